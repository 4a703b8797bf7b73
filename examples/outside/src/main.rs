//! A user of the library: builds a specification, certifies it and has the certificate checked.

use sigmastar::{
    BoundingFunction as Bound, Certificate, CertifyOptions, CheckReport, Error, Specification, certify, check_against,
};

fn main() -> Result<(), Error> {
    let (certificate, answer) = certified_and_checked()?;
    println!("{}", certificate.claim().statement());
    print!("{}", answer.text());
    Ok(())
}

/// The certificate, and what the checker says of it.
///
/// # Errors
/// Those of the front door.
pub fn certified_and_checked() -> Result<(Certificate, CheckReport), Error> {
    let specification = Specification::builder("linear zero dynamics")
        .period("1")
        .lyapunov("1", "1.5512", "0.58")
        .bound(Bound::F, "2*X + E/2")
        .bound(Bound::Fe, "1/2")
        .bound(Bound::Fxx, "0")
        .bound(Bound::Fex, "0")
        .bound(Bound::Q, "3 + X + E/4")
        .bound(Bound::Qe, "1/4")
        .bound(Bound::Qx, "1")
        .bound(Bound::Qt, "20")
        .mu("1")
        .matched_base_frequency("2*pi")
        .power_weights("2", "1/2")
        .initial_set_of_the_paper()
        .build()?;
    let certificate = certify(&specification, &CertifyOptions::new())?;
    let answer = check_against(certificate.to_json(), &specification);
    Ok((certificate, answer))
}
