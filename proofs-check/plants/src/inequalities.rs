//! All questions of the matrix inequalities that a claim rests on, of either regulator (docs/mathematics.md, section 13.7).

use super::at_samples;
use super::inequality::{self, Said};
use super::model::Model;
use super::slopes;
use proofs_core::rules::derivation::Inequalities;
use proofs_core::spec::Specification;
use proofs_core::verdict::Outcome;

/// The questions of all that there are, about the mu and the period of the specification.
pub fn questions(model: &mut Model, inequalities: Inequalities<'_>, spec: &Specification) -> Outcome<Vec<Said>> {
    let mut all = Vec::new();
    if let Some(part) = inequalities.stability {
        all.extend(inequality::of_stability(model, part, spec)?);
    }
    if let Some(part) = inequalities.joint {
        all.extend(inequality::of_joint(model, part)?);
    }
    if let Some(part) = inequalities.existence {
        all.extend(inequality::of_existence(model, part, spec)?);
    }
    if let Some(asked) = inequalities.slopes {
        all.extend(slopes::questions(model, asked));
    }
    if let Some(parts) = inequalities.at_samples {
        all.extend(at_samples::questions(model, parts, spec)?);
    }
    Ok(all)
}
