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
    /// As a thin line with the colour of the curve that comes next, which it bounds.
    Limit,
    /// As an area of a light tone: where the curve that comes next lies, with the colour of that one. The points go around it.
    Band,
}

/// One curve.
#[derive(Clone, Debug)]
pub struct Curve {
    /// What the legend says; without words the curve has no place in it.
    pub label: String,
    /// Its points; those that are not finite, or not positive on a logarithmic axis, are left out.
    pub points: Vec<(f64, f64)>,
    /// How it is drawn.
    pub style: Style,
}

impl Curve {
    /// Whether its points are marked.
    pub(super) fn has_marks(&self) -> bool {
        matches!(self.style, Style::Marked | Style::Points)
    }
}
