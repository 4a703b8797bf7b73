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
///
/// With a delay C5d, the same of the forms in (X, E, Y, P) for P = |y_{k-1}|, with the weight `gm`.
pub fn conditions(
    law: &Law<'_>,
    error_box: &ErrorBox,
    [w_x, eta]: [&Interval; 2],
    gm: Option<&Interval>,
) -> Vec<Condition> {
    let id = if gm.is_some() { "C5d" } else { "C5h" };
    let zero = law.d.int(0);
    let room = 1 - &law.h * steepness(error_box) / Interval::pi(law.d.precision);
    let mut conditions = vec![Condition::less(id, "0 < 1 - h k_e/pi", zero.clone(), room.clone())];
    for (name, at_end) in [("Q_0", false), ("Q_h", true)] {
        let own = form(law, error_box, [w_x, eta], &room, at_end);
        let minors = match gm {
            None => minors(&own).to_vec(),
            Some(gm) => minors_with(&delayed(law, error_box, [w_x, eta, gm], (own, &room), at_end)),
        };
        let positive = |(i, minor): (usize, Interval)| {
            Condition::less(id, format!("0 < minor {} of {name}", i + 1), zero.clone(), minor)
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

/// The matrix of Q_t in (X, E, Y, P) with a delay, from that without one: `e(s) = (1 - s sigma) e_k + s (y + h sigma y_{k-1}) + G`, so that P
/// stands beside Y, h sigma times, wherever Y is that of e; the balance has `2 eta_t K h b1 y y_{k-1}` besides, what is stored adds
/// `-gm Y^2 + gm P^2`, and with a gain y has `-(1-b) sigma h y_{k-1}` in it.
fn delayed(
    law: &Law<'_>,
    error_box: &ErrorBox,
    [w_x, eta, gm]: [&Interval; 3],
    (own, room): (Form, &Interval),
    at_end: bool,
) -> [[Interval; 4]; 4] {
    let d = law.d;
    let [t, ts] = if at_end { [&law.h, &law.share].map(Interval::clone) } else { [0; 2].map(|zero| d.int(zero)) };
    let (k_e, scaled, share) = (steepness(error_box), eta / &law.gain, &law.share);
    let coupling = w_x * d.p_up.sqrt() * &error_box.k_f;
    // Of P alone: e(t)^2 has t (h sigma P)^2.
    let pp = gm - &t * share.sqr();
    // Halves of what stands before X P, E P and Y P.
    let xp = -(coupling * (&t / room) / d.int(3).sqrt() * share);
    let ep = -((1 - ts).abs() * share);
    let [up, down] = law.shifts(&law.sigma);
    let of_gain = up.max(&-down) * &law.h;
    // b_hi K h Nb2, twice the loss.
    let of_balance = &law.loss * 2;
    let bend = &t * (&t / room) * k_e.sqr() / 6;
    let yp = -(&t * share + &scaled * (&t * &k_e / 2 * share + bend * share + of_balance + of_gain));
    let [[xx, xe, xy], [_, ee, ey], [_, _, yy]] = own;
    let yy = yy - gm;
    [
        [xx, xe.clone(), xy.clone(), xp.clone()],
        [xe, ee, ey.clone(), ep.clone()],
        [xy, ey, yy, yp.clone()],
        [xp, ep, yp, pp],
    ]
}

/// The determinant of the rows and columns but one of each, of three.
fn cofactor(form: &[[Interval; 4]; 4], column: usize) -> Interval {
    let [a, b, c] = [0, 1, 2, 3].iter().filter(|at| **at != column).copied().collect::<Vec<_>>()[..] else {
        return Interval::undefined(form[0][0].precision());
    };
    let two = |first: usize, i: usize, j: usize| &form[first][i] * &form[2][j] - &form[first][j] * &form[2][i];
    &form[0][a] * two(1, b, c) - &form[0][b] * two(1, a, c) + &form[0][c] * two(1, a, b)
}

/// The leading principal minors of order 1 to 4, the last one along the last row.
fn minors_with(form: &[[Interval; 4]; 4]) -> Vec<Interval> {
    let part = [0, 1, 2].map(|i| [0, 1, 2].map(|j| form[i][j].clone()));
    let mut minors = minors(&part).to_vec();
    let terms = [0, 1, 2, 3].map(|column| &form[3][column] * cofactor(form, column));
    let [a, b, c, e] = terms;
    minors.push(e - c + b - a);
    minors
}
