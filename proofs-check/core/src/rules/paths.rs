//! The paths along which differences of f and of q on the error box are split (docs/mathematics.md, section 13.7).

use crate::json::{Field, Fields};
use crate::verdict::{Outcome, bad};

/// From a periodic solution to a point of the error box. d/dx is taken up to |x| <= X_b, and |e| <= e_per where x comes first, else
/// |e| <= E_b; d/de up to |e| <= E_b, and |x| <= x_per where e comes first, else |x| <= X_b.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Path {
    StateFirst,
    ErrorFirst,
    Straight,
}

impl Path {
    fn read(field: &Field<'_>) -> Outcome<Path> {
        match field.text()? {
            "x-first" => Ok(Path::StateFirst),
            "e-first" => Ok(Path::ErrorFirst),
            "straight" => Ok(Path::Straight),
            _ => bad(&field.pointer, "expected `x-first`, `e-first` or `straight`"),
        }
    }

    /// The bound of |e| where d/dx is taken.
    pub fn e_at_dx<'r, T>(self, e_per: &'r T, e_b: &'r T) -> &'r T {
        match self {
            Path::StateFirst => e_per,
            Path::ErrorFirst | Path::Straight => e_b,
        }
    }

    /// The bound of |x| where d/de is taken.
    pub fn x_at_de<'r, T>(self, x_per: &'r T, x_b: &'r T) -> &'r T {
        match self {
            Path::ErrorFirst => x_per,
            Path::StateFirst | Path::Straight => x_b,
        }
    }
}

/// The path of f and the one of q.
#[derive(Clone, Copy, Debug)]
pub struct Paths {
    pub f: Path,
    pub q: Path,
}

impl Paths {
    /// Takes `paths` out of a witness; without it f is split over x first, and q straight.
    pub fn read(witness: &mut Fields<'_>) -> Outcome<Paths> {
        let Some(field) = witness.optional("paths") else {
            return Ok(Paths { f: Path::StateFirst, q: Path::Straight });
        };
        field.object(|paths| Ok(Paths { f: Path::read(&paths.required("f")?)?, q: Path::read(&paths.required("q")?)? }))
    }
}
