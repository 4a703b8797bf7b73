//! The certificate file, and the order in which the rules are applied to it.

use crate::subject::{Subject, same_data};
use proofs_core::data::Data;
use proofs_core::effort;
use proofs_core::json::{Field, Json};
use proofs_core::rules::bounding;
use proofs_core::rules::by_n_o;
use proofs_core::rules::claim::{Claim, reads};
use proofs_core::rules::common::Free;
use proofs_core::rules::derivation::{Derivation, Inequalities};
use proofs_core::rules::no_plant::NoPlant;
use proofs_core::rules::rates::{self, Asked, Kind, Witness};
use proofs_core::sha256;
use proofs_core::spec::{Specification, header};
use proofs_core::verdict::{Finding, Outcome, Verdict, bad};
use rug::Float;

/// The precisions that a certificate may name, in bits: those at which it may have been written.
const PRECISIONS: std::ops::RangeInclusive<u32> = 128..=4096;
/// The precisions at which a claim is decided: doubled from the first on, up to the last or to that of the certificate.
const FIRST_PRECISION: u32 = 128;
const LAST_PRECISION: u32 = 1024;

/// Applies every rule, and returns what a certificate is about whose claim is proved; `lines` receives the argument, line by line.
/// `other` is a specification that the certificate has to be about.
pub fn check(json: &Json, other: Option<&Json>, lines: &mut Vec<String>) -> Outcome<Subject> {
    let mut file = Field { json, pointer: String::new() }.fields()?;
    header(&mut file, "sigmastar/certificate")?;
    let mut tool = file.required("tool")?.fields()?;
    let tool_name = tool.required("name")?.text()?;
    let tool_version = tool.required("version")?.text()?;
    tool.finish()?;
    let bits = file.required("precision_bits")?;
    let written_at = bits.whole()?;
    if !PRECISIONS.contains(&written_at) {
        return bad(&bits.pointer, format!("expected {PRECISIONS:?} bits"));
    }
    // A plant stands in the place of a specification.
    let (embedded, about) = match file.optional("plant") {
        Some(plant) => (plant, "plant"),
        None => (file.required("specification")?, "specification"),
    };
    let mut witness = file.required("witness")?.fields()?;
    let (mut spec, cells) = match about {
        "plant" => proofs_plants::read::read(&embedded, &mut witness).map(|(spec, cells)| (spec, Some(cells)))?,
        _ => (Specification::read(&embedded, &mut witness)?, None),
    };
    let mut canonical = String::new();
    embedded.json.canonical(&mut canonical);
    let digest = sha256::hex_digest(canonical.as_bytes());
    reads("digest", &file.required(&format!("{about}_sha256"))?, &digest)?;
    lines.push(format!(
        "{about}: well-formed; T, w, mu, alpha, P_low > 0, P_up >= P_low; W1-W3 and n_0 > n_1; digest right"
    ));

    let has_states = spec.plant.as_ref().is_some_and(|plant| plant.states > 0);
    let claim = Claim::read(&file.required("claim")?, has_states)?;
    if let Some(actuator) = &mut spec.actuator {
        actuator.by_n_o = claim.keeps_to_actuator_by_n_o()?;
    }
    let derivation = match &claim.sampled {
        Some(regulator) => Derivation::read_sampled(&mut witness, regulator, (claim.set.clone(), claim.scope()))?,
        None => Derivation::read(&mut witness, claim.sigma.clone(), (claim.set.clone(), claim.scope()))?,
    };
    let continuous = claim.sampled.is_none();
    let no_plant = if continuous { file.optional("no_plant") } else { None };
    let no_plant = no_plant.as_ref().map(NoPlant::read).transpose()?;
    // Figures for people: nothing that is proved rests on them, and they are not looked at. Those of a continuous regulator are left to
    // be refused in a sampled certificate.
    file.optional("conditions");
    if continuous {
        file.optional("constants");
        file.optional("comparison");
        witness.optional("lmi");
    }
    let states = spec.plant.as_ref().map_or(0, |plant| plant.states);
    let regions = derivation.regions();
    let kind = match regions {
        None if continuous => Kind::Continuous,
        None => Kind::Sampled,
        Some(_) => Kind::Slopes { states, corner: derivation.has_corner() && states > 0 },
    };
    let rates = Witness::read_all(witness.optional("for_n_o").as_ref(), &claim.rates, kind)?;
    let by_n_o =
        by_n_o::Witness::read(witness.optional("by_n_o").as_ref(), &claim.by_n_o, &spec, derivation.at_samples())?;
    witness.finish()?;
    file.finish()?;
    by_n_o::demand_form(&spec, &claim.by_n_o)?;

    let mut precision = FIRST_PRECISION;
    let last = LAST_PRECISION.max(written_at);
    let (arguments, statement) = loop {
        let mut attempt = lines.clone();
        let d = Data::new(&spec, precision);
        let result = prove(&d, &claim, (&derivation, &rates, by_n_o.as_ref()), &mut attempt)
            .and_then(|proved| no_plant.as_ref().map_or(Ok(()), |part| part.prove(&d, &mut attempt)).map(|()| proved));
        // More bits do not help where the cutting of a box came to its end.
        let undecided = |finding: &Finding| finding.verdict == Verdict::Undecided && finding.rule != bounding::RULE;
        let open = result.as_ref().is_err_and(|finding| undecided(finding));
        if !open || precision >= last || effort::exhausted() {
            *lines = attempt;
            break result?;
        }
        precision = (precision * 2).min(last);
    };
    let shown = arguments.each_ref().map(Float::to_f64);
    // Last, because it may take the longest.
    if let Some(cells) = &cells {
        let slopes = regions.map(|at| Asked { witnesses: &rates, at });
        let inequalities = Inequalities { list: Some(&derivation.inequalities), law: derivation.law(), slopes };
        proofs_plants::prove(&spec, cells, arguments.each_ref(), inequalities, lines)?;
        if let Some(witness) = &by_n_o {
            let (Free { set, d_x, d_e, w_x, h, k0, k1, .. }, sigma) = (&derivation.free, &claim.sigma);
            let (error_box, periodic) = ([d_x, d_e], claim.sizes()?);
            let (weights, stability) = ([w_x, h], derivation.inequalities.stability.as_ref());
            // Of k0 and k1 the transfer bound is proved with the claim, by its derivation.
            let transfer = [k0, k1];
            let at_samples = derivation.at_samples();
            let about = by_n_o::About { sigma, set, error_box, periodic, transfer, weights, stability, at_samples };
            proofs_plants::by_n_o::prove(&spec, cells, &about, (&claim.by_n_o, witness), lines)?;
        }
    }
    // By what is proved by now.
    if let Some(actuator) = spec.actuator.as_ref().filter(|actuator| actuator.by_n_o) {
        claim.keep_to_actuator(actuator)?;
        lines.push("actuator: with every n_o what is put out is at most its max, by what is said by n_o".to_owned());
    }
    if let Some((jacobian, witness)) = &spec.jacobian {
        for witness in [witness].into_iter().chain(spec.existence.iter().map(|(witness, _)| witness)) {
            lines
                .push(format!("Lyapunov triple: {}", proofs_plants::jacobian::prove(jacobian, &spec.period, witness)?));
        }
    }
    let of = (&spec, &claim, &derivation);
    let subject = Subject::new(&embedded, of, statement, &digest, [tool_name, tool_version], shown);
    if let Some(other) = other {
        same_data(about, embedded.json, other)?;
    }
    Ok(subject)
}

/// The claim at one precision: the largest X and E at which bounding functions are used, and what is proved in words.
fn prove(
    d: &Data<'_>,
    claim: &Claim<'_>,
    (derivation, rates, by_n_o): (&Derivation, &[Witness], Option<&by_n_o::Witness>),
    lines: &mut Vec<String>,
) -> Outcome<([Float; 2], String)> {
    lines.push(format!("working precision: {} bits", d.precision));
    if let Some([x, e]) = &d.spec.domain {
        let (x, e) = (x.enclose(d.precision), e.enclose(d.precision));
        bounding::prove_all(d, [&x, &e], lines)?;
    }
    let proved = derivation.prove(d, lines)?;
    let free = &derivation.free;
    let statement = claim.check(d, &proved, [&free.x_p, &free.e_p], derivation.prediction())?;
    if !rates.is_empty() {
        if !derivation.rests_on_norms() && derivation.regions().is_none() {
            return bad(
                "/claim/for_n_o",
                "rates at samples are proved with a claim by norms, of a law without a delay",
            );
        }
        let known = by_n_o.map(|witness| by_n_o::Known { claimed: &claim.by_n_o, witness });
        let about = (free, &proved.sizes, &claim.sigma, derivation.law(), known);
        rates::prove(d, about, (&claim.rates, rates), lines)?;
    }
    if let Some(witness) = by_n_o {
        let about = (&free.set, &claim.sigma, derivation.at_samples());
        by_n_o::prove(d, about, (&claim.by_n_o, witness), lines)?;
    }
    lines.push("claim: verdict, n_o, mu, set, periodic solution and control follow from what is proved".to_owned());
    let mut largest = proved.arguments.each_ref().map(|argument| argument.hi().into_owned());
    if let Some(plant) = &d.spec.plant {
        // Those of exact regulation count as well, and one that is not known most of all.
        for (end, other) in largest.iter_mut().zip(derivation.regulated(d).into_iter().flatten()) {
            if !other.is_defined() || *other.hi() > *end {
                end.clone_from(&other.hi());
            }
        }
        plant.lies_within(largest.each_ref(), "/witness")?;
    }
    Ok((largest, statement))
}
