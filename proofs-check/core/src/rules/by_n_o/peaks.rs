//! Which solution that of a trial is, and how far solutions from the claimed set go: sections 14.4 and 14.5 of docs/mathematics.md.
//!
//! Guarantee of [`prove`], with [`Solution`] as it is, the claim proved, and the inequalities of the trial proved of the formulas on its boxes, which lie in
//! the domain of the plant: the solution of every member is that of the claim, and `largest` of the entry, where it is there, is true of every solution
//! from the claimed set. At the gain b of the actuator the weight of `|zeta|_N^2` in these functions is b times that at 1.
//!
//! The solution is that of the claim if all solutions from the set converge to it, in the box of the trial or in that of `x_first`, or if the
//! difference to the one of the claim lies in the error box of the claim. Then the function of the claim falls along differences, too: each
//! function that does gives a bound at all times, and the least counts. At samples `d` has K in the place of mu, and h is eta (section 12.3): these functions do not rise
//! from sample to sample, and are at least what is theirs of x and e in between.

use super::About;
use super::claimed::{Entry, RULE};
use super::trials::Trial;
use super::x_first::Split;
use crate::data::Data;
use crate::interval::Interval;
use crate::rules::control::{put_out, transient};
use crate::rules::inequality::{Extent, Metric, share};
use crate::rules::joint::{between, start};
use crate::rules::stability::{distances, level};
use crate::verdict::{Condition, Finding, Outcome, Verdict};
use rug::Rational;

/// What is known of the periodic solution.
pub struct Solution {
    /// X_N, E_N and Z_N.
    pub sizes: [Interval; 3],
    /// s_x and s_e: how far it is from the trial.
    pub off: [Interval; 2],
    /// Of its u.
    pub u: Interval,
}

/// What a function that falls is at most at the start; it is never below `weight e^2 + h |zeta|_N^2`.
struct Level {
    /// What it is at most for every b.
    start: Interval,
    weight: Interval,
    /// What it is at most, with that h: of a member at each end of b; what is between is not larger.
    ends: Vec<[Interval; 2]>,
    /// What the weight is.
    name: &'static str,
}

impl Level {
    /// V of a form. The weight is e_low, or w of a form without p.
    fn of_form(
        d: &Data<'_>,
        form: (&Metric, &Extent),
        (name, weight): (&'static str, &Rational),
        reach: &[Interval; 3],
    ) -> Level {
        let h = d.number(&form.0.half) * &d.mu;
        let of = |b: &Interval| [start(d, form, reach, b), &h * b];
        let ends = bounds(d).each_ref().map(of);
        Level { start: ends[1][0].clone(), weight: d.number(weight), ends: ends.to_vec(), name }
    }

    /// The function of the claim: V of its joint metrics, or else `w_x x'Px + e^2 + b h |zeta|_N^2`, or by a matrix inequality with the threshold tau,
    /// where there is an input gain, that with `tau/sigma` times this weight of zeta (section 13.1, Theorem G3).
    fn of_claim(d: &Data<'_>, about: &About<'_>, reach: &[Interval; 3]) -> Level {
        if let Some((part, pair)) = about.stability.and_then(|part| part.pair().map(|pair| (part, pair))) {
            // A claim by joint metrics is about b = 1 alone.
            let starts = pair.map(|form| start(d, form, reach, &d.int(1)));
            let [start, weight, h] = between(d, pair, starts.each_ref(), [&part.sigma, about.sigma]);
            return Level { start: start.clone(), weight, ends: vec![[start, h]], name: "e_low" };
        }
        let [[d_x, d_e], [w_x, h]] = [&about.error_box, &about.weights].map(|pair| pair.map(|of| d.number(of)));
        let [low, high] = bounds(d).map(|b| b * &h);
        let [start, _] = level(d, reach, [&d_x, &d_e, &w_x, &high]);
        let share = share(d, about.stability, about.sigma);
        Level { start: start.clone(), weight: d.int(1), ends: vec![[start, low * share]], name: "1" }
    }

    /// How far e and u go from those of the periodic solution.
    fn moves(&self, d: &Data<'_>, sigma: &Interval) -> [Interval; 2] {
        let at = |[start, h]: &[Interval; 2]| transient(d, [sigma, &d.mu], [&self.weight, h], (start, &d.int(0)));
        let of_u = self.ends.iter().map(at).fold(d.int(0), |most, of_u| most.max(&of_u));
        [(&self.start / &self.weight).sqrt(), of_u]
    }

    /// That no difference leaves a box around the trial; `place`: of the box in the file. x_low is that of the form, where there are states.
    fn stays(
        &self,
        d: &Data<'_>,
        (radii, x_low): (&[Rational; 2], Option<&Rational>),
        off: &[Interval; 2],
        (place, about): (&str, &str),
    ) -> Outcome<()> {
        let less = |weight: &str, at: &str, low: &Interval, which: usize| {
            let what = format!("sqrt(V_0/{weight}) + s_{at} < D_{at} of the box, {about}");
            let left = (&self.start / low).sqrt() + &off[which];
            Condition::less("T", what, left, d.number(&radii[which])).demand(RULE, &format!("{place}/{at}"))
        };
        if let Some(x_low) = x_low {
            less("x_low", "x", &d.number(x_low), 0)?;
        }
        less(self.name, "e", &self.weight, 1)
    }
}

/// b_lo and b_hi.
fn bounds(d: &Data<'_>) -> [Interval; 2] {
    [d.by_gain(|gain| &gain.low, &d.int(1)), d.by_gain(|gain| &gain.high, &d.int(1))]
}

/// Proves which solution it is, and `largest`; `d` has the sum of the weights of the entry, whose root has the name `n_bar`.
pub fn prove(
    d: &Data<'_>,
    about: &About<'_>,
    (entry, trial): (&Entry<'_>, &Trial),
    solution: &Solution,
    n_bar: &str,
) -> Outcome<()> {
    let (has_states, words) = (trial.states.is_some(), entry.about());
    let mut reach = distances(d, about.set, solution.sizes.each_ref());
    if !has_states {
        reach[0] = d.int(0);
    }
    // One of the forms is enough: a trial has one at least, and x_first too. Without one the finding is that of the first form, or of one that is undecided.
    let stays = |levels: &[Level], radii, extents: &[&Extent], place: &str| {
        let mut failed: Option<Box<Finding>> = None;
        for (level, extent) in levels.iter().zip(extents) {
            let x_low = Some(&extent.x_low).filter(|_| has_states);
            match (level.stays(d, (radii, x_low), &solution.off, (place, &words)), &failed) {
                (Ok(()), _) => return Ok(()),
                (Err(known), Some(first)) if first.verdict == known.verdict || known.verdict != Verdict::Undecided => {}
                (Err(known), _) => failed = Some(known),
            }
        }
        failed.map_or(Ok(()), Err)
    };
    let of_form =
        |(metric, extent): &(Metric, Extent)| Level::of_form(d, (metric, extent), ("e_low", &extent.e_low), &reach);
    let forms: Vec<Level> = trial.forms.iter().map(of_form).collect();
    let extents: Vec<&Extent> = trial.forms.iter().map(|(_, extent)| extent).collect();
    let near = stays(&forms, &trial.radii, &extents, &format!("{}/box", trial.pointer));

    let mut levels = vec![Level::of_claim(d, about, &reach)];
    let mut sources = "the function of the claim".to_owned();
    match &near {
        Ok(()) => {
            levels.extend(forms);
            sources += " and the forms";
        }
        Err(finding) => sources += &format!(" (of the forms nothing is known: {})", finding.message),
    }
    match (&trial.x_first, near) {
        (Some(first), _) => {
            let what = format!("s_e <= E, {words}");
            let within = Condition::at_most("T", what, solution.off[1].clone(), d.number(&first.slice));
            within.demand(RULE, &format!("{}/E", first.pointer))?;
            let of_form =
                |Split { metric, extent, .. }: &Split| Level::of_form(d, (metric, extent), ("w", &metric.w), &reach);
            let own: Vec<Level> = first.forms.iter().map(of_form).collect();
            let extents: Vec<&Extent> = first.forms.iter().map(|form| &form.extent).collect();
            stays(&own, &first.radii, &extents, &format!("{}/box", first.pointer))?;
            levels.extend(own);
            sources += ", and x_first";
        }
        (None, Err(left)) => {
            let apart = in_error_box(d, about, (entry, trial), solution);
            apart.map_err(|apart| neither(entry.largest.is_some(), left, apart))?;
        }
        (None, Ok(())) => {}
    }

    let Some([largest_e, largest_u]) = &entry.largest else { return Ok(()) };
    let sigma = d.number(about.sigma);
    let undefined = || Interval::undefined(d.precision);
    let least = |[e, u]: [Interval; 2], [of_e, of_u]: [Interval; 2]| [e.least(&of_e), u.least(&of_u)];
    let [of_e, of_u] = levels.iter().map(|of| of.moves(d, &sigma)).fold([undefined(), undefined()], least);
    let [put, _] = put_out(d, [&solution.u + of_u, d.int(0)]);
    let of_law = if about.at_samples.is_some() { "K" } else { "mu" };
    for (place, what, bound, claimed) in [
        ("e", "E_N + sqrt(V_0/e_low)".to_owned(), &solution.sizes[1] + of_e, largest_e),
        ("u", format!("that of u + sqrt(V_0 (sigma^2/e_low + {of_law}^2 {n_bar}^2/h))"), put, largest_u),
    ] {
        let what = format!("{what} <= largest {place}, {words}: the least by {sources}");
        let condition = Condition::at_most("T", what, bound, d.number(claimed));
        condition.demand(RULE, &format!("{}/largest/{place}", entry.pointer))?;
    }
    Ok(())
}

/// The difference to the periodic solution of the claim stays in its error box: `X_N + x_per <= D_x`, `E_N + e_per <= D_e`.
fn in_error_box(
    d: &Data<'_>,
    about: &About<'_>,
    (entry, trial): (&Entry<'_>, &Trial),
    solution: &Solution,
) -> Outcome<()> {
    let within = |what: &str, which: usize| {
        let (of_claim, radius) = (d.number(&about.periodic[which]), d.number(about.error_box[which]));
        let what = format!("{what} of the claim, or the solution need not be that of the claim, {}", entry.about());
        Condition::at_most("T", what, &solution.sizes[which] + of_claim, radius).demand(RULE, &trial.pointer)
    };
    if trial.states.is_some() {
        within("X_N + x_per <= D_x", 0)?;
    }
    within("E_N + e_per <= D_e", 1)
}

/// That it is not known which solution it is: both ways that failed, at the place of the box where `largest` is asked for.
fn neither(largest: bool, left: Box<Finding>, apart: Box<Finding>) -> Box<Finding> {
    let (mut finding, other) = if largest { (left, apart) } else { (apart, left) };
    if other.verdict == Verdict::Undecided {
        finding.verdict = Verdict::Undecided;
    }
    finding.message = format!("{}; and {}", finding.message, other.message);
    finding
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::json::{Field, parse};
    use crate::spec::Specification;

    /// Where a difference may touch the box it is not kept in it: both roots are exact here.
    #[test]
    fn a_reach_that_touches_the_box_does_not_stay() {
        let path = format!("{}/../tests/certificates/linear.sharp.json", env!("CARGO_MANIFEST_DIR"));
        let json = parse(&std::fs::read(path).unwrap()).unwrap();
        let mut file = Field { json: &json, pointer: String::new() }.fields().unwrap();
        let mut witness = file.required("witness").unwrap().fields().unwrap();
        let spec = Specification::read(&file.required("specification").unwrap(), &mut witness).unwrap();
        let d = Data::new(&spec, 128);
        let level = Level { start: d.int(4), weight: d.int(1), ends: Vec::new(), name: "1" };
        let stays = |x: Rational, e: Rational| {
            let off = [d.int(1), d.int(1)];
            let found = level.stays(&d, (&[x, e], Some(&Rational::from(4))), &off, ("/box", "a test"));
            found.map_err(|finding| finding.pointer)
        };
        // sqrt(4/4) + 1 in x, and sqrt(4/1) + 1 in e.
        let above = |value: i32| Rational::from(value) + Rational::from((1, 1_000_000));
        assert_eq!(stays(above(2), above(3)), Ok(()));
        assert_eq!(stays(Rational::from(2), above(3)), Err("/box/x".to_owned()));
        assert_eq!(stays(above(2), Rational::from(3)), Err("/box/e".to_owned()));
    }
}
