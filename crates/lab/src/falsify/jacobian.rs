//! Drawing F(t) = df/dx(t, 0, 0) with the condition on P_x proved, and a bound of its norm.

use super::claim::TriedClaim;
use super::contraction::{self, WantedRate};
use super::random::Random;
use super::shape::{Factor, Number};
use nalgebra::DMatrix;
use rug::Rational;
use sigmastar_decide::lyapunov::prove;
use sigmastar_exact::enclosure::{DEFAULT_PRECISION, Enclosure};
use sigmastar_lang::expr::{Expr, TrigonometricPolynomial, Variables};
use sigmastar_lang::spec::model::{Constant, Jacobian, JacobianEntry, Lyapunov, LyapunovSource, PeriodicMatrix};
use sigmastar_theory::evidence::ProvedTriple;
use sigmastar_theory::jacobian::Family;
use std::f64::consts::TAU;

/// A drawn Jacobian.
#[derive(Clone, Debug)]
pub(super) struct Drawn {
    /// The entries as texts in t, row by row.
    pub rows: Vec<Vec<String>>,
    /// An upper bound of sup_t |F(t)|.
    pub norm: Number,
}

/// What is drawn about the time dependence of a plant.
#[derive(Clone, Copy, Debug)]
pub(super) struct Clock<'c> {
    /// The text of T.
    pub period: &'c str,
    /// Orders of harmonics are multiples of this: the plant has the period T/multiple.
    pub multiple: u32,
}

impl Clock<'_> {
    /// A factor of the time: 1 in half of the cases.
    pub(super) fn factor(self, random: &mut Random) -> Factor {
        if random.chance(0.5) {
            return Factor::ONE;
        }
        let order = self.multiple * random.whole(1, 2);
        Factor { order, phase: Number::new(TAU * random.uniform()) }
    }
}

/// Draws F for the Lyapunov data of a claim, of norm at most `largest` where there is a choice.
///
/// With a triple: in the axes of a constant P with eigenvalues p_i, F_ij = G_ij sqrt(p_j/p_i) with
/// G = -(alpha + slack_i) I + (skew part times a factor of the time), so that P F + F'P <= -2 alpha P up to rounding; then
/// the inequality is proved for the entries as they are written. In the place of alpha stands the contraction rate at the
/// origin where that is larger. With a Jacobian, whose triple the claim has proved for
/// all its matrices: a member, proved entry by entry. `None` where nothing could be proved or drawn.
pub(super) fn draw(claim: &TriedClaim, clock: Clock<'_>, largest: f64, random: &mut Random) -> Option<Drawn> {
    let (rows, family) = match &claim.spec.lyapunov {
        LyapunovSource::Given(triple) => of_triple(claim, triple, clock, largest, random)?,
        LyapunovSource::Proved { jacobian, .. } => member(claim, jacobian, clock, random)?,
        LyapunovSource::Wanted(_) | LyapunovSource::Plant(_) => return None,
    };
    let norm = norm(&family)?;
    Some(Drawn { rows, norm: Number::new(norm * (1.0 + 1e-8)) })
}

/// The entries as a family of one matrix.
fn family(claim: &TriedClaim, rows: &[Vec<String>]) -> Option<Family> {
    let entry = |text: &String| Expr::parse(text, Variables::Time).ok().map(JacobianEntry::Function);
    let rows = rows.iter().map(|row| row.iter().map(entry).collect()).collect::<Option<Vec<Vec<_>>>>()?;
    let jacobian = Jacobian { rows, period: claim.spec.period.nominal().exact.clone() };
    Family::new(&jacobian, &claim.spec.period, DEFAULT_PRECISION)
}

fn of_triple(
    claim: &TriedClaim,
    triple: &Lyapunov,
    clock: Clock<'_>,
    largest: f64,
    random: &mut Random,
) -> Option<(Vec<Vec<String>>, Family)> {
    let n = random.whole(1, 3) as usize;
    let rate = contraction::wanted(claim, triple)?;
    let alpha = rate.value;
    let ratio = (1.0 + (triple.p_up.to_f64() / triple.p_low.to_f64() - 1.0) * random.share()) * (1.0 - 1e-4);
    let ratio = if ratio > 1.0 && n > 1 { ratio } else { 1.0 };
    // The ends of the spectrum are taken, the rest lies between.
    let axes: Vec<f64> = (0..n)
        .map(|i| match i {
            0 => 1.0,
            1 => ratio,
            _ => libm::pow(ratio, random.uniform()),
        })
        .collect();
    let turn = rotation(n, random);
    let slack: Vec<f64> = (0..n).map(|i| if i == 0 { 0.0 } else { alpha * random.uniform() }).collect();
    let skew: Vec<f64> = (0..n * n).map(|_| 2.0 * random.uniform() - 1.0).collect();
    let factor = if claim.spec.period.nominal().exact.is_some() { clock.factor(random) } else { Factor::ONE };
    let p = &turn * DMatrix::from_fn(n, n, |i, j| if i == j { axes[i] } else { 0.0 }) * turn.transpose();
    let mut size = 3.0 * largest * random.share();
    for _ in 0..60 {
        // Rounding the entries costs a little of the rate, and more so with large ones.
        let margin = 1e-6 * (alpha + size * ratio);
        let still = DMatrix::from_fn(n, n, |i, j| if i == j { -alpha - slack[i] - margin } else { 0.0 });
        let moving = DMatrix::from_fn(n, n, |i, j| {
            let (low, high) = (i.min(j), i.max(j));
            let sign = if i < j { 1.0 } else { -1.0 };
            if i == j { 0.0 } else { sign * size * skew[low * n + high] * (axes[j] / axes[i]).sqrt() }
        });
        let [still, moving] = [still, moving].map(|matrix| &turn * matrix * turn.transpose());
        let spectral = |matrix: DMatrix<f64>| matrix.singular_values().max();
        if spectral(&still + &moving).max(spectral(&still - &moving)) < largest {
            let text = |i: usize, j: usize| {
                let [still, moving] = [&still, &moving].map(|matrix| Number::new(matrix[(i, j)]));
                format!("{still} + {moving}*{}", factor.text(clock.period))
            };
            let rows: Vec<Vec<String>> = (0..n).map(|i| (0..n).map(|j| text(i, j)).collect()).collect();
            let family = family(claim, &rows)?;
            return condition_holds(triple, &rate, &family, &p, ratio).then_some((rows, family));
        }
        size *= 0.9;
    }
    None
}

/// A rotation as a product of those in the coordinate planes.
fn rotation(n: usize, random: &mut Random) -> DMatrix<f64> {
    let mut turn = DMatrix::identity(n, n);
    for i in 0..n {
        for j in 0..i {
            let (sine, cosine) = libm::sincos(TAU * random.uniform());
            let mut plane = DMatrix::identity(n, n);
            (plane[(i, i)], plane[(j, j)], plane[(i, j)], plane[(j, i)]) = (cosine, cosine, sine, -sine);
            turn *= plane;
        }
    }
    turn
}

/// Proves the condition on P_x with a constant P and a rate: its scale is free, so the ratio of its bounds is compared
/// with that of the triple.
fn condition_holds(triple: &Lyapunov, rate: &WantedRate, family: &Family, p: &DMatrix<f64>, ratio: f64) -> bool {
    let n = p.nrows();
    let enclosed = |constant: &Constant| constant.enclose(DEFAULT_PRECISION);
    let identity = ratio == 1.0;
    let entry = |i: usize, j: usize| match identity {
        true => Some(Rational::from(u32::from(i == j))),
        false => Rational::from_f64(0.5 * (p[(i, j)] + p[(j, i)])),
    };
    let mean: Option<Vec<Vec<Rational>>> = (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect();
    let ends = if identity { [0.5, 2.0] } else { [1.0 - 1e-6, ratio * (1.0 + 1e-6)] };
    let (Some(mean), Some(p_low), Some(p_up)) = (mean, Rational::from_f64(ends[0]), Rational::from_f64(ends[1])) else {
        return false;
    };
    // A multiple of the identity has the ratio 1, which every triple allows.
    let exact = |value: &Rational| Enclosure::from_rational(value, DEFAULT_PRECISION);
    let allowed = enclosed(&triple.p_up) / enclosed(&triple.p_low);
    let fits = identity || (exact(&p_up) / exact(&p_low)).le(&allowed).is_true();
    let matrix = PeriodicMatrix { mean, harmonics: Vec::new() };
    fits && prove(family, &ProvedTriple { matrix, p_low, p_up, alpha: rate.above.clone() }).is_ok()
}

/// A matrix function of a Jacobian: its functions as they are written, and for each interval a constant or a wave
/// between the two ends, which are touched in a third of the cases.
fn member(
    claim: &TriedClaim,
    jacobian: &Jacobian,
    clock: Clock<'_>,
    random: &mut Random,
) -> Option<(Vec<Vec<String>>, Family)> {
    let mut rows = Vec::new();
    for row in &jacobian.rows {
        let mut texts = Vec::new();
        for entry in row {
            texts.push(match entry {
                JacobianEntry::Function(expr) => expr.text().to_owned(),
                JacobianEntry::Interval(ends) => {
                    let factor = if jacobian.period.is_some() { clock.factor(random) } else { Factor::ONE };
                    let [low, high] = [&ends[0], &ends[1]].map(Constant::to_f64);
                    let (middle, reach) = (0.5 * (low + high), 0.5 * (high - low) * random.share() * (1.0 - 1e-6));
                    let signed = if random.chance(0.5) { reach } else { -reach };
                    let (middle, wave) = (Number::new(middle), Number::new(signed));
                    let text = format!("{middle} + {wave}*{}", factor.text(clock.period));
                    // An interval too narrow for nine digits has at least its lower end.
                    if lies_between(claim, &text, ends) { text } else { ends[0].text.clone() }
                }
            });
        }
        rows.push(texts);
    }
    let family = family(claim, &rows)?;
    Some((rows, family))
}

/// Whether mean + a cos + b sin is proved to lie between two constants: sqrt(a^2 + b^2) is its largest deviation.
fn lies_between(claim: &TriedClaim, text: &str, ends: &[Constant; 2]) -> bool {
    let Some(family) = family(claim, &[vec![text.to_owned()]]) else { return false };
    let TrigonometricPolynomial { mean, harmonics } = &family.centre[0][0];
    let deviation =
        harmonics.iter().fold(Enclosure::zero(DEFAULT_PRECISION), |sum, [a, b]| sum + (a.sqr() + b.sqr()).sqrt());
    let [low, high] = [&ends[0], &ends[1]].map(|end| end.enclose(DEFAULT_PRECISION));
    low.le(&(mean - &deviation)).and((mean + &deviation).le(&high)).is_true()
}

/// Samples of a period for each degree of a trigonometric polynomial.
const SAMPLES: usize = 32;

/// Squarings in the bound of a spectral norm: it is too large by a factor of at most n^(2^-SQUARINGS/2).
const SQUARINGS: usize = 8;

/// An upper bound of sup_t |F(t)|.
///
/// u'F v is a trigonometric polynomial of some degree d for all u and v, and such a polynomial is at most its largest
/// of N > 2 d equally spaced samples divided by cos(pi d/N) (Ehlich and Zeller).
fn norm(family: &Family) -> Option<f64> {
    let degree = family.degree();
    let count = (SAMPLES * degree).max(1);
    let pi = Enclosure::pi(DEFAULT_PRECISION);
    let turn = |k: usize, of: usize| &pi * k as i64 / of as i64;
    let largest =
        (0..count).map(|sample| spectral_norm(family, &turn(2 * sample, count))).try_fold(0.0_f64, |a, b| {
            let b = b.upper_f64();
            b.is_finite().then_some(a.max(b))
        })?;
    let shrinkage = turn(degree, count).cos().lower_f64();
    Some(largest / shrinkage * (1.0 + 1e-12))
}

/// An upper bound of |F| at an angle: with B = F'F, |F|^2 is the spectral radius of B, at most |B^m|^(1/m) in the
/// Frobenius norm, m = 2^SQUARINGS.
fn spectral_norm(family: &Family, angle: &Enclosure) -> Enclosure {
    let n = family.order();
    let entries: Vec<Vec<Enclosure>> =
        family.centre.iter().map(|row| row.iter().map(|entry| entry.at(angle)).collect()).collect();
    let zero = || Enclosure::zero(DEFAULT_PRECISION);
    let product =
        |a: &dyn Fn(usize, usize) -> Enclosure, b: &dyn Fn(usize, usize) -> Enclosure| -> Vec<Vec<Enclosure>> {
            (0..n).map(|i| (0..n).map(|j| (0..n).fold(zero(), |sum, k| sum + a(i, k) * b(k, j))).collect()).collect()
        };
    let mut power = product(&|i, k| entries[k][i].clone(), &|k, j| entries[k][j].clone());
    for _ in 0..SQUARINGS {
        power = product(&|i, k| power[i][k].clone(), &|k, j| power[k][j].clone());
    }
    let mut root = power.iter().flatten().fold(zero(), |sum, entry| sum + entry.sqr()).sqrt();
    for _ in 0..=SQUARINGS {
        root = root.sqrt();
    }
    root
}

#[cfg(test)]
mod tests {
    use super::*;
    use sigmastar_lang::spec::Specification;

    fn of(rows: &[&[&str]]) -> Family {
        let entry = |text: &&str| JacobianEntry::Function(Expr::parse(text, Variables::Time).unwrap());
        let rows = rows.iter().map(|row| row.iter().map(entry).collect()).collect();
        let spec = Specification::from_json("linear", include_str!("../../../../specs/linear.json")).unwrap();
        let jacobian = Jacobian { rows, period: spec.period.nominal().exact.clone() };
        Family::new(&jacobian, &spec.period, DEFAULT_PRECISION).unwrap()
    }

    #[test]
    fn norms() {
        for (rows, exact) in [
            (&[&["3", "0"][..], &["0", "-2"]][..], 3.0),
            (&[&["0", "5"], &["-1/2", "0"]], 5.0),
            (&[&["1", "1"], &["1", "1"]], 2.0),
            (&[&["-1 + 2*cos(2*pi*t + 1)"]], 3.0),
            (&[&["cos(4*pi*t)", "sin(4*pi*t)"], &["-sin(4*pi*t)", "cos(4*pi*t)"]], 1.0),
        ] {
            let bound = norm(&of(rows)).unwrap();
            assert!(exact <= bound && bound < 1.007 * exact, "{exact} {bound}");
        }
    }

    #[test]
    fn the_condition_on_p_is_decided() {
        let one = |text: &str| Constant::rational(&sigmastar_exact::number::parse_decimal(text).unwrap());
        let triple = |p_up, alpha| Lyapunov { p_low: one("1"), p_up: one(p_up), alpha: one(alpha) };
        let family = of(&[&["-1", "1.5"], &["-1", "-1"]]);
        // In the axes diag(1, 1.5) the skew part has the entries sqrt(1.5), -sqrt(1.5): it takes nothing from the rate.
        let p = DMatrix::from_row_slice(2, 2, &[1.0, 0.0, 0.0, 1.5]);
        let holds = |p_up, alpha, p: &DMatrix<f64>, ratio| {
            let triple = triple(p_up, alpha);
            let above = triple.alpha.enclose(DEFAULT_PRECISION).upper_rational().unwrap();
            let rate = WantedRate { text: alpha.to_owned(), value: above.to_f64(), above };
            condition_holds(&triple, &rate, &family, p, ratio)
        };
        assert!(holds("1.6", "0.999", &p, 1.5));
        assert!(!holds("1.6", "1.001", &p, 1.5));
        assert!(!holds("1.4", "0.9", &p, 1.5));
        assert!(holds("1", "0.74", &DMatrix::identity(2, 2), 1.0));
        assert!(!holds("1", "0.76", &DMatrix::identity(2, 2), 1.0));
    }

    #[test]
    fn members_of_a_jacobian_are_within_its_intervals() {
        let text = include_str!("../../../../specs/paper-example-jacobian.json");
        let mut spec = Specification::from_json("jacobian", text).unwrap();
        let jacobian = spec.lyapunov.jacobian().unwrap().clone();
        let one = Constant::rational(&Rational::from(1));
        // The triple does not matter to what is drawn.
        let triple = Lyapunov { p_low: one.clone(), p_up: one.clone(), alpha: one };
        let matrix = PeriodicMatrix { mean: Vec::new(), harmonics: Vec::new() };
        spec.lyapunov = LyapunovSource::Proved { jacobian: jacobian.clone(), triple, matrix, existence: None };
        let claim = TriedClaim::for_tests(spec, [10.0, 10.0]);
        let (mut random, mut largest) = (Random::new(7, 8), 0.0_f64);
        for _ in 0..20 {
            let drawn = draw(&claim, Clock { period: "1", multiple: 1 }, 0.0, &mut random).unwrap();
            let family = family(&claim, &drawn.rows).unwrap();
            for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let [low, high] = match &jacobian.rows[i][j] {
                    JacobianEntry::Function(expr) => [expr.to_float().eval(0.0, 0.0); 2],
                    JacobianEntry::Interval(ends) => [ends[0].to_f64(), ends[1].to_f64()],
                };
                for k in 0..16 {
                    let angle = Enclosure::pi(DEFAULT_PRECISION) * k / 8;
                    let value = family.centre[i][j].at(&angle).midpoint_f64();
                    assert!(low - 1e-12 <= value && value <= high + 1e-12, "{i} {j}: {value}");
                    if low < high {
                        largest = largest.max((value - 0.5 * (low + high)).abs() / (0.5 * (high - low)));
                    }
                }
            }
        }
        assert!(largest > 0.99, "{largest}");
        let ends = [Constant::rational(&Rational::from(1)), Constant::rational(&Rational::from(2))];
        assert!(lies_between(&claim, "1.5 + 0.3*cos(2*pi*t) + 0.39*sin(2*pi*t)", &ends));
        assert!(!lies_between(&claim, "1.5 + 0.31*cos(2*pi*t) + 0.4*sin(2*pi*t)", &ends));
    }
}
