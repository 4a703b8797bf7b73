//! Calls that come to no claim, and how they are told.

use super::output::{self, Format};
use sigmastar::Error;
use sigmastar_lang::spec::SpecErrors;
use sigmastar_prove::certify::{Verdict, verdict_of_errors};
use sigmastar_report::{call_failure_json, failure_json};

/// Why a command came to no claim.
#[derive(Debug)]
pub enum Failure {
    /// A document or a flag with errors at known places; not empty.
    Documents(Vec<SpecErrors>),
    /// A file or a call that is wrong as a whole.
    Call {
        /// What is wrong, in one sentence.
        message: String,
        /// What to try.
        help: String,
    },
}

impl From<SpecErrors> for Failure {
    fn from(errors: SpecErrors) -> Failure {
        Failure::Documents(vec![errors])
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Failure {
        match (error.sources(), error.diagnostics()) {
            ([], [told, ..]) => Failure::call(&told.message, told.help.clone().unwrap_or_default()),
            ([], []) => Failure::call(error.to_string(), ""),
            (all, _) => Failure::Documents(all.to_vec()),
        }
    }
}

impl Failure {
    /// A wrong call.
    pub fn call(message: impl Into<String>, help: impl Into<String>) -> Failure {
        Failure::Call { message: message.into(), help: help.into() }
    }

    /// `bad-input`, or `undecided` where nothing was found to be wrong.
    pub fn verdict(&self) -> Verdict {
        match self {
            Failure::Documents(all) => verdict_of_errors(all),
            Failure::Call { .. } => Verdict::BadInput,
        }
    }

    /// Tells the failure, as diagnostics on standard error or as JSON on standard output, and returns the exit code.
    pub fn tell(&self, format: Format, quiet: bool) -> u8 {
        let verdict = self.verdict();
        if format == Format::Json {
            let value = match self {
                Failure::Documents(all) => failure_json(verdict, all),
                Failure::Call { message, help } => call_failure_json(verdict, message, help),
            };
            if !quiet {
                output::remark(&format!("{verdict}; the errors are in the JSON on standard output"));
            }
            return output::data(&output::json_text(&value)).err().unwrap_or(verdict.exit_code());
        }
        match self {
            Failure::Documents(all) => output::diagnostics(all),
            Failure::Call { message, help } => output::error(message, help),
        }
        output::remark(&match verdict {
            Verdict::Undecided => format!("{verdict}: nothing is claimed either way, and nothing was written"),
            _ => format!("{verdict}: nothing was written"),
        });
        verdict.exit_code()
    }
}
