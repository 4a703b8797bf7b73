//! What larger gains bring (derivation, 13.5): bounds at multiples of the gain of a claim.

use super::certification::Certification;
use super::gain_row::{GainRow, RowProof, shown};
use super::outcome::is_better;
use super::pool::{Member, Wanted};
use super::sampled::{SampledCertification, certify_sampled};
use rug::Rational;
use sigmastar_decide::conditions::Ladder;
use sigmastar_decide::conditions::prove_up_to;
use sigmastar_decide::conditions::{SampledProof, SharpProof};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, round_rational};
use sigmastar_exact::parallel;
use sigmastar_lang::spec::Specification;
use sigmastar_propose::search::SampledProposal;
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::consequences::error_bounds;
use sigmastar_theory::derivation::mistuned::Mistuning;
use std::sync::Arc;

/// The gains of the rows beside that of a claim, in tenths of [`unit_of_gains`].
pub const ROWS: [u32; 5] = [12, 15, 20, 30, 50];

/// A smallest gain below this share of 1/T is not of the size at which a loop converges in any time that counts.
const TINY: f64 = 1e-2;

/// Digits of these gains.
const DIGITS: u32 = 4;

/// What larger gains are multiples of: the smallest one, in 1/time, or about 1/T where it is far below that, as of a plant whose error decays by itself.
#[must_use]
pub fn unit_of_gains(smallest: &Rational, period: &Enclosure) -> Rational {
    let unit = (Enclosure::one(period.precision()) / period).upper_rational();
    let tiny = smallest.to_f64() * period.midpoint_f64() < TINY;
    let unit = unit.filter(|_| tiny).map(|unit| round_rational(&unit, DIGITS, Direction::Up));
    unit.unwrap_or_else(|| smallest.clone())
}

/// So many tenths of a gain.
fn larger(tenths: u32, sigma: &Rational) -> Rational {
    round_rational(&(Rational::from((tenths, 10)) * sigma), DIGITS, Direction::Up)
}

/// The row of a proof, with the steady errors of these numbers of oscillators.
fn row_of(spec: &Specification, proof: SharpProof, other: Option<Arc<Specification>>, counts: &[u32]) -> GainRow {
    let data = Data::new(spec, proof.precision);
    let (evaluation, mistuning) = (&proof.evaluation, Mistuning::new(&data));
    let sigma = data.rational(&proof.witness.sigma);
    let e_per = &evaluation.periodic.e_per;
    let sup =
        |n_o: u32| error_bounds(&data, &evaluation.excitation, mistuning.as_ref(), &sigma, e_per, u64::from(n_o)).sup;
    GainRow {
        sigma: proof.witness.sigma.clone(),
        e0: proof.witness.set.e0.clone(),
        steady: sup(0),
        steady_with: counts.iter().map(|n_o| (*n_o, sup(*n_o))).collect(),
        peak: evaluation.peak.clone(),
        control: evaluation.control.clone(),
        rates: Vec::new(),
        proof: RowProof::Continuous(Box::new(proof), other),
    }
}

/// The rows of larger gains than that of a claim: the best that the members of a pool have there; where that gain is given the
/// pool may have data of its own for it. One at which nothing is proved has none.
fn larger_rows(own: &Specification, proof: &SharpProof, pool: &[Member<'_>], counts: &[u32]) -> Vec<GainRow> {
    let reach = proof.decided().reach();
    let unit = unit_of_gains(&proof.witness.sigma, &own.period.nominal().enclose(proof.precision));
    let row = |tenths: &u32| {
        let sigma = larger(*tenths, &unit);
        let (spec, proof) = best_at(pool, &sigma)?;
        // The data of a plant are proved where they are used, those of a specification on a domain, or up to the arguments of the claim.
        let [x, e] = proof.decided().reach()?;
        let within = reach.as_ref().is_some_and(|[known_x, known_e]| x <= *known_x && e <= *known_e);
        let known = spec.domain.is_some() || spec.plant().is_some() || within || prove_up_to(spec, &x, &e).is_ok();
        let other = (!std::ptr::eq(spec, own)).then(|| Arc::new(spec.clone()));
        known.then(|| row_of(spec, proof, other, counts))
    };
    parallel::map(&ROWS, row).into_iter().flatten().collect()
}

/// The proof at a gain with the smallest bound of |e|, of the data of a pool.
fn best_at<'s>(pool: &[Member<'s>], sigma: &Rational) -> Option<(&'s Specification, SharpProof)> {
    let at = |member: &Member<'s>| {
        let proof = member.best(Wanted { gain: Some(sigma), ..Wanted::default() }).outcome;
        proof.proved().map(|proof| (member.spec, proof.clone()))
    };
    pool.iter().filter_map(at).reduce(|a, b| if is_better(&b.1, &a.1) { b } else { a })
}

impl Member<'_> {
    /// Whether at the smallest gain the bound of |e| on the way is far above what |e| is at the start; `None` where no gain is proved.
    #[must_use]
    pub fn goes_far(&self) -> Option<bool> {
        self.smallest().map(|proof| row_of(self.spec, proof.clone(), None, &[]).goes_far())
    }
}

impl Certification<'_> {
    /// The rows of a run that is certified without an actuator; of one with an actuator nothing is said of another gain. Hypothesis: the data of the
    /// pool are of the same subject; in the same coordinates, where the set is stated in them. `counts`: the numbers of oscillators that are asked about.
    pub fn set_gains(&mut self, pool: &[Member<'_>], counts: &[u32]) {
        let Some(proof) = self.sharp.proved().filter(|_| self.claim().is_some() && self.spec.actuator.is_none()) else {
            return;
        };
        let mut rows = vec![row_of(self.spec, proof.clone(), None, shown(counts))];
        rows.extend(larger_rows(self.spec, proof, pool, shown(counts)));
        self.gains = rows;
    }
}

impl SampledCertification<'_> {
    /// The rows at the gain of the claim and at larger ones, at the same samples: what a call with that gain certifies. Without a claim, and with an
    /// actuator, there are none.
    pub(crate) fn set_gains(&mut self, start: Option<&SampledProposal>, ladder: Ladder) {
        let Some(proof) = self.claim().filter(|_| self.spec.actuator.is_none()) else { return };
        let row = |proof: &SampledProof| GainRow {
            sigma: proof.witness.sigma.clone(),
            e0: proof.witness.set.e0.clone(),
            steady: proof.evaluation.size.e_per.clone(),
            steady_with: Vec::new(),
            peak: proof.evaluation.peak.clone(),
            control: proof.evaluation.control.clone(),
            rates: Vec::new(),
            proof: RowProof::Sampled(Box::new(proof.clone())),
        };
        let unit = unit_of_gains(&proof.witness.sigma, &self.spec.period.nominal().enclose(proof.precision));
        let at = |tenths: &u32| {
            let sigma = larger(*tenths, &unit);
            let run = certify_sampled(self.spec, &self.sampling, Some(&sigma), start, ladder).ok()?;
            run.claim().map(row)
        };
        let more: Vec<GainRow> = parallel::map(&ROWS, at).into_iter().flatten().collect();
        self.gains = std::iter::once(row(proof)).chain(more).collect();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn larger_gains_are_multiples_of_the_smallest_or_of_the_period() {
        let rational = |(p, q): (u32, u32)| Rational::from((p, q));
        let unit = |smallest, period| unit_of_gains(&rational(smallest), &Enclosure::exactly(period));
        assert_eq!(unit((3, 2), 1.0), rational((3, 2)));
        // What is above a hundredth of 1/T is large enough, what is below it is not.
        assert_eq!(unit((21, 1000), 0.5), rational((21, 1000)));
        assert_eq!(unit((19, 1000), 0.5), rational((2, 1)));
        // 1/3 in four digits, rounded up.
        assert_eq!(unit((1, 10_000_000), 3.0), rational((3334, 10_000)));
        assert_eq!(larger(15, &unit((1, 10_000_000), 3.0)), rational((5001, 10_000)));
    }
}
