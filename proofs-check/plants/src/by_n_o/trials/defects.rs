//! The defects of a trial at every t and for every member (docs/mathematics.md, section 14.4).
//!
//! On a cell of t and a box of p and b, at first all of them, each is a polynomial in t, p and b with a bound of the rest ([`crate::expansion`]), by one
//! evaluation of the formulas. How large the polynomial is where its coefficients do not say it is found on parts of the cell and the box
//! ([`crate::within`]), without the formulas; they are evaluated again on halves where the rest is too large.

use super::around::Around;
use crate::expansion::{Expansion, Expansions};
use crate::formula::{Id, Leaf};
use crate::machine::{Machine, Values};
use crate::path::{Judged, ORDER, Path, coefficient, everywhere};
use crate::powers::Powers;
use crate::region::{Piece, Region};
use crate::within::{Found, shares, within};
use crate::{PRECISION, TAYLOR_PRECISIONS};
use proofs_core::interval::Interval;
use proofs_core::rules::by_n_o::claimed::RULE;
use proofs_core::verdict::{Outcome, demand};

/// The degree in t, p and b together, by the number of p and b.
const DEGREES: [usize; 5] = [ORDER, 10, 8, 6, 5];
/// With more of them.
const LEAST_DEGREE: usize = 4;

/// What is known at a point is to be known to this share of what it is compared with.
const SHARE: i64 = 16;

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
        let powers = Powers::new(1 + numbers, DEGREES.get(numbers).copied().unwrap_or(LEAST_DEGREE));
        let number = |defect| Interval::rational(defect, p);
        let [d_x, d_q] = self.trial.defects.each_ref().map(number);
        let of_rate = self.trial.or_more.as_ref().map(|more| number(&more.defect));
        let most: Vec<Interval> = [d_x, d_q - kappa.round(p)].into_iter().chain(of_rate).collect();
        let family = Region::of_family(&self.plant, p);
        let whole = family.whole(&machine, machine.period(period));
        // Which of them is open on the last box, and whether that is for the precision.
        let (mut open, mut coarse) = (0, false);
        let judge = |piece: &Piece| {
            let mut rest = self.expanded(&path, piece, &powers, &values);
            let mut all = [rest.drain(..self.plant.states()).collect(), Vec::new(), Vec::new()];
            all.iter_mut().skip(1).zip(rest).for_each(|(vector, one)| vector.push(one));
            for (which, (most, vector)) in most.iter().zip(&all).enumerate() {
                let found = within(&powers, vector.clone(), most);
                if matches!(found, Found::Within) {
                    continue;
                }
                open = which;
                match found {
                    Found::Above(xi) if family.has(&place(piece, &xi)) => return Judged::Refuted,
                    _ => {}
                }
                let noise = vector.iter().fold(Interval::int(0, p), |sum, one| sum + one.first().half_width());
                if !is_last && (noise * SHARE).le(most) == Some(false) {
                    coarse = true;
                    return Judged::Open;
                }
                return Judged::Halve(hints(&powers, vector, piece, &whole));
            }
            Judged::Proved
        };
        match everywhere(whole.clone(), judge) {
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

    /// The defects on a box.
    fn expanded(&self, path: &Path<'_, '_>, piece: &Piece, powers: &Powers, values: &Values) -> Vec<Expansion> {
        let (machine, formulas) = (path.machine, &self.model.formulas);
        let (p, degree) = (machine.precision, powers.degree());
        let on_cell = path.on_cell(&piece.cell);
        let zero = || Interval::int(0, p);
        let half = piece.half_width(None);
        // `t = middle + half xi_0`: the powers of xi_0 alone.
        let scales: Vec<Interval> = (0..=degree + 1).map(|k| half.powi(k as i32)).collect();
        let of_time: Vec<usize> = std::iter::successors(Some(0), |place| powers.raised(*place, 0)).collect();
        let leaf = |leaf: Leaf| {
            if let Leaf::Parameter(i) = leaf {
                // The first side is that of e, and the first number of the powers is t.
                let mut coefficients = vec![zero(); 3 + i];
                let middle = piece.sides.get(1 + i).map(Interval::middle);
                coefficients[0] = middle.unwrap_or_else(|| Interval::undefined(p));
                coefficients[2 + i] = piece.half_width(Some(1 + i));
                return Expansion::exact(coefficients, p);
            }
            let [thin, thick] =
                [false, true].map(|on_all| on_cell.series(leaf, &[], on_all, degree + 1 + usize::from(on_all)));
            let mut coefficients = Vec::new();
            for (k, place) in of_time.iter().enumerate().take(thin.len()) {
                coefficients.resize_with(*place, zero);
                coefficients.push(coefficient(&thin, k, p) * &scales[k]);
            }
            let rest = coefficient(&thick, degree + 1, p).abs() * &scales[degree + 1];
            Expansion { coefficients, rest: rest.ceiling() }
        };
        let order = formulas.below(&self.defects);
        let expansions = Expansions { powers, precision: p };
        let all = expansions.expand(formulas, &order, |id| machine.number(id, values), leaf);
        self.defects.iter().map(|root: &Id| all[root.0].clone()).collect()
    }
}

/// Zero for e, and p and b.
fn place(piece: &Piece, xi: &[Interval]) -> Vec<Interval> {
    let mut place = piece.middles();
    let moved = place.iter_mut().enumerate().skip(1).zip(xi.iter().skip(1));
    moved.for_each(|((side, middle), xi)| *middle = &*middle + piece.half_width(Some(side)) * xi);
    place
}

/// How much t and each number add to what is not in the polynomials, by their terms of the largest degree; where these say nothing, how wide the box is.
fn hints(powers: &Powers, vector: &[Expansion], piece: &Piece, whole: &Piece) -> Vec<f64> {
    let numbers = piece.sides.len();
    if vector.iter().all(Expansion::is_defined) {
        let shares = shares(powers, vector, numbers, powers.degree());
        if shares.iter().any(|share| *share > 0.0) {
            return shares;
        }
    }
    (0..numbers).map(|side| piece.share(Some(side).filter(|side| *side > 0), whole)).collect()
}
