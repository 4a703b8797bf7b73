//! The integral of the negative part of a function known up to a constant error.

use super::ranges::middles;
use rug::Float;
use rug::float::Round;
use sigmastar_exact::enclosure::Enclosure;

/// Pieces examined for one polynomial.
const MAX_PIECES: usize = 512;

/// Bisections of one piece.
const MAX_DEPTH: u32 = 64;

/// When an undecided piece is given up, as its contribution to the integral is small enough.
#[derive(Clone, Debug)]
pub(super) struct Tolerance {
    /// Largest size of the function on the piece, whatever its length.
    pub(super) size: Float,
    /// Largest product of size and length.
    pub(super) area: Float,
}

/// A function q + e on [0, 1]: q a polynomial with point coefficients from the constant term up, |e| <= `error`.
#[derive(Clone, Debug)]
pub(super) struct Perturbed {
    coefficients: Vec<Float>,
    slope: Vec<Float>,
    curvature: Vec<Float>,
    /// A primitive of q, up to an error of at most `rounding` in size on [0, 1].
    primitive: Vec<Float>,
    rounding: Enclosure,
    /// [-error, error]
    error: Enclosure,
    precision: u32,
}

/// The range of a polynomial on [left, right], 0 <= left <= right, by Horner's rule with outward rounding.
fn horner(coefficients: &[Float], left: &Float, right: &Float, precision: u32) -> Enclosure {
    let (mut lower, mut upper) = (Float::new(precision), Float::new(precision));
    for coefficient in coefficients.iter().rev() {
        // x >= 0: the least product is at the left end when the factor is nonnegative, at the right end otherwise.
        let x = if lower >= 0 { left } else { right };
        lower.mul_add_round(x, coefficient, Round::Down);
        let x = if upper >= 0 { right } else { left };
        upper.mul_add_round(x, coefficient, Round::Up);
    }
    Enclosure::new(lower, upper)
}

/// Midpoints, and an upper bound of the sum of what they leave out.
fn split(coefficients: &[Enclosure], precision: u32) -> (Vec<Float>, Enclosure) {
    let (middles, rest) = middles(coefficients, precision);
    (middles, rest.iter().fold(Enclosure::zero(64), |sum, rest| sum + rest.abs()).ceiling())
}

#[derive(Clone, Copy, PartialEq)]
enum Shape {
    Unknown,
    Monotone,
}

struct Piece {
    left: Float,
    right: Float,
    depth: u32,
    shape: Shape,
}

impl Perturbed {
    /// The function with coefficients in the given enclosures, known up to `error` (its upper end is used).
    pub(super) fn new(coefficients: &[Enclosure], error: &Enclosure, precision: u32) -> Perturbed {
        let (coefficients, rest) = split(coefficients, precision);
        let error = (error + rest).ceiling();
        let primitive: Vec<Enclosure> = (1i64..).zip(&coefficients).map(|(k, c)| Enclosure::point(c) / k).collect();
        let (mut primitive, rounding) = split(&primitive, precision);
        primitive.insert(0, Float::new(precision));
        // 32 more bits hold the products with the (small) exponents exactly, and 32 more those of the second time.
        let derivative = |c: &[Float], bits: u32| -> Vec<Float> {
            (1u32..).zip(c.iter().skip(1)).map(|(k, c)| Float::with_val(bits, c * k)).collect()
        };
        let slope = derivative(&coefficients, precision + 32);
        let curvature = derivative(&slope, precision + 64);
        Perturbed { coefficients, slope, curvature, primitive, rounding, error: error.negate().hull(&error), precision }
    }

    /// An enclosure of `integral_0^1 max(-(q + e), 0)` for every measurable e with |e| <= `error`.
    ///
    /// [0, 1] is split until the sign of q + e is proved on a piece, which then adds 0 or minus its integral exactly
    /// up to rounding, or `tolerance` is met, and the piece adds something between 0 and length times size.
    pub(super) fn integral(&self, tolerance: &Tolerance) -> Enclosure {
        let zero = Enclosure::zero(self.precision);
        let mut total = zero.clone();
        let whole = Piece {
            left: Float::new(self.precision),
            right: Float::with_val(self.precision, 1),
            depth: 0,
            shape: Shape::Unknown,
        };
        let (mut pieces, mut examined) = (vec![whole], 0);
        while let Some(mut piece) = pieces.pop() {
            examined += 1;
            let range = self.range(&mut piece);
            if range.lower() >= 0 {
                continue;
            }
            let length = Enclosure::point(&piece.right) - Enclosure::point(&piece.left);
            if range.upper() <= 0 {
                let integral = self.at(&self.primitive, &piece.right) - self.at(&self.primitive, &piece.left)
                    + self.rounding.negate().hull(&self.rounding) * 2
                    + &self.error * &length;
                // The integral of a nonpositive function: what rounding adds above 0 is cut off.
                total = total + (-integral).max(&zero);
                continue;
            }
            // The negative part lies between 0 and this size; it is infinite if nothing is known.
            let size = if range.is_defined() { -range.lower() } else { Float::with_val(64, f64::INFINITY) };
            let area = length * Enclosure::new(Float::new(self.precision), size.clone());
            let small = size <= tolerance.size || area.upper() <= tolerance.area;
            if small || piece.depth >= MAX_DEPTH || examined >= MAX_PIECES {
                total = total + area;
            } else {
                self.split(&piece, &mut pieces);
            }
        }
        total
    }

    /// An enclosure of q + e on a piece; notes when q is proved monotone there.
    fn range(&self, piece: &mut Piece) -> Enclosure {
        let ends = || {
            let left = self.at(&self.coefficients, &piece.left);
            left.hull(&self.at(&self.coefficients, &piece.right)) + &self.error
        };
        if piece.shape == Shape::Monotone {
            return ends();
        }
        let direct = horner(&self.coefficients, &piece.left, &piece.right, self.precision) + &self.error;
        if direct.lower() >= 0 || direct.upper() <= 0 {
            return direct;
        }
        // Mean-value forms: of q' about the middle, then of q.
        let middle = self.middle(piece);
        let offset = Enclosure::new(piece.left.clone(), piece.right.clone()) - Enclosure::point(&middle);
        let mut slope = horner(&self.slope, &piece.left, &piece.right, self.precision);
        if slope.contains_zero() {
            let curvature = horner(&self.curvature, &piece.left, &piece.right, self.precision);
            slope = slope.intersect(&(self.at(&self.slope, &middle) + curvature * &offset));
        }
        if slope.lower() >= 0 || slope.upper() <= 0 {
            let range = ends();
            piece.shape = Shape::Monotone;
            return range;
        }
        let centred = self.at(&self.coefficients, &middle) + slope * offset + &self.error;
        direct.intersect(&centred)
    }

    /// The value of a polynomial at a point of [0, 1].
    fn at(&self, coefficients: &[Float], x: &Float) -> Enclosure {
        horner(coefficients, x, x, self.precision)
    }

    fn middle(&self, piece: &Piece) -> Float {
        Float::with_val(self.precision, &piece.left + &piece.right) / 2
    }

    /// Splits at the middle, or, for a monotone q, around an approximate zero. Any splitting is sound.
    fn split(&self, piece: &Piece, pieces: &mut Vec<Piece>) {
        let mut cuts = vec![self.middle(piece)];
        if piece.shape == Shape::Monotone
            && let Some((before, after)) = self.around_zero(piece)
        {
            cuts = [before, after].into_iter().filter(|x| *x > piece.left && *x < piece.right).collect();
        }
        if cuts.is_empty() {
            cuts.push(self.middle(piece));
        }
        let mut left = piece.left.clone();
        cuts.push(piece.right.clone());
        for right in cuts {
            let (from, to) = (std::mem::replace(&mut left, right.clone()), right);
            pieces.push(Piece { left: from, right: to, depth: piece.depth + 1, shape: piece.shape });
        }
    }

    /// A small bracket around the zero that Newton's method proposes (a guess: nothing rests on it).
    fn around_zero(&self, piece: &Piece) -> Option<(Float, Float)> {
        let value = |coefficients: &[Float], x: &Float| {
            let mut sum = Float::new(self.precision);
            for coefficient in coefficients.iter().rev() {
                sum.mul_add_mut(x, coefficient);
            }
            sum
        };
        let mut zero = self.middle(piece);
        for _ in 0..7 {
            let step = value(&self.coefficients, &zero) / value(&self.slope, &zero);
            zero -= &step;
            zero = zero.clamp(&piece.left, &piece.right);
            if step.clone().abs() < Float::with_val(64, 1) >> (self.precision / 2) {
                break;
            }
        }
        let blur = Float::with_val(64, self.error.upper() / value(&self.slope, &zero)).abs() * 4;
        let radius: Float = blur + (Float::with_val(64, 1) >> (self.precision / 2));
        (zero.is_finite() && radius.is_finite()).then(|| {
            (Float::with_val(self.precision, &zero - &radius), Float::with_val(self.precision, &zero + &radius))
        })
    }
}
