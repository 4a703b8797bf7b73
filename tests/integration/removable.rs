//! Plants with `exprelr` and `sinc`, whose arguments pass through 0, and stay there: certified, and valid for the checker.

use crate::support;
use sigmastar::{CertifyOptions, Subject, certify};

#[test]
fn arguments_pass_through_0_and_stay_there() {
    for (f, q) in [
        // x_0 is 0 for all t, and so are the arguments; they pass through 0 with the states; with t.
        ("-2*x + x*exprelr(x)/4 + e*sinc(x)/5", "x/4 + cos(2*pi*t) + sinc(x) + exprelr(e)/10"),
        ("-2*x + exprelr(x) - 1 + sin(2*pi*t) + e/4", "sinc(4*x)*cos(2*pi*t)/4 + exprelr(x - e)/4"),
        ("-2*x + e/5 + 0.2*exprelr((cos(2*pi*t) + x)/2)", "x/4 + sinc(3*cos(2*pi*t))"),
    ] {
        let plant = support::plant(&["x"], &[f], q).to_string();
        let certificate = certify(Subject::from_json(&plant).unwrap(), &CertifyOptions::new())
            .unwrap_or_else(|error| panic!("{f}, {q}: {error}"));
        let report = proofs_check::check(certificate.to_json().as_bytes());
        assert!(report.is_valid(), "{f}, {q}: {}", report.text(true));
    }
}
