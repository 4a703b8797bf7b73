//! Rule: the embedded specification is well-formed (docs/guide.md), and its data lie in their ranges (docs/mathematics.md, section 1).
//!
//! Guarantee: no unknown field, every number exact, T, w, mu, alpha, P_low > 0, P_up >= P_low, weights with W1-W3
//! ([`crate::weights`]), `matched` only where base_frequency * period = 2 pi exactly, and `sampling_period` only with it and
//! where period / sampling_period is a whole number >= 2 exactly.

use crate::actuator::{self, Actuator};
use crate::bound::{BOUND_NAMES, BOUNDS, REQUIRED};
use crate::constant::{Constant, Number, PRECISIONS, RULE, expression, positive, positive_with};
use crate::exact::Exact;
use crate::expr::{ARGUMENTS, Expr, Named, Written};
use crate::input_gain;
use crate::interval::Interval;
use crate::jacobian::{self, Jacobian};
use crate::json::{Field, Fields};
use crate::noise::Noise;
use crate::period::{self, Period};
use crate::plant::OfPlant;
use crate::range::Range;
use crate::scope::Scope;
use crate::verdict::{Outcome, bad, demand};
use crate::weights::Weights;
use rug::{Integer, Rational};

/// q(t,0,0) = sum over |k| <= K of c_k e^{i k Om t} + rest (docs/mathematics.md, section 10.1).
#[derive(Clone, Debug)]
pub struct Forcing {
    /// Bounds of |c_0|, ..., |c_K|.
    pub harmonics: Vec<Size>,
    /// A bound of rms(rest).
    pub rest_rms: Size,
    /// A bound of rms(rest'), if given.
    pub rest_t_rms: Option<Size>,
}

/// A number that is not negative: as a specification has it, or as it follows from a plant's witness.
#[derive(Clone, Debug)]
pub enum Size {
    Constant(Constant),
    Number(Rational),
    /// The root of this number.
    Root(Rational),
}

impl Size {
    /// An enclosure, without what may lie below 0.
    pub fn enclose(&self, precision: u32) -> Interval {
        let value = match self {
            Size::Constant(constant) => constant.enclose(precision),
            Size::Number(value) => Interval::rational(value, precision),
            Size::Root(square) => Interval::rational(square, precision).sqrt(),
        };
        value.max(&Interval::int(0, precision))
    }
}

/// The most harmonics that are read.
const MAX_HARMONICS: usize = 1000;

/// The set of initial conditions that is asked for.
#[derive(Clone, Debug)]
pub enum AskedSet {
    /// X0 = 2 X_p, E0 = 2 E_p, Z0 = 2 (Z + Nbar E_p).
    Paper,
    /// Z0 = 0; X0, E0 given or 2 X_p, 2 E_p.
    AtRest([Option<Constant>; 2]),
    /// z = M e at the first instant of the regulator; X0, E0 given or 2 X_p, 2 E_p.
    Aligned([Option<Constant>; 2]),
    /// X0, E0, Z0 given.
    Box([Constant; 3]),
}

/// A specification that satisfies this rule.
#[derive(Clone, Debug)]
pub struct Specification {
    pub period: Period,
    pub p_low: Constant,
    pub p_up: Constant,
    pub alpha: Constant,
    /// The Jacobian that stands in place of the triple, with what proves the triple.
    pub jacobian: Option<(Jacobian, jacobian::Witness)>,
    /// With a Jacobian: what proves a second triple for it, which serves for existence, and that triple.
    pub existence: Option<(jacobian::Witness, [Constant; 3])>,
    /// The contraction rate a(X, E), for the P of a triple that is given.
    pub rate: Option<Expr>,
    pub regulator: InternalModel,
    pub bounds: [Option<Expr>; BOUNDS],
    pub q_0: Option<Forcing>,
    pub domain: Option<[Constant; 2]>,
    pub initial_set: AskedSet,
    /// The gain of the actuator signal, where it need not be 1.
    pub input_gain: Option<Range>,
    /// What the actuator takes, where the claim keeps to it.
    pub actuator: Option<Actuator>,
    /// Noise and disturbance, of which what is said of given n_o speaks alone.
    pub noise: Noise,
    /// Where the specification is a plant's formulas: what is known of them.
    pub plant: Option<Box<OfPlant>>,
}

/// The regulator, as far as it is given.
#[derive(Clone, Debug)]
pub struct InternalModel {
    pub mu: Constant,
    pub base_frequency: Constant,
    pub matched: bool,
    /// N_s = T/h, where a sampling period is given: a claim in continuous time does not use it.
    pub samples: Option<Integer>,
    /// `delay_samples`: whether a control is computed in the sample before it acts.
    pub delayed: bool,
    /// Which oscillators the claim has to be about, where the file says it.
    pub harmonics: Option<Scope>,
    pub weights: Weights,
}

/// `N_s = period / sampling`, a whole number >= 2 exactly; without exact forms nothing is known.
pub fn samples(period: &Constant, sampling: &Constant, pointer: &str) -> Outcome<Integer> {
    let inverse = sampling.exact.as_ref().and_then(Exact::recip);
    let ratio = period.exact.as_ref().zip(inverse).and_then(|(period, inverse)| period.mul(&inverse));
    let whole = ratio.as_ref().map(|ratio| ratio.as_rational().filter(|q| *q.denom() == 1 && *q >= 2));
    demand(whole.as_ref().map(Option::is_some), RULE, pointer, "period / sampling_period is a whole number >= 2")?;
    whole.flatten().map_or_else(|| bad(pointer, "this is no part of the period"), |q| Ok(q.into_numer_denom().0))
}

/// Reads `sampling_period`, if it is given.
fn read_samples(
    fields: &mut Fields<'_>,
    period: &Period,
    matched: bool,
    constants: &[Named],
) -> Outcome<Option<Integer>> {
    let Some(field) = fields.optional("sampling_period") else { return Ok(None) };
    let sampling = positive_with(&field, "sampling_period", constants)?;
    let period = period.demand_exact(&field.pointer, "a sampling period")?;
    demand(Some(matched), RULE, &field.pointer, "a sampling period needs `matched`")?;
    samples(period, &sampling, &field.pointer).map(Some)
}

/// `delay_samples`: 0 or 1.
pub fn read_delay(field: &Field<'_>) -> Outcome<bool> {
    match field.whole()? {
        0 => Ok(false),
        1 => Ok(true),
        _ => bad(&field.pointer, "expected 0 or 1"),
    }
}

fn nonnegative(field: &Field<'_>, constants: &[Named]) -> Outcome<Constant> {
    let constant = Constant::read_with(field, constants)?;
    let truth = Number::rational(Rational::new()).le(&constant.number());
    demand(truth, RULE, &field.pointer, "the number is nonnegative").map(|()| constant)
}

impl Specification {
    /// Reads and checks the embedded specification. With a Jacobian, the triple is the field `lyapunov` of the witness, and a second
    /// one may be its field `lyapunov_existence`; both are taken out, and their proof (the crate `proofs-plants`) is left to be done.
    pub fn read(field: &Field<'_>, witness: &mut Fields<'_>) -> Outcome<Specification> {
        let mut file = field.fields()?;
        header(&mut file, "sigmastar/bounding-spec")?;
        words(&mut file)?;
        let period = Period::read(&mut file, &[])?;

        let mut fields = file.required("lyapunov")?.fields()?;
        let (jacobian, [p_low, p_up, alpha]) = match fields.optional("jacobian") {
            None => (None, ["p_low", "p_up", "alpha"].map(|name| positive(&mut fields, name))),
            Some(field) => {
                let jacobian = jacobian::read(&field, &period)?;
                let (witness, triple) = jacobian::Witness::read(&witness.required("lyapunov")?, jacobian.len())?;
                (Some((jacobian, witness)), triple.map(Ok))
            }
        };
        let (p_low, p_up, alpha) = (p_low?, p_up?, alpha?);
        demand(p_low.number().le(&p_up.number()), RULE, &fields.pointer, "p_low <= p_up")?;
        // The P that is found for a Jacobian is not known to whoever states a rate.
        let (existence, rate) = match &jacobian {
            None => (None, fields.part("rate", |field| expression(field, ARGUMENTS))?),
            Some((rows, _)) => {
                let second = |field: &Field<'_>| jacobian::Witness::read(field, rows.len());
                (witness.part("lyapunov_existence", second)?, None)
            }
        };
        fields.finish()?;

        let mut functions = file.required("bounds")?.fields()?;
        let mut bounds: [Option<Expr>; BOUNDS] = Default::default();
        for (index, (name, bound)) in BOUND_NAMES.iter().zip(&mut bounds).enumerate() {
            let field = if index < REQUIRED { Some(functions.required(name)?) } else { functions.optional(name) };
            *bound = field.map(|field| expression(&field, ARGUMENTS)).transpose()?;
        }
        functions.finish()?;
        let q_0 = file.part("q_0", read_forcing)?;
        let ends = |fields: &mut Fields<'_>| Ok([positive(fields, "X")?, positive(fields, "E")?]);
        let domain = file.part("domain", |field| field.object(ends))?;
        let regulator = InternalModel::read(&file.required("internal_model")?, &period, &[])?;
        let (initial_set, _) = read_set(&file.required("initial_set")?, (false, false), &[])?;
        let input_gain = input_gain::read(&mut file, &[], &[])?;
        let actuator = actuator::read(&mut file, &[], false)?;
        let noise = Noise::read(&mut file)?;
        file.part("relative_degree", filter)?;
        file.finish()?;
        Ok(Specification {
            period,
            p_low,
            p_up,
            alpha,
            jacobian,
            existence,
            rate,
            regulator,
            bounds,
            q_0,
            domain,
            initial_set,
            input_gain,
            actuator,
            noise,
            plant: None,
        })
    }
}

impl Specification {
    /// What a claim says of the file besides the gain, for either regulator.
    pub fn in_words(&self) -> String {
        format!(
            "{}{}, with {}, mu = {} and base frequency {}",
            input_gain::in_words(self.input_gain.as_ref()),
            actuator::in_words(self.actuator.as_ref()),
            period::in_words(&self.period),
            self.regulator.mu.words,
            self.regulator.base_frequency.words,
        )
    }
}

impl InternalModel {
    /// Reads `internal_model`; `matched` only where base_frequency * period = 2 pi exactly. Names of a plant's constants may stand in
    /// mu, the base frequency and the sampling period.
    pub fn read(field: &Field<'_>, period: &Period, constants: &[Named]) -> Outcome<InternalModel> {
        let mut model = field.fields()?;
        let mut read = |name| positive_with(&model.required(name)?, name, constants);
        let (mu, base_frequency) = (read("mu")?, read("base_frequency")?);
        let matched = model.part("matched", Field::truth)?.unwrap_or_default();
        let weights = Weights::read(&model.required("weights")?)?;
        if matched {
            let pointer = format!("{}/matched", model.pointer);
            let period = period.demand_exact(&pointer, "`matched`")?;
            let product = base_frequency.number().times(period.number());
            let two_pi = Exact::rational(&Rational::from(2)).and_then(|two| two.mul(&Exact::pi()));
            let equal = match (&product.exact, &two_pi) {
                (Some(a), Some(b)) => Some(a.equals(b)),
                // Disjoint enclosures refute; nothing else is proved without exact forms.
                _ => PRECISIONS.iter().find_map(|p| {
                    let (a, b) = ((product.enclose)(*p), Interval::pi(*p) * 2);
                    (a.lt(&b) == Some(true) || b.lt(&a) == Some(true)).then_some(false)
                }),
            };
            demand(equal, RULE, &pointer, "base_frequency * period = 2 pi")?;
        }
        let samples = read_samples(&mut model, period, matched, constants)?;
        let delayed = match model.optional("delay_samples") {
            None => false,
            Some(field) if samples.is_none() => return bad(&field.pointer, "it needs a sampling period"),
            Some(field) => read_delay(&field)?,
        };
        let harmonics = model.part("harmonics", |field| Scope::read(field, period))?;
        model.finish()?;
        Ok(InternalModel { mu, base_frequency, matched, samples, delayed, harmonics, weights })
    }
}

/// What `sigmastar certify` and `sigmastar design` tell with `--format json`.
const REPORTS: [&str; 2] = ["sigmastar/report", "sigmastar/design"];

/// `format` and `version` of a file.
pub fn header(file: &mut Fields<'_>, format: &str) -> Outcome<()> {
    let field = file.required("format")?;
    let found = field.text()?;
    if found != format {
        // What is to be certified, in the place of what was.
        let what = match (found, format) {
            ("sigmastar/plant", "sigmastar/certificate") => "a plant",
            ("sigmastar/bounding-spec", "sigmastar/certificate") => "a specification",
            (report, "sigmastar/certificate") if REPORTS.contains(&report) => {
                let why = "this is what `sigmastar` told of a claim, and its certificate is the file that `-o` writes";
                return bad(&field.pointer, format!("expected `{format}`; {why}"));
            }
            _ => return bad(&field.pointer, format!("expected `{format}`")),
        };
        let first =
            "is to be certified first: `sigmastar certify FILE -o CERTIFICATE`, and then the CERTIFICATE is checked";
        return bad(&field.pointer, format!("expected `{format}`; this is {what}, which {first}"));
    }
    let field = file.required("version")?;
    if field.whole()? == 1 { Ok(()) } else { bad(&field.pointer, "only version 1 is read") }
}

/// `name` and `description` of a file, of which nothing is used.
pub fn words(file: &mut Fields<'_>) -> Outcome<()> {
    file.required("name")?.text()?;
    file.part("description", |field| field.text()).map(drop)
}

fn read_forcing(field: &Field<'_>) -> Outcome<Forcing> {
    let size = |field: &Field<'_>| nonnegative(field, &[]).map(Size::Constant);
    field.object(|fields| {
        let list = fields.required("harmonics")?;
        if !(1..=MAX_HARMONICS).contains(&list.elements()?.len()) {
            return bad(&list.pointer, format!("expected 1 to {MAX_HARMONICS} harmonics"));
        }
        Ok(Forcing {
            harmonics: list.list(size)?,
            rest_rms: size(&fields.required("rest_rms")?)?,
            rest_t_rms: fields.part("rest_t_rms", size)?,
        })
    })
}

/// Reads the set that is asked for; that of a plant may have `ball` in the place of `X0`: then it is returned too. Names of the
/// plant's constants may stand in its numbers. Without states a box needs no `X0`: it is 0.
pub fn read_set(
    field: &Field<'_>,
    (of_plant, stateless): (bool, bool),
    constants: &[Named],
) -> Outcome<(AskedSet, Option<Constant>)> {
    let nonnegative = |field: &Field<'_>| nonnegative(field, constants);
    let mut fields = field.fields()?;
    let kind = fields.required("kind")?;
    let name = kind.text()?;
    let takes_ball = of_plant && matches!(name, "at-rest" | "aligned" | "box");
    let ball = if takes_ball { fields.part("ball", nonnegative)? } else { None };
    let set = match name {
        "paper" => AskedSet::Paper,
        "at-rest" | "aligned" => {
            let mut end = |name| fields.part(name, nonnegative);
            // Where there is a ball, `X0` is left to be refused as unknown.
            let sizes = [if ball.is_some() { None } else { end("X0")? }, end("E0")?];
            if name == "aligned" { AskedSet::Aligned(sizes) } else { AskedSet::AtRest(sizes) }
        }
        "box" => {
            let x0 = match &ball {
                Some(ball) => ball.clone(),
                None if stateless => {
                    let zero = || Written { text: "0".to_owned(), words: "0".to_owned() };
                    let stated = fields.part("X0", nonnegative)?;
                    stated.unwrap_or_else(|| Constant::standing_for(zero(), Rational::new()))
                }
                None => nonnegative(&fields.required("X0")?)?,
            };
            let mut end = |name| nonnegative(&fields.required(name)?);
            AskedSet::Box([x0, end("E0")?, end("Z0")?])
        }
        _ => return bad(&kind.pointer, "expected `paper`, `at-rest`, `aligned` or `box`"),
    };
    fields.finish()?;
    Ok((set, ball))
}

/// The filter e = xi_r + sum a_i xi_i: s^(r-1) + a_(r-1) s^(r-2) + ... + a_1 must be Hurwitz (docs/mathematics.md, section 6),
/// decided by Routh's array in rationals.
fn filter(field: &Field<'_>) -> Outcome<()> {
    let list = field.object(|fields| fields.required("a"))?;
    let elements = list.elements()?;
    if elements.is_empty() || elements.len() > 3 {
        return bad(&list.pointer, "expected 1 to 3 coefficients (relative degree 2 to 4)");
    }
    let mut coefficients = vec![Rational::from(1)];
    for element in elements.iter().rev() {
        match Constant::read(element)?.rational() {
            Some(value) => coefficients.push(value),
            None => return bad(&element.pointer, "this coefficient is not known to be rational"),
        }
    }
    let every_second = |from: usize| coefficients.iter().skip(from).step_by(2).cloned().collect::<Vec<_>>();
    let (mut upper, mut lower) = (every_second(0), every_second(1));
    while let (Some(a), Some(b)) = (upper.first().cloned(), lower.first().cloned()) {
        demand(Some(b > 0), RULE, &list.pointer, "the polynomial of `a` is Hurwitz")?;
        let at = |row: &[Rational], j: usize| row.get(j).cloned().unwrap_or_default();
        let next = (1..upper.len()).map(|j| at(&upper, j) - Rational::from(&a / &b) * at(&lower, j)).collect();
        (upper, lower) = (lower, next);
    }
    Ok(())
}
