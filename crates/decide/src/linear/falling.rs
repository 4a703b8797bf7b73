//! A quadratic form that falls along every difference of two solutions of a linear loop, and the peaks that follow (derivation, 13.7 (M),
//! 14.5; at samples 14.6).

use super::PRECISION;
use super::plant::LinearPlant;
use super::steady::{AtSamples, Loop, Sizes};
use rug::Rational;
use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_matrix::{ScaledMatrix, is_positive_definite, is_symmetric};
use sigmastar_theory::derivation::sampled_form::{AtPoint, FormNumbers, Less, LoopNumbers, Parts, form};

/// The most boxes of parameters that are looked at.
const MAX_BOXES: usize = 2048;

/// `V = y'P y + w e^2 + (b mu k_p/2) |zeta|_N^2`, at the gain b of the actuator; at samples with K for mu, and with a delay `g_m h y_{k-1}^2` besides.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Falling {
    /// P by rows: symmetric, positive definite, in the coordinates `y = L^-1 x`.
    pub matrix: Vec<Vec<Rational>>,
    /// `P <= p_up I`.
    pub p_up: Rational,
    /// w > 0.
    pub weight: Rational,
    /// k_p > 0.
    pub k_p: Rational,
    /// At samples, and only there.
    pub held: Option<FallingHeld>,
}

/// What a form has at samples.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FallingHeld {
    /// lambda > 0, the multiplier of what moves within a sample.
    pub lambda: Rational,
    /// g_m > 0, with a delay and only there.
    pub past: Option<Rational>,
}

/// The starts.
#[derive(Clone, Debug)]
pub struct Start {
    /// X_0, of `|L^-1 (x - x_0)|`.
    pub x0: Enclosure,
    /// E_0.
    pub e0: Enclosure,
    /// Z_0; none where the regulator sets z = M e at its first instant.
    pub z0: Option<Enclosure>,
    /// Y_0, with a delay: |e_0 - et_0| is at most h times that. Else 0.
    pub y0: Enclosure,
}

impl Start {
    /// d_X, d_E and d_Z: how far the starts are at most from a periodic solution of these sizes X_N, E_N and Z_N, as `zeta = z - M e` (derivation,
    /// 14.5).
    #[must_use]
    pub fn distances(&self, own: &Loop, [states, error, zeta]: [&Enclosure; 3]) -> [Enclosure; 3] {
        let Start { x0, e0, z0, .. } = self;
        let of_start = z0.as_ref().map(|z0| z0 + own.n_bar_squared.sqrt() * e0);
        [x0 + states, e0 + error, of_start.map_or_else(|| zeta.clone(), |of_start| of_start + zeta)]
    }
}

/// Bounds for every solution from the set, at all times.
#[derive(Clone, Debug)]
pub struct Peak {
    /// Of |e - e_per|.
    pub error: Enclosure,
    /// Of |u - u_per|, of the law.
    pub control: Enclosure,
}

impl Falling {
    /// Whether V falls.
    ///
    /// Guarantee: `True` only if P is symmetric and positive definite, not above p_up, w and k_p are positive, and
    /// `[[-(P J + J'P), -P g, -(k_p/2) r'], [., 2 sigma w, -w - (k_p/2)(d + (1-b) sigma)], [., ., k_p]]` is positive definite for every
    /// member, in the coordinates y, and every gain b of the actuator; at samples (14.6a) holds, with lambda > 0 and, with a delay, g_m > 0. Then V
    /// tends to 0 along every difference of two solutions and never rises, for every number of oscillators; the loop has no periodic solution but one.
    /// Hypothesis at samples: h sigma <= 1.
    #[must_use]
    pub fn decide(&self, plant: &LinearPlant, own: &Loop, coordinates: &[Vec<Rational>]) -> Truth {
        let Falling { matrix, p_up, weight, k_p, held } = self;
        let n = plant.states();
        let of_law = match (held, &own.held) {
            (None, None) => true,
            (Some(FallingHeld { lambda, past }), Some(held)) => {
                *lambda > 0 && past.is_some() == held.delayed && past.as_ref().is_none_or(|past| *past > 0)
            }
            _ => false,
        };
        let below = |i: usize, j: usize| Rational::from(if i == j { p_up } else { &ZERO } - &matrix[i][j]);
        let fits = is_symmetric(matrix, n)
            && is_positive_definite(matrix)
            && is_positive_definite(&(0..n).map(|i| (0..n).map(|j| below(i, j)).collect()).collect::<Vec<_>>())
            && *weight > 0
            && *k_p > 0
            && of_law;
        if !fits {
            return Truth::False;
        }
        let numbers = own.held.as_ref().map(|held| own.numbers(held));
        let mut open = vec![plant.whole().to_vec()];
        let mut boxes = 0;
        while let Some(ends) = open.pop() {
            boxes += 1;
            let holds = plant.member(&plant.enclosed(&ends)).is_some_and(|member| {
                let rows = own.in_coordinates(&member.rows, coordinates);
                match (held, &numbers) {
                    (Some(held), Some(numbers)) => self.is_definite_at_samples(&rows, held, numbers),
                    _ => own.gain.iter().all(|b| self.is_definite(&rows, own, b)),
                }
            });
            if holds {
                continue;
            }
            let Some(halves) = widest_halved(&ends).filter(|_| boxes < MAX_BOXES) else { return Truth::Undecided };
            open.extend(halves);
        }
        Truth::True
    }

    /// Whether the matrix is positive definite for every entry of `[[J, g], [r, d]]` in these enclosures.
    fn is_definite(&self, rows: &[Vec<Enclosure>], own: &Loop, b: &Enclosure) -> bool {
        let n = rows.len() - 1;
        let exact = |value: &Rational| Enclosure::from_rational(value, PRECISION);
        let (weight, k_p) = (exact(&self.weight), exact(&self.k_p));
        let half = &k_p / 2;
        let zero = || Enclosure::zero(PRECISION);
        // P times a column.
        let times =
            |i: usize, column: usize| (0..n).fold(zero(), |sum, k| sum + exact(&self.matrix[i][k]) * &rows[k][column]);
        let entry = |i: usize, j: usize| {
            // i >= j.
            match (i, j) {
                (i, j) if i < n => (times(i, j) + times(j, i)).negate(),
                (i, j) if i == n && j < n => times(j, n).negate(),
                (i, j) if i == n && j == n => &own.sigma * &weight * 2,
                (_, j) if j < n => (&half * &rows[n][j]).negate(),
                (_, j) if j == n => {
                    let moved = &rows[n][n] + (Enclosure::one(PRECISION) - b) * &own.sigma;
                    (&weight + &half * moved).negate()
                }
                _ => k_p.clone(),
            }
        };
        ScaledMatrix::from_enclosures(n + 2, entry).is_some_and(|matrix| matrix.is_positive_definite().is_true())
    }

    /// Whether the matrix of (14.6a) is positive definite at all corners, for every entry of `[[J, g], [r, d]]` in these enclosures.
    fn is_definite_at_samples(
        &self,
        rows: &[Vec<Enclosure>],
        FallingHeld { lambda, past }: &FallingHeld,
        of: &LoopNumbers<Enclosure>,
    ) -> bool {
        let n = rows.len() - 1;
        let exact = |value: &Rational| Enclosure::from_rational(value, PRECISION);
        let zero = || Enclosure::zero(PRECISION);
        let times =
            |i: usize, column: usize| (0..n).fold(zero(), |sum, k| sum + exact(&self.matrix[i][k]) * &rows[k][column]);
        let decay: Vec<(usize, usize, Enclosure)> = (0..n)
            .flat_map(|i| (i..n).map(move |j| (i, j)))
            .map(|(i, j)| (i, j, (times(i, j) + times(j, i)).negate()))
            .collect();
        let moved: Vec<Enclosure> = (0..n).map(|i| times(i, n)).collect();
        let (r, d) = (rows[n][..n].to_vec(), rows[n][n].clone());
        let numbers = FormNumbers {
            of,
            weight: exact(&self.weight),
            k_p: exact(&self.k_p),
            lambda: exact(lambda),
            less: Less { e_k: zero(), e: zero(), y: zero() },
            gamma: None,
            past: past.as_ref().map(exact),
        };
        let order = n + 4 + usize::from(past.is_some());
        of.corners(past.is_some()).all(|corner| {
            let parts = Parts { decay: decay.clone(), moved: moved.clone(), r: r.clone(), d: d.clone() };
            let mut entries = vec![zero(); order * order];
            for (i, j, entry) in form(&AtPoint::default(), numbers.clone(), &corner, parts) {
                entries[j * order + i] = entry;
            }
            let matrix = ScaledMatrix::from_enclosures(order, |i, j| entries[i * order + j].clone());
            matrix.is_some_and(|matrix| matrix.is_positive_definite().is_true())
        })
    }

    /// How far solutions from the starts may be from the periodic one of these sizes.
    ///
    /// Hypothesis: V falls, at this gain. Guarantee: with `V_0 = p_up dX^2 + w dE^2 + (b mu k_p/2) dZ^2` they are
    /// `sqrt(V_0/w)` and `sqrt(V_0 (sigma^2/w + 2 mu Nbar^2/(b k_p)))`, at the worse end of b, in which the square is convex; with a delay V_0 has
    /// `g_m h (Y_0 + Y)^2` besides, and the second bracket `h (sigma + K Nb2)^2/g_m`.
    #[must_use]
    pub fn peak(&self, own: &Loop, start: &Start, sizes: &Sizes<Enclosure>) -> Peak {
        let exact = |value: &Rational| Enclosure::from_rational(value, PRECISION);
        let (weight, k_p) = (exact(&self.weight), exact(&self.k_p));
        let [x, e, z] = start.distances(own, [&sizes.states, &sizes.error, &sizes.zeta]);
        let (mut plain, mut of_past) = (exact(&self.p_up) * x.sqr() + &weight * e.sqr(), Enclosure::zero(PRECISION));
        let past = self.held.as_ref().and_then(|held| held.past.as_ref());
        if let Some((past, AtSamples { step, .. })) = past.zip(own.held.as_ref()) {
            plain = plain + exact(past) * step * (&start.y0 + &sizes.mean).sqr();
            of_past = step * (&own.sigma + &own.mu * &own.n_bar_squared).sqr() / exact(past);
        }
        let level = |b: &Enclosure| &plain + b * &own.mu * &k_p / 2 * z.sqr();
        let of_zeta = |b: &Enclosure| &own.mu * &own.n_bar_squared * 2 / (b * &k_p);
        let of_control = |b: &Enclosure| level(b) * (own.sigma.sqr() / &weight + of_zeta(b) + &of_past);
        let [low, high] = &own.gain;
        Peak { error: (level(high) / &weight).sqrt(), control: of_control(low).max(&of_control(high)).sqrt() }
    }
}

static ZERO: std::sync::LazyLock<Rational> = std::sync::LazyLock::new(Rational::new);

impl Loop {
    /// The numbers of F at samples.
    fn numbers(&self, held: &AtSamples) -> LoopNumbers<Enclosure> {
        let moves = self.gain.each_ref().map(|b| Enclosure::one(PRECISION) - b);
        let law = [self.mu.clone(), self.n_bar_squared.clone()];
        LoopNumbers::new(self.sigma.clone(), held.step.clone(), law, &Enclosure::pi(PRECISION), Some(moves))
    }

    /// `[[L^-1 A L, L^-1 b], [c L, d]]`, by rows.
    #[must_use]
    pub fn in_coordinates(&self, rows: &[Vec<Enclosure>], coordinates: &[Vec<Rational>]) -> Vec<Vec<Enclosure>> {
        let n = coordinates.len();
        let exact = |value: &Rational| Enclosure::from_rational(value, PRECISION);
        let sum =
            |terms: &mut dyn Iterator<Item = Enclosure>| terms.fold(Enclosure::zero(PRECISION), |sum, term| sum + term);
        let right: Vec<Vec<Enclosure>> = rows
            .iter()
            .map(|row| {
                let entry = |j: usize| sum(&mut (0..n).map(|k| &row[k] * exact(&coordinates[k][j])));
                (0..n).map(entry).chain([row[n].clone()]).collect()
            })
            .collect();
        let states = self.inverse.iter().map(|inverse| {
            (0..=n).map(|j| sum(&mut (0..n).map(|k| exact(&inverse[k]) * &right[k][j]))).collect::<Vec<Enclosure>>()
        });
        states.chain([right[n].clone()]).collect()
    }
}

/// Both halves across the side that is longest beside its middle; `None` where none has a length.
fn widest_halved(ends: &[[Rational; 2]]) -> Option<[Vec<[Rational; 2]>; 2]> {
    let share = |[low, high]: &[Rational; 2]| {
        let sum = Rational::from(low.abs_ref()) + Rational::from(high.abs_ref());
        if sum == 0 { sum } else { Rational::from(high - low) / sum }
    };
    let side = (0..ends.len()).rev().max_by_key(|&side| share(&ends[side])).filter(|&side| share(&ends[side]) > 0)?;
    let middle: Rational = Rational::from(&ends[side][0] + &ends[side][1]) / 2;
    let [mut below, mut above] = [ends.to_vec(), ends.to_vec()];
    below[side][1] = middle.clone();
    above[side][0] = middle;
    Some([below, above])
}
