//! Builds the paper's example, certifies it, and has the certificate checked: `cargo run --release --example certify`.

#![allow(clippy::disallowed_methods, reason = "what is compared need not be the same on every machine")]

use sigmastar::{
    BoundingFunction as Bound, CertifyOptions, Error, Specification, certify, check_against, transfer_bound,
};

fn main() -> Result<(), Error> {
    let specification = Specification::builder("Example of the paper")
        .period("1")
        .lyapunov("1", "1.5512", "0.58")
        .bound(Bound::F, "2.302*X + 0.112*X^2 + (X + 0.189)*E")
        .bound(Bound::Fe, "X + 0.189")
        .bound(Bound::Fxx, "0.2237")
        .bound(Bound::Fex, "1")
        .bound(Bound::Q, "4.822 + X + atan(E*(X + 0.189))")
        .bound(Bound::Qe, "X + 0.189")
        .bound(Bound::Qx, "sqrt(1 + E^2)")
        .bound(Bound::Qt, "24.18 + 2.106*E")
        .domain("10", "10")
        .mu("1")
        .matched_base_frequency("2*pi")
        .power_weights("2", "1/2")
        .initial_set_of_the_paper()
        .build()?;

    let certificate = certify(&specification, &CertifyOptions::new())?;
    let claim = certificate.claim();
    println!("sigma* = {}\n{}\n", claim.sigma_star(), claim.statement());
    for condition in certificate.conditions() {
        let (lhs, rhs) = (condition.lhs(), condition.rhs());
        println!("{:4} {:.6} {} {:.6}  {}", condition.id(), lhs[1], condition.relation(), rhs[0], condition.text());
    }

    // The text could be written to a file here, and checked by somebody else.
    let report = check_against(certificate.to_json(), &specification);
    println!("\nThe independent checker:\n{}", report.text());

    let bound = transfer_bound(&specification, "20")?;
    println!("T_N(x) <= {} + {} x^2 for every N >= 0 and every x >= 0", bound.k0(), bound.k1());
    Ok(())
}
