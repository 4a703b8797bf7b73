//! The reader of expressions and their evaluation: `cargo +nightly fuzz run expression`.
#![no_main]

use libfuzzer_sys::fuzz_target;
use proofs_check::expr::{ARGUMENTS, Expr, NONE, TIME};
use proofs_check::interval::Interval;

fuzz_target!(|text: &str| {
    for variables in [NONE, ARGUMENTS, TIME] {
        if let Ok(expr) = Expr::parse(text, variables) {
            let side = Interval::int(0, 64).hull(&Interval::int(3, 64));
            let _ = (expr.exact(), expr.enclose(&side, &side));
        }
    }
});
