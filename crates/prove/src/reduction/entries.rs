//! The arguments at which the sharp derivation uses a bound, and the proof of each value.

use super::refusal::PlantRefusal;
use super::watch::{Stage, Watch};
use crate::attempt::{prove_existence, prove_inequality, prove_sampled_existence, prove_value};
use rug::Rational;
use sigmastar_decide::bounds::Engine;
use sigmastar_exact::enclosure::Truth;
use sigmastar_exact::number::{Direction, Portable, round_f64};
use sigmastar_exact::parallel;
use sigmastar_lang::spec::{
    Bound, Constant, ExistenceInequality, JointInequality, MatrixInequality, ProvedValue, ProvedValues,
    SampledExistence, SampledInequalities, SampledInequality, Splitting,
};
use sigmastar_propose::bounds::{EnergyWeights, FloatSuprema};
use sigmastar_propose::search::{AtSigma, ByEnergy, ByMatrix, FloatModel, PeriodicSet, SHARE, active_level, weight_h};
use sigmastar_theory::derivation::paths::{Path, Paths};
use sigmastar_theory::evidence::{Entry, TABLE};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Significant digits of an argument.
const DIGITS: u32 = 8;

/// What is tried, as powers of ten, where a bound that is 0 on the orbit itself is so small that nothing sets its size.
const SMALL: [i32; 8] = [-15, -12, -9, -6, -3, 0, 3, 6];

/// Without states a bound holds for every X, and is stated so far: the shape of an error box is then free.
const WITHOUT_STATES: u32 = 1_000_000;

/// Boxes that a proof of a small value may take.
const SMALL_EFFORT: usize = 1 << 10;

/// Boxes that a proof of a given value may take.
const EFFORT: usize = 1 << 18;

/// Boxes that a proof of the inequality of stability at samples may take at either end of a sample.
const SAMPLED_EFFORT: usize = 20_000;

/// The arguments, rounded up.
pub struct Needed {
    x_p: Rational,
    e_p: Rational,
    x_per: Rational,
    e_per: Rational,
    x_b: Rational,
    e_b: Rational,
    paths: Paths,
    /// Whether existence has a rate of its own.
    second: bool,
    /// The matrix inequality of stability without its threshold, where there is one.
    inequality: Option<MatrixInequality>,
    /// That of existence without c_y.
    existence: Option<ExistenceInequality>,
    /// Whether a joint inequality proves stability.
    by_joint: bool,
    /// Those of the regulator at samples, that of existence without gamma.
    at_samples: SampledInequalities,
}

/// Those of a candidate, enlarged by a share; sigma is the gain that is aimed at.
pub(super) fn needed(
    model: &FloatModel,
    set: &PeriodicSet,
    at: &AtSigma,
    enlarged: f64,
    (second, sigma): (bool, f64),
) -> Option<Needed> {
    let up = |value: f64| round_f64(value * (1.0 + enlarged), DIGITS, Direction::Up).filter(|value| *value >= 0);
    let level = active_level(at.eta, at.dist_e, at.rho);
    let d_e = level.sqrt();
    let (x_b, e_b) = (up(set.x_per + at.d_x)?, up(set.e_per + d_e)?);
    let (x_per, e_per) = (up(set.x_per)?, up(set.e_per)?);
    // S is sought with the threshold.
    let split = |path: Path, matrix: &[Vec<Rational>]| Splitting {
        e: path.e_of_dx(&e_per, &e_b).clone(),
        x: path.x_of_de(&x_per, &x_b).clone(),
        matrix: matrix.to_vec(),
    };
    let inequality = match &model.by_matrix {
        Some(ByMatrix::Sampled { path, rate, .. }) => {
            let short = |value: f64, digits: u32| round_f64(value, digits, Direction::Nearest);
            Some(MatrixInequality {
                x: x_b.clone(),
                e: e_b.clone(),
                w_x: short(level / (model.p_low * at.d_x * at.d_x), DIGITS)?,
                h: short(weight_h(at.eta, at.dist_e, at.dist_z), DIGITS)?,
                rate: short(*rate, 1)?,
                value: Rational::new(),
                splitting: (*path != Path::Straight).then(|| split(*path, &[])),
            })
        }
        // Its arguments are enlarged; its weights stay.
        Some(ByMatrix::Proved(known)) => {
            let splitting = known.splitting.as_ref().map(|known| split(at.paths.common(), &known.matrix));
            Some(MatrixInequality { x: x_b.clone(), e: e_b.clone(), splitting, ..known.as_ref().clone() })
        }
        Some(ByMatrix::Joint(_)) | None => None,
    };
    let (x_p, e_p) = (up(set.x_p)?, up(set.e_p)?);
    let existence = match &model.by_energy {
        Some(ByEnergy::Sampled { weights, .. }) => Some(existence([&x_p, &e_p], weights, SHARE * sigma)?),
        // Its arguments are enlarged; its numbers stay.
        Some(ByEnergy::Proved(known)) => {
            Some(ExistenceInequality { x: x_p.clone(), e: e_p.clone(), ..known.as_ref().clone() })
        }
        Some(ByEnergy::Joint(_)) | None => None,
    };
    let by_joint = matches!(model.by_matrix, Some(ByMatrix::Joint(_)));
    let at_samples = SampledInequalities::default();
    Some(Needed {
        x_p,
        e_p,
        x_per,
        e_per,
        x_b,
        e_b,
        paths: at.paths,
        second,
        inequality,
        existence,
        by_joint,
        at_samples,
    })
}

/// The inequality of existence with short numbers, without c_y.
fn existence([x_p, e_p]: [&Rational; 2], weights: &EnergyWeights, value: f64) -> Option<ExistenceInequality> {
    let EnergyWeights { p, k_p, c_x, .. } = weights;
    let short = |value: f64| round_f64(value, DIGITS, Direction::Nearest);
    let row = |row: &Vec<f64>| row.iter().map(|entry| short(*entry)).collect::<Option<Vec<Rational>>>();
    Some(ExistenceInequality {
        x: x_p.clone(),
        e: e_p.clone(),
        matrix: p.iter().map(row).collect::<Option<_>>()?,
        k_p: short(*k_p)?,
        c_x: round_f64(*c_x, 3, Direction::Down)?,
        c_y: Rational::new(),
        value: short(value)?,
    })
}

impl Needed {
    /// With matrix inequalities of the regulator at samples, on the sets that are asked for here.
    pub(super) fn with_sampled(self, SampledInequalities { stability, existence }: SampledInequalities) -> Needed {
        let Needed { x_p, e_p, x_b, e_b, .. } = &self;
        let at_samples = SampledInequalities {
            stability: stability.map(|known| SampledInequality { x: x_b.clone(), e: e_b.clone(), ..known }),
            existence: existence.map(|known| SampledExistence { x: x_p.clone(), e: e_p.clone(), ..known }),
        };
        Needed { at_samples, ..self }
    }

    /// The largest X and E.
    pub(super) fn largest(&self) -> [Rational; 2] {
        let larger = |a: &Rational, b: &Rational| if a > b { a.clone() } else { b.clone() };
        [larger(&self.x_p, &self.x_b), larger(&self.e_p, &self.e_b)]
    }

    /// With every X as far as nothing is in the way of it where there are no states.
    fn without_states(&self) -> Needed {
        let far = |x: &Rational| Rational::from(x * WITHOUT_STATES);
        let Needed { e_p, e_per, e_b, paths, second, by_joint, .. } = self;
        let inequality = self.inequality.clone().map(|known| MatrixInequality { x: far(&known.x), ..known });
        let existence = self.existence.clone().map(|known| ExistenceInequality { x: far(&known.x), ..known });
        let SampledInequalities { stability: of_box, existence: of_set } = self.at_samples.clone();
        let at_samples = SampledInequalities {
            stability: of_box.map(|known| SampledInequality { x: far(&known.x), ..known }),
            existence: of_set.map(|known| SampledExistence { x: far(&known.x), ..known }),
        };
        Needed {
            x_p: far(&self.x_p),
            x_per: far(&self.x_per),
            x_b: far(&self.x_b),
            e_p: e_p.clone(),
            e_per: e_per.clone(),
            e_b: e_b.clone(),
            paths: *paths,
            second: *second,
            by_joint: *by_joint,
            inequality,
            existence,
            at_samples,
        }
    }

    /// Which bound is used where (derivation, 11.3).
    fn list(&self) -> Vec<(Bound, Rational, Rational)> {
        let Needed { x_p, e_p, second, .. } = self;
        let of_existence = if *second { Bound::RateExistence } else { Bound::Rate };
        let zero = Rational::new();
        let mut list = vec![(Bound::Fx, x_p, &zero), (of_existence, x_p, &zero)];
        list.extend([Bound::Fe, Bound::Qx, Bound::Qe, Bound::QeMax].map(|bound| (bound, x_p, e_p)));
        list.extend([(Bound::Qtx, x_p, e_p), (Bound::Qte, x_p, e_p)]);
        list.into_iter().map(|(bound, x, e)| (bound, x.clone(), e.clone())).collect()
    }

    /// Those of the error box: C5 uses them, or, where a matrix inequality stands in its place, nothing but what is said beside the
    /// claim (rates of convergence).
    fn of_error_box(&self) -> Vec<(Bound, Rational, Rational)> {
        let Needed { x_per, e_per, x_b, e_b, paths: Paths { f, q }, .. } = self;
        let mut list = vec![(Bound::Rate, x_b, f.e_of_dx(e_per, e_b)), (Bound::Fe, f.x_of_de(x_per, x_b), e_b)];
        list.push((Bound::Qx, x_b, q.e_of_dx(e_per, e_b)));
        list.extend([Bound::Qe, Bound::QeMax].map(|bound| (bound, q.x_of_de(x_per, x_b), e_b)));
        list.into_iter().map(|(bound, x, e)| (bound, x.clone(), e.clone())).collect()
    }
}

/// Proves a value for each argument; without states the bounds of x are 0, and the rate is any number.
///
/// # Errors
/// The first bound for which none is proved.
pub(super) fn prove_all(
    engine: &Engine,
    suprema: &FloatSuprema,
    needed: &Needed,
    (mu, tried): (&Constant, &AtomicUsize),
    watch: &dyn Watch,
) -> Result<ProvedValues, PlantRefusal> {
    watch.enter(Stage::Bounds);
    let wide = (engine.states() == 0).then(|| needed.without_states());
    let needed = wide.as_ref().unwrap_or(needed);
    let inequality = || match &needed.inequality {
        None => Ok(None),
        Some(wanted) => {
            let mut failed = tried.load(Ordering::Relaxed);
            let proved = prove_inequality(engine, suprema, wanted, mu, &mut failed);
            tried.store(failed, Ordering::Relaxed);
            proved.map(Some).ok_or_else(|| not_proved("stability", [&wanted.x, &wanted.e]))
        }
    };
    let existence = || match &needed.existence {
        None => Ok(None),
        Some(wanted) => {
            let proved = prove_existence(engine, suprema, wanted);
            proved.map(Some).ok_or_else(|| not_proved("existence", [&wanted.x, &wanted.e]))
        }
    };
    let (inequality, existence) = rayon::join(inequality, existence);
    let (inequality, existence) = (inequality?, existence?);
    let at_samples = prove_at_samples(engine, suprema, &needed.at_samples)?;
    let asked = needed.list().into_iter().map(|entry| (entry, true));
    let by_norms = inequality.is_none() && !needed.by_joint && at_samples.stability.is_none();
    let beside = needed.of_error_box().into_iter().map(|entry| (entry, by_norms));
    let all: Vec<_> = asked.chain(beside).collect();
    let (done, count) = (AtomicUsize::new(0), all.len());
    let prove = |((bound, x, e), is_used): &((Bound, Rational, Rational), bool)| {
        let value = value_of(engine, suprema, *bound, [x.clone(), e.clone()]);
        watch.part(done.fetch_add(1, Ordering::Relaxed) + 1, count);
        (value, *is_used)
    };
    let proofs = parallel::map(&all, prove);
    // What no condition uses may be missing.
    let proofs = proofs.into_iter().filter(|(proof, is_used)| *is_used || proof.is_ok()).map(|(proof, _)| proof);
    let entries = proofs.collect::<Result<_, _>>()?;
    Ok(ProvedValues { entries, inequality, existence, at_samples, ..ProvedValues::default() })
}

/// Proves the matrix inequalities of the regulator at samples; gamma is sought.
fn prove_at_samples(
    engine: &Engine,
    suprema: &FloatSuprema,
    SampledInequalities { stability, existence }: &SampledInequalities,
) -> Result<SampledInequalities, PlantRefusal> {
    if let Some(wanted) = stability {
        held("stability", [&wanted.x, &wanted.e], engine.decide_sampled(wanted, SAMPLED_EFFORT).truth)?;
    }
    let existence = match existence {
        None => None,
        Some(wanted) => {
            let proved = prove_sampled_existence(engine, suprema, wanted);
            Some(proved.ok_or_else(|| not_proved("existence", [&wanted.x, &wanted.e]))?)
        }
    };
    Ok(SampledInequalities { stability: stability.clone(), existence })
}

/// The value of a bound at one argument.
fn value_of(
    engine: &Engine,
    suprema: &FloatSuprema,
    bound: Bound,
    [x, e]: [Rational; 2],
) -> Result<ProvedValue, PlantRefusal> {
    let stateless = engine.states() == 0;
    let refusal = || PlantRefusal::NotProved { bound: bound.field(), at: [x.to_f64(), e.to_f64()] };
    let (value, sampled) = match prove_value(engine, suprema, bound, &x, &e) {
        Some(proved) => (proved.value, Rational::from_f64(proved.sampled)),
        // Without states every rate is as good as any other, and the checker asks for none.
        None if bound.is_rate() && stateless => (Rational::from(1), None),
        None if bound.is_rate() => return Err(refusal()),
        None => (smallest(engine, bound, [&x, &e]).ok_or_else(refusal)?, None),
    };
    Ok(ProvedValue { bound, x, e, value, sampled })
}

fn not_proved(bound: &'static str, [x, e]: [&Rational; 2]) -> PlantRefusal {
    PlantRefusal::NotProved { bound, at: [x.to_f64(), e.to_f64()] }
}

/// That what was decided holds.
fn held(bound: &'static str, at: [&Rational; 2], truth: Truth) -> Result<(), PlantRefusal> {
    if truth.is_true() { Ok(()) } else { Err(not_proved(bound, at)) }
}

/// What a small value is multiplied with, so that another program proves it, whose bound of x_0' may be coarser.
const ROOM: u32 = 1000;

/// The smallest power of ten that is proved, with room; not of a rate.
fn smallest(engine: &Engine, bound: Bound, [x, e]: [&Rational; 2]) -> Option<Rational> {
    SMALL.into_iter().find_map(|exponent| {
        let value = round_f64(10f64.portable_powi(exponent), 1, Direction::Up)?;
        let entry = Entry { bound, x: x.clone(), e: e.clone(), value };
        engine.decide(&entry, SMALL_EFFORT).truth.is_true().then(|| entry.value * ROOM)
    })
}

/// Decides given values.
///
/// # Errors
/// The first that is not proved.
pub(super) fn decide_all(engine: &Engine, values: &ProvedValues, mu: &Constant) -> Result<(), PlantRefusal> {
    if let Some(known) = &values.inequality {
        held("stability", [&known.x, &known.e], engine.decide_inequality(known, mu, EFFORT).truth)?;
    }
    if let Some(known) = &values.existence {
        held("existence", [&known.x, &known.e], engine.decide_existence(known, EFFORT).truth)?;
    }
    let SampledInequalities { stability, existence } = &values.at_samples;
    if let Some(known) = stability {
        held("stability", [&known.x, &known.e], engine.decide_sampled(known, EFFORT).truth)?;
    }
    if let Some(known) = existence {
        held("existence", [&known.x, &known.e], engine.decide_sampled_existence(known, EFFORT).truth)?;
    }
    if let Some(joint) = &values.joint_stability {
        let JointInequality { x, e, .. } = &joint.inequality;
        held("joint stability", [x, e], engine.decide_joint_stability(joint, EFFORT).truth)?;
    }
    if let Some(joint) = &values.joint_existence {
        held("joint existence", [&joint.x, &joint.e], engine.decide_joint(joint, EFFORT).truth)?;
    }
    let held = parallel::map(&values.entries, |ProvedValue { bound, x, e, value, .. }| {
        let refusal = || PlantRefusal::NotProved { bound: bound.field(), at: [x.to_f64(), e.to_f64()] };
        if !TABLE.contains(bound) {
            return Err(refusal());
        }
        if bound.is_rate() && engine.states() == 0 {
            return Ok(());
        }
        let entry = Entry { bound: *bound, x: x.clone(), e: e.clone(), value: value.clone() };
        if engine.decide(&entry, EFFORT).truth.is_true() { Ok(()) } else { Err(refusal()) }
    });
    held.into_iter().collect()
}
