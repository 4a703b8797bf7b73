//! Derivatives of formulas, as formulas (docs/mathematics.md, section 11.6).
//!
//! Where every operation is applied inside of where it is smooth, which is decided apart ([`super::smooth`]), these are the
//! derivatives. The one along t follows the frame: the derivative of xb(t) is xb'(t), that of v is 0.

use super::formula::{Axis, Formulas, Id, Kind, Leaf};
use crate::expr::Op;
use rug::Rational;

impl Formulas {
    /// The derivative of a node along an axis.
    pub fn derivative(&mut self, root: Id, axis: Axis) -> Id {
        // From the leaves up, so that nothing recurs however long a sum is.
        for id in self.below(&[root]) {
            if self.derivatives.contains_key(&(id, axis)) {
                continue;
            }
            let slope = if self.depends(id) & axis.bit() == 0 { self.int(0) } else { self.slope(id, axis) };
            self.derivatives.insert((id, axis), slope);
        }
        self.known(root, axis)
    }

    /// A derivative that has been formed.
    fn known(&mut self, id: Id, axis: Axis) -> Id {
        match self.derivatives.get(&(id, axis)) {
            Some(slope) => *slope,
            None => self.int(0),
        }
    }

    fn slope(&mut self, id: Id, axis: Axis) -> Id {
        let (op, [a, b]) = match self.node(id).kind.clone() {
            Kind::Leaf(leaf) => return self.leaf_slope(leaf),
            Kind::Sign(_) => return self.int(0),
            Kind::Apply(op, operands) => (op, operands),
        };
        let (da, db) = (self.known(a, axis), self.known(b, axis));
        let one = self.int(1);
        match op {
            Op::Neg => self.apply(&Op::Neg, [da, 0]),
            Op::Add | Op::Sub => self.apply(&op, [da, db]),
            Op::Mul => self.dot([(da, b), (a, db)]),
            Op::Div => {
                let moved = self.mul(id, db);
                let above = self.sub(da, moved);
                self.apply(&Op::Div, [above, b])
            }
            Op::Sqrt => {
                let half = self.number(&Rational::from((1, 2)));
                let above = self.mul(half, da);
                self.apply(&Op::Div, [above, id])
            }
            Op::Exp => self.mul(id, da),
            Op::Log => self.apply(&Op::Div, [da, a]),
            Op::Sin => {
                let cos = self.apply(&Op::Cos, [a, 0]);
                self.mul(cos, da)
            }
            Op::Cos => {
                let sin = self.apply(&Op::Sin, [a, 0]);
                let product = self.mul(sin, da);
                self.apply(&Op::Neg, [product, 0])
            }
            Op::Tan => {
                let square = self.mul(id, id);
                let factor = self.add(one, square);
                self.mul(factor, da)
            }
            Op::Tanh => {
                let square = self.mul(id, id);
                let factor = self.sub(one, square);
                self.mul(factor, da)
            }
            Op::Atan => {
                let square = self.mul(a, a);
                let below = self.add(one, square);
                self.apply(&Op::Div, [da, below])
            }
            Op::Abs => {
                let sign = self.sign(a);
                self.mul(sign, da)
            }
            Op::Power(n) => {
                let factor = self.int(i64::from(n));
                let power = self.apply(&Op::Power(n - 1), [a, 0]);
                let outer = self.mul(factor, power);
                self.mul(outer, da)
            }
            Op::Pow => self.power_slope(id, [a, b], [da, db]),
            Op::Min => self.chosen([b, a], [da, db]),
            Op::Max => self.chosen([a, b], [da, db]),
            Op::Number(_) | Op::Pi | Op::X | Op::E | Op::State(_) => self.int(0),
        }
    }

    /// `(a^b)' = b a^(b-1) a' + a^b log(a) b'`.
    fn power_slope(&mut self, id: Id, [a, b]: [Id; 2], [da, db]: [Id; 2]) -> Id {
        let one = self.int(1);
        let less = self.sub(b, one);
        let power = self.apply(&Op::Pow, [a, less]);
        let outer = self.mul(b, power);
        let log = self.apply(&Op::Log, [a, 0]);
        let other = self.mul(id, log);
        self.dot([(outer, da), (other, db)])
    }

    /// The first slope where `larger > smaller`, the second where it is less: by factors that are exactly 0 and 1.
    fn chosen(&mut self, [larger, smaller]: [Id; 2], [first, second]: [Id; 2]) -> Id {
        let difference = self.sub(larger, smaller);
        let sign = self.sign(difference);
        let half = self.number(&Rational::from((1, 2)));
        let halved = self.mul(half, sign);
        let (when, unless) = (self.add(half, halved), self.sub(half, halved));
        self.dot([(when, first), (unless, second)])
    }

    fn leaf_slope(&mut self, leaf: Leaf) -> Id {
        match leaf {
            Leaf::Time | Leaf::State(_) | Leaf::Output => self.int(1),
            Leaf::Orbit { state, order } => self.leaf(Leaf::Orbit { state, order: order + 1 }),
            Leaf::Lyapunov { which, entry, order } => self.leaf(Leaf::Lyapunov { which, entry, order: order + 1 }),
            Leaf::Drift(_) => self.int(0),
        }
    }
}
