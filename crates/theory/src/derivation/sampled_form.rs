//! F of the regulator at samples over the derivatives at one point (derivation, 13.7, (Ms), and (E) at samples): written once, for
//! enclosures on boxes, which decide, and for doubles at points, with which a search proposes.

use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::real::{Operand, Real};
use sigmastar_lang::spec::SampledLoop;
use std::marker::PhantomData;

/// What entries are computed in.
pub trait Arithmetic {
    /// What is the same at all points.
    type Number: Real;
    /// What depends on the point.
    type Value: Clone;
    /// The value that is the same at all points.
    fn constant(&self, value: Self::Number) -> Self::Value;
    /// The sum.
    fn add(&self, a: &Self::Value, b: &Self::Value) -> Self::Value;
    /// The value times a number.
    fn scale(&self, value: &Self::Value, factor: &Self::Number) -> Self::Value;
}

/// Numbers at a point: doubles, or enclosures for all that they contain.
pub struct AtPoint<R>(PhantomData<R>);

impl<R> Default for AtPoint<R> {
    fn default() -> AtPoint<R> {
        AtPoint(PhantomData)
    }
}

impl<R: Real> Arithmetic for AtPoint<R>
where
    for<'a> &'a R: Operand<R>,
{
    type Number = R;
    type Value = R;

    fn constant(&self, value: R) -> R {
        value
    }

    fn add(&self, a: &R, b: &R) -> R {
        a + b
    }

    fn scale(&self, value: &R, factor: &R) -> R {
        value * factor
    }
}

/// The numbers of a law at samples and its gain.
#[derive(Clone, Debug)]
pub struct LoopNumbers<R> {
    /// sigma.
    pub sigma: R,
    /// h.
    pub step: R,
    /// K.
    pub gain: R,
    /// 1/(1 + theta) = 1 - K h Nb2/2, with an input gain b_hi K for K.
    pub kept: R,
    /// h/pi.
    pub across: R,
    /// (1-b) sigma at both ends of an input gain; 0 alone without one.
    pub moved: Vec<R>,
}

impl<R: Real> LoopNumbers<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// Of sigma, h, K, Nb2 and pi, and the 1 - b at both ends of an input gain.
    #[must_use]
    pub fn new(sigma: R, step: R, [gain, weight_sum]: [R; 2], pi: &R, moves: Option<[R; 2]>) -> LoopNumbers<R> {
        let largest = moves.as_ref().map_or_else(|| gain.clone(), |[_, least]| &gain * (R::int(1) - least));
        let kept = R::int(1) - largest * &step * weight_sum / R::int(2);
        let moved = moves.map_or_else(|| vec![R::int(0)], |moves| moves.map(|share| share * &sigma).into());
        LoopNumbers { across: &step / pi, sigma, step, gain, kept, moved }
    }

    /// With 3/2 of h/pi: for differences that a control that moves within a sample moves, too, as `(a + b)^2 <= 9/4 a^2 + 9/5 b^2` (derivation, 14.6).
    #[must_use]
    pub fn with_ripple(self) -> LoopNumbers<R> {
        LoopNumbers { across: self.across * R::int(3) / R::int(2), ..self }
    }

    /// Both ends of a sample, with both ends of an input gain and, with a delay, both signs of what it adds: F is affine in where it is in the
    /// sample, in b, and in b_1 of the law.
    pub fn corners(&self, delayed: bool) -> impl Iterator<Item = Corner<'_, R>> {
        let signs: &[i64] = if delayed { &[1, -1] } else { &[0] };
        let with_gain = End::BOTH.into_iter().flat_map(|end| self.moved.iter().map(move |moved| (end, moved)));
        with_gain.flat_map(move |(end, moved)| signs.iter().map(move |sign| Corner { end, moved, sign: *sign }))
    }
}

impl LoopNumbers<Enclosure> {
    /// Enclosed; T is the period, and `moves` the 1 - b at both ends of an input gain.
    pub fn enclosed(
        about: &SampledLoop,
        period: &Enclosure,
        moves: Option<&[Rational; 2]>,
        precision: u32,
    ) -> LoopNumbers<Enclosure> {
        let exact = |number: &Rational| Enclosure::from_rational(number, precision);
        let step = period / Enclosure::from_integer(i64::from(about.samples), precision);
        let law = [&about.law.gain, &about.law.weight_sum].map(exact);
        let moves = moves.map(|moves| moves.each_ref().map(exact));
        LoopNumbers::new(exact(&about.sigma), step, law, &Enclosure::pi(precision), moves)
    }

    /// In doubles.
    pub fn to_f64(&self) -> LoopNumbers<f64> {
        let LoopNumbers { sigma, step, gain, kept, across, moved } = self;
        let [sigma, step, gain, kept, across] = [sigma, step, gain, kept, across].map(Enclosure::midpoint_f64);
        let moved = moved.iter().map(Enclosure::midpoint_f64).collect();
        LoopNumbers { sigma, step, gain, kept, across, moved }
    }
}

/// Where in a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// s = 0.
    Start,
    /// s = h.
    End,
}

impl End {
    /// Both of them.
    pub const BOTH: [End; 2] = [End::Start, End::End];
}

/// One of those at which F is to be positive.
pub struct Corner<'n, R> {
    /// Where in a sample.
    pub end: End,
    /// (1-b) sigma.
    pub moved: &'n R,
    /// The sign of b_1 = M'N R M, at its largest size; 0 without a delay.
    pub sign: i64,
}

/// The free numbers of F.
#[derive(Clone)]
pub struct FormNumbers<'n, R> {
    /// The law at samples and its gain.
    pub of: &'n LoopNumbers<R>,
    /// The weight of e^2: 1 in every claim, a variable of the programs that propose.
    pub weight: R,
    /// k_p, the weight of the internal model.
    pub k_p: R,
    /// The multiplier of what G is.
    pub lambda: R,
    /// What F must exceed.
    pub less: Less<R>,
    /// Of q0^2; without it q0 is no variable.
    pub gamma: Option<R>,
    /// g_m, the weight of the last y of the law with a delay; without it that is no variable.
    pub past: Option<R>,
}

/// What F must exceed beside what its block of x holds: so much of e_k^2, of e(s)^2 and of y^2.
#[derive(Clone)]
pub struct Less<R> {
    /// Of e_k^2.
    pub e_k: R,
    /// Of e(s)^2.
    pub e: R,
    /// Of y^2.
    pub y: R,
}

/// The derivatives at a point, with P.
pub struct Parts<V> {
    /// The block of x, on and above the diagonal.
    pub decay: Vec<(usize, usize, V)>,
    /// P g.
    pub moved: Vec<V>,
    /// q_x in the coordinates y.
    pub r: Vec<V>,
    /// q_e.
    pub d: V,
}

/// The entries of F on and above the diagonal in (x, e_k, y, G, w), then q0 and then p = y_{k-1} where there are these, at one of
/// [`LoopNumbers::corners`].
///
/// With e(s) = (1 - s sigma) e_k + s Y + G, Y = y, with a delay Y = y + h sigma p, the form is that of the block of x, -2 x'P g e(s)
/// + weight (sigma (2 - h sigma) e_k^2 - 2 (1 - h sigma) e_k Y - h Y^2) + k_p y^2/(1 + theta) - k_p y (r x + d e(s) + q0) + lambda G^2
/// + 2 lambda (h/pi) w (r x + d e(s) + q0) + lambda w^2 + gamma q0^2, less what it must exceed.
///
/// With an input gain less `k_p (1-b) sigma e_k y`, for y = q + (1-b) sigma e_k + b K v in the mean (13.1), with a delay `e_k - h p` there for e_k; and
/// with a delay g_m (p^2 - y^2) and 2 k_p theta/(1 + theta) y p with the sign of the corner besides (13.7, 14.6).
pub fn form<A: Arithmetic>(
    a: &A,
    numbers: FormNumbers<'_, A::Number>,
    corner: &Corner<'_, A::Number>,
    parts: Parts<A::Value>,
) -> Vec<(usize, usize, A::Value)>
where
    for<'a> &'a A::Number: Operand<A::Number>,
{
    let FormNumbers { of, weight, k_p, lambda, less, gamma, past } = numbers;
    let LoopNumbers { sigma, step, kept, across, .. } = of;
    let Corner { end, moved: of_gain, sign } = *corner;
    let int = <A::Number as Real>::int;
    let product = step * sigma;
    let decayed = int(1) - &product;
    let (of_e, of_y) = match end {
        End::Start => (int(1), step * int(0)),
        End::End => (decayed.clone(), step.clone()),
    };
    let of_p = &of_y * &product;
    let half = &k_p / int(2);
    let across = &lambda * across;
    let Parts { decay, moved, r, d } = parts;
    let n = moved.len();
    let [e, y, g, w, q] = [n, n + 1, n + 2, n + 3, n + 4];
    let p = if gamma.is_some() { q + 1 } else { q };
    let mut entries = decay;
    for (i, (moved, r)) in moved.iter().zip(&r).enumerate() {
        entries.push((i, e, a.scale(moved, &-of_e.clone())));
        entries.push((i, y, a.add(&a.scale(moved, &-of_y.clone()), &a.scale(r, &-half.clone()))));
        entries.push((i, g, a.scale(moved, &int(-1))));
        entries.push((i, w, a.scale(r, &across)));
        if past.is_some() {
            entries.push((i, p, a.scale(moved, &-of_p.clone())));
        }
    }
    let constant = |value: A::Number| a.constant(value);
    let with_d = |value: A::Number, factor: A::Number| a.add(&a.constant(value), &a.scale(&d, &factor));
    let of_square = &k_p * kept - &weight * step - less.y - &less.e * of_y.sqr();
    let of_square = past.as_ref().map_or_else(|| of_square.clone(), |past| &of_square - past);
    entries.push((e, e, constant(&weight * sigma * (int(2) - &product) - less.e_k - &less.e * of_e.sqr())));
    entries.push((e, y, with_d(-(&weight * &decayed) - &less.e * &of_e * &of_y - &half * of_gain, -(&half * &of_e))));
    entries.push((e, g, constant(-(&less.e * &of_e))));
    entries.push((e, w, a.scale(&d, &(&across * &of_e))));
    entries.push((y, y, with_d(of_square, -(&k_p * &of_y))));
    entries.push((y, g, with_d(-(&less.e * &of_y), -half.clone())));
    entries.push((y, w, a.scale(&d, &(&across * &of_y))));
    entries.push((g, g, constant(&lambda - &less.e)));
    entries.push((g, w, a.scale(&d, &across)));
    entries.push((w, w, constant(lambda)));
    if let Some(gamma) = gamma {
        entries.push((y, q, constant(-half.clone())));
        entries.push((w, q, constant(across.clone())));
        entries.push((q, q, constant(gamma)));
    }
    if let Some(past) = past {
        let of_delay = &half * step * of_gain + int(sign) * &k_p * (int(1) - kept);
        entries.push((e, p, constant(-(&weight * &decayed * &product) - &less.e * &of_e * &of_p)));
        let own = of_delay - &weight * step * &product - &less.e * &of_y * &of_p;
        entries.push((y, p, with_d(own, -(&half * &of_p))));
        entries.push((g, p, constant(-(&less.e * &of_p))));
        entries.push((w, p, a.scale(&d, &(&across * &of_p))));
        entries.push((p, p, constant(past - &weight * step * product.sqr() - &less.e * of_p.sqr())));
    }
    entries
}
