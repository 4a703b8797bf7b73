//! All questions of the matrix inequalities that a claim rests on, of either regulator (docs/mathematics.md, section 13.7).

use super::at_samples;
use super::inequality::{self, Said};
use super::model::Model;
use super::slopes;
use proofs_core::rules::derivation::Inequalities;
use proofs_core::spec::Specification;
use proofs_core::verdict::Outcome;
use rug::Rational;

/// The questions of all that there are, about the mu and the period of the specification.
pub fn questions<'i>(
    model: &mut Model,
    inequalities: Inequalities<'i>,
    spec: &Specification,
) -> Outcome<Vec<Said<'i>>> {
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

/// Where they are asked: X and E of each.
pub fn arguments<'i>(inequalities: Inequalities<'i>) -> impl Iterator<Item = [&'i Rational; 2]> {
    let of_stability = inequalities.stability.into_iter().flat_map(|part| part.arguments());
    let of_joint = inequalities.joint.map(|part| [&part.x, &part.e]);
    let of_existence = inequalities.existence.map(|part| [&part.x, &part.e]);
    let at_samples = inequalities.at_samples.into_iter().flat_map(|parts| {
        let existence = parts.existence.map(|part| [&part.x, &part.e]);
        parts.stability.map(|part| [&part.x, &part.e]).into_iter().chain(existence)
    });
    let of_slopes = inequalities.slopes.into_iter().flat_map(|asked| asked.at);
    of_stability.chain(of_joint).chain(of_existence).chain(of_slopes).chain(at_samples)
}
