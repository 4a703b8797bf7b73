//! The coordinates in which a bound is decided: only those that its formulas depend on.
//!
//! Boxes lie in the cube of s = t/T in [0, 1], of y in [-1, 1]^m, of e/E in [-1, 1] and of each parameter of a family, brought to
//! [-1, 1] too; `x = xb(t;p) + (X + r) C y`. With C = L the tube is exactly `|y| <= 1`, and boxes outside of this ball are left out. Where the formulas depend on some states A alone, C
//! has as many columns, with `C C^T >= L_A L_A^T`: then `{L_A y : |y| <= 1}` lies in `{C y : |y| <= 1}`, as
//! the support functions `|L_A^T g| <= |C^T g|` say. Where they depend on one state and not on t, that state moves through an
//! interval: the union of the projections of the tube at all t.

use super::PRECISION;
use super::centred::{Centred, Frame};
use super::region::Region;
use super::side::Side;
use super::time_cell::TimeCell;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::expr::{MAX_STATES, MAX_VARIED, PlantVariable, Walk};
use sigmastar_lang::spec::{Interval, TrigonometricVector};
use sigmastar_matrix::is_positive_definite;

/// How often a side is halved at most.
pub(super) const MAX_LEVEL: u32 = 40;

/// What a Cholesky factor in doubles is enlarged by, so that it is one from above.
const ENLARGEMENT: f64 = 1.0 + 1e-9;

/// How states follow from the coordinates.
#[derive(Clone, Debug)]
enum States {
    /// No formula depends on a state.
    None,
    /// One state in an interval.
    Interval { index: usize, middle: Rational, half: Rational },
    /// These states, with the rows of `(X + r) C`.
    Tube { active: Vec<usize>, shape: Vec<Vec<Rational>> },
}

/// The coordinates of a decision.
#[derive(Clone, Debug)]
pub(super) struct Chart {
    /// Whether s is the first coordinate.
    pub(super) time: bool,
    states: States,
    /// E, where e is a coordinate: the one after those of the states.
    error: Option<Rational>,
    /// The parameters that are the last coordinates.
    parameters: Vec<Axis>,
    /// The number of parameters of the plant.
    count: usize,
    period: Enclosure,
    /// The number of states of the plant.
    order: usize,
    /// X + r.
    radius: Rational,
}

/// A parameter as a coordinate.
#[derive(Clone, Debug)]
struct Axis {
    index: usize,
    nominal: Rational,
    /// The middle of the interval less the nominal value.
    offset: Rational,
    half: Rational,
}

/// A box in the coordinates.
pub(super) type Cell = Vec<Side>;

/// The variables on a box.
#[derive(Clone, Debug)]
pub(super) struct Placed {
    pub(super) frame: Frame,
    pub(super) t: Centred,
    pub(super) x: Vec<Centred>,
    pub(super) e: Centred,
    /// The parameters of which intervals are known.
    pub(super) p: Vec<Centred>,
}

/// The unit ball in the coordinates of a box: which of them, and where the box lies in them.
#[derive(Clone, Debug)]
pub(super) struct Ball {
    /// For each coordinate: whether it is one of the ball.
    pub(super) member: Vec<bool>,
    /// The low end, the middle and the high end of each coordinate.
    pub(super) ends: Vec<[Enclosure; 3]>,
}

impl Ball {
    /// Whether the middle of the box certainly lies in the ball.
    pub(super) fn has_its_middle(&self) -> bool {
        let squares = self.ends.iter().zip(&self.member).filter(|(_, member)| **member);
        let square = squares.fold(Enclosure::zero(PRECISION), |sum, ([_, middle, _], _)| sum + middle.sqr());
        square.le(&Enclosure::one(PRECISION)).is_true()
    }
}

/// Which variables formulas depend on.
#[derive(Clone, Debug)]
pub(super) struct Active {
    pub(super) time: bool,
    pub(super) states: Vec<usize>,
    pub(super) error: bool,
    /// Parameters of which intervals are known. Those that move the orbit matter as well where a state does.
    pub(super) parameters: Vec<usize>,
}

impl Active {
    /// The variables that some formulas use.
    pub(super) fn of(walk: &Walk) -> Active {
        let used = walk.all_variables();
        Active {
            time: used.has(PlantVariable::Time),
            states: (0..MAX_STATES).filter(|index| used.has(PlantVariable::State(*index))).collect(),
            error: used.has(PlantVariable::Error),
            parameters: (0..MAX_VARIED).filter(|index| used.has(PlantVariable::Parameter(*index))).collect(),
        }
    }
}

impl Chart {
    /// The coordinates for `G(X,E)`. `extent` gives for a state an interval that contains xb at all t and p.
    pub(super) fn new(
        (region, intervals): (&Region, &[Interval]),
        period: Enclosure,
        active: &Active,
        [x, e]: [&Rational; 2],
        extent: impl Fn(usize) -> [Rational; 2],
    ) -> Chart {
        let radius = Rational::from(x + region.radius());
        let order = region.states();
        let error = active.error.then(|| e.clone());
        let steady = region.orbit().harmonics() == 0;
        let states = match active.states[..] {
            [] => States::None,
            [index] if !active.time => {
                let [low, high] = extent(index);
                let reach = norm_above(&region.matrix()[index]) * &radius;
                let half = Rational::from(&high - &low) / 2u32 + reach;
                States::Interval { index, middle: (low + high) / 2u32, half }
            }
            _ => {
                let rows: Vec<Vec<Rational>> =
                    active.states.iter().map(|&index| region.matrix()[index].clone()).collect();
                let scaled = |row: Vec<Rational>| row.into_iter().map(|entry| entry * &radius).collect();
                let shape = factor_above(rows).into_iter().map(scaled).collect();
                States::Tube { active: active.states.clone(), shape }
            }
        };
        let in_tube = matches!(states, States::Tube { .. });
        let moving = in_tube && !steady;
        let moves = |part: &TrigonometricVector| {
            !part.harmonics.is_empty() || active.states.iter().any(|state| !part.mean[*state].is_zero())
        };
        let axis = |(index, interval): (usize, &Interval)| {
            let moves = in_tube && region.orbit().sensitivities.get(index).is_some_and(moves);
            let Interval { nominal, low, high } = interval;
            (moves || active.parameters.contains(&index)).then(|| Axis {
                index,
                nominal: nominal.clone(),
                offset: Rational::from(low + high) / 2u32 - nominal,
                half: Rational::from(high - low) / 2u32,
            })
        };
        let parameters = intervals.iter().enumerate().filter_map(axis).collect();
        let count = intervals.len();
        Chart { time: active.time || moving, states, error, parameters, count, period, order, radius }
    }

    /// Whether every point of the ball is one of the tube: that is so with C = L, not with fewer coordinates.
    pub(super) fn is_exact(&self) -> bool {
        match &self.states {
            States::None => true,
            States::Interval { .. } => false,
            States::Tube { active, shape } => {
                active.len() == self.order && shape.first().is_some_and(|row| row.len() == self.order)
            }
        }
    }

    fn ball_sides(&self) -> usize {
        match &self.states {
            States::Tube { shape, .. } => shape.first().map_or(0, Vec::len),
            States::None | States::Interval { .. } => 0,
        }
    }

    /// The number of coordinates.
    pub(super) fn sides(&self) -> usize {
        let states = match self.states {
            States::None => 0,
            States::Interval { .. } => 1,
            States::Tube { .. } => self.ball_sides(),
        };
        usize::from(self.time) + states + usize::from(self.error.is_some()) + self.parameters.len()
    }

    /// The unit ball on a box; `None` if the box certainly lies outside of it.
    pub(super) fn ball(&self, cell: &Cell) -> Option<Ball> {
        let first = usize::from(self.time);
        let member: Vec<bool> = (0..cell.len()).map(|i| (first..first + self.ball_sides()).contains(&i)).collect();
        let exact = |value: &Rational| Enclosure::from_rational(value, PRECISION);
        let ends: Vec<[Enclosure; 3]> = cell
            .iter()
            .enumerate()
            .map(|(i, side)| if self.time && i == 0 { side.unit() } else { side.symmetric() }.each_ref().map(exact))
            .collect();
        let nearest = ends.iter().zip(&member).filter(|(_, member)| **member).map(|([low, _, high], _)| {
            // The square over the side: its least value is that of the point nearest to 0.
            low.hull(high).sqr()
        });
        let squares = nearest.fold(Enclosure::zero(PRECISION), |sum, square| sum + square);
        let outside = squares.gt(&Enclosure::one(PRECISION)).is_true();
        (!outside).then_some(Ball { member, ends })
    }

    /// The variables on a box, given what depends on t alone there.
    pub(super) fn place(&self, cell: &Cell, ball: &Ball, time: Option<&TimeCell>) -> Placed {
        let half = |(i, side): (usize, &Side)| {
            let half = side.half();
            Enclosure::from_rational(&if self.time && i == 0 { half } else { half * 2 }, PRECISION)
        };
        let frame = Frame { halves: cell.iter().enumerate().map(half).collect(), precision: PRECISION };
        let sides = frame.sides();
        let undefined = || frame.constant(Enclosure::undefined(PRECISION));
        // The product of a coordinate and a number.
        let coordinate = |index: usize, factor: &Enclosure| {
            let [low, middle, high] = &ball.ends[index];
            let mut slopes = vec![None; sides];
            slopes[index] = Some(factor.clone());
            Centred { centre: middle * factor, range: low.hull(high) * factor, slopes }
        };
        let t = if self.time { coordinate(0, &self.period) } else { undefined() };
        let e = match &self.error {
            Some(bound) => coordinate(sides - 1 - self.parameters.len(), &Enclosure::from_rational(bound, PRECISION)),
            None => undefined(),
        };
        let first = usize::from(self.time);
        // p_i - p_i^0 and p_i.
        let mut deviations = vec![None; self.count];
        let mut p = vec![undefined(); self.count];
        for (place, axis) in self.parameters.iter().enumerate() {
            let varied =
                coordinate(sides - self.parameters.len() + place, &Enclosure::from_rational(&axis.half, PRECISION));
            let deviation = frame.add(&frame.rational(&axis.offset), &varied);
            p[axis.index] = frame.add(&frame.rational(&axis.nominal), &deviation);
            deviations[axis.index] = Some(deviation);
        }
        let mut x = vec![undefined(); self.order];
        match &self.states {
            States::None => {}
            States::Interval { index, middle, half } => {
                let half = Enclosure::from_rational(half, PRECISION);
                x[*index] = frame.add(&frame.rational(middle), &coordinate(first, &half));
            }
            States::Tube { active, shape } => {
                for (index, row) in active.iter().zip(shape) {
                    let start = match time {
                        Some(time) => {
                            let centre = self.moving(&frame, &time.orbit[*index]);
                            let parts = time.sensitivities.iter().zip(&deviations);
                            parts.fold(centre, |sum, (part, deviation)| match deviation {
                                Some(deviation) => {
                                    frame.add(&sum, &frame.mul(&self.moving(&frame, &part[*index]), deviation))
                                }
                                // It moves none of these states.
                                None => sum,
                            })
                        }
                        None => undefined(),
                    };
                    let terms = row.iter().enumerate().filter(|(_, entry)| !entry.is_zero());
                    x[*index] = terms.fold(start, |sum, (column, entry)| {
                        frame.add(&sum, &coordinate(first + column, &Enclosure::from_rational(entry, PRECISION)))
                    });
                }
            }
        }
        Placed { frame, t, x, e, p }
    }

    /// What `|L^-1 (x - xb)|` is not below: X + r times the distance from the centre of the ball; 0 where states are in no
    /// ball. With fewer columns than states `L_A y = C s` has a solution with `|s| <= |y|`, so that it is none below either.
    pub(super) fn distance(&self, frame: &Frame, ball: &Ball) -> Centred {
        let radius = Enclosure::from_rational(&self.radius, PRECISION);
        frame.scale(&frame.norm(&ball.ends, &ball.member), &radius)
    }

    /// A value that depends on t alone, among the others.
    pub(super) fn moving(&self, frame: &Frame, value: &Centred) -> Centred {
        let mut slopes = vec![None; frame.sides()];
        if self.time
            && let Some(slope) = value.slopes.first()
        {
            slopes[0].clone_from(slope);
        }
        Centred { centre: value.centre.clone(), range: value.range.clone(), slopes }
    }
}

/// A rational that is not below the Euclidean norm.
pub(super) fn norm_above(row: &[Rational]) -> Rational {
    let square = row.iter().fold(Rational::new(), |sum, entry| sum + Rational::from(entry.square_ref()));
    let root = Enclosure::from_rational(&square, PRECISION).sqrt().upper_rational();
    // Without a root that is exact: the sum of the magnitudes.
    root.unwrap_or_else(|| row.iter().fold(Rational::new(), |sum, entry| sum + Rational::from(entry.abs_ref())))
}

/// A matrix C with `C C^T >= rows rows^T`, with no more columns than rows where one is found.
fn factor_above(rows: Vec<Vec<Rational>>) -> Vec<Vec<Rational>> {
    let columns = rows.first().map_or(0, Vec::len);
    if rows.len() >= columns {
        return rows;
    }
    if let [row] = &rows[..] {
        return vec![vec![norm_above(row)]];
    }
    let product = |a: &[Rational], b: &[Rational]| {
        a.iter().zip(b).fold(Rational::new(), |sum, (a, b)| sum + Rational::from(a * b))
    };
    let gram: Vec<Vec<Rational>> = rows.iter().map(|a| rows.iter().map(|b| product(a, b)).collect()).collect();
    let factor = cholesky(&gram);
    let excess = factor.as_ref().map(|factor| {
        let order = rows.len();
        (0..order)
            .map(|i| (0..order).map(|j| product(&factor[i], &factor[j]) - &gram[i][j]).collect())
            .collect::<Vec<Vec<Rational>>>()
    });
    match (factor, excess) {
        (Some(factor), Some(excess)) if is_positive_definite(&excess) => factor,
        _ => rows,
    }
}

/// A lower triangular factor in doubles, a little enlarged; exact rationals, but nothing is claimed of them.
fn cholesky(gram: &[Vec<Rational>]) -> Option<Vec<Vec<Rational>>> {
    let order = gram.len();
    let mut factor = vec![vec![0.0_f64; order]; order];
    for i in 0..order {
        for j in 0..=i {
            let rest: f64 = gram[i][j].to_f64() - (0..j).map(|k| factor[i][k] * factor[j][k]).sum::<f64>();
            factor[i][j] = if i == j { rest.sqrt() } else { rest / factor[j][j] };
        }
    }
    factor.iter().map(|row| row.iter().map(|entry| Rational::from_f64(entry * ENLARGEMENT)).collect()).collect()
}
