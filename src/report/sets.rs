//! sigma* and the sets of the claim.

use super::document::{Block, Table};
use super::number::{exact, upper};
use crate::certify::{Certification, Derivation};
use crate::enclosure::Enclosure;
use crate::number::{Direction, write_exact};
use crate::plot::{Curve, Figure, Scale, Style};
use rug::Rational;
use std::f64::consts::FRAC_PI_2;

/// The table of the sets; nothing without a certified claim.
pub(super) fn section(run: &Certification<'_>) -> Vec<Block> {
    let (Some(sigma), Some(set), Some(periodic), Some(error_box)) =
        (run.sigma_star(), run.claimed_set(), run.periodic_solution(), run.error_box())
    else {
        return Vec::new();
    };
    // Of a plant the norm is that of y = L^-1 (x - x_0).
    let state = if run.spec.plant().is_some() { "|y|" } else { "|x|" };
    let none = || "-".to_owned();
    let down = |value| exact(value, Direction::Down);
    let mut table = Table::new(&["<", state, "|e|", "|zeta|_N", "|z|_N"]);
    table.push(["initial set (covered)".to_owned(), down(&set.x0), down(&set.e0), none(), down(&set.z0)]);
    let [x, e, zeta, z] = periodic.each_ref().map(upper);
    table.push(["periodic solution, at most".to_owned(), x, e, zeta, z]);
    // The box is where solutions stay, so its radii are upper bounds.
    let [d_x, d_e] = error_box.each_ref().map(upper);
    table.push(["error box around it (radii)".to_owned(), d_x, d_e, none(), none()]);
    let exact = run.exact_arguments();
    let claim = if exact.is_some() { "bounding functions used up to, sigma*" } else { "bounding functions used up to" };
    for (what, arguments) in [(claim, run.largest_arguments()), ("bounding functions used up to, sigma*_oo", exact)] {
        if let Some([x, e]) = arguments.map(|arguments| arguments.each_ref().map(upper)) {
            table.push([what.to_owned(), x, e, none(), none()]);
        }
    }
    let boxes = Boxes {
        state,
        initial: [&set.x0, &set.e0].map(Rational::to_f64),
        periodic: [&periodic[0], &periodic[1]].map(Enclosure::upper_f64),
        error: error_box.each_ref().map(Enclosure::upper_f64),
        used: run.largest_arguments().map(|arguments| arguments.each_ref().map(Enclosure::upper_f64)),
        // C4 keeps solutions below a level of U in the box; as P >= P_low I, such a level is within this ellipse.
        ellipse: run.options.derivation == Derivation::Sharp,
    };
    vec![
        Block::Heading(format!("sigma* = {} and the sets", write_exact(sigma))),
        Block::Table(table),
        Block::Drawing(boxes.figure()),
        Block::says(
            "Solutions from the initial set stay in the error box around the periodic solution. The rate of convergence \
             depends on n_o and is not part of the claim; sigma* and the sets do not depend on n_o. sigma is in 1/time.",
        ),
    ]
}

/// Sizes of sets in the plane of |x| and |e|.
pub(super) struct Boxes {
    /// How the norm of x is written.
    pub(super) state: &'static str,
    /// The initial set.
    pub(super) initial: [f64; 2],
    /// The periodic solution, at most.
    pub(super) periodic: [f64; 2],
    /// The error box around it.
    pub(super) error: [f64; 2],
    /// Where bounding functions are used.
    pub(super) used: Option<[f64; 2]>,
    /// Whether solutions stay in the ellipse within the error box.
    pub(super) ellipse: bool,
}

impl Boxes {
    /// Points of a quarter of an ellipse.
    const QUARTER: u32 = 60;

    /// The quarter of each set in which both coordinates are positive. It is drawn from doubles and claims nothing.
    pub(super) fn figure(&self) -> Figure {
        let state = self.state;
        let curve = |label: &str, points, style| Curve { label: label.to_owned(), points, style };
        let edge = |[x, e]: [f64; 2]| vec![(0.0, e), (x, e), (x, 0.0)];
        let mut curves = Vec::new();
        curves.extend(self.used.map(|used| curve("bounding functions used up to", edge(used), Style::Bound)));
        curves.push(curve("initial set", edge(self.initial), Style::Line));
        curves.push(curve("periodic solution, at most", edge(self.periodic), Style::Line));
        curves.push(curve("error box, from the periodic solution", edge(self.error), Style::Line));
        if self.ellipse {
            let [x, e] = self.error;
            let point = |k| {
                let (sin, cos) = libm::sincos(f64::from(k) / f64::from(Self::QUARTER) * FRAC_PI_2);
                (x * sin, e * cos)
            };
            let points = (0..=Self::QUARTER).map(point).collect();
            curves.push(curve("solutions stay within, from the periodic solution", points, Style::Line));
        }
        Figure {
            title: format!("The sets in the plane of {state} and |e|"),
            x: format!("{state} [unit of the norm]"),
            y: "|e| [unit of e]".to_owned(),
            scale: Scale::Linear,
            floor: 0.0,
            curves,
        }
    }
}
