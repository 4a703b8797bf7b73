//! The periodic solution x_0 of `x' = f(t,x,0)` near xb (docs/mathematics.md, section 11.2, P1).
//!
//! Guarantee: exactly one T-periodic solution has `|L^-1 (x_0 - xb)| <= rho` for all t, and it has at most r there; each P is
//! between its p_low and p_up, and has its rate alpha in the tube.

use super::formula::{Formulas, Id};
use super::machine::Curves;
use super::model::Model;
use super::parts::Orbit;
use super::path::{Expanded, Judged, Path, bound, bound_of_norm, everywhere, total};
use super::question::Question;
use super::read::Plant;
use super::region::{Piece, Region};
use proofs_core::interval::Interval;
use proofs_core::jacobian::Witness;
use proofs_core::matrix::{self, is_semidefinite};
use proofs_core::verdict::{Outcome, demand};
use rug::Rational;

/// The name of this rule.
pub const RULE: &str = "orbit";

/// `(c/alpha) eps <= r < rho` with `c^2 = p_up/p_low`, exactly.
pub fn radii(orbit: &Orbit, stability: &Witness) -> Outcome<()> {
    let [p_low, p_up, alpha] = &stability.numbers;
    let square = |value: &Rational| Rational::from(value.square_ref());
    let (needed, given) = (square(&orbit.defect) * p_up, square(&Rational::from(&orbit.radius * alpha)) * p_low);
    let pointer = |name: &str| format!("{}/{name}", orbit.pointer);
    demand(Some(needed <= given), RULE, &pointer("radius"), "(c/alpha) defect <= radius")?;
    demand(Some(orbit.radius < orbit.tube), RULE, &pointer("tube"), "radius < tube")
}

/// `P - p_low I` and `p_up I - P` as questions; nothing where P is constant and that is decided exactly.
pub fn sizes(plant: &Plant, model: &mut Model) -> Outcome<Vec<(usize, &'static str, Question)>> {
    let states = model.states();
    let mut questions = Vec::new();
    for (which, w) in plant.lyapunov.iter().enumerate() {
        let [p_low, p_up, _] = &w.numbers;
        let constant = w.harmonics.iter().flatten().flatten().flatten().all(Rational::is_zero);
        for (sign, end, what) in [(1, p_low, "p_low I <= P"), (-1, p_up, "P <= p_up I")] {
            if constant {
                let rows = matrix::shifted(&w.mean, &Rational::from(sign), &Rational::from(end * sign));
                demand(Some(is_semidefinite(rows)), RULE, &w.pointer, what)?;
                continue;
            }
            let p = model.lyapunov[which].clone();
            let rows = shifted(&mut model.formulas, &p, end, sign);
            questions.push((which, what, Question::new(&mut model.formulas, rows, states)));
        }
    }
    Ok(questions)
}

/// `sign (P - end I)`, its lower triangle.
pub fn shifted(formulas: &mut Formulas, p: &[Vec<Id>], end: &Rational, sign: i32) -> Vec<Vec<Id>> {
    let (end, zero) = (formulas.number(end), formulas.int(0));
    let entry = |i: usize, j: usize, formulas: &mut Formulas| {
        let taken = if i == j { end } else { zero };
        formulas.make(if sign > 0 { p[i][j] - taken } else { taken - p[i][j] })
    };
    (0..p.len()).map(|i| (0..=i).map(|j| entry(i, j, formulas)).collect()).collect()
}

/// `|L^-1 (f(t,xb,0) - xb')| <= eps` for all t and all parameters, `defect` the components of the
/// left side with their derivatives in the parameters; how many boxes that took.
pub fn defect(
    plant: &Plant,
    defect: &[Vec<Id>],
    model: &Model,
    curves: &Curves,
    om: &Interval,
    period: &Interval,
) -> Outcome<usize> {
    let p = om.precision();
    let machine = super::machine::Machine::new(&model.formulas, curves, om);
    let values = machine.values();
    let path = Path::new(&machine, curves, om, defect);
    let family = Region::of_family(plant, p);
    let most = Interval::rational(&plant.orbit.defect, p);
    let judge = |piece: &Piece| {
        let (expanded, half) = (Expanded::new(&path, piece, &values), piece.cell.all.half_width());
        let norm = |parts: &[Interval]| parts.iter().fold(Interval::int(0, p), |sum, part| sum + part.sqr()).sqrt();
        let in_t = bound_of_norm(&expanded.at_middle, &half);
        let moves = expanded.moves(|slope| bound(slope, &half));
        let together: Vec<Interval> =
            (0..plant.states()).map(|j| total(moves.iter().map(|parts| &parts[j]), p)).collect();
        if (&in_t + norm(&together)).le(&most) == Some(true) {
            return Judged::Proved;
        }
        let at_middle = norm(&expanded.at_middle.iter().map(|part| part.coefficients[0].clone()).collect::<Vec<_>>());
        if most.lt(&at_middle) == Some(true) && family.has_middle(piece) {
            return Judged::Refuted;
        }
        let shares = moves.iter().map(|parts| norm(parts));
        Judged::Halve([in_t - at_middle].into_iter().chain(shares).map(|share| share.hi().to_f64()).collect())
    };
    everywhere(family.whole(&machine, machine.period(period)), judge).or_else(|(t, refuted)| {
        let pointer = format!("{}/defect", plant.orbit.pointer);
        let what = format!("|L^-1 (f(t,xb,0) - xb')| <= defect near t = {t:.6}");
        demand(refuted.then_some(false), RULE, &pointer, what).map(|()| 0)
    })
}
