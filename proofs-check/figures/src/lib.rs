//! The figures of a certificate on which no claim rests: the sides of its conditions, the table of constants, the other
//! derivation for comparison, a second proof of C5, a remark. They are computed again, one by one, apart from the claim,
//! and get an answer of their own. So a figure can neither take a true claim away nor pass unseen when it is wrong.

mod compare;
mod constants;
pub mod existence;
mod lmi;
mod no_plant;
pub mod repaired;

use proofs_core::data::Data;
use proofs_core::effort;
use proofs_core::interval::Interval;
use proofs_core::json::{Field, Fields, join};
use proofs_core::rules::common::Evaluated;
use proofs_core::rules::derivation::{Derivation, Witness};
use proofs_core::rules::{control, sampled, sharp};
use proofs_core::spec::{AskedSet, Specification};
use proofs_core::verdict::{Condition, Finding, Outcome, Verdict, bad, finding, invalid};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

/// The precisions, in bits, at which figures are computed: it is enough that one of them gives the stored one. Those from
/// the second on are for what is undecided, and for words, which may depend on a comparison.
const PRECISIONS: [u32; 4] = [128, 256, 512, 1024];

/// What was found out about the figures.
#[derive(Clone, Debug, Default)]
pub struct Figures {
    /// How many were looked at.
    pub checked: usize,
    /// Those that are not as they are computed here, with what is wrong.
    pub findings: Vec<Finding>,
}

impl Figures {
    /// `agree`; `differ`, where one certainly does; else `undecided`.
    pub fn word(&self) -> &'static str {
        match self.findings.iter().any(differs) {
            true => "differ",
            false if self.findings.is_empty() => "agree",
            false => "undecided",
        }
    }
}

fn differs(finding: &Finding) -> bool {
    finding.verdict != Verdict::Undecided
}

impl fmt::Display for Figures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let wrong = self.findings.iter().filter(|finding| differs(finding)).count();
        match (wrong, self.findings.len() - wrong) {
            (0, 0) => write!(f, "all {} agree", self.checked),
            (0, open) => write!(f, "{open} undecided"),
            (1, 0) => write!(f, "1 differs"),
            (wrong, 0) => write!(f, "{wrong} differ"),
            (wrong, open) => write!(f, "{wrong} differ{}, {open} undecided", if wrong == 1 { "s" } else { "" }),
        }
    }
}

/// The parts of a file that hold figures.
pub struct Parts<'a> {
    /// `/conditions`.
    pub conditions: Option<Field<'a>>,
    /// `/constants`.
    pub constants: Option<Field<'a>>,
    /// `/comparison`.
    pub comparison: Option<Field<'a>>,
    /// `/witness/lmi`.
    pub multipliers: Option<Field<'a>>,
    /// `/claim/periodic_solution`, whose truth is part of the claim; how tight it is, is not.
    pub periodic: Field<'a>,
    /// `/claim/control`, the same.
    pub control: Option<Field<'a>>,
    /// `/no_plant`.
    pub no_plant: Option<Field<'a>>,
}

/// Figures by their places: `None` for one that is as it is computed here.
type Answers = BTreeMap<String, Option<Box<Finding>>>;

/// Computes all figures again within `limit` steps; `main` is the derivation of the claim, which is proved.
pub fn check(spec: &Specification, parts: &Parts<'_>, main: &Derivation, limit: u64) -> Figures {
    let (answer, _) = effort::limited(limit, || {
        let mut settled = BTreeSet::new();
        let mut figures = Figures::default();
        for precision in PRECISIONS {
            let mut attempt = Attempt { d: &Data::new(spec, precision), parts, answers: Answers::new() };
            attempt.run(main);
            // What an attempt says that ran out of steps is worth nothing, not even that a figure agrees.
            if effort::exhausted() {
                let message = "not computed within the steps that the figures may take";
                figures.findings.push(*finding(Verdict::Undecided, "effort", "", message));
                break;
            }
            figures.checked = attempt.answers.len();
            figures.findings.clear();
            for (place, finding) in attempt.answers {
                match finding {
                    None => drop(settled.insert(place)),
                    Some(finding) if !settled.contains(&place) => figures.findings.push(*finding),
                    Some(_) => {}
                }
            }
            let open = |finding: &Finding| !differs(finding) || (finding.sides.is_none() && precision == PRECISIONS[0]);
            if !figures.findings.iter().any(open) {
                break;
            }
        }
        figures
    });
    answer
}

/// All figures at one precision.
struct Attempt<'a> {
    d: &'a Data<'a>,
    parts: &'a Parts<'a>,
    answers: Answers,
}

impl Attempt<'_> {
    fn note(&mut self, place: &str, outcome: Outcome<()>) {
        self.answers.insert(place.to_owned(), outcome.err());
    }

    fn run(&mut self, main: &Derivation) {
        // It was proved for the claim, if not at this precision.
        let outcome = match &main.witness {
            Witness::Sampled(w) => sampled::evaluate(self.d, w).map(|evaluated| self.of_claim(&evaluated)),
            Witness::Sharp(w) => sharp::evaluate(self.d, w).map(|sharp| {
                self.of_claim(&sharp.evaluated);
                self.in_continuous_time(main, w, &sharp);
            }),
        };
        if let Err(finding) = outcome {
            self.note("", Err(finding));
        }
    }

    fn of_claim(&mut self, evaluated: &Evaluated) {
        self.conditions(&evaluated.conditions);
        let sizes = evaluated.sizes.named(self.d);
        self.tight(Some(&self.parts.periodic), &sizes);
        let control = control::NAMES.into_iter().zip(evaluated.control.iter().cloned());
        self.tight(self.parts.control.as_ref(), &control.collect::<Vec<_>>());
    }

    fn in_continuous_time(&mut self, main: &Derivation, w: &sharp::Witness, sharp: &sharp::Sharp) {
        self.multipliers(w, sharp);
        let repaired = self.repaired();
        let repaired = repaired.as_ref().map(|(w, proved)| (w, proved));
        let regulation = main.regulation.as_ref().map(|w| &w.sigma);
        self.constants(&constants::Input { sharp: (w, sharp), repaired, regulation });
        if let Some(field) = &self.parts.no_plant {
            self.note(&field.pointer, no_plant::check(self.d, field));
        }
    }

    fn conditions(&mut self, proved: &[Condition]) {
        let Some(list) = &self.parts.conditions else { return self.note("/conditions", missing("/conditions")) };
        let mut stored = match list.elements() {
            Ok(stored) => stored,
            Err(finding) => return self.note(&list.pointer, Err(finding)),
        };
        let mut computed: Vec<&Condition> = proved.iter().collect();
        if self.d.spec.plant.is_some() {
            // A ball and a domain of a plant are compared exactly, by matrices (section 11.5), not by these two numbers.
            let compared = |id: &str| !["set", "domain"].contains(&id);
            computed.retain(|condition| compared(condition.id));
            let id = |element: &Field<'_>| Some(element.fields().ok()?.optional("id")?.text().ok()?.to_owned());
            stored.retain(|element| id(element).is_none_or(|id| compared(&id)));
        }
        for (element, mine) in stored.iter().zip(&computed) {
            self.note(&element.pointer, compare::condition(element, mine));
        }
        if stored.len() != computed.len() {
            let message = format!("{} conditions are stored, not {}", stored.len(), computed.len());
            self.note(&list.pointer, invalid(compare::RULE, &list.pointer, message));
        }
    }

    /// The upper ends of the claim are no larger than their rounding makes them.
    fn tight(&mut self, part: Option<&Field<'_>>, computed: &[(&'static str, Interval)]) {
        let Some(Ok(mut fields)) = part.map(Field::fields) else { return };
        for (name, mine) in computed {
            let Some(field) = fields.optional(name) else { continue };
            self.note(&field.pointer, compare::tight(&field, mine));
        }
    }

    /// C5 as a matrix inequality.
    fn multipliers(&mut self, w: &sharp::Witness, proved: &sharp::Sharp) {
        let Some(field) = &self.parts.multipliers else { return };
        if self.d.gain.is_some() {
            return self.note(&field.pointer, of_family(&field.pointer));
        }
        let outcome = lmi::check(self.d, &proved.error_box, [&w.sigma, &w.free.w_x, &w.free.h], field);
        self.note(&field.pointer, outcome);
    }

    /// The repaired derivation, if it is given and proved.
    fn repaired(&mut self) -> Option<(repaired::Witness, repaired::Repaired)> {
        let field = self.parts.comparison.as_ref()?;
        if is_family(self.d) {
            self.note(&field.pointer, of_family(&field.pointer));
            return None;
        }
        let outcome = comparison(field, self.d).and_then(|w| repaired::prove(self.d, &w).map(|proved| (w, proved)));
        let (found, outcome) = match outcome {
            Ok(pair) => (Some(pair), Ok(())),
            Err(finding) => (None, Err(finding)),
        };
        self.note(&field.pointer, outcome);
        found
    }

    fn constants(&mut self, input: &constants::Input<'_>) {
        let Some(table) = &self.parts.constants else { return self.note("/constants", missing("/constants")) };
        let mut outcomes = Vec::new();
        constants::check(self.d, table, input, &mut |place, outcome| outcomes.push((place, outcome)));
        outcomes.into_iter().for_each(|(place, outcome)| self.note(&place, outcome));
    }
}

/// Whether the input gain or the period is an interval: the printed and the repaired derivation are about one number of each.
fn is_family(d: &Data<'_>) -> bool {
    d.gain.is_some() || d.spec.period.range().is_some()
}

/// The second proof of C5 is about the gain 1 too, and has no period.
fn of_family(pointer: &str) -> Outcome<()> {
    invalid(compare::RULE, pointer, "it says nothing of an interval of the input gain or the period")
}

fn missing(pointer: &str) -> Outcome<()> {
    bad(pointer, "this part of a certificate is missing")
}

/// The free numbers of the repaired derivation.
fn comparison(field: &Field<'_>, d: &Data<'_>) -> Outcome<repaired::Witness> {
    let mut fields = field.object(|fields| fields.required("repaired"))?.fields()?;
    let sigma = fields.number("sigma_star")?;
    let mut set = fields.required("initial_set")?.fields()?;
    let (numbers, _) =
        proofs_core::rules::claim::read_set(&mut set, matches!(d.spec.initial_set, AskedSet::Aligned(_)))?;
    set.finish()?;
    let mut witness = fields.required("witness")?.fields()?;
    fields.finish()?;
    let w = repaired::Witness::read(&mut witness, sigma, numbers)?;
    witness.finish()?;
    Ok(w)
}

/// What is left of an object is unknown; each is a figure that nothing stands behind.
fn unknown(fields: Fields<'_>, note: &mut dyn FnMut(String, Outcome<()>)) {
    let at = fields.pointer.clone();
    for (key, _) in fields.rest() {
        let place = join(&at, key);
        let outcome = invalid(compare::RULE, &place, "nothing in the certificate gives this figure");
        note(place, outcome);
    }
}
