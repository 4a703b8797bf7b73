//! The first lines of a report on a certified claim: the gain, from where, what to do next, what limits the gain, what is
//! assumed. The sections below say more of each.

use super::by_count::section as by_count;
use super::gains::to_use;
use super::of_plant::orbit;
use super::verdict::assumed;
use super::{Origin, sensitivity, words};
use rug::Rational;
use sigmastar_document::number::{estimate, exact, upper};
use sigmastar_document::{Block, clean};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, write_exact};
use sigmastar_lang::spec::Specification;
use sigmastar_prove::certify::{ByCount, Certification, SampledCertification};
use sigmastar_prove::rate::bound::RateBound;
use sigmastar_prove::rate::found::ForCount;
use sigmastar_prove::rate::noise::{NoNoiseBound, NoiseBound};
use sigmastar_theory::derivation::consequences::ErrorBounds;
use sigmastar_theory::derivation::control::Control;
use sigmastar_theory::derivation::initial_set::ClaimedSet;
use sigmastar_theory::derivation::targets::{Consequences, SampledConsequences};

/// The numbers of oscillators of which the error is said.
const SHOWN: [u64; 3] = [0, 10, 100];

/// Of a claim about the regulator in continuous time; nothing without one.
pub(super) fn of_run(run: &Certification<'_>, consequences: Option<&Consequences>, origin: Origin) -> Vec<Block> {
    let (Some(sigma), Some(set), Some(periodic), Some(error_box), Some((steady, peak, control))) =
        (run.sigma_star(), run.claimed_set(), run.periodic_solution(), run.error_box(), run.best_bounds())
    else {
        return Vec::new();
    };
    let sigma = write_exact(sigma);
    let same = words::the_same_for(run.is_for_every_set());
    let gain = match (&run.given_gain, &run.spec.actuator) {
        (_, Some(actuator)) => {
            let kept = match &actuator.range {
                None => format!("$`|u|`$ never exceeds the {} that the actuator takes", clean(&actuator.max.text)),
                Some(_) => format!("{} at all times, as the actuator takes it", words::taken(actuator)),
            };
            format!("$`sigma = {sigma}`$ in 1/time, this gain alone; {kept}; {same}")
        }
        (Some(_), None) => {
            format!("$`sigma = {sigma}`$ in 1/time, as it was given, or any larger; {same}")
        }
        (None, None) if !run.limits.is_empty() => {
            let least = run.smallest_gain.map_or_else(String::new, |least| {
                format!(
                    "; without these limits the smallest gain $`sigma*`$ is about {} (an estimate)",
                    estimate(least)
                )
            });
            format!(
                "$`sigma = {sigma}`$ in 1/time, the smallest gain found that keeps the limits asked for; every larger gain is certified, too, but \
                 with other bounds; {same}{least}{}",
                // The limit holds for every n_o, so without oscillators too.
                match run.limits.steady_error {
                    Some(_) if run.for_n_o.is_empty() =>
                        "; with N oscillators a smaller gain may keep the steady error: `--n-o N` seeks it",
                    _ => "",
                }
            )
        }
        (None, None) => format!("$`sigma* = {sigma}`$ in 1/time, or any larger; {same}"),
    };
    let mut facts = Vec::new();
    // Who gives a gain, limits or targets has chosen.
    let has_targets = consequences.is_some_and(|all| !all.targets.is_empty());
    let is_free = run.given_gain.is_none() && run.limits.is_empty() && !has_targets;
    facts.extend(to_use(&run.gains).filter(|_| is_free));
    facts.extend([
        ("gain", gain),
        ("initial set", initial_set(run.spec, set, &periodic, "any time")),
        ("next", next(run.spec, origin, false)),
    ]);
    facts.extend(orbit(run.spec).map(|said| ("orbit", said)));
    facts.extend(limited_by(run).map(|said| ("limited by", said)));
    facts.extend(
        run.alternatives
            .aligned
            .filter(|_| run.given_gain.is_none())
            .map(|sigma| ("aligned start", sensitivity::aligned(sigma))),
    );
    facts.extend(input_gain(run).map(|said| ("input gain", said)));
    facts.extend(interval_costs(run.spec, &run.interval_costs, "$`sigma*`$").map(|said| ("intervals", said)));
    // A table stands below where more is known.
    let by_n_o = consequences.filter(|_| run.by_count.is_none());
    let why = if run.options.compare { why_no_counts(run.spec, false) } else { None };
    facts
        .extend(by_n_o.and_then(|all| of_error(run, all)).map(|said| ("steady error", said + why.unwrap_or_default())));
    facts.extend(for_n_o(run, has_targets).map(|said| ("convergence", said)));
    // It grows with the gain, of which the claim says "or any larger".
    let [x, _, zeta, z] = periodic;
    let periodic = [x, steady, zeta, z];
    // Bounds by the number of oscillators say nothing of other sets of harmonics, of which the claim is, too.
    let of_first = run.is_for_every_set() && run.by_count.as_ref().is_some_and(ByCount::is_about_all);
    let which =
        if of_first { " (all at this gain; $`|e|`$ and $`|u|`$ with every $`n_o`$)" } else { " (all at this gain)" };
    let control = Some((&control, which));
    let transient = (upper(&error_box[0]), &peak);
    facts.push(("periodic solution", periodic_solution(run.spec, &periodic, transient, control)));
    facts.push(("assumed", assumed(run.spec, run.largest_arguments(), None)));
    let asked: Vec<u32> = run.rates().map(|(n_o, _)| n_o).collect();
    let known = by_count(run.spec, run.by_count.as_ref(), &asked);
    [Block::facts(facts)].into_iter().chain(known).chain([Block::says(letters(run.spec, set, "$`sigma`$"))]).collect()
}

/// Why nothing is proved by the number of oscillators of a plant, as the end of a sentence; nothing of bounding functions, and where the base frequency is not
/// matched, for there is none then.
fn why_no_counts(spec: &Specification, delayed: bool) -> Option<&'static str> {
    let plant = spec.plant().filter(|_| spec.internal_model.matched)?;
    Some(match plant.undivided() {
        None => "; sharper bounds by $`n_o`$ are not proved of a family whose parameters are cut into cells",
        _ if delayed => {
            "; no sharper bounds by $`n_o`$ were found; with a delay they need a plant that is linear in x and e"
        }
        Some(_) => "; no sharper bounds by $`n_o`$ were found at this gain; a larger one may have some",
    })
}

/// The bounds of the error for the numbers of oscillators that were asked about, or else for a few.
fn of_error(run: &Certification<'_>, all: &Consequences) -> Option<String> {
    let asked = run.rates().map(|(n_o, _)| u64::from(n_o));
    let asked: Vec<(u64, ErrorBounds)> = asked.filter_map(|n_o| Some((n_o, run.error_with(n_o)?))).collect();
    if asked.is_empty() { few(&all.by_n_o) } else { error(asked.iter()) }
}

/// How fast the error decays for the oscillators that were asked about; without any, how to ask, where nothing else was `asked`.
fn for_n_o(run: &Certification<'_>, asked: bool) -> Option<String> {
    let all = rates(run.spec, &run.for_n_o, &run.why_no_rate());
    if all.is_empty() {
        let how = "`--n-o N` proves a rate at this gain, `--rate V --n-o N` finds a gain for one";
        return (!asked).then(|| how.to_owned());
    }
    Some(format!("bounds of $`|e - e_per|`$, at this gain alone: {}", all.join("; ")))
}

/// A clause for each n_o or set.
fn rates<P, Q>(spec: &Specification, found: &[ForCount<P, Q>], why_not: &str) -> Vec<String> {
    let one = |ForCount { oscillators, bound, noise }: &ForCount<P, Q>| match bound {
        None => format!("not proved with {} ({why_not})", words::with(oscillators)),
        Some(RateBound { rate, factor, .. }) => {
            let bounds = |noise: &NoiseBound<Q>| [noise.peak.clone(), noise.limit.clone()];
            let disturbed = disturbed(spec, noise.as_ref().map(|noise| noise.as_ref().map(bounds)));
            let [factor, rate] = [exact(factor, Direction::Up), exact(rate, Direction::Down)];
            let with = words::with(oscillators);
            format!("$`{factor} exp(-{rate} (t - t_0))`$ with {with}{disturbed}")
        }
    };
    found.iter().map(one).collect()
}

/// What noise and a disturbance, or rounding alone, make of it, where there are some and it is proved: the peak and the limit, which adds to the way
/// where that is so.
fn disturbed(spec: &Specification, noise: Option<Result<[Rational; 2], &NoNoiseBound>>) -> String {
    let (word, without) =
        if spec.disturbances.any() { ("disturbed", "undisturbed") } else { ("rounded", "computed exactly") };
    match noise {
        None => String::new(),
        Some(Ok(bounds)) => {
            let [peak, limit] = bounds.map(|bound| exact(&bound, Direction::Up));
            if words::limit_adds_to_the_way(spec) {
                format!(", and at most {limit} more if {word}")
            } else {
                format!(" if {without}, and if {word} at most {peak} at all times and {limit} in the limit")
            }
        }
        Some(Err(reason)) => format!(" (if {word}: {})", reason.message()),
    }
}

/// What a claim at samples says of the given n_o, as one line: rates at the sampling instants; nothing where none was asked for.
fn for_n_o_at_samples(run: &SampledCertification<'_>) -> Option<String> {
    let all = rates(run.spec, &run.for_n_o, &run.why_no_rate());
    (!all.is_empty()).then(|| format!("bounds of $`|e - e_per|`$ at the sampling instants: {}", all.join("; ")))
}

/// Of a claim about the regulator at samples; nothing without one.
pub(super) fn of_samples(
    run: &SampledCertification<'_>,
    consequences: Option<&SampledConsequences>,
    origin: Origin,
) -> Vec<Block> {
    let (Some(proof), Some(periodic)) = (run.claim(), run.periodic_solution()) else { return Vec::new() };
    let Some((steady, peak, control)) = run.best_bounds() else { return Vec::new() };
    let witness = &proof.witness;
    // That gain stands exactly in the sentence above: the claim is about no other.
    let gain = format!(
        "$`sigma = {}`$ in 1/time with $`h = {}`$ only; no other gain or sampling period",
        write_exact(&witness.sigma),
        clean(&run.sampling.step.text)
    );
    let when = witness.delay.as_ref().map_or_else(
        || "a sampling instant".to_owned(),
        |delay| {
            let y_0 = exact(&delay.y_0, Direction::Down);
            format!(
                "a sampling instant, with a prediction of $`e`$ there that is off by at most $`h Y_0`$, $`Y_0 = {y_0}`$"
            )
        },
    );
    let mut facts = Vec::new();
    let is_free = run.given_gain.is_none() && run.limits.is_empty();
    facts.extend(to_use(&run.gains).filter(|_| is_free));
    facts.extend([
        ("gain", gain),
        ("initial set", initial_set(run.spec, &witness.set, &periodic, &when)),
        ("next", next(run.spec, origin, true)),
    ]);
    facts.extend(orbit(run.spec).map(|said| ("orbit", said)));
    facts.extend(run.found.map(|(_, limit)| ("limited by", format!("{} (an estimate)", limit.describe()))));
    // A table stands below where more is known.
    let by_n_o = consequences.filter(|_| run.by_count.is_none());
    // Rows of other gains are there where all is compared.
    let why = if run.gains.is_empty() { None } else { why_no_counts(run.spec, run.sampling.delayed) };
    facts.extend(by_n_o.and_then(|all| few(&all.by_n_o)).map(|said| ("steady error", said + why.unwrap_or_default())));
    facts.extend(for_n_o_at_samples(run).map(|said| ("convergence", said)));
    let [x, _, zeta, z] = periodic.clone();
    let along = [x, steady, zeta, z];
    let of_first = run.spec.internal_model.asks_every_set() && run.by_count.as_ref().is_some_and(ByCount::is_about_all);
    let of_first = if of_first { " ($`|e|`$ and $`|u|`$ with every $`n_o`$)" } else { "" };
    let transient = (exact(&witness.d_x, Direction::Up), &peak);
    facts.push(("periodic solution", periodic_solution(run.spec, &along, transient, Some((&control, of_first)))));
    facts.extend(uncertain_gain(run.spec).map(|said| ("input gain", said)));
    facts.extend(interval_costs(run.spec, &run.interval_costs, "the gain").map(|said| ("intervals", said)));
    let late = if run.sampling.delayed { "every control put out at the next sample, no" } else { "no delay," };
    let of_the_computer = match run.spec.actuator {
        Some(_) => format!("{late} rounding or quantisation"),
        None => format!("{late} rounding, quantisation or saturation"),
    };
    let proved = run.counts_noise();
    let beside = match (proved && run.spec.v_bar() > 0, proved && run.spec.disturbances.in_doubles()) {
        (false, false) => "",
        (true, false) => "; only the bounds with noise for given $`n_o`$ include `measurement`",
        (false, true) => "; only the bounds with rounding for given $`n_o`$ include that of the exported C code",
        (true, true) => {
            "; only the bounds with noise for given $`n_o`$ include `measurement` and the rounding of the exported C code"
        }
    };
    facts.push(("assumed", format!("{}; {of_the_computer}{beside}", assumed(run.spec, run.largest_arguments(), None))));
    let asked: Vec<u32> = run.rates().map(|(n_o, _)| n_o).collect();
    let known = by_count(run.spec, run.by_count.as_ref(), &asked);
    [Block::facts(facts)]
        .into_iter()
        .chain(known)
        .chain([Block::says(letters(run.spec, &witness.set, "The law"))])
        .collect()
}

/// What to do with the claim next; `at_samples` where its law is one.
fn next(spec: &Specification, origin: Origin, at_samples: bool) -> String {
    let said = match (origin, at_samples) {
        (Origin::Search, false) => {
            "`sigmastar design` finds a gain and $`n_o`$ for your needs; `-o FILE` writes the certificate, `check FILE` decides it \
             again, `controller FILE --n-o N` writes the regulator"
        }
        (Origin::Search, true) => {
            "`sigmastar design` finds a gain and $`n_o`$ for your needs; `-o FILE` writes the certificate, `check FILE` decides it again, \
             `controller FILE --n-o N --format c` writes the code"
        }
        (Origin::Written, false) => {
            "`sigmastar design` finds a gain and $`n_o`$ for your needs; `check FILE` decides the certificate again, `controller FILE --n-o N` \
             writes the regulator"
        }
        (Origin::Written, true) => {
            "`sigmastar design` finds a gain and $`n_o`$ for your needs; `check FILE` decides the certificate again, \
             `controller FILE --n-o N --format c` writes the code"
        }
        (Origin::Witness, false) => {
            "`sigmastar check FILE` decides the certificate with other code; `controller FILE --n-o N` writes the regulator"
        }
        (Origin::Witness, true) => {
            "`sigmastar check FILE` decides the certificate with other code; `controller FILE --n-o N` writes the code"
        }
        (Origin::Checked, _) => {
            let writes = if at_samples { " --format c -o FILE.c` writes the code" } else { "` writes the regulator" };
            // A simulation takes a plant.
            let runs = spec.plant().map_or("", |_| "`simulate FILE --n-o N` runs it with the plant; ");
            return format!(
                "`sigmastar controller FILE --n-o N{writes}; {runs}`falsify FILE` tries to break the claim by simulation"
            );
        }
    };
    said.to_owned()
}

/// What the letters above are, and whom a gain or a law serves: every plant of which what is assumed above holds.
fn letters(spec: &Specification, set: &ClaimedSet, what: &str) -> String {
    let serves = if spec.plant().is_some() { String::new() } else { format!(" {what} serves every such plant.") };
    words::letters(spec, set) + &serves
}

/// The initial set, of a plant the ball in it, and where its sizes are from.
fn initial_set(spec: &Specification, set: &ClaimedSet, [x, e, ..]: &[Enclosure; 4], when: &str) -> String {
    let ball = words::ball(spec, set);
    let own = words::origin_of_sizes(spec, set, [x, e]);
    format!("{}, at {when}{ball}; {own}", words::set(spec, set))
}

/// The periodic solution, how far from it solutions go, and how large the control gets.
fn periodic_solution(
    spec: &Specification,
    periodic: &[Enclosure; 4],
    (d_x, peak): (String, &Enclosure),
    control: Option<(&Control<Enclosure>, &str)>,
) -> String {
    let ([x, e, _, _], peak) = (periodic.each_ref().map(upper), upper(peak));
    let (along, transient) = match spec.state_name() {
        Some(state) => (
            format!("$`|{state}| <= {x}`$, $`|e| <= {e}`$"),
            format!("$`{state}`$ stays within {d_x} of it, $`|e| <= {peak}`$"),
        ),
        None => (format!("$`|e| <= {e}`$"), format!("$`|e| <= {peak}`$")),
    };
    let of_u = |bound: &Enclosure| format!(", $`|u| <= {}`$", upper(bound));
    let [steady, largest] = match control {
        Some((Control { steady, transient }, which)) => {
            [of_u(steady), format!("{}{which}", of_u(&(steady + transient)))]
        }
        None => [String::new(), String::new()],
    };
    format!("{along}{steady}; in the transient {transient}{largest}")
}

/// The mechanism that asks for most of sigma*, and the datum that would lower it most.
fn limited_by(run: &Certification<'_>) -> Option<String> {
    let binding = run.binding.filter(|_| run.given_gain.is_none())?;
    let best = run.sensitivities.first().filter(|(_, gain)| *gain >= sensitivity::TOLD).map(|(datum, gain)| {
        format!(
            "; {} lowers $`sigma*`$ by about {} %",
            sensitivity::one_per_cent(run.spec, *datum),
            estimate(100.0 * gain)
        )
    });
    Some(format!("{}{} (estimates)", binding.describe(), best.unwrap_or_default()))
}

/// The interval of the input gain, and what it costs.
fn input_gain(run: &Certification<'_>) -> Option<String> {
    let said = uncertain_gain(run.spec)?;
    let known = run.alternatives.nominal_gain.filter(|_| run.given_gain.is_none());
    let known = known.map_or_else(String::new, |sigma| format!("; {}", sensitivity::nominal_gain(sigma)));
    Some(format!("{said}{known}"))
}

/// The interval of the input gain.
fn uncertain_gain(spec: &Specification) -> Option<String> {
    let gain = spec.input_gain.as_ref()?;
    let which = words::input_gain(spec, ["exactly", "any constant from"])?;
    let nominal = words::nominal_gain(gain);
    Some(format!("{which}; the regulator divides its control by the nominal gain {nominal}"))
}

/// What the intervals of parameters cost.
fn interval_costs(spec: &Specification, all: &[(String, Option<f64>)], gain: &str) -> Option<String> {
    let found = all.iter().filter_map(|(name, sigma)| Some((name, (*sigma)?)));
    let costs: Vec<String> = found
        .map(|(name, sigma)| format!("{} if {} were known exactly", estimate(sigma), words::of_interval(spec, name)))
        .collect();
    (!costs.is_empty()).then(|| format!("{gain} would be about {} (estimates)", costs.join(", ")))
}

/// The bounds of the error for a few n_o.
fn few(by_n_o: &[(u64, ErrorBounds)]) -> Option<String> {
    error(by_n_o.iter().filter(|(n_o, _)| SHOWN.contains(n_o)))
}

/// Bounds of the error.
fn error<'b>(shown: impl Iterator<Item = &'b (u64, ErrorBounds)>) -> Option<String> {
    let shown: Vec<String> =
        shown.map(|(n_o, bounds)| format!("{} with $`n_o = {n_o}`$", upper(&bounds.sup))).collect();
    (!shown.is_empty()).then(|| format!("$`sup|e|`$ at most {}", shown.join(", ")))
}
