//! The fields of a plant.

use super::parts::{
    POSITIVE, actuator, arithmetic, disturbance, header, initial_set, input_gain, internal_model, interval,
    measurement, period,
};
use super::shape::{Field, Shape, Sign, any_list, may, must};
use sigmastar_lang::plant::{FORMAT, VERSIONS};

/// What formulas are in.
const VARIABLES: &str = "t, phase, the states, e and the parameters";

/// All fields; those of a file of its own, or of a copy in another one.
pub(super) fn fields() -> Vec<Field> {
    let number = || Shape::Constant(Sign::Any);
    let start = vec![
        must("x", "x", "One number for each state.", any_list(number())),
        must("e", "e", "The regulated output.", number()),
        may("z", "z", "The state of the regulator; at rest without it.", any_list(number())),
    ];
    let domain = vec![
        must("x", "x", "The model holds for |x - x_0(t)| up to this.", POSITIVE),
        must("e", "e", "The model holds for |e| up to this.", POSITIVE),
    ];
    let ends = [
        ("Nominal value", "What is expected, a rational number."),
        ("Low", "The least value, a rational number."),
        ("High", "The largest value, a rational number."),
    ];
    let mut fields = header(FORMAT, &VERSIONS);
    fields.extend([
        period(),
        must(
            "states",
            "States",
            "The names of the states x, such as x1; empty where there are none.",
            any_list(Shape::Text),
        ),
        must(
            "f",
            "f",
            "x' = f(t,x,e): for each state a formula in t, the states and e.",
            any_list(Shape::Expression(VARIABLES)),
        ),
        must("q", "q", "e' = q(t,x,e) + u.", Shape::Expression(VARIABLES)),
        may(
            "parameters",
            "Parameters",
            "Constants by their names, which may stand for them in f, q, period, initial, initial_set, domain, and in mu, \
             base_frequency and sampling_period of internal_model; at most 12. Of at most 4 an interval may be given: these \
             stand in f and q alone, and the claim is for every constant value in it.",
            Shape::Map(Box::new(Shape::OneOf(vec![number(), interval(Sign::Any, ends)]))),
        ),
        may(
            "initial",
            "Start of simulations",
            "Where `simulate` starts; no claim depends on it.",
            Shape::Object(start),
        ),
        may("initial_set", "Initial set", "The initial conditions that the claim covers.", initial_set(true)),
        may("domain", "Domain", "Where the model holds; everywhere without it.", Shape::Object(domain)),
        internal_model(),
        input_gain(),
        actuator(true),
        measurement(),
        disturbance(),
        arithmetic(),
    ]);
    fields
}
