//! A family of plants with known bounds.

use super::shape::{Factor, Number, Shape};

/// a cos(k Om t + phase), or a for k = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Harmonic {
    /// The amplitude a >= 0.
    pub amplitude: Number,
    /// k and the phase.
    pub factor: Factor,
}

/// A plant with n states:
///
/// f = F(t) x + e a(t) (g + g_1 v phi(v'x)) + kappa b(t) w psi(w'x),
/// q = A(t) + c d(t) r(e) + (beta + delta r(e)) b_q(t) phi_q(m'x),
///
/// with vectors v, w, m of norm at most 1, phi, phi_q and r as in [`Shape`], psi(s) = s^2/2 or l^2 (1 - cos(s/l)),
/// factors a, b, d, b_q as in [`Factor`], and A a sum of harmonics of different orders. F is a matrix of texts in t.
#[derive(Clone, Debug, PartialEq)]
pub struct Family {
    /// T as it is written in the specification.
    pub period: String,
    /// F, row by row; empty without states.
    pub jacobian: Vec<Vec<String>>,
    /// An upper bound of sup_t |F(t)|, as an expression.
    pub jacobian_norm: String,
    /// g and an upper bound of its norm.
    pub g: (Vec<Number>, Number),
    /// g_1 >= 0.
    pub g_1: Number,
    /// kappa >= 0.
    pub kappa: Number,
    /// v, w, m.
    pub directions: [Vec<Number>; 3],
    /// phi and phi_q.
    pub shapes: [Shape; 2],
    /// l of psi; `None` for s^2/2.
    pub wave: Option<Number>,
    /// beta >= 0.
    pub beta: Number,
    /// c >= 0.
    pub c: Number,
    /// delta >= 0.
    pub delta: Number,
    /// r.
    pub saturation: Shape,
    /// a, b, b_q, d.
    pub factors: [Factor; 4],
    /// A.
    pub harmonics: Vec<Harmonic>,
}

/// The bounds in the order of [`Family::bounds`].
pub(super) const CONDITIONS: [&str; 10] = ["f", "f_e", "f_xx", "f_ex", "q", "q_e", "q_x", "q_t", "q_rms", "q_t_rms"];

fn sum(terms: impl Iterator<Item = String>) -> String {
    let terms: Vec<String> = terms.collect();
    if terms.is_empty() { "0".to_owned() } else { terms.join(" + ") }
}

impl Family {
    /// The number of states.
    #[must_use]
    pub fn states(&self) -> usize {
        self.jacobian.len()
    }

    /// Upper bounds of the plant's functions as expressions in X and E, in the order of the fields of a specification:
    ///
    /// |f| <= |F| X + E (|g| + g_1 phi) + kappa X^2/2, |df/de| <= |g| + g_1 phi, |d2f/dxdx| <= kappa + E g_1 |phi''|,
    /// |d2f/dedx| <= g_1, |q| <= sum|a_k| + c r + (beta + delta r) phi_q, |dq/de| <= c + delta phi_q,
    /// |dq/dx| <= beta + delta r, |dq/dt| <= sum k Om |a_k| + (speed of d) c r + (speed of b_q)(beta + delta r) phi_q, and
    /// the last but one and the last of these with rms of A and A' in place of the sums; phi, phi_q and r stand for
    /// their bounds on |x| <= X, |e| <= E.
    #[must_use]
    pub fn bounds(&self) -> [String; 10] {
        let [v, x] = self.shapes.map(|shape| shape.bound("X"));
        let r = self.saturation.bound("E");
        let Family { jacobian_norm, g_1, kappa, beta, c, delta, .. } = self;
        let g = format!("({} + {g_1}*{v})", self.g.1);
        let input = format!("({beta} + {delta}*{r})");
        let state_part = format!("{input}*{x} + {c}*{r}");
        let [_, _, by_state, by_error] = self.factors.map(|factor| factor.speed(&self.period));
        let drift = format!("{by_state}*{input}*{x} + {by_error}*{c}*{r}");
        let size = |Harmonic { amplitude, factor }: &Harmonic, derivative: bool| match derivative {
            false => format!("{amplitude}"),
            true => format!("{amplitude}*{}", factor.speed(&self.period)),
        };
        let sup = |derivative: bool| sum(self.harmonics.iter().map(|harmonic| size(harmonic, derivative)));
        let rms = |derivative: bool| {
            let square = |harmonic: &Harmonic| {
                let mean = if harmonic.factor.order == 0 { "" } else { "/2" };
                format!("({})^2{mean}", size(harmonic, derivative))
            };
            format!("sqrt({})", sum(self.harmonics.iter().map(square)))
        };
        [
            format!("({jacobian_norm})*X + E*{g} + {kappa}*X^2/2"),
            g,
            format!("{kappa} + E*{g_1}*{}", self.shapes[0].bend()),
            g_1.to_string(),
            format!("{} + {state_part}", sup(false)),
            format!("{c} + {delta}*{x}"),
            input,
            format!("{} + {drift}", sup(true)),
            format!("{} + {state_part}", rms(false)),
            format!("{} + {drift}", rms(true)),
        ]
    }

    /// f and q as texts in t, x1, x2, ... and e.
    #[must_use]
    pub fn texts(&self) -> (Vec<String>, String) {
        let [v, w, m] = &self.directions;
        let along = |vector: &[Number]| {
            format!("({})", sum(vector.iter().enumerate().map(|(i, part)| format!("{part}*x{}", i + 1))))
        };
        let [a, b, by_state, by_error] = self.factors.map(|factor| factor.text(&self.period));
        let Family { g_1, kappa, beta, c, delta, .. } = self;
        let error = self.saturation.of("e");
        let mut q: Vec<String> = self
            .harmonics
            .iter()
            .filter(|harmonic| harmonic.amplitude.value() != 0.0)
            .map(|Harmonic { amplitude, factor }| format!("{amplitude}*{}", factor.text(&self.period)))
            .collect();
        q.push(format!("{c}*{by_error}*{error}"));
        if self.states() == 0 {
            return (Vec::new(), q.join(" + "));
        }
        let [phi, phi_q] = [self.shapes[0].of(&along(v)), self.shapes[1].of(&along(m))];
        let psi = match self.wave {
            None => format!("{}^2/2", along(w)),
            Some(wave) => format!("{wave}^2*(1 - cos({}/{wave}))", along(w)),
        };
        q.push(format!("({beta} + {delta}*{error})*{by_state}*{phi_q}"));
        let row = |(i, entries): (usize, &Vec<String>)| {
            let linear = sum(entries.iter().enumerate().map(|(j, entry)| format!("({entry})*x{}", j + 1)));
            let (g, v, w) = (self.g.0[i], v[i], w[i]);
            format!("{linear} + e*{a}*({g} + {g_1}*{v}*{phi}) + {kappa}*{w}*{b}*{psi}")
        };
        (self.jacobian.iter().enumerate().map(row).collect(), q.join(" + "))
    }
}
