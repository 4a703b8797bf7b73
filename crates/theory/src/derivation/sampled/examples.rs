//! What the tests of this folder start from.

use super::law::SampledLaw;
use crate::data::Data;
use serde_json::Value;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::spec::Specification;

/// The paper's example, T = 1, at so many samples with this mu, and with other changes.
pub(in crate::derivation) fn example(samples: u32, mu: &str, change: impl FnOnce(&mut Value)) -> Specification {
    let mut document: Value = serde_json::from_str(include_str!("../../../../../specs/paper-example.json")).unwrap();
    document["internal_model"]["mu"] = mu.into();
    document["internal_model"]["sampling_period"] = format!("1/{samples}").into();
    change(&mut document);
    Specification::from_json("sampled", &document.to_string()).unwrap()
}

/// The law of such a specification.
pub(in crate::derivation) fn law(data: &Data<'_>) -> SampledLaw<Enclosure> {
    let model = &data.spec.internal_model;
    let sampling = model.sampling.clone().unwrap();
    let gain = model.sampled_gain(&sampling.step).unwrap();
    SampledLaw::new(data, &sampling, &gain)
}
