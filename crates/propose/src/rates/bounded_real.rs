//! Pi for the loop in which the first derivatives lie in a ball (derivation, 13.6, (K) and (D)), proposed by a Riccati equation in floating
//! point.
//!
//! With `D = C + D'`, `D''H D' <= S`, K is definite for some multipliers with this ball if and only if
//! `Pi (A + B C E + rate) + (.)' + E'S E + Pi B H^-1 B'Pi < 0`, E taking a = (x, e) of eta: a bounded real inequality, which has a Pi > 0 if and only
//! if the loop with D = C decays faster than the rate and its gain from D' to a is small on the line Re s = -rate. With an input gain there
//! is one more signal at B_q, `(b_u - b_c) (-sigma e + mu b'zs)`, with a multiplier of its own. Of balls of the columns of x and of e apart S is block
//! diagonal, and H^-1 the sum of theirs.

use super::diagonal;
use super::least_factor::least_factor;
use super::proposal::{Numbers, Proposal};
use super::riccati::Equation;
use super::slopes_program::{Ball, closed, decay, matrices, moved};
use faer::linalg::solvers::Llt;
use faer::{Mat, Side};
use rug::Rational;
use sigmastar_decide::rates::inequality::RateWitness;
use sigmastar_decide::rates::matrix_loop::{KnownSlopes, MatrixLoop, Multipliers};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, round_f64};

/// Steps of the bisection in the rate, and the shares of the fastest one between which it goes.
const BISECTIONS: u32 = 12;
const SHARES: [f64; 2] = [1e-4, 0.999];

/// The multipliers of an input gain that are tried, in units of its signal.
const OF_GAIN: [f64; 7] = [0.01, 0.05, 0.2, 1.0, 5.0, 20.0, 100.0];

/// By what share of the rate a Pi may miss its own.
const NEARLY: f64 = 1e-3;

/// By what share the rate of a program is above the one that is claimed: its matrices are semidefinite, and for a smaller rate definite.
const ABOVE: f64 = 2e-2;

/// The equation of one loop and one ball.
pub struct BoundedReal {
    of: MatrixLoop<f64>,
    /// A + B C E.
    matrix: Mat<f64>,
    /// E'S E.
    output: Mat<f64>,
    /// B H^-1 B' as inputs: each eigenvalue of H^-1, and B times its eigenvector.
    inputs: Vec<(f64, Vec<f64>)>,
    /// The signal of the input gain, and B_q, where it is not known.
    moved: Option<[Vec<f64>; 2]>,
    /// Each part of D.
    slopes: Vec<KnownSlopes<f64>>,
    /// The rate of decay with D = C.
    fastest: f64,
}

impl BoundedReal {
    /// The equation; `slopes` are of the ball, rounded. `None` where the loop with D = C does not decay, or a number is not finite.
    #[must_use]
    pub fn new(of: MatrixLoop<f64>, slopes: Vec<KnownSlopes<f64>>) -> Option<BoundedReal> {
        let (order, signals) = (of.order(), of.states + 1);
        let mut centre = Mat::<f64>::zeros(signals, signals);
        let (mut output, mut inverse) = (Mat::<f64>::zeros(order, order), Mat::<f64>::zeros(signals, signals));
        for part in &slopes {
            let Ball { inverse: own, middle, size } = Ball::new(part)?;
            let (start, count) = (part.columns.start, part.columns.len());
            centre.as_mut().subcols_mut(start, count).copy_from(-middle);
            output.as_mut().submatrix_mut(start, start, count, count).copy_from(size);
            inverse += own;
        }
        let rows: Vec<Vec<f64>> = (0..signals).map(|i| (0..signals).map(|j| centre[(i, j)]).collect()).collect();
        let (matrix, fastest) = (closed(&of, &rows), decay(&of, &rows)?);
        let [_, b] = matrices(&of);
        let eigen = inverse.self_adjoint_eigen(Side::Lower).ok()?;
        let turned = &b * eigen.U();
        let of_value = |(k, value): (usize, &f64)| (*value, (0..order).map(|i| turned[(i, k)]).collect());
        let inputs = eigen.S().column_vector().iter().enumerate().map(of_value).collect();
        let moved = moved(&of);
        (fastest > 0.0 && fastest.is_finite()).then_some(BoundedReal {
            of,
            matrix,
            output,
            inputs,
            moved,
            slopes,
            fastest,
        })
    }

    /// The rate of decay with D = C.
    #[must_use]
    pub fn fastest(&self) -> f64 {
        self.fastest
    }

    /// The largest rate that some Pi has, with the multiplier of the input gain; `None` where there is none.
    #[must_use]
    pub fn largest_rate(&self) -> Option<[f64; 2]> {
        let multipliers: &[f64] = if self.moved.is_some() { &OF_GAIN } else { &[1.0] };
        let largest = |of_gain: f64| {
            let holds = |rate: f64| self.holds(rate, of_gain);
            let [mut low, mut high] = SHARES.map(|share| share * self.fastest);
            if holds(high) {
                return Some([high, of_gain]);
            }
            if !holds(low) {
                return None;
            }
            for _ in 0..BISECTIONS {
                let middle = (low * high).sqrt();
                if holds(middle) { low = middle } else { high = middle }
            }
            Some([low, of_gain])
        };
        multipliers.iter().filter_map(|of_gain| largest(*of_gain)).max_by(|a, b| a[0].total_cmp(&b[0]))
    }

    fn holds(&self, rate: f64, of_gain: f64) -> bool {
        self.pi([rate, of_gain]).is_some_and(|pi| self.proves(&pi, rate * (1.0 - NEARLY)))
    }

    /// Numbers for a share of the largest rate, with its multiplier of the input gain; Pi is that of a rate halfway between.
    #[must_use]
    pub fn propose(&self, [largest, of_gain]: [f64; 2], share: f64) -> Option<Proposal<OfStates>> {
        let pi = self.pi([largest * (1.0 + share) / 2.0, of_gain])?;
        let rate = round_f64(largest * share, 6, Direction::Down)?;
        Some(Proposal { pi, numbers: OfStates { rate, states: self.of.states } })
    }

    /// The same of which the factor of the bound is about the least for starts within these distances; `None` where the loop has too many states, or
    /// nothing is found.
    #[must_use]
    pub fn propose_factor(
        &self,
        [largest, of_gain]: [f64; 2],
        share: f64,
        distances: [&Enclosure; 3],
    ) -> Option<Proposal<OfStates>> {
        let known = self.pi([largest * (1.0 + share) / 2.0, of_gain])?;
        let (_, e_low) = diagonal::bounds_of_states(&known, self.of.states, distances)?;
        let claimed = largest * share;
        let distances = distances.map(Enclosure::upper_f64);
        let rate = claimed * (1.0 + ABOVE);
        let pi = least_factor((&self.of, &self.slopes), rate, (&known, e_low.to_f64()), distances)?;
        let rate = round_f64(claimed, 6, Direction::Down)?;
        Some(Proposal { pi, numbers: OfStates { rate, states: self.of.states } })
    }

    /// Pi of the equation at a rate, for a multiplier of the input gain.
    fn pi(&self, [rate, of_gain]: [f64; 2]) -> Option<Mat<f64>> {
        let n = self.of.order();
        let a = Mat::from_fn(n, n, |i, j| self.matrix[(i, j)] + if i == j { rate } else { 0.0 });
        let (mut output, mut inputs) = (self.output.clone(), self.inputs.clone());
        if let Some([signal, at]) = &self.moved {
            // In the size that H gives to the last of omega.
            let of_q = self.slopes.last().and_then(|part| part.h.last()?.last());
            let weight = of_gain * of_q.copied().unwrap_or(1.0);
            output += Mat::from_fn(n, n, |i, j| weight * signal[i] * signal[j]);
            inputs.push((weight.recip(), at.clone()));
        }
        let equation = Equation { a: &a, inputs: &inputs, output: &output };
        let of_inputs =
            inputs.iter().map(|(beta, input)| beta * input.iter().map(|entry| entry * entry).sum::<f64>()).sum();
        let pi = equation.solution([trace(&output), of_inputs])?;
        Llt::new(pi.as_ref(), Side::Lower).is_ok().then_some(pi)
    }

    /// Whether K is definite in doubles.
    fn proves(&self, pi: &Mat<f64>, rate: f64) -> bool {
        let n = pi.nrows();
        let rows: Vec<Vec<f64>> = (0..n).map(|i| (0..n).map(|j| pi[(i, j)]).collect()).collect();
        self.of.ends().iter().all(|gain| {
            let form = self.of.form(gain, &Multipliers { rate: &rate, pi: &rows, slopes: &self.slopes });
            let order = form.len();
            // In units of the diagonal.
            let unit = |i: usize| form[i][i].max(f64::MIN_POSITIVE).sqrt();
            let matrix = Mat::from_fn(order, order, |i, j| form[i.max(j)][i.min(j)] / (unit(i) * unit(j)));
            (0..order).all(|i| form[i][i] > 0.0) && Llt::new(matrix.as_ref(), Side::Lower).is_ok()
        })
    }
}

fn trace(of: &Mat<f64>) -> f64 {
    (0..of.nrows()).map(|i| of[(i, i)]).sum()
}

/// The numbers of a proof by all derivatives beside Pi, which is one of (x, e, zs): there are no multipliers.
#[derive(Clone, Debug)]
pub struct OfStates {
    /// The rate, rounded down.
    pub rate: Rational,
    states: usize,
}

impl Numbers for OfStates {
    type Witness = RateWitness;

    fn witness(&self, pi: Vec<Vec<Rational>>, _: u32) -> Option<RateWitness> {
        let none = Rational::new;
        Some(RateWitness { rate: self.rate.clone(), w: none(), pi, l: none(), inputs: [None, None] })
    }
}

impl Proposal<OfStates> {
    /// x_up, e_up, z_up and e_low about Pi, rounded to the safe side, about the best for a start within these distances; without states x_up
    /// is 0.
    #[must_use]
    pub fn diagonal_bounds_of_states(&self, distances: [&Enclosure; 3]) -> Option<([Rational; 3], Rational)> {
        diagonal::bounds_of_states(&self.pi, self.numbers.states, distances)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sigmastar_lang::spec::Specification;
    use sigmastar_theory::data::Data;

    /// The root of `(x_up dX^2 + e_up dE^2 + z_up dZ^2)/e_low`.
    fn factor(proposal: &Proposal<OfStates>, distances: [&Enclosure; 3]) -> f64 {
        let (upper, e_low) = proposal.diagonal_bounds_of_states(distances).unwrap();
        let squares = upper.iter().zip(distances).map(|(upper, of)| upper.to_f64() * of.upper_f64() * of.upper_f64());
        (squares.sum::<f64>() / e_low.to_f64()).sqrt()
    }

    /// A state that decays at the rate 2 and is driven by e, and q of x and e in a ball, or q of e alone; with a known input gain, and with an interval.
    #[test]
    fn a_program_has_a_smaller_factor_at_the_same_rate() {
        let text = include_str!("../../../../specs/linear.json");
        let of_interval = r#"{ "input_gain": { "nominal": 1, "low": "9/10", "high": "11/10" }, "#;
        let specs = [text.to_owned(), text.replacen('{', of_interval, 1)]
            .map(|text| Specification::from_json("test", &text).unwrap());
        let distances = [0.5, 2.0, 3.0].map(Enclosure::exactly);
        let sigma = Rational::from(40);
        let known = [(0, 0), (0, 2), (1, 0), (1, 1), (1, 3)].map(|case| (&specs[0], case));
        for (spec, (states, n_o)) in known.into_iter().chain([(&specs[1], (0, 1)), (&specs[1], (1, 1))]) {
            let data = Data::new(spec, 128);
            let oscillators: Vec<u32> = (1..=n_o).collect();
            let of = MatrixLoop::new(&data, states, &sigma, &oscillators).doubles(1.0);
            // (D - C)'(D - C) <= S with C = [[-2, 1], [0.5, 0]], S = I/16, or C = 0.5, S = 1/16.
            let (signals, c) = (states + 1, [[-2.0, 1.0], [0.5, 0.5]]);
            let c: Vec<Vec<f64>> = c[1 - states..].iter().map(|row| row[1 - states..].to_vec()).collect();
            let square = |i: usize, j: usize| c.iter().map(|row| row[i] * row[j]).sum::<f64>();
            let slopes = KnownSlopes {
                columns: 0..signals,
                q: (0..signals)
                    .map(|i| (0..signals).map(|j| f64::from(i == j) / 16.0 - square(i, j)).collect())
                    .collect(),
                g: (0..signals).map(|i| (0..signals).map(|k| -c[k][i]).collect()).collect(),
                h: (0..signals).map(|i| (0..signals).map(|j| f64::from(i == j)).collect()).collect(),
            };
            let equation = BoundedReal::new(of, vec![slopes]).unwrap();
            let largest = equation.largest_rate().unwrap();
            for share in [0.95, 0.5] {
                let distances = distances.each_ref();
                let plain = equation.propose(largest, share).unwrap();
                let least = equation.propose_factor(largest, share, distances).unwrap();
                assert_eq!(plain.numbers.rate, least.numbers.rate);
                let rate = least.numbers.rate.to_f64();
                assert_eq!(
                    [&plain.pi, &least.pi].map(|pi| equation.proves(pi, rate)),
                    [true; 2],
                    "{states} {n_o} {share}"
                );
                let [plain, least] = [plain, least].map(|proposal| factor(&proposal, distances));
                assert!(least < 0.97 * plain && least > 2.0, "{states} {n_o} {share}: {least} {plain}");
            }
        }
        // Of too many oscillators there is none.
        let data = Data::new(&specs[0], 128);
        let many: Vec<u32> = (1..=8).collect();
        let of = MatrixLoop::new(&data, 0, &sigma, &many).doubles(1.0);
        let slopes = KnownSlopes { columns: 0..1, q: vec![vec![0.25]], g: vec![vec![0.0]], h: vec![vec![1.0]] };
        let equation = BoundedReal::new(of, vec![slopes]).unwrap();
        let largest = equation.largest_rate().unwrap();
        assert!(equation.propose(largest, 0.95).is_some());
        assert!(equation.propose_factor(largest, 0.95, distances.each_ref()).is_none());
    }
}
