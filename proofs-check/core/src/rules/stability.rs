//! Rules C4 and C5 of the sharp derivation (docs/mathematics.md, sections 5, 10.1 and 10.4).

use super::paths::{Path, Paths};
use super::set::ClaimedSet;
use crate::bound::Bound;
use crate::data::Data;
use crate::interval::Interval;
use crate::verdict::Condition;

/// What the plant's data give on the error box |xt| <= D_x, |et| <= D_e around |x| <= x_per, |e| <= e_per.
pub struct ErrorBox {
    pub x_b: Interval,
    pub e_b: Interval,
    pub k_x: Interval,
    /// dq/de lies in [-k_e, most].
    pub k_e: Interval,
    pub most: Interval,
    pub k_f: Interval,
    /// a_2: alpha - gam, or the rate where it is larger.
    pub rate: Interval,
    /// The condition on q_e_max, where it is given.
    pub one_sided: Option<Condition>,
}

impl ErrorBox {
    /// `gam = c [b_fxx(x_per,0) x_per + b_fex(x_per,E) E + b_fxx(X_b,E) D_x/2]`, `k_x = b_qx/sqrt(P_low)`, k_e, k_f, with
    /// (X_b, E_b) = (x_per + D_x, e_per + D_e), which must lie in the domain, at the arguments of the paths; E is the one where f
    /// has d/dx.
    pub fn new(d: &Data<'_>, paths: Paths, [x_per, e_per]: [&Interval; 2], [d_x, d_e]: [&Interval; 2]) -> ErrorBox {
        let (x_b, e_b) = (x_per + d_x, e_per + d_e);
        let e_f = paths.f.e_at_dx(e_per, &e_b);
        let bends = d.bound(Bound::Fxx, x_per, &d.int(0)) * x_per + d.bound(Bound::Fxx, &x_b, e_f) * d_x / 2;
        let gam = &d.c * (bends + d.bound(Bound::Fex, x_per, e_f) * e_f);
        let x_q = paths.q.x_at_de(x_per, &x_b);
        let k_e = d.bound(Bound::Qe, x_q, &e_b);
        let given = d.q_e_max(x_q, &e_b);
        let place = if paths.q == Path::ErrorFirst { "(x_per, E_b)" } else { "(X_b, E_b)" };
        ErrorBox {
            rate: d.better_rate(&(&d.alpha - &gam), false, &x_b, e_f),
            k_x: d.bound(Bound::Qx, &x_b, paths.q.e_at_dx(e_per, &e_b)) / d.p_low.sqrt(),
            k_f: d.bound(Bound::Fe, paths.f.x_at_de(x_per, &x_b), &e_b),
            one_sided: one_sided(place, &k_e, given.as_ref()),
            most: given.map_or_else(|| k_e.clone(), |given| given.min(&k_e)),
            k_e,
            x_b,
            e_b,
        }
    }

    /// k_e and most, with a gain those of [`crate::input_gain::Gain::sector`].
    fn sector(&self, d: &Data<'_>, ht: &Interval, sigma: &Interval) -> [Interval; 2] {
        match &d.gain {
            Some(gain) => gain.sector([ht, sigma], [&self.k_e, &self.most]),
            None => [self.k_e.clone(), self.most.clone()],
        }
    }

    /// C5 by its closed form, with ht = h/mu, A = w_x a_2 and D = max{|1 + ht most|, |1 - ht k_e|}: `ht k_x^2`, `4 A`, and, if the
    /// first is below the second, the threshold `D^2/(4 ht) + (w_x sqrt(P_up) k_f + k_x D/2)^2/(4A - ht k_x^2)` of sigma. With a gain
    /// they are those of its sector, at sigma.
    pub fn decay(&self, d: &Data<'_>, [w_x, h]: [&Interval; 2], sigma: &Interval) -> [Interval; 3] {
        let ht = h / &d.mu;
        let (coupling, curvature) = (&ht * self.k_x.sqr(), w_x * &self.rate * 4);
        let [k_e, most] = self.sector(d, &ht, sigma);
        let size = (1 + &ht * &most).abs().max(&(1 - &ht * &k_e).abs());
        let cross = w_x * d.p_up.sqrt() * &self.k_f + &self.k_x * &size / 2;
        let room = &curvature - &coupling;
        let share = if room.is_positive() { cross.sqr() / room } else { Interval::undefined(d.precision) };
        [coupling, curvature, size.sqr() / (ht * 4) + share]
    }

    /// C5 as conditions, on the gain that is named; before them the one on q_e_max.
    pub fn conditions(
        &self,
        [coupling, curvature, threshold]: [Interval; 3],
        sigma: Interval,
        name: &str,
    ) -> Vec<Condition> {
        let mut conditions: Vec<Condition> = self.one_sided.iter().cloned().collect();
        conditions.push(Condition::less("C5", "(h/mu) k_x^2 < 4 w_x a_2", coupling, curvature));
        let what = format!("threshold of the quadratic form < {name}");
        conditions.push(Condition::less("C5b", what, threshold, sigma));
        conditions
    }
}

/// The condition that q_e_max, where it is given, is not below the lower bound -b_qe of dq/de.
pub fn one_sided(place: &str, q_e: &Interval, most: Option<&Interval>) -> Option<Condition> {
    let what = format!("-b_qe <= q_e_max at {place}");
    most.map(|most| Condition::at_most("M", what, -q_e, most.clone()))
}

/// dX = X_0 + x_per, dE = E_0 + e_per, and dZ = Z_0 + Nbar E_0 + Z, or Z where zeta = z - M e starts at 0.
pub fn distances(d: &Data<'_>, set: &ClaimedSet, [x_per, e_per, z]: [&Interval; 3]) -> [Interval; 3] {
    let [x0, e0] = [&set.x0, &set.e0].map(|size| d.number(size));
    let of_zeta = set.z0.as_ref().map_or_else(|| z.clone(), |z0| d.number(z0) + &d.n_bar * &e0 + z);
    [x0 + x_per, &e0 + e_per, of_zeta]
}

/// The two sides of C4: `w_x P_up dX^2 + dE^2 + h dZ^2` and `min{w_x P_low D_x^2, D_e^2}`. At the gain b the weight of `|zeta|_N^2` is
/// b h: with a gain C4 is that of b_hi h.
pub fn level(d: &Data<'_>, [x, e, z]: &[Interval; 3], [d_x, d_e, w_x, h]: [&Interval; 4]) -> [Interval; 2] {
    let start = w_x * &d.p_up * x.sqr() + e.sqr() + h * z.sqr();
    [start, (w_x * &d.p_low * d_x.sqr()).min(&d_e.sqr())]
}
