//! The entries of `bounds`: what they say, and for which arguments (docs/mathematics.md, section 11.3).
//!
//! An entry answers for arguments up to its own ones, rounded up; it is decided for these.

use crate::bound::{BOUND_NAMES, Bound};
use crate::interval::{Interval, above};
use crate::json::Field;
use crate::verdict::{Outcome, bad, demand};
use rug::{Float, Rational};

/// The name of this rule.
pub const RULE: &str = "bounds of the plant";
/// The most entries.
const MAX_ENTRIES: usize = 100;
/// The precision, in bits, at which the arguments of an entry are rounded up: that at which a claim is decided first, so that
/// an argument that is the entry's own finds it.
const ARGUMENT_PRECISION: u32 = 128;

/// What is bounded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Name {
    Fx,
    Fe,
    Qx,
    Qe,
    QeMax,
    Qtx,
    Qte,
    Rate,
    RateExistence,
}

#[rustfmt::skip]
const NAMES: [(&str, Name); 9] = [
    ("f_x", Name::Fx), ("f_e", Name::Fe), ("q_x", Name::Qx), ("q_e", Name::Qe), ("q_e_max", Name::QeMax),
    ("q_tx", Name::Qtx), ("q_te", Name::Qte), ("rate", Name::Rate), ("rate_existence", Name::RateExistence),
];

impl Name {
    /// Whether its formula has the velocity of the frame.
    pub fn is_of_motion(self) -> bool {
        matches!(self, Name::Qtx | Name::Qte)
    }

    /// Whether it is a rate, of which the largest is the best.
    fn is_rate(self) -> bool {
        matches!(self, Name::Rate | Name::RateExistence)
    }

    /// Whether it bounds a norm.
    fn is_norm(self) -> bool {
        !self.is_rate() && self != Name::QeMax
    }

    /// The bound of sections 1 and 10, which has the same name in a file.
    fn of(which: Bound) -> Option<Name> {
        NAMES.iter().find(|(label, _)| *label == BOUND_NAMES[which as usize]).map(|(_, name)| *name)
    }
}

/// One entry.
#[derive(Clone, Debug)]
pub struct Entry {
    pub pointer: String,
    pub label: &'static str,
    pub name: Name,
    /// X and E as they are written, and rounded up.
    pub written: [Rational; 2],
    pub arguments: [Float; 2],
    pub value: Rational,
}

/// All entries.
#[derive(Clone, Debug)]
pub struct Entries {
    pub list: Vec<Entry>,
    /// Without states nothing depends on X, and every bound of f is 0.
    has_states: bool,
}

impl Entries {
    /// Reads the list `bounds`.
    pub fn read(field: &Field<'_>, has_states: bool, two_matrices: bool) -> Outcome<Entries> {
        if field.elements()?.len() > MAX_ENTRIES {
            return bad(&field.pointer, format!("expected at most {MAX_ENTRIES} bounds"));
        }
        let entry = |element: &Field<'_>| {
            let mut fields = element.fields()?;
            let bound = fields.required("bound")?;
            let text = bound.text()?;
            let Some((label, name)) = NAMES.iter().find(|(label, _)| *label == text) else {
                return bad(&bound.pointer, "this is the name of no bound of a plant");
            };
            if *name == Name::RateExistence && !two_matrices {
                return bad(&bound.pointer, "there is no `lyapunov_existence`");
            }
            let arguments = [fields.required("X")?, fields.required("E")?];
            let value = fields.required("value")?;
            fields.finish()?;
            let end = |argument: &Field<'_>| -> Outcome<Rational> {
                let end = argument.rational()?;
                demand(Some(end >= 0), RULE, &argument.pointer, "an argument is not negative")?;
                Ok(end)
            };
            let written = [end(&arguments[0])?, end(&arguments[1])?];
            let arguments = written.each_ref().map(|end| above(end, ARGUMENT_PRECISION));
            let number = value.rational()?;
            // Norms are decided by their squares.
            demand(Some(!name.is_norm() || number >= 0), RULE, &value.pointer, "a bound of a norm is not negative")?;
            Ok(Entry { pointer: element.pointer.clone(), label, name: *name, written, arguments, value: number })
        };
        Ok(Entries { list: field.list(entry)?, has_states })
    }

    /// The entry with the best value among those that cover.
    fn best_of(&self, name: Name, covers: impl Fn(&Entry) -> bool) -> Option<&Entry> {
        let entries = self.list.iter().filter(|entry| entry.name == name && covers(entry));
        let value = |a: &&Entry, b: &&Entry| a.value.cmp(&b.value);
        if name.is_rate() { entries.max_by(value) } else { entries.min_by(value) }
    }

    /// The best value that is given for these arguments.
    fn best(&self, name: Name, x: &Interval, e: &Interval) -> Option<&Rational> {
        let covers = |entry: &Entry| {
            let [to_x, to_e] = &entry.arguments;
            (!self.has_states || *x.hi() <= *to_x) && *e.hi() <= *to_e
        };
        self.best_of(name, covers).map(|entry| &entry.value)
    }

    /// The best entry for arguments that are known exactly; of a plant with states.
    pub fn exactly_at(&self, name: Name, [x, e]: [&Rational; 2]) -> Option<&Entry> {
        self.best_of(name, |entry| *x <= entry.written[0] && *e <= entry.written[1])
    }

    /// A bound of section 1 or 10 at (X, E).
    pub fn at(&self, which: Bound, x: &Interval, e: &Interval, precision: u32) -> Option<Interval> {
        let nothing =
            matches!(which, Bound::F | Bound::Fe | Bound::Fxx | Bound::Fex | Bound::Fx | Bound::Qx | Bound::Qtx);
        if nothing && !self.has_states {
            return Some(Interval::int(0, precision));
        }
        self.best(Name::of(which)?, x, e).map(|value| Interval::rational(value, precision))
    }

    /// The rate a(X, E) of one of the two P.
    pub fn rate(&self, name: Name, x: &Interval, e: &Interval, precision: u32) -> Option<Interval> {
        self.best(name, x, e).map(|value| Interval::rational(value, precision))
    }
}
