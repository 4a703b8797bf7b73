//! The fields of a parameter study.

use super::parts::{POSITIVE, header};
use super::shape::{Field, Shape, Sign, list, may, must};
use sigmastar_studies::sweep::{FORMAT, MAX_CASES, MAX_PARAMETERS, VERSIONS};

/// A study of either design.
pub(super) fn shape() -> Shape {
    Shape::OneOf(vec![Shape::Object(fields("grid")), Shape::Object(fields("latin"))])
}

fn fields(design: &'static str) -> Vec<Field> {
    let latin = design == "latin";
    let mut fields = header(FORMAT, &VERSIONS);
    fields.extend([
        must(
            "subject",
            "Subject",
            "The path of a specification or plant, relative to this file, or one in place.",
            Shape::OneOf(vec![Shape::Text, Shape::Foreign]),
        ),
        may("derivation", "Derivation", "What the verdicts are about; `sharp` without it.", Shape::Word(vec!["sharp"])),
        may(
            "sampling_period",
            "Sampling period h",
            "Of every case: the regulator at samples, in units of time.",
            POSITIVE,
        ),
        must("design", "Design", "How the values are combined.", Shape::Word(vec![design])),
    ]);
    if latin {
        fields.push(must("count", "Count", "How many cases there are.", Shape::Whole(2, MAX_CASES)));
        fields.push(must("seed", "Seed", "From which the cases are drawn.", Shape::Whole(0, u64::MAX)));
    }
    let of = |named: bool| ["values", "linear", "logarithmic"].map(|kind| Shape::Object(parameter(kind, latin, named)));
    let kinds: Vec<Shape> = of(false).into_iter().chain(of(true)).collect();
    let text = "What is varied, and through which values.";
    fields.push(must("parameters", "Parameters", text, list(Shape::OneOf(kinds), MAX_PARAMETERS)));
    fields
}

/// A place by its pointer, or by the name of a parameter of the plant, and its values.
fn parameter(kind: &'static str, latin: bool, named: bool) -> Vec<Field> {
    let range = || {
        let mut fields = vec![
            must("from", "From", "The first value, a rational number.", Shape::Constant(Sign::Any)),
            must("to", "To", "The last value, a rational number.", Shape::Constant(Sign::Any)),
        ];
        if !latin {
            fields.push(must("count", "Count", "How many values there are.", Shape::Whole(2, MAX_CASES)));
        }
        Shape::Object(fields)
    };
    let values = match kind {
        "values" => {
            let shape = Shape::List(Box::new(Shape::Scalar), 1, None);
            must(kind, "Values", "The values, one by one.", shape)
        }
        "linear" => must(kind, "Linear range", "Values at equal distances, exactly.", range()),
        _ => must(kind, "Logarithmic range", "Positive values at equal ratios, to six digits.", range()),
    };
    let place = if named {
        must("parameter", "Parameter", "The name of one of the plant's parameters.", Shape::Text)
    } else {
        let text = "The JSON pointer (RFC 6901) of the value in the subject, as /lyapunov/alpha.";
        must("pointer", "Pointer", text, Shape::Text)
    };
    let usual = if named { "its name" } else { "the pointer" };
    vec![
        place,
        may("name", "Name", format!("What tables and figures call it; {usual} without it."), Shape::Text),
        values,
    ]
}
