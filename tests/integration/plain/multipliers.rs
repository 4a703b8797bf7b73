//! C5 a second time, as a matrix inequality with multipliers (sections 5 and 10.4).

use super::{R, Spec, number, numbers, r};
use serde_json::Value;

impl Spec<'_> {
    /// Whether the multipliers of a certificate prove C5: with u_x^2 <= k_x^2 xi^2, phi^2 <= k_f^2 et^2 and u_e between the slopes times et,
    /// -U' plus the multiplied constraints is a positive definite form in (s, xi, et, u_x, u_e, phi). A signal that vanishes has no row, and
    /// its multiplier is 0.
    pub fn multipliers_hold(&self, certificate: &Value) -> bool {
        let (witness, sigma) = (&certificate["witness"], number(&certificate["claim"]["sigma_star"]));
        let [w_x, h] = numbers(witness, ["w_x", "h"]);
        let [l_x, l_e, l_f] = numbers(&witness["lmi"], ["l_x", "l_e", "l_f"]);
        let found = self.derive(certificate).error_box;
        let [above, below] = &found.slopes;
        let zero = r(0.0);
        // Twice the form, as a symmetric matrix; each constraint is multiplied and subtracted.
        let mut form = vec![vec![zero.clone(); 6]; 6];
        let mut add = |i: usize, j: usize, value: R| {
            form[i][j] = &form[i][j] + &value;
            if i != j {
                form[j][i] = &form[j][i] + &value;
            }
        };
        let (s, xi, et, u_x, u_e, phi) = (0, 1, 2, 3, 4, 5);
        // The derivatives along the loop: of xi, of et = -sigma et + mu s + u_x + u_e, and h (-mu s - u_x - u_e) s.
        add(xi, xi, r(2.0) * &w_x * &found.rate);
        add(xi, phi, &zero - &w_x * self.p_up.sqrt());
        add(et, et, r(2.0) * &sigma);
        add(et, s, &zero - &self.mu);
        add(et, u_x, r(-1.0));
        add(et, u_e, r(-1.0));
        add(s, s, r(2.0) * &h * &self.mu);
        add(s, u_x, h.clone());
        add(s, u_e, h.clone());
        add(xi, xi, &zero - &l_x * found.k_x.sq());
        add(u_x, u_x, l_x.clone());
        add(et, et, &zero - &l_f * found.k_f.sq());
        add(phi, phi, l_f.clone());
        // (u_e - above et)(u_e + below et) <= 0.
        add(u_e, u_e, l_e.clone());
        add(u_e, et, &l_e * (below - above) / r(2.0));
        add(et, et, &zero - &l_e * above * below);
        // Where dq/de is one number, u_e is that times et.
        let one = above + below == zero;
        if one {
            add(et, et, r(-2.0) * above);
            add(et, s, &h * above);
        }
        let gone = [(u_x, found.k_x == zero, &l_x), (u_e, one, &l_e), (phi, found.k_f == zero, &l_f)];
        let kept: Vec<usize> =
            (0..6).filter(|row| !gone.iter().any(|(gone, is_gone, _)| gone == row && *is_gone)).collect();
        let form = kept.iter().map(|i| kept.iter().map(|j| form[*i][*j].clone()).collect()).collect();
        gone.iter().all(|(_, is_gone, multiplier)| !is_gone || **multiplier == zero) && is_definite(form)
    }
}

/// Whether a symmetric matrix is positive definite, by elimination.
fn is_definite(mut rows: Vec<Vec<R>>) -> bool {
    for k in 0..rows.len() {
        if rows[k][k] <= r(0.0) {
            return false;
        }
        for i in k + 1..rows.len() {
            let factor = &rows[i][k] / &rows[k][k];
            let pivot = rows[k].clone();
            rows[i].iter_mut().zip(&pivot).for_each(|(entry, above)| *entry = &*entry - &factor * above);
        }
    }
    true
}
