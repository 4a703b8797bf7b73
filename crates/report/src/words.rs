//! How a report names the state of the zero dynamics: x, its coordinates y of a plant's formulas, or nothing where a plant
//! has none.

use rug::Rational;
use sigmastar_document::clean;
use sigmastar_document::number::{estimate, exact};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, write_exact};
use sigmastar_lang::expr::quoted;
use sigmastar_lang::spec::{Actuator, Constant, InputGain, Oscillators, Specification, StartSizes};
use sigmastar_prove::certificate::members;
use sigmastar_prove::certify::claimed_ball;
use sigmastar_theory::derivation::initial_set::ClaimedSet;

/// The oscillators that something is said of: their number, or the harmonics of a set.
#[must_use]
pub fn with(oscillators: &Oscillators) -> String {
    oscillators.n_o().map_or_else(|| oscillators.to_string(), |n_o| format!("$`n_o = {n_o}`$"))
}

/// Oscillators in a column of numbers of them: "3", or "at 0, 1, 5".
#[must_use]
pub fn row_of(oscillators: &Oscillators) -> String {
    let all = || oscillators.all().map(|k| k.to_string()).collect::<Vec<String>>().join(", ");
    oscillators.n_o().map_or_else(|| format!("at {}", all()), |n_o| n_o.to_string())
}

/// Of which oscillators a claim is, by the `n_o` that it covers: of every number of them, or of every one of these `sets` (derivation, 14.7).
pub(super) fn oscillators(n_o: &str, sets: Option<&str>) -> String {
    match sets {
        None => format!("every number of oscillators $`{n_o}`$"),
        Some(sets) => format!("oscillators at every {sets} with 0"),
    }
}

/// The same in the short report.
pub(super) fn the_same_for(every_set: bool) -> &'static str {
    match every_set {
        false => "the same for every $`n_o`$",
        true => "the same for every set of oscillators",
    }
}

/// What an actuator takes: `|u| <= 30`, or `0 <= 1.95 + u <= 3.9` where u is measured from the middle of its range; a formula.
pub(super) fn taken(actuator: &Actuator) -> String {
    match &actuator.range {
        None => format!("$`|u| <= {}`$", clean(&actuator.max.text)),
        Some(range) => {
            let [min, max] = [&range.min, &range.max]
                .map(|limit| limit.as_rational().map_or_else(|| clean(&limit.text), write_exact));
            let put_out =
                actuator.middle().map_or_else(|| "u".to_owned(), |middle| format!("{} + u", write_exact(&middle)));
            format!("$`{min} <= {put_out} <= {max}`$")
        }
    }
}

/// A number with so many characters at most is shown exactly.
const SHORT: usize = 12;

/// The nominal gain of the actuator, or about that number where it is long.
pub(super) fn nominal_gain(gain: &InputGain) -> String {
    let exact = gain.nominal.as_rational().map_or_else(|| clean(&gain.nominal.text), write_exact);
    if exact.len() <= SHORT { exact } else { format!("about {}", estimate(gain.nominal.to_f64())) }
}

/// What the letters of a report on this set are, in a sentence.
pub(super) fn letters(spec: &Specification, set: &ClaimedSet) -> String {
    let of_z = set.z0.as_ref().filter(|z0| **z0 != 0).map(|_| "$`|z|_N = sqrt(z'Nz)`$");
    let of_y = (spec.plant().is_some() && spec.state_name().is_some())
        .then_some("$`y = L^-1 (x - x_0(t))`$ with orbit $`x_0`$ and matrix $`L`$");
    let both: Vec<&str> = of_z.into_iter().chain(of_y).collect();
    let before = if both.is_empty() { String::new() } else { format!("{}; ", both.join(", and ")) };
    format!("Here {before}{}.", output(spec))
}

/// What u is in every report: what is put out, measured from the middle of the range of the actuator.
fn output(spec: &Specification) -> String {
    let control =
        spec.input_gain.as_ref().map(|gain| format!("its control divided by the nominal gain {}", nominal_gain(gain)));
    match (spec.actuator.as_ref().and_then(Actuator::middle), control) {
        (None, None) => "the regulator puts out $`u`$, and $`e' = q + u`$".to_owned(),
        (None, Some(control)) => format!("the regulator puts out $`u`$, {control}"),
        (Some(middle), control) => {
            let middle = write_exact(&middle);
            let of_u = control.map_or_else(String::new, |control| format!(", and $`u`$ {control}"));
            format!("the regulator puts out $`{middle} + u`$, {middle} the middle of the range of the actuator{of_u}")
        }
    }
}

/// The ball about the orbit that lies in the initial set of a plant with states, with a semicolon before it; of others nothing.
pub(super) fn ball(spec: &Specification, set: &ClaimedSet) -> String {
    let ball = spec.plant().and_then(|plant| claimed_ball(plant, &set.x0));
    let ball = ball.map(|ball| format!("; contains the ball $`|x - x_0| <= {}`$", exact(&ball, Direction::Down)));
    ball.unwrap_or_default()
}

/// The initial set, rounded inward: `|x| <= 1, |e| <= 2, |z|_N <= 3`, or `z = 0`, or `z = M e`.
pub(super) fn set(spec: &Specification, set: &ClaimedSet) -> String {
    let StartSizes { x0, e0, z0 } = set.map(|value| exact(value, Direction::Down));
    let of_state = spec.state_name().map_or_else(String::new, |name| format!("$`|{name}| <= {x0}`$, "));
    let of_regulator = match z0.as_deref() {
        None => "$`z = M e`$".to_owned(),
        Some("0") => "$`z = 0`$".to_owned(),
        Some(z0) => format!("$`|z|_N <= {z0}`$"),
    };
    format!("{of_state}$`|e| <= {e0}`$, {of_regulator}")
}

/// Where the sizes of the initial set are from: those that are stated, and those that are not, by the bounds of the periodic solution of which they
/// are a multiple: "E0 as stated, X0 about twice the bound of the periodic solution".
pub(super) fn origin_of_sizes(spec: &Specification, set: &ClaimedSet, periodic: [&Enclosure; 2]) -> String {
    let ball = spec.plant().and_then(|plant| plant.ball.as_ref());
    let [x0, e0] = spec.initial_set.given();
    let of = |stated: Option<&Constant>, claimed: &Rational, bound: &Enclosure| match stated {
        // What is stated irrationally is rounded up, and a given witness may cover more.
        Some(stated) if stated.as_rational() == Some(claimed) => "as stated".to_owned(),
        Some(_) => "at least as stated".to_owned(),
        None => multiple(claimed, bound),
    };
    let of_x = match ball {
        Some(_) => "from the `ball` of the file".to_owned(),
        None => of(x0, &set.x0, periodic[0]),
    };
    let of_e = of(e0, &set.e0, periodic[1]);
    match spec.state_name() {
        None => of_e,
        Some(_) if of_x == of_e => of_x,
        Some(_) => format!("$`X0`$ {of_x}, $`E0`$ {of_e}"),
    }
}

/// How large a size that is not stated is against the bound of the periodic solution, of which the search takes twice what its existence is proved
/// within: the bound may be far below that.
fn multiple(size: &Rational, bound: &Enclosure) -> String {
    let share = size.to_f64() / bound.upper_f64();
    if !share.is_finite() {
        "chosen".to_owned()
    } else if (share - 2.0).abs() < 0.01 {
        "about twice the bound of the periodic solution".to_owned()
    } else {
        format!("about {} times the bound of the periodic solution", estimate(share))
    }
}

/// The input gain after the first of the words where both ends are written alike, its interval "0.8 to 1.25" after the second; `None` where the
/// document has none.
pub(super) fn input_gain(spec: &Specification, [one, interval]: [&str; 2]) -> Option<String> {
    spec.input_gain.as_ref().map(|gain| {
        let InputGain { low, high, .. } = gain;
        let [from, to] = [low, high].map(|end| clean(&end.words()));
        let ends = if from == to { format!("{one} {from}") } else { format!("{interval} {from} to {to}") };
        match (gain.of_parameters(), low.as_rational(), high.as_rational()) {
            (true, Some(low), Some(high)) => {
                format!("{ends} (within {} to {})", exact(low, Direction::Down), exact(high, Direction::Up))
            }
            _ => ends,
        }
    })
}

/// What an interval is of, a parameter or a field of the document.
pub(super) fn of_interval(spec: &Specification, name: &str) -> String {
    let parameters = spec.plant().map(|plant| &plant.parameters);
    let is_parameter = parameters.is_some_and(|parameters| parameters.named_intervals().any(|(own, _)| own == name));
    if is_parameter { quoted(name) } else { name.to_owned() }
}

/// " and every constant input gain from 0.8 to 1.25 and every plant with ...": all that a claim is about beside every number of
/// oscillators.
pub(super) fn of_all(spec: &Specification) -> String {
    let gains = input_gain(spec, [" and the input gain", " and every constant input gain from"]);
    let plants = spec.plant().and_then(|plant| members(&plant.parameters));
    let plants = plants.map(|members| format!(" and every plant with {members}"));
    let periods = period(spec).map(|interval| format!(" and every constant period T from {interval}"));
    [gains, plants, periods].into_iter().flatten().collect()
}

/// "1/50.2 to 1/49.8": the interval of the period, where only that is known.
pub(super) fn period(spec: &Specification) -> Option<String> {
    spec.period.interval().map(|[low, high]| format!("{} to {}", clean(&low.words()), clean(&high.words())))
}

/// The arguments up to which bounding functions are used: `X = 1, E = 2`.
pub(super) fn arguments(spec: &Specification, [x, e]: [String; 2]) -> String {
    let of_state = spec.state_name().map_or_else(String::new, |_| format!("$`X = {x}`$, "));
    format!("{of_state}$`E = {e}`$")
}

/// What vanishes with infinitely many oscillators. Within bounding functions x is the deviation from the solution of
/// x' = f(t,x,0); in the formulas of a plant it is not.
pub(super) fn limit(spec: &Specification) -> &'static str {
    match (spec.plant().is_some(), spec.state_name()) {
        (false, _) => "$`x`$ and $`e`$ tend to 0",
        (true, Some(_)) => "$`x - x_0(t)`$ and $`e`$ tend to 0, $`x_0`$ the T-periodic solution of $`x' = f(t,x,0)`$",
        (true, None) => "$`e`$ tends to 0",
    }
}

/// The cells of a table of sizes, whose first one is that of the state: left out where there is none.
pub(super) fn with_state<T, const N: usize>(spec: &Specification, cells: [T; N]) -> impl Iterator<Item = T> {
    cells.into_iter().skip(usize::from(spec.state_name().is_none()))
}

/// Whether `factor exp(-rate (t - t_0))` and the limit together bound the way under noise, a disturbance or rounding. Not from an aligned start: it sets
/// z = M e of the measured e, and the factor is of a start without noise (derivation, 13.6).
pub(super) fn limit_adds_to_the_way(spec: &Specification) -> bool {
    !spec.initial_set.is_aligned()
}
