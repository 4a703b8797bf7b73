//! Bounds for given numbers of oscillators of any plant of which nothing is an interval, by trials (derivation, 14.4, 14.5).

use super::gain_row::{ByCount, CountBounds, CountProof, Largest};
use crate::attempt::prove_value;
use rug::Rational;
use sigmastar_decide::bounds::{Engine, Region, StatesForm};
use sigmastar_decide::linear::{Loop, PRECISION, Start};
use sigmastar_decide::trial::{Concluded, Known, OrMore, Peaks, Trial, TubeProof, XFirst};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, round_f64, round_rational};
use sigmastar_exact::parallel;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::{Bound, Level, Metric, OfPlant, ProvedCell, Specification};
use sigmastar_matrix::inverse;
use sigmastar_propose::bounds::{FallingForm, FloatCurve, FloatSuprema, LookedAt, PeakBox, PeakOf, PeakProgram};
use sigmastar_propose::orbit::FloatSeries;
use sigmastar_propose::trial::{ProposedTrial, TrialLoop};
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::control::{Control, Reach};
use sigmastar_theory::derivation::initial_set::ClaimedSet;
use sigmastar_theory::derivation::sharp::SharpWitness;
use sigmastar_theory::evidence::Coordinates;
use std::collections::BTreeSet;

/// The numbers of oscillators that are looked at where they are not looked at one by one, and from where on all of them at once.
const COUNTS: [u64; 6] = [0, 1, 2, 3, 5, 10];
const OR_MORE: u64 = 20;

/// From where on all of them may be looked at once, each number before by itself; the share of q that they leave then.
const ONE_BY_ONE: usize = 12;
const LEFT: f64 = 1e-9;

/// Digits of the numbers of a form, and of bounds.
const DIGITS: u32 = 9;
const SHORT: u32 = 4;

/// By what share of the diagonal the matrices of a form are to be definite, and how much of that is claimed.
const MARGINS: [f64; 2] = [1e-3, 1e-5];
const WIDE_MARGINS: [f64; 2] = [0.1, 1e-2];
const KEPT: f64 = 0.5;

/// How far a metric is from what a level says of it.
const ROOM: f64 = 1e-5;

/// For so few oscillators a box and forms of their own are looked for where others serve, and proved if the peak is less than this share of the other.
const OWN: u64 = 2;
const WORTH: f64 = 0.97;

/// Defects that are small enough, beside q, and the velocity of the states.
const SMALL: f64 = 1e-10;

/// Boxes of the proof of a form.
const EFFORT: usize = 20_000;

/// How far x may come from the periodic solution, in distances of the start, in turn; the first box of e in that of its start.
const REACHES: [f64; 5] = [1.5, 2.5, 4.0, 6.5, 12.0];
const FIRST: f64 = 1.2;

/// The share of a box up to which solutions may come, and how often the box is fitted to that.
const FILLED: f64 = 0.985;
const FITS: usize = 10;
const LARGER: f64 = 1.04;
const SMALLER: f64 = 1.002;
const SETTLED: f64 = 0.99;

/// Along x first the peak hardly depends on how far the box goes in e: the box of e in the search, in that of its start, and in peaks.
const FAR: f64 = 2.0;
const ROOMY: f64 = 1.08;

/// The claim that such bounds are added to.
pub(super) struct Asked<'a> {
    pub(super) plant: &'a Plant,
    pub(super) spec: &'a Specification,
    pub(super) sigma: &'a Rational,
    pub(super) set: &'a ClaimedSet,
    /// What proves it.
    pub(super) witness: &'a SharpWitness,
    /// Its `x_per` and `e_per`.
    pub(super) periodic: [Enclosure; 2],
    /// The numbers of its formulas.
    pub(super) data: Data<'a>,
    /// kappa_0 and kappa_1.
    pub(super) kappas: [Enclosure; 2],
    /// Numbers of oscillators that are looked at besides.
    pub(super) counts: &'a [u32],
}

/// The bounds that are found; `None` without any.
pub(super) fn by_trials(asked: &Asked<'_>) -> Option<ByCount> {
    let Asked { plant, spec, .. } = asked;
    let of_plant = spec.plant()?;
    let known_gain = spec.input_gain.as_ref().is_none_or(|gain| gain.factors(PRECISION).is_none());
    let cell =
        of_plant.undivided().filter(|_| !plant.is_family() && plant.period.interval().is_none() && known_gain)?;
    let around = |n_o: u64, or_more: bool| Around { asked, of_plant, cell, n_o, or_more };
    let (mut counts, from): (BTreeSet<u64>, u64) = match around(OR_MORE, true).met_by() {
        Some(from) => ((0..from).collect(), from),
        None => (BTreeSet::from(COUNTS), OR_MORE),
    };
    // What it is proved with serves the others in many cases.
    let last = around(from, true).bounds(None);
    let known = last.as_ref().map(|(_, (_, proof))| proof);
    let besides = asked.counts.iter().copied().map(u64::from);
    counts.extend(besides.filter(|n_o| *n_o < from || last.is_none()));
    let counts: Vec<u64> = counts.into_iter().collect();
    let mut found = parallel::map(&counts, |n_o| around(*n_o, false).bounds(known));
    found.push(last);
    let (counts, trials): (Vec<_>, Vec<_>) = found.into_iter().flatten().unzip();
    (!counts.is_empty()).then_some(ByCount { counts, proof: CountProof::Trials(trials), checked: false })
}

/// One number of oscillators.
struct Around<'a> {
    asked: &'a Asked<'a>,
    of_plant: &'a OfPlant,
    cell: &'a ProvedCell,
    n_o: u64,
    or_more: bool,
}

/// A trial with everything that is evaluated around it.
struct Prepared {
    trial: Trial,
    own: Loop,
    period: Enclosure,
    start: Start,
    engine: Engine,
    samples: FloatSuprema,
    /// d_x, d_q and d_t.
    defects: [Rational; 3],
    /// The distances of the start from the periodic solution: of x, e, zeta.
    distances: [f64; 3],
}

/// What is proved, what follows, and the peaks where they are known.
type Proved = (TubeProof, Concluded, Option<Peaks>);

/// The radii of a box in short numbers.
fn short(radii: [f64; 2]) -> Option<[Rational; 2]> {
    let [x, e] = radii.map(|radius| round_f64(radius, DIGITS, Direction::Down));
    Some([x?, e?])
}

fn up(value: f64, digits: u32) -> Option<Rational> {
    // Of 0 too a bound that is above it: what is proved is strict.
    round_f64(value.max(f64::MIN_POSITIVE), digits, Direction::Up)
}

impl Around<'_> {
    /// The bounds; `other`: what is proved for another number of oscillators.
    fn bounds(&self, other: Option<&TubeProof>) -> Option<(CountBounds, (Trial, TubeProof))> {
        let prepared = self.prepared()?;
        let nominal = self.asked.spec.input_gain.as_ref().map(|gain| gain.nominal.enclose(PRECISION));
        let alone = |(radii, forms): ([Rational; 2], Vec<(Metric, Level)>)| {
            let proof = self.proof(&prepared, radii, forms)?;
            let concluded = Concluded::of(&prepared.trial, &proof, &self.known(&prepared))?;
            Some((proof, concluded, None))
        };
        let small = || {
            SMALL_BOXES.into_iter().find_map(|share| {
                let (radii, form) = self.small_box(&prepared, share)?;
                alone((short(radii)?, vec![rounded(&form)?]))
            })
        };
        let of_other = other.map(|TubeProof { radii, forms, x_first, .. }| ((radii.clone(), forms.clone()), x_first));
        let (mut proof, concluded, mut peaks) = match of_other {
            // Where they do not fall with all derivatives at one point for another number, they do not for this one.
            Some((known, Some(_))) => alone(known).or_else(small)?,
            Some(((radii, forms), None)) => {
                let known = self.with_peaks(&prepared, radii, forms);
                let own = || self.with_own_peaks(&prepared, known.as_ref().and_then(|known| known.2.as_ref()));
                let own = if known.is_none() || self.n_o < OWN { own() } else { None };
                own.or(known).or_else(small)?
            }
            None => self.with_own_peaks(&prepared, None).or_else(small)?,
        };
        if peaks.is_none() {
            let found = self.along_x_first(&prepared, &concluded, other.and_then(|other| other.x_first.as_ref()));
            (proof.x_first, peaks) = found.unzip();
        }
        if peaks.is_none() && !self.is_of_the_claim(&concluded) {
            return None;
        }
        // The solution is that of the claim: its function falls along the differences, too.
        let own = self.reach_by_the_claim(&prepared, &concluded);
        let reach = match peaks {
            Some(Peaks { error, control, .. }) => {
                Reach { error: own.error.min(&error), transient: own.transient.min(&control) }
            }
            None => own,
        };
        let Control { steady, transient } =
            Control { steady: concluded.control.clone(), transient: reach.transient }.over(nominal.as_ref());
        let bounds = CountBounds {
            n_o: self.n_o,
            or_more: self.or_more,
            steady_error: concluded.error.clone(),
            mean_square: concluded.mean_square.clone(),
            steady_control: steady,
            largest: Some(Largest { error: &concluded.error + reach.error, transient }),
        };
        Some((bounds, (prepared.trial, proof)))
    }

    /// What is proved with forms of its own, if the peak is expected to be well below those that are known.
    fn with_own_peaks(&self, prepared: &Prepared, known: Option<&Peaks>) -> Option<Proved> {
        // What many oscillators leave may be more than rounding: with small margins the solution could be anywhere.
        let [first, last] = MARGINS;
        let wide = WIDE_MARGINS.last().filter(|_| self.or_more).copied();
        std::iter::once(first).chain(wide).chain([last]).find_map(|margin| {
            let (radii, forms) = self.peak_box(prepared, margin, None)?;
            let expected = forms.first()?.level.sqrt();
            if known.is_some_and(|known| expected > WORTH * known.error.upper_f64()) {
                return None;
            }
            let forms = forms.iter().map(rounded).collect::<Option<_>>()?;
            self.with_peaks(prepared, short(radii)?, forms)
        })
    }

    /// What is proved with forms on a box that solutions from the set do not leave.
    fn with_peaks(&self, prepared: &Prepared, radii: [Rational; 2], forms: Vec<(Metric, Level)>) -> Option<Proved> {
        let proof = self.proof(prepared, radii, forms)?;
        let concluded = Concluded::of(&prepared.trial, &proof, &self.known(prepared))?;
        let peaks = self.peaks(prepared, &concluded, (&proof.radii, &proof.forms))?;
        Some((proof, concluded, Some(peaks)))
    }

    /// The peaks by forms on a box, if solutions from the set do not leave it.
    fn peaks(
        &self,
        prepared: &Prepared,
        concluded: &Concluded,
        (radii, forms): (&[Rational; 2], &[(Metric, Level)]),
    ) -> Option<Peaks> {
        let has_states = self.asked.plant.states() > 0;
        let peaks = Peaks::of((forms, has_states), concluded, &prepared.own, &prepared.start)?;
        let mut inside = peaks.reach.iter().zip(radii).zip([has_states, true]);
        inside
            .all(|((reach, end), asked)| !asked || reach.lt(&Enclosure::from_rational(end, PRECISION)).is_true())
            .then_some(peaks)
    }

    /// What falls along x first on a box that solutions from the set do not leave; `other`: that of another number of oscillators.
    fn along_x_first(
        &self,
        prepared: &Prepared,
        concluded: &Concluded,
        other: Option<&XFirst>,
    ) -> Option<(XFirst, Peaks)> {
        let eta = round_f64(SMALL_ETA * prepared.distances[1], SHORT, Direction::Up)?;
        if !concluded.distances[1].le(&Enclosure::from_rational(&eta, PRECISION)).is_true() {
            return None;
        }
        let of_other = || self.decided_x_first(prepared, concluded, XFirst { eta: eta.clone(), ..other?.clone() });
        let found = |margin: f64| {
            let (radii, forms) = self.peak_box(prepared, margin, Some(eta.to_f64()))?;
            let splitting = |form: &FallingForm| form.splitting.as_ref()?.iter().map(short_row).collect();
            let splittings = forms.iter().map(splitting).collect::<Option<_>>()?;
            let forms = forms.iter().map(rounded).collect::<Option<_>>()?;
            let x_first = XFirst { radii: short(radii)?, eta: eta.clone(), forms, splittings };
            self.decided_x_first(prepared, concluded, x_first)
        };
        of_other().or_else(|| MARGINS.into_iter().find_map(found))
    }

    /// What is proved of it: at least the first form.
    fn decided_x_first(
        &self,
        prepared: &Prepared,
        concluded: &Concluded,
        mut x_first: XFirst,
    ) -> Option<(XFirst, Peaks)> {
        let Prepared { engine, .. } = prepared;
        let [x, e] = x_first.radii.each_ref();
        self.in_domain(prepared, [x, e])?;
        engine.smooth(x, e).ok()?;
        let decided = |((metric, level), s): (&(Metric, Level), &Vec<Vec<Rational>>)| {
            let place = ([x, e], &x_first.eta);
            engine.decide_form_x_first((metric, level, s), self.asked.sigma, place, EFFORT).truth.is_true()
        };
        let holds: Vec<bool> = x_first.forms.iter().zip(&x_first.splittings).map(decided).collect();
        holds.first().filter(|first| **first)?;
        let mut each = holds.iter();
        x_first.forms.retain(|_| each.next() == Some(&true));
        let mut each = holds.iter();
        x_first.splittings.retain(|_| each.next() == Some(&true));
        let peaks = self.peaks(prepared, concluded, (&x_first.radii, &x_first.forms))?;
        Some((x_first, peaks))
    }

    fn known<'p>(&'p self, prepared: &'p Prepared) -> Known<'p> {
        let orbit = &self.cell.orbit;
        Known {
            own: &prepared.own,
            period: &prepared.period,
            orbit: &orbit.approximation.centre,
            radius: &orbit.radius,
            kappas: &self.asked.kappas,
        }
    }

    /// (ii) of 14.4.
    fn is_of_the_claim(&self, concluded: &Concluded) -> bool {
        let Asked { witness, periodic, .. } = self.asked;
        let error_box = [&witness.d_x, &witness.d_e].map(|radius| Enclosure::from_rational(radius, PRECISION));
        let sizes = [&concluded.states, &concluded.error];
        let within =
            |((size, periodic), end): ((&Enclosure, &Enclosure), &Enclosure)| (size + periodic).le(end).is_true();
        sizes.into_iter().zip(periodic).zip(&error_box).all(within)
    }

    /// How far solutions from the set are from the periodic one by what proves the claim, with the sizes for this number of oscillators.
    fn reach_by_the_claim(&self, prepared: &Prepared, concluded: &Concluded) -> Reach<Enclosure> {
        let Asked { witness, data, .. } = self.asked;
        let own = &prepared.own;
        let distances = prepared.start.distances(own, [&concluded.states, &concluded.error, &concluded.zeta]);
        witness.reach(&data.with_oscillators(&own.n_bar_squared), distances.each_ref())
    }

    /// From which number of oscillators on what they leave of q is as small as nothing, of a loop in which they leave no error; `None` where that is
    /// not soon.
    fn met_by(&self) -> Option<u64> {
        let forcing = self.proposed()?.forcing;
        let sizes = forcing.harmonics.iter().map(|[cos, sin]| cos.to_f64().hypot(sin.to_f64())).collect::<Vec<f64>>();
        let all = forcing.mean.to_f64().abs() + sizes.iter().sum::<f64>();
        let left = |met: usize| sizes.iter().skip(met).sum::<f64>();
        (0..=ONE_BY_ONE).find(|met| left(*met) <= LEFT * all).map(|met| met as u64)
    }

    fn proposed(&self) -> Option<ProposedTrial> {
        let Asked { plant, spec, sigma, .. } = self.asked;
        let model = &spec.internal_model;
        let weight = |l: u64| model.weights.weight(l, PRECISION).midpoint_f64();
        let program = TrialLoop {
            plant,
            sigma: sigma.to_f64(),
            mu: model.mu.enclose(PRECISION).midpoint_f64(),
            weights: (0..=self.n_o).map(weight).collect(),
            or_more: self.or_more,
        };
        let orbit = &self.cell.orbit.approximation.centre;
        let doubles = |vector: &Vec<Rational>| vector.iter().map(Rational::to_f64).collect();
        let curve = FloatSeries {
            mean: doubles(&orbit.mean),
            harmonics: orbit.harmonics.iter().map(|pair| pair.each_ref().map(doubles)).collect(),
        };
        program.propose(&curve)
    }

    fn prepared(&self) -> Option<Prepared> {
        let Asked { plant, spec, sigma, set, .. } = self.asked;
        let model = &spec.internal_model;
        let met = usize::try_from(self.n_o).ok()?;
        let ProposedTrial { states, error, forcing } = self.proposed()?;
        let trial = Trial { n_o: self.n_o, or_more: self.or_more, states, error, forcing };
        let l = &self.of_plant.coordinates;
        let lines = met.max(trial.error.harmonics.len());
        let own = Loop::new(sigma, model, lines, None, inverse(l)?);
        let own = if self.or_more { own } else { own.with_oscillators(met) };
        let coordinates = Coordinates { l: l.clone(), p: self.of_plant.matrix.clone() };
        let q = trial.forcing.parts().map(|part| part.to_f64().abs()).sum::<f64>();
        let frequency = own.fundamental.upper_f64();
        let speed = |(k, [a, b]): (usize, &[Vec<Rational>; 2])| {
            (k + 1) as f64 * frequency * a.iter().chain(b).map(|part| part.to_f64().abs()).sum::<f64>()
        };
        let velocity = trial.states.harmonics.iter().enumerate().map(speed).sum::<f64>();
        let scale = own.inverse.iter().flatten().map(|entry| entry.to_f64().abs()).fold(0.0, f64::max);
        let of_slope = if self.or_more { SMALL * q * frequency } else { f64::INFINITY };
        let enough = [SMALL * velocity * scale, SMALL * q, of_slope];
        let [d_x, d_q, d_t] = trial.defects(plant, &coordinates, enough).ok()?;
        let d_q = d_q + trial.mismatch(&own);
        let moved = plant.with_error_moved(&trial.error);
        let region = Region::new(l.clone(), trial.states.clone(), Rational::new()).ok()?;
        let rows = l.iter().map(|row| row.iter().map(Rational::to_f64).collect()).collect();
        let samples = FloatSuprema::new(&moved, FloatCurve::from(&trial.states), rows, [None; 2]);
        let engine = Engine::new(&moved, region, None, None).ok()?;
        let exact = |value: &Rational| Enclosure::from_rational(value, PRECISION);
        let start = Start { x0: exact(&set.x0), e0: exact(&set.e0), z0: set.z0.as_ref().map(exact) };
        let period = plant.period.nominal().enclose(PRECISION);
        let short = |defect: &Enclosure| up(defect.upper_f64(), SHORT);
        let defects = [short(&d_x)?, short(&d_q)?, short(&d_t)?];
        let mut prepared = Prepared { trial, own, period, start, engine, samples, defects, distances: [0.0; 3] };
        let sizes = Concluded::sizes_of(&prepared.trial, &self.known(&prepared))?;
        let distances = prepared.start.distances(&prepared.own, sizes.each_ref());
        prepared.distances = distances.map(|size| size.upper_f64());
        Some(prepared)
    }

    fn program(&self, prepared: &Prepared, reach: Option<f64>) -> PeakProgram {
        let own = &prepared.own;
        PeakProgram {
            points: Vec::new(),
            gain: [1.0; 2],
            sigma: own.sigma.midpoint_f64(),
            mu: own.mu.midpoint_f64(),
            n_bar_squared: own.n_bar_squared.midpoint_f64(),
            start: prepared.distances,
            joint: true,
            reach,
        }
    }

    /// The box that solutions from the set do not leave, with the smallest peak that is found, and forms on it; along x first with that eta.
    fn peak_box(&self, prepared: &Prepared, margin: f64, x_first: Option<f64>) -> Option<([f64; 2], Vec<FallingForm>)> {
        let [d_x, d_e, _] = prepared.distances;
        let has_states = self.asked.plant.states() > 0;
        let reaches = if has_states { &REACHES[..] } else { &REACHES[..1] };
        let mut best: Option<([f64; 2], FallingForm)> = None;
        let found_on = |at: [f64; 2], asked: (f64, LookedAt)| {
            let share = if x_first.is_some() { 1.0 / ROOMY } else { FILLED };
            let mut program = self.program(prepared, has_states.then_some(share * at[0]));
            let asked = (PeakOf::Error, asked.0, asked.1);
            prepared.samples.propose_peak(PeakBox { at, x_first }, &mut program, asked)
        };
        let fitted = |x: f64, mut e: f64, asked: (f64, LookedAt)| {
            if x_first.is_some() {
                let found = found_on([x, e], asked)?;
                return Some(([x, ROOMY * found.level.sqrt()], found));
            }
            let mut kept: Option<([f64; 2], FallingForm)> = None;
            for _ in 0..FITS {
                let Some(found) = found_on([x, e], asked) else { break };
                let peak = found.level.sqrt();
                let fits = peak <= FILLED * e;
                let settled = kept.as_ref().is_some_and(|(_, known)| !fits || found.level > SETTLED * known.level);
                if fits {
                    kept = Some(([x, e], found));
                }
                // A smaller box has a smaller peak.
                e = if kept.is_some() { SMALLER * peak / FILLED } else { LARGER * peak };
                if settled {
                    break;
                }
            }
            kept
        };
        let first = if x_first.is_some() { FAR } else { FIRST };
        for reach in reaches {
            let found = fitted(if has_states { reach * d_x } else { 0.0 }, first * d_e, (margin, LookedAt::Grid));
            let (known, found) = (best.take(), found);
            // Once they are worse, those further out are too.
            let worse = known.as_ref().zip(found.as_ref()).is_some_and(|(known, found)| found.1.level > known.1.level);
            best = if worse { known } else { found.or(known) };
            if worse {
                break;
            }
        }
        let ([x, e], _) = best?;
        let (radii, first) = fitted(x, e, (margin, LookedAt::Between))?;
        let mut program = self.program(prepared, None);
        let asked = (PeakOf::Control, margin, LookedAt::Between);
        let second = prepared.samples.propose_peak(PeakBox { at: radii, x_first }, &mut program, asked);
        Some((radii, std::iter::once(first).chain(second).collect()))
    }

    /// A box that is small beside the trial, and a form on it.
    fn small_box(&self, prepared: &Prepared, share: f64) -> Option<([f64; 2], FallingForm)> {
        let radii = [0, 1].map(|i| share * prepared.distances[i]);
        let place = PeakBox { at: radii, x_first: None };
        // The larger the margins are, the nearer is the solution to the trial.
        let found = |margin: f64| {
            let asked = (PeakOf::Error, margin, LookedAt::Grid);
            prepared.samples.propose_peak(place, &mut self.program(prepared, None), asked)
        };
        Some((radii, WIDE_MARGINS.into_iter().chain(MARGINS).find_map(found)?))
    }

    /// What is proved on a box: at least the first form.
    fn proof(&self, prepared: &Prepared, [x, e]: [Rational; 2], mut forms: Vec<(Metric, Level)>) -> Option<TubeProof> {
        let Prepared { engine, samples, .. } = prepared;
        let has_states = self.asked.plant.states() > 0;
        self.in_domain(prepared, [&x, &e])?;
        engine.smooth(&x, &e).ok()?;
        let decided = |(metric, level): &(Metric, Level)| {
            engine.decide_form((metric, level), self.asked.sigma, [&x, &e], EFFORT).truth.is_true()
        };
        // The box is that of the first.
        let holds: Vec<bool> = forms.iter().map(decided).collect();
        holds.first().filter(|first| **first)?;
        let mut holds = holds.into_iter();
        forms.retain(|_| holds.next() == Some(true));
        let first = forms.first()?;
        let slope = |bound| prove_value(engine, samples, bound, &x, &e).map(|proved| proved.value);
        let of_states = |bound| if has_states { slope(bound) } else { Some(Rational::new()) };
        let slopes = [of_states(Bound::Qx)?, slope(Bound::Qe)?];
        let [d_x, d_q, d_t] = prepared.defects.clone();
        let or_more = match self.or_more {
            false => None,
            true => Some(OrMore {
                defect_t: d_t,
                in_time: [of_states(Bound::Qtx)?, slope(Bound::Qte)?],
                states: [of_states(Bound::Fx)?, of_states(Bound::Fe)?],
            }),
        };
        let states = match has_states {
            false => None,
            true => {
                let form = self.states_form(samples, first, [&x, &e])?;
                engine.decide_states(&form, [&x, &e], EFFORT).truth.is_true().then_some(())?;
                Some(form)
            }
        };
        Some(TubeProof { defects: [d_x, d_q], radii: [x, e], slopes, forms, states, or_more, x_first: None })
    }

    /// That the box lies where the model holds.
    fn in_domain(&self, prepared: &Prepared, [x, e]: [&Rational; 2]) -> Option<()> {
        let Some(domain) = &self.asked.spec.domain else { return Some(()) };
        let [of_x, of_e, _] = Concluded::sizes_of(&prepared.trial, &self.known(prepared))?;
        let reach = [(of_x, x, &domain.x), (of_e, e, &domain.e)];
        let within = |(size, radius, end): &(Enclosure, &Rational, &sigmastar_lang::spec::Constant)| {
            (size + Enclosure::from_rational(radius, PRECISION)).le(&end.enclose(PRECISION)).is_true()
        };
        reach.iter().all(within).then_some(())
    }

    /// (14.4b) with the P of a form.
    fn states_form(
        &self,
        samples: &FloatSuprema,
        (metric, level): &(Metric, Level),
        [x, e]: [&Rational; 2],
    ) -> Option<StatesForm> {
        let pushed = samples.refined(Bound::Fe, x.to_f64(), e.to_f64()).value;
        let c_x = metric.c_x.to_f64();
        let p_up = level.p_up.to_f64();
        // |P g|^2 <= gamma (c_x - 2 c).
        let gamma = 2.2 * (p_up * pushed) * (p_up * pushed) / c_x;
        Some(StatesForm {
            matrix: metric.matrix.clone(),
            q_low: level.x_low.clone(),
            q_up: level.p_up.clone(),
            c: round_rational(&Rational::from(&metric.c_x / 4u32), DIGITS, Direction::Down),
            gamma: up(gamma, SHORT)?,
        })
    }
}

/// The shares of the distances of the start that a box has around a trial of which nothing is known further away, in turn.
const SMALL_BOXES: [f64; 2] = [1e-4, 1e-2];

/// The share of that of e that eta is.
const SMALL_ETA: f64 = 1e-4;

/// A row of a matrix in short numbers.
fn short_row(row: &Vec<f64>) -> Option<Vec<Rational>> {
    row.iter().map(|entry| round_f64(*entry, DIGITS, Direction::Nearest)).collect()
}

/// A form in short numbers.
fn rounded(form: &FallingForm) -> Option<(Metric, Level)> {
    let FallingForm { matrix, cross, weight, k_p, p_up, x_low, e_low, margins, .. } = form;
    let short = |value: f64| round_f64(value, DIGITS, Direction::Nearest);
    let [c_x, c_e, c_y] = margins.map(|margin| round_f64(KEPT * margin, SHORT, Direction::Down));
    let has_states = !matrix.is_empty();
    let metric = Metric {
        matrix: matrix.iter().map(short_row).collect::<Option<_>>()?,
        cross: short_row(cross)?,
        weight: short(*weight)?,
        k_p: short(*k_p)?,
        c_x: if has_states { c_x? } else { Rational::from(1) },
        c_e: c_e?,
        c_y: c_y?,
    };
    let level = Level {
        p_up: round_f64(if has_states { p_up * (1.0 + ROOM) } else { 1.0 }, DIGITS, Direction::Up)?,
        x_low: round_f64(x_low * (1.0 - ROOM), DIGITS, Direction::Down)?,
        e_low: round_f64(e_low * (1.0 - ROOM), DIGITS, Direction::Down)?,
    };
    Some((metric, level))
}
