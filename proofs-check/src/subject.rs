//! What a certificate is about: the claim in words, the specification, what it takes for granted; and whether that is the
//! specification of somebody else's file.

use proofs_core::actuator::Actuator;
use proofs_core::bound::{BOUND_NAMES, Bound};
use proofs_core::input_gain;
use proofs_core::json::{Field, Json, join, rational};
use proofs_core::plant::OfPlant;
use proofs_core::plant::parameters::Parameter;
use proofs_core::range::Range;
use proofs_core::rules::claim::Claim;
use proofs_core::rules::derivation::Derivation;
use proofs_core::spec::Specification;
use proofs_core::verdict::{Outcome, escaped, invalid};

const RULE: &str = "the specification that was asked for";

/// The most characters of a free text that are shown.
const MAX_SHOWN: usize = 200;

/// What a certificate that is proved says, and of what.
#[derive(Clone, Debug)]
pub struct Subject {
    /// The claim in words: proved.
    pub statement: String,
    /// What is proved besides: exact regulation, in words.
    pub also: Option<String>,
    /// What stands in the file: `specification` or `plant`.
    pub about: &'static str,
    /// The SHA-256 of its canonical form: right.
    pub digest: String,
    /// What is assumed and not proved, one a line.
    pub assumed: Vec<String>,
    /// Texts that anybody may write: `name`, `description`, `tool`.
    pub free_texts: Vec<(&'static str, String)>,
}

impl Subject {
    /// From a certificate that is proved, and what is proved in words; `arguments` are the largest X and E at which its bounding functions
    /// are used.
    pub fn new(
        embedded: &Field<'_>,
        (spec, claim, derivation): (&Specification, &Claim<'_>, &Derivation),
        statement: String,
        digest: &str,
        [tool, version]: [&str; 2],
        arguments: [f64; 2],
    ) -> Subject {
        let text = |name: &str| {
            let mut fields = embedded.fields().ok()?;
            fields.optional(name).and_then(|field| field.text().ok()).map(free_text)
        };
        let named = [("name", text("name")), ("description", text("description"))];
        let mut free_texts: Vec<_> =
            named.into_iter().filter_map(|(name, text)| text.map(|text| (name, text))).collect();
        free_texts.push(("tool", format!("{} {}", free_text(tool), free_text(version))));
        let also = derivation.regulation.as_ref().map(|w| {
            format!(
                "With infinitely many oscillators and any gain sigma >= {}, solutions from the same set are bounded, and {}.",
                w.sigma_text,
                limit(spec.plant.as_deref())
            )
        });
        let rounded = claim.says_of_noise() && spec.noise.is_rounded(claim.sampled.is_some());
        Subject {
            statement,
            also,
            digest: digest.to_owned(),
            about: if spec.plant.is_some() { "plant" } else { "specification" },
            assumed: {
                let mut list = match &spec.plant {
                    Some(plant) => assumed_of_plant(plant, spec),
                    None => assumed(spec, arguments),
                };
                list.extend(spec.period.range().map(period));
                match &claim.sampled {
                    Some(sampled) => {
                        list.extend(sampled.assumed([spec.actuator.is_some(), claim.says_of_noise(), rounded]));
                        list.extend(output(spec).map(|said| format!("the regulator{said}")));
                    }
                    None => list.push(regulator(spec, claim.says_of_noise())),
                }
                if claim.says_of_noise() {
                    list.push(NOISE.to_owned());
                }
                if rounded {
                    list.push(ROUNDING.to_owned());
                }
                list
            },
            free_texts,
        }
    }
}

/// What vanishes with infinitely many oscillators (docs/mathematics.md, section 6): within bounding functions x is the
/// deviation from the solution of `x' = f(t,x,0)`, in the formulas of a plant it is not.
fn limit(plant: Option<&OfPlant>) -> &'static str {
    match plant {
        None => "x and e tend to 0",
        Some(plant) if plant.states == 0 => "e tends to 0",
        Some(_) => "x - x_0(t) and e tend to 0",
    }
}

/// What the claim takes for granted (docs/trust.md) of the plant.
fn assumed(spec: &Specification, [x, e]: [f64; 2]) -> Vec<String> {
    let given = |bound: Bound| spec.bounds[bound as usize].is_some();
    let names: Vec<&str> = BOUND_NAMES.iter().zip(&spec.bounds).filter(|(_, b)| b.is_some()).map(|(n, _)| *n).collect();
    let where_ = match &spec.domain {
        Some([x, e]) => format!("on the domain |x| <= {}, |e| <= {}", x.words, e.words),
        None => format!(
            "for all X and E (no domain is stated; the main claim uses them up to X = {}, E = {})",
            rounded_up(x),
            rounded_up(e)
        ),
    };
    let input = input(spec);
    let mut list = vec![
        format!("the plant is x' = f(t,x,e), e' = q(t,x,e) + {input} with f, q C2, T-periodic in t, and f(t,0,0) = 0"),
        format!("the bounding functions ({}) bound that plant {where_}", names.join(", ")),
    ];
    if given(Bound::QRms) || given(Bound::QtRms) {
        list.push("q_rms, q_t_rms bound mean squares over a period as the format says".to_owned());
    }
    list.push(if spec.jacobian.is_some() {
        "df/dx(t,0,0) is at each t one of the matrices of `jacobian` (the Lyapunov triple is proved from that)"
            .to_owned()
    } else {
        "the Lyapunov triple (p_low, p_up, alpha) holds for df/dx(t,0,0)".to_owned()
    });
    if spec.rate.is_some() {
        list.push("df/dx(t,x,e) contracts at the rate `rate` in the P of that triple".to_owned());
    }
    if spec.q_0.is_some() {
        list.push("q(t,0,0) is made of the harmonics and the rest that `q_0` bounds".to_owned());
    }
    list
}

/// Four digits that are not below the number.
fn rounded_up(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let exponent = format!("{value:e}").split_once('e').and_then(|(_, exponent)| exponent.parse::<i32>().ok());
    let places = 3 - exponent.unwrap_or(0);
    let in_digits = |value: f64| match places {
        0..=6 => format!("{value:.0$}", places.unsigned_abs() as usize),
        _ => format!("{value:.3e}"),
    };
    let half = format!("5e{}", -places - 1).parse().unwrap_or(0.0);
    let bounds = |text: &String| text.parse().is_ok_and(|shown: f64| shown >= value);
    [value, value + half, value + 2.0 * half]
        .into_iter()
        .map(in_digits)
        .find(bounds)
        .unwrap_or_else(|| format!("{value:e}"))
}

/// What is assumed of a period that is an interval.
fn period(range: &Range) -> String {
    let [low, high] = [&range.low, &range.high].map(|end| &end.words);
    format!(
        "the period T is one constant in [{low}, {high}], and time enters the plant through the phase 2 pi t/T alone"
    )
}

/// What reaches the plant.
fn input(spec: &Specification) -> &'static str {
    match (&spec.input_gain, spec.actuator.as_ref().and_then(Actuator::middle_in_words)) {
        (Some(_), _) => "g v, v what the regulator puts out and g the gain of the actuator,",
        (None, Some(_)) => "what the regulator puts out,",
        (None, None) => "u",
    }
}

/// What is put out where that is not u, and what becomes of it.
fn output(spec: &Specification) -> Option<String> {
    let middle = spec.actuator.as_ref().and_then(Actuator::middle_in_words);
    let put_out = spec.input_gain.as_ref().map(input_gain::output);
    let whole = match (middle, put_out) {
        (None, None) => return None,
        (None, Some(put_out)) => put_out,
        (Some(middle), put_out) => format!("{middle} + {}", put_out.as_deref().unwrap_or("u")),
    };
    let Some(gain) = &spec.input_gain else { return Some(format!(" puts out {whole}, and this acts in e'")) };
    let [low, high] = [&gain.low, &gain.high].map(|constant| &constant.words);
    let value = if low == high { format!("the constant {low}") } else { format!("one constant in [{low}, {high}]") };
    Some(format!(" puts out v = {whole}; g is {value}"))
}

/// What is assumed where something is said of noise.
const NOISE: &str = "where the claim has noise: at all times the regulator takes e + v for e, and the plant has q + d for q; |v| is at most the noise \
                     plus half a step of the measurement, |d| at most the disturbance, and both are arbitrary otherwise";

/// What is assumed besides where its arithmetic is that of doubles.
const ROUNDING: &str = "where the claim has rounding: the regulator computes in doubles as its exported C code does, each constant the double nearest to \
                        it and each operation rounded to nearest on its own, in the order of that code (no fast-math, no \
                        excess precision); what it takes for e is the double nearest to e + v, and its z starts as doubles";

/// What it takes for granted of a continuous regulator; `noisy`: something is said of noise.
fn regulator(spec: &Specification, noisy: bool) -> String {
    let frequency = if spec.regulator.matched { ", with base_frequency exactly 2 pi/period" } else { "" };
    let output = output(spec).map_or_else(String::new, |said| format!(", and{said}"));
    format!(
        "the regulator runs in continuous time with exactly the mu, weights and base frequency stated{frequency}{output}: no \
         {} or noise{}",
        if spec.actuator.is_some() { "sampling, delay" } else { "sampling, delay, saturation" },
        if noisy { " except where the claim says so" } else { "" }
    )
}

/// What a claim about formulas takes for granted.
fn assumed_of_plant(plant: &OfPlant, spec: &Specification) -> Vec<String> {
    let stateless = plant.states == 0;
    let where_ = match &plant.domain {
        None => String::new(),
        Some([_, e]) if stateless => format!(" for |e| <= {}", e.words),
        Some([x, e]) => format!(" for |x - x_0| <= {}, |e| <= {}", x.words, e.words),
    };
    let (equations, input) = (if stateless { "e' = q(t,e)" } else { "x' = f(t,x,e), e' = q(t,x,e)" }, input(spec));
    let family: Vec<String> = plant.parameters.iter().map(Parameter::in_words).collect();
    let family = if family.is_empty() { String::new() } else { format!(", with {}", family.join(" and ")) };
    vec![format!("the machine is {equations} + {input} with exactly these formulas{family}{where_}")]
}

/// A free text: several blanks are one, for with many of them it could end in what looks like a line of the answer where a terminal wraps it.
fn free_text(text: &str) -> String {
    printable(&text.split(' ').filter(|word| !word.is_empty()).collect::<Vec<_>>().join(" "))
}

/// A text of a file on one line: what is not shown, or moves what is, is escaped, and what is long is cut.
fn printable(text: &str) -> String {
    let shown: String = text.chars().take(MAX_SHOWN).collect();
    let cut = if text.chars().nth(MAX_SHOWN).is_some() { "..." } else { "" };
    format!("{}{cut}", escaped(&shown))
}

/// Demands that two specifications hold the same data. Free texts and the order of fields do not matter, and a number may
/// be written in any way.
///
/// # Errors
/// `invalid`, with the first place where they differ and what each says there.
pub fn same_data(about: &str, embedded: &Json, asked: &Json) -> Outcome<()> {
    let free = if about == "plant" { &FREE[..] } else { &FREE[..3] };
    match difference(embedded, asked, "", free) {
        None => Ok(()),
        Some((place, ours, theirs)) => {
            let field = place.rsplit('/').next().unwrap_or_default();
            let message = match (ours.as_str(), theirs.as_str()) {
                (NOTHING, _) => format!("`{}` is in your file and not in the certificate", printable(field)),
                (_, NOTHING) => format!("`{}` is in the certificate and not in your file", printable(field)),
                _ => format!("the certificate has {ours}, your {about} has {theirs}"),
            };
            invalid(RULE, &format!("/{about}{place}"), message)
        }
    }
}

/// Fields of a specification that hold no data: texts, and the schema for editors, which a file may have and a certificate
/// not. The last one, of a plant alone: where simulations start.
const FREE: [&str; 4] = ["/name", "/description", "/$schema", "/initial"];

fn difference(a: &Json, b: &Json, place: &str, free: &[&str]) -> Option<(String, String, String)> {
    let differ = || Some((place.to_owned(), shown(Some(a)), shown(Some(b))));
    match (a, b) {
        (Json::Object(a), Json::Object(b)) => {
            let find = |list: &[(String, Json)], key: &str| list.iter().position(|(other, _)| other == key);
            let mut keys: Vec<&str> = a.iter().chain(b).map(|(key, _)| key.as_str()).collect();
            keys.sort_unstable();
            keys.dedup();
            keys.into_iter().map(|key| (join(place, key), key)).filter(|(at, _)| !free.contains(&at.as_str())).find_map(
                |(at, key)| match (find(a, key), find(b, key)) {
                    (Some(i), Some(j)) => difference(&a[i].1, &b[j].1, &at, free),
                    (i, j) => {
                        let (ours, theirs) = (i.map(|i| &a[i].1), j.map(|j| &b[j].1));
                        // Not matched and exact is the default.
                        let default = match ours.or(theirs) {
                            Some(Json::Bool(value)) => key == "matched" && !value,
                            Some(Json::Text(text)) => at == "/arithmetic" && text == "exact",
                            _ => false,
                        };
                        (!default).then(|| (at, shown(ours), shown(theirs)))
                    }
                },
            )
        }
        (Json::Array(a), Json::Array(b)) if a.len() == b.len() => {
            let pairs = a.iter().zip(b).enumerate();
            pairs.into_iter().find_map(|(i, (a, b))| difference(a, b, &join(place, &i.to_string()), free))
        }
        (Json::Text(a) | Json::Number(a), Json::Text(b) | Json::Number(b)) if same_numeral(a, b) => None,
        (Json::Bool(a), Json::Bool(b)) if a == b => None,
        (Json::Null, Json::Null) => None,
        _ => differ(),
    }
}

/// Whether two texts are equal but for white space, or are one rational number.
fn same_numeral(a: &str, b: &str) -> bool {
    let bare = |text: &str| text.split_whitespace().collect::<String>();
    bare(a) == bare(b) || rational(a).zip(rational(b)).is_some_and(|(a, b)| a == b)
}

/// A field that is not there.
const NOTHING: &str = "nothing";

fn shown(json: Option<&Json>) -> String {
    match json {
        None => NOTHING.to_owned(),
        Some(Json::Text(text) | Json::Number(text)) => format!("`{}`", printable(text)),
        Some(Json::Bool(value)) => value.to_string(),
        Some(Json::Null) => "null".to_owned(),
        Some(Json::Array(list)) => format!("a list of {}", list.len()),
        Some(Json::Object(_)) => "an object".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::{free_text, rounded_up};

    #[test]
    fn blanks_of_a_free_text_move_nothing_to_another_line() {
        assert_eq!(free_text(&format!("ok{}  proved:  all", " ".repeat(58))), "ok proved: all");
        assert_eq!(free_text(" a b "), "a b");
    }

    #[test]
    fn what_is_shown_is_not_below_the_number() {
        for (value, shown) in [
            (0.767_681_2, "0.7677"),
            (2.809_26, "2.810"),
            (1189.6345, "1190"),
            (40_381.9, "4.039e4"),
            (1.0e-9, "1.000e-9"),
            (0.5, "0.5000"),
            (9.999_9, "10.000"),
            (0.0, "0"),
        ] {
            let text = rounded_up(value);
            assert!(text == shown && text.parse::<f64>().unwrap() >= value, "{value}: {text}");
        }
    }
}
