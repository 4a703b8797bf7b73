//! That a form falls along the difference of two solutions of a plant that is linear in x and e (docs/mathematics.md, sections 14.3 and 14.6).
//!
//! Guarantee of [`Falls::prove`]: F of (14.3a) is positive definite for every member of the family and at both ends of b, in which it is affine: it is not
//! below `diag(sigma p_up I, sigma w, k_p)` times 2^-40. At samples the same of (14.6a), with lambda for e(s) and v, and g_m for p, in the diagonal.

use super::system::System;
use crate::PRECISION;
use crate::at_samples;
use crate::form::{Form, ends};
use crate::machine::{Cell, Machine, Values};
use crate::question::{Answer, MAX_PIECES, Question};
use crate::read::Plant;
use crate::region::Region;
use proofs_core::rules::by_n_o::claimed::RULE;
use proofs_core::rules::by_n_o::linear;
use proofs_core::rules::inequality::{Metric, P};
use proofs_core::rules::sampled::law::Terms;
use proofs_core::spec::Specification;
use proofs_core::verdict::{Outcome, demand};
use rug::Rational;
use std::rc::Rc;

/// How much is taken from the diagonal, as a power of 2.
const TAKEN: u32 = 40;

/// A form with the question at each end of b.
pub struct Falls {
    pointer: String,
    questions: Vec<(String, Question)>,
}

impl Falls {
    /// The questions of a form; with the law of a claim at samples.
    pub fn new(
        system: &mut System,
        spec: &Specification,
        (sigma, law): (&Rational, Option<&Terms>),
        form: &linear::Form,
    ) -> Outcome<Falls> {
        let share = |number: Rational| number >> TAKEN;
        let [c_x, c_e] = [&form.p_up, &form.w].map(|weight| share(Rational::from(sigma * weight)));
        let metric = Metric {
            p: P::Own(form.p.clone()),
            w: form.w.clone(),
            half: Rational::from(&form.k_p / 2u32),
            cross: vec![Rational::new(); form.p.len()],
            least: [c_x, c_e, share(form.k_p.clone())],
            lambda: form.at_samples.as_ref().map_or_else(Rational::new, |within| within.lambda.clone()),
            gamma: None,
            extent: None,
        };
        let pointer = form.pointer.clone();
        let model = &mut system.model;
        if let Some((law, within)) = law.zip(form.at_samples.as_ref()) {
            let questions = at_samples::falls(model, (&metric, within, share(Rational::from(1))), law, spec)?;
            return Ok(Falls { pointer, questions });
        }
        let corner = Rational::from(sigma * 2u32) * &form.w;
        let unit = model.formulas.int(1);
        let mut questions = Vec::new();
        for end in ends(&mut model.formulas, spec, sigma) {
            let form = Form { metric: &metric, unit, corner: &corner, shift: end.shift, pull: &metric.cross };
            let (mut rows, of_e) = form.rows(model);
            rows.push(of_e);
            questions.push((format!("F > 0{}", end.at), Question::new(&mut model.formulas, rows, 0)));
        }
        Ok(Falls { pointer, questions })
    }

    /// Decides them for all members of the family.
    pub fn prove(
        &self,
        plant: &Plant,
        machine: &Machine<'_>,
        root: &Rc<Cell>,
        values: &mut Values,
        lines: &mut Vec<String>,
    ) -> Outcome<()> {
        let region = Region::of_family(plant, PRECISION);
        for (what, question) in &self.questions {
            match question.decide(machine, root, &region, MAX_PIECES, values) {
                Answer::Proved(count) => lines.push(format!("{RULE}: {what}, by {count} boxes")),
                Answer::Refuted(place) => demand(Some(false), RULE, &self.pointer, format!("{what}, at {place}"))?,
                Answer::Open(place) => demand(None, RULE, &self.pointer, format!("{what}, near {place}"))?,
            }
        }
        Ok(())
    }
}
