//! The parts that several files have.

use super::shape::{Field, Shape, Sign, list, may, must};
use sigmastar_lang::spec::MAX_WEIGHTS;

/// A positive constant.
pub(super) const POSITIVE: Shape = Shape::Constant(Sign::Positive);

/// A constant that is not negative.
pub(super) const NONNEGATIVE: Shape = Shape::Constant(Sign::Nonnegative);

/// `$schema`, `format`, `version`, `name`, `description`.
pub(super) fn header(format: &'static str, versions: &[u64]) -> Vec<Field> {
    vec![
        may("$schema", "Schema", "Where an editor finds the schema of this file. It is ignored.", Shape::Text),
        must("format", "Format", "The kind of this file.", Shape::Word(vec![format])),
        must("version", "Version", "The version of the format.", Shape::Version(versions.to_vec())),
        must("name", "Name", "Free text for reports; no claim depends on it.", Shape::Text),
        may("description", "Description", "Free text for reports; no claim depends on it.", Shape::Text),
    ]
}

/// `internal_model`.
pub(super) fn internal_model() -> Field {
    let fields = vec![
        must("mu", "Gain mu", "The gain of the internal model, in 1/time.", POSITIVE),
        must(
            "base_frequency",
            "Base frequency w",
            "The oscillators have the frequencies w, 2 w, 3 w, ..., in radians per unit of time.",
            POSITIVE,
        ),
        may(
            "matched",
            "Matched",
            "Whether base_frequency is 2 pi / period, which is proved exactly. Without it: false.",
            Shape::Boolean,
        ),
        must(
            "weights",
            "Weights",
            "The weights n_0, n_1, ... of the oscillators; they are proved to be summable.",
            weights(),
        ),
        may(
            "harmonics",
            "Sets of harmonics",
            "every-set: a claim about oscillators at every finite set of harmonics that contains 0; first: at the first n_o harmonics alone, for every n_o.",
            Shape::Word(vec!["first", "every-set"]),
        ),
        may(
            "sampling_period",
            "Sampling period h",
            "Asks for the regulator at samples, in units of time: the period is a whole multiple, and `matched` is true.",
            POSITIVE,
        ),
        may(
            "delay_samples",
            "Samples of delay",
            "1 for the law whose control is computed in the sample before it acts, with `sampling_period`; 0 is the law without it.",
            Shape::Whole(0, 1),
        ),
    ];
    must("internal_model", "Internal model", "The oscillators of the regulator.", Shape::Object(fields))
}

/// The nominal value of a constant and the ends of the interval that it is from, each with its title and its description.
pub(super) fn interval(sign: Sign, ends: [(&'static str, &'static str); 3]) -> Shape {
    let fields = ["nominal", "low", "high"].into_iter().zip(ends);
    Shape::Object(fields.map(|(name, (title, text))| must(name, title, text, Shape::Constant(sign))).collect())
}

/// `period`.
pub(super) fn period() -> Field {
    let ends = [
        ("Nominal period", "What the oscillators, exports and figures are about."),
        ("Shortest period", "The true period is at least this, at most the nominal one."),
        ("Longest period", "The true period is at most this, at least the nominal one."),
    ];
    must(
        "period",
        "Period T",
        "The period of f and q in t, in units of time; or an interval of one constant, with time in formulas as `phase`, which is \
         2 pi t/T, and without `matched`.",
        Shape::OneOf(vec![POSITIVE, interval(Sign::Positive, ends)]),
    )
}

/// `input_gain`.
pub(super) fn input_gain() -> Field {
    let ends = [
        ("Nominal gain", "What the regulator divides its control by."),
        ("Smallest gain", "The true gain of the actuator is at least this, at most the nominal one."),
        ("Largest gain", "The true gain of the actuator is at most this, at least the nominal one."),
    ];
    may(
        "input_gain",
        "Input gain",
        "An actuator whose gain is one constant that is known to an interval: e' = q + gain u. Without it the gain is 1.",
        interval(Sign::Positive, ends),
    )
}

/// `actuator`.
pub(super) fn actuator(of_plant: bool) -> Field {
    const MAX: (&str, &str) = (
        "Greatest control",
        "The greatest size of what is put out that the actuator takes, in the units of that: with an input gain of the control over the nominal gain.",
    );
    let of_size = Shape::Object(vec![must("max", MAX.0, MAX.1, POSITIVE)]);
    let shape = match of_plant {
        false => of_size,
        true => Shape::OneOf(vec![
            of_size,
            Shape::Object(vec![
                must(
                    "min",
                    "Lower limit",
                    "What is put out acts as it is from `min` to `max`, rational numbers: u is measured from the middle of both.",
                    Shape::Constant(Sign::Any),
                ),
                must("max", "Upper limit", "Above `min`.", Shape::Constant(Sign::Any)),
            ]),
        ]),
    };
    may(
        "actuator",
        "Actuator",
        "An actuator that saturates: it takes the output as it is up to `max` in size. The claim is then about one gain. From its set, \
         without noise, the actuator never saturates.",
        shape,
    )
}

/// `measurement`.
pub(super) fn measurement() -> Field {
    let fields = vec![
        may("noise", "Noise", "The greatest size of the noise on the measured e, in the unit of e.", Shape::Ratio),
        may("quantum", "Quantum", "The step of the converter that rounds the measured e to nearest.", Shape::Ratio),
    ];
    may(
        "measurement",
        "Measurement",
        "The regulator measures e + v with |v| <= noise + quantum/2; state one of the two, or both. Only the bounds for given numbers of \
         oscillators (`certify --n-o`) include it.",
        Shape::Object(fields),
    )
}

/// `disturbance`.
pub(super) fn disturbance() -> Field {
    may(
        "disturbance",
        "Disturbance",
        "The greatest size of what is added to q, in the unit of e'. Only the bounds for given numbers of oscillators (`certify --n-o`) include it.",
        Shape::Ratio,
    )
}

/// `arithmetic`.
pub(super) fn arithmetic() -> Field {
    may(
        "arithmetic",
        "Arithmetic",
        "How the law at samples is computed: `exact`, without rounding (the default), or `double`, as the exported C code does. Only the bounds for \
         given numbers of oscillators (`certify --n-o`) include the rounding.",
        Shape::Word(vec!["exact", "double"]),
    )
}

fn weights() -> Shape {
    let family = |name| must("family", "Family", "How the weights are given.", Shape::Word(vec![name]));
    let power = vec![
        family("power"),
        must("n0", "n_0", "The weight of the integrator, above 1.", Shape::Constant(Sign::Any)),
        must("epsilon", "epsilon", "The weight of oscillator l is l^-(1 + epsilon).", Shape::Constant(Sign::Any)),
    ];
    let tail = vec![
        must("coefficient", "Coefficient", "c in c l^-p.", Shape::Constant(Sign::Any)),
        must("exponent", "Exponent", "p in c l^-p.", Shape::Constant(Sign::Any)),
    ];
    let explicit = vec![
        family("explicit"),
        must("values", "Values", "n_0, n_1, ... one by one.", list(Shape::Constant(Sign::Any), MAX_WEIGHTS)),
        must("tail", "Tail", "The weights beyond the list: c l^-p.", Shape::Object(tail)),
    ];
    Shape::OneOf(vec![Shape::Object(power), Shape::Object(explicit)])
}

/// The kinds of `initial_set`; of a plant a ball may stand for X0.
pub(super) fn initial_set(ball: bool) -> Shape {
    let kind = |name| must("kind", "Kind", "What the initial set is.", Shape::Word(vec![name]));
    let x0 = || {
        let text = if ball { "Bounds |L^-1 (x - x_0)| in the norm of the certificate." } else { "Bounds |x|." };
        ("X0", "X0", text, NONNEGATIVE)
    };
    let round = || ("ball", "Ball", "The set contains |x - x_0| up to this radius.", NONNEGATIVE);
    let e0 = || ("E0", "E0", "Bounds |e|.", NONNEGATIVE);
    let optional = |(name, title, text, shape)| may(name, title, text, shape);
    let required = |(name, title, text, shape)| must(name, title, text, shape);
    let z0 = || must("Z0", "Z0", "Bounds |z|_N = sqrt(z'Nz), the state of the regulator.", NONNEGATIVE);
    let mut kinds = vec![
        Shape::Object(vec![kind("paper")]),
        Shape::Object(vec![kind("at-rest"), optional(x0()), optional(e0())]),
        Shape::Object(vec![kind("aligned"), optional(x0()), optional(e0())]),
        // Of a plant without states it may be left out, which is read with the states alone.
        Shape::Object(vec![kind("box"), if ball { optional(x0()) } else { required(x0()) }, required(e0()), z0()]),
    ];
    if ball {
        kinds.push(Shape::Object(vec![kind("at-rest"), required(round()), optional(e0())]));
        kinds.push(Shape::Object(vec![kind("aligned"), required(round()), optional(e0())]));
        kinds.push(Shape::Object(vec![kind("box"), required(round()), required(e0()), z0()]));
    }
    Shape::OneOf(kinds)
}
