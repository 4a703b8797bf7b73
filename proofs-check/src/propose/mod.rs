//! Everything that is searched for: where to cut, and by which rule each part is to be proved.
//!
//! What comes from here is plain data ([`crate::monotone::Step`], break points) and proves nothing: the rules verify that the
//! parts cover the whole, and each part by one evaluation. So a mistake here can make an answer `undecided`, never `valid`. It
//! is paid for apart from the claim ([`crate::effort::aside`]).

mod break_points;
mod cuts;

pub use break_points::{Judgement, break_points};
pub use cuts::{Proposal, cuts};
