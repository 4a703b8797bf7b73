//! The defects of a trial at every t and for every member (docs/mathematics.md, section 14.4).
//!
//! Guarantee: on a box of t, p and b with the middle c a function is `sum over alpha of g_alpha(t) delta^alpha`, `delta = (p, b) - c`, with g_alpha from its
//! Taylor polynomial at c below a degree, and at that degree somewhere on the box; each g_alpha is a polynomial of t at the middle of the cell, and that of
//! `alpha = 0` has a remainder, from t anywhere in the cell and (p, b) anywhere on the box. So what is small at c together with its derivatives, as a
//! defect is, is small on the box.

use super::around::Around;
use crate::formula::Id;
use crate::jet::{Jets, Powers};
use crate::machine::{Machine, Values};
use crate::path::{
    Judged, ORDER, OnCell, Path, Polynomial, bound, bound_of_derivative, bound_of_norm, coefficient, everywhere, total,
};
use crate::region::{Piece, Region};
use crate::taylor::expand;
use crate::{PRECISION, TAYLOR_PRECISIONS};
use proofs_core::interval::Interval;
use proofs_core::rules::by_n_o::claimed::RULE;
use proofs_core::verdict::{Outcome, demand};

/// The degree up to which coefficients are those at the middle, by the number of p and b.
const DEGREES: [u32; 6] = [0, 6, 4, 3, 2, 2];

/// What is known at a point is to be known to this share of what it is compared with.
const SHARE: i64 = 16;

/// A function on a box.
struct Expanded {
    /// With p and b in the middle.
    at_middle: Polynomial,
    /// The others, each with a bound of `|delta^alpha|` and with alpha.
    moved: Vec<(Interval, Polynomial, Vec<u32>)>,
}

impl Expanded {
    /// How much it moves with p and b, by a bound of the polynomials.
    fn moves(&self, bound: &dyn Fn(&Polynomial) -> Interval, precision: u32) -> Interval {
        let parts: Vec<Interval> = self.moved.iter().map(|(size, polynomial, _)| size * bound(polynomial)).collect();
        total(parts.iter(), precision)
    }

    /// The same for each number, in which a power of more numbers counts by their exponents: a hint.
    fn shares(&self, bound: &dyn Fn(&Polynomial) -> Interval, numbers: usize) -> Vec<f64> {
        let mut shares = vec![0.0; numbers];
        for (size, polynomial, alpha) in &self.moved {
            let degree = f64::from(alpha.iter().sum::<u32>().max(1));
            let own = (size * bound(polynomial)).hi().to_f64() / degree;
            shares.iter_mut().zip(alpha).for_each(|(share, exponent)| *share += own * f64::from(*exponent));
        }
        shares
    }
}

impl Around<'_> {
    /// Proves `|L^-1 (f(t,xhat,ehat) - xhat')| <= d_x` and `|q(t,xhat,ehat) + b uhat - ehat'| + b_hi kappa <= d_q` at every t and for every member, and of
    /// an entry about so many oscillators or more `|(q(t,xhat,0) + b uhat)'| <= d_t`; `circle`: Om and the period at a precision; by how many boxes.
    pub fn defects(&self, circle: impl Fn(u32) -> [Interval; 2], kappa: &Interval, about: &str) -> Outcome<usize> {
        let [more, last] = TAYLOR_PRECISIONS;
        for p in [PRECISION, more] {
            if let Some(boxes) = self.at_precision(circle(p).each_ref(), kappa, about, false)? {
                return Ok(boxes);
            }
        }
        match self.at_precision(circle(last).each_ref(), kappa, about, true)? {
            Some(boxes) => Ok(boxes),
            None => demand(None, RULE, &self.trial.pointer, format!("the defects for {about}")).map(|()| 0),
        }
    }

    /// At the precision of Om; `None` where that does not suffice, unless it is the last one.
    fn at_precision(
        &self,
        [om, period]: [&Interval; 2],
        kappa: &Interval,
        about: &str,
        is_last: bool,
    ) -> Outcome<Option<usize>> {
        let p = om.precision();
        let machine = Machine::new(&self.model.formulas, &self.curves, om);
        let values = machine.values();
        let path = Path::new(&machine, &self.curves, om, &[]);
        let numbers = self.plant.family.len();
        let degree = DEGREES.get(numbers).copied().unwrap_or(1);
        // At the degree itself nothing moves without numbers.
        let powers = [degree, degree + u32::from(numbers > 0)].map(|degree| Powers::new(numbers, degree));
        let number = |defect| Interval::rational(defect, p);
        let [d_x, d_q] = self.trial.defects.each_ref().map(number);
        let of_rate = self.trial.or_more.as_ref().map(|more| number(&more.defect));
        let most: Vec<Interval> = [d_x, d_q - kappa.round(p)].into_iter().chain(of_rate).collect();
        let (family, zero) = (Region::of_family(&self.plant, p), Interval::int(0, p));
        // Which of them is open on the last box, and whether that is for the precision.
        let (mut open, mut coarse) = (0, false);
        let judge = |piece: &Piece| {
            let (all, half) = (self.expanded(&path, piece, &powers, &values), piece.cell.all.half_width());
            let (of_f, q) = all.split_at(self.plant.states());
            let of_value = |polynomial: &Polynomial| bound(polynomial, &half);
            let of_slope = |polynomial: &Polynomial| bound_of_derivative(polynomial, &half);
            let bounds: [&dyn Fn(&Polynomial) -> Interval; 3] = [&of_value, &of_value, &of_slope];
            // The value, or the slope, at the middle, with the precision of it.
            let at_middle = |which: usize| {
                let (parts, order) = [(of_f, 0), (q, 0), (q, 1)][which];
                let values: Vec<Interval> =
                    parts.iter().map(|part| coefficient(&part.at_middle.coefficients, order, p)).collect();
                let noise = values.iter().fold(zero.clone(), |sum, value| sum + value.half_width());
                (values.iter().fold(zero.clone(), |sum, value| sum + value.sqr()).sqrt(), noise)
            };
            let norm = |parts: Vec<Interval>| parts.iter().fold(zero.clone(), |sum, part| sum + part.sqr()).sqrt();
            let size = |which: usize| {
                let parts = if which == 0 { of_f } else { q };
                let moved = norm(parts.iter().map(|part| part.moves(bounds[which], p)).collect());
                let in_t = match which {
                    0 => bound_of_norm(parts.iter().map(|part| &part.at_middle), &half),
                    _ => norm(parts.iter().map(|part| bounds[which](&part.at_middle)).collect()),
                };
                (in_t, moved)
            };
            let wrong = |which: &usize| {
                let (in_t, moved) = size(*which);
                (in_t + moved).le(&most[*which]) != Some(true)
            };
            let Some(which) = (0..most.len()).find(wrong) else { return Judged::Proved };
            open = which;
            let (value, noise) = at_middle(which);
            if most[which].lt(&value) == Some(true) && family.has_middle(piece) {
                return Judged::Refuted;
            }
            if !is_last && (noise * SHARE).le(&most[which]) != Some(true) {
                coarse = true;
                return Judged::Open;
            }
            let of_t = (size(which).0 - value).hi().to_f64();
            let mut shares = vec![0.0; numbers];
            for part in if which == 0 { of_f } else { q } {
                shares.iter_mut().zip(part.shares(bounds[which], numbers)).for_each(|(sum, own)| *sum += own);
            }
            Judged::Halve([of_t].into_iter().chain(shares).collect())
        };
        match everywhere(family.whole(&machine, machine.period(period)), judge) {
            Ok(boxes) => Ok(Some(boxes)),
            Err(_) if coarse => Ok(None),
            Err((t, refuted)) => {
                let (name, what) = [
                    ("defect_x", "|L^-1 (f(t,xhat,ehat) - xhat')| <= defect_x"),
                    ("defect_q", "|q(t,xhat,ehat) + b uhat - ehat'| + b_hi kappa <= defect_q"),
                    ("defect_q_t", "|(q(t,xhat,0) + b uhat)'| <= defect_q_t"),
                ][open];
                let what = format!("{what} for {about}, near t = {t:.6}");
                demand(refuted.then_some(false), RULE, &format!("{}/{name}", self.trial.pointer), what).map(|()| None)
            }
        }
    }

    /// The defects on a box; the powers of the degree are those that the second list has besides.
    fn expanded(
        &self,
        path: &Path<'_, '_>,
        piece: &Piece,
        [below, all]: &[Powers; 2],
        values: &Values,
    ) -> Vec<Expanded> {
        let (machine, formulas) = (path.machine, &self.model.formulas);
        let (p, order) = (machine.precision, formulas.below(&self.defects));
        let on_cell: OnCell<'_> = path.on_cell(&piece.cell);
        let number = |id| machine.number(id, values);
        // The first side is that of e.
        let (middle, on_box) = (&piece.middles()[1..], &piece.sides[1..]);
        let jets = |powers, parameters: &[Interval]| {
            let jets = Jets { powers, length: ORDER + 1, precision: p };
            jets.expand(formulas, &order, number, |leaf| on_cell.series(leaf, parameters, false, ORDER + 1))
        };
        let at_middle = jets(below, middle);
        let on_all = if all.list.len() > below.list.len() { jets(all, on_box) } else { Vec::new() };
        let length = ORDER + 2;
        let remainders = expand(formulas, &order, number, |leaf| on_cell.series(leaf, on_box, true, length), length);
        let width = |alpha: &Vec<u32>| {
            let power = |(i, exponent): (usize, &u32)| piece.half_width(Some(1 + i)).powi(*exponent as i32);
            alpha.iter().enumerate().map(power).fold(Interval::int(1, p), |product, power| product * power)
        };
        let of = |root: &Id| {
            let series = |place: usize| {
                let jet = if place < below.list.len() { &at_middle[root.0] } else { &on_all[root.0] };
                jet[place].clone()
            };
            let moved = all.list.iter().enumerate().skip(1).map(|(place, alpha)| {
                let polynomial = Polynomial { coefficients: series(place), remainder: Interval::int(0, p) };
                (width(alpha), polynomial, alpha.clone())
            });
            let moved = moved.filter(|(_, polynomial, _)| !polynomial.coefficients.is_empty()).collect();
            let remainder = coefficient(&remainders[root.0], ORDER + 1, p);
            Expanded { at_middle: Polynomial { coefficients: series(0), remainder }, moved }
        };
        self.defects.iter().map(of).collect()
    }
}
