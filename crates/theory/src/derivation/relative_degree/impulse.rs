//! The L1 norm k_inf of the impulse response of 1/p, for p of degree 1 to 3.

use super::{RelativeDegreeError, Undecided, check_hurwitz};
use rug::{Float, Rational};
use sigmastar_exact::enclosure::{Enclosure, MAX_PRECISION};

/// Bits beyond those of the result: quotients, roots and sums lose a few each.
const GUARD: u32 = 96;

/// The error aimed at, relative to 1/a_1 <= k_inf, as a power of 2.
const TARGET: u32 = 44;

/// Bits of the terms of the sum, and the width as a power of 2 at which the place of a sign change is known well enough.
const TERMS: (u32, u32) = (128, 56);

/// Sign changes that are enclosed at most.
const MAX_WAVES: u32 = 16_384;

/// Steps of the iteration for one sign change at most.
const MAX_STEPS: u32 = 64;

/// An enclosure of k_inf = integral_0^oo |g|, with limsup |xi_1| <= k_inf limsup |e| (derivation, section 6).
///
/// The integral of g is 1/p(0) = 1/a_1, so 1/a_1 is a lower bound, and k_inf = 1/a_1 exactly where g has one sign. With roots
/// `-sigma +- i omega` (omega > 0) and, for degree 3, `-c`, put s = sigma/omega and kappa = (c - sigma)/omega. Then
///
/// ```text
/// all roots real, or c <= sigma:   k_inf = 1/a_1,
/// degree 2:                        k_inf = coth(pi s/2)/a_1,
/// degree 3, c > sigma:             k_inf = (1 + 2 sum_{k>=1} E_k)/a_1,   E_k = e^{-s theta_k} (cos eta_k + s sin eta_k),
/// ```
///
/// where `theta_k = k pi + eta_k`, 0 < eta_k < pi, are the sign changes of g in the time omega t, one in each half turn
/// (docs/mathematics.md, section 6). They satisfy, with R = sqrt(1 + kappa^2) and rho = atan(1/kappa),
///
/// ```text
/// eta_k = rho + asin(e^{-kappa theta_k}/R) (k odd),   eta_k = rho - asin(e^{-kappa theta_k}/R) (k even),
/// ```
///
/// which is iterated from [0, pi] (no zero is lost by that). From some k on rho takes the place of eta_k: that is a geometric
/// series, and as `|dE/d eta| <= (1 + s^2) e^{-s k pi}` and asin x <= pi x/2, the terms from k on differ from it together by at most
///
/// ```text
/// (1 + s^2) (pi/2)/R e^{-(s+kappa) k pi}/(1 - e^{-(s+kappa) pi}).
/// ```
///
/// # Guarantee
/// The enclosure contains k_inf. It is exact up to rounding but for degree 3 with c > sigma. Then its relative width is about
/// 2^-40 as long as c/omega is at least about 10^-3; below, the enclosure is finite but wide.
///
/// # Errors
/// [`RelativeDegreeError::Count`] and [`RelativeDegreeError::NotHurwitz`] for unusable coefficients,
/// [`RelativeDegreeError::Undecided`] when the time scales are so far apart that no number holds them.
pub fn k_infinity(a: &[Rational], precision: u32) -> Result<Enclosure, RelativeDegreeError> {
    check_hurwitz(a)?;
    let output = precision.clamp(64, MAX_PRECISION);
    let a_1 = Enclosure::from_rational(&a[0], output + GUARD);
    let relative = match a {
        [a_1, a_2] => second_order(a_1, a_2, output + GUARD),
        [a_1, a_2, a_3] => third_order(a_1, a_2, a_3, output + GUARD),
        _ => None,
    };
    let Some(relative) = relative else {
        return Ok(Enclosure::from_rational(&Rational::from(a[0].recip_ref()), output));
    };
    let result = (relative.max(&Enclosure::one(output)) / a_1).at_precision(output);
    if result.is_bounded() { Ok(result) } else { Err(RelativeDegreeError::Undecided(Undecided::TimeScales)) }
}

/// a_1 k_inf of `s^2 + a_2 s + a_1`; `None` where it is 1.
fn second_order(a_1: &Rational, a_2: &Rational, precision: u32) -> Option<Enclosure> {
    let sigma = Rational::from(a_2 / 2u32);
    let omega_squared = a_1 - Rational::from(sigma.square_ref());
    (omega_squared > 0).then(|| {
        let omega = Enclosure::from_rational(&omega_squared, precision).sqrt();
        (Enclosure::from_rational(&sigma, precision) / omega * Enclosure::pi(precision) / 2).coth()
    })
}

/// a_1 k_inf of `s^3 + a_3 s^2 + a_2 s + a_1`; `None` where it is 1.
///
/// Cardano: with `s = y - a_3/3`, `y^3 + P y + Q = 0` and `D = Q^2/4 + P^3/27`, not all roots are real if D > 0, and c > sigma
/// if Q > 0. With `A^3 = Q/2 + sqrt D` and `B = -P/(3 A)` the real root is `y = -(A + B)`, the others are
/// `(A + B)/2 +- i sqrt(3)/2 (A - B)`. As A^3 + B^3 = Q, A^3 - B^3 = 2 sqrt D and A B = -P/3,
///
/// ```text
/// c - sigma = (3/2) Q/(A^2 + B^2 + P/3),   omega = sqrt(3 D)/(A^2 + B^2 - P/3),
/// sigma = (a_2 a_3 - a_1)/(2 ((c + sigma)^2 + omega^2)),   c + sigma = (2 a_3 + (c - sigma))/3,
/// ```
///
/// in which nothing cancels: the two denominators are A^2 - A B + B^2 and A^2 + A B + B^2.
fn third_order(a_1: &Rational, a_2: &Rational, a_3: &Rational, precision: u32) -> Option<Enclosure> {
    let square = Rational::from(a_3.square_ref());
    let p = a_2 - Rational::from(&square / 3u32);
    let q = Rational::from(&square * a_3) * 2u32 / 27u32 - Rational::from(a_2 * a_3) / 3u32 + a_1;
    let d = Rational::from(q.square_ref()) / 4u32 + Rational::from(p.square_ref()) * &p / 27u32;
    if d <= 0 || q <= 0 {
        return None;
    }
    let enclosed = |x: &Rational| Enclosure::from_rational(x, precision);
    let (p, q, d) = (enclosed(&p), enclosed(&q), enclosed(&d));
    let third = enclosed(&Rational::from((1, 3)));
    let a = (&q / 2 + d.sqrt()).pow(&third);
    let b = -(&p / (&a * 3));
    let squares = a.sqr() + b.sqr();
    let lead = q * 3 / ((&squares + &p / 3) * 2);
    let omega = (d * 3).sqrt() / (squares - p / 3);
    let sum = (enclosed(a_3) * 2 + &lead) / 3;
    let sigma = enclosed(&(Rational::from(a_2 * a_3) - a_1)) / ((sum.sqr() + omega.sqr()) * 2);
    Some(overshoots(&(sigma / &omega), &(lead / omega)) * 2 + 1)
}

/// The sum of E_k over k >= 1, for s and kappa.
fn overshoots(s: &Enclosure, kappa: &Enclosure) -> Enclosure {
    let (s, kappa) = (&s.at_precision(TERMS.0), &kappa.at_precision(TERMS.0));
    let precision = TERMS.0;
    let (zero, pi) = (Enclosure::zero(precision), Enclosure::pi(precision));
    let goal = Enclosure::from_rational(&(Rational::from(1) >> TARGET), precision);
    let enough = Float::with_val(64, 1) >> TERMS.1;
    let squared = kappa.sqr() + 1;
    let radius = squared.sqrt();
    let rho = kappa.recip().atan();
    let overshoot = |eta: &Enclosure| (-(s * eta)).exp() * (eta.cos() + s * eta.sin());
    // 1/(1 - e^{-x pi})
    let series = |x: &Enclosure| ((x * &pi / 2).coth() + 1) / 2;
    let (slow, fast) = ((-(s * &pi)).exp(), (-(kappa * &pi)).exp());
    let difference = (s.sqr() + 1) * &pi / (&radius * 2) * series(&(s + kappa));
    let (mut sum, mut decay, mut lead) = (zero.clone(), slow.clone(), fast.clone());
    for k in 1..=MAX_WAVES {
        // decay = e^{-s k pi}, lead = e^{-kappa k pi}
        let rest = &difference * &decay * &lead;
        if rest.le(&goal).is_true() {
            break;
        }
        let mut eta = zero.hull(&pi);
        for _ in 0..MAX_STEPS {
            let w = &lead * (-(kappa * &eta)).exp();
            // asin(w/R) by half the angle; w <= R, whatever rounding says.
            let angle = (&w / (&radius + (&squared - w.sqr()).max(&zero).sqrt())).atan() * 2;
            let next = eta.intersect(&if k % 2 == 1 { &rho + angle } else { &rho - angle });
            let settled = width(&next) <= enough || width(&next) * 2u32 > width(&eta);
            eta = next;
            if settled {
                break;
            }
        }
        sum = sum + &decay * overshoot(&eta);
        decay = decay * &slow;
        lead = lead * &fast;
    }
    let rest = difference * &decay * lead;
    sum + decay * overshoot(&rho) * series(s) + rest.negate().hull(&rest)
}

fn width(x: &Enclosure) -> Float {
    Float::with_val(64, x.upper() - x.lower())
}
