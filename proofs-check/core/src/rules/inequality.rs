//! The matrix inequalities of a certificate over the derivatives of a plant (docs/mathematics.md, section 13.7), read in one form: (M), (Jm) and (E), and
//! those of a regulator at samples. Whoever reads a plant's formulas proves them: the crate `proofs-plants`.
//!
//! A metric has the matrix `Pi = [P p; p' w]` and `k_p`: its function is `V = (x,e)'Pi(x,e) + (k_p mu/2)|zeta|_N^2`. Along the loop, with
//! y = q + mu s, -V' is the form at (x, e, y) of
//! `F_sigma(Pi, k_p) = [-(P' + P J + J'P), -(P g - sigma p) - J'p, -p - (k_p/2) r'; ., 2 sigma w - 2 p'g, -w - (k_p/2) d; ., ., k_p]`.
//! An inequality says that it is not below `diag(c_x I, c_e, c_y)`, for all derivatives J, g, r, d at one point of `|y| <= X`, `|e| <= E`; with
//! a splitting for (J, r) at a point with X and the E of the splitting, and (g, d) at a point with E and the X of the splitting. What a kind
//! of inequality does not have is 0, or the weights of the witness.
//!
//! The near metric of two, `Pi_1 = [P_1 p; p' w_1]`, `k_1` has `F_sigma_0 >= diag(c_x I, c_e, c_y)` at the threshold sigma_0. The far one, `P_2`, `w_2`,
//! `k_2` without p, has the same, with numbers of its own, of
//! `G = [-(P_2 J + J'P_2), -(P_2 g - sigma_0 p), -(k_2/2) r'; ., 2 sigma_0 (w_1 + w_2), -w_2 - (k_2/2) d; ., ., k_2]`.
//! At `sigma' = sigma_0/l`, `0 < l <= 1`, take `Pi = l Pi_1 + (1 - l) diag(P_2, w_2)` and `k_p = l k_1 + (1 - l) k_2`: entry by entry
//! `F_sigma' = l F_sigma_0 + (1 - l) G + diag(0, 2 sigma_0 w_2 (1 - l)^2/l, 0)`, so with `w_2 >= 0` F_sigma' is not below
//! `l diag(c_1) + (1 - l) diag(c_2)`. The two matrices prove the inequality for sigma_0 and for every larger gain.
//!
//! Guarantee of the one of stability: with [`Inequality::conditions`], and the inequality proved, what C5 is there for holds at every gain from sigma on: U
//! (with two metrics V, `joint`) decreases in the error box. What the one of existence says of a solution is in `existence`.
//!
//! With an input gain (section 13.1) F has `d + (1-b) threshold` in the place of d, at both ends of b, in which it is affine, and C5B says
//! that L, its part in e and y with d = 0, is positive definite. At `sigma' = threshold/l`, 0 < l < 1, the weight l h serves, with b l h for
//! zeta: in `(x/sqrt(l), e/sqrt(l), y sqrt(l))` the form is l times F, and (1 - l) L besides. So it is not below
//! `2 w_x rate P` for x, and definite in e and y: U decreases, and C4 with b_hi h is more than what its level needs.
//!
//! At samples `e(s) = (1 - s sigma) e_k + s y + G` from a sample on, with `G' = q - mean q`, and G vanishes at both ends, so
//! `lambda (avg G^2 - (t/pi)^2 avg q^2) <= 0` may be added to what U loses over t. The sum is the average over s of a form in (x, e_k, y, G), the
//! least over w of `F_{t,s}`. It does not increase with t, and `F_{h,s}` is affine in s and in (J, g, r, d): so it is not negative where `F_{h,0}` and
//! `F_{h,h}` are semidefinite at every t and every point. Of the one of stability `F_{h,s} >= diag(2 w_x rate P, c_e, c_y, 0, 0)` in (x, e_k, y, G, w): in the
//! error box `U^t <= U_k` for 0 < t <= h, and U falls over a step by `h rho (rms(x)^2 + e_k^2 + y^2)` at least, for some rho > 0 (rate, c_e, c_y > 0).
//! For convergence as in section 12.3 it takes no more: q is `r x + d e` with bounded r and d, and `G(h) = 0` makes its mean a bounded function of x,
//! e_k and y, whatever h d is. Of the one of existence `F_{h,s} >= c_x |x|^2 + c_e e(s)^2 + c_y y^2 - gamma q_0^2` in (x, e_k, y, G, w, q_0), with `q + q_0` for q.

use super::paths::{Path, Paths};
use super::stability::ErrorBox;
use crate::data::Data;
use crate::input_gain;
use crate::interval::Interval;
use crate::json::{Field, Fields};
use crate::matrix::{Matrix, is_symmetric};
use crate::verdict::{Condition, Outcome, Verdict, bad, finding};
use rug::Rational;

/// What an inequality is there for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Stability in the place of C5, with the metric of U.
    Matrix,
    /// Stability and its level, with two metrics.
    Joint,
    /// Existence of the periodic solution, with one metric or two.
    Existence,
}

impl Kind {
    /// The name of the rule.
    pub fn rule(self) -> &'static str {
        match self {
            Kind::Matrix => "matrix inequality",
            Kind::Joint => "joint inequality",
            Kind::Existence => "existence inequality",
        }
    }

    /// The name of the part in a witness.
    fn part(self) -> String {
        self.rule().replace(' ', "_")
    }
}

/// An inequality, its place in the file, and where it is proved.
#[derive(Clone, Debug)]
pub struct Inequality {
    pub kind: Kind,
    pub pointer: String,
    /// X and E.
    pub at: [Rational; 2],
    /// The threshold: the gain that it is proved for. At samples it is that of the law.
    pub sigma: Rational,
    pub at_samples: bool,
    /// The one metric, or the near one of two.
    pub metric: Metric,
    pub far: Option<Metric>,
    pub splitting: Option<Splitting>,
}

/// The numbers of a metric.
#[derive(Clone, Debug)]
pub struct Metric {
    pub p: P,
    /// The weight of e^2.
    pub w: Rational,
    /// `k_p/2`; with the P of the triple h, which is that times mu, at samples times K.
    pub half: Rational,
    /// The p of a near metric, as long as its P; else empty.
    pub cross: Vec<Rational>,
    /// c_x, c_e, c_y.
    pub least: [Rational; 3],
    /// At samples, else 0.
    pub lambda: Rational,
    /// gamma, where `q_0` stands beside q.
    pub gamma: Option<Rational>,
    /// Of a metric of stability.
    pub extent: Option<Extent>,
}

/// The P of a metric.
#[derive(Clone, Debug)]
pub enum P {
    /// `w_x` times that of the triple, with J + `rate` I in the place of J.
    Triple { w_x: Rational, rate: Rational },
    /// One of its own, by rows, of any sign. That it has one for each state is seen where the formulas are.
    Own(Matrix),
}

/// `P <= p_up I`, `Pi >= diag(x_low I, 0)` and `Pi >= diag(0, e_low)`. Without states the first two say nothing, so that p_up has to be
/// above 0 by itself.
#[derive(Clone, Debug)]
pub struct Extent {
    pub p_up: Rational,
    pub x_low: Rational,
    pub e_low: Rational,
}

/// S in (x, y), which `F` without e is not below, and which leaves `[[S, v], [v', 2 sigma]] >= 0` for the column v of e.
#[derive(Clone, Debug)]
pub struct Splitting {
    pub at: [Rational; 2],
    pub matrix: Matrix,
}

/// Those of a witness: at most one of stability, and one of existence.
#[derive(Clone, Debug)]
pub struct List {
    pub stability: Option<Inequality>,
    pub existence: Option<Inequality>,
}

/// The rows of a symmetric matrix of any order.
pub(super) fn symmetric(rows: &Field<'_>) -> Outcome<Matrix> {
    let matrix = rows.list(|row| row.list(Field::rational))?;
    let is_square = matrix.iter().all(|row| row.len() == matrix.len());
    if is_square && is_symmetric(&matrix) { Ok(matrix) } else { bad(&rows.pointer, "expected a symmetric matrix") }
}

/// X and E, which are not negative.
fn place(fields: &mut Fields<'_>) -> Outcome<[Rational; 2]> {
    fields.each(["X", "E"], |fields, name| number(fields, name, false))
}

/// A number above 0, or one that is not negative.
pub(super) fn number(fields: &mut Fields<'_>, name: &str, positive: bool) -> Outcome<Rational> {
    let field = fields.required(name)?;
    let value = field.rational()?;
    match value > 0 || (!positive && value == 0) {
        true => Ok(value),
        false => bad(&field.pointer, if positive { "expected a number above 0" } else { "it is negative" }),
    }
}

/// That a rational is at most another: their difference is exact, so equality is decided.
pub(super) fn not_above(d: &Data<'_>, id: &'static str, what: String, [inner, outer]: [&Rational; 2]) -> Condition {
    Condition::at_most(id, format!("{what} <= 0"), d.number(&Rational::from(inner - outer)), d.int(0))
}

impl Metric {
    /// Takes its numbers out of a part; `of_two`: whether it is the near one of two, or the far one. `weights`: w_x and h of the witness.
    pub(super) fn read(
        fields: &mut Fields<'_>,
        (kind, at_samples): (Kind, bool),
        of_two: Option<bool>,
        [w_x, h]: [&Rational; 2],
    ) -> Outcome<Metric> {
        let own = kind != Kind::Matrix;
        let known = |name: &str, fields: &mut Fields<'_>, is_there: bool| {
            if is_there { number(fields, name, true) } else { Ok(Rational::new()) }
        };
        let p = match own {
            true => P::Own(symmetric(&fields.required("P")?)?),
            false => P::Triple { w_x: w_x.clone(), rate: number(fields, "rate", true)? },
        };
        let half = if own { number(fields, "k_p", true)? / 2u32 } else { h.clone() };
        let w = match of_two {
            None => Rational::from(1),
            Some(true) => fields.number("w")?,
            Some(false) => number(fields, "w", false)?,
        };
        let least = [
            known("c_x", fields, own)?,
            known("c_e", fields, at_samples || of_two.is_some())?,
            known("c_y", fields, at_samples || own)?,
        ];
        let lambda = known("lambda", fields, at_samples)?;
        let gamma = if at_samples && own { Some(number(fields, "gamma", true)?) } else { None };
        let mut extent = None;
        if kind == Kind::Joint {
            let [p_up, x_low, e_low] =
                fields.each(["P_up", "x_low", "e_low"], |fields, name| number(fields, name, true))?;
            extent = Some(Extent { p_up, x_low, e_low });
        }
        let mut metric = Metric { p, w, half, cross: Vec::new(), least, lambda, gamma, extent };
        if of_two == Some(true) {
            let cross = fields.required("p")?;
            metric.cross = cross.list(Field::rational)?;
            if !metric.has_order(metric.cross.len()) {
                return bad(&cross.pointer, "expected a number for each row of P");
            }
        }
        Ok(metric)
    }

    fn has_order(&self, order: usize) -> bool {
        match &self.p {
            P::Triple { .. } => true,
            P::Own(rows) => rows.len() == order,
        }
    }
}

/// The share of the weight of `|zeta|_N^2` in what falls by an inequality, where there is a gain: its threshold over sigma (section 13.1, Theorem G3).
pub fn share(d: &Data<'_>, stability: Option<&Inequality>, sigma: &Rational) -> Interval {
    match stability {
        Some(part) if d.gain.is_some() => d.number(&part.sigma) / d.number(sigma),
        _ => d.int(1),
    }
}

impl Inequality {
    /// Reads a part, beside w_x and h of its witness; `law`: sigma of a regulator at samples.
    pub fn read(field: &Field<'_>, kind: Kind, weights: [&Rational; 2], law: Option<&Rational>) -> Outcome<Inequality> {
        let at_samples = law.is_some();
        let of = (kind, at_samples);
        field.object(|fields| {
            let two = kind == Kind::Joint || (kind == Kind::Existence && !at_samples && fields.has("near"));
            let mut one = |name: &str, of_two| {
                fields.required(name)?.object(|fields| Metric::read(fields, of, Some(of_two), weights))
            };
            let (metric, far) = match two {
                true => (one("near", true)?, Some(one("far", false)?)),
                false => (Metric::read(fields, of, None, weights)?, None),
            };
            let splitting = |field: &Field<'_>| {
                field.object(|fields| {
                    let matrix = symmetric(&fields.required("S")?)?;
                    Ok(Splitting { at: place(fields)?, matrix })
                })
            };
            Ok(Inequality {
                kind,
                pointer: field.pointer.clone(),
                at: place(fields)?,
                sigma: law.map_or_else(|| number(fields, "sigma", true), |sigma| Ok(sigma.clone()))?,
                at_samples,
                metric,
                far,
                splitting: if kind == Kind::Matrix && !at_samples {
                    fields.part("splitting", splitting)?
                } else {
                    None
                },
            })
        })
    }

    /// Its metrics.
    pub fn metrics(&self) -> impl Iterator<Item = &Metric> {
        [&self.metric].into_iter().chain(&self.far)
    }

    /// Whether it is about these w_x and h.
    pub fn is_for(&self, [of_x, h]: [&Rational; 2]) -> bool {
        matches!(&self.metric.p, P::Triple { w_x, .. } if w_x == of_x) && self.metric.half == *h
    }

    /// (X, E) of (J, r), and of (g, d).
    pub fn arguments(&self) -> [[&Rational; 2]; 2] {
        let ([x, e], [other_x, other_e]) = (&self.at, self.splitting.as_ref().map_or(&self.at, |other| &other.at));
        [[x, other_e], [other_x, e]]
    }

    /// That every P has a row for each state, and S one more.
    pub fn demand_order(&self, states: usize) -> Outcome<()> {
        let names = if self.far.is_some() { ["/near", "/far"] } else { [""; 2] };
        if let Some((_, name)) = self.metrics().zip(names).find(|(metric, _)| !metric.has_order(states)) {
            return bad(&format!("{}{name}/P", self.pointer), "expected a row for each state");
        }
        match self.splitting.as_ref().filter(|splitting| splitting.matrix.len() != states + 1) {
            Some(_) => bad(&format!("{}/splitting/S", self.pointer), "expected a row for each state, and one more"),
            None => Ok(()),
        }
    }

    /// That the error box around a periodic solution of the sizes `periodic` lies where it is proved, on the path of f and q, and
    /// that the gain that is named is enough. Where their paths differ, the straight one is open to both.
    pub fn conditions(
        &self,
        d: &Data<'_>,
        (paths, [x_per, e_per], error_box): (Paths, [&Interval; 2], &ErrorBox),
        named: (&Rational, &str),
    ) -> Vec<Condition> {
        let path = if paths.f == paths.q { paths.f } else { Path::Straight };
        let (ErrorBox { x_b, e_b, .. }, [x, e]) = (error_box, &self.at);
        let within =
            |name, what: String, inner: &Interval, end| Condition::at_most(name, what, inner.clone(), d.number(end));
        let rule = self.kind.rule();
        let mut conditions = vec![
            within("C5x", format!("X_b <= X of the {rule}"), x_b, x),
            within("C5e", format!("E_b <= E of the {rule}"), e_b, e),
        ];
        if let Some(Splitting { at: [x, e], .. }) = &self.splitting {
            let (of_dx, of_de) = (path.e_at_dx(e_per, e_b), path.x_at_de(x_per, x_b));
            conditions.push(within("C5j", "E of df/dx <= E of the splitting".to_owned(), of_dx, e));
            conditions.push(within("C5g", "X of df/de <= X of the splitting".to_owned(), of_de, x));
        }
        if !self.at_samples {
            conditions.extend(self.enough(d, named));
        }
        conditions
    }

    /// C5m, or E3: that the threshold is below a gain; C5s, or E3, with two metrics, where it may be that gain: c_x, c_e and c_y are above 0.
    /// With an input gain C5B, or E4: with 0 for d the part of e and y is definite, or not below `diag(0, c_y)`.
    pub fn enough(&self, d: &Data<'_>, (sigma, name): (&Rational, &str)) -> Vec<Condition> {
        let id = match self.kind {
            Kind::Matrix => "C5m",
            Kind::Joint => "C5s",
            Kind::Existence => "E3",
        };
        let what = format!("threshold of the {}", self.kind.rule());
        let exceeded = match self.far {
            Some(_) => not_above(d, id, format!("{what} - sigma"), [&self.sigma, sigma]),
            None => Condition::less(id, format!("{what} < {name}"), d.number(&self.sigma), d.number(sigma)),
        };
        [exceeded].into_iter().chain(self.undamped(d)).collect()
    }

    fn undamped(&self, d: &Data<'_>) -> Option<Condition> {
        let gain = d.gain.as_ref().filter(|_| self.far.is_none())?;
        let [half, c_y, threshold] =
            [&self.metric.half, &self.metric.least[2], &self.sigma].map(|value| d.number(value));
        Some(if self.kind == Kind::Matrix {
            let [undamped, room] = gain.undamped(&(half / &d.mu), &threshold);
            let what = "(1 + ht (1-b) threshold)^2 < 4 ht threshold at both ends of b, ht = h/mu";
            Condition::less("C5B", what, undamped, room)
        } else {
            let [undamped, room] = gain.undamped(&half, &threshold);
            let what = "(1 + (k_p/2) (1-b) threshold)^2 <= 2 threshold (k_p - c_y) at both ends of b";
            Condition::at_most("E4", what, undamped, room - threshold * c_y * 2)
        })
    }
}

impl List {
    /// Takes them out of a witness with these w_x and h; `law`: sigma of a regulator at samples, of which stability has no two metrics.
    pub fn read(fields: &mut Fields<'_>, weights: [&Rational; 2], law: Option<&Rational>) -> Outcome<List> {
        let read = |kind: Kind| move |field: &Field<'_>| Inequality::read(field, kind, weights, law);
        let existence = fields.part(&Kind::Existence.part(), read(Kind::Existence))?;
        let of_stability = if law.is_none() { &[Kind::Matrix, Kind::Joint][..] } else { &[Kind::Matrix] };
        let there: Vec<Kind> = of_stability.iter().copied().filter(|kind| fields.has(&kind.part())).collect();
        let stability = match there[..] {
            [] => None,
            [kind] => fields.part(&kind.part(), read(kind))?,
            _ => {
                let at = format!("{}/{}", fields.pointer, Kind::Joint.part());
                return bad(&at, "it has no place beside `matrix_inequality`");
            }
        };
        Ok(List { stability, existence })
    }

    /// All that there are.
    pub fn all(&self) -> impl Iterator<Item = &Inequality> {
        self.stability.iter().chain(&self.existence)
    }

    /// That an inequality stands beside the formulas that it is about, with a row for each of their states.
    pub fn demand(&self, d: &Data<'_>) -> Outcome<()> {
        self.all().try_for_each(|part| match &d.spec.plant {
            Some(plant) => part.demand_order(plant.states),
            None => bad(&part.pointer, "a matrix inequality is about the formulas of a plant"),
        })
    }

    /// With two metrics nothing is proved about a gain.
    pub fn without_gain(&self, d: &Data<'_>) -> Outcome<()> {
        match self.all().find(|part| part.far.is_some() && d.gain.is_some()) {
            None => Ok(()),
            Some(part) => {
                let message = "two metrics are not available with `input_gain`: nothing is proved of them";
                Err(finding(Verdict::Undecided, input_gain::RULE, &part.pointer, message))
            }
        }
    }
}
