//! Stability and domain of attraction (derivation, sections 5 and 10.4): the quadratic form of C5 and its closed form.

use super::paths::{Path, Paths};
use crate::data::{Bound, Data, Numbers, Problem};
#[cfg(doc)]
use crate::input_gain::InputGain;
use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_exact::real::{Operand, Real};

/// The error box and what the plant's data give on it.
///
/// The periodic solution is bounded by (x_per, e_per), which is (0, 0) for exact regulation.
#[derive(Clone, Debug)]
pub struct ErrorBox<R> {
    /// X_b = x_per + D_x.
    pub x_b: R,
    /// E_b = e_per + D_e.
    pub e_b: R,
    /// k_x = b_qx/sqrt(P_low), where the path of q has dq/dx.
    pub k_x: R,
    /// The sector of dq/de, where the path of q has it: from -k_l = -b_qe up to m = min{q_e_max, b_qe}.
    pub sector: Sector<R>,
    /// X and E there.
    pub sector_at: [R; 2],
    /// k_f = b_fe, where the path of f has df/de.
    pub k_f: R,
    /// gam = c [b_fxx(x_per,0) x_per + b_fex(x_per,E) E + b_fxx(X_b,E) D_x/2], in 1/time, with E where the path of f has df/dx:
    /// what the nonlinearity takes from alpha; unknown where a rate is given in the place of these bounds.
    pub gamma: R,
    /// a_2 = alpha - gam, or a(X_b, E) where a rate is given and larger: a rate of df/dx averaged over a segment of the path.
    pub rate: R,
}

/// dq/de lies between -below and above.
#[derive(Clone, Debug)]
pub struct Sector<R> {
    /// k_l.
    pub below: R,
    /// m, at most k_l.
    pub above: R,
}

impl<R: Real> ErrorBox<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// Evaluates the bounding functions on the error box |xt| <= D_x, |et| <= D_e around a periodic solution with
    /// sup|x| <= x_per, sup|e| <= e_per, along the paths of f and of q. Hypothesis: (X_b, E_b) lies in the domain.
    #[must_use]
    pub fn new(problem: &impl Problem<R>, paths: Paths, periodic: [&R; 2], radii: [&R; 2]) -> ErrorBox<R> {
        let corner = Corner::new(periodic, radii);
        corner.error_box(&corner.of_f(problem, paths.f), &corner.of_q(problem, paths.q))
    }

    /// The error boxes along every pair of paths that a search chooses from, each with its paths.
    pub fn on_paths(
        problem: &impl Problem<R>,
        periodic: [&R; 2],
        radii: [&R; 2],
    ) -> impl Iterator<Item = (Paths, ErrorBox<R>)> {
        let corner = Corner::new(periodic, radii);
        let of_f = Path::CHOICE.map(|path| corner.of_f(problem, path));
        let of_q = Path::CHOICE.map(|path| corner.of_q(problem, path));
        let boxes: Vec<ErrorBox<R>> =
            of_f.iter().flat_map(|of_f| of_q.iter().map(|of_q| corner.error_box(of_f, of_q))).collect();
        Paths::choice().zip(boxes)
    }
}

/// An error box before anything is known on it.
struct Corner<R> {
    x_per: R,
    e_per: R,
    d_x: R,
    x_b: R,
    e_b: R,
}

/// gam, a_2 and k_f.
struct OfF<R> {
    gamma: R,
    rate: R,
    k_f: R,
}

/// k_x and the sector.
struct OfQ<R> {
    k_x: R,
    sector: Sector<R>,
    sector_at: [R; 2],
}

impl<R: Real> Corner<R>
where
    for<'a> &'a R: Operand<R>,
{
    fn new([x_per, e_per]: [&R; 2], [d_x, d_e]: [&R; 2]) -> Corner<R> {
        let (x_b, e_b) = (x_per + d_x, e_per + d_e);
        Corner { x_per: x_per.clone(), e_per: e_per.clone(), d_x: d_x.clone(), x_b, e_b }
    }

    fn of_f(&self, problem: &impl Problem<R>, path: Path) -> OfF<R> {
        let Corner { x_per, e_per, d_x, x_b, e_b } = self;
        let (x, e) = (path.x_of_de(x_per, x_b), path.e_of_dx(e_per, e_b));
        let gamma = &problem.numbers().c
            * (problem.bound(Bound::Fxx, x_per, &problem.zero()) * x_per
                + problem.bound(Bound::Fex, x_per, e) * e
                + problem.bound(Bound::Fxx, x_b, e) * d_x / R::int(2));
        let by_norms = &problem.numbers().alpha - &gamma;
        // Of what is not given nothing is known.
        let rate = by_norms.max_known(&problem.bound(Bound::Rate, x_b, e));
        OfF { gamma, rate, k_f: problem.bound(Bound::Fe, x, e_b) }
    }

    fn of_q(&self, problem: &impl Problem<R>, path: Path) -> OfQ<R> {
        let Corner { x_per, e_per, x_b, e_b, .. } = self;
        let (x, e) = (path.x_of_de(x_per, x_b), path.e_of_dx(e_per, e_b));
        OfQ {
            k_x: problem.bound(Bound::Qx, x_b, e) / problem.numbers().p_low.sqrt(),
            sector: Sector { below: problem.bound(Bound::Qe, x, e_b), above: problem.bound(Bound::QeMax, x, e_b) },
            sector_at: [x.clone(), e_b.clone()],
        }
    }

    fn error_box(&self, of_f: &OfF<R>, of_q: &OfQ<R>) -> ErrorBox<R> {
        ErrorBox {
            x_b: self.x_b.clone(),
            e_b: self.e_b.clone(),
            k_x: of_q.k_x.clone(),
            sector: of_q.sector.clone(),
            sector_at: of_q.sector_at.clone(),
            k_f: of_f.k_f.clone(),
            gamma: of_f.gamma.clone(),
            rate: of_f.rate.clone(),
        }
    }
}

/// The terms of (C5) in the form of 10.4, with ht = h/mu and A = w_x a_2.
#[derive(Clone, Debug)]
pub struct DecayTerms<R> {
    /// ht.
    pub h_over_mu: R,
    /// ht k_x^2.
    pub coupling: R,
    /// 4 A.
    pub curvature: R,
    /// D = max{|1 + ht m|, |1 - ht k_l|}; 1 + ht k_l where m = k_l.
    pub worst: R,
    /// w_x sqrt(P_up) k_f + k_x D/2.
    pub cross: R,
}

impl<R: Real> DecayTerms<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// The terms for given weights, a_2, mu, sqrt(P_up), k_x, k_f and the sector of dq/de.
    #[must_use]
    pub fn new(
        [w_x, h]: [&R; 2],
        [rate, mu, root_p_up]: [&R; 3],
        [k_x, k_f]: [&R; 2],
        sector: &Sector<R>,
    ) -> DecayTerms<R> {
        let h_over_mu = h / mu;
        // |y| = max{y, -y}.
        let at = |slope: R| {
            let factor = R::int(1) + &h_over_mu * slope;
            factor.max(&-factor.clone())
        };
        let worst = at(sector.above.clone()).max(&at(-sector.below.clone()));
        DecayTerms {
            coupling: &h_over_mu * k_x.sqr(),
            curvature: R::int(4) * (w_x * rate),
            cross: w_x * root_p_up * k_f + k_x * &worst / R::int(2),
            worst,
            h_over_mu,
        }
    }

    /// The threshold of sigma for `margin` = 4A - ht k_x^2 > 0:
    /// `D^2/(4 ht) + (w_x sqrt(P_up) k_f + k_x D/2)^2 / (4A - ht k_x^2)`.
    #[must_use]
    pub fn threshold(&self, margin: R) -> R {
        self.by_slope() + self.cross.sqr() / margin
    }

    /// The first term of the threshold, `D^2/(4 ht)`: what dq/de and the start of the internal model ask for.
    #[must_use]
    pub fn by_slope(&self) -> R {
        self.worst.sqr() / (R::int(4) * &self.h_over_mu)
    }
}

/// (C5) by its closed form, for given weights w_x, h of the Lyapunov function
/// U = w_x xt'P_x xt + et^2 + h zt'N zt.
#[derive(Clone, Debug)]
pub struct DecayCondition<R> {
    /// ht k_x^2, to be below `curvature`; ht = h/mu.
    pub coupling: R,
    /// 4 A = 4 w_x a_2.
    pub curvature: R,
    /// The threshold that sigma must exceed; meaningful when `coupling < curvature` is proved.
    pub sigma_threshold: R,
    /// Its first term; the other one is the loop through x.
    pub by_slope: R,
}

impl<R: Real> DecayCondition<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// `coupling < curvature` and sigma above the threshold of [`DecayTerms`]; with an input gain the sector is that of
    /// [`InputGain::sector`] at this sigma.
    ///
    /// Guarantee: then U' <= -rho (xi^2 + et^2 + s^2) for some rho > 0 in the error box (complete the square in s, take the
    /// worst signs of u_x, u_e, phi).
    #[must_use]
    pub fn new(problem: &impl Problem<R>, error_box: &ErrorBox<R>, [w_x, h]: [&R; 2], sigma: &R) -> DecayCondition<R> {
        let Numbers { mu, p_up, input_gain, .. } = problem.numbers();
        let ErrorBox { k_x, k_f, sector, rate, .. } = error_box;
        let moved = input_gain.as_ref().map(|gain| {
            let [below, above] = gain.sector([&sector.below, &sector.above], &(h / mu), sigma);
            Sector { below, above }
        });
        let sector = moved.as_ref().unwrap_or(sector);
        let terms = DecayTerms::new([w_x, h], [rate, mu, &p_up.sqrt()], [k_x, k_f], sector);
        let margin = &terms.curvature - &terms.coupling;
        // Where the margin is not proved positive the threshold has no meaning; unknown keeps it from being used.
        let sigma_threshold = terms.threshold(if margin.is_certainly_positive() { margin } else { R::unknown() });
        let by_slope = terms.by_slope();
        DecayCondition { coupling: terms.coupling, curvature: terms.curvature, sigma_threshold, by_slope }
    }
}

impl DecayCondition<Enclosure> {
    /// Whether C5 holds at sigma.
    #[must_use]
    pub fn holds(&self, sigma: &Enclosure) -> Truth {
        match self.coupling.lt(&self.curvature) {
            Truth::True => self.sigma_threshold.lt(sigma),
            other => other,
        }
    }
}

/// The two sides of (C4): `w_x P_up dX^2 + dE^2 + h dZ^2 < min{w_x P_low D_x^2, D_e^2}`, with an input gain b_hi h in the place of h:
/// at the gain b the weight of |zeta|_N^2 is b h.
///
/// Guarantee: when it holds, the initial set lies in a sublevel set of U that lies in the error box.
#[must_use]
pub fn level_condition<R: Real>(problem: &impl Problem<R>, distances: [&R; 3], [d_x, d_e, w_x, h]: [&R; 4]) -> (R, R)
where
    for<'a> &'a R: Operand<R>,
{
    let [dist_x, dist_e, dist_z] = distances;
    let Numbers { p_up, p_low, input_gain, .. } = problem.numbers();
    let largest = input_gain.as_ref().map(|gain| h * &gain.high);
    let start = w_x * p_up * dist_x.sqr() + dist_e.sqr() + largest.as_ref().unwrap_or(h) * dist_z.sqr();
    let exit = (w_x * p_low * d_x.sqr()).min(&d_e.sqr());
    (start, exit)
}

/// Its words.
#[must_use]
pub fn level_words(data: &Data<'_>) -> String {
    let h_at_most = if data.input_gain.is_some() { "b_hi h" } else { "h" };
    format!("w_x P_up dX^2 + dE^2 + {h_at_most} dZ^2 < min{{w_x P_low D_x^2, D_e^2}}")
}
