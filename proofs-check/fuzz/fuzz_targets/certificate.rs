//! The reader of certificates, and every rule behind it: `cargo +nightly fuzz run certificate ../tests/certificates`.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let _ = proofs_check::check(bytes);
});
