//! Rule: noise and a disturbance, as a file states them (docs/mathematics.md, section 13.6). They count in what a claim says of given n_o
//! alone: all else that it says is of the loop without them.
//!
//! What is measured is `e + v`, |v| <= v_bar at all times, and q + d stands for q, |d| <= d_bar. Guarantee: `v_bar = noise + quantum/2`, for a
//! converter in steps of `quantum` rounds to the nearest, and `d_bar = disturbance`, none of the three below 0. With the `arithmetic` `double` the
//! rounding of a regulator at samples counts too ([`crate::rules::rates`]); `exact`, which need not be written, leaves it out.

use crate::constant::RULE;
use crate::json::{Field, Fields};
use crate::verdict::{Outcome, bad, demand};
use rug::Rational;

/// A number of a file and how it is written.
#[derive(Clone, Debug)]
struct Size {
    value: Rational,
    text: String,
}

impl Size {
    fn read(field: &Field<'_>) -> Outcome<Size> {
        let value = field.rational()?;
        demand(Some(value >= 0), RULE, &field.pointer, "the number is nonnegative")?;
        Ok(Size { value, text: field.numeral()?.to_owned() })
    }

    fn value(of: Option<&Size>) -> Rational {
        of.map_or_else(Rational::new, |size| size.value.clone())
    }
}

/// What a file says of noise: nothing, as a rule.
#[derive(Clone, Debug, Default)]
pub struct Noise {
    noise: Option<Size>,
    quantum: Option<Size>,
    disturbance: Option<Size>,
    doubles: bool,
}

impl Noise {
    /// Takes `measurement`, `disturbance` and `arithmetic` out of a file, where they are.
    pub fn read(file: &mut Fields<'_>) -> Outcome<Noise> {
        let mut read = Noise::default();
        let measured = |fields: &mut Fields<'_>| {
            let [noise, quantum] = ["noise", "quantum"].map(|name| fields.part(name, Size::read));
            match (noise?, quantum?) {
                (None, None) => bad(&fields.pointer, "expected `noise`, `quantum` or both"),
                both => Ok(both),
            }
        };
        (read.noise, read.quantum) = file.part("measurement", |field| field.object(measured))?.unwrap_or_default();
        read.disturbance = file.part("disturbance", Size::read)?;
        read.doubles = file.part("arithmetic", in_doubles)?.unwrap_or_default();
        Ok(read)
    }

    /// The most that a measurement is off.
    pub fn v_bar(&self) -> Rational {
        Size::value(self.noise.as_ref()) + Size::value(self.quantum.as_ref()) / 2
    }

    /// The most that is added to q.
    pub fn d_bar(&self) -> Rational {
        Size::value(self.disturbance.as_ref())
    }

    /// Whether a regulator computes in doubles, `at_samples`: in continuous time none does.
    pub fn is_rounded(&self, at_samples: bool) -> bool {
        at_samples && self.doubles
    }

    /// Whether there is none, of a regulator at samples or in continuous time.
    pub fn is_none(&self, at_samples: bool) -> bool {
        self.v_bar() + self.d_bar() == 0 && !self.is_rounded(at_samples)
    }

    /// Those that are there, in words.
    pub fn in_words(&self, at_samples: bool) -> String {
        let part = |size: &Option<Size>, of: &dyn Fn(&str) -> String| {
            size.as_ref().filter(|size| size.value != 0).map(|size| of(&apart(&size.text)))
        };
        let rounding = self.is_rounded(at_samples).then(|| "computed in double precision as exported".to_owned());
        let parts = [
            part(&self.noise, &|size| format!("noise of at most {size} on the measurement of e")),
            part(&self.quantum, &|size| format!("a measurement of e in steps of {size}")),
            part(&self.disturbance, &|size| format!("a disturbance of at most {size} added to q")),
            rounding,
        ];
        parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
    }
}

/// Whether the `arithmetic` is that of doubles.
fn in_doubles(field: &Field<'_>) -> Outcome<bool> {
    match field.text()? {
        "double" => Ok(true),
        "exact" => Ok(false),
        "single" => {
            bad(&field.pointer, "nothing is proved of single precision: the regulator is exported in double precision")
        }
        _ => bad(&field.pointer, "expected `double`, in which the regulator is exported, or `exact`"),
    }
}

/// A numeral within a sentence or in front of a product: a fraction stands in parentheses.
pub fn apart(text: &str) -> String {
    if text.contains('/') { format!("({text})") } else { text.to_owned() }
}
