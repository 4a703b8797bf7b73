//! `Phi - mu M M'N` for a given n_o, enclosed.
//!
//! In the coordinates `N^(1/2) zeta`, in which |zeta|_N is the Euclidean norm, the matrix is `A = Phi - mu b b'` with
//! `b = N^(1/2) M`: Phi commutes with N. Its order is 2 n_o + 1.

use sigmastar_exact::enclosure::Enclosure;
use sigmastar_theory::data::Data;

/// The matrix A of one n_o, enclosed.
pub struct OscillatorMatrix {
    order: usize,
    /// w.
    pub frequency: Enclosure,
    /// mu.
    pub mu: Enclosure,
    /// b, one number for each state; 0 for the second state of an oscillator.
    pub b: Vec<Enclosure>,
}

impl OscillatorMatrix {
    /// The matrix of a specification for n_o oscillators.
    #[must_use]
    pub fn new(data: &Data<'_>, n_o: u32) -> OscillatorMatrix {
        let weights = &data.spec.internal_model.weights;
        let root = |l: u64| weights.weight(l, data.precision).sqrt();
        let mut b = vec![root(0)];
        b.extend((1..=u64::from(n_o)).flat_map(|l| [root(l), data.zero()]));
        OscillatorMatrix { order: b.len(), frequency: data.base_frequency.clone(), mu: data.mu.clone(), b }
    }

    /// `2 n_o + 1`.
    #[must_use]
    pub fn order(&self) -> usize {
        self.order
    }

    /// `(P Phi)_ij` for column j: where the one entry of that column of Phi stands, and the entry.
    #[must_use]
    pub fn phi(&self, column: usize) -> Option<(usize, Enclosure)> {
        let oscillator = column.div_ceil(2) as i64;
        let entry = &self.frequency * oscillator;
        // Phi = l w [[0, 1], [-1, 0]] on the states 2l - 1 and 2l.
        match column {
            0 => None,
            odd if odd % 2 == 1 => Some((column + 1, entry.negate())),
            _ => Some((column - 1, entry)),
        }
    }
}
