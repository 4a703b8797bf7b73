//! The bounds of a plant for a claim about the regulator at samples that rests on matrix inequalities over the derivatives
//! (derivation, 13.7, (Ms), and (E) at samples): in the coordinates of the inequality in continuous time, the gain is raised from the one
//! there until both hold with some room, and they are proved at it.

use super::choice::with_constant;
use super::coordinates::{Chosen, CoordinateSearch, Start};
use super::entries::needed;
use super::grid::Grid;
use super::proofs::{Along, PRECISION, Proofs};
use super::proved_at_samples::{ReducedSampled, found_again};
use super::sampling::{Sampling, float_matrix};
use rug::Rational;
use sigmastar_exact::number::{Direction, Portable, round_f64};
use sigmastar_exact::parallel;
use sigmastar_lang::spec::{
    self, PeriodicMatrix, ProvedValues, SampledExistence, SampledGain, SampledInequalities, SampledInequality,
    SampledLoop,
};
use sigmastar_propose::bounds::{FloatSuprema, Places, SampledEnergy, SampledWeights};
use sigmastar_propose::search::{
    AtSamples, AtSigma, BySampledEnergy, BySampledMatrix, FloatModel, Floors, PeriodicSet, SampledProposal,
    SampledSearch, active_level, weight_h,
};
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::paths::Path;
use sigmastar_theory::derivation::sampled::{SampledEnergyNumbers, SampledLaw, sampled_trade_off};
use sigmastar_theory::derivation::sampled_form::LoopNumbers;
use std::sync::Arc;

/// How much larger the next gain of the scan is, how many there are at most, and the steps of the bisection after it.
const NEXT: f64 = 1.06;
const GAINS: usize = 60;
const STEPS: usize = 6;

/// The steps in which a gain that is given is come to from the smallest one.
const PARTS: u32 = 3;

/// The radii that are aimed at, in turn: what is left below 1 is for what the samples have missed, and for few boxes.
const TARGETS: [f64; 3] = [0.985, 0.95, 0.85];

/// Where nothing is found from the shape in continuous time: sets, over the ordinary one, and shapes, over that one, from which it is sought at
/// once; and by how much larger the next gain is then.
const SIZES: [f64; 3] = [1.0, 30.0, 1000.0];
const SHAPES: [[f64; 2]; 5] = [[1.0, 1.0], [1.0, 0.3], [1.0, 0.1], [0.3, 1.0], [0.3, 0.1]];
const NEXT_ANEW: f64 = 1.2;

/// How far beyond the arguments of a proposal the bounds are proved, in turn.
const ENLARGED: [f64; 2] = [2e-2, 1e-1];

/// The inequality of stability is sampled so far beyond the error box.
const BEYOND: f64 = 1.05;

/// c_e in units of sigma^2 c_y, in turn.
const SHARES: [f64; 2] = [0.3, 1.0];

/// So many times gamma at samples is reckoned with: its proof may take that.
const GAMMA_ROOM: f64 = 1.32;

/// How often the inequality of existence is sought for the set that it gave, where that is so many times smaller than the one it was
/// sought for, or larger.
const TURNS: usize = 2;
const FAR: f64 = 2.0;

/// The set for which it is sought is so much larger than the one that is known.
const LARGER: f64 = 1.1;

/// The ratio of neighbouring nodes of a grid of gamma.
const RATIO: f64 = 1.12;

/// Points that are looked at for each bound.
const EACH: usize = 6;

/// What x, e_k and y keep, as shares of the rate along the orbit, of sigma and of k_p.
const KEPT: f64 = 1e-6;

/// The room in S1 and S2.
const ROOM: f64 = 1e-9;

/// Significant digits of the numbers of an inequality, and of the gain.
const DIGITS: u32 = 8;
const DIGITS_OF_GAIN: u32 = 6;

/// What a matrix inequality must take from the gain of norms.
const WORTH: f64 = 0.99;

/// The coordinates of the inequality in continuous time, on the straight path near one of these starts; none where it is not worth its proof
/// beside norms that prove a gain, and where P moves.
pub(super) fn straight_by_matrix(
    p: &PeriodicMatrix,
    starts: &[Start],
    sampling: &Sampling<'_>,
    beside_norms: bool,
) -> Option<(Along, Chosen)> {
    if !p.harmonics.is_empty() {
        return None;
    }
    let path = Some(Path::Straight);
    let by_norms = |start: &Start| if beside_norms { start.proposal.sigma } else { f64::INFINITY };
    let choose = |search: &CoordinateSearch<'_>, start| search.choose_near(start, by_norms(start), f64::INFINITY);
    let near = |start| with_constant(p, sampling, path, |search| choose(search, start)).ok();
    let found = starts.iter().filter_map(near);
    found.min_by(|(_, a), (_, b)| a.proposal.sigma.total_cmp(&b.proposal.sigma))
}

/// The search at one sampling period.
pub(super) struct MatrixAtSamples<'a> {
    sampled: &'a Sampling<'a>,
    along: &'a Along,
    chosen: &'a Chosen,
    sampling: &'a spec::Sampling,
    gain: SampledGain,
    law: SampledLaw<f64>,
    model: FloatModel,
    suprema: Arc<FloatSuprema>,
    units: [f64; 2],
    /// The points that matter from the start.
    places: Places,
}

/// Where the search is at one gain.
#[derive(Clone)]
struct At {
    sigma: f64,
    /// (X_p, E_p) for which the inequality of existence is sought.
    size: [f64; 2],
    /// (rho, eta).
    shape: (f64, f64),
    places: Places,
}

/// What was found at one gain.
#[derive(Clone)]
struct Found {
    sigma: f64,
    set: PeriodicSet,
    at: AtSigma,
    energy: Option<SampledEnergy>,
    model: FloatModel,
    places: Places,
}

impl<'a> MatrixAtSamples<'a> {
    /// `None` where the law has no numbers for this sampling period.
    pub(super) fn new(
        sampled: &'a Sampling<'a>,
        (along, chosen): (&'a Along, &'a Chosen),
        sampling: &'a spec::Sampling,
    ) -> Option<MatrixAtSamples<'a>> {
        let plant = sampled.plant;
        let gain = plant.internal_model.sampled_gain(&sampling.step)?;
        let empty = along.specification(plant, ProvedValues::default()).ok()?;
        let data = Data::new(&empty, PRECISION);
        let enclosed = SampledLaw::new(&data, sampling, &gain);
        let mut model = chosen.model.with_trade_off(sampled_trade_off(&data, &enclosed));
        (model.by_matrix, model.by_energy) = (None, None);
        let units = sampled.units(&float_matrix(&along.coordinates.l));
        let suprema = Arc::new(along.suprema(sampled));
        let places = suprema.extreme(&[units], EACH, None).places;
        let law = enclosed.to_f64();
        Some(MatrixAtSamples { sampled, along, chosen, sampling, gain, law, model, suprema, units, places })
    }

    /// The bounds and inequalities at the gain that is given, or at the smallest one that is found, and is below that of norms.
    pub(super) fn reduce(&self, gain: Option<&Rational>, by_norms: Option<f64>) -> Option<ReducedSampled> {
        if let Some(gain) = gain {
            let at_once = self.scan_at(gain.to_f64()).and_then(|found| self.proved(&found, gain));
            return at_once.or_else(|| self.above_the_least(gain));
        }
        let largest = by_norms.map_or(f64::INFINITY, |sigma| sigma * WORTH).min(self.law.step.recip());
        let from = |start: &At| {
            TARGETS.into_iter().find_map(|target| {
                let found = self.least(start, target, largest)?;
                let sigma = round_f64(found.sigma, DIGITS_OF_GAIN, Direction::Up)?;
                let found = self.at(&At { sigma: sigma.to_f64(), ..self.again(&found) })?;
                self.proved(&found, &sigma)
            })
        };
        from(&self.start(self.chosen.proposal.sigma)).or_else(|| from(&self.anew(largest)?))
    }

    /// From what is found at the first of few gains from some set and shape.
    fn anew(&self, largest: f64) -> Option<At> {
        let gains = std::iter::successors(Some(self.chosen.proposal.sigma), |sigma| Some(sigma * NEXT_ANEW));
        let mut gains = gains.take(GAINS).take_while(|sigma| *sigma <= largest);
        gains.find_map(|sigma| self.anywhere(sigma)).map(|found| self.again(&found))
    }

    /// What is found at a gain from the first set and shape that lead to something.
    fn anywhere(&self, sigma: f64) -> Option<Found> {
        let known = self.start(sigma);
        let (rho, eta) = known.shape;
        let starts = SIZES.iter().flat_map(|size| SHAPES.iter().map(move |shape| (size, shape)));
        let mut found = starts.filter_map(|(size, [of_rho, of_eta])| {
            let shape = (1.0 + (rho - 1.0) * of_rho, eta * of_eta);
            self.at(&At { size: self.units.map(|unit| unit * size), shape, ..known.clone() })
        });
        found.find(|found| found.at.threshold < 1.0)
    }

    /// The smallest gain for samples of the derivatives; nothing is proved.
    pub(super) fn estimate(&self) -> Option<f64> {
        let found = self.least(&self.start(self.chosen.proposal.sigma), TARGETS[0], self.law.step.recip());
        found.map(|found| found.sigma)
    }

    /// From what is known in continuous time.
    fn start(&self, sigma: f64) -> At {
        let parameters = self.chosen.proposal.parameters;
        At { sigma, size: self.units, shape: (parameters.rho, parameters.eta), places: self.places.clone() }
    }

    fn floors(&self) -> Floors {
        self.chosen.proposal.parameters.floors
    }

    /// Where the next gain starts from what was found at one.
    fn again(&self, found: &Found) -> At {
        let Found { sigma, set, at, places, .. } = found;
        At { sigma: *sigma, size: [set.x_p, set.e_p], shape: (at.rho, at.eta), places: places.clone() }
    }

    /// The least gain with that radius, up to the largest one.
    fn least(&self, start: &At, target: f64, largest: f64) -> Option<Found> {
        let mut from = start.clone();
        let mut below = None;
        let mut best = None;
        for _ in 0..GAINS {
            if from.sigma > largest {
                return None;
            }
            let next = from.sigma * NEXT;
            match self.at(&from) {
                Some(found) if found.at.threshold <= target => {
                    best = Some(found);
                    break;
                }
                Some(found) => {
                    below = Some(from.sigma);
                    from = At { sigma: next, ..self.again(&found) };
                }
                None => {
                    below = Some(from.sigma);
                    // The set that was found before may be what is too large.
                    from = At { sigma: next, size: self.units, ..from };
                }
            }
        }
        let mut best = best?;
        // An uncertain input gain asks for more in continuous time, where every larger sigma has to do.
        for _ in 0..GAINS {
            if below.is_some() {
                break;
            }
            let next = best.sigma / NEXT;
            match self.at(&At { sigma: next, ..self.again(&best) }) {
                Some(found) if found.at.threshold <= target => best = found,
                _ => below = Some(next),
            }
        }
        let Some(mut below) = below else { return Some(best) };
        for _ in 0..STEPS {
            let middle = (below * best.sigma).sqrt();
            match self.at(&At { sigma: middle, ..self.again(&best) }) {
                Some(found) if found.at.threshold <= target => best = found,
                _ => below = middle,
            }
        }
        Some(best)
    }

    /// At a gain that is given from what is found at the smallest one, which the inequalities may be followed from.
    fn above_the_least(&self, gain: &Rational) -> Option<ReducedSampled> {
        let (sigma, largest) = (gain.to_f64(), self.law.step.recip());
        let from = |start: &At| {
            TARGETS.into_iter().find_map(|target| {
                let mut found = self.least(start, target, largest)?;
                // As far above it as it is rounded.
                if sigma < round_f64(found.sigma, DIGITS_OF_GAIN, Direction::Up)?.to_f64() {
                    return None;
                }
                for part in (1..=PARTS).rev() {
                    let next = (sigma / found.sigma).portable_ln() / f64::from(part);
                    let next = if part == 1 { sigma } else { found.sigma * next.portable_exp() };
                    found = self.at(&At { sigma: next, ..self.again(&found) })?;
                }
                self.proved(&found, gain)
            })
        };
        from(&self.start(self.chosen.proposal.sigma)).or_else(|| from(&self.anew(largest)?))
    }

    /// What is found at a gain that is given.
    fn scan_at(&self, sigma: f64) -> Option<Found> {
        let again = |first: Found| self.at(&self.again(&first)).filter(|found| found.at.threshold < 1.0);
        let first = self.at(&self.start(sigma));
        first.and_then(again).or_else(|| self.anywhere(sigma).and_then(again))
    }

    fn numbers(&self, sigma: f64) -> LoopNumbers<f64> {
        let SampledLaw { step, gain, weight_sum, pi, .. } = &self.law;
        LoopNumbers::new(sigma, *step, [*gain, *weight_sum], pi, self.suprema.moves())
    }

    /// The model at one gain.
    fn model(&self, sigma: f64, places: &Places, energy: Option<&SampledEnergy>) -> FloatModel {
        let of = self.numbers(sigma);
        let (suprema, listed, law) = (self.suprema.clone(), places.clone(), of.clone());
        let radius = move |[x, e]: [f64; 2], [w_x, eta]: [f64; 2], _: f64| {
            let weights = SampledWeights { w_x, eta, of: law.clone() };
            suprema.sampled_radius([x * BEYOND, e * BEYOND], &listed, &weights).radius
        };
        let existence = energy.map(|energy| {
            let SampledEnergy { c_x, c_e, c_y, .. } = *energy;
            let (suprema, listed, energy) = (self.suprema.clone(), places.clone(), energy.clone());
            let gamma = move |x: f64, e: f64| GAMMA_ROOM * suprema.sampled_gamma([x, e], &listed, &energy, &of);
            let grid = Grid::new(gamma, self.units, RATIO);
            BySampledEnergy::Sampled(Arc::new(move |at, _| {
                let gamma = grid.at(at, |gamma| *gamma).unwrap_or(f64::NAN);
                SampledEnergyNumbers { c_x, c_e, c_y, gamma }
            }))
        });
        let stability = Some(BySampledMatrix::Sampled(Arc::new(radius)));
        let mut model = self.model.clone();
        model.at_samples = AtSamples { stability, existence };
        model
    }

    /// The best that is found at a gain: of the inequalities of existence the one with which the known shape does best, and then the shape.
    fn at(&self, from: &At) -> Option<Found> {
        self.sampled.count();
        let of = self.numbers(from.sigma);
        let with = |energy: Option<SampledEnergy>| {
            let model = self.model(from.sigma, &from.places, energy.as_ref());
            let (set, at) = self.near_shape(&model, from, false)?;
            Some(Found { sigma: from.sigma, set, at, energy, model, places: from.places.clone() })
        };
        let smaller = |a: &Found, b: &Found| a.at.threshold.total_cmp(&b.at.threshold);
        let mut best = with(None);
        let mut size = from.size;
        for _ in 0..TURNS {
            let reach = size.map(|side| side * LARGER);
            let sought = parallel::map(&SHARES, |&share| {
                let energy = self.suprema.propose_sampled_energy(reach, &of, share)?;
                with(Some(energy))
            });
            best = sought.into_iter().flatten().chain(best).min_by(smaller);
            let found = best.as_ref().map(|found| [found.set.x_p, found.set.e_p])?;
            let is_near = |found: f64, size: f64| (size / FAR..=size * LARGER).contains(&found);
            if is_near(found[0], size[0]) && is_near(found[1], size[1]) {
                break;
            }
            size = found;
        }
        let known = best?;
        let (set, at) = self.near_shape(&known.model, from, true)?;
        let mut found = Found { set, at, ..known };
        found.places = self.with_worst(&found);
        Some(found)
    }

    /// The periodic set and the error box near the known shape.
    fn near_shape(&self, model: &FloatModel, from: &At, refined: bool) -> Option<(PeriodicSet, AtSigma)> {
        let search = SampledSearch::new(model, self.law.clone());
        search.near_shape((from.sigma, self.floors()), from.shape, ROOM, refined)
    }

    /// The points that matter, with those where the inequality of stability is tightest.
    fn with_worst(&self, found: &Found) -> Places {
        let (at, weights, lambda) = self.weights(found);
        self.suprema.with_worst(at, &self.places, &weights, lambda)
    }

    /// Where the inequality of stability is asked for, its weights, and the best lambda.
    fn weights(&self, found: &Found) -> ([f64; 2], SampledWeights, f64) {
        let Found { sigma, set, at, places, .. } = found;
        let level = active_level(at.eta, at.dist_e, at.rho);
        let (w_x, eta) = (level / (self.model.p_low * at.d_x * at.d_x), weight_h(at.eta, at.dist_e, at.dist_z));
        let weights = SampledWeights { w_x, eta, of: self.numbers(*sigma) };
        let reach = [set.x_per + at.d_x, set.e_per + level.sqrt()].map(|side| side * BEYOND);
        let lambda = self.suprema.sampled_radius(reach, places, &weights).lambda;
        (reach, weights, lambda)
    }

    /// The specification with the values proved at the arguments of what was found.
    fn proved(&self, found: &Found, sigma: &Rational) -> Option<ReducedSampled> {
        let wanted = self.wanted(found, sigma)?;
        let proofs = Proofs::new(self.along, self.sampled).ok()?;
        let proposal = SampledProposal {
            sigma: found.sigma,
            floors: self.floors(),
            rho: found.at.rho,
            eta: found.at.eta,
            radius: found.at.threshold,
        };
        ENLARGED.into_iter().find_map(|enlarged| {
            let second = self.along.second().is_some();
            let at = needed(&found.model, &found.set, &found.at, enlarged, (second, found.sigma))?;
            let at = at.with_sampled(wanted.clone());
            let [x, e] = at.largest();
            proofs.engine.smooth(&x, &e).ok()?;
            let values = proofs.values(&at).ok()?;
            let spec = self.along.specification(proofs.plant, values).ok()?;
            let proposal = found_again(&spec, self.sampling, &proposal, Some(found.sigma)).ok()?;
            Some(ReducedSampled { spec, proposal, near: None, others: Vec::new() })
        })
    }

    /// The inequalities with short numbers; gamma is sought with their proofs.
    fn wanted(&self, found: &Found, sigma: &Rational) -> Option<SampledInequalities> {
        let about = SampledLoop { sigma: sigma.clone(), samples: self.sampling.samples, law: self.gain.clone() };
        let short = |value: f64| round_f64(value, DIGITS, Direction::Nearest);
        let little = |value: f64| round_f64(KEPT * value, 1, Direction::Down).filter(|value| *value > 0);
        let (_, weights, lambda) = self.weights(found);
        let stability = SampledInequality {
            x: Rational::new(),
            e: Rational::new(),
            w_x: short(weights.w_x)?,
            eta: short(weights.eta)?,
            lambda: short(lambda)?,
            rate: little(self.model.alpha)?,
            c_e: little(found.sigma)?,
            c_y: little(2.0 * weights.eta / self.law.gain)?,
            at: about.clone(),
        };
        let existence = match &found.energy {
            None => None,
            Some(SampledEnergy { p, k_p, lambda, c_x, c_e, c_y }) => {
                let row = |row: &Vec<f64>| row.iter().map(|entry| short(*entry)).collect::<Option<Vec<Rational>>>();
                Some(SampledExistence {
                    x: Rational::new(),
                    e: Rational::new(),
                    matrix: p.iter().map(row).collect::<Option<_>>()?,
                    k_p: short(*k_p)?,
                    c_x: short(*c_x)?,
                    c_e: short(*c_e)?,
                    c_y: short(*c_y)?,
                    gamma: Rational::new(),
                    lambda: short(*lambda)?,
                    at: about,
                })
            }
        };
        Some(SampledInequalities { stability: Some(stability), existence })
    }
}
