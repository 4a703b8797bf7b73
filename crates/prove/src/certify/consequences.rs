//! What follows from a run beyond its claim: the error for given numbers of oscillators, the arguments that were used, the
//! error box, the regulated output behind a filter.

use super::certification::{Certification, RelativeDegreeGains};
use super::sampled::SampledCertification;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_theory::data::{Bound, Data, Problem};
use sigmastar_theory::derivation::consequences::{ErrorBounds, Excitation, error_bounds};
use sigmastar_theory::derivation::control::Control;
use sigmastar_theory::derivation::mistuned::Mistuning;
use sigmastar_theory::derivation::targets::{Consequences, SampledConsequences, Target};

impl Certification<'_> {
    /// Certified bounds of the periodic error, with answers to the targets, of these bounds and of those by the number of oscillators
    /// ([`Certification::set_counts`]); `None` without a certified claim.
    ///
    /// Guarantee: the bounds hold for every sigma' >= sigma* and the stated n_o, along the periodic solution; answers say where they are about sigma*
    /// alone.
    #[must_use]
    pub fn consequences(&self, targets: &[Target]) -> Option<Consequences> {
        let claim = self.claim()?;
        let data = Data::new(self.spec, claim.precision);
        let [_, e_per, _] = claim.periodic;
        let mut all = Consequences::new(&data, self.excitation()?, &data.rational(claim.sigma), e_per, targets);
        for (target, outcome) in &mut all.targets {
            let own = self.by_count.as_ref().and_then(|found| found.reaching(target));
            *outcome = outcome.or_at_gain(own, self.spec.actuator.is_some());
        }
        Some(all)
    }

    /// Certified bounds of the periodic error with so many oscillators; `None` without a certified claim.
    ///
    /// Guarantee: as for [`Certification::consequences`].
    #[must_use]
    pub fn error_with(&self, n_o: u64) -> Option<ErrorBounds> {
        let claim = self.claim()?;
        let data = Data::new(self.spec, claim.precision);
        let [_, e_per, _] = claim.periodic;
        let mistuning = Mistuning::new(&data);
        let (excitation, sigma) = (self.excitation()?, data.rational(claim.sigma));
        Some(error_bounds(&data, excitation, mistuning.as_ref(), &sigma, e_per, n_o))
    }

    fn excitation(&self) -> Option<&Excitation> {
        self.sharp.proved().map(|proof| &proof.evaluation.excitation)
    }

    /// An upper bound of sigma* + mu Nbar^2, if certified: u = -(sigma + mu (n_0 + ... + n_{n_o})) e + mu M'N z, so this is
    /// what the law multiplies e by at sigma*, at most, for every n_o.
    #[must_use]
    pub fn feedback(&self) -> Option<Enclosure> {
        let claim = self.claim()?;
        let data = Data::new(self.spec, claim.precision);
        Some((data.rational(claim.sigma) + &data.mu * &data.n_bar_squared).ceiling())
    }

    /// Bounds of the control at sigma, if certified; of a larger gain they say nothing.
    #[must_use]
    pub fn control(&self) -> Option<&Control<Enclosure>> {
        self.claim()?;
        self.sharp.proved().map(|proof| &proof.evaluation.control)
    }

    /// Radii of the error box of the claim in x and e, if certified.
    #[must_use]
    pub fn error_box(&self) -> Option<[Enclosure; 2]> {
        self.claim().map(|claim| claim.error_box)
    }

    /// The largest X and E at which the claim for every n_o uses a bounding function; upper bounds.
    #[must_use]
    pub fn largest_arguments(&self) -> Option<[Enclosure; 2]> {
        self.attempt().map(|attempt| attempt.arguments)
    }

    /// The largest X and E at which exact regulation uses a bounding function; it does so for an error box of its own.
    #[must_use]
    pub fn exact_arguments(&self) -> Option<[Enclosure; 2]> {
        let claim = self.exact.as_ref()?;
        Some([&claim.witness.d_x, &claim.witness.d_e].map(|radius| Enclosure::from_rational(radius, self.precision)))
    }

    /// Upper bounds of sup|xi_1| and rms(xi_1) along the periodic solution, for every n_o: k_inf and sqrt(k_2) times the
    /// certified bound of sup|e|, which also bounds rms(e). `None` without a certified claim.
    #[must_use]
    pub fn regulated_output(&self, gains: &RelativeDegreeGains) -> Option<[Enclosure; 2]> {
        let [_, e, _, _] = self.periodic_solution()?;
        Some([&gains.k_inf * &e, gains.k_2.sqrt() * e])
    }

    /// Whether f(0,0) > 0 is proved of the bounding function, although |f(t,0,0)| = 0 for every plant of the family.
    #[must_use]
    pub fn has_force_at_origin(&self) -> bool {
        let data = Data::new(self.spec, self.precision);
        data.bound(Bound::F, &data.zero(), &data.zero()).is_positive().is_true()
    }
}

impl SampledCertification<'_> {
    /// Certified bounds of the periodic error by the number of oscillators, with answers to the targets, of these bounds and of those of
    /// [`SampledCertification::set_counts`]; `None` without a certified claim.
    ///
    /// Guarantee: they hold for exactly the gain and the sampling period of the claim, along the periodic solution, between samples too.
    #[must_use]
    pub fn consequences(&self, targets: &[Target]) -> Option<SampledConsequences> {
        let proof = self.claim()?;
        let bounds = proof.evaluation.errors(&Data::new(self.spec, proof.precision), &proof.witness);
        let mut all = SampledConsequences::new(&bounds, proof.precision, targets);
        for (target, outcome) in &mut all.targets {
            // All of them are about the gain of the claim alone.
            let own = self.by_count.as_ref().and_then(|found| found.reaching(target));
            *outcome = outcome.or_at_gain(own, true);
        }
        Some(all)
    }
}
