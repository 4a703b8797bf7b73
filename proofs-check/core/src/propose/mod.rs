//! Everything that is searched for: where to cut, by which rule each part is to be proved, which factors a
//! polynomial has.
//!
//! What comes from here is plain data ([`crate::monotone::Step`], break points, factors) and proves nothing: the rules verify that the
//! parts cover the whole, each part by one evaluation, and multiply the factors out. So a mistake here can make an answer `undecided`, never `valid`. It
//! is paid for apart from the claim ([`crate::effort::aside`]).

mod cuts;
mod factors;

pub use cuts::{Proposal, cuts};
pub use factors::square_free;
