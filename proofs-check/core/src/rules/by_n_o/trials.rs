//! What proves the numbers by n_o at one gain of the law: a trial for each entry, near which the periodic solution is (docs/mathematics.md, section
//! 14.4), with the forms that say so. Read, and of the numbers that stand alone it is decided that they are right.
//!
//! Guarantee of [`Trial`]: no coefficient of ehat has a mean or a harmonic of an oscillator; of an entry about so many oscillators or more ehat = 0, and no
//! coefficient of uhat has a harmonic above n_o. A harmonic that is written with 0 for both of its numbers is none. Of each form `P <= P_up I`, `Pi >= diag(x_low I, 0)` and
//! `Pi >= diag(0, e_low)` with x_low, e_low > 0, so that Pi is positive definite. At samples p = 0, w, lambda and gamma are above 0, and all harmonics are below half
//! of the samples. `Q_low I <= Q <= Q_up I`, and k_p, c_x, c_e, c_y, Q_low, c, gamma, D_x
//! and D_e are above 0. `sizes` are bounds that other rules may rest on; [`tube`](super::tube) proves them. What is said of the formulas is proved by the crate `proofs-plants`.

use super::claimed::{Entry, RULE};
use super::curves::{Curves, MEMBERS};
use super::form::{MOST_FORMS, form, of_states, radii};
use super::x_first::XFirst;
use crate::data::Data;
use crate::interval::Interval;
use crate::json::{Field, Fields};
use crate::matrix::{is_semidefinite, shifted};
use crate::rules::inequality::{Extent, Metric, P, number, symmetric};
use crate::verdict::{Outcome, bad, demand};
use rug::Rational;

/// A trial of one n_o, or of one set of harmonics.
#[derive(Clone, Debug)]
pub struct Trial {
    /// Where it stands in the file.
    pub pointer: String,
    /// xhat, ehat and uhat: the nominal curves first, and then those of each power of delta.
    pub curves: Vec<Curves>,
    /// d_x and d_q.
    pub defects: [Rational; 2],
    /// D_x and D_e.
    pub radii: [Rational; 2],
    /// b_x and b_e.
    pub slopes: [Rational; 2],
    /// One or more, each with its extent.
    pub forms: Vec<(Metric, Extent)>,
    /// Of a plant with states.
    pub states: Option<States>,
    /// There exactly if the entry is about so many oscillators or more, in continuous time.
    pub or_more: Option<OrMore>,
    /// Where peaks are proved along x first, too; not at samples.
    pub x_first: Option<XFirst>,
    /// Where something else rests on them.
    pub sizes: Option<Sizes>,
}

/// Bounds along the periodic solution of the entry.
#[derive(Clone, Debug)]
pub struct Sizes {
    /// Where they stand in the file.
    pub pointer: String,
    /// Of `|L^-1 (x - x_0)|`; 0 without states.
    pub x: Rational,
    /// Of `|zeta|_N`.
    pub zeta: Rational,
}

/// What the corollary about so many oscillators or more asks for besides.
#[derive(Clone, Debug)]
pub struct OrMore {
    /// d_t.
    pub defect: Rational,
    /// b_qtx and b_qte.
    pub rates: [Rational; 2],
    /// b_fx and b_fe.
    pub slopes: [Rational; 2],
}

/// By what the states answer the error: (14.4b).
#[derive(Clone, Debug)]
pub struct States {
    /// Q.
    pub matrix: P,
    /// `Q_low I <= Q <= Q_up I`.
    pub low: Rational,
    /// See there.
    pub up: Rational,
    /// c and gamma.
    pub decay: [Rational; 2],
}

/// Of what trials are.
#[derive(Clone, Copy, Debug)]
pub struct Shape {
    /// The states of the plant.
    pub states: usize,
    /// Of how many numbers intervals are known.
    pub intervals: usize,
    /// N_s, of a claim at samples.
    pub samples: Option<u32>,
}

/// Reads the list `trials`: one for each entry of the claim.
pub fn read_all(field: &Field<'_>, claimed: &[Entry<'_>], shape: Shape) -> Outcome<Vec<Trial>> {
    let list = field.elements()?;
    if list.len() != claimed.len() {
        return bad(&field.pointer, format!("expected {}, one for each entry of the claim", claimed.len()));
    }
    let read = |(field, entry): (&Field<'_>, &Entry<'_>)| field.object(|fields| Trial::take(fields, entry, shape));
    list.iter().zip(claimed).map(read).collect()
}

impl Trial {
    fn take(fields: &mut Fields<'_>, entry: &Entry<'_>, shape: Shape) -> Outcome<Trial> {
        let Shape { states, intervals, samples } = shape;
        let continuous = samples.is_none();
        let nominal = Curves::take(fields, entry, states, vec![0; intervals])?;
        let curves = match fields.optional(MEMBERS) {
            Some(field) => Curves::read_members(&field, entry, states, nominal)?,
            None => vec![nominal],
        };
        if let Some(samples) = samples {
            let degree = curves.iter().map(Curves::degree).max().unwrap_or(0);
            let what = format!("its {degree} harmonics are below {samples}/2: the samples tell them apart");
            demand(Some(2 * degree < samples as usize), RULE, &fields.pointer, what)?;
        }
        let defects = [of_states(fields, "defect_x", false, states)?, number(fields, "defect_q", false)?];
        let radii = radii(fields, states)?;
        let slopes = [of_states(fields, "q_x", false, states)?, number(fields, "q_e", false)?];
        let list = fields.required("forms")?;
        let forms = list.list(|field| field.object(|fields| form(fields, (states, continuous))))?;
        if forms.is_empty() || forms.len() > MOST_FORMS {
            return bad(&list.pointer, format!("expected 1 to {MOST_FORMS} forms"));
        }
        let or_more = (entry.or_more && continuous).then(|| OrMore::take(fields, states)).transpose()?;
        let x_first = match continuous {
            true => fields.part("x_first", |field| field.object(|fields| XFirst::take(fields, states)))?,
            false => None,
        };
        let sizes = fields.part("sizes", |field| field.object(|fields| Sizes::take(fields, states)))?;
        let states = match states {
            0 => None,
            _ => Some(fields.required("states")?.object(|fields| States::take(fields, states))?),
        };
        let pointer = fields.pointer.clone();
        Ok(Trial { pointer, curves, defects, radii, slopes, forms, states, or_more, x_first, sizes })
    }
}

impl Sizes {
    fn take(fields: &mut Fields<'_>, states: usize) -> Outcome<Sizes> {
        let pointer = fields.pointer.clone();
        let x = of_states(fields, "x", false, states)?;
        Ok(Sizes { pointer, x, zeta: number(fields, "zeta", false)? })
    }
}

impl OrMore {
    fn take(fields: &mut Fields<'_>, states: usize) -> Outcome<OrMore> {
        let defect = number(fields, "defect_q_t", false)?;
        let rates = [of_states(fields, "q_tx", false, states)?, number(fields, "q_te", false)?];
        let mut slope = |name| of_states(fields, name, false, states);
        Ok(OrMore { defect, rates, slopes: [slope("f_x")?, slope("f_e")?] })
    }
}

impl States {
    /// s_x: how far the states go with an error that is at most `e`, and with a defect.
    pub(super) fn follow(&self, d: &Data<'_>, e: &Interval, defect: &Rational) -> Interval {
        let States { low, up, decay, .. } = self;
        let [low, up, c, gamma, d_x] = [low, up, &decay[0], &decay[1], defect].map(|value| d.number(value));
        (&up / (low * &c) * (gamma * e.sqr() + (&up * &d_x).sqr() / c)).sqrt()
    }

    fn take(fields: &mut Fields<'_>, states: usize) -> Outcome<States> {
        let pointer = fields.pointer.clone();
        let field = fields.required("Q")?;
        let matrix = symmetric(&field)?;
        if matrix.len() != states {
            return bad(&field.pointer, "expected a row for each state");
        }
        let [low, up, c, gamma] =
            fields.each(["Q_low", "Q_up", "c", "gamma"], |fields, name| number(fields, name, true))?;
        for (name, what, sign, end) in [("Q_low", "Q_low I <= Q", 1, &low), ("Q_up", "Q <= Q_up I", -1, &up)] {
            let rows = shifted(&matrix, &Rational::from(sign), &Rational::from(end * sign));
            demand(Some(is_semidefinite(rows)), RULE, &format!("{pointer}/{name}"), what)?;
        }
        Ok(States { matrix: P::Own(matrix), low, up, decay: [c, gamma] })
    }
}
