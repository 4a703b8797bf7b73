//! `Phi - mu M M'N` for given oscillators, enclosed.
//!
//! In the coordinates `N^(1/2) zeta`, in which |zeta|_N is the Euclidean norm, the matrix is `A = Phi - mu b b'` with
//! `b = N^(1/2) M`: Phi commutes with N. Its order is 2 p + 1
//! with p oscillators beside the integrator, at whatever harmonics: p = n_o where they are the first ones.

use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::spec::Oscillators;
use sigmastar_theory::data::Data;

/// The matrix A of some oscillators, enclosed.
pub struct OscillatorMatrix {
    order: usize,
    /// w.
    pub frequency: Enclosure,
    /// The harmonics, 0 the first.
    pub harmonics: Vec<u32>,
    /// mu.
    pub mu: Enclosure,
    /// b, one number for each state; 0 for the second state of an oscillator.
    pub b: Vec<Enclosure>,
}

impl OscillatorMatrix {
    /// The matrix of a specification for these oscillators.
    #[must_use]
    pub fn new(data: &Data<'_>, oscillators: &Oscillators) -> OscillatorMatrix {
        let weights = &data.spec.internal_model.weights;
        let root = |l: u32| weights.weight(u64::from(l), data.precision).sqrt();
        let mut b = vec![root(0)];
        b.extend(oscillators.beyond_mean().iter().flat_map(|l| [root(*l), data.zero()]));
        OscillatorMatrix {
            order: b.len(),
            frequency: data.base_frequency.clone(),
            harmonics: oscillators.all().collect(),
            mu: data.mu.clone(),
            b,
        }
    }

    /// `2 p + 1`.
    #[must_use]
    pub fn order(&self) -> usize {
        self.order
    }

    /// `(P Phi)_ij` for column j: where the one entry of that column of Phi stands, and the entry.
    #[must_use]
    pub fn phi(&self, column: usize) -> Option<(usize, Enclosure)> {
        let entry = &self.frequency * i64::from(*self.harmonics.get(column.div_ceil(2))?);
        // Phi = l w [[0, 1], [-1, 0]] on the two states of the oscillator at l.
        match column {
            0 => None,
            odd if odd % 2 == 1 => Some((column + 1, entry.negate())),
            _ => Some((column - 1, entry)),
        }
    }
}
