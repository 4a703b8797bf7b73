//! Existence and size of the periodic solution by mean squares (derivation, 10.1 to 10.4): no contraction is asked for.

use super::energy::EnergyBounds;
use super::gains;
use super::harmonics::{self, AtOrigin};
use crate::condition::{Condition, Relation};
use crate::data::{Bound, Data, Numbers, Problem};
use crate::input_gain::InputGain;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::real::{Operand, Real};

/// Bounds of rms(x), rms(e) and rms(e') along a periodic solution.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MeanSquares<R> {
    /// r_x, of rms(x).
    pub x: R,
    /// r_e, of rms(e).
    pub e: R,
    /// r_d, of rms(e').
    pub e_rate: R,
}

impl<N> MeanSquares<N> {
    /// These bounds over other numbers.
    #[must_use]
    pub fn map<M>(&self, number: impl Fn(&N) -> M) -> MeanSquares<M> {
        MeanSquares { x: number(&self.x), e: number(&self.e), e_rate: number(&self.e_rate) }
    }
}

/// What the regulator makes of a periodic q at one sigma, for every n_o and mu (derivation, 10.2).
#[derive(Clone, Debug)]
pub struct ErrorGains<R> {
    /// sigma.
    pub sigma: R,
    /// bt: sup|e| <= bt rms(q).
    pub sup: R,
    /// tau: sup|e| <= tau rms(q').
    pub sup_by_rate: R,
    /// 1/sg: rms(e) <= rms(q)/sg and rms(e') <= rms(q')/sg; sg = sqrt(sigma^2 + Om^2).
    pub rms: R,
    /// 1/(Om sg): rms(e) <= rms(q')/(Om sg).
    pub rms_by_rate: R,
    /// What an input gain changes: none without one.
    input: Option<OfInput<R>>,
    /// The responses to the known harmonics of q(t,0,0), where some are known.
    known: Option<harmonics::Response<R>>,
    /// What a matrix inequality says of the periodic solution, where there is one (derivation, 13.7, (E)).
    energy: Option<EnergyBounds<R>>,
}

/// What an input gain changes in the gains, which then are those for q over b_m (derivation, 13.1).
#[derive(Clone, Debug)]
struct OfInput<R> {
    /// d_b: rms(e') <= d_b rms(q).
    rate: R,
    /// bt and 1/sg, which serve y = q + (1-b) sigma e + b mu s: e' = y - sigma e has no b.
    of_y: [R; 2],
}

impl<R: Real> ErrorGains<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// Evaluates the gains. Each decreases in sigma.
    #[must_use]
    pub fn new(problem: &impl Problem<R>, sigma: &R) -> ErrorGains<R> {
        let Numbers { period, fundamental, q_0, input_gain, .. } = problem.numbers();
        let rms = R::int(1) / (sigma.sqr() + fundamental.sqr()).sqrt();
        let sup = gains::zero_mean_gain(sigma, period);
        let input =
            input_gain.as_ref().map(|gain| OfInput { rate: gain.of_error_rate(), of_y: [sup.clone(), rms.clone()] });
        // What a harmonic of q does to e, over b_m.
        let of_error = |gain: R| input_gain.as_ref().map_or_else(|| gain.clone(), |input| &gain / input.of_error());
        let rms = of_error(rms);
        ErrorGains {
            sup: of_error(sup),
            sup_by_rate: of_error(gains::tau(sigma, period)),
            rms_by_rate: &rms / fundamental,
            rms,
            input,
            known: q_0.as_ref().map(|known| harmonics::Response::new(problem, known, sigma)),
            sigma: sigma.clone(),
            energy: None,
        }
    }

    /// These gains with the bounds of a matrix inequality, which are taken where they are smaller. What bounds a solution with q(t,0,0)
    /// times a number in [0, 1] then is only strictly below what it shows.
    #[must_use]
    pub fn with_energy(self, energy: Option<EnergyBounds<R>>) -> ErrorGains<R> {
        // With an input gain the form moves with sigma in its entry with e and y: what it says of e is by y alone.
        let energy = match self.input {
            Some(_) => energy.map(|energy| EnergyBounds { e: R::unknown(), ..energy }),
            None => energy,
        };
        ErrorGains { energy, ..self }
    }

    /// Whether there are such bounds.
    #[must_use]
    pub fn has_energy(&self) -> bool {
        self.energy.is_some()
    }

    /// min{bt size, tau rate}: sup|e| for rms(q) <= size and rms(q') <= rate.
    fn sup_of(&self, size: &R, rate: &R) -> R {
        (&self.sup * size).min(&(&self.sup_by_rate * rate))
    }

    /// min{size/sg, rate/(Om sg)}: rms(e) for rms(q) <= size and rms(q') <= rate.
    fn rms_of(&self, size: &R, rate: &R) -> R {
        (&self.rms * size).min(&(&self.rms_by_rate * rate))
    }
}

/// Everything at (X_p, E_p) that sigma does not enter.
#[derive(Clone, Debug)]
pub struct SetBounds<R> {
    /// X_p.
    pub x_p: R,
    /// E_p.
    pub e_p: R,
    /// a_1, a rate of J_x(t) = int_0^1 df/dx(t, r x, 0) dr for |x| <= X_p.
    pub rate: R,
    /// b_fe.
    pub f_e: R,
    /// b_fx at (X_p, 0), a bound of |J_x|.
    pub f_x: R,
    /// (c/a_1) b_fe: sup|x| over sup|e|, and rms(x) over rms(e).
    pub x_gain: R,
    /// K2(a_1) b_fe: sup|x| over rms(e).
    pub x_gain_by_rms: R,
    /// b_q_rms.
    pub q_rms: R,
    /// b_qt_rms.
    pub q_t_rms: R,
    /// b_qe.
    pub q_e: R,
    /// b_qx.
    pub q_x: R,
    /// m = min{q_e_max, b_qe}, an upper bound of dq/de.
    pub q_e_max: R,
    /// The interval of the input gain.
    input_gain: Option<InputGain<R>>,
    /// b_qtx and b_qte, where both are given.
    mixed: Option<[R; 2]>,
}

impl<R: Real> SetBounds<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// Evaluates the bounding functions at (X_p, E_p), those of x' at (X_p, 0).
    ///
    /// a_1 is the larger one of a(X_p, 0), where a rate is given, and alpha - c b_fxx(X_p,0) X_p/2; b_fx the smaller one of
    /// the one that is given and `(b_f(X_p,0) + b_fxx(X_p,0) X_p^2)/X_p`: |F| <= b_f/X + b_fxx X/2 by Taylor, and |J_x - F| <=
    /// b_fxx X/2. Where a_1 is not certainly positive, the gains are unknown.
    #[must_use]
    pub fn new(problem: &impl Problem<R>, x_p: R, e_p: R) -> SetBounds<R> {
        let Numbers { period, existence, input_gain, .. } = problem.numbers();
        let zero = problem.zero();
        let at_box = |which| problem.bound(which, &x_p, &e_p);
        let on_axis = |which| problem.bound(which, &x_p, &zero);
        let f_xx = on_axis(Bound::Fxx);
        let by_curvature = &existence.alpha - &existence.c * &f_xx * &x_p / R::int(2);
        // A rate is one in a certain P: that of existence, where it has its own. Of the other P it says nothing then.
        let given = on_axis(if existence.separate { Bound::RateExistence } else { Bound::Rate });
        // Of what is not given nothing is known.
        let rate = by_curvature.max_known(&given);
        let by_taylor = (on_axis(Bound::F) + f_xx * x_p.sqr()) / &x_p;
        let f_x = by_taylor.min_known(&on_axis(Bound::Fx));
        let f_e = at_box(Bound::Fe);
        let positive = if rate.is_certainly_positive() { rate.clone() } else { R::unknown() };
        let mixed = problem.given(Bound::Qtx) && problem.given(Bound::Qte);
        SetBounds {
            x_gain: &existence.c / &positive * &f_e,
            x_gain_by_rms: gains::mean_square_gain(&existence.c, &positive, period) * &f_e,
            q_rms: at_box(Bound::QRms),
            q_t_rms: at_box(Bound::QtRms),
            q_e: at_box(Bound::Qe),
            q_x: at_box(Bound::Qx),
            q_e_max: at_box(Bound::QeMax),
            mixed: mixed.then(|| [at_box(Bound::Qtx), at_box(Bound::Qte)]),
            input_gain: input_gain.clone(),
            rate,
            f_e,
            f_x,
            x_p,
            e_p,
        }
    }

    /// These bounds without those of q as a whole: what is left bounds q(t,0,0) and the change of q from there, each by itself.
    #[must_use]
    pub fn of_changes(self) -> SetBounds<R> {
        SetBounds { q_rms: R::unknown(), q_t_rms: R::unknown(), ..self }
    }

    /// The left side of (S1b): `min{(c/a_1) b_fe E_p, K2(a_1) b_fe r_e} <= X_p`.
    #[must_use]
    pub fn x_sup(&self, squares: &MeanSquares<R>) -> R {
        (&self.x_gain * &self.e_p).min(&(&self.x_gain_by_rms * &squares.e))
    }

    /// x_per = min{X_p, (c/a_1) b_fe e_per, K2(a_1) b_fe r_e}, a bound of sup|x| where sup|e| <= e_per.
    #[must_use]
    pub fn x_per(&self, e_per: &R, squares: &MeanSquares<R>) -> R {
        self.x_p.min(&(&self.x_gain * e_per)).min(&(&self.x_gain_by_rms * &squares.e))
    }

    /// The left side of (S1c): `(c/a_1) b_fe r_e <= r_x`.
    #[must_use]
    pub fn x_rms(&self, squares: &MeanSquares<R>) -> R {
        &self.x_gain * &squares.e
    }
}

impl SetBounds<Enclosure> {
    /// (S1) and (S2): the sizes of the set in this relation to what bounds sup|x|, and to what bounds rms(x), sup|e|, rms(e) and rms(e'),
    /// each with its formula.
    #[must_use]
    pub fn existence(
        &self,
        data: &Data<'_>,
        squares: &MeanSquares<Enclosure>,
        relation: Relation,
        least: [(String, Enclosure); 4],
    ) -> Vec<Condition> {
        let x_sup = ("min{(c/a_1) b_fe E_p, K2(a_1) b_fe r_e}".to_owned(), self.x_sup(squares));
        let sizes = [
            ("S1b", "X_p", &self.x_p),
            ("S1c", "r_x", &squares.x),
            ("S2", "E_p", &self.e_p),
            ("S2b", "r_e", &squares.e),
            ("S2c", "r_d", &squares.e_rate),
        ];
        let of_size = |((id, name, size), (formula, lhs)): ((_, &str, &Enclosure), (String, _))| Condition {
            id,
            what: format!("{formula} {relation} {name}"),
            lhs,
            relation,
            rhs: size.clone(),
        };
        let positive = Condition::less("S1", "0 < a_1", data.zero(), self.rate.clone());
        let of_sizes = sizes.into_iter().zip(std::iter::once(x_sup).chain(least)).map(of_size);
        std::iter::once(positive).chain(of_sizes).collect()
    }
}

/// Bounds of q along a periodic solution with given mean squares.
#[derive(Clone, Debug)]
pub struct Forcing<R> {
    /// R_q = min{b_q_rms, Q_0 + b_qx r_x + b_qe r_e}, of rms(q).
    pub q_rms: R,
    /// R_1 = b_qt_rms + b_qx r_x1 + b_qe r_d with r_x1 = b_fx r_x + b_fe r_e, of rms(dq/dt along the solution); or what the
    /// known harmonics give, where that is smaller.
    pub q_rate_rms: R,
    /// d_0 and d_1, of rms(d) and rms(d') for d = q(t,x,e) - q(t,0,0).
    pub change: [R; 2],
}

impl<R: Real> Forcing<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// Evaluates the bounds. Guarantee: they hold for all T-periodic (x, e) with sup|x| <= X_p, sup|e| <= E_p, the given
    /// mean squares, and rms(x') <= r_x1.
    #[must_use]
    pub fn new(bounds: &SetBounds<R>, origin: &AtOrigin<R>, squares: &MeanSquares<R>) -> Forcing<R> {
        let x_rate = &bounds.f_x * &squares.x + &bounds.f_e * &squares.e;
        let size = &bounds.q_x * &squares.x + &bounds.q_e * &squares.e;
        let moved = &bounds.q_x * x_rate + &bounds.q_e * &squares.e_rate;
        let in_time = &bounds.q_t_rms + &origin.q_t_rms;
        let in_time = match &bounds.mixed {
            Some([x, e]) => in_time.min_known(&(x * &squares.x + e * &squares.e)),
            None => in_time,
        };
        let change_rate = in_time + &moved;
        let q_rate_rms = &bounds.q_t_rms + moved;
        Forcing {
            q_rms: bounds.q_rms.min_known(&(&origin.q_rms + &size)),
            q_rate_rms: match &origin.known {
                Some(known) => q_rate_rms.min_known(&(&known.rate_rms + &known.rest_t_rms + &change_rate)),
                None => q_rate_rms,
            },
            change: [size, change_rate],
        }
    }
}

/// The right sides of (S2) in the form of 10.3, with `q_0` where it is given: what bounds the regulator's response to q.
#[derive(Clone, Debug)]
pub struct Response<R> {
    /// Of sup|e|, without `sqrt(T r_e r_d)`.
    pub sup: R,
    /// Of rms(e).
    pub rms: R,
    /// Of rms(e').
    pub rate_rms: R,
}

/// What a regulator makes of a periodic input q, for every n_o (derivation, 10.3; at samples 12.1 and 12.2).
pub trait Gains<R: Real> {
    /// Bounds of the error, from those of q.
    fn response(&self, origin: &AtOrigin<R>, forcing: &Forcing<R>) -> Response<R>;

    /// A bound of rms(x) that needs none of rms(e); unknown where there is none.
    fn rms_of_states(&self) -> R {
        R::unknown()
    }

    /// A bound of sup|y_k| of the law at samples; unknown of the one in continuous time.
    fn largest_mean(&self, _: &Forcing<R>) -> R {
        R::unknown()
    }

    /// Z^2, a bound of zeta'N zeta at every instant (or at every sample) of the periodic solution; k0, k1 in units of
    /// x = omega/w.
    fn z_squared(&self, problem: &impl Problem<R>, forcing: &Forcing<R>, k: [&R; 2]) -> R;
}

impl<R: Real> Gains<R> for ErrorGains<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// `min{bt R_q, tau R_1}`, `min{R_q/sg, R_1/(Om sg)}`, `min{R_q, R_1/sg}`; superposed with the known harmonics of
    /// q(t,0,0) where that is smaller; and `bt r_y`, `min{r_y/sg, .}`, `r_y` of a matrix inequality.
    fn response(&self, origin: &AtOrigin<R>, forcing: &Forcing<R>) -> Response<R> {
        let Forcing { q_rms, q_rate_rms, change: [change, change_rate] } = forcing;
        let mut sup = self.sup_of(q_rms, q_rate_rms);
        let mut rms = self.rms_of(q_rms, q_rate_rms);
        let by_size = self.input.as_ref().map_or_else(|| q_rms.clone(), |input| &input.rate * q_rms);
        let mut rate_rms = by_size.min(&(q_rate_rms * &self.rms));
        if let Some(EnergyBounds { y, e, .. }) = &self.energy {
            let [sup_of_y, rms_of_y] =
                self.input.as_ref().map_or([&self.sup, &self.rms], |input| input.of_y.each_ref());
            sup = sup.min_known(&(sup_of_y * y));
            rms = rms.min_known(&(rms_of_y * y)).min_known(e);
            rate_rms = rate_rms.min_known(y);
        }
        let (Some(known), Some(response)) = (&origin.known, &self.known) else {
            return Response { sup, rms, rate_rms };
        };
        let superposed_sup =
            &response.sup + self.sup_of(&known.rest_rms, &known.rest_t_rms) + self.sup_of(change, change_rate);
        let superposed_rms =
            &response.rms + self.rms_of(&known.rest_rms, &known.rest_t_rms) + self.rms_of(change, change_rate);
        Response { sup: sup.min(&superposed_sup), rms: rms.min(&superposed_rms), rate_rms }
    }

    fn rms_of_states(&self) -> R {
        self.energy.as_ref().map_or_else(R::unknown, |energy| energy.x.clone())
    }

    /// `Z^2 = (T/(2 mu) + kappa_0) R_q^2 + kappa_1 R_1^2`, or the superposed form where harmonics of q(t,0,0) are known; with an input
    /// gain `T R_q^2/(2 b_lo^3 mu) + (kappa_0 R_q^2 + kappa_1 R_1^2)/c_m^2`, and the superposed one over c_m.
    fn z_squared(&self, problem: &impl Problem<R>, forcing: &Forcing<R>, [k0, k1]: [&R; 2]) -> R {
        let Numbers { period, mu, q_0, input_gain, .. } = problem.numbers();
        let [kappa_0, kappa_1] = problem.numbers().kappas(k0, k1);
        let swing = period / (R::int(2) * mu) * forcing.q_rms.sqr();
        let steady = input_gain.as_ref().map(InputGain::of_steady_state);
        let swing = input_gain.as_ref().map_or_else(|| swing.clone(), |input| &swing / input.of_swing());
        let mean = |size: &R, rate: &R| {
            let mean = &kappa_0 * size.sqr() + &kappa_1 * rate.sqr();
            steady.as_ref().map_or_else(|| mean.clone(), |steady| &mean / steady.sqr())
        };
        let plain = &swing + mean(&forcing.q_rms, &forcing.q_rate_rms);
        let Some(known) = q_0 else { return plain };
        let rest = harmonics::rest_t_rms(problem, known);
        let [change, change_rate] = &forcing.change;
        let of_harmonics = harmonics::steady_state_norm(problem, known, [k0, k1]);
        let superposed = steady.as_ref().map_or_else(|| of_harmonics.clone(), |steady| &of_harmonics / steady)
            + mean(&known.rest_rms, &rest).sqrt()
            + mean(change, change_rate).sqrt();
        plain.min(&(swing + superposed.sqr()))
    }
}

/// The right sides of (S2) in the form of 10.4: the linear part -kap e is a part of the map.
///
/// Hypotheses: kap > 0. They bound the answer to q + kap e, so for existence they are never mixed with those of
/// [`Response`]; at the periodic solution itself both hold.
#[derive(Clone, Debug)]
pub struct DampedResponse<R> {
    /// g_k Rt, of rms(e).
    pub rms: R,
    /// Rt + kap r_e, of rms(e'); with an input gain d_b Rt.
    pub rate_rms: R,
}

impl<R: Real> DampedResponse<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// `Rt = Q_0 + b_qx r_x + max{m + kap, b_qe - kap} r_e`; `g_k = 1/(sigma + kap)` where kap is certainly below sigma, else
    /// `1/(2 sqrt(sigma kap))`, which is never smaller. With an input gain `1/(b_lo sigma + kap)` where kap is certainly below
    /// `(2 - b_lo) sigma`, else `1/(2 sqrt(sigma (kap - (1 - b_lo) sigma)))` (derivation, 13.1).
    #[must_use]
    pub fn new(
        bounds: &SetBounds<R>,
        origin: &AtOrigin<R>,
        [sigma, kap]: [&R; 2],
        squares: &MeanSquares<R>,
    ) -> DampedResponse<R> {
        let slope = (&bounds.q_e_max + kap).max(&(&bounds.q_e - kap));
        let forcing = &origin.q_rms + &bounds.q_x * &squares.x + slope * &squares.e;
        if let Some(input) = &bounds.input_gain {
            let InputGain { low, .. } = input;
            let one = R::int(1);
            let small = (R::int(2) - low) * sigma - kap;
            let gain = match small.is_certainly_positive() {
                true => one / (low * sigma + kap),
                false => &one / (R::int(2) * (sigma * (kap - (&one - low) * sigma)).sqrt()),
            };
            return DampedResponse { rms: gain * &forcing, rate_rms: input.of_error_rate() * forcing };
        }
        let gain = match (sigma - kap).is_certainly_positive() {
            true => R::int(1) / (sigma + kap),
            false => R::int(1) / (R::int(2) * (sigma * kap).sqrt()),
        };
        DampedResponse { rms: gain * &forcing, rate_rms: forcing + kap * &squares.e }
    }
}

/// sqrt(T r_e r_d): sup|e| of a zero-mean e (integrate |(e^2)'| both ways around from a zero).
#[must_use]
pub fn sup_by_mean_squares<R: Real>(problem: &impl Problem<R>, squares: &MeanSquares<R>) -> R
where
    for<'a> &'a R: Operand<R>,
{
    (&problem.numbers().period * &squares.e * &squares.e_rate).sqrt()
}

/// The right sides of all bounds of rms(x), rms(e), rms(e') that hold at the periodic solution, in terms of themselves:
/// those of [`SetBounds`] and [`Response`], of a matrix inequality where there is one, and of [`DampedResponse`] where kap > 0.
///
/// Guarantee: G is nondecreasing and concave with G(0) >= 0, so mean squares r' with G(r') < r' in every component bound those
/// of the solution: for rho <= G(rho) and lam = max rho_i/r'_i > 1 there would be rho <= G(lam r') <= lam G(r') < lam r'.
#[must_use]
pub fn at_the_solution<R: Real>(
    bounds: &SetBounds<R>,
    origin: &AtOrigin<R>,
    gains: &ErrorGains<R>,
    kap: Option<&R>,
    squares: &MeanSquares<R>,
) -> MeanSquares<R>
where
    for<'a> &'a R: Operand<R>,
{
    let response = gains.response(origin, &Forcing::new(bounds, origin, squares));
    let (mut e, mut e_rate) = (response.rms, response.rate_rms);
    if let Some(kap) = kap {
        let damped = DampedResponse::new(bounds, origin, [&gains.sigma, kap], squares);
        (e, e_rate) = (e.min(&damped.rms), e_rate.min(&damped.rate_rms));
    }
    MeanSquares { x: bounds.x_rms(squares).min_known(&gains.rms_of_states()), e, e_rate }
}

/// The size of the periodic solution (derivation, 10.3), from mean squares that bound it.
#[derive(Clone, Debug)]
pub struct PeriodicSize<R> {
    /// R_q, R_1 and the change of q.
    pub forcing: Forcing<R>,
    /// e_per, the least of E_p, sqrt(T r_e r_d) and the bound of sup|e| in [`Gains::response`].
    pub e_per: R,
    /// x_per = min{X_p, (c/a_1) b_fe e_per, K2(a_1) b_fe r_e}.
    pub x_per: R,
}

impl<R: Real> PeriodicSize<R>
where
    for<'a> &'a R: Operand<R>,
{
    /// Evaluates the bounds. Guarantee: sup|e| <= e_per, sup|x| <= x_per for every sigma' >= sigma and every n_o, where the
    /// mean squares are those of a proved existence (of the regulator at samples for this sigma).
    #[must_use]
    pub fn new(
        problem: &impl Problem<R>,
        bounds: &SetBounds<R>,
        origin: &AtOrigin<R>,
        gains: &impl Gains<R>,
        squares: &MeanSquares<R>,
    ) -> PeriodicSize<R> {
        let forcing = Forcing::new(bounds, origin, squares);
        let e_per = bounds.e_p.min(&gains.response(origin, &forcing).sup).min(&sup_by_mean_squares(problem, squares));
        let x_per = bounds.x_per(&e_per, squares);
        PeriodicSize { forcing, e_per, x_per }
    }
}
