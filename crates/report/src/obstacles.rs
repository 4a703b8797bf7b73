//! Why nothing was certified, and what to try.

use rug::Rational;
use sigmastar_decide::conditions::BoundingProblem;
use sigmastar_document::number::{pair, upper};
use sigmastar_document::{Block, clean};
use sigmastar_exact::enclosure::Truth;
use sigmastar_exact::number::write_exact;
use sigmastar_lang::expr::BoundingFailure;
use sigmastar_lang::spec::{InitialSet, SIZES, Specification};
use sigmastar_propose::search::{Failing, Limited, Obstacle};
use sigmastar_prove::certify::{Certification, Outcome, SmallerChoice, Verdict};
use sigmastar_theory::derivation::condition::Condition;

/// So many items of a list are in the short form.
const FEW: usize = 3;

/// What came of it.
enum Attempt<'r> {
    Proved,
    Failing(&'r [Condition]),
    NotFound(Obstacle),
}

fn attempt<'r>(run: &'r Certification<'_>) -> Attempt<'r> {
    match &run.sharp {
        // The claim itself is proved, and what the certificate says beyond it is not.
        Outcome::Proved(_) if !run.exact_failing.is_empty() => Attempt::Failing(&run.exact_failing),
        Outcome::Proved(_) => Attempt::Proved,
        Outcome::NotProved { failing, .. } => Attempt::Failing(failing),
        Outcome::NotFound(obstacle) => Attempt::NotFound(*obstacle),
    }
}

/// One sentence: what failed.
pub(super) fn sentence(run: &Certification<'_>) -> String {
    let what = match attempt(run) {
        Attempt::Proved => first_unproved(&run.unproved_bounds, "the claim was not proved"),
        Attempt::Failing(conditions) => first_failing(conditions),
        Attempt::NotFound(obstacle) => not_found(&obstacle, run.spec),
    };
    let word = if run.verdict == Verdict::Refuted { "Refuted" } else { "Undecided" };
    format!("{word}: no $`sigma`$ is certified here; {what}. Nothing is claimed about the plant either way.")
}

/// What failed where nothing was found; of an actuator whose range has another middle than 0, where its limit is from.
pub(super) fn not_found(obstacle: &Obstacle, spec: &Specification) -> String {
    let of_actuator = matches!(obstacle.failing, Failing::Limit { which: Limited::Actuator, .. });
    let actuator = spec.actuator.as_ref().filter(|_| of_actuator);
    let of_range = actuator.and_then(|actuator| {
        let (range, middle) = (actuator.range.as_ref()?, actuator.middle()?);
        let [half, min, max] = [&actuator.max, &range.min, &range.max].map(|limit| clean(&limit.text));
        let middle = write_exact(&middle);
        Some(format!("; {half} is half of the range from {min} to {max}, and u is measured from its middle, {middle}"))
    });
    obstacle.sentence() + &of_range.unwrap_or_default()
}

/// The first bounding function that is not proved, in words, or what is said without one.
pub(super) fn first_unproved(problems: &[BoundingProblem], without: &str) -> String {
    match problems.first() {
        Some(problem) => {
            format!("the bounding function {} could not be proved: {}", problem.which.field(), problem.sentence())
        }
        None => without.to_owned(),
    }
}

/// The first condition that is not proved, in words.
pub(super) fn first_failing(conditions: &[Condition]) -> String {
    match conditions.first() {
        Some(condition) => format!("condition {} is {}", condition.id, truth(condition)),
        None => "the conditions were not proved".to_owned(),
    }
}

/// The figures of what failed, and what to try.
pub(super) fn section(run: &Certification<'_>, rechecked: bool) -> Vec<Block> {
    let mut blocks = Vec::new();
    blocks.extend(first_of("Bounding functions that were neither proved nor refuted:", unproved(run)));
    blocks.extend(first_of("Conditions that are not proved:", failing(run)));
    let advice = advice(run, rechecked);
    if !advice.is_empty() {
        blocks.push(Block::says("What to try:"));
        blocks.push(Block::List(advice));
    }
    blocks
}

/// The obstacles that [`section`] had no room for.
pub(super) fn detail(run: &Certification<'_>) -> Vec<Block> {
    let mut blocks = rest_of("Further bounding functions that were neither proved nor refuted", unproved(run));
    blocks.extend(rest_of("Further conditions that are not proved", failing(run)));
    blocks
}

fn unproved(run: &Certification<'_>) -> Vec<String> {
    let sentence = |problem: &BoundingProblem| format!("{}: {}", problem.which.field(), problem.sentence());
    run.unproved_bounds.iter().map(sentence).collect()
}

fn failing(run: &Certification<'_>) -> Vec<String> {
    match attempt(run) {
        Attempt::Failing(conditions) => conditions.iter().map(describe).collect(),
        _ => Vec::new(),
    }
}

/// A list with its title as far as the short form has room for it; nothing where it is empty.
pub(super) fn first_of(title: &str, mut items: Vec<String>) -> Vec<Block> {
    if items.is_empty() {
        return Vec::new();
    }
    let more = items.len().saturating_sub(FEW);
    if more > 0 {
        items.truncate(FEW);
        items.push(format!("and {more} more"));
    }
    vec![Block::says(title), Block::List(items)]
}

/// What [`first_of`] leaves out, under a heading.
pub(super) fn rest_of(heading: &str, items: Vec<String>) -> Vec<Block> {
    let rest: Vec<String> = items.into_iter().skip(FEW).collect();
    if rest.is_empty() { Vec::new() } else { vec![Block::heading(heading), Block::List(rest)] }
}

fn truth(condition: &Condition) -> &'static str {
    match condition.truth() {
        Truth::True => "proved",
        Truth::False => "refuted for this witness",
        Truth::Undecided => "not decided within the precision",
    }
}

pub(super) fn describe(condition: &Condition) -> String {
    format!(
        "{} ($`{}`$): $`{} {} {}`$ is {}",
        condition.id,
        condition.what,
        pair(&condition.lhs),
        condition.relation,
        pair(&condition.rhs),
        truth(condition)
    )
}

/// What to try where nothing is certified.
pub(super) fn advice(run: &Certification<'_>, rechecked: bool) -> Vec<String> {
    let mut items: Vec<String> = Vec::new();
    let mut add = |text: &str| items.push(text.to_owned());
    match attempt(run) {
        Attempt::Proved => {
            let at_the_edge = run
                .unproved_bounds
                .iter()
                .any(|problem| matches!(&problem.failure, BoundingFailure::Undecided { span, .. } if span.is_some()));
            add("rewrite the bounding function as sums, products and compositions of nondecreasing functions");
            if at_the_edge {
                add("see the place in the expression that is shown with this report");
            }
        }
        Attempt::Failing(conditions)
            if conditions.iter().any(|condition| condition.truth().is_undecided())
                && !conditions.iter().any(|condition| condition.truth().is_false()) =>
        {
            add("raise --precision-limit");
        }
        Attempt::Failing(_) if !rechecked => {
            add("other units of time, $`x`$ and $`e`$, in which the data have ordinary magnitudes");
        }
        Attempt::Failing(_) => add("search again (without --witness): another witness may exist"),
        Attempt::NotFound(obstacle) => obstacle_advice(run, obstacle, &mut add),
    }
    items
}

fn obstacle_advice(run: &Certification<'_>, obstacle: Obstacle, add: &mut dyn FnMut(&str)) {
    let domain = run.spec.domain.as_ref();
    match obstacle.failing {
        Failing::Magnitude(_) => add("units of time, $`x`$, $`e`$ and $`q`$ in which the numbers are of ordinary size"),
        Failing::Beyond { .. } => {
            add(
                "another gain, or a search without this witness: its bounds are proved only as far as the smallest gain needs them",
            );
        }
        Failing::NotFinite(Some(bound)) => {
            add(&smaller(run));
            add(&format!("a {} that is finite at these arguments", bound.field()));
        }
        Failing::NotFinite(None) => {
            add("units of time, $`x`$, $`e`$ and $`q`$ in which the numbers are of ordinary size")
        }
        Failing::Existence => {
            add(
                "a larger $`alpha`$, a smaller $`p_up/p_low`$, or smaller $`f_e`$, $`f_xx`$: $`a_1 > 0`$ (sharp), C1 and C3 (repaired) do not contain $`sigma`$ there",
            );
        }
        Failing::DomainX | Failing::DomainE => {
            if let Some(domain) = domain {
                let (x, e) = (clean(&domain.x.text), clean(&domain.e.text));
                add(&format!("a larger domain than $`X = {x}`$, $`E = {e}`$, if the bounding functions hold there"));
            }
            add(&smaller(run));
        }
        Failing::Curvature => {
            add(&smaller(run));
            add(
                "a larger $`alpha`$, or smaller $`f_xx`$ and $`f_ex`$: the nonlinearity is too strong for this initial set",
            );
        }
        Failing::Coupling => {
            add(&smaller(run));
            add("smaller $`q_x`$, $`f_e`$");
        }
        Failing::Gain { .. } => add("a larger gain, or none: without --sigma the smallest one is sought"),
        Failing::Limit { which, beside, .. } => {
            if let Some(gain) = run.given_gain.as_ref().map(|_| other_gain(which)) {
                add(gain);
            }
            add(&wider(which, beside.map(|(other, _)| other)));
            if let Some(divisor) = run.divisor_that_keeps() {
                add(&smaller_by(divisor));
            }
        }
        Failing::NotDecidedAgain { refused, .. } => add(again(refused)),
        Failing::Start { .. } => add(SMALLER_START),
        Failing::Rate { .. } => add(SLOWER),
        Failing::InputGain { .. } => add("a narrower interval `input_gain`"),
        Failing::Delay { .. } => add("a shorter sampling period or a smaller $`mu`$"),
        Failing::Hold { .. } | Failing::Samples => add("a smaller gain or a shorter sampling period"),
        Failing::Sampling => add("a shorter sampling period, or a smaller $`mu`$"),
        Failing::Bounds | Failing::Unproved(_) => add("a `domain` on which the bounding functions are valid"),
    }
    if let Some([x, e]) = run.largest_arguments().map(|arguments| arguments.each_ref().map(upper)) {
        add(&format!("the last witness used the bounding functions up to $`X = {x}`$, $`E = {e}`$"));
    }
}

/// What a certificate asks for that the checker does not decide.
pub(super) fn again(refused: bool) -> &'static str {
    match refused {
        false => {
            "a smaller initial set, narrower intervals (if the file has some), or a larger gain (`--sigma`): the checker then has fewer boxes to decide"
        }
        true => "please report the file: a certificate that is refused is a defect",
    }
}

/// What a limit below the start asks for.
pub(super) const SMALLER_START: &str = "a smaller `E0`, or a limit above it";

/// The smaller set from which a limit is kept.
pub(super) fn smaller_by(divisor: u32) -> String {
    format!("a smaller initial set: with all of its sizes divided by {divisor} the limit is kept")
}

/// What a rate that is not proved asks for.
pub(super) const SLOWER: &str = "a smaller rate, or fewer oscillators";

/// What a limit that is not kept asks for, where `beside` is the other one that is asked for at the same time.
pub(super) fn wider(which: Limited, beside: Option<Limited>) -> String {
    let Some(beside) = beside else {
        return match which {
            Limited::Actuator => "an actuator that takes more",
            Limited::SteadyError | Limited::PeakError => "a larger limit",
            Limited::Control => {
                "a larger limit, above the steady $`|u|`$: a run without a limit shows the bound of that, which a larger gain hardly lowers"
            }
        }
        .to_owned();
    };
    let larger = |limited: Limited| match limited {
        Limited::Actuator => "an actuator that takes more".to_owned(),
        _ => format!("a larger limit of {}", limited.quantity()),
    };
    let opposite = match which.is_of_control() == beside.is_of_control() {
        true => "",
        false => " (far above $`sigma*`$ a larger gain lowers $`|e|`$ and raises $`|u|`$)",
    };
    format!("{}, or {}{opposite}", larger(which), larger(beside))
}

/// What another gain than the one that is given may do for a limit: far above the smallest gain the control grows with it and the error falls;
/// near that one the error box may be so large that both are smaller at a larger gain.
pub(super) fn other_gain(which: Limited) -> &'static str {
    match which {
        Limited::Control | Limited::Actuator => {
            "another gain, and a smaller one if this is far above $`sigma*`$: without --sigma the program seeks a gain that keeps the limit"
        }
        Limited::SteadyError | Limited::PeakError => {
            "a larger gain, which may lower the error: without --sigma the program seeks a gain that keeps the limit"
        }
    }
}

/// Which smaller initial set would do: one that is certified, or what the floating-point search proposes.
fn smaller(run: &Certification<'_>) -> String {
    const ESTIMATE: &str = "the floating-point search (an estimate, no proof)";
    match run.smaller_set() {
        SmallerChoice::Certified { set, sigma, share, as_proposed } => {
            let share =
                share.map_or_else(String::new, |share| format!("; it is {} of the one asked for", write_exact(&share)));
            let edge =
                if as_proposed { format!("; {ESTIMATE} fails for a set that is 3 % larger") } else { String::new() };
            format!(
                "a smaller initial set: {} is certified, with $`sigma* = {}`${share}{edge}",
                field(&set),
                write_exact(&sigma)
            )
        }
        SmallerChoice::Proposed(set) => match set {
            Some(set) => format!("a smaller initial set: {ESTIMATE} succeeds up to about {}", field(&set)),
            None => format!(
                "no smaller initial set alone: {ESTIMATE} fails for every size that was tried, a single point among them"
            ),
        },
    }
}

/// The set as a specification has it.
fn field(set: &InitialSet<Rational>) -> String {
    let mut sizes = String::new();
    let _ = set.map_each(|place, size| sizes += &format!(", \"{}\": \"{}\"", SIZES[place], write_exact(size)));
    format!("`\"initial_set\": {{ \"kind\": \"{}\"{sizes} }}`", set.kind())
}
