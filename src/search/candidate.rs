//! One candidate of the sharp derivation in floating point.

use super::model::FloatModel;
use crate::data::Bound;

/// The four numbers that remain when C4 is active in both members (derivation, section 5).
#[derive(Clone, Copy, Debug)]
pub struct SharpParameters {
    /// X_p.
    pub x_p: f64,
    /// E_p.
    pub e_p: f64,
    /// rho > 1 with D_x = rho c dX.
    pub rho: f64,
    /// eta > 0 with h dZ^2 = eta dE^2.
    pub eta: f64,
}

/// Strict inequalities that do not involve sigma are proposed with this much room, so that rounding to short rationals
/// cannot destroy them.
pub(super) const BELOW_ONE: f64 = 1.0 - 1e-6;

/// The share of the smallest rate in the data below which a gain is as good as none.
const NEGLIGIBLE: f64 = 1e-20;

/// What stands in the way of a candidate; later ones come closer to a certificate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Obstacle {
    /// A number is beyond what the search can work with.
    Magnitude,
    /// A bounding function is not finite there.
    NotFinite,
    /// C1 or C3 fails for every sigma.
    Existence,
    /// X_b leaves the domain.
    DomainX,
    /// E_b leaves the domain.
    DomainE,
    /// gam >= alpha: the nonlinearity in the error box takes all of alpha.
    Curvature,
    /// (h/mu) k_x^2 >= 4 w_x (alpha - gam).
    Coupling,
    /// A proof was found, but the bounding functions are not proved up to its arguments.
    Bounds,
}

impl Obstacle {
    /// The condition that binds, for reports.
    #[must_use]
    pub fn describe(self) -> &'static str {
        match self {
            Obstacle::Magnitude => {
                "a number of the specification, or a bounding function at X = E = 0, is beyond the range of double \
                 precision, in which the search works: use units in which the numbers are of ordinary size"
            }
            Obstacle::NotFinite => "the bounding functions are not finite at any arguments tried",
            Obstacle::Existence => "C1 or C3: no X_p, E_p tried admits a periodic solution by contraction",
            Obstacle::DomainX => "domain X: the error box around the initial set leaves it",
            Obstacle::DomainE => "domain E: the error box around the initial set leaves it",
            Obstacle::Curvature => "C5: gam >= alpha, the nonlinearity over the error box takes all of the decay rate",
            Obstacle::Coupling => "C5: (h/mu) k_x^2 >= 4 w_x (alpha - gam)",
            Obstacle::Bounds => "the bounding functions are not proved up to the arguments of the proof that was found",
        }
    }
}

/// The part of a candidate that does not depend on sigma, rho and eta.
#[derive(Clone, Copy, Debug)]
pub struct Existence {
    pub x_p: f64,
    pub e_p: f64,
    q_rms: f64,
    q_rate: f64,
    x_gain: f64,
    /// Z.
    pub z: f64,
    /// k0, k1 and K.
    pub pair: (f64, f64, u32),
    /// The smallest sigma with C2 and C3.
    pub sigma_least: f64,
    a: f64,
    b: f64,
    q_e: f64,
    q_x: f64,
}

/// The error box of a candidate at one sigma.
#[derive(Clone, Copy, Debug)]
pub struct AtSigma {
    pub d_x: f64,
    pub e_per: f64,
    pub x_per: f64,
    pub rho: f64,
    pub eta: f64,
    pub dist_e: f64,
    pub dist_z: f64,
    /// The right side of C5.
    pub threshold: f64,
}

impl Existence {
    /// C1-C3 and Z at (X_p, E_p).
    pub fn new(model: &FloatModel, x_p: f64, e_p: f64) -> Result<Existence, Obstacle> {
        let at = |which| model.bound(which, x_p, e_p);
        let gain = model.c() / model.alpha;
        let f_xx = model.bound(Bound::Fxx, x_p, 0.0);
        let (f_e, f_ex, q_e, q_x, q_rms) =
            (at(Bound::Fe), at(Bound::Fex), at(Bound::Qe), at(Bound::Qx), at(Bound::QRms));
        let x_rate = model.bound(Bound::F, x_p, 0.0) + f_xx * x_p * x_p + f_e * e_p;
        let q_rate = at(Bound::QtRms) + q_x * x_rate + q_e * q_rms;
        if ![f_xx, f_e, f_ex, q_e, q_x, q_rms, q_rate].iter().all(|v| v.is_finite()) {
            return Err(Obstacle::NotFinite);
        }
        let share = gain * f_xx * x_p / 2.0;
        let (a, b) = (gain * (f_ex * e_p + f_xx * x_p), gain * f_e);
        let invariant = gain * (f_e * e_p + f_xx * x_p * x_p / 2.0) <= x_p && share < 1.0;
        if !invariant || a >= BELOW_ONE {
            return Err(Obstacle::Existence);
        }
        let w2 = model.base_frequency * model.base_frequency;
        let (size, rate) = (q_rms * q_rms / w2, q_rate * q_rate / (w2 * w2));
        let pair = model.trade_off.best(size, rate);
        let z = (model.period / (2.0 * model.mu) * q_rms * q_rms + pair.0 * size + pair.1 * rate).sqrt();
        let by_size = model.inverse(|s| model.beta_s(s) * q_rms, e_p);
        let by_rate = model.inverse(|s| model.tau(s) * q_rate, e_p);
        let contraction = q_e * (1.0 - a) + b * q_x;
        let by_contraction =
            if contraction > 0.0 { model.inverse(|s| model.beta_s(s), (1.0 - a) / contraction) } else { 0.0 };
        let sigma_least = by_size.min(by_rate).max(by_contraction * (1.0 + 1e-9));
        if !sigma_least.is_finite() || !z.is_finite() {
            return Err(Obstacle::Existence);
        }
        let x_gain = gain * f_e / (1.0 - share);
        Ok(Existence { x_p, e_p, q_rms, q_rate, x_gain, z, pair, sigma_least, a, b, q_e, q_x })
    }

    /// Whether C2, rather than C3, sets the least sigma.
    pub fn bound_by_size(&self, model: &FloatModel) -> bool {
        let beta = model.beta_s(self.sigma_least);
        (beta * self.q_rms).min(model.tau(self.sigma_least) * self.q_rate) > self.e_p * (1.0 - 1e-6)
    }

    /// Weights p_x, p_e for C3: the solution of (I - M') p = (1/X_p, 1/E_p), positive because M is a contraction.
    pub fn perron(&self, model: &FloatModel, sigma: f64) -> (f64, f64) {
        let beta = model.beta_s(sigma);
        let (c, d) = (beta * self.q_x, beta * self.q_e);
        let det = (1.0 - self.a) * (1.0 - d) - self.b * c;
        let (u, v) = (1.0 / self.x_p, 1.0 / self.e_p);
        (((1.0 - d) * u + c * v) / det, (self.b * u + (1.0 - self.a) * v) / det)
    }

    /// e_per and x_per at sigma.
    pub fn periodic(&self, model: &FloatModel, sigma: f64) -> (f64, f64) {
        let e_per = self.e_p.min(model.beta_s(sigma) * self.q_rms).min(model.tau(sigma) * self.q_rate);
        (e_per, self.x_p.min(self.x_gain * e_per))
    }

    /// The error box and the threshold of C5 at sigma.
    pub fn at_sigma(&self, model: &FloatModel, rho: f64, eta: f64, sigma: f64) -> Result<AtSigma, Obstacle> {
        let (e_per, x_per) = self.periodic(model, sigma);
        let (x0, e0, z0) = model.required_set(self.x_p, self.e_p, self.z);
        // Floors keep the box open where a distance is 0; a larger distance only strengthens C4.
        let dist_x = (x0 + x_per).max(1e-6 * self.x_p);
        let dist_e = (e0 + e_per).max(1e-6 * self.e_p);
        let dist_z = (z0 + model.n_bar * e0 + self.z).max(1e-6 * model.n_bar * dist_e);
        error_box(model, (x_per, e_per), [dist_x, dist_e, dist_z], rho, eta)
    }

    /// No sigma below this one is sought with this eta, whatever rho: less than C2 and C3 need, and than the first term
    /// 1/(4 ht) of C5 with the largest h; nor any that is negligible beside every rate in the data, since where nothing in
    /// them needs a gain the infimum is 0.
    pub fn least(&self, model: &FloatModel, eta: f64) -> f64 {
        let (_, e0, z0) = model.required_set(self.x_p, self.e_p, self.z);
        // The largest dE and the smallest dZ of `at_sigma`.
        let dist_e = (e0 + self.e_p).max(1e-6 * self.e_p);
        let dist_z = (z0 + model.n_bar * e0 + self.z).max(1e-6 * model.n_bar * e0.max(1e-6 * self.e_p));
        let h_over_mu = eta * dist_e * dist_e / (dist_z * dist_z * model.mu);
        let rates = [model.period.recip(), model.alpha, model.mu, model.base_frequency];
        let negligible = NEGLIGIBLE * rates.into_iter().fold(f64::INFINITY, f64::min);
        // Half of it leaves room for rounding, and a bracket for the bisection.
        self.sigma_least.max(negligible).max(0.5 / (4.0 * h_over_mu)).min(1e290)
    }

    /// The smallest sigma for given rho and eta, to the relative tolerance.
    pub fn sigma(&self, model: &FloatModel, rho: f64, eta: f64, tolerance: f64) -> Result<f64, Obstacle> {
        let needed = |sigma: f64| self.at_sigma(model, rho, eta, sigma).map(|at| at.threshold.max(self.sigma_least));
        let least = self.least(model, eta);
        let mut low = least;
        if let Ok(threshold) = needed(low)
            && threshold <= low
        {
            return Ok(low);
        }
        let mut high = low;
        loop {
            high *= 4.0;
            match needed(high) {
                Ok(threshold) if threshold <= high => break,
                // The obstacle at the largest sigma is the one that counts: e_per, x_per are smallest there.
                Err(obstacle) if high > 1e200 => return Err(obstacle),
                Ok(_) if high > 1e280 => return Err(Obstacle::Coupling),
                _ => low = high,
            }
            if high > 1e12 * least {
                high *= 1e6;
            }
        }
        while high / low - 1.0 > tolerance {
            let middle = low.sqrt() * high.sqrt();
            if middle <= low || middle >= high {
                break;
            }
            match needed(middle) {
                Ok(threshold) if threshold <= middle => high = middle,
                _ => low = middle,
            }
        }
        Ok(high)
    }
}

/// D_x = rho c dX, h from eta, and the threshold of C5 with the level condition active.
pub fn error_box(
    model: &FloatModel,
    (x_per, e_per): (f64, f64),
    [dist_x, dist_e, dist_z]: [f64; 3],
    rho: f64,
    eta: f64,
) -> Result<AtSigma, Obstacle> {
    let d_x = rho * model.c() * dist_x;
    let level = (1.0 + eta) * dist_e * dist_e / (1.0 - 1.0 / (rho * rho));
    let (x_b, e_b) = (x_per + d_x, e_per + level.sqrt());
    if x_b > model.domain.0 * (1.0 - 1e-7) {
        return Err(Obstacle::DomainX);
    }
    if e_b > model.domain.1 * (1.0 - 1e-7) {
        return Err(Obstacle::DomainE);
    }
    let gamma = model.c()
        * (model.bound(Bound::Fxx, x_per, 0.0) * x_per
            + model.bound(Bound::Fex, x_per, e_per) * e_per
            + model.bound(Bound::Fxx, x_b, e_per) * d_x / 2.0);
    let k_x = model.bound(Bound::Qx, x_b, e_b) / model.p_low.sqrt();
    let (k_e, k_f) = (model.bound(Bound::Qe, x_b, e_b), model.bound(Bound::Fe, x_b, e_b));
    if ![gamma, k_x, k_e, k_f].iter().all(|v| v.is_finite()) {
        return Err(Obstacle::NotFinite);
    }
    if gamma >= model.alpha * BELOW_ONE {
        return Err(Obstacle::Curvature);
    }
    let w_x = level / (model.p_low * d_x * d_x);
    let h_over_mu = eta * dist_e * dist_e / (dist_z * dist_z * model.mu);
    let margin = 4.0 * w_x * (model.alpha - gamma) - h_over_mu * k_x * k_x;
    if margin.is_nan() || margin <= (1.0 - BELOW_ONE) * 4.0 * w_x * model.alpha {
        return Err(Obstacle::Coupling);
    }
    let one_plus = 1.0 + h_over_mu * k_e;
    let cross = w_x * model.p_up.sqrt() * k_f + k_x * one_plus / 2.0;
    let threshold = one_plus * one_plus / (4.0 * h_over_mu) + cross * cross / margin;
    if !threshold.is_finite() {
        return Err(Obstacle::NotFinite);
    }
    Ok(AtSigma { d_x, e_per, x_per, rho, eta, dist_e, dist_z, threshold })
}
