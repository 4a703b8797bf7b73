//! sigma* and the sets of the claim.

use super::words;
use rug::Rational;
use sigmastar_document::number::{self, upper};
use sigmastar_document::plot::{Curve, Figure, Scale, Style};
use sigmastar_document::{Block, Table};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::Direction;
use sigmastar_lang::spec::{Specification, StartSizes};
use sigmastar_prove::certify::Certification;
use sigmastar_theory::derivation::initial_set::ClaimedSet;
use std::f64::consts::FRAC_PI_2;

/// The table of the sets; nothing without a certified claim.
pub(super) fn section(run: &Certification<'_>) -> Vec<Block> {
    let (Some(sigma), Some(set), Some(periodic), Some(error_box)) =
        (run.sigma_star(), run.claimed_set(), run.periodic_solution(), run.error_box())
    else {
        return Vec::new();
    };
    // Of a plant the norm is that of y = L^-1 (x - x_0).
    let mut sizes = Sizes::new(run.spec);
    sizes.of_claim(set, &periodic);
    // The box is where solutions stay, so its radii are upper bounds.
    sizes.row("error box around it (radii)", error_box.each_ref().map(upper));
    let exact = run.exact_arguments();
    let claim =
        if exact.is_some() { "bounding functions used up to, $`sigma*`$" } else { "bounding functions used up to" };
    for (what, arguments) in [(claim, run.largest_arguments()), ("bounding functions used up to, $`sigma*_oo`$", exact)]
    {
        if let Some(arguments) = arguments.map(|arguments| arguments.each_ref().map(upper)) {
            sizes.row(what, arguments);
        }
    }
    let boxes = Boxes {
        state: run.spec.state_name(),
        initial: [&set.x0, &set.e0].map(Rational::to_f64),
        periodic: [&periodic[0], &periodic[1]].map(Enclosure::upper_f64),
        error: error_box.each_ref().map(Enclosure::upper_f64),
        used: run.largest_arguments().map(|arguments| arguments.each_ref().map(Enclosure::upper_f64)),
        // C4 keeps solutions below a level of U in the box; as P >= P_low I, such a level is within this ellipse.
        ellipse: true,
    };
    let mut blocks = vec![
        Block::Heading(match run.is_smallest() {
            true => format!("sigma* = {} and the sets", number::exact(sigma, Direction::Up)),
            false => format!("sigma = {} and the sets", number::exact(sigma, Direction::Up)),
        }),
        Block::Table(sizes.table),
    ];
    blocks.extend(boxes.figure().map(Block::Drawing));
    blocks.push(Block::says(format!(
        "Solutions from the initial set stay in the error box around the periodic solution. {NORMS} The gain and the sets are the same for every \
         $`n_o`$. The rate of convergence depends on $`n_o`$ and {}. $`sigma`$ is in 1/time.",
        match run.for_n_o.iter().any(|found| found.bound.is_some()) {
            true => "is part of the claim only for the numbers that were asked for",
            false => "is not part of the claim",
        }
    )));
    blocks
}

/// What the last two columns of the table are sizes of.
pub(super) const NORMS: &str = "Here $`zeta = z - M e`$, $`|z|_N = sqrt(z'Nz)`$, and $`|zeta|_N`$ likewise.";

/// The table of the sizes of sets: in the norms of the state, where there is one, of e, of zeta and of z.
pub(super) struct Sizes<'s> {
    spec: &'s Specification,
    pub(super) table: Table,
}

impl<'s> Sizes<'s> {
    pub(super) fn new(spec: &'s Specification) -> Sizes<'s> {
        let state = spec.state_name().map(|name| format!("$`|{name}|`$"));
        let titles: Vec<&str> =
            ["<"].into_iter().chain(state.as_deref()).chain(["$`|e|`$", "$`|zeta|_N`$", "$`|z|_N`$"]).collect();
        Sizes { spec, table: Table::new(&titles) }
    }

    /// Where solutions start, rounded inward, and how large the periodic solution is, rounded outward.
    pub(super) fn of_claim(&mut self, set: &ClaimedSet, periodic: &[Enclosure; 4]) {
        let StartSizes { x0, e0, z0 } = set.map(|value| number::exact(value, Direction::Down));
        // z = M e is zeta = 0.
        let [zeta, z] = z0.map_or_else(|| ["0".to_owned(), "$`z = M e`$".to_owned()], |z0| ["-".to_owned(), z0]);
        self.cells("initial set (covered)", [x0, e0, zeta, z]);
        self.cells("periodic solution, at most", periodic.each_ref().map(upper));
    }

    /// Sizes in the first two norms.
    pub(super) fn row(&mut self, name: &str, [x, e]: [String; 2]) {
        self.cells(name, [x, e, "-".to_owned(), "-".to_owned()]);
    }

    fn cells(&mut self, name: &str, cells: [String; 4]) {
        self.table.push(std::iter::once(name.to_owned()).chain(words::with_state(self.spec, cells)));
    }
}

/// Sizes of sets in the plane of |x| and |e|.
pub(super) struct Boxes {
    /// What the state is called, where there is one.
    pub(super) state: Option<&'static str>,
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

    /// Sizes that are further apart than this are not seen beside each other on a linear axis.
    const APART: f64 = 50.0;

    /// The smaller and the larger end of one coordinate, of what is not 0.
    fn ends(&self, coordinate: usize) -> [f64; 2] {
        let sizes = [self.initial, self.periodic, self.error].into_iter().chain(self.used).map(|ends| ends[coordinate]);
        let sizes = sizes.filter(|size| *size > 0.0);
        sizes.fold([f64::INFINITY, 0.0], |[low, high], size| [low.min(size), high.max(size)])
    }

    /// The quarter of each set in which both coordinates are positive. It is drawn from doubles and claims nothing.
    /// Nothing without a state: the sets are intervals of |e| then.
    pub(super) fn figure(&self) -> Option<Figure> {
        let state = format!("|{}|", self.state?);
        let curve = |label: &str, points, style| Curve { label: label.to_owned(), points, style };
        let ends = [self.ends(0), self.ends(1)];
        let logarithmic = ends.iter().any(|[low, high]| *high > Self::APART * low);
        // A logarithmic axis has no 0: sets go on beyond its lower edge.
        let decade = |low: f64| libm::pow(10.0, libm::log10(0.5 * low).floor());
        let [x_0, e_0] = ends.map(|[low, _]| if logarithmic { decade(low) } else { 0.0 });
        let edge = |[x, e]: [f64; 2]| vec![(x_0, e.max(e_0)), (x.max(x_0), e.max(e_0)), (x.max(x_0), e_0)];
        let mut curves = Vec::new();
        curves.extend(self.used.map(|used| curve("bounding functions used up to", edge(used), Style::Bound)));
        curves.push(curve("initial set", edge(self.initial), Style::Line));
        curves.push(curve("periodic solution, at most", edge(self.periodic), Style::Line));
        curves.push(curve("error box, from the periodic solution", edge(self.error), Style::Line));
        if self.ellipse {
            let [x, e] = self.error;
            let point = |k| {
                let (sin, cos) = libm::sincos(f64::from(k) / f64::from(Self::QUARTER) * FRAC_PI_2);
                (x_0.max(x * sin), e_0.max(e * cos))
            };
            let points = (0..=Self::QUARTER).map(point).collect();
            curves.push(curve("solutions stay within, from the periodic solution", points, Style::Line));
        }
        Some(Figure {
            title: format!("The sets in the plane of {state} and |e|"),
            x: format!("{state} [unit of the norm]"),
            y: "|e| [unit of e]".to_owned(),
            scale: if logarithmic { Scale::LogLog } else { Scale::Linear },
            floor: e_0,
            curves,
        })
    }
}
