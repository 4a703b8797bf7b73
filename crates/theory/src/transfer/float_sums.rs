//! T_N in doubles: where its peaks are and which boxes are worth proposing. Nothing here decides a claim.

use super::lorentz::weight_tail;
use crate::data::Data;
use sigmastar_exact::number::Portable;

/// The weights and nu in doubles.
#[derive(Clone, Debug)]
pub(super) struct FloatSums {
    /// n_0, n_1, ...
    weights: Vec<f64>,
    /// nu.
    pub nu: f64,
}

/// Which numbers of oscillators a box is about, in doubles.
#[derive(Clone, Copy, Debug)]
pub(super) struct FloatGroup {
    /// The last pole that is summed.
    pub last: usize,
    /// For every N > last together: an upper bound of sum_{l > last} n_l/l^2.
    pub tail: Option<f64>,
}

impl FloatSums {
    /// Converts the weights up to `last`.
    pub(super) fn new(data: &Data<'_>, last: usize) -> FloatSums {
        let weights = &data.spec.internal_model.weights;
        FloatSums { weights: (0..=last as u64).map(|l| weights.weight_f64(l)).collect(), nu: data.nu.midpoint_f64() }
    }

    /// The group of all N >= `first`.
    pub(super) fn all_from(data: &Data<'_>, first: u32) -> FloatGroup {
        FloatGroup { last: first as usize - 1, tail: Some(weight_tail(data, first).upper_f64()) }
    }

    /// T_N(0) = 1/(nu^2 n_0).
    pub(super) fn at_zero(&self) -> f64 {
        1.0 / (self.nu * self.nu * self.weights[0])
    }

    /// c_m: n_0, or n_m/2.
    pub(super) fn residue(&self, m: usize) -> f64 {
        if m == 0 { self.weights[0] } else { self.weights[m] / 2.0 }
    }

    /// The sums of c_l/(l - x) and c_l/(l - x)^2 over |l| <= last without the pole `without`.
    fn sums(&self, x: f64, last: usize, without: usize) -> (f64, f64) {
        let (mut sum, mut slope) = (0.0, 0.0);
        (0..self.weights.len().min(last + 1)).for_each(|l| self.add(l, x, without, (&mut sum, &mut slope)));
        (sum, slope)
    }

    /// Adds the terms of l and -l to both sums, but for the pole `without`.
    fn add(&self, l: usize, x: f64, without: usize, (sum, slope): (&mut f64, &mut f64)) {
        let weight = self.weights[l];
        if l == 0 {
            if without != 0 {
                *sum -= weight / x;
                *slope += weight / (x * x);
            }
            return;
        }
        let (behind, half) = (1.0 / (l as f64 + x), weight / 2.0);
        *sum -= half * behind;
        *slope += half * behind * behind;
        if l != without {
            let ahead = 1.0 / (l as f64 - x);
            *sum += half * ahead;
            *slope += half * ahead * ahead;
        }
    }

    /// T from the sums without the nearest pole m; `reached` says whether m is among the poles.
    fn combine(&self, x: f64, m: usize, reached: bool, (sum, slope): (f64, f64)) -> f64 {
        if !reached {
            return slope / (1.0 + (self.nu * sum).portable_powi(2));
        }
        let (c, d) = (self.residue(m), x - m as f64);
        (c + slope * d * d) / (d * d + (self.nu * (c - sum * d)).portable_powi(2))
    }

    /// T_N(x), x > 0.
    pub(super) fn transfer(&self, x: f64, n: usize) -> f64 {
        let m = x.round() as usize;
        let without = if m <= n { m } else { usize::MAX };
        self.combine(x, m, m <= n, self.sums(x, n, without))
    }

    /// The largest T_N(x) over the N that can be summed, and that N; x > 0.
    pub(super) fn supremum(&self, x: f64) -> (f64, usize) {
        let m = x.round() as usize;
        // All poles below m first, then one more at a time: the order in which N grows.
        let (mut best, mut best_n) = (f64::NEG_INFINITY, 0);
        let (mut sum, mut slope) = (0.0, 0.0);
        for l in 0..self.weights.len() {
            self.add(l, x, m, (&mut sum, &mut slope));
            let value = self.combine(x, m, m <= l, (sum, slope));
            if value > best {
                (best, best_n) = (value, l);
            }
        }
        (best, best_n)
    }

    /// The zero of g_N between the poles m and m + 1 <= N, and the half width 1/(nu g_N') of the peak of T_N there.
    pub(super) fn peak(&self, m: usize, n: usize) -> (f64, f64) {
        let (mut low, mut high) = (m as f64, m as f64 + 1.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.sums(middle, n, usize::MAX).0 < 0.0 { low = middle } else { high = middle }
        }
        let x = 0.5 * (low + high);
        (x, 1.0 / (self.nu * self.sums(x, n, usize::MAX).1))
    }

    /// The upper bound of T over a box that an enclosure would give, for the nearest pole m.
    pub(super) fn box_upper(&self, [a, b]: [f64; 2], m: usize, group: FloatGroup) -> f64 {
        let reached = m <= group.last;
        let without = if reached { m } else { usize::MAX };
        let ((low, _), (high, _)) = (self.sums(a, group.last, without), self.sums(b, group.last, without));
        // Each term of the slope at the end of the box where it is largest.
        let mut slope = if without == 0 { 0.0 } else { self.weights[0] / (a * a) };
        for (l, weight) in self.weights.iter().enumerate().take(group.last + 1).skip(1) {
            let l_float = l as f64;
            slope += weight / 2.0 / (l_float + a).portable_powi(2);
            if l != without {
                let nearest_end = if l_float > b { l_float - b } else { a - l_float };
                slope += weight / 2.0 / (nearest_end * nearest_end);
            }
        }
        let mut high = high;
        if let Some(tail) = group.tail {
            let gap = 1.0 - (b / (group.last + 1) as f64).portable_powi(2);
            high += b * tail / gap;
            slope += 2.0 * tail / (gap * gap);
        }
        let least_square = |from: f64, to: f64| {
            if from <= 0.0 && to >= 0.0 { 0.0 } else { (from * from).min(to * to) }
        };
        let nu_squared = self.nu * self.nu;
        if !reached {
            return slope / (1.0 + nu_squared * least_square(low, high));
        }
        let (c, d_low, d_high) = (self.residue(m), a - m as f64, b - m as f64);
        let products = [low * d_low, low * d_high, high * d_low, high * d_high];
        let least = products.iter().copied().fold(f64::INFINITY, f64::min);
        let most = products.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let numerator = c + slope * (d_low * d_low).max(d_high * d_high);
        numerator / (least_square(d_low, d_high) + nu_squared * least_square(c - most, c - least))
    }

    /// By how much the form divided by x^2 holds on [0, b] (see `LorentzSums::near_zero`): positive where it does.
    pub(super) fn near_zero(&self, b: f64, group: FloatGroup, [k0, k1]: [f64; 2]) -> f64 {
        let (mut s, mut slope) = (0.0, 0.0);
        let y = b * b;
        for (l, weight) in self.weights.iter().enumerate().take(group.last + 1).skip(1) {
            let square = (l * l) as f64;
            s += weight / (square - y);
            slope += weight * (square + y) / (square - y).portable_powi(2);
        }
        if let Some(tail) = group.tail {
            let gap = 1.0 - (b / (group.last + 1) as f64).portable_powi(2);
            s += tail / gap;
            slope += 2.0 * tail / (gap * gap);
        }
        let (n_0, nu_squared) = (self.weights[0], self.nu * self.nu);
        let rest = (n_0 - s * y).max(0.0);
        let left = k0 * (1.0 - 2.0 * nu_squared * n_0 * s) + k1 * nu_squared * rest * rest;
        // The scale of the terms, so that a proposal leaves room for rounding.
        left - slope - 1e-9 * (k0 * (1.0 + 2.0 * nu_squared * n_0 * s) + k1 * nu_squared * n_0 * n_0 + slope)
    }
}

#[cfg(test)]
mod tests {
    use super::super::weights_only::weights_only;
    use super::*;

    #[test]
    fn the_supremum_is_the_largest_of_the_members() {
        let spec = weights_only("2", "1/2", "3/10", "1");
        let sums = FloatSums::new(&Data::new(&spec, 128), 12);
        for x in [0.01, 0.3, 0.5, 0.77, 1.0, 1.49, 2.2, 7.6, 11.9, 13.3] {
            let members: Vec<f64> = (0..=12).map(|n| sums.transfer(x, n)).collect();
            let (value, n) = sums.supremum(x);
            let largest = members.iter().copied().fold(0.0, f64::max);
            assert!((value / largest - 1.0).abs() < 1e-12 && (members[n] / largest - 1.0).abs() < 1e-12, "x = {x}");
        }
    }

    #[test]
    fn peaks_are_zeros_of_g_where_t_is_its_slope() {
        let spec = weights_only("2", "1/2", "3/10", "1");
        let sums = FloatSums::new(&Data::new(&spec, 128), 12);
        for (m, n) in [(0, 1), (0, 12), (3, 4), (3, 9), (10, 12)] {
            let (x, width) = sums.peak(m, n);
            assert!(m as f64 <= x && x <= m as f64 + 1.0);
            assert!((sums.transfer(x, n) * width * sums.nu - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn boxes_bound_the_values_in_them() {
        let spec = weights_only("2", "1/2", "3/10", "1");
        let data = Data::new(&spec, 128);
        let sums = FloatSums::new(&data, 40);
        let groups: Vec<(FloatGroup, Vec<usize>)> = vec![
            (FloatGroup { last: 1, tail: None }, vec![1]),
            (FloatGroup { last: 5, tail: None }, vec![5]),
            (FloatSums::all_from(&data, 6), vec![6, 9, 40]),
        ];
        for (a, b, m) in [(0.0, 0.25, 0), (0.25, 0.5, 0), (0.5, 0.75, 1), (0.9, 1.1, 1), (1.0, 1.5, 1), (3.5, 3.625, 4)]
        {
            for (group, members) in &groups {
                let upper = sums.box_upper([a, b], m, *group);
                for n in members {
                    for step in 1..20 {
                        let x = a + (b - a) * f64::from(step) / 20.0;
                        assert!(sums.transfer(x, *n) <= upper, "[{a}, {b}], N = {n}, x = {x}");
                    }
                }
            }
        }
    }
}
