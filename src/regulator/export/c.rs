//! The discrete regulator as C99 without dependencies.

use super::{Export, decimal};
use crate::regulator::{Discrete, Regulator, SampledLoop};
use sha2::{Digest, Sha256};

/// A header and its source.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CSources {
    /// The header.
    pub header: String,
    /// The source, which includes the header by the name that was given.
    pub source: String,
}

/// The regulator as a C99 header and source with a step function; `header_name` is how the source includes the header.
/// `None` without a discretisation: C code runs at samples.
///
/// The code allocates nothing, includes nothing from the standard library, and performs the operations of
/// [`Stepper::step`](crate::regulator::Stepper::step) in the same order. Constants are hexadecimal floating-point
/// literals, so that no decimal is rounded again.
#[must_use]
pub fn c_sources(export: &Export<'_>, header_name: &str) -> Option<CSources> {
    let (discrete, sampled) = export.discrete?;
    let regulator = export.regulator;
    // A comment could be closed by the name, or end in a line splice.
    let name: String = export.name.replace("*/", "* /").replace("/*", "/ *").replace(['\\', '?'], " ");
    let source = source(regulator, discrete);
    let id = identity(&source);
    let top = format!(
        "/* Regulator for: {name} */\n#include \"{header_name}\"\n\n#if SIGMASTAR_CONTROLLER_ID != {id}\n\
         #error \"this source and its header are of different regulators\"\n#endif\n\n"
    );
    Some(CSources { header: header(regulator, discrete, sampled, &name, &id), source: top + &source })
}

/// A number that the header and the source share, so that two which do not belong together do not compile.
fn identity(source: &str) -> String {
    let digest = Sha256::digest(source);
    let word = digest.iter().take(4).fold(0_u32, |word, byte| (word << 8) | u32::from(*byte));
    format!("0x{word:08x}UL")
}

fn header(regulator: &Regulator, discrete: &Discrete, sampled: SampledLoop, name: &str, id: &str) -> String {
    let n_o = regulator.oscillators().unwrap_or(0);
    let dimension = regulator.dimension();
    format!(
        "/* Regulator for: {name}\n\
         \x20* sigma = {}, mu = {}, n_o = {n_o}, sampling time {}.\n\
         \x20* In floating point, {sampled}.\n\
         \x20* Call sigmastar_step once per sample with the measured error; apply the control that it returns. */\n\
         #ifndef SIGMASTAR_CONTROLLER_H\n\
         #define SIGMASTAR_CONTROLLER_H\n\n\
         #define SIGMASTAR_CONTROLLER_ID {id}\n\
         #define SIGMASTAR_OSCILLATORS {n_o}\n\
         #define SIGMASTAR_STATES {dimension}\n\
         #define SIGMASTAR_SAMPLING_TIME {} /* {} */\n\n\
         typedef struct {{\n    double z[SIGMASTAR_STATES];\n}} sigmastar_controller;\n\n\
         #ifdef __cplusplus\nextern \"C\" {{\n#endif\n\n\
         /* Sets the state to rest (z = 0). */\n\
         void sigmastar_reset(sigmastar_controller *controller);\n\n\
         /* Takes the error of this sample, returns the control for it, and moves the state to the next sample. */\n\
         double sigmastar_step(sigmastar_controller *controller, double e);\n\n\
         #ifdef __cplusplus\n}}\n#endif\n\n#endif\n",
        decimal(regulator.sigma),
        decimal(regulator.mu),
        decimal(discrete.step),
        hexadecimal(discrete.step),
        decimal(discrete.step),
    )
}

fn source(regulator: &Regulator, discrete: &Discrete) -> String {
    let (cosines, sines): (Vec<f64>, Vec<f64>) = discrete.rotations.iter().map(|[c, s]| (*c, *s)).unzip();
    let mut source = String::from(
        "/* The same bits on every machine need each operation rounded on its own: GCC does so with -std=c99 or\n\
         \x20* -ffp-contract=off, other compilers follow this pragma. */\n",
    );
    source.push_str("#if !defined(__GNUC__) || defined(__clang__)\n#pragma STDC FP_CONTRACT OFF\n#endif\n\n");
    source.push_str(&format!("static const double sigma = {};\n", literal(regulator.sigma)));
    source.push_str(&format!("static const double mu = {};\n", literal(regulator.mu)));
    source.push_str(&array("weight", &regulator.weights));
    source.push_str(&array("input", &discrete.input));
    if !cosines.is_empty() {
        source.push_str(&array("cosine", &cosines));
        source.push_str(&array("sine", &sines));
    }
    source.push_str(
        "\nvoid sigmastar_reset(sigmastar_controller *controller)\n{\n    int i;\n\n\
         \x20   for (i = 0; i < SIGMASTAR_STATES; i++) {\n        controller->z[i] = 0.0;\n    }\n}\n\n\
         double sigmastar_step(sigmastar_controller *controller, double e)\n{\n    double *z = controller->z;\n",
    );
    let body = "    u = mu * sum - sigma * e;\n    z[0] += input[0] * e;\n";
    if cosines.is_empty() {
        source.push_str("    double sum = weight[0] * (z[0] - e);\n    double u;\n\n");
        source.push_str(body);
    } else {
        source.push_str(
            "    double sum = weight[0] * (z[0] - e);\n    double u;\n    int l;\n\n\
             \x20   for (l = 1; l <= SIGMASTAR_OSCILLATORS; l++) {\n\
             \x20       sum += weight[l] * (z[2 * l - 1] - e);\n    }\n",
        );
        source.push_str(body);
        source.push_str(
            "    for (l = 1; l <= SIGMASTAR_OSCILLATORS; l++) {\n\
             \x20       double a = z[2 * l - 1];\n        double b = z[2 * l];\n\n\
             \x20       z[2 * l - 1] = (cosine[l - 1] * a + sine[l - 1] * b) + input[2 * l - 1] * e;\n\
             \x20       z[2 * l] = (cosine[l - 1] * b - sine[l - 1] * a) + input[2 * l] * e;\n    }\n",
        );
    }
    source.push_str("    return u;\n}\n");
    source
}

fn array(name: &str, values: &[f64]) -> String {
    let entries: Vec<String> = values.iter().map(|value| format!("    {}", literal(*value))).collect();
    format!("static const double {name}[{}] = {{\n{}\n}};\n", values.len(), entries.join(",\n"))
}

/// The literal, with the decimal beside it for a reader.
fn literal(value: f64) -> String {
    format!("{} /* {} */", hexadecimal(value), decimal(value))
}

/// A finite double as a C99 hexadecimal literal.
fn hexadecimal(value: f64) -> String {
    let bits = value.to_bits();
    let sign = if value.is_sign_negative() { "-" } else { "" };
    let fraction = bits & ((1 << 52) - 1);
    // Eleven bits fit.
    let exponent = ((bits >> 52) & 0x7ff) as i64;
    match (exponent, fraction) {
        (0, 0) => format!("{sign}0x0p+0"),
        // Subnormal numbers have no leading 1, and the exponent of the smallest normal ones.
        (0, _) => format!("{sign}0x0.{fraction:013x}p-1022"),
        _ => format!("{sign}0x1.{fraction:013x}p{:+}", exponent - 1023),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hexadecimal_literals() {
        for (value, text) in [
            (1.0, "0x1.0000000000000p+0"),
            (-0.1, "-0x1.999999999999ap-4"),
            (0.0, "0x0p+0"),
            (6.5, "0x1.a000000000000p+2"),
            (5e-324, "0x0.0000000000001p-1022"),
        ] {
            assert_eq!(hexadecimal(value), text);
        }
    }
}
