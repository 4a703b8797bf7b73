//! How fast q changes between two samples, harmonic by harmonic on a box of parameters (docs/mathematics.md, section 14.6).
//!
//! With `V(s) = X_k'(s) = e^(s Ae) V(0) + i om_k c_k int_0^s e^((s-r) Ae) e^(i om_k r) dr B` it is `q' = (c,d) V + i om_k c_k e^(i om_k s)`, and
//! `q'' = (c,d) Ae V + i om_k c_k (d + i om_k) e^(i om_k s)`. On a part of [0, h] with the middle m, of the length 2 r, by the mean value theorem
//! `|q'(s)|^2 <= |q'(m)|^2 + r sup |2 Re(conj(q') q'')|`.

use super::bound::Bound;
use super::complex::Complex;
use super::jet::{Axes, Jet, Number};
use super::series::{Driven, Exponential, column, complex, plus_products};
use proofs_core::interval::Interval;

/// On how many parts of a sample |q'| is bounded: so many for each radian that the fastest harmonic turns in it, within these ends.
const PARTS_OF_A_RADIAN: f64 = 20.0;
const PARTS: [i64; 2] = [4, 16];

/// q' in the middle of a part, on the part, and q'' on the part.
type OnPart<T> = [T; 3];

/// What is the same for all harmonics.
pub struct Ways {
    parts: Vec<Part>,
    /// (c,d), and (c,d) Ae.
    outputs: [Vec<Jet<Complex>>; 2],
    precision: u32,
}

struct Part {
    middle: Interval,
    all: Interval,
    /// At least r.
    reach: Interval,
    /// What stands beside V(0).
    rows: OnPart<Vec<Jet<Complex>>>,
}

/// What c_k adds on each part, of one harmonic.
pub struct Rates(Vec<OnPart<Jet<Complex>>>);

impl Ways {
    /// For parts of [0, h], and harmonics up to the frequency `fastest`.
    pub fn new(axes: &Axes, of: &Exponential<'_>, fastest: &Interval, h: &Interval) -> Ways {
        let turned = (fastest * h).hi().to_f64();
        // A number that is undefined becomes 0 as an integer, so there are parts in any case.
        let count = ((PARTS_OF_A_RADIAN * turned).ceil() as i64).clamp(PARTS[0], PARTS[1]);
        let matrix = of.real();
        let output = matrix.last().cloned().unwrap_or_default();
        let zero = Jet::constant(&Interval::int(0, h.precision()));
        let entry = |j: usize| plus_products(axes, zero.clone(), &output, &column(matrix, j));
        let next: Vec<Jet<Interval>> = (0..output.len()).map(entry).collect();
        let part = |i: i64| {
            let all = (h * i / count).hull(&(h * (i + 1) / count));
            let middle = all.middle();
            let [at_middle, on_part] = [&middle, &all].map(|s| of.grown(s));
            let rows = [(&output, &at_middle), (&output, &on_part), (&next, &on_part)].map(|(row, grown)| {
                let entry = |j: usize| complex(&plus_products(axes, row[j].clone(), row, &column(grown, j)));
                (0..row.len()).map(entry).collect()
            });
            Part { reach: (&all - &middle).abs().ceiling(), middle, all, rows }
        };
        let parts = (0..count).map(part).collect();
        let outputs = [&output, &next].map(|row| row.iter().map(complex).collect());
        Ways { parts, outputs, precision: h.precision() }
    }

    /// What c_k adds, from `i om_k`.
    pub fn of_wave(
        &self,
        axes: &Axes,
        (of, driven): (&Exponential<'_>, &Driven),
        (turning, input): (&Complex, &Jet<Complex>),
    ) -> Rates {
        let one = Jet::constant(&Complex::real(Interval::int(1, turning.im.precision())));
        let [first, second] = &self.outputs;
        // d is the last of (c,d).
        let turned = Jet::constant(turning);
        let faster = first.last().map_or_else(|| turned.clone(), |d| d.plus(&turned));
        let on_part = |part: &Part| {
            let [at_middle, on_part] = [&part.middle, &part.all].map(|s| {
                let angle = &turning.im * s;
                (of.answer(driven, s), Jet::constant(&Complex { re: angle.cos(), im: angle.sin() }))
            });
            [(first, &one, &at_middle), (first, &one, &on_part), (second, &faster, &on_part)].map(
                |(row, factor, (moved, wave))| {
                    let sum = plus_products(axes, axes.times(factor, wave), row, moved);
                    axes.times(input, &sum.mapped(|value| value.times(turning)))
                },
            )
        };
        Rates(self.parts.iter().map(on_part).collect())
    }

    /// A bound of |q'| between samples, from V(0).
    pub fn most(&self, axes: &Axes, Rates(rates): &Rates, velocity: &[Jet<Complex>]) -> Bound {
        let on_part = |(part, own): (&Part, &OnPart<Jet<Complex>>)| {
            let value =
                |which: usize| axes.narrowed(plus_products(axes, own[which].clone(), &part.rows[which], velocity));
            let [at_middle, on_part, next] = [0, 1, 2].map(value);
            let turned = axes.times(&on_part.mapped(Complex::conjugate), &next).mapped(|product| &product.re * 2);
            Bound::of(&at_middle).raised(&turned, &part.reach)
        };
        let zero = Bound::zero(self.precision);
        self.parts.iter().zip(rates).map(on_part).fold(zero, |most, bound| most.most(&bound))
    }
}
