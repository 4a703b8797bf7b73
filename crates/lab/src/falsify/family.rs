//! A family of plants with known bounds.

use super::shape::{Factor, Number, Shape};
use sigmastar_theory::data::Bound;

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
/// q = A(t) - damping e + c d(t) r(e) + (beta + delta r(e)) b_q(t) phi_q(m'x),
///
/// with vectors v, w, m of norm at most 1, phi, phi_q and r as in [`Shape`], psi(s) = s^2/2 or l^2 (1 - cos(s/l)),
/// factors a, b, d, b_q as in [`Factor`], and A a sum of harmonics of different orders. F is a matrix of texts in t.
#[derive(Clone, Debug, Default, PartialEq)]
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
    /// The damping, >= 0.
    pub damping: Number,
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

/// An upper bound of one of a plant's functions as two expressions in X and E, whose sum it is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FamilyBound {
    /// What a smaller size of the other coefficients leaves as it is: the part of F, or that of the damping.
    pub fixed: Option<String>,
    /// The rest, nonnegative.
    pub moving: String,
}

impl FamilyBound {
    /// The bound itself.
    #[must_use]
    pub fn text(&self) -> String {
        let Self { fixed, moving } = self;
        fixed.as_ref().map_or_else(|| moving.clone(), |fixed| format!("{fixed} + {moving}"))
    }
}

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

    /// An upper bound of what a bounding function bounds, by expressions in X and E:
    ///
    /// |f| <= |F| X + E (|g| + g_1 phi) + kappa X^2/2, |df/de| <= |g| + g_1 phi, |d2f/dxdx| <= kappa + E g_1 |phi''|,
    /// |d2f/dedx| <= g_1, |df/dx| <= |F| + E g_1 + kappa |psi'|,
    /// |q| <= sum|a_k| + damping E + c r + (beta + delta r) phi_q, |dq/de| <= damping + c + delta phi_q,
    /// dq/de <= -damping + c + delta phi_q, |dq/dx| <= beta + delta r,
    /// |dq/dt| <= sum k Om |a_k| + (speed of d) c r + (speed of b_q)(beta + delta r) phi_q,
    /// |d2q/dtdx| <= (speed of b_q)(beta + delta r), |d2q/dtde| <= (speed of d) c + (speed of b_q) delta phi_q, and in the mean
    /// the same as for q and dq/dt with rms of A and A' in place of the sums; phi, phi_q, r and psi' stand for their bounds
    /// on |x| <= X, |e| <= E. `None` for the contraction rate, which no expression bounds.
    #[must_use]
    pub fn bound(&self, which: Bound) -> Option<FamilyBound> {
        let [v, x] = self.shapes.map(|shape| shape.bound("X"));
        let r = self.saturation.bound("E");
        let Family { jacobian_norm, g_1, kappa, damping, beta, c, delta, .. } = self;
        let g = format!("({} + {g_1}*{v})", self.g.1);
        let input = format!("({beta} + {delta}*{r})");
        let state_part = format!("{input}*{x} + {c}*{r}");
        let [_, _, by_state, by_error] = self.factors.map(|factor| factor.speed(&self.period));
        let drift = format!("{by_state}*{input}*{x} + {by_error}*{c}*{r}");
        let damped = |text: String| Some(text).filter(|_| damping.value() != 0.0);
        let (fixed, moving) = match which {
            Bound::F => (None, format!("({jacobian_norm})*X + E*{g} + {kappa}*X^2/2")),
            Bound::Fe => (None, g),
            Bound::Fxx => (None, format!("{kappa} + E*{g_1}*{}", self.shapes[0].bend())),
            Bound::Fex => (None, g_1.to_string()),
            Bound::Fx => {
                let slope = self.wave.map_or_else(|| "X".to_owned(), |wave| format!("min(X, {wave})"));
                (Some(format!("({jacobian_norm})")), format!("E*{g_1} + {kappa}*{slope}"))
            }
            Bound::Q => (damped(format!("{damping}*E")), format!("{} + {state_part}", self.forcing_sup(false))),
            Bound::Qe => (damped(damping.to_string()), format!("{c} + {delta}*{x}")),
            Bound::QeMax => (damped(format!("-{damping}")), format!("{c} + {delta}*{x}")),
            Bound::Qx => (None, input),
            Bound::Qt => (None, format!("{} + {drift}", self.forcing_sup(true))),
            Bound::QRms => (damped(format!("{damping}*E")), format!("{} + {state_part}", self.forcing_rms(false))),
            Bound::QtRms => (None, format!("{} + {drift}", self.forcing_rms(true))),
            Bound::Qtx => (None, format!("{by_state}*{input}")),
            Bound::Qte => (None, format!("{by_error}*{c} + {by_state}*{delta}*{x}")),
            Bound::Rate | Bound::RateExistence => return None,
        };
        Some(FamilyBound { fixed, moving })
    }

    /// The amplitude of a harmonic of A, or of A'.
    fn size(&self, Harmonic { amplitude, factor }: &Harmonic, derivative: bool) -> String {
        match derivative {
            false => format!("{amplitude}"),
            true => format!("{amplitude}*{}", factor.speed(&self.period)),
        }
    }

    /// A bound of sup|A|, or of sup|A'|.
    fn forcing_sup(&self, derivative: bool) -> String {
        sum(self.harmonics.iter().map(|harmonic| self.size(harmonic, derivative)))
    }

    /// rms(A), or rms(A').
    fn forcing_rms(&self, derivative: bool) -> String {
        let square = |harmonic: &Harmonic| {
            let mean = if harmonic.factor.order == 0 { "" } else { "/2" };
            format!("({})^2{mean}", self.size(harmonic, derivative))
        };
        format!("sqrt({})", sum(self.harmonics.iter().map(square)))
    }

    /// f and q as texts in t, x1, x2, ... and e.
    #[must_use]
    pub fn texts(&self) -> (Vec<String>, String) {
        let [v, w, m] = &self.directions;
        let along = |vector: &[Number]| {
            format!("({})", sum(vector.iter().enumerate().map(|(i, part)| format!("{part}*x{}", i + 1))))
        };
        let [a, b, by_state, by_error] = self.factors.map(|factor| factor.text(&self.period));
        let Family { g_1, kappa, damping, beta, c, delta, .. } = self;
        let error = self.saturation.of("e");
        let mut q: Vec<String> = self
            .harmonics
            .iter()
            .filter(|harmonic| harmonic.amplitude.value() != 0.0)
            .map(|Harmonic { amplitude, factor }| format!("{amplitude}*{}", factor.text(&self.period)))
            .collect();
        if damping.value() != 0.0 {
            q.push(format!("(-{damping})*e"));
        }
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
