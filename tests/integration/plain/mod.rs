//! Every condition computed a second way: plain 400-bit arithmetic, without enclosures and without the tool's formulas.
//!
//! C5 is decided by the determinant of the quadratic form itself, Nbar by MPFR's zeta function.

mod multipliers;
mod number;
mod repaired;
mod table;

pub use number::{BITS, R, r};
use rug::ops::Pow;
use rug::{Float, Rational};
use serde_json::Value;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::expr::Expr;
use sigmastar_lang::spec::{Bound, Constant, InitialSet, Specification, Weights};
pub use table::Cell;

/// One condition: its identifier, both sides, and whether it holds.
pub struct Plain {
    pub id: &'static str,
    pub lhs: R,
    pub rhs: R,
    pub holds: bool,
}

fn less(id: &'static str, lhs: R, rhs: R) -> Plain {
    let holds = lhs < rhs;
    Plain { id, lhs, rhs, holds }
}

fn at_most(id: &'static str, lhs: R, rhs: R) -> Plain {
    let holds = lhs <= rhs;
    Plain { id, lhs, rhs, holds }
}

/// The decimal or fraction in a certificate.
pub fn parse(text: &str) -> Rational {
    if text.contains('/') {
        return text.parse().expect("a fraction");
    }
    let (mantissa, exponent) = text.split_once('e').unwrap_or((text, "0"));
    let (whole, part) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits: Rational = format!("{whole}{part}").parse().expect("digits");
    let exponent: i32 = exponent.parse::<i32>().expect("an exponent") - part.len() as i32;
    digits * Rational::from(10).pow(exponent)
}

/// The numbers of a specification.
pub struct Spec<'s> {
    spec: &'s Specification,
    t: R,
    p_low: R,
    p_up: R,
    alpha: R,
    mu: R,
    w: R,
    c: R,
    n_bar: R,
}

fn constant(value: &Constant) -> R {
    R(Float::with_val(BITS, value.enclose(BITS).lower()))
}

/// n_l by the definition of the family.
pub fn weight(weights: &Weights, l: u64) -> R {
    let power = |exponent: R| R(Float::with_val(BITS, l).pow(-exponent.0));
    match weights {
        Weights::Power { n0, .. } if l == 0 => constant(n0),
        Weights::Power { epsilon, .. } => power(r(1.0) + constant(epsilon)),
        Weights::Explicit { values, coefficient, exponent } => match values.get(l as usize) {
            Some(value) => constant(value),
            None => constant(coefficient) * power(constant(exponent)),
        },
    }
}

/// Nbar^2 by the zeta function.
fn total(weights: &Weights) -> R {
    let zeta = |p: R| R(p.0.zeta());
    match weights {
        Weights::Power { n0, epsilon } => constant(n0) + zeta(r(1.0) + constant(epsilon)),
        Weights::Explicit { values, coefficient, exponent } => {
            let listed = values.iter().fold(r(0.0), |sum, value| sum + constant(value));
            let skipped = (1..values.len() as u64)
                .fold(r(0.0), |sum, l| sum + R(Float::with_val(BITS, l).pow(-constant(exponent).0)));
            listed + constant(coefficient) * (zeta(constant(exponent)) - skipped)
        }
    }
}

/// The bounding functions at one point.
struct At {
    f: R,
    q: R,
    qt: R,
    fe: R,
    fxx: R,
    fex: R,
    qe: R,
    qx: R,
    qr: R,
    qtr: R,
    /// -below <= dq/de <= above.
    below: R,
    above: R,
    fx: Option<R>,
    mixed: Option<[R; 2]>,
    rate: Option<R>,
}

/// What the data give on the error box.
struct ErrorBox {
    x_b: R,
    e_b: R,
    gamma: R,
    /// a_2.
    rate: R,
    k_x: R,
    k_f: R,
    /// -slopes[1] <= dq/de <= slopes[0].
    slopes: [R; 2],
    threshold: R,
}

/// What follows from the witness of a sharp certificate.
struct Derived {
    conditions: Vec<Plain>,
    a_1: R,
    /// (c/a_1) b_fe.
    x_gain: R,
    /// rms(x), rms(e), rms(e').
    means: [R; 3],
    /// R_q, R_1.
    rates: [R; 2],
    /// |x|, |e|, |zeta|_N along the periodic solution.
    sizes: [R; 3],
    error_box: ErrorBox,
}

impl<'s> Spec<'s> {
    pub fn new(spec: &'s Specification) -> Spec<'s> {
        let (p_low, p_up) =
            (constant(&spec.lyapunov.triple().unwrap().p_low), constant(&spec.lyapunov.triple().unwrap().p_up));
        Spec {
            spec,
            t: constant(spec.period.nominal()),
            c: (&p_up / &p_low).sqrt(),
            p_low,
            p_up,
            alpha: constant(&spec.lyapunov.triple().unwrap().alpha),
            mu: constant(&spec.internal_model.mu),
            w: constant(&spec.internal_model.base_frequency),
            n_bar: total(&spec.internal_model.weights).sqrt(),
        }
    }

    fn at(&self, x: &R, e: &R) -> At {
        let point = |v: &R| Enclosure::new(v.0.clone(), v.0.clone());
        let value = |expr: &Expr| {
            let value = expr.enclose(&point(x), &point(e));
            // The positive part, as section 1 of the mathematics says.
            let value = if value.is_bounded() { R(Float::with_val(BITS, value.lower())) } else { r(f64::NAN) };
            if value < r(0.0) { r(0.0) } else { value }
        };
        let b = &self.spec.bounds;
        let of = |which: Bound| b.get(which).map_or(r(f64::NAN), value);
        let signed = |which: Bound| {
            b.own(which).map(|expr| R(Float::with_val(BITS, expr.enclose(&point(x), &point(e)).lower())))
        };
        // A root mean square is at most the supremum.
        let rms = |own: Bound, supremum: Bound| {
            let (own, supremum) = (of(own), of(supremum));
            if own < supremum { own } else { supremum }
        };
        At {
            f: of(Bound::F),
            q: of(Bound::Q),
            qt: of(Bound::Qt),
            fe: of(Bound::Fe),
            fxx: of(Bound::Fxx),
            fex: of(Bound::Fex),
            qe: of(Bound::Qe),
            qx: of(Bound::Qx),
            qr: rms(Bound::QRms, Bound::Q),
            qtr: rms(Bound::QtRms, Bound::Qt),
            below: of(Bound::Qe),
            above: signed(Bound::QeMax)
                .map_or_else(|| of(Bound::Qe), |m| if m < of(Bound::Qe) { m } else { of(Bound::Qe) }),
            fx: b.own(Bound::Fx).map(&value),
            mixed: b.own(Bound::Qtx).zip(b.own(Bound::Qte)).map(|(x, e)| [value(x), value(e)]),
            rate: signed(Bound::Rate),
        }
    }

    /// sqrt(sum over all j of 1/(sigma^2 + om_j^2)).
    fn beta(&self, sigma: &R) -> R {
        let q = R(Float::with_val(BITS, -(sigma * &self.t).0).exp());
        let coth = (r(1.0) + &q) / (r(1.0) - &q);
        (&self.t * coth / (r(2.0) * sigma)).sqrt()
    }

    /// tau = sqrt(T^2/12 - beta^2 + 1/sigma^2)/sigma; 400 bits absorb the cancellation for the sigma of these tests.
    fn tau(&self, sigma: &R) -> R {
        let sum = self.t.sq() / r(12.0) - self.beta(sigma).sq() + r(1.0) / sigma.sq();
        sum.sqrt() / sigma
    }

    /// Whether the pair is admissible and its proof allowed.
    fn transfer(&self, witness: &Value, k0: &R, k1: &R) -> Plain {
        let model = &self.spec.internal_model;
        let weights = &model.weights;
        let nu = &self.mu / &self.w;
        let inverse = r(1.0) / nu.sq();
        let (n_0, n_1) = (weight(weights, 0), weight(weights, 1));
        let needed = |k: u64| match k {
            0 => &inverse / &n_0,
            _ => r(2.0) * &inverse / weight(weights, k),
        };
        let square = |k: u64| r(k as f64).sq();
        let holds = match witness["transfer"]["proof"].as_str() {
            Some("closed-form") => {
                let pi = R(Float::with_val(BITS, rug::float::Constant::Pi));
                let first = (&inverse + n_1.sq()) / &n_0;
                let second = r(4.0) * &n_0 - r(2.0) * &n_1;
                let least_0 = (pi.sq() - r(4.0)) * &n_1 / r(2.0) + first.max(&second);
                let least_1 = r(8.0) * (&inverse + (r(2.0) * &n_0 + &n_1 / r(3.0)).sq()) / &n_1;
                least_0 <= *k0 && least_1 <= *k1
            }
            _ => {
                let k = witness["transfer"]["K"].as_u64().unwrap();
                model.matched
                    && (1..=4096).contains(&k)
                    && (0..k).all(|k| needed(k) <= k0 + k1 * square(k))
                    && needed(k) <= k1 * square(k)
                    // What the proof is for.
                    && (0..200).all(|k| needed(k) <= k0 + k1 * square(k))
            }
        };
        Plain { id: "T", lhs: r(0.0), rhs: r(0.0), holds }
    }

    fn set(&self, claim: &Value, x_p: &R, e_p: &R, z: &R) -> Vec<Plain> {
        let two = r(2.0);
        let size = |given: &Option<Constant>, twice: &R| given.as_ref().map_or(&two * twice, constant);
        // The same kind of set, of sizes that are no smaller.
        let (kind, required) = match &self.spec.initial_set {
            InitialSet::Paper => ("paper", vec![&two * x_p, &two * e_p, &two * (z + &self.n_bar * e_p)]),
            InitialSet::AtRest { x0, e0 } => ("at-rest", vec![size(x0, x_p), size(e0, e_p), r(0.0)]),
            InitialSet::Aligned { x0, e0 } => ("aligned", vec![size(x0, x_p), size(e0, e_p)]),
            InitialSet::Box { x0, e0, z0 } => ("box", vec![constant(x0), constant(e0), constant(z0)]),
        };
        let set = &claim["initial_set"];
        assert_eq!((&set["kind"], set["Z0"].is_string()), (&Value::from(kind), required.len() == 3));
        let claimed = ["X0", "E0", "Z0"].into_iter().map(|name| number(&set[name]));
        required.into_iter().zip(claimed).map(|(a, b)| at_most("set", a - b, r(0.0))).collect()
    }

    /// How far the claimed set is from a periodic solution of the given size: x and e by the triangle inequality, and so
    /// zeta = z - M e, which is 0 where z starts as M e.
    fn distances(&self, claim: &Value, [x_per, e_per, z]: [&R; 3]) -> [R; 3] {
        let set = &claim["initial_set"];
        let [x_0, e_0] = numbers(set, ["X0", "E0"]);
        let zeta = if set["kind"] == "aligned" { r(0.0) } else { number(&set["Z0"]) + &self.n_bar * &e_0 };
        [x_0 + x_per, e_0 + e_per, zeta + z]
    }

    fn domain(&self, x: &R, e: &R) -> Vec<Plain> {
        self.spec.domain.as_ref().map_or_else(Vec::new, |domain| {
            vec![at_most("domain", x.clone(), constant(&domain.x)), at_most("domain", e.clone(), constant(&domain.e))]
        })
    }

    /// M, C4 and C5 around a periodic solution of the given size, and the error box.
    fn stability(
        &self,
        [x_per, e_per]: [&R; 2],
        distances: &[R; 3],
        part: &Value,
        sigma: &R,
    ) -> (Vec<Plain>, ErrorBox) {
        let [d_x, d_e, w_x, h] = numbers(part, ["D_x", "D_e", "w_x", "h"]);
        let (x_b, e_b) = (x_per + &d_x, e_per + &d_e);
        // (x, e) of each leg of a path from the periodic solution: along the one that moves x the derivatives in x count, along
        // the other those in e. Who names no paths has the older ones.
        let legs = |function: &str, older: &str| match part["paths"][function].as_str().unwrap_or(older) {
            "x-first" => [[x_b.clone(), e_per.clone()], [x_b.clone(), e_b.clone()]],
            "e-first" => [[x_b.clone(), e_b.clone()], [x_per.clone(), e_b.clone()]],
            "straight" => [[x_b.clone(), e_b.clone()], [x_b.clone(), e_b.clone()]],
            path => panic!("no path {path}"),
        };
        let ([f_dx, f_de], [q_dx, q_de]) = (legs("f", "x-first"), legs("q", "straight"));
        let on = |[x, e]: &[R; 2]| self.at(x, e);
        // df/dx on its leg, against the one at x = 0, e = 0: first as x goes to the periodic solution's, then as e goes from 0.
        let gamma = &self.c
            * (self.at(x_per, &r(0.0)).fxx * x_per
                + self.at(x_per, &f_dx[1]).fex * &f_dx[1]
                + on(&f_dx).fxx * &d_x / r(2.0));
        let edge = on(&q_de);
        let (k_x, k_f) = (on(&q_dx).qx / self.p_low.sqrt(), on(&f_de).fe);
        let rate = &self.alpha - &gamma;
        let rate = on(&f_dx).rate.map_or(rate.clone(), |given| given.max(&rate));
        let [a, b, c] = distances;
        let start = &w_x * &self.p_up * a.sq() + b.sq() + &h * c.sq();
        let exit = (&w_x * &self.p_low * d_x.sq()).min(&d_e.sq());
        // -U' as a form in (s, xi, et), with u = k_x xi + slope et at its worst sign and phi = k_f et; the slope at either end
        // of its sector, and k_x with either sign.
        let corner = r(2.0) * &w_x * &rate;
        let first = r(2.0) * &h * &self.mu;
        let mut threshold = r(0.0);
        let mut definite = first > r(0.0);
        let [above, below] = [edge.above.clone(), r(0.0) - &edge.below];
        for (slope, sign) in [(above.clone(), 1.0), (below.clone(), 1.0), (above, -1.0), (below, -1.0)] {
            let k_x = r(sign) * &k_x;
            let coupled = &h * &k_x;
            let mixed = &h * &slope - &self.mu;
            let cross = r(0.0) - &w_x * self.p_up.sqrt() * &k_f - &k_x;
            let second = &first * &corner - coupled.sq();
            let determinant = |sigma: &R| {
                let last = r(2.0) * (sigma - &slope);
                &first * (&corner * &last - cross.sq()) - &coupled * (&coupled * &last - &cross * &mixed)
                    + &mixed * (&coupled * &cross - &corner * &mixed)
            };
            // The determinant is affine in sigma, with twice the second minor as its slope.
            threshold = threshold.max(&(r(0.0) - determinant(&r(0.0)) / (r(2.0) * &second)));
            definite = definite && second > r(0.0) && determinant(sigma) > r(0.0);
        }
        let mut conditions: Vec<Plain> = self.one_sided(&q_de[0], &q_de[1]).into_iter().collect();
        conditions.extend([
            less("C4", start, exit),
            less("C5", &h / &self.mu * k_x.sq(), r(4.0) * &w_x * &rate),
            Plain { id: "C5b", lhs: threshold.clone(), rhs: sigma.clone(), holds: definite },
        ]);
        let slopes = [edge.above, edge.below];
        (conditions, ErrorBox { x_b, e_b, gamma, rate, k_x, k_f, slopes, threshold })
    }

    /// C_k, r_0 and r_1 of `q_0`.
    fn known(&self) -> Option<(Vec<R>, R, R)> {
        let known = self.spec.q_0.as_ref()?;
        let c: Vec<R> = known.harmonics.iter().map(constant).collect();
        let om = self.om();
        let rate = (1..c.len()).fold(r(0.0), |sum, k| sum + r(2.0) * (r(k as f64) * &om * &c[k]).sq()).sqrt();
        let derived = self.at(&r(0.0), &r(0.0)).qtr + rate;
        let rest_rate = known.rest_t_rms.as_ref().map_or(derived.clone(), |given| constant(given).min(&derived));
        Some((c, constant(&known.rest_rms), rest_rate))
    }

    fn om(&self) -> R {
        r(2.0) * R(Float::with_val(BITS, rug::float::Constant::Pi)) / &self.t
    }

    /// All conditions of a sharp certificate (sections 5 and 10).
    pub fn sharp(&self, certificate: &Value) -> Vec<Plain> {
        self.derive(certificate).conditions
    }

    /// The same, with the numbers that a table of constants shows.
    fn derive(&self, certificate: &Value) -> Derived {
        let (witness, claim) = (&certificate["witness"], &certificate["claim"]);
        let sigma = number(&claim["sigma_star"]);
        let [x_p, e_p, k0, k1, kap] = numbers(witness, ["X_p", "E_p", "k0", "k1", "kap"]);
        let squares = |part: &Value| numbers(part, ["r_x", "r_e", "r_d"]);
        let (t, om) = (&self.t, self.om());
        let at = self.at(&x_p, &e_p);
        let axis = self.at(&x_p, &r(0.0));
        let origin = self.at(&r(0.0), &r(0.0));
        // 10.1.
        let a_1 = &self.alpha - &self.c * &axis.fxx * &x_p / r(2.0);
        let a_1 = axis.rate.map_or(a_1.clone(), |given| given.max(&a_1));
        let taylor = (&axis.f + &axis.fxx * x_p.sq()) / &x_p;
        let fx = axis.fx.map_or(taylor.clone(), |given| given.min(&taylor));
        // 10.2.
        let sg = (sigma.sq() + om.sq()).sqrt();
        let bt = (self.beta(&sigma).sq() - r(1.0) / sigma.sq()).sqrt();
        let tau = self.tau(&sigma);
        let half = &a_1 * t / r(2.0);
        let coth = R(Float::with_val(BITS, half.0.coth_ref()));
        let gain = &self.c / &a_1;
        let k2 = &self.c * (t * coth / (r(2.0) * &a_1)).sqrt();
        // 10.3.
        let known = self.known();
        let q_0 = known.as_ref().map_or(origin.qr.clone(), |(c, rest, _)| {
            let squares = (1..c.len()).fold(c[0].sq(), |sum, k| sum + r(2.0) * c[k].sq());
            origin.qr.min(&(squares.sqrt() + rest))
        });
        let sums = known.as_ref().map(|(c, ..)| {
            let gain = |k: usize| r(1.0) / (sigma.sq() + (r(k as f64) * &om).sq());
            let sup = (1..c.len()).fold(r(0.0), |sum, k| sum + r(2.0) * &c[k] * gain(k).sqrt());
            let rms = (1..c.len()).fold(r(0.0), |sum, k| sum + r(2.0) * c[k].sq() * gain(k)).sqrt();
            let rate = (1..c.len()).fold(r(0.0), |sum, k| sum + r(2.0) * (r(k as f64) * &om * &c[k]).sq()).sqrt();
            (sup, rms, rate)
        });
        let sup_of = |size: &R, rate: &R| (&bt * size).min(&(&tau * rate));
        let rms_of = |size: &R, rate: &R| (size / &sg).min(&(rate / (&om * &sg)));
        let forcing = |[r_x, r_e, r_d]: &[R; 3]| {
            let moved = &at.qx * (&fx * r_x + &at.fe * r_e) + &at.qe * r_d;
            let d_0 = &at.qx * r_x + &at.qe * r_e;
            let in_time = &at.qtr + &origin.qtr;
            let in_time = at.mixed.as_ref().map_or(in_time.clone(), |[x, e]| in_time.min(&(x * r_x + e * r_e)));
            let d_1 = in_time + &moved;
            let r_q = at.qr.min(&(&q_0 + &d_0));
            let r_1 = &at.qtr + moved;
            let r_1 = match (&sums, &known) {
                (Some((.., rate)), Some((.., rest))) => r_1.min(&(rate + rest + &d_1)),
                _ => r_1,
            };
            [r_q, r_1, d_0, d_1]
        };
        let response = |[r_q, r_1, d_0, d_1]: &[R; 4]| {
            let (mut sup, mut rms) = (sup_of(r_q, r_1), rms_of(r_q, r_1));
            if let (Some((sup_0, rms_0, _)), Some((_, rest, rest_rate))) = (&sums, &known) {
                sup = sup.min(&(sup_0 + sup_of(rest, rest_rate) + sup_of(d_0, d_1)));
                rms = rms.min(&(rms_0 + rms_of(rest, rest_rate) + rms_of(d_0, d_1)));
            }
            [sup, rms, r_q.min(&(r_1 / &sg))]
        };
        let damped = |[r_x, r_e, _]: &[R; 3]| {
            let slope = (&at.above + &kap).max(&(&at.below - &kap));
            let forced = &q_0 + &at.qx * r_x + slope * r_e;
            let g = if kap <= sigma { r(1.0) / (&sigma + &kap) } else { r(0.5) / (&sigma * &kap).sqrt() };
            [g * &forced, forced + &kap * r_e]
        };
        let first = squares(witness);
        let refined = (!witness["refined"].is_null()).then(|| squares(&witness["refined"]));
        let last = refined.clone().unwrap_or_else(|| first.clone());
        let by_squares = |[_, r_e, r_d]: &[R; 3]| (t * r_e * r_d).sqrt();
        let forced = forcing(&last);
        let [sup, ..] = response(&forced);
        let e_per = e_p.min(&sup).min(&by_squares(&last));
        let x_per = x_p.min(&(&gain * &at.fe * &e_per)).min(&(&k2 * &at.fe * &last[1]));
        let w2 = self.w.sq();
        let (kappa_0, kappa_1) = (&k0 / &w2, &k1 / w2.sq());
        let [r_q, r_1, d_0, d_1] = &forced;
        let swing = t / (r(2.0) * &self.mu) * r_q.sq();
        let norm = |a: &R, b: &R| &kappa_0 * a.sq() + &kappa_1 * b.sq();
        let mut z = (&swing + norm(r_q, r_1)).sqrt();
        if let Some((c, rest, rest_rate)) = &known {
            let weights = &self.spec.internal_model.weights;
            let nu = &self.mu / &self.w;
            let bound = |k: usize| {
                let general = &k0 + &k1 * (r(k as f64) * &om / &self.w).sq();
                let matched = r(2.0) / (nu.sq() * weight(weights, k as u64));
                if self.spec.internal_model.matched { general.min(&matched) } else { general }
            };
            let mean = c[0].sq() / (nu.sq() * weight(weights, 0));
            let sum = (1..c.len()).fold(mean, |sum, k| sum + r(2.0) * bound(k) * c[k].sq());
            let total = sum.sqrt() / &self.w + norm(rest, rest_rate).sqrt() + norm(d_0, d_1).sqrt();
            z = z.min(&(swing + total.sq()).sqrt());
        }
        let mut all = signs(certificate, &["X_p", "E_p", "r_x", "r_e", "r_d", "D_x", "D_e", "w_x", "h", "k1"]);
        if kap != r(0.0) {
            all.push(less("sign", r(0.0), kap.clone()));
        }
        for value in refined.iter().flatten() {
            all.push(less("sign", r(0.0), value.clone()));
        }
        all.extend(self.set(claim, &x_p, &e_p, &z));
        let distances = self.distances(claim, [&x_per, &e_per, &z]);
        let (stability, error_box) = self.stability([&x_per, &e_per], &distances, witness, &sigma);
        all.extend(self.domain(&x_p.max(&error_box.x_b), &e_p.max(&error_box.e_b)));
        all.push(self.transfer(witness, &k0, &k1));
        all.push(less("S1", r(0.0), a_1.clone()));
        all.push(at_most("S1b", (&gain * &at.fe * &e_p).min(&(&k2 * &at.fe * &first[1])), x_p.clone()));
        all.push(at_most("S1c", &gain * &at.fe * &first[1], first[0].clone()));
        let [sup, rms, rate] = if kap == r(0.0) {
            let [sup, rms, rate] = response(&forcing(&first));
            [sup.min(&by_squares(&first)), rms, rate]
        } else {
            all.extend(self.one_sided(&x_p, &e_p));
            let [rms, rate] = damped(&first);
            [by_squares(&first), rms, rate]
        };
        all.push(at_most("S2", sup, e_p.clone()));
        all.push(at_most("S2b", rms, first[1].clone()));
        all.push(at_most("S2c", rate, first[2].clone()));
        if let Some(refined) = &refined {
            let [_, mut rms, mut rate] = response(&forcing(refined));
            if kap != r(0.0) {
                let [by_damping, rate_by_damping] = damped(refined);
                (rms, rate) = (rms.min(&by_damping), rate.min(&rate_by_damping));
            }
            all.push(less("S3", &gain * &at.fe * &refined[1], refined[0].clone()));
            all.push(less("S3b", rms, refined[1].clone()));
            all.push(less("S3c", rate, refined[2].clone()));
        }
        all.extend(stability);
        let [r_q, r_1, ..] = forced;
        let sizes = [x_per, e_per, z];
        Derived { conditions: all, a_1, x_gain: gain * at.fe, means: last, rates: [r_q, r_1], sizes, error_box }
    }

    /// Whether the sector of dq/de is one.
    fn one_sided(&self, x: &R, e: &R) -> Option<Plain> {
        self.spec.bounds.own(Bound::QeMax)?;
        let at = self.at(x, e);
        Some(at_most("M", r(0.0) - at.below, at.above))
    }

    /// The conditions of the exact-regulation part, if there is one.
    pub fn exact(&self, certificate: &Value) -> Vec<Plain> {
        let part = &certificate["witness"]["exact_regulation"];
        if part.is_null() {
            return Vec::new();
        }
        let sigma = number(&part["sigma_star_oo"]);
        let origin = self.at(&r(0.0), &r(0.0));
        let weights = &self.spec.internal_model.weights;
        let pi = R(Float::with_val(BITS, rug::float::Constant::Pi));
        let turn = &self.t / (r(2.0) * pi);
        let norm = |size: &R, rate: &R| {
            (size.sq() / weight(weights, 0) + r(2.0) * turn.sq() * rate.sq() / weight(weights, 1)).sqrt()
        };
        let mut z = norm(&origin.qr, &origin.qtr);
        if let Some((c, rest, rest_rate)) = self.known() {
            let first = c[0].sq() / weight(weights, 0);
            let sum = (1..c.len()).fold(first, |sum, k| sum + r(4.0) * c[k].sq() / weight(weights, k as u64));
            z = z.min(&(sum.sqrt() + norm(&rest, &rest_rate)));
        }
        let z = z / &self.mu;
        let zero = r(0.0);
        let distances = self.distances(&certificate["claim"], [&zero, &zero, &z]);
        let (stability, ErrorBox { x_b, e_b, .. }) = self.stability([&zero, &zero], &distances, part, &sigma);
        let mut all = Vec::new();
        for value in numbers(part, ["sigma_star_oo", "D_x", "D_e", "w_x", "h"]) {
            all.push(less("sign", r(0.0), value));
        }
        all.extend(self.domain(&x_b, &e_b));
        all.extend(stability);
        all
    }
}

fn number(value: &Value) -> R {
    R::rational(&parse(value.as_str().unwrap()))
}

fn numbers<const N: usize>(object: &Value, names: [&str; N]) -> [R; N] {
    names.map(|name| number(&object[name]))
}

/// The sizes of a claimed set, by their names.
fn sizes(claim: &Value) -> Vec<(&'static str, R)> {
    let set = &claim["initial_set"];
    let there = ["X0", "E0", "Z0"].into_iter().filter(|name| set[name].is_string());
    there.map(|name| (name, number(&set[name]))).collect()
}

fn signs(certificate: &Value, names: &[&str]) -> Vec<Plain> {
    let sigma = number(&certificate["claim"]["sigma_star"]);
    let values = names.iter().map(|name| number(&certificate["witness"][name]));
    std::iter::once(sigma).chain(values).map(|value| less("sign", r(0.0), value)).collect()
}
