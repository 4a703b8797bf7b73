//! Whatever is certified is valid to the independent checker, and what the certificate shows of its conditions is what is decided.

use crate::agreement::differing;
use crate::mutants;
use crate::support::cases;
use serde_json::Value;
use sigmastar_lang::spec::Specification;
use sigmastar_prove::certificate::certificate_json;
use sigmastar_prove::certify::{Options, TransferChoice, certify, resolve};

/// Seeds of an ordinary run, and of a night; `SIGMASTAR_CASES=0..3000 cargo test --release --test integration mutated` takes
/// others.
const SEEDS: [u64; 2] = [6, 1000];

/// Cases that a long campaign found: a checker whose cosine was too rough on [0, 1] to prove `tan(min(X, 1))` monotone, and
/// `sqrt(1 + X^2) - 1` at X = 1e-40, whose figures need more bits than the claim.
const FOUND: [u64; 2] = [627, 1303];

/// The certificate of a specification, if there is one.
fn certificate(seed: u64, text: &str) -> Option<Value> {
    let mut spec = Specification::from_json("mutant", text).ok()?;
    if let Some(resolved) = resolve(&spec) {
        spec = resolved.ok()?.spec;
    }
    let transfer = match seed % 7 {
        5 => TransferChoice::Boxes,
        6 => TransferChoice::ClosedForm,
        _ => TransferChoice::Best,
    };
    let options = Options { transfer, ..Options::default() };
    certificate_json(&certify(&spec, options).ok()?)
}

#[test]
fn whatever_is_certified_is_valid() {
    assert_valid(cases(SEEDS[0], SEEDS[1]));
}

#[test]
#[ignore = "search tier"]
fn what_a_long_campaign_found_is_valid() {
    assert_valid(FOUND);
}

fn assert_valid(seeds: impl IntoIterator<Item = u64>) {
    let (mut certified, mut wrong) = (0, Vec::new());
    for seed in seeds {
        let text = mutants::specification(seed).to_string();
        let Some(certificate) = certificate(seed, &text) else { continue };
        certified += 1;
        if certified % 100 == 0 {
            eprintln!("seed {seed}: {certified} certified so far");
        }
        let report = proofs_check::check(certificate.to_string().as_bytes());
        let differing = differing(&certificate);
        if !report.is_valid() || !differing.is_empty() {
            eprintln!("seed {seed}: {}{differing:#?}{text}\n", report.text(false));
            if let Ok(folder) = std::env::var("SIGMASTAR_MUTANTS_DIR") {
                std::fs::write(format!("{folder}/{seed}.json"), certificate.to_string()).expect("written");
            }
            wrong.push(seed);
        }
    }
    eprintln!("{certified} certified, {} not valid: {wrong:?}", wrong.len());
    assert!(certified > 0 && wrong.is_empty(), "seeds {wrong:?}");
}
