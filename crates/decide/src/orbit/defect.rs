//! The defect `eps` of an approximate orbit (derivation, 11.2): an upper bound of `|L^-1 (f(t,xb,0) - xb')|` for all t (and members
//! of a family).

use super::curve::{Curve, PRECISION};
use super::linear::norm;
use super::not_proved::OrbitNotProved;
use super::recurrences::{combine, mul};
use super::taylor::{Expansion, Taylor};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::parallel;
use sigmastar_lang::expr::Walk;

/// The order of the Taylor polynomials in t.
pub(super) const ORDER: usize = 10;

/// Powers of two that the number of cells runs through.
pub(super) const CELLS: std::ops::RangeInclusive<u32> = 4..=9;

/// The power of two from which the number of cells starts: twice the number of harmonics.
pub(super) fn first_exponent(harmonics: usize) -> u32 {
    (2 * harmonics).next_power_of_two().trailing_zeros().clamp(*CELLS.start(), *CELLS.end())
}

/// An upper bound of `|L^-1 (f(t,xb,0;p) - xb')|` over all cells and members; `walk` has the components of f, `slopes` the rows of
/// df/dx and then df/dp for each parameter, `inverse` is `L^-1`.
///
/// Guarantee: if `Ok`, f is smooth near the curves, and the bound holds for every t of the period and every p of the box. With
/// `D(t,p)` the difference and `D_i = f_x xb_i + f_pi - xb_i'` its derivative in p_i, `D(t,p) - D(t,p^0)` is the sum of `p_i - p_i^0`
/// times a mean of D_i over the segment from p^0 to p, which lies in the box. With a clock v, d/dt is v/T_nom times d/ds, and D_v has
/// `-(d/ds xb)/T_nom` besides (13.3).
pub(super) fn bound(
    curve: &Curve,
    walk: &Walk,
    slopes: &Walk,
    inverse: &[Vec<Enclosure>],
) -> Result<Enclosure, OrbitNotProved> {
    largest(&on_cells(curve, walk, slopes, inverse), curve.cells.count)
}

/// An upper bound of `|L^-1 (f(t,xb,0;p) - xb')|` on each cell, for all members. It is not bounded on a cell near which f is not smooth.
fn on_cells(curve: &Curve, walk: &Walk, slopes: &Walk, inverse: &[Vec<Enclosure>]) -> Vec<Enclosure> {
    let cells = &curve.cells;
    let parameters = &curve.members.parameters;
    parallel::numbered(cells.count, |cell| {
        let states = curve.states(cell, ORDER + 1);
        let f = curve.along(walk, cell, (&states, &parameters.nominal), ORDER);
        let difference = [0, 1].map(|which| -> Vec<Taylor> {
            let own = f[which].iter().zip(&states[which]);
            own.map(|(f, x)| combine(f, &slope(x, &curve.period), -1)).collect()
        });
        let along = derivatives_in_parameters(curve, slopes, cell, &states);
        let components = inverse.iter().map(|row| {
            let bound = |difference: &[Vec<Taylor>; 2]| {
                let [middle, over] = difference.each_ref().map(|terms| weigh(row.iter().zip(terms)));
                Expansion::new(&middle, &over, ORDER, PRECISION).bound(&cells.half)
            };
            let own = bound(&difference);
            along.iter().zip(&parameters.reaches).fold(own, |sum, (part, reach)| sum + bound(part) * reach)
        });
        norm(components, PRECISION)
    })
}

/// The middle of the cell with the largest bound, in periods.
pub(super) fn worst(curve: &Curve, walk: &Walk, slopes: &Walk, inverse: &[Vec<Enclosure>]) -> f64 {
    let bounds: Vec<f64> = on_cells(curve, walk, slopes, inverse).iter().map(Enclosure::upper_f64).collect();
    let worst = (0..bounds.len()).max_by(|a, b| bounds[*a].total_cmp(&bounds[*b])).unwrap_or_default();
    (worst as f64 + 0.5) / curve.cells.count as f64
}

/// D_i for each parameter.
fn derivatives_in_parameters(
    curve: &Curve,
    slopes: &Walk,
    cell: usize,
    states: &[Vec<Taylor>; 2],
) -> Vec<[Vec<Taylor>; 2]> {
    let sensitivities = curve.sensitivities(cell, ORDER + 1);
    if sensitivities.is_empty() {
        return Vec::new();
    }
    let n = states[0].len();
    let members = curve.of_members(states, &sensitivities, &curve.members.parameters);
    let values = curve.along(slopes, cell, (&members, &curve.members.parameters.values), ORDER);
    let of_one = |(i, part): (usize, &[Vec<Taylor>; 2])| {
        let is_clock = curve.members.parameters.clock == Some(i);
        [0, 1].map(|which| -> Vec<Taylor> {
            (0..n)
                .map(|row| {
                    let moved = slope(&part[which][row], &curve.elapsed);
                    let moved = match is_clock {
                        true => combine(&moved, &slope(&members[which][row], &curve.period), 1),
                        false => moved,
                    };
                    let own = combine(&values[which][n * (n + i) + row], &moved, -1);
                    (0..n)
                        .fold(own, |sum, j| combine(&sum, &mul(&values[which][n * row + j], &part[which][j], ORDER), 1))
                })
                .collect()
        })
    };
    sensitivities.iter().enumerate().map(of_one).collect()
}

/// The largest of the bounds of all cells; the first cell that has none is told.
pub(super) fn largest(bounds: &[Enclosure], count: usize) -> Result<Enclosure, OrbitNotProved> {
    if let Some(cell) = bounds.iter().position(|bound| !bound.is_bounded()) {
        return Err(OrbitNotProved::NotSmooth { s: (cell as f64 + 0.5) / count as f64, cause: None });
    }
    Ok(bounds.iter().fold(Enclosure::zero(PRECISION), |largest, bound| largest.max(bound)))
}

/// The series of dx/dt from that of x, whose variable is (t - t_0)/T.
pub(super) fn slope(x: &[Enclosure], period: &Enclosure) -> Taylor {
    let mut slope: Taylor = x.iter().zip(0_i64..).skip(1).map(|(c, j)| c * j / period).collect();
    if slope.is_empty() {
        slope.push(Enclosure::zero(PRECISION));
    }
    slope
}

/// The sum of series with factors. A factor that is exactly 0 leaves its series out, but never an undefined one: 0 times what
/// is undefined is undefined.
pub(super) fn weigh<'a>(terms: impl Iterator<Item = (&'a Enclosure, &'a Taylor)>) -> Taylor {
    let nothing = |factor: &Enclosure, term: &Taylor| {
        factor.is_exact() && factor.contains_zero() && term.iter().all(Enclosure::is_defined)
    };
    let terms = terms.filter(|(factor, term)| !nothing(factor, term));
    terms.fold(vec![Enclosure::zero(PRECISION)], |sum, (factor, term)| {
        let scaled: Taylor = term.iter().map(|c| c * factor).collect();
        combine(&sum, &scaled, 1)
    })
}
