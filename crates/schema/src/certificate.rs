//! The fields of a certificate. It is written by the program; the schema is for readers of it.

use super::shape::{Field, Shape, Sign, any_list, list, may, must};
use super::{parts, plant, specification};
use sigmastar_lang::spec::{
    Bound, JointInequality, Level, MatrixInequality, Metric, ProvedValue, SampledInequality, Splitting,
};
use sigmastar_prove::certificate::{FORMAT, NumberFields, RefinedSquares, VERSION};
use sigmastar_prove::rate::bound::{MAX_COUNTS, MAX_OSCILLATORS};
use sigmastar_theory::derivation::exact_regulation::ExactWitness;
use sigmastar_theory::derivation::paths::Path;
use sigmastar_theory::derivation::repaired::RepairedWitness;
use sigmastar_theory::derivation::sampled::{DelayWitness, SampledWitness};
use sigmastar_theory::derivation::sharp::SharpWitness;

/// An exact rational number, as a decimal or a fraction.
fn rational() -> Shape {
    named("rational", Shape::Constant(Sign::Any))
}

/// A certificate of a specification or of a plant.
pub(super) fn shape() -> Shape {
    let of_specification = must(
        "specification",
        "Specification",
        "The specification as it was read.",
        Shape::Object(specification::fields(false)),
    );
    let of_plant = must("plant", "Plant", "The plant as it was read.", Shape::Object(plant::fields(false)));
    let digest =
        |name, what: &str| must(name, "Digest", format!("SHA-256 of the canonical form of the {what}."), Shape::Digest);
    Shape::OneOf(vec![
        Shape::Object(fields(of_specification, digest("specification_sha256", "specification"), false)),
        Shape::Object(fields(of_plant, digest("plant_sha256", "plant"), true)),
    ])
}

fn fields(embedded: Field, digest: Field, of_plant: bool) -> Vec<Field> {
    let tool = vec![
        must("name", "Name", "The program that wrote this file.", Shape::Text),
        must("version", "Version", "Its version.", Shape::Text),
    ];
    let claims = [false, true].map(|sampled| Shape::Object(claim(sampled, of_plant)));
    let witnesses = [Kind::MeanSquares, Kind::Sampled];
    let witnesses = Shape::OneOf(witnesses.map(|kind| Shape::Object(witness(kind, true))).into());
    let compared =
        vec![must("repaired", "Repaired", "Those of the repaired derivation.", Shape::Object(proof(Kind::Repaired)))];
    vec![
        must("format", "Format", "The kind of this file.", Shape::Word(vec![FORMAT])),
        must("version", "Version", "The version of the format.", Shape::Version(vec![VERSION])),
        must("tool", "Tool", "What wrote this file; free text.", Shape::Object(tool)),
        must("precision_bits", "Precision", "The bits at which the conditions were decided.", Shape::Whole(128, 4096)),
        embedded,
        digest,
        must("claim", "Claim", "What is claimed.", Shape::OneOf(claims.into())),
        must("witness", "Witness", "From what the claim is decided again.", named("witness", witnesses)),
        may("no_plant", "No plant", "That no plant with a state x satisfies the data.", Shape::Object(no_plant())),
        may(
            "comparison",
            "Comparison",
            "The free numbers of the repaired derivation; a figure.",
            named("comparison", Shape::Object(compared)),
        ),
        may(
            "conditions",
            "Conditions",
            "The conditions with both sides; figures.",
            any_list(named("condition", Shape::Object(condition()))),
        ),
        may("constants", "Constants", "The constants in each derivation; figures.", {
            Shape::Map(Box::new(named("constant", Shape::Object(constant()))))
        }),
    ]
}

fn named(name: &'static str, shape: Shape) -> Shape {
    Shape::Named(name, Box::new(shape))
}

fn claim(sampled: bool, of_plant: bool) -> Vec<Field> {
    let word = |name, title: &str, text: &str, word| must(name, title, text, Shape::Word(vec![word]));
    let mut fields = vec![word("verdict", "Verdict", "Nothing else is written.", "certified")];
    if sampled {
        fields.extend([
            word("regulator", "Regulator", "The regulator at samples.", "digital"),
            word("derivation", "Derivation", "How it is proved.", "sharp"),
            must("sigma", "Gain sigma", "The one gain that is certified, in 1/time.", rational()),
            must("sampling_period", "Sampling period h", "In units of time.", rational()),
            must("samples", "Samples", "period / h, a whole number.", Shape::Whole(2, 999_999_999)),
            must("gain", "Gain K", "K of the law at samples, a double.", rational()),
            word("n_o", "n_o", "For which numbers of oscillators.", "every n_o < samples/2"),
            may(
                "delay_samples",
                "Samples of delay",
                "1 where it is about the law whose control is computed in the sample before it acts.",
                Shape::Whole(0, 1),
            ),
        ]);
    } else {
        fields.extend([
            must("derivation", "Derivation", "How it is proved.", Shape::Word(vec!["sharp"])),
            may(
                "sigma_star",
                "sigma*",
                "Every gain from this one on is certified, in 1/time; without an actuator.",
                rational(),
            ),
            may("sigma", "Gain sigma", "The one gain that is certified, in 1/time; with an actuator.", rational()),
            word("n_o", "n_o", "For which numbers of oscillators.", "every n_o >= 0"),
        ]);
    }
    // An interval of one constant that the whole claim is about.
    let covered = |name, title, text, ends| may(name, title, text, parts::interval(Sign::Positive, ends));
    fields.push(covered(
        "input_gain",
        "Input gain",
        "Every constant gain of the actuator from `low` to `high` is covered; there where the document has one.",
        [
            ("Nominal gain", "What the regulator divides its control by."),
            ("Smallest gain", "The smallest gain that is covered."),
            ("Largest gain", "The largest gain that is covered."),
        ],
    ));
    let max = must("max", "Greatest control", "In the units of what is put out.", Shape::Constant(Sign::Positive));
    fields.push(may(
        "actuator",
        "Actuator",
        "What it takes, which what is put out never exceeds; there where the document has one.",
        Shape::Object(vec![max]),
    ));
    if !sampled {
        fields.push(covered(
            "period",
            "Period",
            "Every constant period from `low` to `high` is covered; there where the document has an interval.",
            [
                ("Nominal period", "What the oscillators are about."),
                ("Shortest period", "The shortest period that is covered."),
                ("Longest period", "The longest period that is covered."),
            ],
        ));
    }
    let set = |kinds: &[&'static str], sizes: Vec<Field>| {
        let kind = must("kind", "Kind", "What was asked for.", Shape::Word(kinds.to_vec()));
        let ball = may("ball", "Ball", "The set contains |x - x_0| up to this radius.", rational());
        Shape::Object([kind].into_iter().chain(sizes).chain(of_plant.then_some(ball)).collect())
    };
    let sets = Shape::OneOf(vec![
        set(&["paper", "at-rest", "box"], sizes().into()),
        // The regulator sets z = M e.
        set(&["aligned"], sizes().into_iter().take(2).collect()),
    ]);
    // Without a state x there is no bound of it.
    let orbit = [("x", "|x|"), ("e", "|e|"), ("zeta", "|zeta|_N"), ("z", "|z|_N")]
        .map(|(name, what)| may(name, what, format!("An upper bound of {what} along it."), rational()));
    let control = [("steady", "|u| along the periodic solution"), ("transient", "|u| less that, from the set")]
        .map(|(name, what)| must(name, name, format!("An upper bound of {what}."), rational()));
    fields.extend([
        must("mu", "Gain mu", "That of the specification.", rational()),
        must("initial_set", "Initial set", "The set that is covered.", sets),
        must("periodic_solution", "Periodic solution", "Bounds of it.", Shape::Object(orbit.into())),
        may("control", "Control", "Bounds of |u| at the gain of the claim.", Shape::Object(control.into())),
        must("statement", "Statement", "The claim in words.", Shape::Text),
    ]);
    let text = match sampled {
        false => {
            "For each of these n_o, at the gain of the claim alone: |e - e_per| <= factor exp(-rate (t - t_0)), in the loop without noise and disturbance."
        }
        true => {
            "For each of these n_o: |e - e_per| <= factor exp(-rate (t - t_0)) at the sampling instants t, in the loop without noise and disturbance."
        }
    };
    let mut rate = vec![count()];
    rate.push(must("rate", "Rate", "In 1/time.", rational()));
    rate.push(must("factor", "Factor", "For every start in the set, in the unit of e.", rational()));
    let noise = [("limit", "in the limit"), ("peak", "at all times from the start on")]
        .map(|(name, when)| must(name, name, format!("Bounds |e - e_per| {when}, in the unit of e."), rational()));
    let of_noise = "With the noise and the disturbance of the document.";
    rate.push(may("noise", "Noise", of_noise, Shape::Object(noise.into())));
    fields.push(may("for_n_o", "For given n_o", text, list(Shape::Object(rate), MAX_COUNTS)));
    if of_plant {
        let ends = ["nominal", "low", "high"];
        let interval = ends.map(|name| must(name, name, "A value of the parameter.", rational()));
        let text = "The intervals of the parameters: the claim is for every constant value in them.";
        fields.push(may("parameters", "Parameters", text, Shape::Map(Box::new(Shape::Object(interval.into())))));
    }
    fields
}

/// n_o of a rate.
fn count() -> Field {
    must("n_o", "n_o", "The number of oscillators.", Shape::Whole(0, u64::from(MAX_OSCILLATORS)))
}

/// What proves the rate of one n_o (section 13.6): by norms, in continuous time or at samples, or in continuous time from the first derivatives of a
/// plant.
fn rate_witness(sampled: bool) -> Shape {
    if sampled { by_norms(true) } else { Shape::OneOf(vec![by_norms(false), by_matrices()]) }
}

/// From the first derivatives.
fn by_matrices() -> Shape {
    let text = "The lower triangle of a matrix for (x, e, N^(1/2) zeta), by rows.";
    let mut fields = vec![count(), must("Pi", "Pi", text, any_list(any_list(rational())))];
    fields.extend(numbers(&["e_low", "e_up", "z_up"], "What Pi is between."));
    fields.push(may("x_up", "x_up", "What Pi is below, where there are states.", rational()));
    let known = || {
        let rows = [
            ("Q", "The lower triangle of Q, by rows."),
            ("G", "G, by rows."),
            ("H", "The lower triangle of H, by rows."),
        ];
        Shape::Object(rows.map(|(name, text)| must(name, name, text, any_list(any_list(rational())))).into())
    };
    let apart = Shape::Object(vec![
        must("states", "By x", "The derivatives by x, where the matrix inequality has them.", known()),
        must("error", "By e", "The derivatives by e, where the matrix inequality has them.", known()),
    ]);
    let text = "What is proved of the first derivatives D of the plant: Q - G D - D'G' - D'H D >= 0, of all of them or of those by x and by e \
                apart.";
    fields.push(must("slopes", "Slopes", text, Shape::OneOf(vec![known(), apart])));
    Shape::Object(fields)
}

/// By norms, at samples or in continuous time.
fn by_norms(sampled: bool) -> Shape {
    let mut fields = vec![count()];
    let text = "The lower triangle of a matrix for (e, N^(1/2) zeta), by rows.";
    fields.push(must("Pi", "Pi", text, any_list(any_list(rational()))));
    fields.extend(numbers(&["e_low", "e_up", "z_up"], "What Pi is between."));
    let of_x = || {
        let names: &[&str] = if sampled { &["w", "l_x", "l_e", "l_y"] } else { &["w", "l"] };
        names.iter().map(|name| may(name, *name, "A weight, where x has a part in e.", rational()))
    };
    let multipliers = || numbers(&["c", "l_slope", "l_hold"], "What W loses in a sample, or a multiplier.");
    if sampled {
        fields.extend(multipliers());
    }
    fields.extend(of_x());
    let mut noise = vec![must("Pi", "Pi", text, any_list(any_list(rational())))];
    if sampled {
        noise.extend(multipliers());
    } else {
        noise.extend(numbers(&["lambda"], "Half of the rate at which W would decay, in 1/time."));
    }
    noise.extend(numbers(&["e_low"], "What Pi is above in e."));
    noise.extend(of_x());
    let of_inputs = [("g_d", "the disturbance"), ("g_v", "the noise"), ("g_r", "the disturbance within a sample")];
    noise.extend(
        of_inputs
            .into_iter()
            .take(if sampled { 3 } else { 2 })
            .map(|(name, of)| may(name, name, format!("The weight of {of}, where there is one."), rational())),
    );
    if sampled {
        let of_rounding = [
            ("z_low", "What Pi is above in z."),
            ("z_up", "What the block of z in Pi is below."),
            ("z_noise", "What noise and rounding add to zeta at most."),
            ("level", "What the root of W of that part stays below."),
        ];
        let rounds = |what| format!("{what} Of a law in doubles.");
        noise.extend(of_rounding.map(|(name, what)| may(name, name, rounds(what), rational())));
    }
    fields.push(may("noise", "Noise", "What proves the bounds under noise.", Shape::Object(noise)));
    Shape::Object(fields)
}

fn sizes() -> [Field; 3] {
    [("X0", "|x|"), ("E0", "|e|"), ("Z0", "|z|_N")]
        .map(|(name, what)| must(name, name, format!("Bounds {what} of the initial set."), rational()))
}

/// Which conditions a witness is of.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    MeanSquares,
    Repaired,
    Sampled,
}

/// The free numbers of a derivation beside the claim.
fn proof(kind: Kind) -> Vec<Field> {
    vec![
        must("sigma_star", "sigma*", "Its gain.", rational()),
        must(
            "initial_set",
            "Initial set",
            "Its initial set.",
            Shape::OneOf(vec![Shape::Object(sizes().into()), Shape::Object(sizes().into_iter().take(2).collect())]),
        ),
        must("witness", "Witness", "Its free numbers.", Shape::Object(witness(kind, false))),
    ]
}

fn numbers(names: &[&'static str], text: &str) -> Vec<Field> {
    names.iter().map(|name| must(name, *name, text, rational())).collect()
}

/// The witness; `main` is the one of the claim, which carries the proofs of the data.
fn witness(kind: Kind, main: bool) -> Vec<Field> {
    let names: &[&str] = match kind {
        Kind::MeanSquares => SharpWitness::NAMES,
        Kind::Repaired => RepairedWitness::NAMES,
        Kind::Sampled => SampledWitness::NAMES,
    };
    let free = "A free number of the proof.";
    let mut fields = numbers(names, free);
    if kind == Kind::Sampled {
        fields.extend(numbers(&["weight_sum"], free));
        let of_delay = "A free number of the law with a delay; there with `delay_samples` alone.";
        fields.extend(DelayWitness::NAMES.iter().map(|name| may(name, *name, of_delay, rational())));
    }
    if kind != Kind::Repaired {
        fields.push(paths());
    }
    fields.push(must("transfer", "Transfer bound", "How (k0, k1) is proved.", Shape::OneOf(transfer(kind))));
    if kind == Kind::MeanSquares {
        let mut regulated = numbers(ExactWitness::NAMES, "A free number of exact regulation.");
        regulated.push(paths());
        fields.push(may("exact_regulation", "Exact regulation", "With infinitely many oscillators.", {
            Shape::Object(regulated)
        }));
        let refined = numbers(RefinedSquares::NAMES, "A root mean square of the periodic solution.");
        fields.push(may("refined", "Refined", "Smaller mean squares.", Shape::Object(refined)));
        let multipliers = numbers(&["l_x", "l_e", "l_f"], "A multiplier.");
        fields.push(may("lmi", "Multipliers", "C5 as a matrix inequality; a figure.", Shape::Object(multipliers)));
    }
    if main && kind != Kind::Repaired {
        let text = "What proves the rates of the claim for given n_o.";
        let shape = match kind {
            Kind::Sampled => named("sampled_rate_witness", rate_witness(true)),
            _ => named("rate_witness", rate_witness(false)),
        };
        fields.push(may("for_n_o", "For given n_o", text, list(shape, MAX_COUNTS)));
    }
    if main {
        fields.extend(of_data());
    }
    fields
}

/// Along which paths differences on the error box are split; certificates from before there were paths have none.
fn paths() -> Field {
    let path = |name: &'static str| {
        must(name, name, format!("The path of {name}."), Shape::Word(Path::ALL.map(Path::name).to_vec()))
    };
    let text =
        "Along which paths the differences of f and q on the error box are split; without them f x first, q straight.";
    may("paths", "Paths", text, Shape::Object(vec![path("f"), path("q")]))
}

fn transfer(kind: Kind) -> Vec<Shape> {
    let proof = |word| must("proof", "Proof", "Which proof it is.", Shape::Word(vec![word]));
    if kind == Kind::Sampled {
        return vec![Shape::Object(vec![proof("sampled")])];
    }
    let whole = |name| must(name, name, "A whole number of the proof.", Shape::Whole(0, 999_999_999));
    let points = any_list(any_list(rational()));
    let boxes = must("boxes", "Boxes", "Break points of x, for each number of oscillators.", points);
    vec![
        Shape::Object(vec![proof("closed-form")]),
        Shape::Object(vec![proof("matched"), whole("K")]),
        Shape::Object(vec![proof("boxes"), whole("m0"), whole("N0"), boxes]),
    ]
}

/// What a Jacobian or a plant adds to the witness.
fn of_data() -> Vec<Field> {
    let matrix = || named("matrix", any_list(any_list(rational())));
    let harmonics = |shape: &dyn Fn() -> Shape| {
        let pair = [("cos", "cosine"), ("sin", "sine")]
            .map(|(name, what)| must(name, name, format!("The coefficient of the {what}."), shape()));
        may(
            "harmonics",
            "Harmonics",
            "Those of 2 pi k t/period for k = 1, 2, ...",
            any_list(Shape::Object(pair.into())),
        )
    };
    let triple = || {
        let mut fields = vec![must("P", "P", "The mean of P(t), by rows.", matrix()), harmonics(&matrix)];
        fields.extend(numbers(&["p_low", "p_up", "alpha"], "A number of the proved triple."));
        named("triple", Shape::Object(fields))
    };
    let vector = || any_list(rational());
    let parts = |part: Vec<Field>| {
        let text = "How it changes with each parameter of which an interval is given.";
        may("sensitivities", "Sensitivities", text, any_list(Shape::Object(part)))
    };
    let around = |field: fn(&'static str, &'static str, &'static str, Shape) -> Field| {
        let mut orbit = vec![must("mean", "Mean", "The mean of the approximate orbit.", vector()), harmonics(&vector)];
        orbit.push(parts(vec![must("mean", "Mean", "The mean.", vector()), harmonics(&vector)]));
        orbit.extend(numbers(&["defect", "tube", "radius"], "A size of the proof of the orbit."));
        let mut forcing =
            vec![must("mean", "Mean", "The mean of q along the orbit.", rational()), harmonics(&rational)];
        forcing.push(parts(vec![must("mean", "Mean", "The mean.", rational()), harmonics(&rational)]));
        forcing.extend(numbers(&["rest", "rest_t"], "A bound of what the harmonics leave."));
        let orbit = named("orbit", Shape::Object(orbit));
        let orbit = field("orbit", "Orbit", "The periodic solution of the zero dynamics.", orbit);
        [orbit, field("forcing", "Forcing", "q along the orbit.", named("forcing", Shape::Object(forcing)))]
    };
    let ends = Shape::Object(numbers(&["low", "high"], "An end of the interval in this cell.").into_iter().collect());
    let ends = must("parameters", "Parameters", "The part of each interval, in their order.", any_list(ends));
    let cell = Shape::Object([ends].into_iter().chain(around(must)).collect());
    let [orbit, forcing] = around(may);
    let names = Bound::ALL.map(Bound::field).to_vec();
    let mut value = vec![must("bound", "Bound", "Which bounding function.", Shape::Word(names))];
    value.extend(numbers(ProvedValue::NAMES, "An argument, or the bound there."));
    let mut inequality = numbers(MatrixInequality::NAMES, "An argument, the rate that x keeps, or the threshold.");
    let mut splitting = numbers(Splitting::NAMES, "X of (g, d), or E of (J, r).");
    splitting.push(must("S", "S", "Below F without e, and above what e adds; in (x, y).", matrix()));
    let splitting = named("splitting", Shape::Object(splitting));
    let about = "With it (J, r) and (g, d) are taken at two points.";
    inequality.push(may("splitting", "Splitting", about, splitting));
    let mut existence = numbers(&["X", "E"], "An argument.");
    existence.push(may("P", "P", "A symmetric matrix for y, by rows.", matrix()));
    existence.extend(["k_p", "c_x", "c_y"].map(|name| may(name, name, "A weight, or a margin.", rational())));
    existence.push(must("sigma", "sigma", "The threshold.", rational()));
    existence.extend(metrics(false).map(|(name, about, shape)| may(name, name, about, shape)));
    let mut joint = numbers(JointInequality::NAMES, "An argument, or the threshold.");
    joint.extend(metrics(true).map(|(name, about, shape)| must(name, name, about, shape)));
    let at_samples = numbers(SampledInequality::NAMES, "An argument, a weight, or what is left.");
    let inequality = Shape::OneOf(vec![Shape::Object(inequality), Shape::Object(at_samples)]);
    let mut existence_at_samples = numbers(&["X", "E"], "An argument.");
    existence_at_samples.push(must("P", "P", "A symmetric matrix for y, by rows.", matrix()));
    let names = ["k_p", "c_x", "c_e", "c_y", "gamma", "lambda"];
    existence_at_samples.extend(numbers(&names, "A weight, a margin, or what q(t,0,0) counts."));
    let existence = Shape::OneOf(vec![Shape::Object(existence), Shape::Object(existence_at_samples)]);
    vec![
        may("lyapunov", "Lyapunov triple", "P(t) and the triple of stability, proved.", triple()),
        may("lyapunov_existence", "Second triple", "That of the existence of the periodic solution.", triple()),
        may("coordinates", "Coordinates", "The rows of L in x = x_0 + L y.", matrix()),
        orbit,
        forcing,
        may(
            "cells",
            "Cells",
            "Of a cut box of parameters, in the place of orbit and forcing.",
            list(named("cell", cell), 64),
        ),
        may(
            "bounds",
            "Bounds",
            "The bounds that are proved from the formulas.",
            any_list(named("bound", Shape::Object(value))),
        ),
        may(
            "matrix_inequality",
            "Matrix inequality",
            "That of stability in the place of C5 (at samples of C5h), proved from the formulas for w_x and h of the witness.",
            named("matrix_inequality", inequality),
        ),
        may(
            "existence_inequality",
            "Matrix inequality of existence",
            "What bounds the periodic solution beside the gains of loops, proved from the formulas: with P, k_p, c_x, c_y, or with metrics.",
            named("existence_inequality", existence),
        ),
        may(
            "joint_inequality",
            "Joint inequality",
            "That of stability in the place of C4 and C5, with metrics of (y, e), proved from the formulas.",
            named("joint_inequality", Shape::Object(joint)),
        ),
    ]
}

/// The near and the far metric of a joint inequality; with levels those of stability.
fn metrics(with_levels: bool) -> [(&'static str, &'static str, Shape); 2] {
    let metric = |is_near: bool| {
        let mut fields =
            vec![must("P", "P", "A symmetric matrix for y, by rows.", named("matrix", any_list(any_list(rational()))))];
        if is_near {
            fields.push(must("p", "p", "What joins y and e, an entry for each state.", any_list(rational())));
        }
        fields.extend(numbers(Metric::NAMES, "A weight, or a margin."));
        if with_levels {
            fields.extend(numbers(Level::NAMES, "What the metric is between."));
        }
        let name = match (is_near, with_levels) {
            (true, true) => "near_level",
            (true, false) => "near",
            (false, true) => "far_level",
            (false, false) => "far",
        };
        named(name, Shape::Object(fields))
    };
    [("near", "The metric at the threshold.", metric(true)), ("far", "That of the largest gains.", metric(false))]
}

fn interval() -> Shape {
    Shape::List(Box::new(Shape::Text), 2, Some(2))
}

fn condition() -> Vec<Field> {
    let text = |name, title: &str, about: &str| must(name, title, about, Shape::Text);
    vec![
        text("id", "Name", "The name of the condition."),
        text("what", "Words", "What it says."),
        text("relation", "Relation", "How its sides compare."),
        must("lhs", "Left side", "An enclosure.", interval()),
        must("rhs", "Right side", "An enclosure.", interval()),
        text("margin", "Margin", "The right side less the left one, rounded down."),
    ]
}

fn constant() -> Vec<Field> {
    let about = || {
        vec![
            must("status", "Status", "Whether the formula is sound.", Shape::Text),
            must("source", "Source", "Where the formula stands.", Shape::Text),
        ]
    };
    let entry = || {
        let value = must("value", "Value", "An enclosure.", interval());
        let reason = must("reason", "Reason", "Why there is no value.", Shape::Text);
        let kinds = [value, reason].map(|first| Shape::Object([first].into_iter().chain(about()).collect()));
        named("entry", Shape::OneOf(kinds.into()))
    };
    vec![
        must("evaluated_at", "Evaluated at", "With which free numbers.", Shape::Text),
        may("printed", "Printed", "In the printed derivation.", entry()),
        may("repaired", "Repaired", "In the repaired derivation.", entry()),
        may("sharp", "Sharp", "In the sharp derivation.", entry()),
    ]
}

/// Why no plant satisfies the data.
fn no_plant() -> Vec<Field> {
    vec![
        must("X", "X", "Where the bounds contradict each other.", rational()),
        must("rate_at_most", "Rate", "The largest contraction rate that the bounds allow.", interval()),
        must("exceeded_by", "Exceeded by", "What is larger.", Shape::Word(vec!["alpha", "rate", "jacobian"])),
        may("t", "t", "Where in the period, as a fraction of it.", rational()),
        may("column", "Column", "Which column of the Jacobian.", Shape::Whole(0, 11)),
    ]
}
