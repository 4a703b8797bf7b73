//! The source of exported C code.

use super::Prefix;
use super::literal::{array, literal};
use crate::Discrete;
use crate::export::Export;

/// The source below the inclusion of its header.
pub(super) fn source(export: &Export<'_>, discrete: &Discrete, prefix: &Prefix) -> String {
    let regulator = export.regulator;
    let (cosines, sines): (Vec<f64>, Vec<f64>) = discrete.rotations.iter().map(|[c, s]| (*c, *s)).unzip();
    let mut source = String::from(
        "/* The same bits on every machine need each operation rounded on its own: GCC does so with -std=c99 or\n\
         \x20* -ffp-contract=off, other compilers follow this pragma. */\n\
         #if !defined(__GNUC__) || defined(__clang__)\n#pragma STDC FP_CONTRACT OFF\n#endif\n\n",
    );
    let numbers = [("sigma", regulator.sigma), ("gain", discrete.gain), ("decay", discrete.decay)];
    let saturation = discrete.saturation.map(|limit| [("step", discrete.step), ("limit", limit)]);
    let nominal = regulator.nominal.map(|nominal| ("nominal", nominal));
    for (name, value) in numbers.into_iter().chain(nominal).chain(saturation.into_iter().flatten()) {
        source.push_str(&format!("static const double {name} = {};\n", literal(value)));
    }
    source.push_str(&array("weight", &regulator.weights));
    if !cosines.is_empty() {
        source.push_str(&array("cosine", &cosines));
        source.push_str(&array("sine", &sines));
    }
    let upper = prefix.upper();
    source.push_str(&reset(&upper, prefix, !cosines.is_empty(), export.aligned));
    let put_out = PutOut { saturation: discrete.saturation.is_some(), nominal: regulator.nominal.is_some() };
    source.push_str(&step(&upper, prefix, !cosines.is_empty(), put_out));
    source
}

/// z at the first instant: 0, or M e.
fn reset(upper: &str, prefix: &Prefix, oscillators: bool, aligned: bool) -> String {
    if !aligned {
        return format!(
            "\nvoid {prefix}_reset({prefix}_controller *controller)\n{{\n    int i;\n\n\
             \x20   for (i = 0; i < {upper}_STATES; i++) {{\n        controller->z[i] = 0.0;\n    }}\n}}\n\n"
        );
    }
    let (index, blocks) = match oscillators {
        true => (
            "    int l;\n\n",
            format!(
                "    for (l = 1; l <= {upper}_OSCILLATORS; l++) {{\n        controller->z[2 * l - 1] = e;\n\
                 \x20       controller->z[2 * l] = 0.0;\n    }}\n"
            ),
        ),
        false => ("", String::new()),
    };
    format!(
        "\nvoid {prefix}_reset({prefix}_controller *controller, double e)\n{{\n{index}\
         \x20   controller->z[0] = e;\n{blocks}}}\n\n"
    )
}

/// What is done to the control before it is put out.
#[derive(Clone, Copy)]
struct PutOut {
    /// Whether it is clipped.
    saturation: bool,
    /// Whether it is divided by a nominal gain.
    nominal: bool,
}

/// The operations of the Rust stepper, in its order.
fn step(upper: &str, prefix: &Prefix, oscillators: bool, put_out: PutOut) -> String {
    let PutOut { saturation, nominal } = put_out;
    let wanted = match (saturation, nominal) {
        (false, _) => "",
        (true, false) => ", wanted",
        (true, true) => ", wanted, applied",
    };
    let index = if oscillators { "    int l;\n" } else { "" };
    let mut text = format!(
        "double {prefix}_step({prefix}_controller *controller, double e)\n{{\n    double *z = controller->z;\n\
         \x20   double sum, carry, u{wanted};\n{index}\n\
         \x20   /* z becomes R (z - M e). */\n    z[0] -= e;\n    sum = weight[0] * z[0];\n"
    );
    if oscillators {
        text.push_str(&format!(
            "    for (l = 1; l <= {upper}_OSCILLATORS; l++) {{\n\
             \x20       double a = z[2 * l - 1] - e;\n        double b = z[2 * l];\n\n\
             \x20       z[2 * l - 1] = cosine[l - 1] * a + sine[l - 1] * b;\n\
             \x20       z[2 * l] = cosine[l - 1] * b - sine[l - 1] * a;\n\
             \x20       sum += weight[l] * z[2 * l - 1];\n    }}\n"
        ));
    }
    text.push_str("    u = gain * sum - sigma * e;\n    carry = decay * e;\n");
    if nominal && !saturation {
        text.push_str("    /* What is put out is over the nominal gain of the actuator. */\n    u = u / nominal;\n");
    }
    if nominal && saturation {
        text.push_str(
            "    /* What is put out is over the nominal gain of the actuator. Against windup: z is told the control that\n\
             \x20    * is applied. */\n    wanted = u;\n    applied = u;\n    u = wanted / nominal;\n\
             \x20   if (u > limit) {\n        u = limit;\n        applied = nominal * limit;\n    }\n\
             \x20   if (u < -limit) {\n        u = -limit;\n        applied = -(nominal * limit);\n    }\n\
             \x20   carry += step * (applied - wanted);\n",
        );
    }
    if saturation && !nominal {
        text.push_str(
            "    /* Against windup: z is told the control that is applied. */\n    wanted = u;\n\
             \x20   if (u > limit) {\n        u = limit;\n    }\n    if (u < -limit) {\n        u = -limit;\n    }\n\
             \x20   carry += step * (u - wanted);\n",
        );
    }
    text.push_str("    z[0] += carry;\n");
    if oscillators {
        text.push_str(&format!(
            "    for (l = 1; l <= {upper}_OSCILLATORS; l++) {{\n        z[2 * l - 1] += carry;\n    }}\n"
        ));
    }
    text.push_str("    return u;\n}\n");
    text
}
