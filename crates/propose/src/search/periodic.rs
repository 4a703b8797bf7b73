//! The smallest set for which S1 and S2 say that it contains a periodic solution, at one sigma, in floating point (derivation, 10.3 and 10.4).
//!
//! S1 and S2 say that a map G of (X_p, E_p, r_x, r_e, r_d) has G(w) <= w. G is nondecreasing, so of all such w the least fixed
//! point is the smallest, in every component at once; and everything that section 5 makes of w grows with it. So nothing is
//! left to choose: the iteration of G from below finds it.

use super::by_energy::ByEnergy;
use super::model::FloatModel;
use super::obstacle::{Failing, Obstacle};
use sigmastar_exact::number::Portable;
use sigmastar_exact::real::Real;
use sigmastar_theory::data::Problem;
use sigmastar_theory::derivation::harmonics::AtOrigin;
use sigmastar_theory::derivation::mean_squares::{
    DampedResponse, ErrorGains, Forcing, Gains, MeanSquares, PeriodicSize, Response, SetBounds, at_the_solution,
    sup_by_mean_squares,
};
use sigmastar_theory::derivation::sampled::{SampledGains, SampledLaw};

/// Which form of S2 existence is sought with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ExistenceForm {
    /// That of 10.3.
    Plain,
    /// That of 10.4, with this share of (b_qe - m)/2 as kap.
    Damped(f64),
}

/// What the set may not be smaller than, where nothing else keeps it open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Floors {
    /// Of X_p.
    pub x_p: f64,
    /// Of E_p.
    pub e_p: f64,
}

/// A set with a periodic solution, and its size.
#[derive(Clone, Debug)]
pub struct PeriodicSet {
    /// X_p.
    pub x_p: f64,
    /// E_p.
    pub e_p: f64,
    /// r_x, r_e, r_d of existence.
    pub squares: MeanSquares<f64>,
    /// kap.
    pub kap: f64,
    /// Smaller ones, where kap > 0.
    pub refined: Option<MeanSquares<f64>>,
    /// x_per.
    pub x_per: f64,
    /// e_per.
    pub e_per: f64,
    /// Z.
    pub z: f64,
    /// k0, k1 and K.
    pub pair: (f64, f64, u32),
    /// Of the law at samples, a bound of sup|y_k|.
    pub y_per: f64,
}

/// Steps of the iteration at most.
const STEPS: usize = 1000;

/// Steps down from beyond the limit at most. Each of them leaves a point that G maps below itself, so that none of them is needed.
const STEPS_DOWN: usize = 24;

/// The largest relative step at which it has converged.
const NEAR: f64 = 1e-14;

/// Every so many steps, many steps at once are tried.
const STRIDE_EVERY: usize = 6;

/// The first that are tried, as the logarithm to the base 2, and by how much more after they succeed.
const FIRST_DOUBLINGS: u32 = 4;

/// Of so many (the logarithm to the base 2), the sum is the limit if there is one.
const DOUBLINGS: u32 = 30;

/// The share of the first step that the last one has, where the sum of the steps is nearly the limit.
const NEARLY_ALL: f64 = 1e-2;

/// The way to the limit as a share of the point, from where one leaps beyond it.
const NEAR_ENOUGH: f64 = 1e-3;

/// How far beside a point the derivatives are taken, as a share of it.
const BESIDE: f64 = 1e-6;

/// How far beyond the limit, as shares of the distance to it; the steps from there lead down to it.
const BEYOND: [f64; 4] = [1e-9, 1e-6, 1e-3, 0.1];

/// Mean squares are at least this share of the suprema: they have to be positive.
const SMALLEST_SHARE: f64 = 1e-12;

/// (X_p, E_p, r_x, r_e, r_d).
type Point = [f64; 5];

/// What the regulator makes of a periodic q.
#[derive(Clone, Copy)]
enum Regulated<'a> {
    /// In continuous time.
    Continuous { gains: &'a ErrorGains<f64>, form: ExistenceForm },
    /// At samples.
    Sampled { gains: &'a SampledGains<f64>, sigma: f64 },
}

/// The iteration at one sigma.
struct Iteration<'a> {
    model: &'a FloatModel,
    origin: &'a AtOrigin<f64>,
    regulated: Regulated<'a>,
    floors: Floors,
    /// 1 + the room that is left between both sides of every inequality.
    enlarged: f64,
}

impl Iteration<'_> {
    /// (1 + room) G, not below the floors.
    fn image(&self, [x_p, e_p, x, e, e_rate]: Point) -> Result<Point, Obstacle> {
        if x_p > self.model.domain.0 {
            return Err(Failing::DomainX.at(x_p, e_p));
        }
        if e_p > self.model.domain.1 {
            return Err(Failing::DomainE.at(x_p, e_p));
        }
        let bounds = SetBounds::new(self.model, x_p, e_p);
        if bounds.rate <= 0.0 {
            return Err(Failing::Existence.at(x_p, e_p));
        }
        let squares = MeanSquares { x, e, e_rate };
        let by_squares = sup_by_mean_squares(self.model, &squares);
        let kap = self.kap(&bounds);
        let forcing = || Forcing::new(&bounds, self.origin, &squares);
        let mut x_rms = bounds.x_rms(&squares);
        let undamped = |response: Response<f64>| [response.sup.min(by_squares), response.rms, response.rate_rms];
        let [sup, rms, rate_rms] = match self.regulated {
            Regulated::Continuous { gains, .. } => match self.by_energy(gains, [x_p, e_p])? {
                // With it all bounds hold together.
                Some(gains) => {
                    let sup = gains.response(self.origin, &forcing()).sup.min(by_squares);
                    let known = (kap > 0.0).then_some(&kap);
                    let image = at_the_solution(&bounds, self.origin, &gains, known, &squares);
                    x_rms = image.x;
                    [sup, image.e, image.e_rate]
                }
                None if kap > 0.0 => {
                    let damped = DampedResponse::new(&bounds, self.origin, [&gains.sigma, &kap], &squares);
                    [by_squares, damped.rms, damped.rate_rms]
                }
                None => undamped(gains.response(self.origin, &forcing())),
            },
            Regulated::Sampled { gains, sigma } => {
                let gains = self.at_samples(gains, sigma, [x_p, e_p])?;
                x_rms = x_rms.min_known(&gains.rms_of_states());
                undamped(gains.response(self.origin, &forcing()))
            }
        };
        let next = [bounds.x_sup(&squares), sup, x_rms, rms, rate_rms].map(|v| v * self.enlarged);
        if !next.iter().all(|value| value.is_finite() && *value < 1e140) {
            return Err(if next.iter().any(|value| value.is_nan()) {
                self.model.not_finite(x_p, e_p)
            } else {
                Failing::Existence.at(x_p, e_p)
            });
        }
        let [x_p, e_p] = [next[0].max(self.floors.x_p), next[1].max(self.floors.e_p)];
        let least = |share: f64, of: f64| share.max(SMALLEST_SHARE * of);
        let rate = e_p / self.model.period;
        Ok([x_p, e_p, least(next[2], x_p), least(next[3], e_p), least(next[4], rate)])
    }

    /// The set of a point that G maps below itself, with mean squares that `refine` makes smaller.
    fn set(
        &self,
        [x_p, e_p, x, e, e_rate]: Point,
        gains: &impl Gains<f64>,
        refine: impl Fn(&SetBounds<f64>, f64) -> Option<MeanSquares<f64>>,
    ) -> Result<PeriodicSet, Obstacle> {
        let model = self.model;
        let bounds = SetBounds::new(model, x_p, e_p);
        let squares = MeanSquares { x, e, e_rate };
        let kap = self.kap(&bounds);
        let refined = refine(&bounds, kap);
        let size = PeriodicSize::new(model, &bounds, self.origin, gains, refined.as_ref().unwrap_or(&squares));
        let pair = cheapest_pair(model, &size.forcing);
        let z = gains.z_squared(model, &size.forcing, [&pair.0, &pair.1]).sqrt();
        if !z.is_finite() {
            return Err(model.not_finite(x_p, e_p));
        }
        let [x_per, e_per, y_per] = [size.x_per, size.e_per, gains.largest_mean(&size.forcing)];
        Ok(PeriodicSet { x_p, e_p, squares, kap, refined, x_per, e_per, z, pair, y_per })
    }

    /// The gains with what a matrix inequality says on (X_p, E_p), where there is one there.
    fn by_energy(
        &self,
        gains: &ErrorGains<f64>,
        at @ [x_p, e_p]: [f64; 2],
    ) -> Result<Option<ErrorGains<f64>>, Obstacle> {
        let Some(known) = &self.model.by_energy else { return Ok(None) };
        match (known.bounds(at, self.origin, gains.sigma), known) {
            (Ok(bounds), _) => Ok(Some(gains.clone().with_energy(Some(bounds)))),
            (Err(_), ByEnergy::Sampled { .. }) => Ok(None),
            // A claim with an inequality that is proved has to use it.
            (Err(failing), ByEnergy::Proved(_) | ByEnergy::Joint(_)) => Err(failing.at(x_p, e_p)),
        }
    }

    /// The gains of the law at samples with what a matrix inequality says on (X_p, E_p), where there is one there.
    fn at_samples(&self, gains: &SampledGains<f64>, sigma: f64, at: [f64; 2]) -> Result<SampledGains<f64>, Obstacle> {
        let Some(known) = &self.model.at_samples.existence else { return Ok(gains.clone()) };
        let bounds = known.bounds(at, self.origin, sigma).map_err(|failing| failing.at(at[0], at[1]))?;
        Ok(gains.clone().with_energy(bounds))
    }

    fn kap(&self, bounds: &SetBounds<f64>) -> f64 {
        match self.regulated {
            Regulated::Continuous { form: ExistenceForm::Damped(share), .. } => {
                share * 0.5 * (bounds.q_e - bounds.q_e_max).max(0.0)
            }
            Regulated::Continuous { form: ExistenceForm::Plain, .. } | Regulated::Sampled { .. } => 0.0,
        }
    }

    /// The least fixed point; where it is approached slowly, a point a little above it that G maps below itself.
    fn least(&self) -> Result<Point, Obstacle> {
        let mut at = self.image([self.floors.x_p, self.floors.e_p, 0.0, 0.0, 0.0])?;
        let mut doublings = FIRST_DOUBLINGS;
        for step in 1..STEPS {
            let next = self.image(at)?;
            if change(&at, &next) <= NEAR {
                return Ok(next);
            }
            if step % STRIDE_EVERY != 0 {
                at = next;
                continue;
            }
            let Some(line) = Linear::of(self, at, next) else {
                at = next;
                continue;
            };
            if let Some(found) = self.leap(&line) {
                return Ok(found);
            }
            match self.stride(&line, doublings) {
                Some((reached, further)) => (doublings, at) = (reached + FIRST_DOUBLINGS, further),
                None => (doublings, at) = (FIRST_DOUBLINGS, next),
            }
        }
        Err(Failing::Existence.at(at[0], at[1]))
    }

    /// Many steps from below at once, and how many (the logarithm to the base 2).
    ///
    /// Where w < G(w) all along a straight way up from a point below the least fixed point, its end is below it, too: at the last point of
    /// the way that is below, G(w) would be as well, and with it more of the way. It is looked at half way and at the end.
    fn stride(&self, line: &Linear, doublings: u32) -> Option<(u32, Point)> {
        let below =
            |at: Point| self.image(at).ok().filter(|image| image.iter().zip(&at).all(|(image, at)| image >= at));
        (1..=doublings).rev().step_by(2).find_map(|doublings| {
            let way = line.steps(doublings, NEARLY_ALL)?;
            below(line.ahead(&way, 0.5))?;
            Some((doublings, below(line.ahead(&way, 1.0))?))
        })
    }

    /// A point a little beyond the limit, if that is near and G maps the point below itself.
    fn leap(&self, line: &Linear) -> Option<Point> {
        let way = line.steps(DOUBLINGS, NEAR)?;
        if way.iter().any(|way| way.abs() > NEAR_ENOUGH) {
            return None;
        }
        BEYOND.into_iter().find_map(|beyond| self.down(line.ahead(&way, 1.0 + beyond)))
    }

    /// From a point that G maps below itself down, which removes what it is too large; every point on the way is as good.
    fn down(&self, from: Point) -> Option<Point> {
        let below = |at: &Point| {
            let next = self.image(*at).ok()?;
            next.iter().zip(at).all(|(next, at)| *next <= at * (1.0 + NEAR)).then_some(next)
        };
        let mut at = from;
        let mut next = below(&at)?;
        for step in 1..STEPS_DOWN {
            if change(&at, &next) <= NEAR {
                break;
            }
            if step % STRIDE_EVERY == 0
                && let Some(line) = Linear::of(self, at, next)
                && let Some(way) = line.steps(DOUBLINGS, NEARLY_ALL)
                && let further = line.ahead(&way, 1.0)
                && let Some(image) = below(&further)
            {
                (at, next) = (further, image);
                continue;
            }
            let Some(image) = below(&next) else { break };
            (at, next) = (next, image);
        }
        Some(next)
    }

    /// The least mean squares with `(1 + room) G(r) = r` at fixed X_p, E_p and kap, from both forms together.
    fn refined(&self, gains: &ErrorGains<f64>, bounds: &SetBounds<f64>, kap: f64) -> Option<MeanSquares<f64>> {
        let [x, e, e_rate] = [bounds.x_p, bounds.e_p, bounds.e_p / self.model.period].map(|of| SMALLEST_SHARE * of);
        let least = MeanSquares { x, e, e_rate };
        let mut at = least.clone();
        for _ in 0..STEPS {
            let next = at_the_solution(bounds, self.origin, gains, Some(&kap), &at);
            let next =
                [(&next.x, x), (&next.e, e), (&next.e_rate, e_rate)].map(|(v, low)| (v * self.enlarged).max(low));
            let done = change(&[at.x, at.e, at.e_rate], &next) <= NEAR;
            let [x, e, e_rate] = next;
            at = MeanSquares { x, e, e_rate };
            if done {
                break;
            }
        }
        // Where it has not converged, the next to the last digits are missing: the mean squares of existence serve.
        let image = at_the_solution(bounds, self.origin, gains, Some(&kap), &at);
        let below = [(image.x, at.x), (image.e, at.e), (image.e_rate, at.e_rate)];
        below.into_iter().all(|(image, at)| image < at).then_some(at)
    }
}

/// G as it is near a point, in shares of the point.
struct Linear {
    at: Point,
    /// G(w) - w.
    step: Point,
    /// The derivatives.
    by: [Point; 5],
}

impl Linear {
    /// From the point, its image, and those of points beside it.
    fn of(iteration: &Iteration, at: Point, image: Point) -> Option<Linear> {
        let mut by = [[0.0; 5]; 5];
        for column in 0..5 {
            let mut beside = at;
            beside[column] *= 1.0 + BESIDE;
            let moved = iteration.image(beside).ok()?;
            for row in 0..5 {
                by[row][column] = ((moved[row] - image[row]) / (BESIDE * at[row])).max(0.0);
            }
        }
        let step = std::array::from_fn(|index| (image[index] - at[index]) / at[index]);
        Some(Linear { at, step, by })
    }

    /// The sum of 2^doublings steps, if it is finite; of fewer, where the last one is so small a share of the first.
    fn steps(&self, doublings: u32, last: f64) -> Option<Point> {
        let (mut sum, mut power) = (self.step, self.by);
        for _ in 0..doublings {
            let more = product(&power, &sum);
            sum = std::array::from_fn(|index| sum[index] + more[index]);
            let step = product(&power, &self.step);
            if step.iter().zip(&self.step).all(|(step, first)| step.abs() <= last * first.abs()) {
                break;
            }
            let columns = power;
            power = std::array::from_fn(|row| {
                std::array::from_fn(|column| (0..5).map(|k| columns[row][k] * columns[k][column]).sum())
            });
        }
        sum.iter().all(|value| value.is_finite()).then_some(sum)
    }

    /// A share of the way further.
    fn ahead(&self, way: &Point, share: f64) -> Point {
        std::array::from_fn(|index| self.at[index] * (1.0 + share * way[index]))
    }
}

/// A matrix times a vector.
fn product(matrix: &[Point; 5], vector: &Point) -> Point {
    std::array::from_fn(|row| matrix[row].iter().zip(vector).map(|(a, b)| a * b).sum())
}

/// The largest relative change of a component.
fn change<const N: usize>(from: &[f64; N], to: &[f64; N]) -> f64 {
    from.iter().zip(to).map(|(a, b)| ((b - a) / b).abs()).fold(0.0, f64::max)
}

impl PeriodicSet {
    /// The smallest set at sigma, with so much room (relatively) between both sides of S1 and S2.
    ///
    /// # Errors
    /// The obstacle where there is none.
    pub fn least(
        model: &FloatModel,
        origin: &AtOrigin<f64>,
        sigma: f64,
        (form, floors): (ExistenceForm, Floors),
        room: f64,
    ) -> Result<PeriodicSet, Obstacle> {
        let gains = ErrorGains::new(model, &sigma);
        let regulated = Regulated::Continuous { gains: &gains, form };
        let iteration = Iteration { model, origin, regulated, floors, enlarged: 1.0 + room };
        let at = iteration.least()?;
        match iteration.by_energy(&gains, [at[0], at[1]])? {
            // It has been found with all bounds together.
            Some(gains) => iteration.set(at, &gains, |_, _| None),
            None => iteration.set(
                at,
                &gains,
                |bounds, kap| {
                    if kap > 0.0 { iteration.refined(&gains, bounds, kap) } else { None }
                },
            ),
        }
    }

    /// The smallest set at sigma under the law at samples, with so much room (relatively) between both sides of S1 and S2.
    ///
    /// # Errors
    /// The obstacle where there is none.
    pub fn least_sampled(
        model: &FloatModel,
        origin: &AtOrigin<f64>,
        (law, sigma): (&SampledLaw<f64>, f64),
        floors: Floors,
        room: f64,
    ) -> Result<PeriodicSet, Obstacle> {
        let gains = SampledGains::new(law, &sigma, &model.period);
        let regulated = Regulated::Sampled { gains: &gains, sigma };
        let iteration = Iteration { model, origin, regulated, floors, enlarged: 1.0 + room };
        let at = iteration.least()?;
        let gains = iteration.at_samples(&gains, sigma, [at[0], at[1]])?;
        iteration.set(at, &gains, |_, _| None)
    }
}

/// The pair that makes Z smallest.
fn cheapest_pair(model: &FloatModel, forcing: &Forcing<f64>) -> (f64, f64, u32) {
    // What a unit of k0 and of k1 adds to Z^2.
    let [by_size, by_rate] =
        model.numbers().kappas(&forcing.q_rms.portable_powi(2), &forcing.q_rate_rms.portable_powi(2));
    model.trade_off.best(by_size, by_rate)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::search::floors::tiny;
    use sigmastar_lang::spec::Specification;
    use sigmastar_theory::data::Data;
    use sigmastar_theory::transfer::TradeOff;

    fn model(text: &str) -> FloatModel {
        let spec = Specification::from_json("example", text).unwrap();
        let data = Data::new(&spec, 64);
        FloatModel::new(&data, TradeOff::matched(&data))
    }

    /// The iteration without anything else, until it has converged or a bound is left: from below, so that a point that is not converged is
    /// below the least fixed point.
    fn by_steps(iteration: &Iteration<'_>, steps: usize) -> Result<(Point, bool), Obstacle> {
        let mut at = iteration.image([iteration.floors.x_p, iteration.floors.e_p, 0.0, 0.0, 0.0])?;
        for _ in 0..steps {
            let next = iteration.image(at)?;
            if change(&at, &next) <= NEAR {
                return Ok((next, true));
            }
            at = next;
        }
        Ok((at, false))
    }

    /// The least one of the gains at which there is a set is approached from above; the steps of the iteration become as many as one likes there.
    #[test]
    fn many_steps_at_once_lead_to_the_least_set() {
        let linear = include_str!("../../../../specs/linear.json").to_owned();
        let cubic = linear.replace(r#""q_e": ""#, r#""q_e": "E^2/5 + "#);
        assert_ne!(cubic, linear);
        let (mut slow, mut none) = (0, 0);
        for text in [linear, cubic, include_str!("../../../../specs/paper-example.json").to_owned()] {
            let model = model(&text);
            let origin = AtOrigin::new(&model);
            let floors = tiny(&model);
            for room in [1e-10, 5e-2] {
                for exponent in 0..120 {
                    let sigma = 0.5 * 1.05_f64.portable_powi(exponent);
                    let gains = ErrorGains::new(&model, &sigma);
                    let regulated = Regulated::Continuous { gains: &gains, form: ExistenceForm::Plain };
                    let iteration =
                        Iteration { model: &model, origin: &origin, regulated, floors, enlarged: 1.0 + room };
                    match (iteration.least(), by_steps(&iteration, 30_000)) {
                        (Ok(found), Ok((least, converged))) => {
                            let image = iteration.image(found).unwrap();
                            for (index, value) in found.iter().enumerate() {
                                assert!(image[index] <= value * (1.0 + 1e-12), "{sigma} {found:?} {image:?}");
                                assert!(*value >= least[index] * (1.0 - 1e-9), "{sigma} {found:?} {least:?}");
                                assert!(
                                    !converged || *value <= least[index] * (1.0 + 1e-6),
                                    "{sigma} {found:?} {least:?}"
                                );
                            }
                            slow += usize::from(by_steps(&iteration, 200).unwrap().1 != converged);
                        }
                        (Err(_), Err(_)) => none += 1,
                        (Err(obstacle), Ok((least, converged))) => {
                            assert!(!converged, "{sigma} {obstacle:?} {least:?}")
                        }
                        (Ok(found), Err(obstacle)) => panic!("{sigma} {found:?} {obstacle:?}"),
                    }
                }
            }
        }
        assert!(slow > 0 && none > 0, "{slow} {none}");
    }

    /// With sqrt(E) in dq/de G need not be convex, and its linear part leads too far: no step is accepted that ends above the least fixed point.
    #[test]
    fn a_step_that_leads_too_far_is_not_taken() {
        let text =
            include_str!("../../../../specs/linear.json").replace(r#""q_e": "1/4""#, r#""q_e": "1/4 + 8*sqrt(E)""#);
        let model = model(&text);
        let origin = AtOrigin::new(&model);
        let floors = tiny(&model);
        let (mut taken, mut too_far) = (0, 0);
        for exponent in 0..80 {
            let sigma = 0.5 * 1.1_f64.portable_powi(exponent);
            let gains = ErrorGains::new(&model, &sigma);
            let regulated = Regulated::Continuous { gains: &gains, form: ExistenceForm::Plain };
            let iteration = Iteration { model: &model, origin: &origin, regulated, floors, enlarged: 1.0 };
            let Ok((least, true)) = by_steps(&iteration, 30_000) else { continue };
            let above = |at: Point| at.iter().zip(&least).any(|(at, least)| *at > least * (1.0 + 1e-9));
            for steps in 0..30 {
                let (at, _) = by_steps(&iteration, steps).unwrap();
                let Some(line) = Linear::of(&iteration, at, iteration.image(at).unwrap()) else { continue };
                for doublings in 1..20 {
                    let way = line.steps(doublings, NEARLY_ALL);
                    too_far += usize::from(way.is_some_and(|way| above(line.ahead(&way, 1.0))));
                    if let Some((_, further)) = iteration.stride(&line, doublings) {
                        assert!(!above(further), "{sigma} {further:?} {least:?}");
                        taken += 1;
                    }
                }
            }
        }
        assert!(taken > 0 && too_far > 0, "{taken} {too_far}");
    }
}
