//! How large the control of a proved claim gets (docs/mathematics.md, section 13.5), at the gain of the claim and no other.
//!
//! Guarantee: |u| of the periodic solution is at most `steady` for every n_o, and every solution from the claimed set has
//! |u - u_per| <= `transient` at all times. Of an actuator with an input gain that is so of what it is given, the control of the law over
//! the nominal gain ([`put_out`]); before, u is that of the law. Where an actuator is given it never saturates ([`saturation`]).

use crate::data::Data;
use crate::interval::Interval;
use crate::verdict::Condition;

/// The bounds under their names in a file.
pub const NAMES: [&str; 2] = ["steady", "transient"];

/// `|u_j| <= factor |q_j|` for the harmonics of q but for the mean, which u answers by its opposite; `by_rate` bounds the sum of all
/// of these |u_j| over the root mean square of q'.
pub struct Answer {
    /// |u_0| over |q_0|.
    pub mean: Interval,
    pub factor: Interval,
    pub by_rate: Interval,
}

impl Answer {
    /// `2/sqrt(3)`; with `sum 1/om_j^2 = T^2/12` over both signs `T/3`. With a gain b u_j is `(i om e_j - q_j)/b` and u_0 `-q_0/b`, and the factor
    /// `sqrt(1 + 2/(4 b - 1 + sqrt(1 + 8 b)))/b`, which falls in b.
    pub fn continuous(d: &Data<'_>) -> Answer {
        let b = d.by_gain(|gain| &gain.low, &d.int(1));
        let more = 2 / (&b * 4 - 1 + (&b * 8 + 1).sqrt());
        let factor = (more + 1).sqrt() / &b;
        Answer { mean: b.recip(), by_rate: &factor * d.period.longest() / d.int(12).sqrt(), factor }
    }

    /// The least of what the harmonics of q say, with its root mean squares and with `q_0`, and of what the sizes of e and zeta do:
    /// u = -sigma e + mu M'N zeta.
    pub fn steady(&self, along: &Along, by_parts: &Interval) -> Interval {
        let [[r_q, r_1], [d_0, d_1]] = &along.inputs;
        let plain = |mean: &Interval| (&self.mean * mean + &self.by_rate * r_1).least(by_parts);
        let Some([mean, others, rest, rest_t]) = &along.harmonics else { return plain(r_q) };
        let mean = r_q.least(&(mean + rest + d_0));
        plain(&mean).least(&(&self.mean * &mean + &self.factor * others + &self.by_rate * (rest_t + d_1)))
    }
}

/// What is known of q along the periodic solution.
pub struct Along {
    /// R_q, R_1; d_0, d_1.
    pub inputs: [[Interval; 2]; 2],
    /// C_0, 2 sum_{k>=1} C_k, r_0 and r_1, where `q_0` is given.
    pub harmonics: Option<[Interval; 4]>,
}

/// The bounds of what is put out, from those of the control of the law.
pub fn put_out(d: &Data<'_>, bounds: [Interval; 2]) -> [Interval; 2] {
    match &d.spec.input_gain {
        Some(gain) => bounds.map(|bound| bound / gain.nominal.enclose(d.precision)),
        None => bounds,
    }
}

/// C6, where the claim does not keep to the actuator by what it says by n_o: of a solution from the claimed set what is put out is never larger than the actuator takes. So it is a solution of the loop with the
/// saturation, too, whose solutions are unique.
pub fn saturation(d: &Data<'_>, [steady, transient]: &[Interval; 2]) -> Option<Condition> {
    let actuator = d.spec.actuator.as_ref().filter(|actuator| !actuator.by_n_o)?;
    let max = actuator.max.enclose(d.precision);
    Some(Condition::at_most("C6", "steady + transient <= max of the actuator", steady + transient, max))
}

/// `sigma e_per + mu Nbar Z`.
pub fn by_parts(d: &Data<'_>, [sigma, mu]: [&Interval; 2], [e, zeta]: [&Interval; 2]) -> Interval {
    sigma * e + mu * &d.n_bar * zeta
}

/// `|sigma e - mu M'N zeta|` where `weight e^2 + h |zeta|_N^2 <= level`: the function that falls is not below that sum. `more` is what the last y adds
/// to the square of it over the level (section 13.4).
pub fn transient(
    d: &Data<'_>,
    [sigma, mu]: [&Interval; 2],
    [weight, h]: [&Interval; 2],
    (level, more): (&Interval, &Interval),
) -> Interval {
    (level * (sigma.sqr() / weight + (mu * &d.n_bar).sqr() / h + more)).sqrt()
}
