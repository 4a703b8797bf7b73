//! How e and q move within a sample (derivation, 12.3 and 13.6): what every claim about the law at samples takes from (12.6).

use sigmastar_exact::real::{Operand, Real};

/// (12.6) on [kh, kh + t]: with X = rms(xi), E = |e_k| and Y = |y| there, `rms(e) <= c_X X + c_E E + c_Y Y`, and the mean of q is
/// `d_l e_k + d_m y` but for `k_x (1+g) X + g k_e E + t^2 k_e^2/(6 kp) Y`.
#[derive(Clone, Debug)]
pub struct Held<R> {
    /// t k_e/kp.
    pub motion: R,
    /// `g = t k_e/(sqrt(12) kp)`.
    pub g: R,
    /// `c_X = t k_x/(pi kp)`.
    pub c_x: R,
    /// `c_E = sqrt(1 - t sigma + (t sigma)^2/3) + t k_e/(pi kp)`.
    pub c_e: R,
    /// `c_Y = t/(sqrt(3) kp)`.
    pub c_y: R,
}

impl<R: Real> Held<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// Evaluates them for t sigma, t, k_x, k_e, `kp = 1 - h k_e/pi` and pi. Hypotheses: t sigma <= 1, 0 < kp.
    #[must_use]
    pub fn new([ts, t]: [&R; 2], [k_x, k_e]: [&R; 2], [within, pi]: [&R; 2]) -> Held<R> {
        let motion = t * k_e / within;
        Held {
            g: (motion.sqr() / R::int(12)).sqrt(),
            c_x: t * k_x / (pi * within),
            c_e: (R::int(1) - ts + ts.sqr() / R::int(3)).sqrt() + &motion / pi,
            c_y: (t.sqr() / R::int(3)).sqrt() / within,
            motion,
        }
    }
}

/// What bounds a whole sample for one gain: the sample, the gain, and the plant's bounds in the error box.
#[derive(Clone, Debug)]
pub struct SampleNumbers<R> {
    /// h.
    pub step: R,
    /// sigma.
    pub sigma: R,
    /// pi.
    pub pi: R,
    /// k_x.
    pub k_x: R,
    /// -k_l and m.
    pub slopes: [R; 2],
}

/// The bounds of a whole sample from which (R_h) of section 13.6 is made.
///
/// With measurements `e_k + v_k` and a disturbance d, `|d| <= d_bar`, beside q, let
/// `y = mean(q + d) + (1-b) sigma e_k + b (K v'_k - (sigma + K b_1) v_k)`, so that `e_{k+1} = (1 - h sigma) e_k + h y`. Then
/// `mean(q + d) = w1 + w2 + p + D` with w1 in `slope` times e_k, w2 in `hold` times y, `|p| <= by_x X`, `|D| <= (1+g) d_bar`, and
/// `rms(e) <= c_X X + c_E |e_k| + c_Y |y| + c_d d_bar`. Hypotheses: h sigma <= 1, 0 < `within`.
#[derive(Clone, Debug)]
pub struct SampleBounds<R> {
    /// `kp = 1 - h k_e/pi`, k_e = max{k_l, m}; to be positive.
    pub within: R,
    /// The numbers of (12.6) at t = h.
    pub held: Held<R>,
    /// `c_d = h/(pi kp)`.
    pub c_d: R,
    /// 1 + g.
    pub enlarged: R,
    /// `k_x (1+g)`.
    pub by_x: R,
    /// `lo1 = -(1 - h sigma/2) k_l - g k_e` and `hi1 = (1 - h sigma/2) m + g k_e`.
    pub slope: [R; 2],
    /// `lo2 = -(h/2) k_l - h^2 k_e^2/(6 kp)` and `hi2 = max{0, (h/2) m + h^2 k_e^2/(6 kp)}`: 0 lies between.
    pub hold: [R; 2],
}

impl<R: Real> SampleBounds<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// Evaluates the bounds.
    #[must_use]
    pub fn new(SampleNumbers { step, sigma, pi, k_x, slopes: [below, above] }: &SampleNumbers<R>) -> SampleBounds<R> {
        let (one, two) = (R::int(1), R::int(2));
        let k_e = above.max(&-below.clone());
        let within = &one - step * &k_e / pi;
        let product = step * sigma;
        let held = Held::new([&product, step], [k_x, &k_e], [&within, pi]);
        let (mean, half) = (&one - &product / &two, step / &two);
        let moved = &held.g * &k_e;
        let bend = step * &k_e * &held.motion / R::int(6);
        let enlarged = &one + &held.g;
        SampleBounds {
            c_d: step / (pi * &within),
            by_x: k_x * &enlarged,
            slope: [&mean * below - &moved, &mean * above + &moved],
            hold: [&half * below - &bend, (&half * above + &bend).max(&R::int(0))],
            enlarged,
            within,
            held,
        }
    }
}
