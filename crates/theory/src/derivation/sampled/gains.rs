//! What the law at samples makes of a periodic q, for every n_o < N_s/2 (derivation, 12.1).

use super::law::SampledLaw;
use crate::data::Problem;
use crate::derivation::energy::EnergyBounds;
use crate::derivation::harmonics::AtOrigin;
use crate::derivation::mean_squares::{Forcing, Gains, Response};
use crate::input_gain::InputGain;
use sigmastar_exact::real::{Operand, Real};

/// The gains at one sigma, between bounds R_q of rms(q), R_1 of rms(q') and those of e.
#[derive(Clone, Debug)]
pub struct SampledGains<R> {
    /// bt_S: sup|e_k| <= bt_S rms(q).
    pub sup: R,
    /// tau_S: sup|e_k| <= tau_S rms(q').
    pub sup_by_rate: R,
    /// 1/sg_S: the rms of the e_k over rms(q), and that of (e_{k+1} - e_k)/h over rms(q').
    pub rms: R,
    /// 1/(om_1 sg_S): the rms of the e_k over rms(q').
    pub rms_by_rate: R,
    /// 2 (1 + theta)/(2 - h sigma): rms(e') over rms(q).
    pub rate: R,
    /// 1 + theta: the mean square of the y_k over rms(q); with a delay times 1 + h sigma.
    pub means: R,
    /// 1 + theta, also with a delay: the bound of the harmonics of y, and of the mean square of the y_k, over those of q.
    pub of_y: R,
    /// sqrt(1/sg_S^2 + (h/pi)^2): rms(e') over rms(q').
    pub rate_by_rate: R,
    /// (h/(2 pi)) sqrt(h T): what e is off its straight lines between samples, over rms(q').
    pub between: R,
    /// (h/pi)^2: the same in the mean.
    pub between_rms: R,
    /// bt_h: sup|e_k| over the mean square of the y_k.
    pub sup_of_means: R,
    /// 2/(2 - h sigma): the mean square of (e_{k+1} - e_k)/h over that of the y_k.
    pub rate_of_means: R,
    /// sqrt(h T)/2: what e is off its straight lines between samples, over rms(q).
    pub between_by_size: R,
    /// What a matrix inequality says of the periodic solution, where there is one (derivation, 13.7, (E) at samples); of y at samples.
    energy: Option<EnergyBounds<R>>,
    /// How far the worst harmonic is from being without one, of an input gain: the least `1/(1+theta) - (1-b) sigma Re D_j/|D_j|^2`, to be
    /// positive.
    pub room: Option<R>,
    /// mu of the law, and what multiplies Z: 1 + theta, with an input gain times `1 + dl max sigma |e_j|/|qb_j|`.
    mu: R,
    enlarged: R,
    /// sqrt(N_s) and sqrt((T^2 - h^2)/12): sup|y_k| over its mean square, and over rms(q') where each |y_j| is at most |qb_j|.
    sup_of_y: [R; 2],
    /// With a delay, what takes the place of T/(2 mu) (1+theta)^2 in Z^2, over T.
    swing: Option<R>,
}

impl<R: Real> SampledGains<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// Evaluates the gains. Hypotheses: K h Nb2 < 2, h sigma <= 1.
    ///
    /// With Sb_j = min{1 + theta, 1/|cos(pi j/N_s)|} the harmonics of y are at most Sb_j times those of the means of q, and 0
    /// for j <= n_o; the sums are over j = 1, ..., N_s - 1, of which j and N_s - j are alike. With an input gain F_j of 13.1
    /// bounds each of them. With a delay 1 + th1 stands for Sb_j (S3 is not available, nor where the law is for every set of harmonics), and e has 1 + h sigma more; hypothesis then:
    /// 3 K h Nb2 < 2.
    #[must_use]
    pub fn new(law: &SampledLaw<R>, sigma: &R, period: &R) -> SampledGains<R> {
        let one = R::int(1);
        let product = &law.step * sigma;
        let decay = &one - &product;
        let share = |sine: &R| sigma.sqr() + &decay * law.frequency_squared(sine);
        let largest = law.of_y().sqr();
        let of_delay = law.of_delay(sigma);
        let mut worst = law.input_gain.as_ref().map(Worst::new);
        let nothing = &largest * R::int(0);
        let (mut sup, mut sup_by_rate, mut sup_of_means) = (nothing.clone(), nothing.clone(), nothing);
        for (j, sine) in (1_u32..).zip(law.sines.iter()) {
            let size = share(sine);
            let gain = of_harmonic(law, &mut worst, sigma, [sine, &size, &largest]);
            let times = if 2 * j == law.samples { one.clone() } else { R::int(2) };
            let own = times / size;
            let term = gain * &own;
            sup_of_means = sup_of_means + own;
            sup_by_rate = sup_by_rate + &term / law.frequency_squared(sine);
            sup = sup + term;
        }
        let first = law.first_frequency_squared();
        let rate_of_means = R::int(2) / (R::int(2) - product);
        let (rms, rate, of_y, shifted) = match &worst {
            None => {
                let rms = &one / slowest(law, sigma, &decay);
                (rms, &rate_of_means * law.of_y(), law.of_y(), one.clone())
            }
            Some(Worst { gain, error, rate, means, .. }) => {
                let [rms, rate, means] = [error, rate, means].map(R::sqrt);
                // What drives zeta beside q is (1-b) sigma e, with a delay (1-b) sigma et, |et_j| = |y_j/D_j|.
                let shifted = &one + gain.largest_shift() * sigma * &rms;
                (rms, rate, means, shifted)
            }
        };
        let enlarged = law.of_y() * &shifted;
        let swing = law.delayed.then(|| swing_with_delay(law, [&of_y, &shifted]));
        let delayed = |value: R| if law.delayed { &of_delay * value } else { value };
        let [sup, sup_by_rate, rms, rate, means] =
            [sup.sqrt(), sup_by_rate.sqrt(), rms, rate, of_y.clone()].map(delayed);
        let in_between = &law.step / &law.pi;
        SampledGains {
            sup,
            sup_of_means: sup_of_means.sqrt(),
            rate_of_means,
            between_by_size: (&law.step * period).sqrt() / R::int(2),
            energy: None,
            sup_by_rate,
            rms_by_rate: &rms / first.sqrt(),
            rate,
            means,
            of_y,
            rate_by_rate: (rms.sqr() + in_between.sqr()).sqrt(),
            rms,
            between: &in_between / R::int(2) * (&law.step * period).sqrt(),
            between_rms: in_between.sqr(),
            room: worst.map(|worst| worst.room),
            mu: law.mu.clone(),
            enlarged,
            sup_of_y: [R::int(i64::from(law.samples)).sqrt(), ((period.sqr() - law.step.sqr()) / R::int(12)).sqrt()],
            swing,
        }
    }

    /// sup|et_k|, the largest prediction along the periodic solution, from bounds of q and q': |et_j| = |y_j|/|D_j|, so that it has 1 + h sigma
    /// less than e.
    #[must_use]
    pub fn largest_prediction(&self, law: &SampledLaw<R>, sigma: &R, forcing: &Forcing<R>) -> R {
        let Forcing { q_rms, q_rate_rms, .. } = forcing;
        (&self.sup * q_rms).min_known(&(&self.sup_by_rate * q_rate_rms)) / law.of_delay(sigma)
    }

    /// These gains with the bounds of a matrix inequality, which are taken where they are smaller. What bounds a solution with q(t,0,0)
    /// times a number in [0, 1] then is only strictly below what it shows.
    #[must_use]
    pub fn with_energy(self, energy: Option<EnergyBounds<R>>) -> SampledGains<R> {
        SampledGains { energy, ..self }
    }

    /// Whether there are such bounds.
    #[must_use]
    pub fn has_energy(&self) -> bool {
        self.energy.is_some()
    }
}

/// The bound of |y_j|^2 over |qb_j|^2, of a harmonic by its sine and |D_j|^2, from that of all of them; with an input gain it is
/// taken into account for the worst ones.
fn of_harmonic<R: Real>(
    law: &SampledLaw<R>,
    worst: &mut Option<Worst<'_, R>>,
    sigma: &R,
    [sine, size, largest]: [&R; 3],
) -> R
where
    for<'a> &'a R: Operand<R>,
{
    if let Some(worst) = worst {
        return worst.take(law, sigma, [sine, size]);
    }
    let cosine = R::int(1) - sine;
    match law.is_sharp() && cosine.is_certainly_positive() {
        true => largest.min(&(R::int(1) / cosine)),
        false => largest.clone(),
    }
}

/// What a period adds to the mean of |zeta_k|_N^2 at most, over `T R_q^2`: `1/(2 K cq) + h Nb2 (1+th1)^2`. With an input gain `b K` for K,
/// at the worse end of b, times the square of what q + (1-b) sigma et is over q, and the bound of |y|_s for 1 + th1.
fn swing_with_delay<R: Real>(law: &SampledLaw<R>, [of_y, shifted]: [&R; 2]) -> R
where
    for<'a> &'a R: Operand<R>,
{
    let of = |b: &R| {
        let gain = &law.gain * b;
        R::int(1) / (R::int(2) * &gain * (R::int(1) - &gain * &law.step * &law.weight_sum))
    };
    let raised = match &law.input_gain {
        None => of(&R::int(1)),
        // b - b^2 K h Nb2 is concave in b.
        Some(InputGain { low, high }) => of(low).max(&of(high)),
    };
    raised * shifted.sqr() + &law.step * &law.weight_sum * of_y.sqr()
}

/// The worst harmonics with an input gain (derivation, 13.1): with `D_j = (e^{i om h} - a)/h`
///
/// `|e_j| <= F_j |qb_j|`, `F_j = |D_j| / min_b ( |D_j|^2/(1+theta) - (1-b) sigma Re D_j )`, y_j = D_j e_j,
///
/// over b in {b_lo, b_hi}, with theta that of b_hi. With a delay `|y_j| <= |qb_j|/(1/(1+th1) - dl sigma/|D_j|)`, dl the largest |1 - b|, and
/// F_j is that over |D_j| (13.1).
/// For `e_j = qb_j/(D_j (1 + b K h G) - (1-b) sigma)`, where `1 + b K h G = 1 - be + i eta` with a
/// real eta and `1 - be >= 1/(1+theta)`: that is on a line, the distance of which from 0 is the minimum over `|D_j|`.
struct Worst<'g, R> {
    gain: &'g InputGain<R>,
    /// The largest F_j^2.
    error: R,
    /// The largest om_j^2 F_j^2, which is at least 1: at the largest j it is that at b = 1, and om_j^2 >= 3/h^2 there.
    rate: R,
    /// The largest |D_j|^2 F_j^2.
    means: R,
    /// The least `1/(1+theta) - (1-b) sigma Re D_j/|D_j|^2`.
    room: R,
}

impl<'g, R: Real> Worst<'g, R>
where
    for<'a> &'a R: Operand<R>,
{
    fn new(gain: &'g InputGain<R>) -> Worst<'g, R> {
        let none = || R::int(0);
        Worst { gain, error: none(), rate: none(), means: none(), room: R::int(1) }
    }

    /// Takes a harmonic into account, by its sine and |D_j|^2: |y_j|^2 is at most so many times |qb_j|^2; unknown where a
    /// denominator may vanish.
    fn take(&mut self, law: &SampledLaw<R>, sigma: &R, [sine, size]: [&R; 2]) -> R {
        let one = R::int(1);
        let squared = law.frequency_squared(sine);
        // sigma Re D_j = sigma (sigma - h om_j^2/2), over |D_j|^2.
        let along = sigma * (sigma - &law.step * &squared / R::int(2)) / size;
        let InputGain { low, high } = self.gain;
        let moved = (&along * (&one - low)).max(&(along * (&one - high)));
        // With a delay the circle of radius sigma/|D_j| about 0 that (1-b) sigma E^-1/D_j lies on counts in every direction.
        let room = match law.delayed {
            false => &one - law.lost() - moved,
            true => &one - law.lost() * R::int(3) - self.gain.largest_shift() * sigma / size.sqrt(),
        };
        let of_y = if room.is_certainly_positive() { &one / room.sqr() } else { R::unknown() };
        let own = &of_y / size;
        self.room = self.room.min(&room);
        self.rate = self.rate.max(&(squared * &own));
        self.error = self.error.max(&own);
        self.means = self.means.max(&of_y);
        of_y
    }
}

/// sg_S = max{ sg_h/(1+theta), min{ cos(pi/N_s) sg_h, sqrt(sigma^2 + 4 a s*/h^2)/(1+theta) } }, s* = 1 - (1+theta)^-2: at most
/// every sqrt(sigma^2 + a om_j^2)/Sb_j.
fn slowest<R: Real>(law: &SampledLaw<R>, sigma: &R, decay: &R) -> R
where
    for<'a> &'a R: Operand<R>,
{
    let one = R::int(1);
    let first = sigma.sqr() + decay * law.first_frequency_squared();
    let squared = law.of_y().sqr();
    let plain = &first / &squared;
    if !law.is_sharp() {
        return plain.sqrt();
    }
    let turn = &one - &one / &squared;
    let cosine = law.sines.first().map_or_else(R::unknown, |sine| &one - sine);
    let at_turn = (sigma.sqr() + decay * law.frequency_squared(&turn)) / &squared;
    plain.max(&(cosine * &first).min(&at_turn)).sqrt()
}

impl<R: Real> Gains<R> for SampledGains<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// `min{bt_S R_q, tau_S R_1} + (h/(2 pi)) sqrt(h T) R_1`, `min{R_q, R_1/om_1}/sg_S + (h/pi)^2 R_1`,
    /// `min{2 (1+theta)/(2 - h sigma) R_q, sqrt(1/sg_S^2 + (h/pi)^2) R_1}`; and of a matrix inequality
    /// `bt_h r_y + (sqrt(h T)/2) R_q`, its bound of rms(e), `sqrt((2 r_y/(2 - h sigma))^2 + R_q^2)`.
    fn response(&self, _: &AtOrigin<R>, forcing: &Forcing<R>) -> Response<R> {
        let Forcing { q_rms, q_rate_rms, .. } = forcing;
        let least = |by_size: &R, by_rate: &R| (by_size * q_rms).min_known(&(by_rate * q_rate_rms));
        let mut response = Response {
            sup: least(&self.sup, &self.sup_by_rate) + &self.between * q_rate_rms,
            rms: least(&self.rms, &self.rms_by_rate) + &self.between_rms * q_rate_rms,
            rate_rms: least(&self.rate, &self.rate_by_rate),
        };
        if let Some(EnergyBounds { y, e, .. }) = &self.energy {
            let rate = ((&self.rate_of_means * y).sqr() + q_rms.sqr()).sqrt();
            response.sup = response.sup.min_known(&(&self.sup_of_means * y + &self.between_by_size * q_rms));
            response.rms = response.rms.min_known(e);
            response.rate_rms = response.rate_rms.min_known(&rate);
        }
        response
    }

    fn rms_of_states(&self) -> R {
        self.energy.as_ref().map_or_else(R::unknown, |energy| energy.x.clone())
    }

    /// `Y min{ sqrt(N_s) R_q, sqrt((T^2 - h^2)/12) R_1 }`, Y the bound of the harmonics of y over those of q, 1 + th1 with a delay (13.4): y has no
    /// mean.
    fn largest_mean(&self, forcing: &Forcing<R>) -> R {
        let [by_size, by_rate] = &self.sup_of_y;
        &self.of_y * (by_size * &forcing.q_rms).min_known(&(by_rate * &forcing.q_rate_rms))
    }

    /// `Z^2 = (1+theta)^2 [ (T/(2 mu) + k0/w^2) R_q^2 + (k1/w^4) R_1^2 ]` (12.2), a bound of sup_k |zeta_k|_N^2. With a delay
    /// `Z^2 = T R_q^2 [ 1/(2 K cq) + h Nb2 (1+th1)^2 ] + (1+th1)^2 [ (k0/w^2) R_q^2 + (k1/w^4) R_1^2 ]`, cq = 1 - K h Nb2 (13.4).
    fn z_squared(&self, problem: &impl Problem<R>, forcing: &Forcing<R>, [k0, k1]: [&R; 2]) -> R {
        let [kappa_0, kappa_1] = problem.numbers().kappas(k0, k1);
        if let Some(swing) = &self.swing {
            let own = self.enlarged.sqr();
            let of_size = &problem.numbers().period * swing + &own * kappa_0;
            return of_size * forcing.q_rms.sqr() + own * kappa_1 * forcing.q_rate_rms.sqr();
        }
        let swing = &problem.numbers().period / (R::int(2) * &self.mu);
        self.enlarged.sqr() * ((swing + kappa_0) * forcing.q_rms.sqr() + kappa_1 * forcing.q_rate_rms.sqr())
    }
}

mod by_count;
#[cfg(test)]
mod tests;
