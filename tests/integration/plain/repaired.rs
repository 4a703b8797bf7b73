//! The repaired derivation (sections 4 and 5): what the part `comparison` of a certificate stands for.

use super::{At, Plain, R, Spec, at_most, less, number, numbers, r};
use rug::Float;
use serde_json::Value;

/// What the table of constants shows of it.
pub struct Repaired {
    /// All that have to hold.
    pub conditions: Vec<Plain>,
    pub(super) sigma: R,
    pub(super) h: R,
    pub(super) sizes: Vec<(&'static str, R)>,
    /// X_b, E_b.
    pub(super) arguments: [R; 2],
    /// rho_0, rho_11, rho_12, rho_22.
    pub(super) rho: [R; 4],
    pub(super) minors: [R; 3],
    pub(super) sigma_a: R,
    /// C2 and C3 hold of every `beta` below this.
    pub(super) beta: R,
}

impl Spec<'_> {
    /// `K_alpha = c (e^(alpha T) - 1 + c) e^(-alpha T)`.
    pub(super) fn k_alpha(&self) -> R {
        let decay = R(Float::with_val(super::BITS, -(&self.alpha * &self.t).0).exp());
        &self.c * (r(1.0) / &decay - r(1.0) + &self.c) * decay
    }

    /// The closed form of (k0, k1) (section 2).
    pub(super) fn closed_form(&self) -> [R; 2] {
        let weights = &self.spec.internal_model.weights;
        let (n_0, n_1) = (super::weight(weights, 0), super::weight(weights, 1));
        let nu = &self.mu / &self.w;
        let pi = R(Float::with_val(super::BITS, rug::float::Constant::Pi));
        let first = (r(1.0) / nu.sq() + n_1.sq()) / &n_0;
        let k0 = (pi.sq() - r(4.0)) * &n_1 / r(2.0) + first.max(&(r(4.0) * &n_0 - r(2.0) * &n_1));
        let k1 = r(8.0) * (r(1.0) / nu.sq() + (r(2.0) * &n_0 + &n_1 / r(3.0)).sq()) / n_1;
        [k0, k1]
    }

    /// kappa_0, kappa_1 of a pair.
    pub(super) fn kappas(&self, [k0, k1]: [&R; 2]) -> [R; 2] {
        [k0 / self.w.sq(), k1 / self.w.sq().sq()]
    }

    /// The paper's Z for a solution within (X, E).
    pub(super) fn z_of_paper(&self, at: &At, [kappa_0, kappa_1]: &[R; 2]) -> R {
        let of_q = &self.t / &self.mu + kappa_0 + r(54.0) * kappa_1 * at.qe.sq();
        (of_q * at.q.sq() + r(3.0) * kappa_1 * (at.qt.sq() + (&at.qx * &at.f).sq())).sqrt()
    }

    /// The part `comparison`, where there is one.
    pub fn repaired(&self, certificate: &Value) -> Option<Repaired> {
        let mut part = certificate.get("comparison")?.get("repaired")?.clone();
        part["initial_set"]["kind"] = certificate["claim"]["initial_set"]["kind"].clone();
        let (witness, sigma) = (&part["witness"], number(&part["sigma_star"]));
        let [x, e, level, h, p_x, p_e, k0, k1] = numbers(witness, ["X", "E", "L", "h", "p_x", "p_e", "k0", "k1"]);
        let at = self.at(&x, &e);
        let b_fxx = |x: &R, e: &R| self.at(x, e).fxx;
        let axis = b_fxx(&x, &r(0.0));
        let beta = r(2.0) * self.beta(&sigma);
        let over = self.k_alpha() / &self.alpha;
        let z = self.z_of_paper(&at, &self.kappas([&k0, &k1]));
        // The error box, from the level.
        let arguments = [&x + (&level / &self.p_low).sqrt(), &e + level.sqrt()];
        let [x_b, e_b] = &arguments;
        let far = self.at(x_b, e_b);
        let rho_0 = &self.p_up * (&at.fxx * &x + &at.fex * &e + b_fxx(x_b, &e) * (x_b + &x) / r(2.0));
        let rho_11 = &rho_0 + &h / &self.mu * far.qx.sq();
        let rho_12 = &self.p_up * &far.fe + &far.qx;
        let rho_22 = &far.qe + &h / &self.mu * far.qe.sq();
        // The leading minors of R by cofactors.
        let damping = &self.alpha * &self.p_low;
        let first = r(2.0) * (&damping - &rho_11);
        let error = r(2.0) * (&sigma - &rho_22);
        let second = &first * &error - rho_12.sq();
        let third = &self.mu * &h * (&first * &error - rho_12.sq()) - &first * self.mu.sq();
        let sigma_a = &rho_22 + &self.mu / (r(2.0) * &h) + rho_12.sq() / (r(2.0) * &first);
        // C3 at beta = 1, and what it asks of beta.
        let [xx, xe] = [&over * (&at.fex * &e + r(2.0) * &axis * &x), &over * &at.fe];
        let steepest = (r(1.0) - &xx) / ((r(1.0) - &xx) * &at.qe + &xe * &at.qx);
        let largest = (&e / &at.q).min(&steepest);

        let mut conditions: Vec<Plain> =
            [&sigma, &x, &e, &level, &h, &p_x, &p_e, &k1].map(|value| less("sign", r(0.0), value.clone())).into();
        conditions.extend(self.set(&part, &x, &e, &z));
        conditions.extend(self.domain(x_b, e_b));
        conditions.push(self.transfer(witness, &k0, &k1));
        conditions.push(at_most("C1", &over * (&at.fe * &e + &axis * x.sq() / r(2.0)), x.clone()));
        conditions.push(at_most("C2", &beta * &at.q, e.clone()));
        conditions.push(less("C3", &xx * &p_x + &beta * &at.qx * &p_e, p_x.clone()));
        conditions.push(less("C3b", &xe * &p_x + &beta * &at.qe * &p_e, p_e));
        let [d_x, d_e, d_z] = self.distances(&part, [&x, &e, &z]);
        let start = &self.p_up * d_x.sq() + d_e.sq() + &h * d_z.sq();
        conditions.push(less("C4", start, level));
        conditions.push(less("C5", rho_11.clone(), damping));
        conditions.push(less("C5b", sigma_a.clone(), sigma.clone()));
        let sizes = super::sizes(&part);
        let (rho, minors) = ([rho_0, rho_11, rho_12, rho_22], [first, second, third]);
        Some(Repaired { conditions, sigma, h, sizes, arguments, rho, minors, sigma_a, beta: largest })
    }
}
