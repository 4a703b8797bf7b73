//! (C5h): the quadratic forms of the decay from sample to sample (derivation, 12.3); with a delay (C5d), forms in one variable more (13.4).

use super::hold::Held;
use super::law::SampledLaw;
use crate::data::{Numbers, Problem};
use crate::derivation::stability::ErrorBox;
use crate::input_gain::InputGain;
use sigmastar_exact::real::{Operand, Real};

/// `xx X^2 + ee E^2 + yy Y^2 - xe XE - xy XY - ey EY`; the last three are nonnegative.
#[derive(Clone, Debug)]
pub struct Form<R> {
    /// Of X^2.
    pub xx: R,
    /// Of E^2.
    pub ee: R,
    /// Of Y^2.
    pub yy: R,
    /// Of -XE.
    pub xe: R,
    /// Of -XY.
    pub xy: R,
    /// Of -EY.
    pub ey: R,
    /// What a delay adds.
    pub past: Option<Past<R>>,
}

/// `pp P^2 - xp XP - ep EP - yp YP` for P = |y_{k-1}|; the last three are nonnegative.
#[derive(Clone, Debug)]
pub struct Past<R> {
    /// Of P^2.
    pub pp: R,
    /// Of -XP.
    pub xp: R,
    /// Of -EP.
    pub ep: R,
    /// Of -YP.
    pub yp: R,
}

impl<R: Real> Form<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// The leading principal minors of its matrix: all positive if and only if the form is positive definite.
    #[must_use]
    pub fn minors(&self) -> Vec<R> {
        let two = R::int(2);
        let [p, q, r] = [&self.ey / &two, &self.xe / &two, &self.xy / &two];
        let second = &self.xx * &self.ee - q.sqr();
        let third = &second * &self.yy - &self.xx * p.sqr() - &self.ee * r.sqr() - &two * (&p * &q * &r);
        let mut minors = vec![self.xx.clone(), second.clone(), third.clone()];
        if let Some(Past { pp, xp, ep, yp }) = &self.past {
            // pp det - a' adj a, with -a the last column and -p, -q, -r the others.
            let [a, b, c] = [xp, ep, yp].map(|part| part / &two);
            let adjugate = [
                &self.ee * &self.yy - p.sqr(),
                &self.xx * &self.yy - r.sqr(),
                second,
                &q * &self.yy + &p * &r,
                &r * &self.ee + &p * &q,
                &p * &self.xx + &q * &r,
            ];
            let [aa, bb, cc, ab, ac, bc] = &adjugate;
            let squares = a.sqr() * aa + b.sqr() * bb + c.sqr() * cc;
            let mixed = &a * &b * ab + &a * &c * ac + &b * &c * bc;
            minors.push(pp * third - squares - R::int(2) * mixed);
        }
        minors
    }
}

/// What of the sampling is taken into account: everything, but for a report that asks what limits a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// theta: what K h Nbar^2 takes from the damping of the oscillators.
    Theta,
    /// h sigma, and the hold of e over a sample.
    Hold,
    /// What moves within a sample: h k_x, h k_e, and x with it.
    Motion,
}

/// Q_0 and Q_h: the decay over [kh, kh + t] is at least t times the form between them.
#[derive(Clone, Debug)]
pub struct DecayForms<R> {
    /// kp = 1 - h k_e/pi, to be positive.
    pub within: R,
    /// Q_0.
    pub start: Form<R>,
    /// Q_h.
    pub end: Form<R>,
}

/// The numbers of the forms at one sigma.
pub struct DecayNumbers<'n, R> {
    /// The law.
    pub law: &'n SampledLaw<R>,
    /// sigma.
    pub sigma: &'n R,
    /// w_x.
    pub w_x: &'n R,
    /// eta, the weight of zeta.
    pub eta: &'n R,
    /// gm, the weight of h y_{k-1}^2; of a law with a delay alone.
    pub gm: &'n R,
}

impl<R: Real> DecayForms<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// Evaluates the forms on an error box.
    ///
    /// Guarantee: where `within` and the minors of both are positive, U falls from sample to sample in the box, and at no time
    /// between samples exceeds what it was at the last one; for every n_o < N_s/2. With a delay so does U + gm h y_{k-1}^2.
    #[must_use]
    pub fn new(problem: &impl Problem<R>, error_box: &ErrorBox<R>, numbers: &DecayNumbers<'_, R>) -> DecayForms<R> {
        DecayForms::without(problem, error_box, numbers, None)
    }

    /// Evaluates the forms as if one part of what the sampling does were not there: for a report, never for a claim.
    #[must_use]
    pub fn without(
        problem: &impl Problem<R>,
        error_box: &ErrorBox<R>,
        numbers: &DecayNumbers<'_, R>,
        part: Option<Part>,
    ) -> DecayForms<R> {
        let DecayNumbers { law, sigma, w_x, eta, gm } = *numbers;
        let Numbers { p_up, .. } = problem.numbers();
        let ErrorBox { k_x, k_f, rate, sector, .. } = error_box;
        let (one, two) = (R::int(1), R::int(2));
        let k_e = sector.below.max(&sector.above);
        let within = &one - &law.step * &k_e / &law.pi;
        // eta/K.
        let weight = eta / &law.gain;
        let coupling = &two * w_x * p_up.sqrt() * k_f;
        let form = |share: R| {
            let t = |of: Part| if part == Some(of) { &law.step * R::int(0) } else { &law.step * &share };
            let (hold, motion) = (t(Part::Hold), t(Part::Motion));
            let theta = if part == Some(Part::Theta) { R::int(0) } else { &share * law.lost() };
            let ts = &hold * sigma;
            let Held { motion: within_t, g, c_x, c_e, c_y } =
                Held::new([&ts, &motion], [k_x, &k_e], [&within, &law.pi]);
            // |1 - ts + (eta/K) ((1 - ts/2) delta + (1-b) sigma)| at the ends of the sector: delta and 1 - b grow together.
            let mean = &one - &ts / &two;
            let at = |slope: R, b: Option<&R>| {
                let slope = &mean * slope;
                let moved = b.map_or_else(|| slope.clone(), |b| &slope + (&one - b) * sigma);
                let value = &one - &ts + &weight * moved;
                value.max(&-value.clone())
            };
            let (low, high) = law.input_gain.as_ref().map(|InputGain { low, high }| (low, high)).unzip();
            let worst = at(sector.above.clone(), low).max(&at(-sector.below.clone(), high));
            // (eta/K) t^2 k_e^2/(3 kp), of y and its own mean.
            let bend = &weight * within_t.sqr() * &within / R::int(3);
            let past = law.delayed.then(|| {
                // y + h sigma y_{k-1} is what moves e.
                let product = &law.step * sigma;
                let rest = &one - &ts;
                let shift = law.input_gain.as_ref().map_or_else(|| R::int(0), InputGain::largest_shift);
                Past {
                    pp: gm - &hold * product.sqr(),
                    xp: &coupling * &c_y * &product,
                    ep: &two * rest.max(&-rest.clone()) * &product,
                    yp: &two * &hold * &product
                        + &weight * &hold * &k_e * &product
                        + &bend * &product
                        + R::int(4) * &weight * law.lost()
                        + &two * &weight * shift * &product,
                }
            });
            let mut form = Form {
                xx: &two * w_x * rate - &coupling * c_x,
                xe: &coupling * c_e,
                xy: &coupling * c_y + &two * &weight * k_x * (&one + &g),
                ee: sigma * (&two - &ts),
                ey: &two * worst + &two * &weight * &g * &k_e,
                yy: &two * &weight * (&one - theta) - &hold - &weight * &hold * &sector.above - bend,
                past,
            };
            if form.past.is_some() {
                form.yy = form.yy - gm;
            }
            form
        };
        DecayForms { start: form(R::int(0)), end: form(R::int(1)), within }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::{Bound, Data, Problem};
    use crate::derivation::sampled::examples::{example, law};
    use crate::derivation::stability::{DecayTerms, Sector};
    use sigmastar_lang::spec::Specification;

    /// P = 1, so that xi = |x|, and 40 samples in a period of 1.
    fn spec(mu: &str) -> Specification {
        example(40, mu, |document| document["lyapunov"]["p_up"] = "1".into())
    }

    /// A problem whose bounding functions nobody asks for.
    struct InDoubles(Numbers<f64>);

    impl Problem<f64> for InDoubles {
        fn numbers(&self) -> &Numbers<f64> {
            &self.0
        }
        fn bound(&self, _: Bound, _: &f64, _: &f64) -> f64 {
            f64::NAN
        }
        fn given(&self, _: Bound) -> bool {
            false
        }
        fn zero(&self) -> f64 {
            0.0
        }
    }

    fn parts(data: &Data<'_>) -> (InDoubles, SampledLaw<f64>) {
        (InDoubles(data.numbers.midpoints()), law(data).to_f64())
    }

    fn random(seed: u64) -> impl FnMut() -> f64 {
        let mut state = seed;
        move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / 2f64.powi(24)
        }
    }

    fn box_of(next: &mut impl FnMut() -> f64, scale: f64) -> ErrorBox<f64> {
        let below = scale * next();
        let sector = Sector { below, above: below * (2.0 * next() - 1.0) };
        let (k_x, k_f, rate) = (scale * next(), scale * next(), 0.1 + scale * next());
        ErrorBox { x_b: 1.0, e_b: 1.0, k_x, sector, sector_at: [1.0; 2], k_f, gamma: 0.0, rate }
    }

    /// The fourth minor, against elimination.
    #[test]
    fn the_minors_of_four_variables() {
        let mut next = random(5);
        for _ in 0..200 {
            let past = Past { pp: next(), xp: next(), ep: next(), yp: next() };
            let [xx, ee, yy, xe, xy, ey] = [0; 6].map(|_| next());
            let rows = [
                [xx, -xe / 2.0, -xy / 2.0, -past.xp / 2.0],
                [-xe / 2.0, ee, -ey / 2.0, -past.ep / 2.0],
                [-xy / 2.0, -ey / 2.0, yy, -past.yp / 2.0],
                [-past.xp / 2.0, -past.ep / 2.0, -past.yp / 2.0, past.pp],
            ];
            let form = Form { xx, ee, yy, xe, xy, ey, past: Some(past) };
            let (mut rows, mut product) = (rows, 1.0);
            let minors = form.minors();
            assert_eq!(minors.len(), 4);
            for (i, minor) in minors.into_iter().enumerate() {
                product *= rows[i][i];
                assert!((minor - product).abs() < 1e-9 * (1.0 + product.abs()), "{i}: {minor} {product}");
                for k in i + 1..4 {
                    let factor = rows[k][i] / rows[i][i];
                    (0..4).for_each(|j| rows[k][j] -= factor * rows[i][j]);
                }
            }
        }
    }

    #[test]
    fn the_form_at_the_start_is_that_of_continuous_time() {
        let spec = spec("1");
        let data = Data::new(&spec, 128);
        let (model, law) = parts(&data);
        let mut next = random(3);
        let mut seen = [0; 2];
        for _ in 0..2000 {
            let error_box = box_of(&mut next, 4.0);
            let (w_x, eta, sigma) = (0.2 + 4.0 * next(), 0.05 + next(), 30.0 * next());
            let numbers = DecayNumbers { law: &law, sigma: &sigma, w_x: &w_x, eta: &eta, gm: &0.0 };
            let start = DecayForms::new(&model, &error_box, &numbers).start;
            let ErrorBox { rate, k_x, k_f, sector, .. } = &error_box;
            let terms = DecayTerms::new([&w_x, &eta], [rate, &law.gain, &1.0], [k_x, k_f], sector);
            let holds = terms.coupling < terms.curvature && sigma > terms.threshold(terms.curvature - terms.coupling);
            let definite = start.minors().iter().all(|minor| *minor > 0.0);
            assert_eq!(definite, holds, "{error_box:?} {sigma} {w_x} {eta}");
            seen[usize::from(holds)] += 1;
        }
        assert!(seen.iter().all(|count| *count > 200), "{seen:?}");
    }

    /// One interval of a loop of the class, integrated finely: U falls at least as the form between both says, for every part of
    /// a sample, and every gain of an interval.
    #[test]
    fn the_level_falls_as_the_forms_say() {
        let mut next = random(11);
        let mut tightest = [f64::INFINITY; 6];
        let models = [("1", [1.0, 1.0]), ("20", [1.0, 1.0]), ("1", [0.6, 1.4]), ("20", [0.8, 1.5])];
        let with_delay = [("1", [1.0, 1.0]), ("4", [1.0, 1.0]), ("1", [0.6, 1.4]), ("4", [0.8, 1.5])];
        let models = models.map(|model| (model, false)).into_iter().chain(with_delay.map(|model| (model, true)));
        for ((mu, [low, high]), delayed) in models {
            let spec = example(40, mu, |document| {
                document["lyapunov"]["p_up"] = "1".into();
                let ends = [low, high].map(|end: f64| end.to_string());
                document["input_gain"] = serde_json::json!({ "nominal": "1", "low": ends[0], "high": ends[1] });
                document["internal_model"]["delay_samples"] = u8::from(delayed).into();
            });
            let data = Data::new(&spec, 128);
            let (model, law) = parts(&data);
            let weights = [2.0, 1.0, 1.0];
            let angle = std::f64::consts::TAU * law.step;
            for trial in 0..400 {
                let end = if high > low { trial % 3 } else { 0 };
                let b = [low, high, low + (high - low) * next()][end];
                let error_box = box_of(&mut next, 20.0);
                let sigma = (0.05 + 0.95 * next()) / law.step;
                let (w_x, eta) = (0.1 + next(), 10f64.powf(-2.0 + 3.0 * next()));
                let gm = if delayed { eta * 10f64.powf(-2.0 + 3.0 * next()) } else { 0.0 };
                let forms = DecayForms::new(
                    &model,
                    &error_box,
                    &DecayNumbers { law: &law, sigma: &sigma, w_x: &w_x, eta: &eta, gm: &gm },
                );
                if forms.within <= 0.0 {
                    continue;
                }
                let [x, e] = [2.0 * next() - 1.0, 2.0 * next() - 1.0];
                let zeta = [0; 3].map(|_| (2.0 * next() - 1.0) * 10f64.powf(2.0 * next() - 1.0));
                let turned = [
                    zeta[0],
                    angle.cos() * zeta[1] + angle.sin() * zeta[2],
                    angle.cos() * zeta[2] - angle.sin() * zeta[1],
                ];
                let v = 2.0 * turned[0] + turned[1];
                // The last y; M'N R M = 2 + cos, and the prediction is off by h times that y.
                let last = if delayed { (2.0 * next() - 1.0) * 10f64.powf(3.0 * next() - 1.0) } else { 0.0 };
                let (predicted, v) = (e - law.step * last, v + law.step * (2.0 + angle.cos()) * last);
                let u = b * (law.gain * v - sigma * predicted);
                let norm = |zeta: [f64; 3]| -> f64 { zeta.iter().zip(weights).map(|(z, n)| n * z * z).sum() };
                let level = |x: f64, e: f64, zeta: [f64; 3]| w_x * x * x + e * e + b * eta * norm(zeta);
                let ErrorBox { k_x, k_f, rate, sector, .. } = &error_box;
                // dq/de, dq/dx and df/de of any size and sign that the box allows, switched within the sample.
                let pick = |next: &mut dyn FnMut() -> f64| {
                    let slope = -sector.below + next() * (sector.above + sector.below);
                    [slope, k_x * (2.0 * next() - 1.0), k_f * (2.0 * next() - 1.0)]
                };
                let slopes = [pick(&mut next), pick(&mut next)];
                let (steps, until) = (400, 0.05 + 0.95 * next());
                let t = until * law.step;
                let dt = t / f64::from(steps);
                let (mut xs, mut es, mut x_squares, mut q_mean) = (x, e, 0.0, 0.0);
                for step in 0..steps {
                    let [slope, by_x, by_e] = slopes[usize::from(step >= steps / 2)];
                    let field = |x: f64, e: f64| [-rate * x + by_e * e, slope * e + by_x * x + u];
                    let [a, b] = field(xs, es);
                    let [c, d] = field(xs + dt / 2.0 * a, es + dt / 2.0 * b);
                    let (xm, em) = (xs + dt / 2.0 * a, es + dt / 2.0 * b);
                    x_squares += xm * xm / f64::from(steps);
                    q_mean += (slope * em + by_x * xm) / f64::from(steps);
                    (xs, es) = (xs + dt * c, es + dt * d);
                }
                let y = b * law.gain * v + (1.0 - b) * sigma * predicted + q_mean;
                let moved = [turned[0] - t * y, turned[1] - t * y, turned[2]];
                let fall = (level(x, e, zeta) - level(xs, es, moved)) / t + gm * (last * last - y * y);
                let [x_rms, e_size, y_size] = [x_squares.sqrt(), e.abs(), y.abs()];
                let value = |form: &Form<f64>| {
                    form.xx * x_rms * x_rms + form.ee * e_size * e_size + form.yy * y_size * y_size
                        - form.xe * x_rms * e_size
                        - form.xy * x_rms * y_size
                        - form.ey * e_size * y_size
                        + form.past.as_ref().map_or(0.0, |past| {
                            let p = last.abs();
                            past.pp * p * p - past.xp * x_rms * p - past.ep * e_size * p - past.yp * y_size * p
                        })
                };
                assert_eq!(forms.end.past.is_some(), delayed);
                let least = (1.0 - until) * value(&forms.start) + until * value(&forms.end);
                let scale = fall.abs() + least.abs() + y * y * eta + gm * last * last;
                assert!(fall >= least - 1e-4 * scale, "{fall} {least} {b} {error_box:?}");
                let kind = end + if delayed { 3 } else { 0 };
                tightest[kind] = tightest[kind].min((fall - least) / scale);
            }
        }
        // The bound is not idle.
        assert!(tightest.iter().all(|slack| *slack < 0.05), "{tightest:?}");
    }
}
