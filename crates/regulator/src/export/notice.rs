//! What is claimed of an exported regulator, and what is not: the words that every export carries.

use super::Export;
use sigmastar_lang::spec::Oscillators;

/// The law at samples, as exports write it: Phi is R there.
pub const SAMPLED_LAW: &str = "v = M'N Phi (z - M e), u = -sigma e + K v, z_next = Phi (z - M e) + (1 - h sigma) M e";

/// The law at samples with a delay, as exports write it: the state is (z, s).
pub const DELAYED_LAW: &str = "e1 = e + s, z_next = R (z - M e) + M e1, v = M'N R (z_next - M e1), u_next = -sigma e1 + K v, \
                               s_next = -h sigma e1";

/// When what happens, with a delay.
fn delay(export: &Export<'_>) -> String {
    format!(
        "The computation has a whole sample (delay_samples: 1): e_k is measured at the sample k, u_(k+1) is computed from it, and put out at the sample \
         k + 1. Until the first one is, put out {}.",
        super::decimal(export.middle.unwrap_or(0.0))
    )
}

/// What a certificate says of a regulator.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Provenance {
    /// SHA-256, in hexadecimal, of the canonical form of the certificate.
    pub sha256: String,
    /// Its sigma*, exactly; of a claim about the regulator at samples its gain.
    pub sigma_star: String,
    /// Whether it is about that gain alone: at samples, or with an actuator.
    pub one_gain: bool,
    /// Its claim in words.
    pub statement: String,
    /// What it says about this regulator.
    pub scope: Scope,
    /// The oscillators, where what it says of these counts the rounding of the C code.
    pub rounding: Option<Oscillators>,
}

/// What the claim of a certificate is about, and whether the regulator is that.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// The regulator in continuous time, with this gain.
    Continuous,
    /// The regulator in continuous time, with larger gains than this one.
    BelowSigmaStar,
    /// The regulator in continuous time, with another gain than this one: a claim with an actuator is about one.
    OtherGain,
    /// The regulator at samples: exactly this law.
    Samples,
    /// The regulator at samples with another gain, sampling period, internal model or too many oscillators.
    OtherSamples,
    /// The regulator with oscillators at the first n_o harmonics, where these are at others; whether that is the one at samples.
    OtherHarmonics {
        /// At samples.
        at_samples: bool,
    },
}

impl Scope {
    /// Whether the claim covers this regulator; of one in continuous time not its sampling.
    #[must_use]
    pub fn covers(self) -> bool {
        matches!(self, Scope::Continuous | Scope::Samples)
    }

    /// Whether the claim is about the regulator at samples.
    #[must_use]
    pub fn is_sampled(self) -> bool {
        matches!(self, Scope::Samples | Scope::OtherSamples | Scope::OtherHarmonics { at_samples: true })
    }

    /// Why it says nothing about this regulator, where it does not.
    #[must_use]
    pub fn obstacle(self, sigma_star: &str) -> Option<String> {
        match self {
            Scope::Continuous | Scope::Samples => None,
            Scope::BelowSigmaStar => Some(format!("sigma is below its sigma* = {sigma_star}")),
            Scope::OtherGain => Some(format!(
                "it states an actuator, so it is about sigma = {sigma_star} alone, and this is another gain"
            )),
            Scope::OtherHarmonics { .. } => Some(
                "it is about oscillators at the first n_o harmonics, and those of this regulator are at other harmonics"
                    .to_owned(),
            ),
            Scope::OtherSamples => Some(format!(
                "it is about one law at samples, with sigma = {sigma_star} and the sampling period that it states, and this is \
                 another one"
            )),
        }
    }
}

/// What stands in every export, one sentence or claim a line.
#[must_use]
pub fn notice(export: &Export<'_>) -> Vec<String> {
    let mut lines = match export.certificate {
        None => vec!["No certificate was given: nothing is claimed.".to_owned()],
        Some(Provenance { sha256, sigma_star, statement, scope, .. }) => {
            let named = format!("Certificate with SHA-256 {sha256} (of its canonical form)");
            let decided = format!("{named}. `sigmastar check` decides it.");
            let claim = format!("Its claim: {}", plain(statement));
            let about = match scope {
                Scope::Samples => "The claim is about this law at samples: this gain, this sampling period, this K.",
                _ => "The certificate is about the continuous-time law. It does not cover sampling.",
            };
            match scope.obstacle(sigma_star) {
                None => vec![decided, claim, about.to_owned()],
                Some(why) => vec![format!("{named}: it says nothing about this regulator, because {why}.")],
            }
        }
    };
    if export.oscillators.n_o().is_none() {
        lines
            .push(format!("The regulator has {} of the base frequency, 0 that of the integrator.", export.oscillators));
    }
    let delayed = export.discrete.is_some_and(|(discrete, _)| discrete.prediction.is_some());
    if delayed {
        lines.push(delay(export));
    }
    if export.aligned {
        lines.push(
            "The initial set is `aligned`: start with z = M e, where e is the error at the first instant.".to_owned(),
        );
    }
    if let Some(nominal) = export.regulator.nominal {
        let sampled = match export.discrete {
            Some(_) => " What this comment says of the sampled loop holds for exactly this gain.",
            None => "",
        };
        let nominal = super::decimal(nominal);
        lines.push(match export.middle {
            None => format!("u is what the actuator is given: the control of the law is divided by the nominal input gain {nominal}.{sampled}"),
            Some(_) => format!("u is the control of the law over the nominal input gain {nominal}.{sampled}"),
        });
    }
    if let Some(middle) = export.middle {
        lines.push(format!(
            "u is measured from the middle of the range of the actuator, which is to be given {} + u. The step function of C code returns that sum: put it \
             out as it is.",
            super::decimal(middle)
        ));
    }
    let claimed = (export.certificate.map(|certificate| certificate.scope), export.actuator);
    let rounding = export.certificate.filter(|certificate| certificate.scope == Scope::Samples);
    let rounding = rounding.and_then(|certificate| certificate.rounding.as_ref());
    let quantisation = if rounding.is_some() { "quantisation that these bounds do not name" } else { "quantisation" };
    // With an actuator the saturation is in a claim about the regulator that is exported, and in no other.
    let saturates = match (claimed, export.discrete) {
        ((Some(Scope::Samples), Some(_)), _) | ((Some(Scope::Continuous), Some(_)), None) => {
            format!("or {quantisation}")
        }
        _ => format!("{quantisation}, or saturation"),
    };
    let late = if delayed { "a computation that takes more than a sample" } else { "a delay of the computation" };
    lines.push(match rounding {
        None => format!(
            "No claim covers the rounding of these numbers and of the arithmetic with them, {late}, {saturates}."
        ),
        Some(oscillators) => format!(
            "The bounds of the certificate with {oscillators} that say \"computed in double precision as exported\" include the rounding of the exported C \
             code. No other bound includes it. No claim covers {late}, {saturates}."
        ),
    });
    lines.extend(clipped(export, claimed.0));
    lines
}

/// Where u is clipped, or is to be; with an actuator, what the certificate says of that.
fn clipped(export: &Export<'_>, scope: Option<Scope>) -> Option<String> {
    let of_max = export.actuator.map_or_else(String::new, |actuator| match actuator.range {
        None => {
            format!(", the least double that is not below the {} that the actuator takes", plain(&actuator.max.text))
        }
        Some(_) => format!(
            ", the least double that is not below half of the range of the actuator, {}",
            plain(&actuator.max.text)
        ),
    });
    let proved = match (export.actuator.and(scope), export.discrete) {
        (Some(Scope::Samples), Some(_)) | (Some(Scope::Continuous), None) => {
            " From the set of the certificate what this law puts out, computed exactly and without noise, stays within that."
        }
        (Some(Scope::Continuous), Some(_)) => {
            " That from the set of the certificate u stays within that is proved of the law in continuous time, without noise, and not at \
             samples."
        }
        _ => "",
    };
    let Some((discrete, _)) = export.discrete else {
        let limit = super::decimal(export.actuator?.limit());
        return Some(format!("Clip u to |u| <= {limit}{of_max}.{proved}"));
    };
    let limit = super::decimal(discrete.saturation?);
    let (told, by) = if discrete.prediction.is_some() { ("s", "h") } else { ("z", "h M") };
    Some(format!(
        "u is clipped to |u| <= {limit}{of_max}.{proved} Against windup {told} is told the control applied: where u is clipped, {by} \
         (applied - wanted) is added to {told}_next. No claim covers a run in which that happens."
    ))
}

/// Text of a stranger as it may stand in source code: printable ASCII on one line.
fn plain(text: &str) -> String {
    let words: String = text.chars().map(|c| if c.is_ascii_graphic() { c } else { ' ' }).collect();
    words.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Lines of comment of at most about a hundred characters, each with the prefix: a paragraph for each of these, with an empty line between them, and in
/// it each sentence from the start of a line.
pub(super) fn comment(paragraphs: &[String], prefix: &str) -> String {
    let texts: Vec<String> = paragraphs
        .iter()
        .map(|paragraph| rows(paragraph).into_iter().map(|row| format!("{prefix}{row}\n")).collect())
        .collect();
    texts.join(&format!("{}\n", prefix.trim_end()))
}

/// The rows of a paragraph.
fn rows(paragraph: &str) -> Vec<String> {
    const WIDTH: usize = 100;
    let mut rows: Vec<String> = Vec::new();
    let mut begins = true;
    for word in paragraph.split_whitespace() {
        match rows.last_mut().filter(|row| !begins && row.len() + 1 + word.len() <= WIDTH) {
            Some(row) => *row += &format!(" {word}"),
            None => rows.push(word.to_owned()),
        }
        begins = word.ends_with('.');
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_are_wrapped_and_hold_every_word() {
        let text = comment(&["ab ".repeat(60), "c".repeat(120)], "% ");
        assert_eq!(text.split_whitespace().filter(|word| *word == "ab").count(), 60);
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines.len() == 4 && lines.iter().all(|line| line.starts_with('%')));
        assert!(lines[..2].iter().all(|line| line.len() <= 102) && lines[2] == "%" && lines[3].len() == 122);
        assert_eq!(comment(&["One of 0.5. Two.".to_owned()], "% "), "% One of 0.5.\n% Two.\n");
        assert_eq!(plain("a\nb\u{202e} \tc"), "a b c");
    }
}
