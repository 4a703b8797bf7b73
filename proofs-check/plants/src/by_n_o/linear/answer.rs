//! What a plant that is linear in x and e answers to one harmonic, on a box of its parameters (docs/mathematics.md, sections 14.3 and 14.6), and the linear
//! equations that say it.

use super::between::Rates;
use super::complex::Complex;
use super::jet::{Axes, Jet};

/// Of one harmonic: `(i om_k - W_k) e_k = b u_k + c_k`, and at samples `(delta_k - W_k) e_k = beta_k b u_k + gamma_k`.
pub struct Answer {
    /// k.
    pub k: usize,
    /// `i om_k`, or delta_k.
    pub speed: Complex,
    /// `R_k g`, or `R_k E_xe`, in the coordinates of the claim.
    pub of_error: Vec<Jet<Complex>>,
    /// W_k.
    pub transfer: Jet<Complex>,
    /// c_k, or gamma_k.
    pub forcing: Jet<Complex>,
    /// What it has besides at samples.
    pub between: Option<Between>,
}

/// What one harmonic has besides.
pub struct Between {
    /// c_k.
    pub input: Jet<Complex>,
    /// beta_k.
    pub of_control: Jet<Complex>,
    /// `R_k G_x` and `R_k F_x`.
    pub states: Vec<[Jet<Complex>; 2]>,
    /// What q' has of c_k alone.
    pub rates: Rates,
}

/// The solutions of linear equations, by their rows of n coefficients and the right sides: what stands in the place of the right sides in the end
/// (Gauss and Jordan). The pivot is one that is large in the middle; which one it is decides nothing.
pub fn solved(mut rows: Vec<Vec<Jet<Complex>>>, axes: &Axes) -> Vec<Vec<Jet<Complex>>> {
    let n = rows.len();
    for step in 0..n {
        let size = |row: &Vec<Jet<Complex>>| row[step].middle.square().to_f64();
        let best = (step..n).max_by(|a, b| size(&rows[*a]).total_cmp(&size(&rows[*b])));
        rows.swap(step, best.unwrap_or(step));
        let pivot = rows[step][step].clone();
        rows[step].iter_mut().skip(step).for_each(|entry| *entry = axes.over(entry, &pivot));
        let own = rows[step].clone();
        for (_, row) in rows.iter_mut().enumerate().filter(|(i, _)| *i != step) {
            let factor = row[step].clone();
            row.iter_mut()
                .zip(&own)
                .skip(step)
                .for_each(|(entry, other)| *entry = entry.minus(&axes.times(&factor, other)));
        }
    }
    rows.into_iter().map(|row| row.into_iter().skip(n).collect()).collect()
}
