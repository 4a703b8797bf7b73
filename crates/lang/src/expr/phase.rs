//! `phase`, the name of 2 pi t/T in formulas with the period T (derivation, 13.3).

use super::Expr;
use super::syntax::{Binary, Node, NodeKind, carried};
use std::sync::Arc;

/// The name.
pub(super) const PHASE: &str = "phase";

/// What stands for t where the period is not known exactly.
pub(super) const INSTEAD_OF_TIME: &str = "the period is known to an interval only: write phase, which is 2*pi*t/period";

/// What `phase` and `t` are in formulas whose period is a certain constant.
#[derive(Clone, Debug)]
pub struct Phase {
    /// The nodes of 2 pi/T.
    turn: Arc<[Node]>,
    /// Whether T is known exactly; else the formulas may depend on time by the phase alone.
    pub(super) exact: bool,
}

impl Phase {
    /// The phase for a period T, a constant expression; `exact` says whether `t` may stand beside it. Where T is known to an interval, T is
    /// its nominal value, and the time that formulas are then evaluated at is the nominal one, of which the phase is `2 pi/T` times.
    #[must_use]
    pub fn new(period: &Expr, exact: bool) -> Phase {
        let node = |kind| Node { kind, span: 0..0 };
        let turn = [NodeKind::Number(2.into()), NodeKind::Pi, NodeKind::Binary(Binary::Mul)].map(node);
        let divided = period.nodes.iter().cloned().chain([node(NodeKind::Binary(Binary::Div))]);
        Phase { turn: turn.into_iter().chain(divided).collect(), exact }
    }

    /// The nodes of `2 pi/T`.
    pub(super) fn turn(&self) -> &[Node] {
        &self.turn
    }

    /// The operations of `2 pi/T * t`.
    pub(super) fn nodes<V: Clone>(&self, time: V) -> Vec<NodeKind<V>> {
        let product = [NodeKind::Variable(time), NodeKind::Binary(Binary::Mul)];
        self.turn.iter().filter_map(carried).chain(product).collect()
    }
}
