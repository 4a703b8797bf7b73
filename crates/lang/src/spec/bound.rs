//! The list of bounding functions.

/// A bounding function of `(X, E)`: an upper bound on `|x| <= X`, `|e| <= E`, for every t (P:LP1, P:LP2; derivation,
/// 10.1).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Bound {
    /// b_f, of `|f|`.
    F,
    /// b_fe, of `|df/de|`.
    Fe,
    /// b_fxx, of `|d2f/dxdx|` as a bilinear map.
    Fxx,
    /// b_fex, of `|d2f/dedx|`.
    Fex,
    /// b_q, of `|q|`.
    Q,
    /// b_qe, of `|dq/de|`.
    Qe,
    /// b_qx, of `|dq/dx|`.
    Qx,
    /// b_qt, of `|dq/dt|`.
    Qt,
    /// b_q_rms, of the root mean square over a period of `sup |q|`; optional, `Q` serves where it is absent or smaller.
    QRms,
    /// b_qt_rms, of the root mean square over a period of `sup |dq/dt|`; optional, `Qt` serves where it is absent or
    /// smaller.
    QtRms,
    /// m, of `dq/de` from above; optional, may be negative, `Qe` serves where it is absent or smaller.
    QeMax,
    /// b_fx, of `|df/dx|`; optional.
    Fx,
    /// b_qtx, of `|d2q/dtdx|`; optional.
    Qtx,
    /// b_qte, of `|d2q/dtde|`; optional.
    Qte,
    /// a, a contraction rate from below: `P' + P J + J'P <= -2 a P` for `J = df/dx` and the P of the triple; optional,
    /// nonincreasing, may be negative.
    Rate,
    /// A contraction rate from below as [`Bound::Rate`], for the P of existence where a plant has two (derivation, 11.3); no specification gives it.
    RateExistence,
}

/// What a bounding function bounds, and what holds without it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    /// A norm; every specification has it.
    Required,
    /// What another bound bounds too, less sharply; that one serves where this is absent.
    Sharper(Bound),
    /// A derivative from above, whose norm the other one bounds.
    OneSided(Bound),
    /// A norm; other formulas serve where it is absent.
    Optional,
    /// A rate from below.
    Rate,
    /// A rate from below that only a plant's formulas give.
    ProvedRate,
}

/// Everything that is the same wherever a bounding function is spoken of, in the order of [`Bound`]: its field in a
/// specification, its role, and what it bounds in the words of a report.
pub(super) const TABLE: [(Bound, &str, Role, &str); 16] = [
    (Bound::F, "f", Role::Required, "|f|"),
    (Bound::Fe, "f_e", Role::Required, "|df/de|"),
    (Bound::Fxx, "f_xx", Role::Required, "|d2f/dxdx|"),
    (Bound::Fex, "f_ex", Role::Required, "|d2f/dedx|"),
    (Bound::Q, "q", Role::Required, "|q|"),
    (Bound::Qe, "q_e", Role::Required, "|dq/de|"),
    (Bound::Qx, "q_x", Role::Required, "|dq/dx|"),
    (Bound::Qt, "q_t", Role::Required, "|dq/dt|"),
    (Bound::QRms, "q_rms", Role::Sharper(Bound::Q), "rms q"),
    (Bound::QtRms, "q_t_rms", Role::Sharper(Bound::Qt), "rms dq/dt"),
    (Bound::QeMax, "q_e_max", Role::OneSided(Bound::Qe), "dq/de from above"),
    (Bound::Fx, "f_x", Role::Optional, "|df/dx|"),
    (Bound::Qtx, "q_tx", Role::Optional, "|d2q/dtdx|"),
    (Bound::Qte, "q_te", Role::Optional, "|d2q/dtde|"),
    (Bound::Rate, "rate", Role::Rate, "contraction of x, from below"),
    (Bound::RateExistence, "rate_existence", Role::ProvedRate, "the same in the P of existence"),
];

impl Bound {
    /// All of them.
    pub const ALL: [Bound; TABLE.len()] = {
        let mut all = [Bound::F; TABLE.len()];
        let mut index = 0;
        while index < TABLE.len() {
            all[index] = TABLE[index].0;
            index += 1;
        }
        all
    };

    pub(super) fn role(self) -> Role {
        TABLE[self as usize].2
    }

    /// The name of its field in a specification.
    #[must_use]
    pub fn field(self) -> &'static str {
        TABLE[self as usize].1
    }

    /// What it bounds, in the words of a report.
    #[must_use]
    pub fn of_what(self) -> &'static str {
        TABLE[self as usize].3
    }

    /// Whether it is of f, or of a derivative by x: without a state there is nothing that it bounds.
    #[must_use]
    pub fn is_of_state(self) -> bool {
        match self {
            Bound::F | Bound::Fe | Bound::Fxx | Bound::Fex | Bound::Fx | Bound::Qx | Bound::Qtx => true,
            Bound::Rate | Bound::RateExistence => true,
            Bound::Q | Bound::Qe | Bound::Qt | Bound::QRms | Bound::QtRms | Bound::QeMax | Bound::Qte => false,
        }
    }

    /// The field of a specification in which its own field is.
    #[must_use]
    pub fn section(self) -> &'static str {
        if matches!(self.role(), Role::Rate | Role::ProvedRate) { "lyapunov" } else { "bounds" }
    }

    /// Whether every specification has it.
    #[must_use]
    pub fn is_required(self) -> bool {
        self.role() == Role::Required
    }

    /// Whether it may be negative: it does not bound a norm.
    #[must_use]
    pub fn is_signed(self) -> bool {
        matches!(self.role(), Role::OneSided(_) | Role::Rate | Role::ProvedRate)
    }

    /// Whether it must be nonincreasing; the others must be nondecreasing.
    #[must_use]
    pub fn is_rate(self) -> bool {
        matches!(self.role(), Role::Rate | Role::ProvedRate)
    }

    /// What serves where it is left out, and bounds what it bounds where it is not.
    #[must_use]
    pub fn replacement(self) -> Option<Bound> {
        match self.role() {
            Role::Sharper(other) | Role::OneSided(other) => Some(other),
            Role::Required | Role::Optional | Role::Rate | Role::ProvedRate => None,
        }
    }
}
