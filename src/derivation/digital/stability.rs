//! (C5h): the quadratic forms of the decay from sample to sample (derivation, 12.3).

use super::law::SampledLaw;
use crate::data::{Numbers, Problem};
use crate::derivation::stability::ErrorBox;
use crate::real::{Operand, Real};

/// `xx X^2 + ee E^2 + yy Y^2 - xe XE - xy XY - ey EY`; the last three are nonnegative.
#[derive(Clone, Debug)]
pub struct Form<R> {
    /// Of X^2.
    pub xx: R,
    /// Of E^2.
    pub ee: R,
    /// Of Y^2.
    pub yy: R,
    /// Of -XE.
    pub xe: R,
    /// Of -XY.
    pub xy: R,
    /// Of -EY.
    pub ey: R,
}

impl<R: Real> Form<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// The leading principal minors of its matrix: all positive if and only if the form is positive definite.
    #[must_use]
    pub fn minors(&self) -> [R; 3] {
        let two = R::int(2);
        let [p, q, r] = [&self.ey / &two, &self.xe / &two, &self.xy / &two];
        let second = &self.xx * &self.ee - q.sqr();
        let third = &second * &self.yy - &self.xx * p.sqr() - &self.ee * r.sqr() - two * (&p * &q * &r);
        [self.xx.clone(), second, third]
    }
}

/// What of the sampling is taken into account: everything, but for a report that asks what limits a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// theta: what K h Nbar^2 takes from the damping of the oscillators.
    Theta,
    /// h sigma, and the hold of e over a sample.
    Hold,
    /// What moves within a sample: h k_x, h k_e, and x with it.
    Motion,
}

/// Q_0 and Q_h: the decay over [kh, kh + t] is at least t times the form between them.
#[derive(Clone, Debug)]
pub struct DecayForms<R> {
    /// kp = 1 - h k_e/pi, to be positive.
    pub within: R,
    /// Q_0.
    pub start: Form<R>,
    /// Q_h.
    pub end: Form<R>,
}

/// The numbers of the forms at one sigma.
pub struct DecayNumbers<'n, R> {
    /// The law.
    pub law: &'n SampledLaw<R>,
    /// sigma.
    pub sigma: &'n R,
    /// w_x.
    pub w_x: &'n R,
    /// eta, the weight of zeta.
    pub eta: &'n R,
}

impl<R: Real> DecayForms<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// Evaluates the forms on an error box.
    ///
    /// Guarantee: where `within` and the minors of both are positive, U falls from sample to sample in the box, and at no time
    /// between samples exceeds what it was at the last one; for every n_o < N_s/2.
    #[must_use]
    pub fn new(problem: &impl Problem<R>, error_box: &ErrorBox<R>, numbers: &DecayNumbers<'_, R>) -> DecayForms<R> {
        DecayForms::without(problem, error_box, numbers, None)
    }

    /// The same as if one part of what the sampling does were not there: for a report, never for a claim.
    #[must_use]
    pub fn without(
        problem: &impl Problem<R>,
        error_box: &ErrorBox<R>,
        numbers: &DecayNumbers<'_, R>,
        part: Option<Part>,
    ) -> DecayForms<R> {
        let DecayNumbers { law, sigma, w_x, eta } = *numbers;
        let Numbers { p_up, .. } = problem.numbers();
        let ErrorBox { k_x, k_f, rate, sector, .. } = error_box;
        let (one, two) = (R::int(1), R::int(2));
        let k_e = sector.below.max(&sector.above);
        let within = &one - &law.step * &k_e / &law.pi;
        // eta/K.
        let weight = eta / &law.gain;
        let coupling = &two * w_x * p_up.sqrt() * k_f;
        let form = |share: R| {
            let t = |of: Part| if part == Some(of) { &law.step * R::int(0) } else { &law.step * &share };
            let (hold, motion) = (t(Part::Hold), t(Part::Motion));
            let theta = if part == Some(Part::Theta) { R::int(0) } else { &share * law.lost() };
            let ts = &hold * sigma;
            let within_t = &motion * &k_e / &within;
            let g = (within_t.sqr() / R::int(12)).sqrt();
            let c_x = &motion * k_x / (&law.pi * &within);
            let c_e = (&one - &ts + ts.sqr() / R::int(3)).sqrt() + &within_t / &law.pi;
            let c_y = (motion.sqr() / R::int(3)).sqrt() / &within;
            // |1 - ts + (eta/K)(1 - ts/2) delta| at the ends of the sector.
            let mean = &weight * (&one - &ts / &two);
            let at = |slope: R| {
                let value = &one - &ts + &mean * slope;
                value.max(&-value.clone())
            };
            let worst = at(sector.above.clone()).max(&at(-sector.below.clone()));
            Form {
                xx: &two * w_x * rate - &coupling * c_x,
                xe: &coupling * c_e,
                xy: &coupling * c_y + &two * &weight * k_x * (&one + &g),
                ee: sigma * (&two - &ts),
                ey: &two * worst + &two * &weight * &g * &k_e,
                yy: &two * &weight * (&one - theta)
                    - &hold
                    - &weight * &hold * &sector.above
                    - &weight * within_t.sqr() * &within / R::int(3),
            }
        };
        DecayForms { start: form(R::int(0)), end: form(R::int(1)), within }
    }
}
