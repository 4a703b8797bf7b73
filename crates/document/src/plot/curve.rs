//! What a figure is told of a curve.

/// How a curve is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// As a line with a colour and dashes of its own.
    Line,
    /// With marks at its points, for values at separate places.
    Marked,
    /// Marks alone, where nothing holds between them.
    Points,
    /// As a thick black line: what bounds the others.
    Bound,
}

/// One curve.
#[derive(Clone, Debug)]
pub struct Curve {
    /// What the legend says.
    pub label: String,
    /// Its points; those that are not finite, or not positive on a logarithmic axis, are left out.
    pub points: Vec<(f64, f64)>,
    /// How it is drawn.
    pub style: Style,
}
