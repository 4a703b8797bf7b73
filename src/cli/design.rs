//! `sigmastar design`.

use super::args::DesignArgs;
use super::counts::finite_counts;
use super::failure::Failure;
use super::files::Input;
use super::output;
use super::progress::working;
use super::subject::Asked;
use sigmastar::program::{DesignNames, design_of};
use sigmastar::{DesignOptions, Error, Verdict};
use std::time::Instant;

/// What the arguments are called here.
const NAMES: DesignNames = DesignNames {
    asked: ["--n-o", "--harmonics", "--sigma", "--sampling-period"],
    required: ["--steady-error", "--peak-error", "--max-control", "--settle", "--noise"],
    choose: "--choose",
    sampling_periods: "--sampling-periods",
};

/// Runs the command and returns the exit code.
pub fn run(args: &DesignArgs) -> Result<u8, Failure> {
    let file = args.replace.asked(args.output.as_deref(), Input::Specification(&args.spec), "the certificate")?;
    let asked = Asked::read(&args.spec)?;
    let subject = asked.subject()?;
    let options = options(args)?;
    let more = "; `--progress` tells how far it is";
    let working = working("proving the rows of the design table", more, args.quiet || args.progress);
    let start = Instant::now();
    let tell = |next: &str| {
        if args.progress {
            output::remark(&format!("{next} (after {:.1} s)", start.elapsed().as_secs_f64()));
        }
    };
    let design = design_of((subject, asked.document), &options, &NAMES, &tell);
    drop(working);
    let design = match design {
        Err(error) if error.report().is_some() => return not_certified(&error, args),
        other => other?,
    };
    if let Some(file) = &file {
        if design.is_met() {
            file.write(design.certificate().to_json())?;
            if !args.quiet {
                let (name, sigma) = (file.name(), design.sigma());
                output::remark(&format!("the certificate of sigma = {sigma} is in `{name}`"));
            }
        } else {
            let name = file.name();
            output::remark(&format!("`{name}` was not written: not all that is required is proved"));
        }
    }
    let verdict = if design.is_met() { Verdict::Certified } else { Verdict::Undecided };
    let text = output::report(design.report(), args.format);
    Ok(output::data(&text).err().unwrap_or(verdict.exit_code()))
}

/// Why there is no table, as `certify` tells it.
fn not_certified(error: &Error, args: &DesignArgs) -> Result<u8, Failure> {
    if let Some(output) = &args.output {
        output::remark(&format!("`{}` was not written: the verdict is {}", output::shown(output), error.verdict()));
    }
    let text = error.report().map(|report| output::report(report, args.format)).unwrap_or_default();
    Ok(output::data(&text).err().unwrap_or(error.verdict().exit_code()))
}

fn options(args: &DesignArgs) -> Result<DesignOptions, Failure> {
    type Set = fn(DesignOptions, String) -> DesignOptions;
    let texts: [(&Option<String>, Set); 6] = [
        (&args.steady_error, DesignOptions::steady_error),
        (&args.peak_error, DesignOptions::peak_error),
        (&args.max_control, DesignOptions::max_control),
        (&args.settle, DesignOptions::settle),
        (&args.noise, DesignOptions::noise),
        (&args.sampling_period, DesignOptions::sampling_period),
    ];
    let mut options = DesignOptions::new().simulate(!args.no_simulation).sampling_periods(args.sampling_periods);
    if let Some(numbers) = &args.choose {
        options = options.choose(numbers);
    }
    if let Some(counts) = &args.n_o {
        options = options.n_o(finite_counts(counts)?);
    }
    for set in &args.harmonics {
        options = options.harmonics(set.all().collect::<Vec<u32>>());
    }
    for (text, set) in texts {
        options = text.clone().map_or(options.clone(), |text| set(options, text));
    }
    if let Some(sigmas) = &args.sigma {
        options = options.sigmas(sigmas.split(',').map(str::trim));
    }
    Ok(options)
}
