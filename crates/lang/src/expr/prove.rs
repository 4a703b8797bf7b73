//! The proof that an expression is a bounding function on a box: finite, nondecreasing, nowhere certainly negative.
//!
//! The box is bisected until, on every piece, the expression is proved to be defined and its slopes in X and in E to
//! be nonnegative. The pieces are closed and cover the box, so a segment parallel to an axis runs through finitely
//! many of them, on each of which the expression is nondecreasing: it is nondecreasing along the segment. A defined
//! expression is continuous, so it is bounded on the compact box. A nondecreasing expression has its least value at
//! (0, 0): if it is negative anywhere, then there. Where that sign is not decided (it may be exactly 0), nothing is lost:
//! the expression bounds a norm, so its positive part does too, and the positive part is what is used everywhere
//! ([`sigmastar_theory::data::Data::bound`]).

use super::Expr;
use super::failure::{BoundingFailure, DomainBox, Property, Reason};
use super::jet::Jet;
use super::refute::{Refuter, sides};
use super::settings::ProofSettings;
use super::slope::is_zero;
use super::syntax::{Argument, Binary, NodeKind, Unary};
use rug::Rational;
use sigmastar_exact::enclosure::{DEFAULT_PRECISION, Enclosure};
use std::collections::VecDeque;
use std::ops::Range;

/// Bisections after which the working precision is raised by as many bits as they may have cost.
const RAISE_EVERY: u32 = 16;

/// What a function such as exp or a power counts in [`ProofSettings::max_operations`].
pub const FUNCTION_WEIGHT: u64 = 4;

/// Executions that the last search for counterexamples may take, in units of the largest number of a whole proof.
const LAST_SHARE: u64 = 4;

/// Undecided boxes at which counterexamples are sought when the search ends.
const LAST_ATTEMPTS: usize = 64;

/// Executions of [`Refuter::corners`].
const CORNERS: u64 = 5;

/// How much longer (relative to the domain, as a power of 2) one side of a box may become than the other.
const MAX_IMBALANCE: i32 = 24;

struct Piece {
    region: DomainBox,
    depth: u32,
    /// How often each side was bisected.
    cuts: [i32; 2],
    /// Whether being nondecreasing in X and in E is already proved; on a piece it then holds on every part.
    monotone: [bool; 2],
}

/// The operations that a proof has taken.
struct Work {
    per_execution: u64,
    done: u64,
}

impl Work {
    fn new(expr: &Expr) -> Work {
        let weight = |kind: &NodeKind| match kind {
            NodeKind::Number(_) | NodeKind::Pi | NodeKind::Variable(_) | NodeKind::Unary(Unary::Neg | Unary::Abs) => 1,
            NodeKind::Unary(_) | NodeKind::Power(_) | NodeKind::Binary(Binary::Pow) => FUNCTION_WEIGHT,
            NodeKind::Binary(_) => 1,
        };
        Work { per_execution: expr.nodes.iter().map(|node| weight(&node.kind)).sum(), done: 0 }
    }

    fn count(&mut self, executions: u64, precision: u32) {
        let each = self.per_execution.saturating_mul(u64::from(precision.div_ceil(DEFAULT_PRECISION)));
        self.done = self.done.saturating_add(each.saturating_mul(executions));
    }
}

/// What keeps a piece from being settled.
struct Obstacle {
    property: Property,
    span: Option<Range<usize>>,
    /// How much each side contributes to it, as far as is known.
    influence: [f64; 2],
    /// Whether the expression is proved not to depend on the side, so that cutting it would not help.
    constant: [bool; 2],
}

/// Proves that the positive part of the expression is a bounding function on `[0, x_max]` times `[0, e_max]`: the
/// expression is defined, bounded and nondecreasing in X and in E. It is refuted where it is certainly negative.
///
/// `Ok` is a proof, and so is [`BoundingFailure::Refuted`]; [`BoundingFailure::Undecided`] claims nothing. The result
/// depends on the arguments only. At most `max_boxes` boxes are examined, and the work ends with the box that takes it
/// beyond `max_operations`.
///
/// # Errors
/// [`BoundingFailure`]: refuted, with exact points that prove it; or undecided, with the box where the proof got
/// stuck. A domain with a negative end is undecided.
pub fn prove_bounding(
    expr: &Expr,
    x_max: &Rational,
    e_max: &Rational,
    settings: &ProofSettings,
) -> Result<(), BoundingFailure> {
    let domain = DomainBox { x: [Rational::new(), x_max.clone()], e: [Rational::new(), e_max.clone()] };
    if *x_max < 0 || *e_max < 0 {
        let (property, reason) = (Property::Finite, Reason::Empty);
        return Err(BoundingFailure::Undecided { property, region: Box::new(domain), span: None, reason });
    }
    let refuter = Refuter::new(expr, settings);
    if !settings.signed {
        not_negative_at_origin(expr, &refuter, settings)?;
    }
    subdivide(expr, &refuter, domain, settings)
}

/// Refutes an expression that is negative at (0, 0), raising the precision as needed.
fn not_negative_at_origin(expr: &Expr, refuter: &Refuter<'_>, settings: &ProofSettings) -> Result<(), BoundingFailure> {
    let zero = Rational::new();
    let mut precision = settings.precision;
    loop {
        refuter.evaluate(&zero, &zero, precision)?;
        let (at, _) = expr.at_point(&zero, &zero, precision);
        let decided = at.value.is_nonnegative().is_true() || at.sign().is_some();
        if decided || precision >= settings.max_precision {
            return Ok(());
        }
        precision = (precision.saturating_mul(2)).min(settings.max_precision);
    }
}

/// Proves the expression defined and nondecreasing on the domain.
fn subdivide(
    expr: &Expr,
    refuter: &Refuter<'_>,
    domain: DomainBox,
    settings: &ProofSettings,
) -> Result<(), BoundingFailure> {
    // A side that is a single point has nothing to be monotone along.
    let monotone = [domain.x[0] == domain.x[1], domain.e[0] == domain.e[1]];
    // First in, first out: the widest boxes come first, so that a limit is met with evenly small ones.
    let mut queue = VecDeque::from([Piece { region: domain, depth: 0, cuts: [0, 0], monotone }]);
    let mut stuck: Vec<(Piece, Obstacle)> = Vec::new();
    let max_boxes = settings.max_boxes;
    let mut work = Work::new(expr);
    let mut examined = 0;
    while let Some(mut piece) = queue.pop_front() {
        let precision = precision_at(piece.depth, settings);
        let Some(obstacle) = examine(expr, &mut piece, precision, &mut work) else { continue };
        if piece.depth == 0 {
            refuter.grid(&piece.region)?;
        } else if refuter.is_suspicious(&piece.region) {
            work.count(CORNERS, precision);
            refuter.corners(&piece.region, precision)?;
        }
        examined += 1;
        let limit = if examined >= max_boxes {
            Some(Reason::Boxes(max_boxes))
        } else {
            (work.done >= settings.max_operations).then_some(Reason::Operations(settings.max_operations))
        };
        if let Some(reason) = limit {
            stuck.push((piece, obstacle));
            return Err(give_up(refuter, stuck, reason, settings, &mut work));
        }
        match bisect(&piece, &obstacle, settings) {
            Some(halves) => queue.extend(halves),
            None => {
                // The last resort of a piece that is not divided is the highest precision.
                if let Some(obstacle) = examine(expr, &mut piece, settings.max_precision, &mut work) {
                    stuck.push((piece, obstacle));
                }
            }
        }
        if stuck.len() >= LAST_ATTEMPTS {
            break;
        }
    }
    if stuck.is_empty() { Ok(()) } else { Err(give_up(refuter, stuck, Reason::Depth, settings, &mut work)) }
}

fn precision_at(depth: u32, settings: &ProofSettings) -> u32 {
    (settings.precision + 2 * RAISE_EVERY * (depth / RAISE_EVERY)).min(settings.max_precision.max(settings.precision))
}

/// The last attempt: counterexamples at the boxes where the proof got stuck, at the highest precision.
fn give_up(
    refuter: &Refuter<'_>,
    mut stuck: Vec<(Piece, Obstacle)>,
    reason: Reason,
    settings: &ProofSettings,
    work: &mut Work,
) -> BoundingFailure {
    work.done = 0;
    for (piece, _) in &stuck {
        if work.done > settings.max_operations / LAST_SHARE {
            break;
        }
        work.count(CORNERS, settings.max_precision);
        if let Err(refuted) = refuter.corners(&piece.region, settings.max_precision) {
            return refuted;
        }
    }
    let (piece, obstacle) = stuck.swap_remove(0);
    BoundingFailure::Undecided {
        property: obstacle.property,
        region: Box::new(piece.region),
        span: obstacle.span,
        reason,
    }
}

fn is_nonnegative(value: &Enclosure) -> bool {
    value.is_nonnegative().is_true()
}

/// Tries to settle a piece; records what is proved, and returns what is not.
fn examine(expr: &Expr, piece: &mut Piece, precision: u32, work: &mut Work) -> Option<Obstacle> {
    let [x, e] = sides(&piece.region, precision);
    work.count(1, precision);
    let slopes = expr.enclose_slopes(&x, &e);
    if !slopes.value.is_defined() {
        let (_, span) = expr.enclose_blaming(&x, &e);
        let constant = [
            !expr.mentions(|kind| matches!(kind, NodeKind::Variable(Argument::X))),
            !expr.mentions(|kind| matches!(kind, NodeKind::Variable(Argument::E))),
        ];
        return Some(Obstacle { property: Property::Finite, span, influence: [f64::NAN; 2], constant });
    }
    piece.monotone[0] |= is_nonnegative(&slopes.slope_x);
    piece.monotone[1] |= is_nonnegative(&slopes.slope_e);
    if piece.monotone == [true, true] {
        return None;
    }
    work.count(1, precision);
    let jet = expr.enclose_jet(&x, &e);
    for side in [0, 1] {
        if !piece.monotone[side] {
            // At most; a derivative may be settled by the first.
            work.count(3, precision);
            piece.monotone[side] = derivative_is_nonnegative(expr, [&x, &e], &jet, side);
        }
    }
    let side = piece.monotone.iter().position(|proved| !proved)?;
    let property = [Property::NondecreasingInX, Property::NondecreasingInE][side];
    let influence = [0, 1].map(|along| {
        let [rate, width] =
            [&jet.second[side + along], [&x, &e][along]].map(|range| range.upper_f64() - range.lower_f64());
        let rate = rate.max(jet.second[side + along].abs().upper_f64());
        rate * width
    });
    let constant = [is_zero(&slopes.slope_x), is_zero(&slopes.slope_e)];
    Some(Obstacle { property, span: None, influence, constant })
}

/// Proves a first derivative nonnegative on a box from the second derivatives there: going from any point along an
/// axis to a face or to the middle of the box changes it by a value of a second derivative times the distance.
fn derivative_is_nonnegative(expr: &Expr, sides: [&Enclosure; 2], jet: &Jet, of: usize) -> bool {
    if is_nonnegative(&jet.first[of]) {
        return true;
    }
    // The second derivatives of the first derivative in question, in X and in E.
    let rates = [&jet.second[of], &jet.second[of + 1]];
    // Where the derivative is least as far as its own derivative tells, else the middle.
    let centre = [0, 1].map(|along| {
        let ends = [sides[along].lower(), sides[along].upper()];
        let [lower, upper] = ends.map(|end| Enclosure::new(end.clone(), end));
        if is_nonnegative(rates[along]) {
            lower
        } else if is_nonnegative(&rates[along].negate()) {
            upper
        } else {
            let middle = (lower + &upper) / 2;
            middle.ceiling()
        }
    });
    [[true, false], [false, true], [true, true]].into_iter().any(|moved| {
        let face = [0, 1].map(|along| if moved[along] { &centre[along] } else { sides[along] });
        let mut derivative = expr.enclose_jet(face[0], face[1]).first[of].clone();
        for along in [0, 1] {
            if moved[along] {
                derivative = derivative + rates[along] * (sides[along] - &centre[along]);
            }
        }
        is_nonnegative(&derivative)
    })
}

/// Halves the side with the larger influence; `None` when the piece may not be divided further.
fn bisect(piece: &Piece, obstacle: &Obstacle, settings: &ProofSettings) -> Option<[Piece; 2]> {
    if piece.depth >= settings.max_depth {
        return None;
    }
    let divisible = [&piece.region.x, &piece.region.e].map(|ends| ends[0] != ends[1]);
    let divisible = [0, 1].map(|along| divisible[along] && !obstacle.constant[along]);
    let balance = piece.cuts[0] - piece.cuts[1];
    let along = match divisible {
        [false, false] => return None,
        [true, false] => 0,
        [false, true] => 1,
        [true, true] if balance.abs() >= MAX_IMBALANCE => usize::from(balance > 0),
        [true, true] if obstacle.influence.iter().all(|rate| rate.is_finite()) => {
            usize::from(obstacle.influence[1] > obstacle.influence[0])
        }
        [true, true] => usize::from(balance > 0),
    };
    let ends = if along == 0 { &piece.region.x } else { &piece.region.e };
    let middle = Rational::from(&ends[0] + &ends[1]) / 2u32;
    let half = |from: &Rational, to: &Rational| {
        let mut region = piece.region.clone();
        let side = if along == 0 { &mut region.x } else { &mut region.e };
        *side = [from.clone(), to.clone()];
        let mut cuts = piece.cuts;
        cuts[along] += 1;
        Piece { region, depth: piece.depth + 1, cuts, monotone: piece.monotone }
    };
    Some([half(&ends[0], &middle), half(&middle, &ends[1])])
}

impl Expr {
    fn mentions(&self, kind: fn(&NodeKind) -> bool) -> bool {
        self.nodes.iter().any(|node| kind(&node.kind))
    }
}
