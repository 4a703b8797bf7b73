//! Rule: the claim says what the witness proves, and nothing that it does not.

use super::by_n_o::claimed::Entry;
use super::by_n_o::kept::demand_kept;
use super::common::Evaluated;
use super::control::NAMES;
use super::rates::claimed::Rate;
use super::rates::demand_noise;
use super::sampled::claim::{N_O, Regulator};
use super::set::ClaimedSet;
use crate::actuator::{self, Actuator};
use crate::constant::Constant;
use crate::data::Data;
use crate::input_gain;
use crate::interval::Interval;
use crate::json::{Field, Fields};
use crate::noise::apart;
use crate::period;
use crate::plant::OfPlant;
use crate::plant::{coordinates, parameters};
use crate::range::is_same;
use crate::scope::{self, Scope};
use crate::spec::{AskedSet, Specification};
use crate::verdict::{Outcome, bad, demand, invalid};
use rug::Rational;

const RULE: &str = "claim";

/// The kind of set whose regulator sets z = M e at its first instant.
const ALIGNED: &str = "aligned";

/// The numbers of a claim.
pub struct Claim<'a> {
    /// sigma*, or the one gain of a sampled regulator or of a claim with an actuator.
    pub sigma: Rational,
    /// The sampled regulator that it is about, if it is.
    pub sampled: Option<Regulator<'a>>,
    /// The initial conditions.
    pub set: ClaimedSet,
    /// Bounds of the periodic solution.
    pub periodic: Field<'a>,
    /// Bounds of the control, where they are claimed.
    control: Option<Field<'a>>,
    /// What it says besides of given oscillators.
    pub rates: Vec<Rate<'a>>,
    /// What it says besides by the number of oscillators.
    pub by_n_o: Vec<Entry<'a>>,
    /// The radius of the ball that the set of a plant contains, with its place and as it is written.
    ball: Option<(Rational, Field<'a>)>,
    /// The actuator that it keeps to, if it names one: then it is about `sigma` alone.
    actuator: Option<Field<'a>>,
    /// The input gain that it is about, if it names one.
    input_gain: Option<Field<'a>>,
    /// The period that it is about, if it names one.
    period: Option<Field<'a>>,
    /// The parameters of the plant that it is about, if it names some.
    parameters: Option<Field<'a>>,
    /// Where it stands in the file.
    pointer: String,
    sigma_text: &'a str,
    /// X_0 as it is written, and how e and the regulator start in words.
    set_text: (&'a str, String),
    verdict: Field<'a>,
    n_o: Field<'a>,
    /// The sets of harmonics that it is about, if it names them.
    harmonics: Option<Field<'a>>,
    mu: Field<'a>,
    kind: Field<'a>,
}

/// A text that is fixed by the rest of the certificate.
pub fn reads(rule: &'static str, field: &Field<'_>, expected: &str) -> Outcome<()> {
    if field.text()? == expected {
        Ok(())
    } else {
        invalid(rule, &field.pointer, format!("it should read: {expected}"))
    }
}

/// Reads X0, E0 and, unless the regulator starts aligned, Z0; with X0 as it is written, and the rest in words.
fn read_set<'a>(fields: &mut Fields<'a>, aligned: bool) -> Outcome<(ClaimedSet, (&'a str, String))> {
    let mut size = |name| {
        let field = fields.required(name)?;
        let value = field.rational()?;
        if value < 0 {
            return invalid("initial set", &field.pointer, "it must not be negative");
        }
        Ok((value, field.numeral()?))
    };
    let ((x0, x_text), (e0, e_text)) = (size("X0")?, size("E0")?);
    if aligned {
        return Ok((ClaimedSet { x0, e0, z0: None }, (x_text, format!("|e| <= {e_text}, z = M e"))));
    }
    let (z0, z_text) = size("Z0")?;
    Ok((ClaimedSet { x0, e0, z0: Some(z0) }, (x_text, format!("|e| <= {e_text}, sqrt(z'Nz) <= {z_text}"))))
}

impl<'a> Claim<'a> {
    /// Reads the claim; `has_ball`: it is about a plant with states.
    pub fn read(field: &Field<'a>, has_ball: bool) -> Outcome<Claim<'a>> {
        let mut fields = field.fields()?;
        let derivation = fields.required("derivation")?;
        if derivation.text()? != "sharp" {
            return bad(&derivation.pointer, "only `sharp` can be claimed");
        }
        let sampled = Regulator::read(&mut fields)?;
        let (sigma, sigma_text) = match &sampled {
            Some(regulator) => (regulator.sigma.clone(), ""),
            None => {
                // With an actuator nothing is said of a larger gain.
                let sigma = fields.required(if fields.has("actuator") { "sigma" } else { "sigma_star" })?;
                (sigma.rational()?, sigma.numeral()?)
            }
        };
        let mut set = fields.required("initial_set")?.fields()?;
        let kind = set.required("kind")?;
        let (numbers, set_text) = read_set(&mut set, kind.text()? == ALIGNED)?;
        let ball = if has_ball { Some(set.required("ball")?) } else { None };
        let ball = ball.map(|field| field.rational().map(|value| (value, field))).transpose()?;
        set.finish()?;
        let delayed = sampled.as_ref().is_some_and(|regulator| regulator.delayed);
        let rates = fields.optional("for_n_o").map(|field| match delayed {
            false => Rate::read_all(&field),
            true => bad(&field.pointer, "nothing is proved of given n_o of a law with a delay"),
        });
        let samples = sampled.as_ref().map(|regulator| regulator.samples);
        let by_n_o = fields.part("by_n_o", |field| Entry::read_all(field, samples))?;
        let harmonics = fields.optional("harmonics");
        let rates = rates.transpose()?.unwrap_or_default();
        let said = rates.iter().map(|rate| (&rate.oscillators, &rate.pointer));
        let mut said = said.chain(by_n_o.iter().flatten().map(|entry| (&entry.oscillators, &entry.pointer)));
        let of_set = said.find(|(oscillators, _)| oscillators.n_o().is_none());
        if let Some((set, pointer)) = of_set.filter(|_| harmonics.is_none()) {
            return bad(&set.place(pointer), "expected only where the claim has `harmonics`");
        }
        let claim = Claim {
            rates,
            by_n_o: by_n_o.unwrap_or_default(),
            sigma,
            sampled,
            set: numbers,
            ball,
            actuator: fields.optional("actuator"),
            input_gain: fields.optional("input_gain"),
            period: fields.optional("period"),
            parameters: fields.optional("parameters"),
            pointer: field.pointer.clone(),
            sigma_text,
            set_text,
            verdict: fields.required("verdict")?,
            n_o: fields.required("n_o")?,
            harmonics,
            mu: fields.required("mu")?,
            kind,
            periodic: fields.required("periodic_solution")?,
            control: fields.optional("control"),
        };
        // What the file says of it in words is for people: the words of an answer are those of `check`.
        fields.required("statement")?.words()?;
        fields.finish()?;
        Ok(claim)
    }

    /// Which oscillators it is about.
    pub fn scope(&self) -> Scope {
        Scope::of_claim(self.harmonics.as_ref())
    }

    /// Whether it says that it keeps to its actuator by what it says by the number of oscillators.
    pub fn keeps_to_actuator_by_n_o(&self) -> Outcome<bool> {
        actuator::says_by_n_o(self.actuator.as_ref())
    }

    /// That it does: what it says by n_o is proved.
    pub fn keep_to_actuator(&self, actuator: &Actuator) -> Outcome<()> {
        demand_kept(actuator, &self.by_n_o, self.scope() == Scope::EverySet, &self.pointer)
    }

    /// Whether it says something of noise.
    pub fn says_of_noise(&self) -> bool {
        self.rates.iter().any(|rate| rate.noise.is_some())
    }

    /// The bounds of |x| and |e| along the periodic solution as it states them: true where [`Claim::check`] accepts it.
    pub fn sizes(&self) -> Outcome<[Rational; 2]> {
        self.periodic.fields()?.numbers(["x", "e"])
    }

    /// Compares every field with the specification, and demands that the stored sizes of the periodic solution bound those
    /// that are proved; `exact` are rational bounds of |x| and |e|.
    ///
    /// `start` is Y_0 as the witness of a law with a delay writes it. What is then proved, in words: each number of it is one of the
    /// claim or of the specification that was compared, and no text of the file stands in it.
    pub fn check(
        &self,
        d: &Data<'_>,
        evaluated: &Evaluated,
        exact: [&Rational; 2],
        start: Option<&str>,
    ) -> Outcome<String> {
        reads(RULE, &self.verdict, "certified")?;
        let spec = d.spec;
        match &self.sampled {
            None => reads(RULE, &self.n_o, "every n_o >= 0")?,
            Some(regulator) => {
                reads(RULE, &self.n_o, N_O)?;
                regulator.check(spec)?;
            }
        }
        let named = (self.harmonics.as_ref(), self.sampled.is_some());
        scope::agrees((spec.regulator.harmonics, &spec.period), named, &self.pointer)?;
        if !is_same(&Constant::read(&self.mu)?, &spec.regulator.mu) {
            reads(RULE, &self.mu, &spec.regulator.mu.text)?;
        }
        input_gain::agrees(spec.input_gain.as_ref(), self.input_gain.as_ref(), &self.pointer)?;
        actuator::agrees(spec.actuator.as_ref(), self.actuator.as_ref(), &self.pointer)?;
        period::agrees(&spec.period, self.period.as_ref(), &self.pointer)?;
        let of_family = spec.plant.as_ref().map_or(&[][..], |plant| &plant.parameters);
        let family = parameters::agree(of_family, self.parameters.as_ref(), &self.pointer)?;
        let kind = match spec.initial_set {
            AskedSet::Paper => "paper",
            AskedSet::AtRest(_) => "at-rest",
            AskedSet::Aligned(_) => ALIGNED,
            AskedSet::Box(_) => "box",
        };
        reads(RULE, &self.kind, kind)?;
        let mut fields = self.periodic.fields()?;
        for (index, (name, mine)) in evaluated.sizes.named(d).into_iter().enumerate() {
            // z is a state at the samples alone.
            let field = match self.sampled {
                Some(_) if name == "z" => fields.optional(name),
                _ => Some(fields.required(name)?),
            };
            field.map_or(Ok(()), |field| bounds(d, &field, &mine, exact.get(index).copied()))?;
        }
        fields.finish()?;
        if let Some(control) = &self.control {
            let mut fields = control.fields()?;
            for (name, mine) in NAMES.into_iter().zip(&evaluated.control) {
                bounds(d, &fields.required(name)?, mine, None)?;
            }
            fields.finish()?;
        }
        let statement = match &spec.plant {
            None => self.in_words(spec, start),
            Some(plant) => {
                self.check_ball(plant)?;
                self.of_plant((spec, plant), family, start)?
            }
        };
        demand_noise(d, &self.rates, self.sampled.is_some())?;
        let sigma = self.sampled.as_ref().map_or(self.sigma_text, Regulator::sigma_text);
        let kind = [self.sampled.is_some(), self.set.z0.is_none()];
        let besides: String = self.rates.iter().map(|rate| rate.in_words(sigma, kind, &spec.noise)).collect();
        let output = spec.input_gain.as_ref().map_or_else(|| "u".to_owned(), input_gain::output);
        let by_n_o: String = self.by_n_o.iter().map(|entry| entry.in_words(sigma, &output, &spec.noise)).collect();
        Ok(statement + &besides + &by_n_o)
    }

    /// The set contains the ball (docs/mathematics.md, section 11.5), and the ball is no smaller than the one that is asked for.
    fn check_ball(&self, plant: &OfPlant) -> Outcome<()> {
        let Some((ball, field)) = &self.ball else { return Ok(()) };
        demand(Some(*ball >= 0), coordinates::RULE, &field.pointer, "the radius is not negative")?;
        let covered = plant.coordinates.covers_ball(&self.set.x0, ball);
        demand(Some(covered), coordinates::RULE, &field.pointer, "X0^2 L L' - ball^2 I >= 0")?;
        demand(plant.asks_for(ball), coordinates::RULE, &field.pointer, "the ball that is asked for <= ball")
    }

    /// The claim about a plant in words.
    fn of_plant(
        &self,
        (spec, plant): (&Specification, &OfPlant),
        family: Option<String>,
        y_0: Option<&str>,
    ) -> Outcome<String> {
        let about = family.map_or_else(
            || "the plant of these formulas".to_owned(),
            |parameters| format!("every plant of these formulas with {parameters}"),
        );
        let domain = plant.domain.as_ref().map_or_else(String::new, |[x, e]| {
            let of_x = if plant.states > 0 { format!("|x - x_0| <= {}, ", x.words) } else { String::new() };
            format!(" (a model that holds for {of_x}|e| <= {})", e.words)
        });
        let (x0, start) = &self.set_text;
        let (states, orbit) = match &self.ball {
            None => (String::new(), String::new()),
            Some((_, field)) => (
                format!("|L^-1 (x - x_0)| <= {x0}, "),
                format!(
                    " Here x is the vector of the states, L the matrix `coordinates` of this certificate, and x_0(t) {}, in the \
                     norm of L^-1 x. The set contains |x - x_0| <= {}.",
                    solution(plant),
                    field.numeral()?
                ),
            ),
        };
        let (regulator, when) = self.regulator(spec, y_0);
        Ok(format!(
            "{regulator}, the closed loop of {about}{domain} has a T-periodic solution. Every solution from {states}{start}, at \
             any {when}, converges exponentially to it.{}{orbit}",
            actuator::never_cut_off(spec.actuator.as_ref()),
        ))
    }

    /// The beginning of the claim in words, and where its solutions start.
    fn regulator(&self, spec: &Specification, y_0: Option<&str>) -> (String, String) {
        if let Some(regulator) = &self.sampled {
            let off = |y_0| format!(", with a prediction of e there within h*{} of it", apart(y_0));
            return (
                regulator.in_words(spec, self.scope()),
                format!("sampling instant{}", y_0.map_or_else(String::new, off)),
            );
        }
        let reach = if spec.regulator.matched { "" } else { " (which need not match the period)" };
        let gain = if spec.actuator.is_some() { "the gain sigma =" } else { "every gain sigma >=" };
        let (sigma, setting) = (self.sigma_text, spec.in_words());
        let words = format!("For {} and {gain} {sigma}{setting}{reach}", self.scope().in_words(None));
        (words, "initial time".to_owned())
    }

    /// The claim in words, as the specification and the numbers of the claim make it.
    fn in_words(&self, spec: &Specification, y_0: Option<&str>) -> String {
        let domain = spec
            .domain
            .as_ref()
            .map_or_else(String::new, |[x, e]| format!(" (for |x| <= {}, |e| <= {})", x.words, e.words));
        let triple = if spec.jacobian.is_some() {
            "whose df/dx(t,0,0) is in the family of the Jacobian (its Lyapunov triple is proved)".to_owned()
        } else {
            let [p_low, p_up, alpha] = [&spec.p_low, &spec.p_up, &spec.alpha].map(|constant| &constant.words);
            format!("with the Lyapunov triple p_low = {p_low}, p_up = {p_up}, alpha = {alpha} (given, not proved)")
        };
        let rate = if spec.rate.is_some() { " and the contraction `rate` (given, not proved)" } else { "" };
        let harmonics =
            if spec.q_0.is_some() { " and harmonics of q(t,0,0) within `q_0` (given, not proved)" } else { "" };
        let (x0, start) = &self.set_text;
        let (regulator, when) = self.regulator(spec, y_0);
        format!(
            "{regulator}, the closed loop of every plant within the bounding functions{domain} and {triple}{rate}{harmonics} \
             has a T-periodic solution. Every solution from |x| <= {x0}, {start}, at any {when}, converges exponentially to it.{}",
            actuator::never_cut_off(spec.actuator.as_ref()),
        )
    }
}

/// What x_0(t) is: of a plant in several cells there is one solution for each, and the claim is about any of them.
fn solution(plant: &OfPlant) -> &'static str {
    match plant.in_cells {
        false => "the T-periodic solution of x' = f(t,x,0) that is proved within `radius` of `orbit`",
        true => {
            "for any of the `cells` that contains the parameters of the plant the T-periodic solution of x' = f(t,x,0) that is proved \
             within `radius` of `orbit` of that cell"
        }
    }
}

/// A stored number is an upper bound of one that is enclosed, or of one that is known exactly to bound it.
fn bounds(d: &Data<'_>, field: &Field<'_>, mine: &Interval, exact: Option<&Rational>) -> Outcome<()> {
    let value = field.rational()?;
    let truth = if exact.is_some_and(|exact| value >= *exact) { Some(true) } else { mine.le(&d.number(&value)) };
    demand(truth, RULE, &field.pointer, format!("it bounds what is proved, {}", crate::verdict::shown(mine)))
}
