//! All bounds at one point in doubles: norms of derivatives in the coordinates y. They propose; nothing rests on them.

use sigmastar_exact::number::Portable;
use sigmastar_lang::spec::Bound;
use sigmastar_matrix::doubles::{largest, largest_of, product, roots};
use sigmastar_theory::evidence::TABLE;
use std::sync::Arc;

/// Where the outputs of the program of derivatives begin: f_x (rows) at 0, then f_e, q_x, q_e, q_tx, q_te, q_xx (rows), q_xe.
#[derive(Clone, Copy, Debug)]
struct Blocks {
    f_e: usize,
    q_x: usize,
    q_e: usize,
    q_tx: usize,
    q_te: usize,
    q_xx: usize,
    q_xe: usize,
}

impl Blocks {
    fn new(n: usize) -> Blocks {
        let f_e = n * n;
        let (q_x, q_e) = (f_e + n, f_e + 2 * n);
        let (q_tx, q_te) = (q_e + 1, q_e + 1 + n);
        Blocks { f_e, q_x, q_e, q_tx, q_te, q_xx: q_te + 1, q_xe: q_te + 1 + n * n }
    }
}

/// Which of [`TABLE`] are asked for: each kind costs something of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Asked(u8);

impl Asked {
    /// The norm of df/dx.
    const NORM: Asked = Asked(1);
    /// df/de, dq/dx and dq/de.
    const SLOPES: Asked = Asked(2);
    /// The derivatives of dq/dx and dq/de in time.
    const IN_TIME: Asked = Asked(4);
    /// The rate.
    const RATE: Asked = Asked(8);
    /// The rate of existence.
    const RATE_EXISTENCE: Asked = Asked(16);
    /// Everything.
    pub const ALL: Asked = Asked(31);
    /// Nothing.
    pub const NOTHING: Asked = Asked(0);
    /// What takes all first derivatives.
    pub const FIRST: Asked = Asked(Asked::NORM.0 | Asked::SLOPES.0 | Asked::RATE.0);
    /// What a set with a periodic solution asks for at the same (X, E) is of one group.
    pub const GROUPS: [Asked; 3] =
        [Asked(Asked::NORM.0 | Asked::RATE.0), Asked(Asked::SLOPES.0 | Asked::IN_TIME.0), Asked::RATE_EXISTENCE];

    /// The place in [`Asked::GROUPS`] of a bound of the table.
    #[must_use]
    pub fn group(bound: Bound) -> usize {
        match Asked::only(bound) {
            Asked::NORM | Asked::RATE => 0,
            Asked::RATE_EXISTENCE => 2,
            _ => 1,
        }
    }

    /// A bound of the table with what costs nothing beside it.
    #[must_use]
    pub fn only(bound: Bound) -> Asked {
        match bound {
            Bound::Fx => Asked::NORM,
            Bound::Qtx | Bound::Qte => Asked::IN_TIME,
            Bound::Rate => Asked::RATE,
            Bound::RateExistence => Asked::RATE_EXISTENCE,
            _ => Asked::SLOPES,
        }
    }

    fn has(self, other: Asked) -> bool {
        self.0 & other.0 != 0
    }

    /// Both.
    pub fn and(self, other: Asked) -> Asked {
        Asked(self.0 | other.0)
    }

    /// The number of the first outputs that it takes, with n states.
    pub fn outputs(self, n: usize) -> usize {
        let blocks = Blocks::new(n);
        match self {
            _ if self.has(Asked::IN_TIME) => blocks.q_xe + n,
            _ if self.has(Asked::SLOPES) => blocks.q_e + 1,
            _ => blocks.f_e,
        }
    }
}

/// P at one time, as it is used.
#[derive(Clone, Debug)]
pub enum MatrixAt {
    /// There is none.
    Missing,
    /// The identity.
    Identity,
    /// A constant one: its symmetric root and the inverse of that, by rows.
    Constant(Arc<[Vec<f64>; 2]>),
    /// P(t) and its derivative.
    Moving([Vec<Vec<f64>>; 2]),
}

/// J by rows, g, r and d at a point, in the coordinates y.
pub struct Derivatives<'a> {
    /// f_x by rows.
    pub j: &'a [f64],
    /// f_e.
    pub g: &'a [f64],
    /// q_x.
    pub r: &'a [f64],
    /// q_e.
    pub d: f64,
}

/// J by rows, g, r and d at a point, in the coordinates y: [`Derivatives`] that own their numbers.
#[derive(Clone, Debug)]
pub struct Slopes {
    /// f_x by rows.
    pub j: Vec<f64>,
    /// f_e.
    pub g: Vec<f64>,
    /// q_x.
    pub r: Vec<f64>,
    /// q_e.
    pub d: f64,
}

impl From<&Derivatives<'_>> for Slopes {
    fn from(Derivatives { j, g, r, d }: &Derivatives<'_>) -> Slopes {
        Slopes { j: j.to_vec(), g: g.to_vec(), r: r.to_vec(), d: *d }
    }
}

impl Slopes {
    /// The largest norms of g and of r.
    pub fn largest(points: &[Slopes]) -> [f64; 2] {
        let norm = |vector: &[f64]| vector.iter().map(|value| value * value).sum::<f64>().sqrt();
        let largest = |of: fn(&Slopes) -> &[f64]| points.iter().map(|point| norm(of(point))).fold(0.0, f64::max);
        [largest(|point| &point.g), largest(|point| &point.r)]
    }

    /// The unit of x, where e has 1 and time 1/value, in which those are of one size.
    pub fn unit(points: &[Slopes], value: f64) -> f64 {
        let [g, r] = Slopes::largest(points);
        match (g > 0.0, r > 0.0) {
            (true, true) => (g / r).sqrt(),
            (true, false) => g / value,
            (false, true) => value / r,
            (false, false) => 1.0,
        }
    }
}

/// The coordinates, with the memory that an evaluation works in.
#[derive(Clone, Debug)]
pub struct Pointwise {
    order: usize,
    /// How far x_0' may be from the velocity that it is given, in each component of the coordinates y.
    drift: f64,
    blocks: Blocks,
    matrix: Vec<f64>,
    inverse: Vec<f64>,
    /// f_x L, then L^-1 f_x L.
    product: Vec<f64>,
    jacobian: Vec<f64>,
    square: Vec<f64>,
    /// L^-1 f_e and q_x L.
    column: Vec<f64>,
    row: Vec<f64>,
}

impl Pointwise {
    pub fn new(matrix: &[Vec<f64>], inverse: &[Vec<f64>], drift: f64) -> Pointwise {
        let n = matrix.len();
        let room = vec![0.0; n * n];
        Pointwise {
            order: n,
            drift,
            blocks: Blocks::new(n),
            matrix: matrix.concat(),
            inverse: inverse.concat(),
            product: room.clone(),
            jacobian: room.clone(),
            square: room,
            column: vec![0.0; n],
            row: vec![0.0; n],
        }
    }

    /// What is to be bounded from above, in the order of [`TABLE`]: norms, q_e, the negatives of the local rates; NaN where
    /// there is no P, and for what is not asked for.
    pub fn at(
        &mut self,
        outputs: &[f64],
        velocity: &[f64],
        matrices: &[MatrixAt; 2],
        asked: Asked,
    ) -> [f64; TABLE.len()] {
        let (n, blocks) = (self.order, self.blocks);
        let mut values = [f64::NAN; TABLE.len()];
        if asked.has(Asked::SLOPES) {
            let column = &outputs[blocks.f_e..blocks.f_e + n];
            let entry = |i: usize| dot(&self.inverse[i * n..(i + 1) * n], column).portable_powi(2);
            values[1] = (0..n).map(entry).sum::<f64>().sqrt();
            values[2] = self.row_norm(|i| outputs[blocks.q_x + i]);
            let q_e = outputs[blocks.q_e];
            (values[3], values[4]) = (q_e.abs(), q_e);
        }
        if asked.has(Asked::IN_TIME) {
            values[5] = self.row_norm(|i| {
                let along = &outputs[blocks.q_xx + i * n..blocks.q_xx + (i + 1) * n];
                outputs[blocks.q_tx + i] + dot(along, velocity)
            });
            values[6] = (outputs[blocks.q_te] + dot(&outputs[blocks.q_xe..blocks.q_xe + n], velocity)).abs();
            if self.drift > 0.0 {
                let [of_x, of_e] = self.along_drift(outputs);
                values[5] += self.drift * of_x;
                values[6] += self.drift * of_e;
            }
        }
        if asked.has(Asked::NORM) || asked.has(Asked::RATE) || asked.has(Asked::RATE_EXISTENCE) {
            self.transform(outputs);
        }
        if asked.has(Asked::NORM) {
            values[0] = self.spectral_norm();
        }
        for (which, of) in [Asked::RATE, Asked::RATE_EXISTENCE].into_iter().enumerate() {
            if asked.has(of) {
                values[7 + which] = self.growth(&matrices[which]);
            }
        }
        values
    }

    /// J, g, r and d.
    pub fn derivatives(&mut self, outputs: &[f64]) -> Derivatives<'_> {
        let (n, blocks) = (self.order, self.blocks);
        self.transform(outputs);
        for i in 0..n {
            self.column[i] = dot(&self.inverse[i * n..(i + 1) * n], &outputs[blocks.f_e..blocks.f_e + n]);
            self.row[i] = (0..n).map(|k| outputs[blocks.q_x + k] * self.matrix[k * n + i]).sum();
        }
        Derivatives { j: &self.jacobian, g: &self.column, r: &self.row, d: outputs[blocks.q_e] }
    }

    /// L^-1 f_x L.
    fn transform(&mut self, outputs: &[f64]) {
        let n = self.order;
        for i in 0..n {
            for j in 0..n {
                self.product[i * n + j] = (0..n).map(|k| outputs[i * n + k] * self.matrix[k * n + j]).sum();
            }
        }
        for i in 0..n {
            for j in 0..n {
                self.jacobian[i * n + j] = (0..n).map(|k| self.inverse[i * n + k] * self.product[k * n + j]).sum();
            }
        }
    }

    /// How much the norm of `L^T q_xx L w` is at most, and `q_xe L w`, for `|w_j| <= 1` in each component.
    fn along_drift(&self, outputs: &[f64]) -> [f64; 2] {
        let (n, blocks) = (self.order, self.blocks);
        let column = |j: usize, of: &[f64]| (0..n).map(|k| of[k] * self.matrix[k * n + j]).sum::<f64>();
        let second = |i: usize, j: usize| {
            let row = |k: usize| column(j, &outputs[blocks.q_xx + k * n..blocks.q_xx + (k + 1) * n]);
            (0..n).map(|k| self.matrix[k * n + i] * row(k)).sum::<f64>().abs()
        };
        let of_row = |i: usize| (0..n).map(|j| second(i, j)).sum::<f64>().portable_powi(2);
        let of_e = (0..n).map(|j| column(j, &outputs[blocks.q_xe..blocks.q_xe + n]).abs()).sum();
        [(0..n).map(of_row).sum::<f64>().sqrt(), of_e]
    }

    /// |row L|.
    fn row_norm(&self, row: impl Fn(usize) -> f64) -> f64 {
        let n = self.order;
        let entry = |j: usize| (0..n).map(|i| row(i) * self.matrix[i * n + j]).sum::<f64>();
        (0..n).map(|j| entry(j).portable_powi(2)).sum::<f64>().sqrt()
    }

    fn spectral_norm(&mut self) -> f64 {
        let n = self.order;
        if n == 0 {
            return 0.0;
        }
        for i in 0..n {
            for j in 0..n {
                self.square[i * n + j] = (0..n).map(|k| self.jacobian[k * n + i] * self.jacobian[k * n + j]).sum();
            }
        }
        largest_of(&mut self.square, n).max(0.0).sqrt()
    }

    /// The least g with `P' + P J + J^T P <= 2 g P`.
    fn growth(&mut self, matrix: &MatrixAt) -> f64 {
        let n = self.order;
        match matrix {
            MatrixAt::Missing => f64::NAN,
            MatrixAt::Constant(roots) => {
                // With P = R R: half of R J R^-1 and of its transpose.
                let [root, inverse] = &**roots;
                for i in 0..n {
                    for j in 0..n {
                        self.product[i * n + j] = (0..n).map(|k| root[i * n + k] * self.jacobian[k * n + j]).sum();
                    }
                }
                let entry =
                    |i: usize, j: usize| -> f64 { (0..n).map(|k| self.product[i * n + k] * inverse[k * n + j]).sum() };
                for i in 0..n {
                    for j in 0..n {
                        self.square[i * n + j] = (entry(i, j) + entry(j, i)) / 2.0;
                    }
                }
                largest_of(&mut self.square, n)
            }
            MatrixAt::Moving([p, derivative]) => {
                let rows: Vec<Vec<f64>> = self.jacobian.chunks(n.max(1)).map(<[f64]>::to_vec).collect();
                growth(p, derivative, &rows)
            }
            MatrixAt::Identity => {
                for i in 0..n {
                    for j in 0..n {
                        self.square[i * n + j] = (self.jacobian[i * n + j] + self.jacobian[j * n + i]) / 2.0;
                    }
                }
                largest_of(&mut self.square, n)
            }
        }
    }
}

pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The largest eigenvalue of half of `P' + P J + J^T P` between roots of P.
fn growth(p: &[Vec<f64>], derivative: &[Vec<f64>], jacobian: &[Vec<f64>]) -> f64 {
    let n = p.len();
    let [_, root] = roots(p);
    let moved = product(p, jacobian);
    let form: Vec<Vec<f64>> =
        (0..n).map(|i| (0..n).map(|j| (derivative[i][j] + moved[i][j] + moved[j][i]) / 2.0).collect()).collect();
    largest(product(&root, &product(&form, &root)))
}
