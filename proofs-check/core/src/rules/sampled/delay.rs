//! Rules for a law whose control is computed in the sample before it acts (docs/mathematics.md, section 13.4): C4d, and what the last y
//! has in the control. C5d, in one variable more than C5h, is with that one.
//!
//! `et_{k+1} = e_k - h sigma et_k`, `z_{k+1} = R (z_k - M e_k) + M et_{k+1}`, `u_{k+1} = -sigma et_{k+1} + K M'N R (z_{k+1} - M et_{k+1})`.
//! With `zeta = z - M e` and `y_k = q_k + (u_k + sigma et_k)` exactly `e_{k+1} = et_{k+1} + h y_k`, `zeta_{k+1} = R zeta_k - h M y_k`: y_{k-1} is
//! what the last prediction was off by, over h. What falls is `U + gm h y_{k-1}^2`.

use super::law::Law;
use crate::data::Data;
use crate::interval::Interval;
use crate::json::Fields;
use crate::rules::set;
use crate::verdict::{Condition, Outcome};
use rug::Rational;

/// The further free numbers.
#[derive(Clone, Debug)]
pub struct Past {
    /// gm, the weight of h y_{k-1}^2.
    pub gm: Rational,
    /// Y_0: a solution starts with `|e_0 - et_0| <= h Y_0`.
    pub y_0: Rational,
    /// Y_0 as it is written.
    pub text: String,
}

impl Past {
    /// Takes them out of a witness.
    pub fn read(fields: &mut Fields<'_>) -> Outcome<Past> {
        let gm = fields.number("gm")?;
        let y_0 = fields.required("Y_0")?;
        Ok(Past { gm, y_0: y_0.rational()?, text: y_0.numeral()?.to_owned() })
    }

    /// gm > 0 and Y_0 >= 0; a start with et_0 = 0 is among those of the claim: `E_0 <= h Y_0`, exactly where h is rational.
    pub fn conditions(&self, law: &Law<'_>, e_0: &Rational, pointer: &str) -> Outcome<Condition> {
        set::positive(&[("gm", &self.gm)], pointer)?;
        let d = law.d;
        let room = match d.spec.period.exact().and_then(|period| period.rational()) {
            Some(period) => d.number(&(period * &self.y_0 / law.samples - e_0)),
            None => &law.h * d.number(&self.y_0) - d.number(e_0),
        };
        Ok(Condition::at_most("set", "0 <= h Y_0 - E_0", d.int(0), room))
    }

    /// What is stored in the level of C4d, and what the last y adds to the square of the control over the level:
    /// `u = -sigma e + K M'N R zeta + h (sigma + K b1) y_{k-1}`, |b1| <= Nb2, and the level is not below `e^2 + b h |zeta|_N^2 + gm h y_{k-1}^2` at the
    /// gain b.
    ///
    /// At the start y_{-1} is within Y_0 of 0, that of the periodic solution within `y_per`. Where the regulator starts with z = M e the last y
    /// that zeta is told is 0 there and that of e is not: both are within the sum.
    pub fn level(&self, law: &Law<'_>, y_per: &Interval) -> [Interval; 2] {
        let gm = law.d.number(&self.gm);
        let stored = &gm * &law.h * (law.d.number(&self.y_0) + y_per).sqr();
        [stored, &law.h * (&law.sigma + &law.gain * law.sum()).sqr() / gm]
    }
}

/// sup|y_k| of the periodic solution: `Y min{ sqrt(N_s) R_q, sqrt((T^2 - h^2)/12) R_1 }`, where each |y_j| is at most Y times |q_j| and y has no
/// mean.
pub fn largest(law: &Law<'_>, of_y: &Interval, [r_q, r_1]: [&Interval; 2]) -> Interval {
    let d: &Data<'_> = law.d;
    let by_rate = ((d.period.only().sqr() - law.h.sqr()) / 12).sqrt() * r_1;
    of_y * (d.int(i64::from(law.samples)).sqrt() * r_q).least(&by_rate)
}
