//! The members of a linear family on a box of its parameters, and how their zero dynamics answer a harmonic.

use super::PRECISION;
use super::held::Held;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::expr::TrigonometricPolynomial;
use sigmastar_theory::transfer::Complex;

/// The coefficients of all members with parameters in a box.
#[derive(Clone, Debug)]
pub struct Member {
    /// `[[A, b], [c, d]]` by rows.
    pub rows: Vec<Vec<Enclosure>>,
    /// f(t,0,0) and then q(t,0,0).
    pub waves: Vec<TrigonometricPolynomial>,
}

/// How the members answer the harmonics.
#[derive(Clone, Debug)]
pub(super) struct Answer {
    /// The harmonics 0, 1, ...
    pub(super) lines: Vec<Line>,
    /// What happens within a sample; none in continuous time.
    pub(super) held: Option<Held>,
}

/// One harmonic, `e^{i k Om t}`, of the members: with the harmonics e of the error and v of the control b u, that of x is
/// `states e + by_control v + by_forcing`, and `(delta - transfer) e = gain v + forcing`. At samples they are values at the sampling instants.
#[derive(Clone, Debug)]
pub(super) struct Line {
    /// `om_k = k Om`.
    pub(super) frequency: Enclosure,
    /// `i om_k`; at samples `(e^{i om_k h} - 1)/h`.
    pub(super) delta: Complex,
    /// `(i om_k - A)^-1 b`; at samples `R_k E_xe`.
    pub(super) states: Vec<Complex>,
    /// `W_k = d + c (i om_k - A)^-1 b`; at samples `E_ee + E_ex R_k E_xe`.
    pub(super) transfer: Complex,
    /// c_k, the harmonic of q along the orbit; at samples gamma_k.
    pub(super) forcing: Complex,
    /// What holding adds; none in continuous time, where the gain is 1 and the rest 0.
    pub(super) held: Option<HeldLine>,
}

/// What holding the control adds to a line.
#[derive(Clone, Debug)]
pub(super) struct HeldLine {
    /// c_k.
    pub(super) driving: Complex,
    /// `R_k G_x`.
    pub(super) by_control: Vec<Complex>,
    /// `R_k F_x`.
    pub(super) by_forcing: Vec<Complex>,
    /// beta_k.
    pub(super) gain: Complex,
}

/// The instants at which the harmonics are looked at.
#[derive(Clone, Debug)]
pub struct Clock {
    /// Om.
    pub fundamental: Enclosure,
    /// N_s, at samples.
    pub samples: Option<u32>,
}

impl Clock {
    /// h, at samples.
    pub(super) fn step(&self) -> Option<Enclosure> {
        let samples = i64::from(self.samples?);
        Some(Enclosure::pi(PRECISION) * 2 / (&self.fundamental * samples))
    }
}

/// The sine and the cosine of `pi j/N_s`.
pub(super) fn half_turn(j: i64, samples: u32) -> [Enclosure; 2] {
    let angle = Enclosure::pi(PRECISION) * j / i64::from(samples);
    [angle.sin(), angle.cos()]
}

impl Member {
    /// The lines 0, ..., `last`; `None` where the system for one may be singular, or where a sample is too long.
    pub(super) fn answer(&self, last: usize, clock: &Clock) -> Option<Answer> {
        let mut lines: Vec<Line> = (0..=last).map(|k| self.line(k, &clock.fundamental)).collect::<Option<_>>()?;
        let Some((samples, step)) = clock.samples.zip(clock.step()) else { return Some(Answer { lines, held: None }) };
        let held = Held::new(&self.rows, &step)?;
        for (k, line) in lines.iter_mut().enumerate() {
            let [sin, cos] = half_turn(k as i64, samples);
            // e^{i om h} - 1 = 2 i sin(om h/2) e^{i om h/2}.
            let delta = Complex { re: sin.negate(), im: cos }.scaled(&(sin * 2 / &step));
            *line = self.held_line(line, delta, &held)?;
        }
        Some(Answer { lines, held: Some(held) })
    }

    fn line(&self, k: usize, fundamental: &Enclosure) -> Option<Line> {
        let n = self.rows.len() - 1;
        let frequency = fundamental * k as i64;
        let delta = Complex { re: Enclosure::zero(PRECISION), im: frequency.clone() };
        let waves: Vec<Complex> = self.waves.iter().map(|wave| coefficient(wave, k)).collect();
        let right = |i: usize| [Complex::real(self.rows[i][n].clone()), waves[i].clone()];
        let ([states, orbit], last) = (resolved(&self.rows, &delta, right)?, &self.rows[n]);
        let transfer = along(last, &states, Complex::real(last[n].clone()));
        let forcing = along(last, &orbit, waves[n].clone());
        Some(Line { frequency, delta, states, transfer, forcing, held: None })
    }

    /// The line with a control that is held.
    fn held_line(&self, Line { frequency, forcing: driving, .. }: &Line, delta: Complex, held: &Held) -> Option<Line> {
        let n = self.rows.len() - 1;
        let driven: Vec<Complex> = held.driven(frequency)?.iter().map(|part| part.mul(driving)).collect();
        let map = &held.step_map;
        let control: Vec<Complex> = held.by_control.iter().cloned().map(Complex::real).collect();
        let right = |i: usize| [Complex::real(map[i][n].clone()), control[i].clone(), driven[i].clone()];
        let [states, by_control, by_forcing] = resolved(map, &delta, right)?;
        let last = &map[n];
        let transfer = along(last, &states, Complex::real(last[n].clone()));
        let gain = along(last, &by_control, control[n].clone());
        let forcing = along(last, &by_forcing, driven[n].clone());
        let held = HeldLine { driving: driving.clone(), by_control, by_forcing, gain };
        Some(Line { frequency: frequency.clone(), delta, states, transfer, forcing, held: Some(held) })
    }
}

/// `start + c x`, c the row without its last entry.
fn along(row: &[Enclosure], x: &[Complex], start: Complex) -> Complex {
    x.iter().zip(row).fold(start, |sum, (x, c)| sum.add(&x.scaled(c)))
}

/// The solutions of `(delta - A) x = right` for each of the right sides, A the block of the states.
fn resolved<const SIDES: usize>(
    rows: &[Vec<Enclosure>],
    delta: &Complex,
    right: impl Fn(usize) -> [Complex; SIDES],
) -> Option<[Vec<Complex>; SIDES]> {
    let n = rows.len() - 1;
    let system = (0..n)
        .map(|i| {
            let entry = |j: usize| {
                let own = Complex::real(rows[i][j].clone());
                if i == j { delta.sub(&own) } else { Complex::real(rows[i][j].negate()) }
            };
            (0..n).map(entry).chain(right(i)).collect()
        })
        .collect();
    solved(system)
}

/// The coefficient of `e^{i k Om t}`: (a_k - i b_k)/2, and the mean for k = 0.
fn coefficient(wave: &TrigonometricPolynomial, k: usize) -> Complex {
    let zero = Enclosure::zero(PRECISION);
    match k.checked_sub(1) {
        None => Complex::real(wave.mean.clone()),
        Some(index) => match wave.harmonics.get(index) {
            Some([a, b]) => Complex { re: a / 2, im: (b / 2).negate() },
            None => Complex::real(zero),
        },
    }
}

/// The solutions for so many right sides, which stand in the last columns: elimination with the pivot whose middle is largest.
///
/// Guarantee: they contain those of every system within the enclosures. `None` where a pivot may be 0.
fn solved<const SIDES: usize>(mut rows: Vec<Vec<Complex>>) -> Option<[Vec<Complex>; SIDES]> {
    let n = rows.len();
    for k in 0..n {
        let size = |row: &Vec<Complex>| row[k].re.midpoint_f64().abs() + row[k].im.midpoint_f64().abs();
        let pivot = (k..n).max_by(|&a, &b| size(&rows[a]).total_cmp(&size(&rows[b])))?;
        rows.swap(k, pivot);
        if !rows[k][k].norm_squared().is_positive().is_true() {
            return None;
        }
        let (done, rest) = rows.split_at_mut(k + 1);
        let row = &done[k];
        for other in rest {
            let factor = other[k].div(&row[k]);
            for j in k..row.len() {
                other[j] = other[j].sub(&factor.mul(&row[j]));
            }
        }
    }
    let mut solutions: [Vec<Complex>; SIDES] =
        std::array::from_fn(|side| rows.iter().map(|row| row[n + side].clone()).collect());
    for solution in &mut solutions {
        for k in (0..n).rev() {
            let known = (k + 1..n).fold(solution[k].clone(), |sum, j| sum.sub(&rows[k][j].mul(&solution[j])));
            solution[k] = known.div(&rows[k][k]);
        }
    }
    Some(solutions)
}
