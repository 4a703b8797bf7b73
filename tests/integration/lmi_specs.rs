//! C5 as a matrix inequality against its closed form, on the certificate of every shipped specification.

use crate::support::{Shipped, certified};
use rug::Rational;
use sigmastar_prove::lmi::cross_check;
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::sharp::SharpWitness;

#[test]
fn the_matrix_inequality_confirms_every_certificate() {
    let mut set_by_c5 = 0;
    for Shipped { name, spec, run, .. } in certified() {
        let proof = run.sharp.proved().expect("certified");
        let data = Data::new(spec, proof.precision);
        let check = cross_check(&proof.evaluation, &proof.witness, &data).expect("solved");
        assert!(check.fixed.relative_difference <= 1e-6, "{name}: {check:?}");
        // The search leaves nothing where C5 sets sigma*: no other weights in the same error box do with a smaller sigma.
        let free = check.free.as_ref().expect("solved");
        assert!(free.relative_difference <= 1e-6 && !check.contradicts(), "{name}: {check:?}");
        let room = 1.0 - free.solver_sigma / check.fixed.solver_sigma;
        let by_c5 = check.fixed.closed_form.upper_f64() > (1.0 - 1e-5) * proof.witness.sigma.to_f64();
        assert!(!by_c5 || room.abs() <= 1e-6, "{name}: {room:e}");
        set_by_c5 += usize::from(by_c5);
        assert!(check.multipliers.is_some(), "{name}: {check:?}");
        // Below the threshold nothing is verified.
        let below = check.fixed.closed_form.lower_rational().expect("bounded") * Rational::from((999_999, 1_000_000));
        let tampered = SharpWitness { sigma: below, ..proof.witness.clone() };
        let check = cross_check(&proof.evaluation, &tampered, &data).expect("solved");
        assert!(check.multipliers.is_none(), "{name}: {check:?}");
    }
    assert!(set_by_c5 >= 10, "C5 sets sigma* on {set_by_c5} only");
}

/// Where dq/de is exactly one number, both programs put it in the place of u_e, and neither has a multiplier for it.
#[test]
fn a_sector_of_one_slope_has_no_multiplier() {
    let folder = tempfile::tempdir().unwrap();
    let [spec, certificate] = ["spec.json", "certificate.json"].map(|name| folder.path().join(name));
    let text = std::fs::read_to_string("specs/paper-example.json").unwrap();
    for (most, present) in [("-1/2", false), ("-1/2 + 1/1000", true)] {
        let mut changed: serde_json::Value = serde_json::from_str(&text).unwrap();
        changed["bounds"]["q_e"] = "1/2".into();
        changed["bounds"]["q_e_max"] = most.into();
        std::fs::write(&spec, changed.to_string()).unwrap();
        let call = |args: &[&std::ffi::OsStr]| crate::support::program().args(args).output().unwrap();
        let [certify, output, force] = ["certify", "-o", "--force"].map(std::ffi::OsStr::new);
        assert!(call(&[certify, spec.as_os_str(), output, certificate.as_os_str(), force]).status.success());
        let written: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(&certificate).unwrap()).unwrap();
        assert_eq!(written["witness"]["lmi"]["l_e"] != "0", present, "{most}: {}", written["witness"]["lmi"]);
        let answer = call(&[std::ffi::OsStr::new("check"), certificate.as_os_str()]);
        let text = String::from_utf8_lossy(&answer.stdout).into_owned();
        assert!(text.starts_with("valid\n"), "{most}: {text}");
    }
}
