//! Entries of a table of bounds.

use rug::Rational;

/// What is bounded: the rows of the table of the derivation, 11.3.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Kind {
    /// `|L^-1 f_x L| <= value`.
    FX,
    /// `|L^-1 f_e| <= value`.
    FE,
    /// `|q_x L| <= value`.
    QX,
    /// `|q_e| <= value`.
    QE,
    /// `q_e <= value`.
    QEMax,
    /// `|(q_tx + q_xx x_0') L| <= value`.
    QTX,
    /// `|q_te + q_xe x_0'| <= value`.
    QTE,
    /// `P' + P J + J^T P <= -2 value P`, `J = L^-1 f_x L`.
    Rate,
    /// The same with the P of existence.
    RateExistence,
    /// `|q| <= value`.
    Q,
    /// `|q_t + q_x x_0'| <= value`.
    QT,
    /// `|L^-1 f_xx (L ., L .)| <= value`: the norm of the matrix with the second index pair in one, which is not below that
    /// of the bilinear map.
    FXX,
    /// `|L^-1 f_ex L| <= value`.
    FEX,
}

impl Kind {
    /// Those that a certificate may list, in the order of the table.
    pub const TABLE: [Kind; 9] =
        [Kind::FX, Kind::FE, Kind::QX, Kind::QE, Kind::QEMax, Kind::QTX, Kind::QTE, Kind::Rate, Kind::RateExistence];

    /// All of them: those of the table first, then what only a bounding specification has.
    pub const ALL: [Kind; 13] = {
        let mut all = [Kind::Q; 13];
        let mut index = 0;
        while index < Kind::TABLE.len() {
            all[index] = Kind::TABLE[index];
            index += 1;
        }
        [all[index], all[index + 1], all[index + 2], all[index + 3]] = [Kind::Q, Kind::QT, Kind::FXX, Kind::FEX];
        // The compiler refuses a list in which a kind is not at its own index.
        let mut index = 0;
        while index < all.len() {
            assert!(all[index] as usize == index);
            index += 1;
        }
        all
    };

    /// Its index in [`Kind::ALL`], and in [`Kind::TABLE`] where it is of the table.
    #[must_use]
    pub const fn index(self) -> usize {
        self as usize
    }

    /// Its value among those of [`Kind::TABLE`]; not a number where it is not of the table.
    #[must_use]
    pub(super) fn of(self, table: &[f64; Kind::TABLE.len()]) -> f64 {
        table.get(self.index()).copied().unwrap_or(f64::NAN)
    }

    /// The name in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Kind::FX => "f_x",
            Kind::FE => "f_e",
            Kind::QX => "q_x",
            Kind::QE => "q_e",
            Kind::QEMax => "q_e_max",
            Kind::QTX => "q_tx",
            Kind::QTE => "q_te",
            Kind::Rate => "rate",
            Kind::RateExistence => "rate_existence",
            Kind::Q => "q",
            Kind::QT => "q_t",
            Kind::FXX => "f_xx",
            Kind::FEX => "f_ex",
        }
    }

    /// Whether the bound is a rate, which is proved from below.
    #[must_use]
    pub fn is_rate(self) -> bool {
        matches!(self, Kind::Rate | Kind::RateExistence)
    }

    /// Whether the bound is that of a norm, and so not negative.
    #[must_use]
    pub fn is_norm(self) -> bool {
        !self.is_rate() && self != Kind::QEMax
    }
}

/// One number of the table: the bound holds with this value on `G(x, e)`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Which bound.
    pub bound: Kind,
    /// X, not negative.
    pub x: Rational,
    /// E, not negative.
    pub e: Rational,
    /// The value.
    pub value: Rational,
}
