//! The fields of a bounding specification.

use super::parts::{
    NONNEGATIVE, POSITIVE, actuator, arithmetic, disturbance, header, initial_set, input_gain, internal_model,
    measurement, period,
};
use super::shape::{Field, Shape, Sign, list, may, must};
use sigmastar_lang::spec::{Bound, FORMAT, MAX_HARMONICS, MAX_RELATIVE_DEGREE_COEFFICIENTS, MAX_STATES, VERSIONS};

/// All fields.
pub(super) fn fields() -> Vec<Field> {
    let mut fields = header(FORMAT, &VERSIONS);
    let harmonics = vec![
        must(
            "harmonics",
            "Harmonics",
            "Bounds of the magnitudes of the complex Fourier coefficients c_0, c_1, ... of q(t,0,0).",
            list(NONNEGATIVE, MAX_HARMONICS),
        ),
        must("rest_rms", "Rest", "Bounds the root mean square of what the harmonics leave.", NONNEGATIVE),
        may("rest_t_rms", "Derivative of the rest", "Bounds the root mean square of its derivative.", NONNEGATIVE),
    ];
    let domain = vec![
        must("X", "X", "The bounds hold for |x| up to this.", POSITIVE),
        must("E", "E", "The bounds hold for |e| up to this.", POSITIVE),
    ];
    let filter = must(
        "a",
        "Coefficients",
        "a_1, ..., a_(r-1) of e = xi_r + a_(r-1) xi_(r-1) + ... + a_1 xi_1: rational numbers, a stable polynomial.",
        list(Shape::Constant(Sign::Any), MAX_RELATIVE_DEGREE_COEFFICIENTS),
    );
    fields.extend([
        period(),
        must("lyapunov", "Lyapunov data", "How the zero dynamics x' = f(t,x,0) contract near 0.", lyapunov()),
        must("bounds", "Bounding functions", "Bounds of f, q and their derivatives.", Shape::Object(bounds("bounds"))),
        may("q_0", "Known disturbance", "What is known of q(t,0,0).", Shape::Object(harmonics)),
        may("domain", "Domain", "Where the bounding functions hold; everywhere without it.", Shape::Object(domain)),
        internal_model(),
        input_gain(),
        actuator(false),
        measurement(),
        disturbance(),
        arithmetic(),
        must("initial_set", "Initial set", "The initial conditions that the claim covers.", initial_set(false)),
        may("relative_degree", "Relative degree", "The filter of an output of higher relative degree.", {
            Shape::Object(vec![filter])
        }),
    ]);
    fields
}

fn lyapunov() -> Shape {
    let mut triple = vec![
        must("p_low", "p_low", "p_low I <= P(t).", POSITIVE),
        must("p_up", "p_up", "P(t) <= p_up I.", POSITIVE),
        must("alpha", "alpha", "P' + P F + F'P <= -2 alpha P for F = df/dx(t,0,0), in 1/time.", POSITIVE),
    ];
    triple.extend(bounds("lyapunov"));
    let end = || Shape::Constant(Sign::Any);
    let interval = Shape::List(Box::new(end()), 2, Some(2));
    let entry = Shape::OneOf(vec![Shape::Expression("t and phase"), interval]);
    let jacobian = must(
        "jacobian",
        "Jacobian",
        "df/dx(t,0,0) by rows, in 1/time, in place of the triple: numbers, intervals [\"lo\", \"hi\"], and trigonometric \
         polynomials in t with the period.",
        list(list(entry, MAX_STATES), MAX_STATES),
    );
    Shape::OneOf(vec![Shape::Object(triple), Shape::Object(vec![jacobian])])
}

/// The bounding functions of a section, from their table.
fn bounds(section: &str) -> Vec<Field> {
    // What only a plant's formulas give has no field.
    let given = |bound: &Bound| bound.section() == section && *bound != Bound::RateExistence;
    let field = |bound: Bound| {
        let what = bound.of_what();
        let text = match bound {
            Bound::QRms => "Bounds the root mean square over a period of sup |q|; q serves without it.".to_owned(),
            Bound::QtRms => {
                "Bounds the root mean square over a period of sup |dq/dt|; q_t serves without it.".to_owned()
            }
            Bound::QeMax => "An upper bound of dq/de, which may be negative; q_e serves without it.".to_owned(),
            Bound::Rate => "A lower bound of the contraction rate of df/dx in P, in 1/time; nonincreasing.".to_owned(),
            _ => format!("Bounds {what} for |x| <= X, |e| <= E and every t; nondecreasing."),
        };
        let make = if bound.is_required() { must } else { may };
        make(bound.field(), format!("Bound of {what}"), text, Shape::Expression("X and E"))
    };
    Bound::ALL.into_iter().filter(given).map(field).collect()
}
