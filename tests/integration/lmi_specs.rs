//! C5 as a matrix inequality against its closed form, on the certificate of every shipped specification.

use crate::support::{Shipped, certified};
use rug::Rational;
use sigmastar::data::Data;
use sigmastar::derivation::sharp::SharpWitness;
use sigmastar::lmi::cross_check;

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
