//! A program for exported C code: a first run on a small plant.

use super::literal::literal;
use super::{CNames, harmless};
use crate::Discrete;
use crate::export::{Export, decimal};

/// A double as the right side of a difference.
fn signed(value: f64) -> String {
    if value < 0.0 { format!("({})", decimal(value)) } else { decimal(value) }
}

/// A `main` that runs the regulator on e' = q(t) + u for a number of periods and prints the largest error of each.
pub(super) fn example(export: &Export<'_>, discrete: &Discrete, names: &CNames) -> String {
    let (prefix, upper) = (&names.prefix, names.prefix.upper());
    // Without oscillators any length serves as a period.
    let frequency = export.regulator.frequencies.first();
    let period = frequency.map_or(50.0 * discrete.step, |frequency| std::f64::consts::TAU / frequency);
    let samples = (period / discrete.step).round().clamp(1.0, 1e6);
    // Half of what the control can do.
    let amplitude = discrete.saturation.map_or(1.0, |limit| limit / 2.0);
    // What the actuator makes of u.
    let from_middle = export.middle.map_or_else(|| "u".to_owned(), |middle| format!("(u - {})", signed(middle)));
    let acting =
        export.regulator.nominal.map_or(from_middle.clone(), |gain| format!("{} * {from_middle}", decimal(gain)));
    let argument = if export.aligned { ", e" } else { "" };
    // With a delay the control that is returned acts in the next sample.
    let (declared, called, kept) = match discrete.prediction {
        Some(_) => {
            let first = export.middle.map_or_else(|| "0.0".to_owned(), literal);
            (format!("    double u = {first};\n"), "double next", "            u = next;\n")
        }
        None => (String::new(), "double u", ""),
    };
    format!(
        "/* A first run of the regulator for: {}\n\
         \x20* The plant is e' = q(t) + {acting}; q is two arcs of a parabola in each period of {samples} samples. Prints the largest |e| of\n\
         \x20* each period. Replace the plant by a measurement of e and an output of u in the interrupt of a timer. */\n\
         #include \"{}\"\n#include <stdio.h>\n\n\
         static const int samples = {samples};\n\
         static const double amplitude = {};\n\n\
         /* The disturbance at a part of the period, from 0 to 1. */\n\
         static double disturbance(double phase)\n{{\n\
         \x20   if (phase < 0.5) {{\n        return amplitude * 16.0 * phase * (0.5 - phase);\n    }}\n\
         \x20   return -amplitude * 16.0 * (phase - 0.5) * (1.0 - phase);\n}}\n\n\
         int main(void)\n{{\n    {prefix}_controller controller;\n    double e = 0.0;\n{declared}    int period, k;\n\n\
         \x20   {prefix}_reset(&controller{argument});\n\
         \x20   for (period = 1; period <= 20; period++) {{\n        double largest = 0.0;\n\n\
         \x20       for (k = 0; k < samples; k++) {{\n\
         \x20           {called} = {prefix}_step(&controller, e);\n\
         \x20           double size = e < 0.0 ? -e : e;\n\n\
         \x20           if (size > largest) {{\n                largest = size;\n            }}\n\
         \x20           e += {upper}_SAMPLING_TIME * (disturbance((k + 0.5) / samples) + {acting});\n{kept}        }}\n\
         \x20       printf(\"period %2d: largest |e| = %.3e\\n\", period, largest);\n    }}\n    return 0;\n}}\n",
        harmless(export.name),
        names.header,
        decimal(amplitude)
    )
}
