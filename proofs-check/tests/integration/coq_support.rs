//! `--coq` on a certificate, and coqc on what it writes, where it is installed.

use crate::common::{every, names};
use proofs_check::coq::theorem;
use proofs_check::verdict::Verdict;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// The certificates of plants in continuous time of which a theorem is written.
pub fn plants() -> impl Iterator<Item = String> {
    let written = |name: &String| name != "converter-samples.certificate" && !name.starts_with("family");
    names("plants").into_iter().filter(|name| name.ends_with(".certificate")).filter(written)
}

/// Whether coqc is to try all that is stored, which takes some minutes; an ordinary run tries one of a kind.
pub fn every_case() -> bool {
    every(2) == 1
}

/// The theorem of a certificate.
pub fn written(certificate: &Value) -> String {
    theorem(certificate.to_string().as_bytes()).unwrap_or_else(|finding| panic!("{finding:?}"))
}

/// No theorem is written, and the place is named.
#[track_caller]
pub fn assert_refused_at(bytes: &str, verdict: Verdict, pointer: &str) {
    let finding = theorem(bytes.as_bytes()).expect_err("it is refused");
    assert_eq!((finding.verdict, finding.pointer.as_str()), (verdict, pointer), "{}", finding.message);
}

/// The folder of the proofs, built once; `None` where coqc is not installed.
pub fn proofs() -> Option<&'static Path> {
    static FOLDER: OnceLock<Option<PathBuf>> = OnceLock::new();
    let build = || {
        let installed = Command::new("coqc").arg("--version").output().is_ok_and(|output| output.status.success());
        if !installed {
            println!("coqc is not installed: no theorem was tried");
            return None;
        }
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("coq");
        let jobs = format!("-j{}", std::thread::available_parallelism().map_or(1, usize::from));
        let made = Command::new("make").args([&jobs, "--no-print-directory", "-C"]).arg(&folder).output();
        let made = made.expect("make runs");
        assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
        Some(folder)
    };
    FOLDER.get_or_init(build).as_deref()
}

/// What coqc answers about the theorem of a certificate.
pub fn coqc(proofs: &Path, name: &str, certificate: &Value) -> Result<String, String> {
    let place = Path::new(env!("CARGO_TARGET_TMPDIR")).join("coq");
    std::fs::create_dir_all(&place).expect("a folder");
    let file = place.join(format!("{name}.v"));
    std::fs::write(&file, written(certificate)).expect("it is written");
    let output = Command::new("coqc").args(["-q", "-w", "none", "-Q"]).arg(proofs).arg("SigmaStar").arg(&file).output();
    let output = output.expect("coqc runs");
    let said = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    if output.status.success() { Ok(said(&output.stdout)) } else { Err(said(&output.stderr)) }
}

/// Coq's classical real numbers.
const AXIOMS: [&str; 4] = [
    "ClassicalDedekindReals.sig_forall_dec",
    "ClassicalDedekindReals.sig_not_dec",
    "FunctionalExtensionality.functional_extensionality_dep",
    "Classical_Prop.classic",
];

/// Both theorems are proved, and rest on [`AXIOMS`] alone.
#[track_caller]
pub fn assert_accepted(name: &str, answer: Result<String, String>) {
    let said = answer.unwrap_or_else(|error| panic!("{name}: {error}"));
    assert_eq!(said.matches("Axioms:").count(), 1, "{name}: {said}");
    let axioms = said.lines().filter(|line| !line.starts_with(' ') && *line != "Axioms:");
    for line in axioms {
        assert!(AXIOMS.contains(&line.split([' ', ':']).next().unwrap()), "{name}: {line}");
    }
}
