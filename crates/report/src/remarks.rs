//! What the data themselves are to be looked at for; no verdict depends on it.

use rug::Rational;
use sigmastar_decide::conditions::{ExceededBy, NoPlant};
use sigmastar_document::number::{estimate, exact, upper};
use sigmastar_exact::number::Direction;
use sigmastar_lang::spec::{ProvedValue, Specification};
use sigmastar_prove::certify::{Certification, SampledCertification, unusual};

/// One sentence or two for each.
pub fn remarks(run: &Certification<'_>) -> Vec<String> {
    let mut remarks = of(run.no_plant.as_ref(), run.has_force_at_origin());
    remarks.extend(unused_parameters(run.spec));
    remarks.extend(meant_otherwise(run.spec));
    remarks.extend(no_worth_of_oscillators(run));
    if let Some(sigma) = run.sigma_star().filter(|_| run.is_smallest())
        && sigma.to_f64() * run.spec.period.longest().to_f64() > LARGE
    {
        let cause = far_above_its_samples(&run.spec.bounds.proved_values().entries).unwrap_or_else(|| {
            let of_plant = run.spec.plant().is_some();
            run.binding.map_or_else(String::new, |binding| {
                format!(
                    " It is limited by {}. {}",
                    binding.describe(),
                    binding.advice(of_plant, run.spec.initial_set.is_aligned())
                )
            })
        });
        remarks.push(format!("Remark: $`sigma*`$ is above $`10^4`$ divided by the period.{cause}"));
    }
    remarks.extend(unused_disturbances(run.spec, run.claim().is_some() && run.for_n_o.is_empty()));
    let asked = run.claim().is_some() && run.is_smallest() && !run.for_n_o.is_empty();
    remarks.extend(by_norms(
        run.spec,
        asked && run.spec.disturbances.any(),
        "what noise does with given numbers of oscillators is",
    ));
    remarks.extend(run.spec.disturbances.in_doubles().then(|| {
        "Remark: this claim does not include the rounding that `arithmetic` states, because it is about the regulator in continuous time. \
         `--sampling-period H --n-o LIST` includes it, in bounds for these numbers of oscillators."
            .to_owned()
    }));
    remarks
}

/// That noise and a disturbance of the document count nowhere in the claim.
fn unused_disturbances(spec: &Specification, unused: bool) -> Option<String> {
    (unused && spec.disturbances.any()).then(|| {
        "Remark: this claim is about the loop without noise: it does not include `measurement` and `disturbance`. `--n-o LIST` includes them, in \
         bounds for these numbers of oscillators."
            .to_owned()
    })
}

/// That rounding counts nowhere in the claim at samples.
fn unused_arithmetic(run: &SampledCertification<'_>) -> Option<String> {
    (run.claim().is_some() && run.for_n_o.is_empty() && run.spec.disturbances.in_doubles()).then(|| {
        "Remark: this claim is about the law without rounding: it does not include `arithmetic`. `--n-o LIST` includes it, in bounds for these \
         numbers of oscillators."
            .to_owned()
    })
}

/// A gain times the period above which a remark names what asks for it.
const LARGE: f64 = 1e4;

/// A bound that is so many times its samples is far above them.
const FAR: f64 = 2.0;

/// The bound of a plant that is farthest above what samples reach, where one is far above.
fn far_above_its_samples(entries: &[ProvedValue]) -> Option<String> {
    let ratio = |entry: &&ProvedValue| {
        let sampled = entry.sampled.as_ref().filter(|sampled| **sampled > 0 && !entry.bound.is_rate())?;
        Some(Rational::from(&entry.value / sampled).to_f64()).filter(|ratio| *ratio > FAR)
    };
    let rated = entries.iter().filter_map(|entry| Some((ratio(&entry)?, entry)));
    let (_, entry) = rated.max_by(|(one, _), (other, _)| one.total_cmp(other))?;
    Some(format!(
        " One bound is far above its samples: $`{}`$ ($`{}`$) is proved to be at most {}, and samples reach {}. A less steep formula \
         or a smaller `domain` may bring the two together, and so lower the gain.",
        entry.bound.field(),
        entry.bound.of_what(),
        exact(&entry.value, Direction::Up),
        estimate(entry.sampled.as_ref()?.to_f64()),
    ))
}

/// The remarks on a run about the regulator at samples.
pub fn sampled_remarks(run: &SampledCertification<'_>) -> Vec<String> {
    let mut remarks = of(run.no_plant.as_ref(), run.has_force_at_origin());
    remarks.extend(unused_parameters(run.spec));
    remarks.extend(meant_otherwise(run.spec));
    remarks.extend(unused_disturbances(run.spec, run.claim().is_some() && run.for_n_o.is_empty()));
    remarks.extend(unused_arithmetic(run));
    let asked = run.claim().is_some() && run.given_gain.is_none() && !run.for_n_o.is_empty();
    remarks.extend(by_norms(run.spec, asked && !run.sampling.delayed, "rates at samples are"));
    remarks
}

/// That parameters of a plant are used nowhere.
fn unused_parameters(spec: &Specification) -> Option<String> {
    Some(format!("Remark: {}.", spec.plant()?.parameters.unused_in_words()?))
}

/// Numbers that are likely to be meant in another way.
fn meant_otherwise(spec: &Specification) -> impl Iterator<Item = String> {
    let all = unusual(&spec.internal_model, &spec.period, spec.input_gain.as_ref());
    all.into_iter().map(|said| format!("Remark: {said}."))
}

/// That a claim about a plant rests on norms because of what was asked for `--n-o`, where a matrix inequality might have given a smaller gain.
fn by_norms(spec: &Specification, asked: bool, what: &str) -> Option<String> {
    let values = spec.bounds.proved_values();
    let by_matrix =
        values.inequality.is_some() || values.joint_stability.is_some() || values.at_samples.stability.is_some();
    (asked && spec.plant().is_some_and(|plant| plant.states() > 0) && !by_matrix).then(|| {
        format!(
            "Remark: with `--n-o` the claim rests on norms, because {what} proved from norms. Without `--n-o` a matrix inequality may prove a smaller gain."
        )
    })
}

/// So many oscillators are held against none, and the share of the bound with none that they leave at least where they are not worth it.
const MANY: u64 = 100;
const LEFT: f64 = 0.9;

/// That the bound of the steady error hardly falls with the number of oscillators.
fn no_worth_of_oscillators(run: &Certification<'_>) -> Option<String> {
    let [none, many] = [0, MANY].map(|n_o| run.error_with(n_o).map(|bounds| bounds.sup));
    let (none, many) = (none?, many?);
    if many.upper_f64() <= LEFT * none.upper_f64() {
        return None;
    }
    let advice = match (run.spec.period.interval(), run.spec.internal_model.matched) {
        (Some(_), _) => {
            "The reason is that only an interval of the period is known, so the oscillators are not at the harmonics. A narrower interval"
        }
        (None, false) => {
            "The reason is that `matched` is false, so the oscillators are not at the harmonics. A `base_frequency` of exactly 2*pi/period, with `matched`,"
        }
        (None, true) => "The reason is that at this gain the size of the loop bounds the error. A smaller load",
    };
    Some(format!(
        "Remark: the bound of the steady error hardly falls with the number of oscillators: it is {} with none and {} with {MANY}. {advice} lets it \
         fall. A larger gain lowers the bounds for every number of oscillators (`--steady-error V` seeks one).",
        upper(&none),
        upper(&many)
    ))
}

fn of(no_plant: Option<&NoPlant>, force_at_origin: bool) -> Vec<String> {
    let mut remarks = Vec::new();
    if let Some(reason) = no_plant {
        let check = match reason.exceeded_by {
            ExceededBy::Alpha { .. } => "$`f`$, $`f_xx`$, their domain, $`alpha`$, and the unit of time in each",
            ExceededBy::Rate { .. } => "$`f`$, $`f_xx`$, their domain, rate, and the unit of time in each",
            ExceededBy::Jacobian { .. } => "$`f`$, $`f_xx`$, their domain, the Jacobian, and the unit of time in each",
        };
        remarks.push(format!("Remark: {reason}. So the claim is about no plant. Check {check}."));
    }
    if force_at_origin {
        remarks.push(
            "Remark: $`f(0,0) > 0`$, although $`|f(t,0,0)| = 0`$ for every plant of the family. Perhaps the bounds were taken before the \
             shift by $`x_0(t)`$, the periodic solution of $`x' = f(t,x,0)`$. They have to hold after it (erratum E18; the guide)."
                .to_owned(),
        );
    }
    remarks
}

#[cfg(test)]
mod tests {
    use super::*;
    use sigmastar_lang::spec::Bound;

    fn entry(bound: Bound, value: i32, sampled: Option<i32>) -> ProvedValue {
        let [value, x, e] = [value, 1, 1].map(Rational::from);
        ProvedValue { bound, x, e, value, sampled: sampled.map(Rational::from) }
    }

    #[test]
    fn the_bound_that_is_farthest_above_its_samples_is_told() {
        let near = [entry(Bound::Qx, 200, Some(100)), entry(Bound::Rate, 9, Some(1)), entry(Bound::Fe, 7, None)];
        assert_eq!(far_above_its_samples(&near), None);
        let far = [entry(Bound::Qe, 201, Some(100)), entry(Bound::Qx, 1000, Some(10)), entry(Bound::Fe, 7, Some(0))];
        let told = far_above_its_samples(&[near.as_slice(), &far].concat()).unwrap();
        assert!(told.contains("$`q_x`$ (") && told.contains("at most 1000, and samples reach 10."), "{told}");
    }
}
