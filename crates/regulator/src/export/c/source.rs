//! The source of exported C code.

use super::Prefix;
use super::literal::{array, literal};
use crate::Discrete;
use crate::export::Export;
use sigmastar_lang::spec::Actuator;

/// The source below the inclusion of its header.
pub(super) fn source(export: &Export<'_>, discrete: &Discrete, prefix: &Prefix) -> String {
    let regulator = export.regulator;
    let (cosines, sines): (Vec<f64>, Vec<f64>) = discrete.rotations.iter().map(|[c, s]| (*c, *s)).unzip();
    let mut source = String::from(
        "/* The same bits on every machine need each operation rounded on its own: GCC does so with -std=c99 or\n\
         \x20* -ffp-contract=off, other compilers follow this pragma. */\n\
         #if !defined(__GNUC__) || defined(__clang__)\n#pragma STDC FP_CONTRACT OFF\n#endif\n\n",
    );
    let kept = discrete.prediction.map_or(("decay", discrete.decay), |product| ("product", product));
    let numbers = [("sigma", regulator.sigma), ("gain", discrete.gain), kept];
    let saturation = discrete.saturation.map(|limit| [("step", discrete.step), ("limit", limit)]);
    let nominal = regulator.nominal.map(|nominal| ("nominal", nominal));
    let middle = export.middle.map(|middle| ("middle", middle));
    let ends = export.actuator.and_then(Actuator::ends).filter(|_| middle.is_some());
    let of_ends = ends.map(|[lowest, highest]| [("lowest", lowest), ("highest", highest)]);
    let middle = middle.into_iter().chain(of_ends.into_iter().flatten());
    for (name, value) in numbers.into_iter().chain(nominal).chain(middle).chain(saturation.into_iter().flatten()) {
        source.push_str(&format!("static const double {name} = {};\n", literal(value)));
    }
    source.push_str(&array("weight", &regulator.weights));
    if !cosines.is_empty() {
        source.push_str(&array("cosine", &cosines));
        source.push_str(&array("sine", &sines));
    }
    let upper = prefix.upper();
    let delayed = discrete.prediction.is_some();
    source.push_str(&reset(&upper, prefix, (!cosines.is_empty(), delayed), export.aligned));
    let put_out = PutOut {
        saturation: discrete.saturation.is_some(),
        nominal: regulator.nominal.is_some(),
        moved: export.middle.is_some(),
        within: ends.is_some(),
        delayed,
    };
    source.push_str(&step(&upper, prefix, !cosines.is_empty(), put_out));
    source
}

/// z at the first instant: 0, or M e; with a delay nothing is predicted yet.
fn reset(upper: &str, prefix: &Prefix, (oscillators, delayed): (bool, bool), aligned: bool) -> String {
    let ahead = if delayed { "    controller->ahead = 0.0;\n" } else { "" };
    if !aligned {
        return format!(
            "\nvoid {prefix}_reset({prefix}_controller *controller)\n{{\n    int i;\n\n\
             \x20   for (i = 0; i < {upper}_STATES; i++) {{\n        controller->z[i] = 0.0;\n    }}\n{ahead}}}\n\n"
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
         \x20   controller->z[0] = e;\n{blocks}{ahead}}}\n\n"
    )
}

/// What is done to the control before it is put out.
#[derive(Clone, Copy)]
struct PutOut {
    /// Whether it is clipped.
    saturation: bool,
    /// Whether it is divided by a nominal gain.
    nominal: bool,
    /// Whether it is measured from the middle of a range.
    moved: bool,
    /// Whether it then is cut off at the ends of that range, which it may leave by rounding alone.
    within: bool,
    /// Whether it is put out at the next sample.
    delayed: bool,
}

/// The operations of the Rust stepper, in its order.
fn step(upper: &str, prefix: &Prefix, oscillators: bool, put_out: PutOut) -> String {
    let PutOut { saturation, nominal, moved, within, delayed } = put_out;
    let wanted = match (saturation, nominal) {
        (false, _) => "",
        (true, false) => ", wanted",
        (true, true) => ", wanted, applied",
    };
    let index = if oscillators { "    int l;\n" } else { "" };
    let (next, first) = match delayed {
        true => {
            (", next", "    /* What e is at the next sample without input. */\n    next = e + controller->ahead;\n")
        }
        false => ("", ""),
    };
    // What R turns further with a delay.
    let turned = match delayed {
        true => "(cosine[l - 1] * z[2 * l - 1] + sine[l - 1] * z[2 * l])",
        false => "z[2 * l - 1]",
    };
    let mut text = format!(
        "double {prefix}_step({prefix}_controller *controller, double e)\n{{\n    double *z = controller->z;\n\
         \x20   double sum, carry, u{next}{wanted};\n{index}\n{first}\
         \x20   /* z becomes R (z - M e). */\n    z[0] -= e;\n    sum = weight[0] * z[0];\n"
    );
    if oscillators {
        text.push_str(&format!(
            "    for (l = 1; l <= {upper}_OSCILLATORS; l++) {{\n\
             \x20       double a = z[2 * l - 1] - e;\n        double b = z[2 * l];\n\n\
             \x20       z[2 * l - 1] = cosine[l - 1] * a + sine[l - 1] * b;\n\
             \x20       z[2 * l] = cosine[l - 1] * b - sine[l - 1] * a;\n\
             \x20       sum += weight[l] * {turned};\n    }}\n"
        ));
    }
    text.push_str(match delayed {
        true => "    u = gain * sum - sigma * next;\n    carry = -(product * next);\n",
        false => "    u = gain * sum - sigma * e;\n    carry = decay * e;\n",
    });
    let (added, told) = if delayed { ("next", "the prediction") } else { ("carry", "z") };
    if nominal && !saturation {
        text.push_str("    /* What is put out is over the nominal gain of the actuator. */\n    u = u / nominal;\n");
    }
    if nominal && saturation {
        text.push_str(&format!(
            "    /* What is put out is over the nominal gain of the actuator. Against windup: {told} is told the control that\n\
             \x20    * is applied. */\n    wanted = u;\n    applied = u;\n    u = wanted / nominal;\n\
             \x20   if (u > limit) {{\n        u = limit;\n        applied = nominal * limit;\n    }}\n\
             \x20   if (u < -limit) {{\n        u = -limit;\n        applied = -(nominal * limit);\n    }}\n\
             \x20   carry += step * (applied - wanted);\n",
        ));
    }
    if saturation && !nominal {
        text.push_str(&format!(
            "    /* Against windup: {told} is told the control that is applied. */\n    wanted = u;\n\
             \x20   if (u > limit) {{\n        u = limit;\n    }}\n    if (u < -limit) {{\n        u = -limit;\n    }}\n\
             \x20   carry += step * (u - wanted);\n",
        ));
    }
    text.push_str(&format!("    z[0] += {added};\n"));
    if oscillators {
        text.push_str(&format!(
            "    for (l = 1; l <= {upper}_OSCILLATORS; l++) {{\n        z[2 * l - 1] += {added};\n    }}\n"
        ));
    }
    if delayed {
        text.push_str("    controller->ahead = carry;\n");
    }
    if moved {
        text.push_str("    /* u is measured from the middle of the range of the actuator. */\n    u = middle + u;\n");
    }
    if within {
        text.push_str(
            "    /* Rounding alone may bring it out of the range. */\n    if (u > highest) {\n        u = highest;\n    }\n\
             \x20   if (u < lowest) {\n        u = lowest;\n    }\n",
        );
    }
    text.push_str("    return u;\n}\n");
    text
}
