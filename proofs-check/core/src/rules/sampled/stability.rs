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

/// What the bounds of the error box say of a time t after a sample, `t sigma` = ts: the root mean square of e on it is at most `c_x X + c_e E + c_y Y`.
pub struct Within {
    /// k_e = max{k_l, m} bounds |dq/de| in the error box.
    pub k_e: Interval,
    /// `kp = 1 - h k_e/pi`.
    pub room: Interval,
    /// `t k_x/(pi kp)`.
    pub c_x: Interval,
    /// `sqrt(1 - ts + ts^2/3) + t k_e/(pi kp)`.
    pub c_e: Interval,
    /// `t/(sqrt(3) kp)`.
    pub c_y: Interval,
    /// `t k_e/(sqrt(12) kp)`.
    pub g: Interval,
    /// `(t k_e)^2/(6 kp)`.
    pub bend: Interval,
}

impl Within {
    /// Where kp is above 0.
    pub fn new(law: &Law<'_>, error_box: &ErrorBox, [t, ts]: [&Interval; 2]) -> Within {
        let (d, pi) = (law.d, Interval::pi(law.d.precision));
        let k_e = error_box.k_e.max(&error_box.most);
        let room = 1 - &law.h * &k_e / &pi;
        let reach = t / &room;
        Within {
            c_x: &reach * &error_box.k_x / &pi,
            c_e: (1 - ts + ts.sqr() / 3).sqrt() + &reach * &k_e / pi,
            c_y: &reach / d.int(3).sqrt(),
            g: &reach * &k_e / d.int(12).sqrt(),
            bend: t * &reach * k_e.sqr() / 6,
            k_e,
            room,
        }
    }
}

/// C5h: `kp = 1 - h k_e/pi > 0`, and the leading minors of Q_0 and Q_h. With a gain the weight of zeta is `b eta` (section 13.1), so that
/// `eta/K` stands beside y for every b.
///
/// With a delay C5d, the same of the forms in (X, E, Y, P) for P = |y_{k-1}|, with the weight `gm`.
pub fn conditions(
    law: &Law<'_>,
    error_box: &ErrorBox,
    weights: [&Interval; 2],
    gm: Option<&Interval>,
) -> Vec<Condition> {
    let id = if gm.is_some() { "C5d" } else { "C5h" };
    let zero = law.d.int(0);
    let none = [&zero; 2];
    let mut conditions = Vec::new();
    for (name, at, loss) in [("Q_0", none, &zero), ("Q_h", [&law.h, &law.share], &law.loss)] {
        let within = Within::new(law, error_box, at);
        if conditions.is_empty() {
            conditions.push(Condition::less(id, "0 < 1 - h k_e/pi", zero.clone(), within.room.clone()));
        }
        let rows = form(law, (error_box, &within), weights, gm, (at, loss));
        // All leading principal minors are positive exactly if the form is positive definite (Sylvester).
        conditions.extend((1..=rows.len()).map(|order| {
            let minor = determinant(&rows, &(0..order).collect::<Vec<_>>());
            Condition::less(id, format!("0 < minor {order} of {name}"), zero.clone(), minor)
        }));
    }
    conditions
}

/// The lower triangle of Q_t in (X, E, Y) at t = 0 or t = h.
///
/// With a delay in (X, E, Y, P): `e(s) = (1 - s sigma) e_k + s (y + h sigma y_{k-1}) + G`, so that P stands beside Y, h sigma times, wherever Y
/// is that of e; the balance has `2 eta_t K h b1 y y_{k-1}` besides, what is stored adds `-gm Y^2 + gm P^2`, and with a gain y has
/// `-(1-b) sigma h y_{k-1}` in it.
fn form(
    law: &Law<'_>,
    (error_box, within): (&ErrorBox, &Within),
    [w_x, eta]: [&Interval; 2],
    gm: Option<&Interval>,
    ([t, ts], loss): ([&Interval; 2], &Interval),
) -> Vec<Vec<Interval>> {
    let (d, k_x, Within { k_e, c_x, c_e, c_y, g, bend, .. }) = (law.d, &error_box.k_x, within);
    let coupling = w_x * d.p_up.sqrt() * &error_box.k_f;
    let scaled = eta / &law.gain;
    let mean = &scaled * (1 - ts / 2);
    let rest = 1 - ts;
    // y has (1-b) sigma e_k in it.
    let [up, down] = law.shifts(&(&scaled * &law.sigma));
    let damping = (&rest + &mean * &error_box.most + up).abs().max(&(&rest - &mean * &error_box.k_e + down).abs());

    let xx = w_x * &error_box.rate * 2 - &coupling * c_x * 2;
    let xe = -(&coupling * c_e);
    let xy = -(&coupling * c_y + &scaled * k_x * (1 + g));
    let ee = &law.sigma * (2 - ts);
    let ey = -(damping + &scaled * g * k_e);
    let yy = &scaled * 2 * (1 - loss) - t - &scaled * t * &error_box.most - &scaled * bend * 2;
    let Some(gm) = gm else { return vec![vec![xx], vec![xe, ee], vec![xy, ey, yy]] };

    let share = &law.share;
    let [up, down] = law.shifts(&law.sigma);
    // b_hi K h Nb2, twice the loss, and what a gain adds.
    let beside = t * k_e / 2 * share + bend * share + &law.loss * 2 + up.max(&-down) * &law.h;
    // Halves of what stands before X P, E P and Y P; of P alone e(t)^2 has t (h sigma P)^2.
    let of_p =
        vec![-(coupling * c_y * share), -(rest.abs() * share), -(t * share + scaled * beside), gm - t * share.sqr()];
    vec![vec![xx], vec![xe, ee], vec![xy, ey, yy - gm], of_p]
}

/// The determinant of these columns of the first rows of a symmetric matrix, given by its lower triangle, along the last of the rows.
fn determinant(form: &[Vec<Interval>], columns: &[usize]) -> Interval {
    let row = columns.len().saturating_sub(1);
    let entry = |column: usize| &form[row.max(column)][row.min(column)];
    if let [column] = columns {
        return entry(*column).clone();
    }
    columns.iter().enumerate().fold(Interval::int(0, form[0][0].precision()), |sum, (at, column)| {
        let part = entry(*column) * determinant(form, &[&columns[..at], &columns[at + 1..]].concat());
        if (row + at).is_multiple_of(2) { sum + part } else { sum - part }
    })
}
