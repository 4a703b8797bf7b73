//! Along which path a difference between two points is split into a part in x and a part in e (derivation, section 13.7).

/// The path from a periodic solution (x_p, e_p) to a point (x, e) of the error box. Where the derivatives along it lie:
///
/// | path | d/dx | d/de |
/// |---|---|---|
/// | x first, then e | (X_b, e_per) | (X_b, E_b) |
/// | e first, then x | (X_b, E_b) | (x_per, E_b) |
/// | straight | (X_b, E_b) | (X_b, E_b) |
///
/// For norms the straight path is no better than the others; certificates without paths have it for q.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Path {
    /// x first.
    StateFirst,
    /// e first.
    ErrorFirst,
    /// Both at once.
    Straight,
}

impl Path {
    /// The paths that a search chooses from.
    pub const CHOICE: [Path; 2] = [Path::StateFirst, Path::ErrorFirst];

    /// Every path.
    pub const ALL: [Path; 3] = [Path::StateFirst, Path::ErrorFirst, Path::Straight];

    /// Its name in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Path::StateFirst => "x-first",
            Path::ErrorFirst => "e-first",
            Path::Straight => "straight",
        }
    }

    /// The arguments where d/de is taken, in words.
    pub(super) fn place_of_de(self) -> &'static str {
        if self == Path::ErrorFirst { "(x_per, E_b)" } else { "(X_b, E_b)" }
    }

    /// The largest |e| where d/dx is taken.
    #[must_use]
    pub fn e_of_dx<'r, R>(self, e_per: &'r R, e_b: &'r R) -> &'r R {
        if self == Path::StateFirst { e_per } else { e_b }
    }

    /// The largest |x| where d/de is taken.
    #[must_use]
    pub fn x_of_de<'r, R>(self, x_per: &'r R, x_b: &'r R) -> &'r R {
        if self == Path::ErrorFirst { x_per } else { x_b }
    }
}

/// The paths of f and of q, independent of each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Paths {
    /// That of f.
    pub f: Path,
    /// That of q.
    pub q: Path,
}

impl Paths {
    /// Those of a certificate that names none.
    pub const UNNAMED: Paths = Paths { f: Path::StateFirst, q: Path::Straight };

    /// The pairs that a search chooses from.
    pub fn choice() -> impl Iterator<Item = Paths> {
        Path::CHOICE.into_iter().flat_map(|f| Path::CHOICE.into_iter().map(move |q| Paths { f, q }))
    }
}
