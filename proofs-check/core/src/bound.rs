//! The bounding functions of a specification (docs/mathematics.md, sections 1 and 10.1).

/// Which bounding function; the numbers are positions in [`BOUND_NAMES`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bound {
    F,
    Fe,
    Fxx,
    Fex,
    Q,
    Qe,
    Qx,
    Qt,
    QRms,
    QtRms,
    Fx,
    QeMax,
    Qtx,
    Qte,
}

/// How many there are.
pub const BOUNDS: usize = 14;
/// How many of them, from the first on, must be given.
pub const REQUIRED: usize = 8;

/// The names of the bounding functions in a file, in the order of [`Bound`].
#[rustfmt::skip]
pub const BOUND_NAMES: [&str; BOUNDS] = [
    "f", "f_e", "f_xx", "f_ex", "q", "q_e", "q_x", "q_t", "q_rms", "q_t_rms", "f_x", "q_e_max", "q_tx", "q_te",
];
