//! The gains of `SampledGains` for a given number of oscillators: harmonics up to it have no y (derivation, 12.1).

use super::{SampledGains, Worst, of_harmonic};
use crate::derivation::sampled::law::SampledLaw;
use sigmastar_exact::real::{Operand, Real};

impl<R: Real> SampledGains<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// What `of` makes of the gains for e with n_o oscillators, for each n_o < N_s/2, from 0 on.
    ///
    /// The sums are over `n_o < j < N_s - n_o`, and what bounds the mean square of the e_k is the largest `|e_j|/|qb_j|` of these, over om_j where
    /// it is by q'; none is larger than for every n_o. What is of e' and zeta, and of e between samples, is as it was. Hypotheses: those of
    /// [`SampledGains::new`], which made these of the same law and sigma.
    #[must_use]
    pub fn by_count<T>(&self, law: &SampledLaw<R>, sigma: &R, of: impl Fn(&SampledGains<R>) -> T) -> Vec<T> {
        let largest = law.of_y().sqr();
        let nothing = &largest * R::int(0);
        let of_delay = law.of_delay(sigma);
        let decay = R::int(1) - &law.step * sigma;
        let mut worst = law.input_gain.as_ref().map(Worst::new);
        let [mut sup, mut sup_by_rate, mut sup_of_means, mut rms, mut rms_by_rate] =
            std::array::from_fn(|_| nothing.clone());
        let mut own = self.clone();
        let mut all = Vec::new();
        let mut with = |[sup, sup_by_rate, sup_of_means, rms, rms_by_rate]: [&R; 5]| {
            own.sup = self.sup.min_known(&(&of_delay * sup.sqrt()));
            own.sup_by_rate = self.sup_by_rate.min_known(&(&of_delay * sup_by_rate.sqrt()));
            own.sup_of_means = self.sup_of_means.min_known(&sup_of_means.sqrt());
            own.rms = self.rms.min_known(&(&of_delay * rms.sqrt()));
            own.rms_by_rate = self.rms_by_rate.min_known(&(&of_delay * rms_by_rate.sqrt()));
            all.push(of(&own));
        };
        if law.samples % 2 == 1 {
            // With as many oscillators as that no harmonic at samples is left.
            with([&sup, &sup_by_rate, &sup_of_means, &rms, &rms_by_rate]);
        }
        let harmonics: Vec<(u32, &R)> = (1..).zip(law.sines.iter()).collect();
        for (j, sine) in harmonics.into_iter().rev() {
            let squared = law.frequency_squared(sine);
            let size = sigma.sqr() + &decay * &squared;
            let gain = of_harmonic(law, &mut worst, sigma, [sine, &size, &largest]);
            let times = R::int(if 2 * j == law.samples { 1 } else { 2 });
            let single = &gain / &size;
            sup_of_means = sup_of_means + &times / &size;
            rms = rms.max(&single);
            rms_by_rate = rms_by_rate.max(&(&single / &squared));
            sup_by_rate = sup_by_rate + &times * &single / &squared;
            sup = sup + times * single;
            with([&sup, &sup_by_rate, &sup_of_means, &rms, &rms_by_rate]);
        }
        all.reverse();
        all
    }
}
