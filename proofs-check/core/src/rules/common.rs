//! What the rules for both regulators share (docs/mathematics.md, sections 5, 10 and 12): the free numbers of a witness, the
//! conditions on the set, the domain and the level, and what is said of the periodic solution.

use super::control;
use super::mean_squares::Means;
use super::paths::Paths;
use super::set::{self, ClaimedSet};
use super::stability::{ErrorBox, distances, level};
use crate::data::Data;
use crate::interval::Interval;
use crate::json::Fields;
use crate::verdict::{Condition, Outcome};
use rug::Rational;

/// The free numbers of either regulator.
#[derive(Clone, Debug)]
pub struct Free {
    /// Where they stand in the file.
    pub pointer: String,
    /// The initial conditions.
    pub set: ClaimedSet,
    pub x_p: Rational,
    pub e_p: Rational,
    /// r_x, r_e, r_d.
    pub r: Means,
    pub d_x: Rational,
    pub d_e: Rational,
    pub w_x: Rational,
    /// The weight of zeta.
    pub h: Rational,
    pub k0: Rational,
    pub k1: Rational,
    pub paths: Paths,
}

/// The sizes |x|, |e|, |zeta|_N of the periodic solution that are proved.
pub struct Sizes {
    pub x: Interval,
    pub e: Interval,
    pub zeta: Interval,
}

impl Sizes {
    /// With that of z = zeta + M e, under the names in a file.
    pub fn named(&self, d: &Data<'_>) -> [(&'static str, Interval); 4] {
        let z = &self.zeta + &d.n_bar * &self.e;
        [("x", self.x.clone()), ("e", self.e.clone()), ("zeta", self.zeta.clone()), ("z", z)]
    }
}

/// What was evaluated of a derivation.
pub struct Evaluated {
    /// The sizes of the periodic solution.
    pub sizes: Sizes,
    /// The bounds of the control ([`super::control`]).
    pub control: [Interval; 2],
    /// The conditions, in the order of the file.
    pub conditions: Vec<Condition>,
    /// The comparisons of the transfer proof, any of which may stand for it in the list of conditions.
    pub transfer: Vec<Condition>,
    /// The largest X and E at which bounding functions are used.
    pub arguments: [Interval; 2],
}

impl Free {
    /// Takes the free numbers out of a witness.
    pub fn read(fields: &mut Fields<'_>, set: ClaimedSet) -> Outcome<Free> {
        let r = fields.numbers(["r_x", "r_e", "r_d"])?;
        let [x_p, e_p, d_x, d_e, w_x, h, k0, k1] =
            fields.numbers(["X_p", "E_p", "D_x", "D_e", "w_x", "h", "k0", "k1"])?;
        let (paths, pointer) = (Paths::read(fields)?, fields.pointer.clone());
        Ok(Free { pointer, set, x_p, e_p, r, d_x, d_e, w_x, h, k0, k1, paths })
    }

    /// Demands the signs that both regulators need, and of these numbers besides.
    pub fn signs(&self, others: &[(&str, &Rational)]) -> Outcome<()> {
        let mut named = vec![("X_p", &self.x_p), ("E_p", &self.e_p), ("D_x", &self.d_x), ("D_e", &self.d_e)];
        named.extend(["r_x", "r_e", "r_d"].into_iter().zip(&self.r));
        named.extend([("w_x", &self.w_x), ("h", &self.h)]);
        set::positive(&[&named, others].concat(), &self.pointer)
    }

    /// The error box around a solution of these sizes, how far the start is from it (dX, dE, dZ), and the conditions before those of the
    /// level and of stability: on the set and the domain, T, and those of existence that are given.
    pub fn evaluate(
        &self,
        d: &Data<'_>,
        sizes: Sizes,
        transfer: Vec<Condition>,
        existence: impl IntoIterator<Item = Condition>,
    ) -> (ErrorBox, [Interval; 3], Evaluated) {
        let [x_p, e_p, d_x, d_e] = [&self.x_p, &self.e_p, &self.d_x, &self.d_e].map(|value| d.number(value));
        let error_box = ErrorBox::new(d, self.paths, [&sizes.x, &sizes.e], [&d_x, &d_e]);
        let arguments = [x_p.max(&error_box.x_b), e_p.max(&error_box.e_b)];
        let mut conditions = set::covers(d, &self.set, [&self.x_p, &self.e_p], &sizes.zeta);
        conditions.extend(set::domain(d, &arguments[0], &arguments[1]));
        conditions.push(transfer[0].clone());
        conditions.extend(existence);
        let reach = distances(d, &self.set, [&sizes.x, &sizes.e, &sizes.zeta]);
        let control = [(); 2].map(|()| Interval::undefined(d.precision));
        (error_box, reach, Evaluated { sizes, control, conditions, transfer, arguments })
    }

    /// C4 of U, at dX, dE, dZ, and how far the control -sigma e + mu M'N zeta goes from there; `of_u`: sigma and mu. At the gain b the weight
    /// of zeta is b h, in the level too: the square of the second is convex in b, and the larger of those at both ends of b bounds it. In
    /// continuous time the level is that at b_hi, and the weight that at b_lo, times `share`: of a matrix inequality whose threshold tau is below
    /// sigma, U with `tau/sigma` times that weight is what falls (section 13.1, Theorem G3). `past`: what a delay adds to the level, and to the square
    /// of the control over it (section 13.4).
    pub fn level(
        &self,
        d: &Data<'_>,
        reach: &[Interval; 3],
        of_u: [&Interval; 2],
        (at_samples, share, past): (bool, &Interval, Option<[Interval; 2]>),
    ) -> (Condition, Interval) {
        let [d_x, d_e, w_x, h] = [&self.d_x, &self.d_e, &self.w_x, &self.h].map(|value| d.number(value));
        let [low, high] = [d.by_gain(|gain| &gain.low, &h), d.by_gain(|gain| &gain.high, &h)];
        let [[mut least, _], [mut start, exit]] = [&low, &high].map(|h| level(d, reach, [&d_x, &d_e, &w_x, h]));
        let weight = if d.gain.is_some() { "b_hi h" } else { "h" };
        let mut what = format!("w_x P_up dX^2 + dE^2 + {weight} dZ^2 < min{{w_x P_low D_x^2, D_e^2}}");
        let mut more = d.int(0);
        let id = if past.is_some() { "C4d" } else { "C4" };
        if let Some([stored, of_control]) = past {
            (least, start, more) = (least + &stored, start + stored, of_control);
            what = format!("gm h (Y_0 + y_per)^2 + {what}");
        }
        let transient = |level, h| control::transient(d, of_u, [&d.int(1), h], (level, &more));
        let transient = if at_samples {
            transient(&least, &low).max(&transient(&start, &high))
        } else {
            transient(&start, &(&low * share))
        };
        (Condition::less(id, what, start, exit), transient)
    }
}
