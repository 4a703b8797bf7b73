//! Which regulator a claim is about, and which document.

use sigmastar_document::Block;
use sigmastar_lang::spec::{Sampling, Specification};
use sigmastar_regulator::export::{continuous_law, sampled_law};

/// The law that is certified, and the digest of the specification or plant that it is certified for; `sampling` of the law at samples.
pub(super) fn facts(spec: &Specification, sampling: Option<&Sampling>) -> Block {
    let divided = spec.input_gain.is_some();
    let law = match sampling {
        None => continuous_law(divided).to_owned(),
        // Exports call R Phi.
        Some(sampling) => format!("{}, R = e^(Phi h)", sampled_law(sampling.delayed, divided).replace("Phi", "R")),
    };
    let kind = if spec.plant().is_some() { "plant" } else { "specification" };
    Block::facts([
        ("law", format!("`{law}`; `sigmastar controller` writes its matrices")),
        (kind, format!("SHA-256 {}, as `sigmastar check` has it", spec.sha256)),
    ])
}
