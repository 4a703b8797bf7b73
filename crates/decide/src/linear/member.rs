//! The members of a linear family on a box of its parameters, and how their zero dynamics answer a harmonic.

use super::PRECISION;
use super::held::{Held, product};
use super::jet::{Jet, Offsets};
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

/// The coefficients of all members with parameters in a box, as they depend on these.
#[derive(Clone, Debug)]
pub(super) struct Family {
    /// In the middle, on the box, and the derivatives along the sides; without sides one for all.
    members: [Member; 2],
    slopes: Vec<Member>,
    /// How far the parameters are from the middle.
    offsets: Offsets,
}

/// How the members answer the harmonics.
#[derive(Clone, Debug)]
pub(super) struct Answer {
    /// The harmonics 0, 1, ...
    pub(super) lines: Vec<Line>,
    /// What happens within a sample; none in continuous time.
    pub(super) held: Option<Held>,
    /// How far the parameters are from the middle of their box.
    pub(super) offsets: Offsets,
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
    pub(super) states: Vec<Jet>,
    /// `W_k = d + c (i om_k - A)^-1 b`; at samples `E_ee + E_ex R_k E_xe`.
    pub(super) transfer: Jet,
    /// c_k, the harmonic of q along the orbit; at samples gamma_k.
    pub(super) forcing: Jet,
    /// What holding adds; none in continuous time, where the gain is 1 and the rest 0.
    pub(super) held: Option<HeldLine>,
}

/// What holding the control adds to a line.
#[derive(Clone, Debug)]
pub(super) struct HeldLine {
    /// c_k.
    pub(super) driving: Jet,
    /// `R_k G_x`.
    pub(super) by_control: Vec<Jet>,
    /// `R_k F_x`.
    pub(super) by_forcing: Vec<Jet>,
    /// beta_k.
    pub(super) gain: Jet,
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
    fn step(&self) -> Option<Enclosure> {
        let samples = i64::from(self.samples?);
        Some(Enclosure::pi(PRECISION) * 2 / (&self.fundamental * samples))
    }

    /// `i k Om`.
    fn rate(&self, k: usize) -> Complex {
        Complex { re: Enclosure::zero(PRECISION), im: &self.fundamental * k as i64 }
    }

    /// `i k Om`; at samples `(e^{i k Om h} - 1)/h`.
    pub(super) fn delta(&self, k: usize) -> Complex {
        let Some((samples, step)) = self.samples.zip(self.step()) else { return self.rate(k) };
        let [sin, cos] = half_turn(k as i64, samples);
        // e^{i om h} - 1 = 2 i sin(om h/2) e^{i om h/2}.
        Complex { re: sin.negate(), im: cos }.scaled(&(sin * 2 / &step))
    }
}

/// The sine and the cosine of `pi j/N_s`.
pub(super) fn half_turn(j: i64, samples: u32) -> [Enclosure; 2] {
    let angle = Enclosure::pi(PRECISION) * j / i64::from(samples);
    let [cos, sin] = angle.cos_sin();
    [sin, cos]
}

impl Family {
    /// One member, or all of a box of which nothing is known along its sides.
    pub(super) fn of_one(member: Member) -> Family {
        Family { members: [member.clone(), member], slopes: Vec::new(), offsets: Offsets::default() }
    }

    /// The members of a box: in its middle, on it, their derivatives along the sides, and how far these go from the middle.
    pub(super) fn new(members: [Member; 2], slopes: Vec<Member>, offsets: Vec<Enclosure>) -> Family {
        Family { members, slopes, offsets: Offsets(offsets) }
    }

    fn jet(&self, of: impl Fn(&Member) -> Complex) -> Jet {
        let [middle, all] = self.members.each_ref().map(&of);
        self.offsets.narrowed(Jet::new([middle, all], self.slopes.iter().map(of).collect()))
    }

    fn rows(&self) -> Vec<Vec<Jet>> {
        let count = self.members[0].rows.len();
        let entry = |i: usize, j: usize| self.jet(|member| Complex::real(member.rows[i][j].clone()));
        (0..count).map(|i| (0..count).map(|j| entry(i, j)).collect()).collect()
    }

    /// The lines 0, ..., `last`; `None` where the system for one may be singular, or where a sample is too long.
    pub(super) fn answer(&self, last: usize, clock: &Clock) -> Option<Answer> {
        let rows = self.rows();
        let offsets = self.offsets.clone();
        let mut lines: Vec<Line> = (0..=last).map(|k| self.line(&rows, k, clock.rate(k))).collect::<Option<_>>()?;
        let Some(step) = clock.step() else {
            return Some(Answer { lines, held: None, offsets });
        };
        let held = Held::new(&rows, &step, &offsets)?;
        for (k, line) in lines.iter_mut().enumerate() {
            *line = held_line(line, clock.delta(k), &held, &offsets)?;
        }
        Some(Answer { lines, held: Some(held), offsets })
    }

    fn line(&self, rows: &[Vec<Jet>], k: usize, delta: Complex) -> Option<Line> {
        let n = rows.len() - 1;
        let frequency = delta.im.clone();
        let waves: Vec<Jet> = (0..=n).map(|i| self.jet(|member| coefficient(&member.waves[i], k))).collect();
        let right = |i: usize| [rows[i][n].clone(), waves[i].clone()];
        let [states, orbit] = resolved(rows, &delta, right, &self.offsets)?;
        let (last, d) = (&rows[n][..n], &rows[n][n]);
        let transfer = self.offsets.narrowed(product(last, &states, &self.offsets).add(d));
        let forcing = self.offsets.narrowed(product(last, &orbit, &self.offsets).add(&waves[n]));
        Some(Line { frequency, delta, states, transfer, forcing, held: None })
    }
}

/// The line with a control that is held.
fn held_line(
    Line { frequency, forcing: driving, .. }: &Line,
    delta: Complex,
    held: &Held,
    offsets: &Offsets,
) -> Option<Line> {
    let Held { step_map: map, by_control: control, .. } = held;
    let n = map.len() - 1;
    let driven: Vec<Jet> = held.driven(frequency, offsets)?.iter().map(|part| part.mul(driving, offsets)).collect();
    let right = |i: usize| [map[i][n].clone(), control[i].clone(), driven[i].clone()];
    let [states, by_control, by_forcing] = resolved(map, &delta, right, offsets)?;
    let along = |x: &[Jet], own: &Jet| offsets.narrowed(product(&map[n][..n], x, offsets).add(own));
    let transfer = along(&states, &map[n][n]);
    let gain = along(&by_control, &control[n]);
    let forcing = along(&by_forcing, &driven[n]);
    let held = HeldLine { driving: driving.clone(), by_control, by_forcing, gain };
    Some(Line { frequency: frequency.clone(), delta, states, transfer, forcing, held: Some(held) })
}

/// The solutions of `(delta - A) x = right` for each of the right sides, A the block of the states.
fn resolved<const SIDES: usize>(
    rows: &[Vec<Jet>],
    delta: &Complex,
    right: impl Fn(usize) -> [Jet; SIDES],
    offsets: &Offsets,
) -> Option<[Vec<Jet>; SIDES]> {
    let n = rows.len() - 1;
    let delta = Jet::constant(delta.clone());
    let system = (0..n)
        .map(|i| {
            let entry = |j: usize| if i == j { delta.sub(&rows[i][j]) } else { rows[i][j].negate() };
            (0..n).map(entry).chain(right(i)).collect()
        })
        .collect();
    solved(system, offsets)
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
fn solved<const SIDES: usize>(mut rows: Vec<Vec<Jet>>, offsets: &Offsets) -> Option<[Vec<Jet>; SIDES]> {
    let n = rows.len();
    for k in 0..n {
        let size = |row: &Vec<Jet>| {
            let Complex { re, im } = row[k].all();
            re.midpoint_f64().abs() + im.midpoint_f64().abs()
        };
        let pivot = (k..n).max_by(|&a, &b| size(&rows[a]).total_cmp(&size(&rows[b])))?;
        rows.swap(k, pivot);
        if !rows[k][k].all().norm_squared().is_positive().is_true() {
            return None;
        }
        let (done, rest) = rows.split_at_mut(k + 1);
        let row = &done[k];
        for other in rest {
            let factor = other[k].div(&row[k], offsets);
            for j in k..row.len() {
                other[j] = offsets.narrowed(other[j].sub(&factor.mul(&row[j], offsets)));
            }
        }
    }
    let mut solutions: [Vec<Jet>; SIDES] =
        std::array::from_fn(|side| rows.iter().map(|row| row[n + side].clone()).collect());
    for solution in &mut solutions {
        for k in (0..n).rev() {
            let known = (k + 1..n).fold(solution[k].clone(), |sum, j| sum.sub(&rows[k][j].mul(&solution[j], offsets)));
            solution[k] = offsets.narrowed(known).div(&rows[k][k], offsets);
        }
    }
    Some(solutions)
}
