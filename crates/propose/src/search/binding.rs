//! What sets sigma*, in words that a user can act on. Floating point: an explanation, not a claim.

/// The mechanism that asks for most of sigma*.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Binding {
    /// S2: below sigma* no periodic solution is proved.
    Existence,
    /// The term D^2/(4 ht) of C5 where ht is as large as dq/de allows: D is 2 or so.
    Slope {
        /// Whether damping is told apart from the rest by `q_e_max`.
        one_sided: bool,
    },
    /// The term D^2/(4 ht) of C5 where ht is small: what the state of the internal model has to lose at the start keeps h small.
    InternalModel,
    /// The other term of C5: the loop through x, by df/de and dq/dx.
    Coupling,
    /// The matrix inequality that stands in the place of C5.
    MatrixInequality,
    /// The joint metrics, of the periodic solution or of stability: at a smaller gain none were found.
    JointMetrics,
}

impl Binding {
    /// What it is.
    #[must_use]
    pub fn describe(self) -> &'static str {
        match self {
            Binding::Existence => "S2: below it no periodic solution is proved to exist",
            Binding::Slope { .. } => "C5: dq/de in the error box",
            Binding::InternalModel => "C5: how far the state of the internal model starts from the periodic solution",
            Binding::Coupling => "C5: the loop through x in the error box (df/de and dq/dx against the decay rate)",
            Binding::MatrixInequality => "(M): the matrix inequality of stability in the error box",
            Binding::JointMetrics => "stability (Jm); no Lyapunov function was found below this gain",
        }
    }

    /// What lowers it: data of a specification, or of a plant what its file states; another start, where it is not `aligned` already.
    #[must_use]
    pub fn advice(self, of_plant: bool, aligned: bool) -> String {
        let told = if of_plant { self.of_plant() } else { self.of_specification() };
        let rest =
            ["An aligned start or a ", "An aligned start, a "].into_iter().find_map(|start| told.strip_prefix(start));
        rest.filter(|_| aligned).map_or_else(|| told.to_owned(), |rest| format!("A {rest}"))
    }

    fn of_plant(self) -> &'static str {
        match self {
            Binding::Existence => {
                "It hardly depends on the initial set: less disturbance in q, a q and f that bend less near the orbit, or \
                 another mu and other weights (`sigmastar tune`) lower it."
            }
            Binding::Slope { .. } => {
                "A smaller initial set lowers it if q is steeper further out. A smaller mu hardly lowers it."
            }
            Binding::InternalModel => {
                "An aligned start or a smaller initial set lowers it, and so do a mu and weights that fit the plant (`sigmastar \
                 tune`)."
            }
            Binding::Coupling => {
                "A smaller initial set lowers it, because f and q bend less there. Less coupling between x and e lowers it, too: by a loop \
                 around x or by another output e."
            }
            Binding::MatrixInequality | Binding::JointMetrics => {
                "An aligned start or a smaller initial set lowers it, because f and q bend less there. A mu and weights that \
                 fit the plant (`sigmastar tune`) lower it, too."
            }
        }
    }

    fn of_specification(self) -> &'static str {
        match self {
            Binding::Existence => {
                "Bounds of q in the mean (q_rms, q_t_rms), its harmonics (q_0), or a bound of dq/de from above (q_e_max) \
                 lower it."
            }
            Binding::Slope { one_sided: false } => {
                "A smaller initial set lowers it, or a bound of dq/de from above (q_e_max), which does not count damping as harm. A \
                 smaller mu hardly lowers it."
            }
            Binding::Slope { one_sided: true } => "A smaller initial set or a smaller q_e_max lowers it.",
            Binding::InternalModel => {
                "An aligned start, a smaller initial set, bounds of q in the mean (q_rms, q_t_rms) or its \
                 harmonics (q_0) lower it, and so does a mu that fits the plant."
            }
            Binding::Coupling => {
                "Smaller f_e or q_x, a larger alpha, a rate on the box, or coordinates of x with such bounds lower it."
            }
            // Only a plant's formulas have one.
            Binding::MatrixInequality | Binding::JointMetrics => self.of_plant(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Binding;

    /// An aligned start is named where the start is another one, and never where it is aligned.
    #[test]
    fn an_aligned_start_is_not_advised_to_itself() {
        for binding in [Binding::InternalModel, Binding::MatrixInequality, Binding::JointMetrics] {
            for of_plant in [true, false] {
                let [other, aligned] = [false, true].map(|aligned| binding.advice(of_plant, aligned));
                assert!(other.starts_with("An aligned start"), "{other}");
                assert!(aligned.starts_with("A smaller initial set") && !aligned.contains("ligned start"), "{aligned}");
            }
        }
        assert_eq!(Binding::Existence.advice(true, false), Binding::Existence.advice(true, true));
    }
}
