//! Decision of an entry, or of a polynomial in X and E, by subdivision (derivation, 11.3 and 11.6), and the values on a box that every
//! decision takes.

use super::PRECISION;
use super::centred::{Centred, Frame, OnBox, negated};
use super::chart::{Active, Ball, Cell, Chart, MAX_LEVEL, Placed};
use super::definite::{SymmetricValues, Verdict, definite, leaves_out, nonnegative};
use super::engine::{Engine, Tube};
use super::majorant::Majorant;
use super::quantity::{Quantity, Right};
use super::side::Side;
use super::time_cell::TimeCell;
use rug::Rational;
use sigmastar_exact::enclosure::{Enclosure, Truth};
use sigmastar_exact::number::Portable;
use sigmastar_lang::expr::{Memory, VariableSet};
use sigmastar_lang::spec::Bound;
use sigmastar_matrix::doubles::largest;
use sigmastar_matrix::doubles::{product, roots, transposed};
use sigmastar_theory::evidence::Entry;
use sigmastar_theory::evidence::Part;

/// Up to so many cells each may take all of an effort; more of them share one.
const WHOLE: usize = 4;

/// The answer for an entry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Decision {
    /// Whether the bound holds on the whole region; `False` is a proof as well.
    pub truth: Truth,
    /// The boxes that were examined; of a family in cells the most in one of these, as a share of the effort.
    pub boxes: usize,
}

impl Decision {
    /// What holds without a box.
    pub(super) const TRUE: Decision = Decision { truth: Truth::True, boxes: 0 };

    /// What is seen to fail without one.
    pub(super) const FALSE: Decision = Decision { truth: Truth::False, boxes: 0 };

    /// What is not looked at.
    pub(super) const UNDECIDED: Decision = Decision { truth: Truth::Undecided, boxes: 0 };

    /// This one and, if it is true, the next one, with the boxes of both.
    pub(super) fn and(self, next: impl FnOnce() -> Decision) -> Decision {
        if !self.truth.is_true() {
            return self;
        }
        let next = next();
        Decision { boxes: self.boxes + next.boxes, ..next }
    }
}

/// Examines boxes until all hold, one fails or the effort is spent.
pub(super) fn subdivide(chart: &Chart, effort: usize, mut examine: impl FnMut(&Cell, &Ball) -> Verdict) -> Decision {
    let mut open: Vec<Cell> = vec![vec![Side::WHOLE; chart.sides()]];
    let mut boxes = 0;
    while let Some(cell) = open.pop() {
        let Some(ball) = chart.ball(&cell) else { continue };
        if boxes == effort {
            return Decision { truth: Truth::Undecided, boxes };
        }
        boxes += 1;
        match examine(&cell, &ball) {
            Verdict::Holds => {}
            Verdict::Fails => {
                let inside = ball.has_its_middle();
                if inside && chart.is_exact() {
                    return Decision { truth: Truth::False, boxes };
                }
                if inside {
                    return Decision { truth: Truth::Undecided, boxes };
                }
                // The middle lies outside of the ball: of its sides the widest is halved.
                let widest = (0..cell.len()).filter(|&i| ball.member[i]).min_by_key(|&i| cell[i].level);
                match widest {
                    Some(side) if cell[side].level < MAX_LEVEL => halve(&mut open, cell, side),
                    _ => return Decision { truth: Truth::Undecided, boxes },
                }
            }
            Verdict::Halve(side) if cell[side].level < MAX_LEVEL => halve(&mut open, cell, side),
            Verdict::Halve(_) | Verdict::Stuck => return Decision { truth: Truth::Undecided, boxes },
        }
    }
    Decision { truth: Truth::True, boxes }
}

fn halve(open: &mut Vec<Cell>, cell: Cell, side: usize) {
    for half in cell[side].halves() {
        let mut next = cell.clone();
        next[side] = half;
        open.push(next);
    }
}

impl Engine {
    /// Decides whether a bound holds on `G(X,E)`, with so many boxes at most.
    ///
    /// Guarantee: `True` only if the inequality of the table (derivation, 11.3) holds for every (t,x,e) of `G(X,E)` and every
    /// value of x_0'; all formulas in it are then defined there. `False` only if it fails at a point of it. A negative X or E has
    /// no region and is undecided, and so is a rate without a P.
    ///
    /// Two things are for the caller to prove besides: the period ([`sigmastar_lang::plant::Plant::prove_periodic`]), and smoothness on the
    /// same region ([`Engine::smooth`]), without which a derivative that is written as 0 need not be one.
    #[must_use]
    pub fn decide(&self, entry: &Entry, effort: usize) -> Decision {
        let Entry { bound, x, e, value } = entry;
        if *x < 0 || *e < 0 || (bound.is_rate() && !self.has_matrix(*bound)) {
            return Decision::UNDECIDED;
        }
        if !bound.is_signed() && *value < 0 {
            return Decision::FALSE;
        }
        let Some(quantity) = self.quantity(*bound) else { return Decision::UNDECIDED };
        self.below((*bound, quantity), &quantity.active, [x, e], effort, &|frame, _, _, _| frame.rational(value))
    }

    /// Decides whether a bounding function holds on `|y| <= X`, `|e| <= E`, with so many boxes at most.
    ///
    /// Guarantee: `True` only if the quantity of `kind` is at most (a rate: at least) `b(|y|, |e|)` at every t and every such x
    /// and e, `y = L^-1 (x - x_0)`, for any x_0 within r of xb and every value of x_0'. As b is nondecreasing (that of a rate
    /// nonincreasing), `b(X', E')` is a bound on `|y| <= X'`, `|e| <= E'` then, for all X' <= X and E' <= E. For the caller to
    /// prove: what [`Engine::decide`] leaves to him.
    #[must_use]
    pub fn decide_majorant(&self, kind: Bound, b: &Majorant, [x, e]: [&Rational; 2], effort: usize) -> Decision {
        if *x < 0 || *e < 0 || (kind.is_rate() && !self.has_matrix(kind)) || !b.is_monotone(kind) {
            return Decision::UNDECIDED;
        }
        let Some(quantity) = self.quantity(kind) else { return Decision::UNDECIDED };
        // The distance from the orbit is that of the tube, which is followed in time.
        let mut active = quantity.active.clone();
        active.time |= !active.states.is_empty();
        self.below((kind, quantity), &active, [x, e], effort, &|frame, (tube, chart), ball, e| {
            // x = x_0 + L y with |x_0 - xb| <= r in the norm of y: |y| is not below the distance from xb less r.
            let zero = frame.constant(Enclosure::zero(PRECISION));
            let distance = frame.sub(&chart.distance(frame, ball), &frame.rational(tube.region.radius()));
            b.on_box(frame, &frame.greater(&distance, &zero), &e.map_or(zero, |e| frame.magnitude(e)))
        })
    }

    /// Decides that a quantity stays below a value, which may differ from point to point.
    fn below(
        &self,
        (kind, quantity): (Bound, &Quantity),
        active: &Active,
        [x, e]: [&Rational; 2],
        effort: usize,
        value: &BoundOnBox<'_>,
    ) -> Decision {
        self.in_all(effort, |tube, effort| {
            let chart = self.chart(tube, active, [x, e]);
            let mut boxes = OnBoxes::new(self, quantity, (tube, &chart));
            subdivide(&chart, effort, |cell, ball| {
                boxes.with(cell, ball, |values, frame| {
                    let bound = value(frame, (tube, &chart), ball, active.error.then_some(values.error));
                    values.examine(kind, &bound, ball)
                })
            })
        })
    }

    /// So many times less than the effort each cell may take.
    pub(super) fn parts(&self) -> usize {
        let count = self.tubes().count();
        if count > WHOLE { count } else { 1 }
    }

    /// A decision of every cell, one after the other up to the first that is not true, in few cells with all of the effort for each, in many
    /// with a part of it: so that a family takes little more than a plant does, here and where it is checked. `boxes` is not below the effort
    /// where that was not enough.
    pub(super) fn in_all(&self, effort: usize, mut decide: impl FnMut(&Tube, usize) -> Decision) -> Decision {
        let mut all = Decision::TRUE;
        let parts = self.parts();
        for tube in self.tubes() {
            let decision = decide(tube, effort.div_ceil(parts));
            all = Decision { boxes: all.boxes.max(decision.boxes * parts), ..decision };
            if !all.truth.is_true() {
                break;
            }
        }
        all
    }
}

/// The formulas of one bound, evaluated on one box after the other.
pub(super) struct OnBoxes<'a> {
    engine: &'a Engine,
    quantity: &'a Quantity,
    tube: &'a Tube,
    chart: &'a Chart,
    memory: Memory<Centred>,
    last: Option<Side>,
}

impl<'a> OnBoxes<'a> {
    pub(super) fn new(engine: &'a Engine, quantity: &'a Quantity, (tube, chart): (&'a Tube, &'a Chart)) -> OnBoxes<'a> {
        OnBoxes { engine, quantity, tube, chart, memory: Memory::default(), last: None }
    }

    /// What `use_it` makes of the values on a box.
    pub(super) fn with<R>(&mut self, cell: &Cell, ball: &Ball, use_it: impl FnOnce(&Values<'_>, &Frame) -> R) -> R {
        let OnBoxes { engine, quantity, tube, chart, memory, last } = self;
        let side = if chart.time { cell[0] } else { Side::WHOLE };
        let time = engine.time_cell(tube, side);
        let placed = chart.place(cell, ball, Some(&time));
        // Formulas of t alone keep their values while its interval does; the slopes are per side, and sides stay.
        let changed = if *last == Some(side) { VariableSet::ALL_BUT_TIME } else { VariableSet::ALL };
        *last = Some(side);
        let velocity = if quantity.is_carried() { engine.velocity(tube, side, &time) } else { &[] };
        let Placed { frame, t, x, e, p } = &placed;
        let outputs = quantity.walk.evaluate_again(&mut OnBox { frame, t, x, e, p }, memory, changed);
        use_it(&Values { engine, chart, frame, quantity, outputs, time: &time, velocity, error: e }, frame)
    }
}

/// The bound on a box, from the frame, the cell and its coordinates, the ball and e (where the quantity depends on it).
type BoundOnBox<'a> = dyn Fn(&Frame, (&Tube, &Chart), &Ball, Option<&Centred>) -> Centred + 'a;

/// The formulas of a bound on a box.
pub(super) struct Values<'a> {
    pub(super) engine: &'a Engine,
    chart: &'a Chart,
    pub(super) frame: &'a Frame,
    quantity: &'a Quantity,
    outputs: Vec<Centred>,
    time: &'a TimeCell,
    /// x_0', where the quantity goes with it.
    velocity: &'a [Centred],
    /// e.
    error: &'a Centred,
}

/// J by rows, g as a column, r and d on a box, in the coordinates y; what a part does not have is empty.
pub(super) struct InY {
    pub(super) jacobian: Vec<Vec<Centred>>,
    pub(super) column: Vec<Vec<Centred>>,
    pub(super) row: Vec<Centred>,
    pub(super) slope: Option<Centred>,
}

impl Values<'_> {
    /// The matrix of the quantity, in the coordinates y.
    pub(super) fn matrix(&self) -> Vec<Vec<Centred>> {
        let frame = self.frame;
        let mut rows: Vec<Vec<Centred>> = self
            .quantity
            .plain
            .iter()
            .map(|row| row.iter().map(|&output| self.outputs[output].clone()).collect())
            .collect();
        for (row, along) in rows.iter_mut().zip(&self.quantity.along) {
            for (entry, terms) in row.iter_mut().zip(along) {
                for (output, state) in terms {
                    let velocity = self.chart.moving(frame, &self.velocity[*state]);
                    *entry = frame.add(entry, &frame.mul(&self.outputs[*output], &velocity));
                }
            }
        }
        if self.quantity.inverse {
            rows = self.product(self.engine.region().inverse(), &rows, false);
        }
        match self.quantity.right {
            Right::One => rows,
            Right::Matrix => self.product(self.engine.region().matrix(), &rows, true),
            Right::Pair => rows.iter().map(|row| self.both(row)).collect(),
        }
    }

    /// `L^T H L` for a symmetric H whose rows stand one behind the other.
    fn both(&self, row: &[Centred]) -> Vec<Centred> {
        let l = self.engine.region().matrix();
        let right: Vec<Vec<Centred>> =
            self.product(l, &row.chunks(l.len().max(1)).map(<[Centred]>::to_vec).collect::<Vec<_>>(), true);
        self.product(l, &transposed(&right), true).concat()
    }

    /// The first derivatives in the coordinates y; [`Values`] must be those of this part.
    pub(super) fn in_y(&self, part: Part) -> Option<InY> {
        let region = self.engine.region();
        // Without the columns of x there is nothing on the left of L.
        let l = if part == Part::Error { &[][..] } else { region.matrix() };
        let mut of_x = self.matrix();
        let mut of_e: Vec<Vec<Centred>> = of_x.iter_mut().map(|row| row.split_off(l.len())).collect();
        let (row, slope) = (of_x.pop()?, of_e.pop()?.pop());
        Some(InY {
            jacobian: self.product(l, &self.product(region.inverse(), &of_x, false), true),
            column: self.product(region.inverse(), &of_e, false),
            row: self.product(l, &[row], true).concat(),
            slope,
        })
    }

    /// `exact * rows`, or `rows * exact` for a square one.
    pub(super) fn product(&self, exact: &[Vec<Rational>], rows: &[Vec<Centred>], right: bool) -> Vec<Vec<Centred>> {
        let frame = self.frame;
        let columns = if right { exact.len() } else { rows.first().map_or(0, Vec::len) };
        let entry = |i: usize, j: usize| {
            let zero = frame.constant(Enclosure::zero(PRECISION));
            (0..if right { exact.len() } else { exact[i].len() }).fold(zero, |sum, k| {
                let (factor, value) = if right { (&exact[k][j], &rows[i][k]) } else { (&exact[i][k], &rows[k][j]) };
                if leaves_out(factor, value) {
                    return sum;
                }
                frame.add(&sum, &frame.scale(value, &Enclosure::from_rational(factor, PRECISION)))
            })
        };
        let count = if right { rows.len() } else { exact.len() };
        (0..count).map(|i| (0..columns).map(|j| entry(i, j)).collect()).collect()
    }

    /// The value in the middle of the box, and how far the others may be from it, in doubles; of a rate the negative. Nothing
    /// rests on them.
    pub(super) fn middle(&self, kind: Bound) -> [f64; 2] {
        let doubles = |value: &Centred| -> [f64; 2] {
            let middle = value.centre.midpoint_f64();
            [middle, (value.range.upper_f64() - middle).max(middle - value.range.lower_f64())]
        };
        let length = |values: &mut dyn Iterator<Item = f64>| values.map(|value| value * value).sum::<f64>().sqrt();
        let matrix = self.matrix();
        if kind.is_rate() {
            let zero = self.frame.constant(Enclosure::zero(PRECISION));
            let matrices = self.time.matrices[usize::from(kind == Bound::RateExistence)].as_ref();
            let (Some(decay), Some([p, _])) = (self.decay(kind, &matrix, &zero), matrices) else {
                return [f64::NAN; 2];
            };
            let p: Vec<Vec<f64>> = p.iter().map(|row| row.iter().map(|entry| doubles(entry)[0]).collect()).collect();
            let [_, root] = roots(&p);
            let mut growth = vec![vec![0.0; decay.order]; decay.order];
            for (i, j, value) in &decay.entries {
                let half = -doubles(value)[0] / 2.0;
                (growth[*i][*j], growth[*j][*i]) = (half, half);
            }
            let reach = length(&mut decay.entries.iter().map(|(.., value)| doubles(value)[1]));
            let weight = length(&mut root.iter().flatten().copied()).portable_powi(2);
            return [largest(product(&root, &product(&growth, &root))), reach * weight];
        }
        let values: Vec<Vec<[f64; 2]>> = matrix.iter().map(|row| row.iter().map(doubles).collect()).collect();
        let reach = length(&mut values.iter().flatten().map(|value| value[1]));
        let middles: Vec<Vec<f64>> = values.iter().map(|row| row.iter().map(|value| value[0]).collect()).collect();
        let middle = match &middles[..] {
            [row] if kind == Bound::QeMax => row.first().copied().unwrap_or(f64::NAN),
            rows => largest(product(&transposed(rows), rows)).max(0.0).sqrt(),
        };
        [middle, reach]
    }

    pub(super) fn examine(&self, kind: Bound, bound: &Centred, ball: &Ball) -> Verdict {
        let frame = self.frame;
        let matrix = self.matrix();
        if kind.is_rate() {
            return match self.decay(kind, &matrix, bound) {
                Some(values) => definite(frame, &values, ball),
                None => Verdict::Stuck,
            };
        }
        if matrix.iter().flatten().all(Centred::is_zero) && bound.range.is_nonnegative().is_true() {
            return Verdict::Holds;
        }
        if let [row] = &matrix[..]
            && let [number] = &row[..]
        {
            let above = nonnegative(frame, &frame.sub(bound, number), ball, false);
            if kind == Bound::QeMax || above != Verdict::Holds {
                return above;
            }
            return nonnegative(frame, &frame.add(bound, number), ball, false);
        }
        // |M| < value exactly if [[value I, M], [M^T, value I]] is positive definite.
        let rows = matrix.len();
        let order = rows + matrix.first().map_or(0, Vec::len);
        let diagonal = (0..order).map(|i| (i, i, bound.clone()));
        let off = matrix.iter().enumerate().flat_map(|(i, row)| {
            row.iter()
                .enumerate()
                .filter(|(_, value)| !value.is_zero())
                .map(move |(j, value)| (i, rows + j, value.clone()))
        });
        definite(frame, &SymmetricValues { order, entries: diagonal.chain(off).collect() }, ball)
    }

    /// `P v` for a column v, with the P of stability.
    pub(super) fn times_p(&self, column: &[Vec<Centred>]) -> Option<Vec<Centred>> {
        let frame = self.frame;
        let [p, _] = self.time.matrices[0].as_ref()?;
        let entry = |row: &Vec<Centred>| {
            let zero = frame.constant(Enclosure::zero(PRECISION));
            row.iter().zip(column.iter().flatten()).fold(zero, |sum, (p, value)| {
                // 0 times what may be undefined is undefined.
                let vanishes = p.is_zero() && value.range.is_defined();
                if vanishes { sum } else { frame.add(&sum, &frame.mul(&self.chart.moving(frame, p), value)) }
            })
        };
        Some(p.iter().map(entry).collect())
    }

    /// `-(P J + J^T P) - c_x I` for a constant P.
    pub(super) fn steady_decay(
        &self,
        p: &[Vec<Rational>],
        jacobian: &[Vec<Centred>],
        c_x: &Rational,
    ) -> Vec<(usize, usize, Centred)> {
        let frame = self.frame;
        let turned = self.product(p, jacobian, false);
        let entry = |(i, j): (usize, usize)| {
            let sum = frame.add(&turned[i][j], &turned[j][i]);
            let sum = if i == j { frame.add(&sum, &frame.rational(c_x)) } else { sum };
            (i, j, negated(&sum))
        };
        (0..p.len()).flat_map(|i| (i..p.len()).map(move |j| (i, j))).map(entry).collect()
    }

    /// `-(P' + P J + J^T P + 2 value P)`.
    pub(super) fn decay(&self, kind: Bound, jacobian: &[Vec<Centred>], value: &Centred) -> Option<SymmetricValues> {
        let frame = self.frame;
        let [p, derivative] = self.time.matrices[usize::from(kind == Bound::RateExistence)].as_ref()?;
        let order = jacobian.len();
        let rate = frame.scale(value, &Enclosure::from_integer(2, PRECISION));
        let moved = |value: &Centred| self.chart.moving(frame, value);
        let entry = |i: usize, j: usize| {
            let start = frame.add(&moved(&derivative[i][j]), &frame.mul(&moved(&p[i][j]), &rate));
            let sum = (0..order).fold(start, |sum, k| {
                // 0 times what may be undefined is undefined.
                let vanishes = |p: &Centred, slope: &Centred| p.is_zero() && slope.range.is_defined();
                let (left, down) = (&p[i][k], &jacobian[k][j]);
                let (right, across) = (&p[k][j], &jacobian[k][i]);
                let sum = if vanishes(left, down) { sum } else { frame.add(&sum, &frame.mul(&moved(left), down)) };
                if vanishes(right, across) { sum } else { frame.add(&sum, &frame.mul(across, &moved(right))) }
            });
            frame.scale(&sum, &Enclosure::from_integer(-1, PRECISION))
        };
        let entries = (0..order).flat_map(|i| (i..order).map(move |j| (i, j)));
        let entries = entries.map(|(i, j)| (i, j, entry(i, j))).collect();
        Some(SymmetricValues { order, entries })
    }
}
