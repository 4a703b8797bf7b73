//! g_N(x) and T_N(x) for every number of oscillators and every x >= 0 (derivation, section 2).

use super::euler_maclaurin::{End, bernoulli_over_index, tail_sums};
use super::inverse_powers::InversePowers;
use crate::data::Data;
use rug::float::Round;
use rug::{Float, Integer, Rational};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::spec::Weights;
use std::cmp::Ordering;
use std::fmt;
use std::sync::OnceLock;

/// The most poles l >= 1 that are summed one by one. With infinitely many or more oscillators, x beyond about two thirds
/// of it is undefined.
pub const MAX_DIRECT_POLES: u64 = 1 << 20;
/// The most pieces between half-integers of which [`PoleSums::transfer_at`] returns the hull.
pub const MAX_PIECES: u64 = 64;
/// Bits carried beyond the precision of the data, so that the rounding of the sums does not show.
const GUARD_BITS: u32 = 32;

/// How many oscillators the internal model has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum OscillatorCount {
    /// N = n_o oscillators; 0 leaves the integrator alone.
    Finite(u64),
    /// One for every l >= 1: the limit of N to infinity.
    Infinite,
}

/// A number, or `infinity`.
impl fmt::Display for OscillatorCount {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            OscillatorCount::Finite(n) => n.fmt(f),
            OscillatorCount::Infinite => f.pad("infinity"),
        }
    }
}

impl OscillatorCount {
    /// Whether the internal model has the pole l: l <= N.
    #[must_use]
    pub fn includes(self, l: u64) -> bool {
        match self {
            OscillatorCount::Finite(n) => l <= n,
            OscillatorCount::Infinite => true,
        }
    }
}

/// The sums over the poles of one internal model, prepared once for any number of x.
///
/// c_0 = n_0, c_l = n_|l|/2, `g_N(x) = sum_{|l|<=N} c_l/(l - x)`, `T_N = g_N'/(1 + nu^2 g_N^2)`, all pure numbers. Poles
/// below L (a little above x and 1.5 x, past the listed weights) are added one by one, the others by the Euler-Maclaurin
/// formula. So the cost grows with x and with the list of weights, not with N. Powers of the first 2^16 integers are kept
/// when they have been used once; evaluation can be shared between threads.
#[derive(Debug)]
pub struct PoleSums {
    count: OscillatorCount,
    precision: u32,
    nu: Enclosure,
    /// n_0, n_1, ... as far as they do not follow the formula; at least n_0.
    listed: Vec<Enclosure>,
    /// n_l = coefficient l^-p beyond the list; no coefficient stands for 1.
    coefficient: Option<Enclosure>,
    powers: InversePowers,
    /// The last pole, when there is one.
    end: Option<End>,
    /// Needed only when there are poles beyond the direct sums.
    bernoulli: OnceLock<Vec<Enclosure>>,
}

/// The sums around one integer m >= 0, for every x in an enclosure.
#[derive(Clone, Debug)]
pub struct AroundPole {
    /// d = x - m.
    pub distance: Enclosure,
    /// R = `sum c_l/(l - x)` over |l| <= N, l != m: g without its pole at m.
    pub sum: Enclosure,
    /// R' = `sum c_l/(l - x)^2` over the same l.
    pub slope: Enclosure,
    /// c_m, or none when m > N: then R = g and R' = g'.
    pub residue: Option<Enclosure>,
}

impl AroundPole {
    /// `T = (c_m + R' d^2)/(d^2 + nu^2 (c_m - R d)^2)`, or `R'/(1 + nu^2 R^2)` without a pole.
    ///
    /// At d = 0 this is 1/(nu^2 c_m): 1/(nu^2 n_0) at x = 0 and 2/(nu^2 n_m) at x = m. The denominator is also enclosed as
    /// `(1 + nu^2 R^2)(d - e)^2 + nu^2 c_m^2/(1 + nu^2 R^2)`, `e = nu^2 c_m R/(1 + nu^2 R^2)`, in which d occurs once: for
    /// wide x it is the better one, and never below Lemma T of the derivation.
    #[must_use]
    pub fn transfer(&self, nu: &Enclosure) -> Enclosure {
        let nu_squared = nu.sqr();
        let (d, sum) = (&self.distance, &self.sum);
        let stretch = 1 + &nu_squared * sum.sqr();
        let Some(residue) = &self.residue else { return &self.slope / stretch };
        let plain = d.sqr() + &nu_squared * (residue - sum * d).sqr();
        let weighted = &nu_squared * residue;
        let denominator = if d.is_exact() {
            plain
        } else {
            let squared = &stretch * (d - &weighted * sum / &stretch).sqr() + &weighted * residue / &stretch;
            plain.intersect(&squared)
        };
        (residue + &self.slope * d.sqr()) / denominator
    }
}

/// R and R' over some set of poles.
struct Sums {
    value: Enclosure,
    slope: Enclosure,
}

impl PoleSums {
    /// Prepares the sums for the weights and nu of a specification, at its working precision.
    ///
    /// Hypotheses: the weights of a [`Specification`](sigmastar_lang::spec::Specification), positive and with a tail
    /// `coefficient l^-p`, p > 1. No other property of them is used.
    #[must_use]
    pub fn new(data: &Data<'_>, count: OscillatorCount) -> PoleSums {
        let work = data.precision.saturating_add(GUARD_BITS);
        let weights = &data.spec.internal_model.weights;
        let (listed, coefficient, exponent) = match weights {
            Weights::Power { epsilon, .. } => (1, None, epsilon.enclose(work) + 1),
            Weights::Explicit { values, coefficient, exponent } => {
                (values.len() as u64, Some(coefficient.enclose(work)), exponent.enclose(work))
            }
        };
        let powers = InversePowers::new(exponent);
        let end = match count {
            OscillatorCount::Finite(n) if n > 0 => {
                // One power by itself: its block would be filled for nothing.
                Some(End { at: integer(n, work), power: powers.power(n) })
            }
            _ => None,
        };
        PoleSums {
            count,
            precision: data.precision,
            nu: data.nu.clone(),
            listed: (0..listed.max(1)).map(|l| weights.weight(l, work)).collect(),
            coefficient,
            powers,
            end,
            bernoulli: OnceLock::new(),
        }
    }

    /// nu = mu/w.
    #[must_use]
    pub fn nu(&self) -> &Enclosure {
        &self.nu
    }

    /// n_l, whether or not l <= N.
    #[must_use]
    pub fn weight(&self, l: u64) -> Enclosure {
        let listed = usize::try_from(l).ok().and_then(|l| self.listed.get(l));
        listed.cloned().unwrap_or_else(|| self.scaled(self.powers.get(l).into_owned()))
    }

    /// c_m: n_0 for m = 0, n_m/2 for m >= 1, none for m > N.
    #[must_use]
    pub fn residue(&self, m: u64) -> Option<Enclosure> {
        self.count.includes(m).then(|| if m == 0 { self.weight(0) } else { self.weight(m) / 2 })
    }

    fn scaled(&self, sum: Enclosure) -> Enclosure {
        match &self.coefficient {
            Some(coefficient) => coefficient * sum,
            None => sum,
        }
    }

    /// The first pole of the Euler-Maclaurin formula, more than x by enough for corrections as small as the last bits
    /// (they shrink to exp(-2 pi (L - x))) and so much larger than x that the geometric series converge quickly.
    fn first_of_tail(&self, x: &Enclosure) -> Option<u64> {
        // Compared first: an integer of a huge number would need as many bits as its exponent says.
        if x.upper() > MAX_DIRECT_POLES {
            return None;
        }
        let above = x.upper().to_integer_round(Round::Up)?.0.to_u64()?;
        let gap = u64::from(self.powers.exponent().precision() / 6 + 8);
        let first = above.checked_add(gap.max(above / 2))?.max(self.listed.len() as u64);
        (first <= MAX_DIRECT_POLES).then_some(first)
    }

    /// R and R' for every x in the interval, without the pole `skip` if there is one.
    ///
    /// For l >= 1 the poles l and -l are taken together: `n_l x/(l^2 - x^2)` and `(n_l/2)(1/(l-x)^2 + 1/(l+x)^2)`.
    fn sums(&self, x: &Enclosure, skip: Option<u64>) -> Sums {
        let work = self.powers.exponent().precision();
        let zero = || Enclosure::zero(work);
        let first_of_tail = self.first_of_tail(x);
        // Few poles are added directly, whatever x.
        let last = match (self.count, first_of_tail) {
            (OscillatorCount::Finite(n), Some(first)) if n <= first.saturating_add(16) => n,
            (OscillatorCount::Finite(n), None) if n <= MAX_DIRECT_POLES => n,
            (_, Some(first)) => first - 1,
            (_, None) => return Sums { value: Enclosure::undefined(work), slope: Enclosure::undefined(work) },
        };
        let add = |sums: Sums, (l, weight): (u64, &Enclosure)| {
            if skip == Some(l) {
                return sums;
            }
            let l = l as i64;
            let (behind, ahead) = ((l - x).recip(), (l + x).recip());
            Sums {
                value: sums.value + weight * (&behind * &ahead),
                slope: sums.slope + weight * (behind.sqr() + ahead.sqr()),
            }
        };
        // Both collect sums still to be multiplied: by x, and by 1/2. `last` is below 2^20 + 16, so no conversion wraps.
        let listed = (1..=last).zip(self.listed.iter().skip(1)).fold(Sums { value: zero(), slope: zero() }, add);
        let beyond = (self.listed.len().max(1) as u64..=last)
            .fold(Sums { value: zero(), slope: zero() }, |sums, l| add(sums, (l, self.powers.get(l).as_ref())));
        let (mut value, mut slope) = (x * beyond.value, beyond.slope / 2);
        if !matches!(self.count, OscillatorCount::Finite(n) if n == last) {
            let start = End { at: integer(last + 1, work), power: self.powers.get(last + 1).into_owned() };
            let ends = (&start, self.end.as_ref());
            // From L on the corrections shrink below the last bits within about 0.14 `work` terms.
            let bernoulli = self.bernoulli.get_or_init(|| bernoulli_over_index(work as usize / 5 + 8, work));
            let [tail_value, tail_slope] = tail_sums(x, self.powers.exponent(), ends, bernoulli, 2 * work);
            value = value + tail_value;
            slope = slope + tail_slope;
        }
        let mut value = self.scaled(value) + x * listed.value;
        let mut slope = self.scaled(slope) + listed.slope / 2;
        if skip != Some(0) {
            value = value - &self.listed[0] / x;
            slope = slope + &self.listed[0] / x.sqr();
        }
        // Of the pair around m >= 1, the pole at -m stays.
        if let Some(m) = skip.filter(|m| *m > 0) {
            let (half, ahead) = (self.weight(m) / 2, (integer(m, work) + x).recip());
            value = value - &half * &ahead;
            slope = slope + half * ahead.sqr();
        }
        Sums { value, slope }
    }

    /// R, R' and c_m for the integer m = `nearest` and every x in the enclosure.
    ///
    /// Hypotheses: 0 <= x; for m <= N, m - 1 < x < m + 1; for m > N, x > N. The results are undefined otherwise, where x is
    /// unbounded, and beyond [`MAX_DIRECT_POLES`].
    ///
    /// Wide intervals: R increases on an interval without poles and R' is convex (its second derivative is
    /// `sum 6 c_l/(l-x)^4`), so R is enclosed by its values at the ends and R' from above by the larger of its two.
    #[must_use]
    pub fn around(&self, x: &Enclosure, nearest: u64) -> AroundPole {
        let residue = self.residue(nearest);
        let applies = x.is_bounded()
            && x.lower() >= 0
            && match self.count {
                OscillatorCount::Finite(n) if residue.is_none() => x.lower() > n,
                _ => (nearest == 0 || x.lower() > nearest - 1) && nearest < u64::MAX && x.upper() < nearest + 1,
            };
        let skip = residue.is_some().then_some(nearest);
        let sums = if !applies {
            Sums { value: Enclosure::undefined(self.precision), slope: Enclosure::undefined(self.precision) }
        } else if self.is_narrow(x) {
            self.sums(x, skip)
        } else {
            let (left, right) =
                (self.sums(&Enclosure::point(&x.lower()), skip), self.sums(&Enclosure::point(&x.upper()), skip));
            let whole = self.sums(x, skip);
            let greatest = left.slope.max(&right.slope);
            Sums {
                value: left.value.hull(&right.value),
                slope: whole.slope.intersect(&Enclosure::zero(2).hull(&greatest)),
            }
        };
        AroundPole {
            distance: x - integer(nearest, self.precision.max(u64::BITS)),
            sum: sums.value.at_precision(self.precision),
            slope: sums.slope.at_precision(self.precision),
            residue: residue.map(|residue| residue.at_precision(self.precision)),
        }
    }

    /// Whether plain interval arithmetic loses nothing that matters on x.
    fn is_narrow(&self, x: &Enclosure) -> bool {
        let width = Float::with_val_round(64, x.upper() - x.lower(), Round::Up).0;
        let scale = Float::with_val_round(64, x.upper() >> (self.precision / 2), Round::Down).0;
        width <= scale
    }

    /// T_N(x) for every x in the enclosure, with the pole m = `nearest` multiplied out; hypotheses as
    /// [`PoleSums::around`]. For thin x the relative width is a few times 2^-precision times the condition of T in x.
    #[must_use]
    pub fn transfer(&self, x: &Enclosure, nearest: u64) -> Enclosure {
        self.around(x, nearest).transfer(&self.nu)
    }

    /// T_N(x) for every x >= 0 in the enclosure: the hull over its pieces between half-integers.
    ///
    /// Undefined when x may be negative, is unbounded, has more than [`MAX_PIECES`] pieces in reach of the poles, or where
    /// the sums are (see [`MAX_DIRECT_POLES`]).
    #[must_use]
    pub fn transfer_at(&self, x: &Enclosure) -> Enclosure {
        let undefined = || Enclosure::undefined(self.precision);
        let Some((first, mut last)) = nearest_integers(x) else { return undefined() };
        if let OscillatorCount::Finite(n) = self.count {
            // Beyond N + 1/2 there is no pole and one piece.
            last = last.min(n.saturating_add(1)).max(first);
        }
        if last - first >= MAX_PIECES {
            return undefined();
        }
        let half = |m: u64| Rational::from((Integer::from(m) * 2u32 + 1u32, 2));
        // Exact: the ends are kept with enough bits for every half-integer that cuts them.
        let bits = x.precision() + 2 * u64::BITS;
        let piece = |m: u64| {
            let left = if m == first { None } else { Some(Float::with_val(bits, half(m - 1))) };
            let right = if m == last { None } else { Some(Float::with_val(bits, half(m))) };
            let piece = Enclosure::new(left.unwrap_or(x.lower()), right.unwrap_or(x.upper()));
            self.transfer(&piece, m)
        };
        (first..=last).skip(1).fold(piece(first), |hull, m| hull.hull(&piece(m)))
    }
}

/// The least and the greatest integer that is nearest to a part of the interval; none when x may be negative or is too
/// large for a count.
fn nearest_integers(x: &Enclosure) -> Option<(u64, u64)> {
    if !x.is_bounded() || x.lower().cmp0() == Some(Ordering::Less) {
        return None;
    }
    let half = Rational::from((1, 2));
    let least = (x.lower_rational()? + &half).floor().numer().to_u64()?;
    let greatest = (x.upper_rational()? - half).ceil().numer().to_u64().unwrap_or(0);
    Some((least, greatest.max(least)))
}

/// An integer at a precision of at least 64 bits: exactly.
fn integer(value: u64, precision: u32) -> Enclosure {
    Enclosure::point(&Float::with_val(precision.max(u64::BITS), value))
}
