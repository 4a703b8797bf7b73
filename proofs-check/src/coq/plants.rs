//! What a certificate knows of the formulas of a plant, as fields of the record `numbers` of `proofs-check/coq/Sizes.v`: the values of
//! its table that are used, each with the arguments up to which it holds.
//!
//! For which arguments a value is needed is settled here from the sizes that the claim states, and decided by Coq from those that it
//! computes.

use super::Parts;
use super::terms::{Fields, constant, number, option, unsupported};
use proofs_core::plant::OfPlant;
use proofs_core::plant::entries::{Entry, Name};
use proofs_core::rules::inequality::{Extent, Inequality, Metric, P};
use proofs_core::rules::joint::Pair;
use proofs_core::rules::paths::Path;
use proofs_core::verdict::Outcome;
use rug::Rational;

/// A value as Coq has it.
struct Value {
    up_to: [Rational; 2],
    value: String,
}

impl Value {
    /// An `entry` of Sizes.v.
    fn entry(&self) -> String {
        let [x, e] = self.up_to.each_ref().map(number);
        format!("{{| up_to_X := {x}; up_to_E := {e}; value := {} |}}", self.value)
    }

    /// A `bound` of Sizes.v, which is taken at one place alone.
    fn everywhere(&self) -> String {
        format!("fun _ _ => {}", self.value)
    }
}

/// Which entries answer.
struct Table<'a> {
    parts: &'a Parts,
    plant: &'a OfPlant,
}

impl Table<'_> {
    /// The best value at these arguments, if there is one. Without states every bound of x and f is 0, the rate is that of an empty P,
    /// and X has no meaning.
    fn given(&self, name: Name, at: [&Rational; 2]) -> Outcome<Option<Value>> {
        let of_entry = |entry: &Entry| Value { up_to: entry.written.clone(), value: number(&entry.value) };
        if self.plant.states > 0 {
            return Ok(self.plant.entries.exactly_at(name, at).map(of_entry));
        }
        // Beyond all arguments of a certificate.
        let free = &self.parts.free;
        let far =
            [&free.x_p + Rational::from(&free.x_p + &free.d_x), &free.e_p + Rational::from(&free.e_p + &free.d_e)];
        let value = match name {
            Name::Fx | Name::Fe | Name::Qx | Name::Qtx => "0".to_owned(),
            Name::Rate | Name::RateExistence => constant(&self.parts.spec.alpha, "/witness/lyapunov/alpha")?,
            Name::Qe | Name::QeMax | Name::Qte => {
                let entry = self.plant.entries.exactly_at(name, [&Rational::new(), at[1]]);
                let [far_x, _] = far;
                return Ok(entry.map(|entry| Value { up_to: [far_x, entry.written[1].clone()], ..of_entry(entry) }));
            }
        };
        Ok(Some(Value { up_to: far, value }))
    }

    /// A value that has to be there.
    fn at(&self, name: Name, at: [&Rational; 2]) -> Outcome<Value> {
        match self.given(name, at)? {
            Some(value) => Ok(value),
            None => {
                let [x, e] = at;
                unsupported("/witness/bounds", format!("no value of {name:?} is given for X = {x}, E = {e}"))
            }
        }
    }
}

/// The fields about the plant.
pub fn known(parts: &Parts, plant: &OfPlant) -> Outcome<Fields> {
    let table = Table { parts, plant };
    let mut fields = existence(&table)?;
    let stable = parts.inequalities.stability.as_ref();
    let known = match stable.and_then(|part| part.pair().map(|pair| (part, pair))) {
        Some((part, pair)) => format!("by_metrics {}", by_metrics(part, pair)),
        None => stability(&table)?,
    };
    fields.push(("known", known));
    fields.extend([("b_q_rms", "None".to_owned()), ("b_qt_rms", "None".to_owned())]);
    Ok(fields)
}

/// The values at (X_p, E_p), and at (X_p, 0) those of df/dx.
fn existence(table: &Table<'_>) -> Outcome<Fields> {
    let (free, zero) = (&table.parts.free, Rational::new());
    let rate = if table.plant.two_matrices { Name::RateExistence } else { Name::Rate };
    let [of_f, rate] = [Name::Fx, rate].map(|name| table.at(name, [&free.x_p, &zero]));
    let (of_f, rate) = (of_f?, rate?);
    let here = [&free.x_p, &free.e_p];
    let [f_e, q_e, q_x, q_tx, q_te] =
        [Name::Fe, Name::Qe, Name::Qx, Name::Qtx, Name::Qte].map(|name| table.at(name, here));
    let [f_e, q_e, q_x, q_tx, q_te] = [f_e?, q_e?, q_x?, q_tx?, q_te?];
    let most = table.given(Name::QeMax, here)?;
    let at_e_p: Vec<&Value> = [&f_e, &q_e, &q_x, &q_tx, &q_te].into_iter().chain(&most).collect();
    // They hold up to the least of their arguments.
    let x = at_e_p.iter().chain(&[&of_f, &rate]).map(|value| &value.up_to[0]).min();
    let e = at_e_p.iter().map(|value| &value.up_to[1]).min();
    let domain = x.zip(e).map(|(x, e)| format!("{}, {}", number(x), number(e)));
    let some = |value: &Value| option(Some(value.everywhere()));
    Ok(vec![
        ("b_fe", f_e.everywhere()),
        ("b_qe", q_e.everywhere()),
        ("b_qx", q_x.everywhere()),
        ("b_fx", some(&of_f)),
        ("q_e_max", option(most.as_ref().map(Value::everywhere))),
        ("rate", some(&rate)),
        ("q_tx", some(&q_tx)),
        ("q_te", some(&q_te)),
        ("domain", option(domain)),
    ])
}

/// The values at the arguments of section 5, or (M).
fn stability(table: &Table<'_>) -> Outcome<String> {
    let (free, [x_per, e_per, _]) = (&table.parts.free, &table.parts.sizes);
    let (x_b, e_b) = (Rational::from(x_per + &free.d_x), Rational::from(e_per + &free.d_e));
    let at_dx = |path: Path| [&x_b, path.e_at_dx(e_per, &e_b)];
    let at_de = |path: Path| [path.x_at_de(x_per, &x_b), &e_b];
    let q_x = table.at(Name::Qx, at_dx(free.paths.q))?;
    let q_e = table.at(Name::Qe, at_de(free.paths.q))?;
    let of_triple = table.parts.inequalities.stability.as_ref().and_then(|part| match &part.metric.p {
        P::Triple { rate, .. } => Some((part, rate)),
        P::Own(_) => None,
    });
    let decline = match of_triple {
        Some((inequality, rate)) => by_matrix(inequality, rate, [free.paths.f, free.paths.q]),
        None => {
            let f_e = table.at(Name::Fe, at_de(free.paths.f))?;
            let rate = table.at(Name::Rate, at_dx(free.paths.f))?;
            let most = table.given(Name::QeMax, at_de(free.paths.q))?;
            let most = most.map_or_else(|| "None".to_owned(), |most| format!("(Some {})", most.entry()));
            format!("by_norms {} {} {most}", f_e.entry(), rate.entry())
        }
    };
    Ok(format!("by_formulas {{| of_qx := {}; of_qe := {}; of_decline := {decline} |}}", q_x.entry(), q_e.entry()))
}

/// (M): how far it reaches for both points, such that the derivatives along the path are where it is proved (13.7).
fn by_matrix(inequality: &Inequality, rate: &Rational, [f, q]: [Path; 2]) -> String {
    let path = if f == q { f } else { Path::Straight };
    let [[of_dx_x, of_dx_e], [of_de_x, of_de_e]] = inequality.arguments();
    let (x, e) = (of_dx_x.min(of_de_x), of_dx_e.min(of_de_e));
    // df/dx is taken from x_per to x, with e_per or e; df/de from e_per to e, with x or x_per.
    let [reach_x, reach_e] = match path {
        Path::StateFirst => [x, of_de_e],
        Path::ErrorFirst => [of_dx_x, e],
        Path::Straight => [x, e],
    };
    let [reach_x, reach_e, x, e] = [reach_x, reach_e, x, e].map(number);
    let [rate, sigma] = [rate, &inequality.sigma].map(number);
    format!(
        "by_matrix {{| X_m := {reach_x}; E_m := {reach_e}; X_per_m := {x}; E_per_m := {e}; delta_m := {rate}; tau_m := {sigma} |}}"
    )
}

/// k_p, c_x, c_e, c_y of a metric.
pub fn metric(metric: &Metric) -> String {
    let [c_x, c_e, c_y] = metric.least.each_ref().map(number);
    format!("{{| k_p := {}; c_x := {c_x}; c_e := {c_e}; c_y := {c_y} |}}", k_p(metric))
}

/// That of a metric with a P of its own.
pub fn k_p(metric: &Metric) -> String {
    number(&Rational::from(&metric.half * 2u32))
}

/// (Jm). Of P and p Coq has the extents alone.
fn by_metrics(joint: &Inequality, [(near, of_near), (far, of_far)]: Pair<'_>) -> String {
    let square = near.cross.iter().fold(Rational::new(), |sum, entry| sum + Rational::from(entry.square_ref()));
    let extent = |of: &Metric, extent: &Extent, cross: &str| {
        let [weight, p_up, x_low, e_low] = [&of.w, &extent.p_up, &extent.x_low, &extent.e_low].map(number);
        format!("{{| weight := {weight}; cross := {cross}; P_up := {p_up}; x_low := {x_low}; e_low := {e_low} |}}")
    };
    let [x, e, threshold] = [&joint.at[0], &joint.at[1], &joint.sigma].map(number);
    format!(
        "{{| X_j := {x}; E_j := {e}; tau_j := {threshold};\n    near_m := {}; near_x := {};\n    far_m := {}; far_x := {} |}}",
        metric(near),
        extent(near, of_near, &format!("(sqrt {})", number(&square))),
        metric(far),
        extent(far, of_far, "0"),
    )
}
