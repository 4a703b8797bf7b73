//! The header of exported C code.

use super::literal::hexadecimal;
use super::{Prefix, harmless};
use crate::export::notice::comment;
use crate::export::{Export, decimal, notice};
use crate::{Convergence, Discrete};

/// The header, with what is claimed and what is not in front.
pub(super) fn header(
    export: &Export<'_>,
    discrete: &Discrete,
    sampled: Convergence,
    prefix: &Prefix,
    id: &str,
) -> String {
    let regulator = export.regulator;
    let n_o = regulator.oscillators().unwrap_or(0);
    let (dimension, upper) = (regulator.dimension(), prefix.upper());
    let mut words = vec![
        format!("Regulator for: {}", export.name),
        format!(
            "sigma = {}, mu = {}, {}, sampling time h = {}, K = mu/(1 + h mu Nbar^2/2) = {}.",
            decimal(regulator.sigma),
            decimal(regulator.mu),
            export.oscillators,
            decimal(discrete.step),
            decimal(discrete.gain),
        ),
        format!("In floating point, {sampled}."),
    ];
    words.extend(notice(export));
    let delayed = discrete.prediction.is_some();
    words.push(match delayed {
        false => format!("Call {prefix}_step once per sample with the measured error; apply the control that it returns."),
        true => format!(
            "Call {prefix}_step once per sample, with the error measured at it; put out the control that it returns exactly at the \
             next sample, not before, however early it is ready."
        ),
    });
    let words: Vec<String> = words.iter().map(|line| harmless(line)).collect();
    let saturation = discrete.saturation.map_or_else(String::new, |limit| {
        format!("#define {upper}_SATURATION {} /* {} */\n", hexadecimal(limit), decimal(limit))
    });
    let (start, argument) = match export.aligned {
        true => ("Sets z = M e, with the error e of the sample that the next step takes.", ", double e"),
        false => ("Sets the state to rest (z = 0).", ""),
    };
    let (macros, member, returned) = match delayed {
        true => (
            format!("#define {upper}_DELAY_SAMPLES 1\n"),
            "    double ahead;\n",
            "Takes the error of this sample, returns the control to be put out at the next one, and moves the state to it.",
        ),
        false => (
            String::new(),
            "",
            "Takes the error of this sample, returns the control for it, and moves the state to the next sample.",
        ),
    };
    format!(
        "/*\n{}\x20*/\n\
         #ifndef {upper}_CONTROLLER_ID\n\
         #define {upper}_CONTROLLER_ID 0x{id}UL\n\n\
         /* The names end in the number of this regulator, so that the linker does not take those of another for them. */\n\
         #define {prefix}_controller {prefix}_controller_{id}\n\
         #define {prefix}_reset {prefix}_reset_{id}\n\
         #define {prefix}_step {prefix}_step_{id}\n\n\
         #define {upper}_OSCILLATORS {n_o}\n\
         #define {upper}_STATES {dimension}\n\
         #define {upper}_SAMPLING_TIME {} /* {} */\n{macros}{saturation}\n\
         typedef struct {{\n    double z[{upper}_STATES];\n{member}}} {prefix}_controller;\n\n\
         #ifdef __cplusplus\nextern \"C\" {{\n#endif\n\n\
         /* {start} */\n\
         void {prefix}_reset({prefix}_controller *controller{argument});\n\n\
         /* {returned} */\n\
         double {prefix}_step({prefix}_controller *controller, double e);\n\n\
         #ifdef __cplusplus\n}}\n#endif\n\n\
         #elif {upper}_CONTROLLER_ID != 0x{id}UL\n\
         #error \"another regulator has this prefix; export this one with --prefix\"\n#endif\n",
        comment(&words, " * "),
        hexadecimal(discrete.step),
        decimal(discrete.step),
    )
}
