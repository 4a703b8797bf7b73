//! Rule C5h: what `U = w_x xi^2 + e^2 + eta |zeta|_N^2` loses from a sample to any time t in (0, h] after it (docs/mathematics.md,
//! section 12.3).
//!
//! Guarantee: with X = rms of xi on that time, E = |e_k|, Y = |y|, the loss over t is at least `(1 - t/h) Q_0 + (t/h) Q_h`, for every
//! coefficient of the form Q_t is concave in t where X, E, Y >= 0. The two are positive definite, so U falls, inside the
//! intervals too.

use super::law::Law;
use crate::interval::Interval;
use crate::rules::stability::ErrorBox;
use crate::verdict::Condition;

type Form = [[Interval; 3]; 3];

/// k_e = max{k_l, m} bounds |dq/de| in the error box.
fn steepness(error_box: &ErrorBox) -> Interval {
    error_box.k_e.max(&error_box.most)
}

/// C5h: `kp = 1 - h k_e/pi > 0`, and the leading minors of Q_0 and Q_h. With a gain the weight of zeta is `b eta` (section 13.1), so that
/// `eta/K` stands beside y for every b.
pub fn conditions(law: &Law<'_>, error_box: &ErrorBox, [w_x, eta]: [&Interval; 2]) -> Vec<Condition> {
    let zero = law.d.int(0);
    let room = 1 - &law.h * steepness(error_box) / Interval::pi(law.d.precision);
    let mut conditions = vec![Condition::less("C5h", "0 < 1 - h k_e/pi", zero.clone(), room.clone())];
    for (name, at_end) in [("Q_0", false), ("Q_h", true)] {
        let minors = minors(&form(law, error_box, [w_x, eta], &room, at_end));
        let positive = |(i, minor): (usize, Interval)| {
            Condition::less("C5h", format!("0 < minor {} of {name}", i + 1), zero.clone(), minor)
        };
        conditions.extend(minors.into_iter().enumerate().map(positive));
    }
    conditions
}

/// The symmetric matrix of Q_t in (X, E, Y) at t = 0 or t = h.
fn form(law: &Law<'_>, error_box: &ErrorBox, [w_x, eta]: [&Interval; 2], room: &Interval, at_end: bool) -> Form {
    let d = law.d;
    let [t, ts, loss] =
        if at_end { [&law.h, &law.share, &law.loss].map(Interval::clone) } else { [0; 3].map(|zero| d.int(zero)) };
    let (k_e, k_x) = (steepness(error_box), &error_box.k_x);
    let reach = &t / room;
    let drift = &reach * &k_e / Interval::pi(d.precision);
    let c_x = &reach * k_x / Interval::pi(d.precision);
    let c_e = (1 - &ts + ts.sqr() / 3).sqrt() + drift;
    let c_y = &reach / d.int(3).sqrt();
    let g = &reach * &k_e / d.int(12).sqrt();
    let bend = &t * &reach * k_e.sqr() / 6;
    let coupling = w_x * d.p_up.sqrt() * &error_box.k_f;
    let scaled = eta / &law.gain;
    let mean = &scaled * (1 - &ts / 2);
    let rest = 1 - &ts;
    // y has (1-b) sigma e_k in it.
    let [up, down] = law.shifts(&(&scaled * &law.sigma));
    let damping = (&rest + &mean * &error_box.most + up).abs().max(&(&rest - &mean * &error_box.k_e + down).abs());

    let xx = w_x * &error_box.rate * 2 - &coupling * &c_x * 2;
    let xe = -(&coupling * c_e);
    let xy = -(&coupling * c_y + &scaled * k_x * (1 + &g));
    let ee = &law.sigma * (2 - ts);
    let ey = -(damping + &scaled * g * k_e);
    let yy = &scaled * 2 * (1 - loss) - &t - &scaled * t * &error_box.most - scaled * bend * 2;
    [[xx, xe.clone(), xy.clone()], [xe, ee, ey.clone()], [xy, ey, yy]]
}

/// The leading principal minors: all are positive exactly if the form is positive definite (Sylvester).
fn minors([[xx, xe, xy], [_, ee, ey], [_, _, yy]]: &Form) -> [Interval; 3] {
    let second = xx * ee - xe.sqr();
    let third = yy * &second - xx * ey.sqr() + xe * xy * ey * 2 - ee * xy.sqr();
    [xx.clone(), second, third]
}
