//! sigma* and the sets of the claim.

use super::blocks::{Block, Table};
use super::number::{exact, upper};
use super::verdict::{exact_arguments, largest_arguments};
use crate::certify::Certification;
use crate::enclosure::Enclosure;
use crate::number::{Direction, write_exact};

/// Where the periodic solution lies and how large the error box around it is.
pub(super) struct Sets {
    /// |x|, |e|, |zeta|_N, |z|_N of the periodic solution.
    pub(super) periodic: [Enclosure; 4],
    /// Radii of the error box in x and e.
    pub(super) error_box: [Enclosure; 2],
}

impl Sets {
    /// The sets of a certified claim.
    pub(super) fn new(run: &Certification<'_>) -> Option<Sets> {
        let periodic = run.periodic_solution()?;
        let error_box = run.claim()?.error_box;
        Some(Sets { periodic, error_box })
    }
}

/// The table of the sets; nothing without a certified claim.
pub(super) fn section(run: &Certification<'_>) -> Vec<Block> {
    let (Some(sigma), Some(set), Some(sets)) = (run.sigma_star(), run.claimed_set(), Sets::new(run)) else {
        return Vec::new();
    };
    let none = || "-".to_owned();
    let down = |value| exact(value, Direction::Down);
    let mut table = Table::new(&["<", "|x|", "|e|", "|zeta|_N", "|z|_N"]);
    table.push(["initial set (covered)".to_owned(), down(&set.x0), down(&set.e0), none(), down(&set.z0)]);
    let [x, e, zeta, z] = sets.periodic.each_ref().map(upper);
    table.push(["periodic solution, at most".to_owned(), x, e, zeta, z]);
    // The box is where solutions stay, so its radii are upper bounds.
    let [d_x, d_e] = sets.error_box.each_ref().map(upper);
    table.push(["error box around it (radii)".to_owned(), d_x, d_e, none(), none()]);
    let exact = exact_arguments(run);
    let claim = if exact.is_some() { "bounding functions used up to, sigma*" } else { "bounding functions used up to" };
    for (what, arguments) in [(claim, largest_arguments(run)), ("bounding functions used up to, sigma*_oo", exact)] {
        if let Some([x, e]) = arguments.map(|arguments| arguments.each_ref().map(upper)) {
            table.push([what.to_owned(), x, e, none(), none()]);
        }
    }
    vec![
        Block::Heading(format!("sigma* = {} and the sets", write_exact(sigma))),
        Block::Table(table),
        Block::says(
            "Solutions from the initial set stay in the error box around the periodic solution. The rate of convergence \
             depends on n_o and is not part of the claim; sigma* and the sets do not depend on n_o. sigma is in 1/time.",
        ),
    ]
}
