//! sigma* and the sets of the claim.

use super::document::{Block, Table};
use super::number::{exact, upper};
use crate::certify::Certification;
use crate::number::{Direction, write_exact};

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
    vec![
        Block::Heading(format!("sigma* = {} and the sets", write_exact(sigma))),
        Block::Table(table),
        Block::says(
            "Solutions from the initial set stay in the error box around the periodic solution. The rate of convergence \
             depends on n_o and is not part of the claim; sigma* and the sets do not depend on n_o. sigma is in 1/time.",
        ),
    ]
}
