//! The sharp derivation: conditions S1, S2, C4, C5 decided from a rational witness (derivation, sections 5 and 10).

use super::condition::{self, Condition, Relation};
use super::consequences::Excitation;
use super::contraction::ContractionMatrix;
use super::control::{self, Control, Reach};
use super::energy;
use super::harmonics::AtOrigin;
use super::initial_set::{ClaimedSet, claimed_distances, set_conditions};
use super::joint;
use super::matrix_inequality;
use super::mean_squares::{
    DampedResponse, ErrorGains, Forcing, Gains, MeanSquares, PeriodicSize, SetBounds, at_the_solution,
    sup_by_mean_squares,
};
use super::paths::Paths;
use super::stability::{DecayCondition, ErrorBox, level_condition, level_words};
use super::uniqueness;
use super::{domain_conditions, sign_conditions};
use crate::data::{Bound, Data, Problem};
use crate::transfer::{self, TransferProof};
use rug::Rational;
use sigmastar_exact::enclosure::{Enclosure, Truth};

/// The free numbers of the sharp derivation, exactly.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SharpWitness {
    /// The gain to be certified.
    pub sigma: Rational,
    /// X_p > 0.
    pub x_p: Rational,
    /// E_p > 0.
    pub e_p: Rational,
    /// r_x > 0.
    pub r_x: Rational,
    /// r_e > 0.
    pub r_e: Rational,
    /// r_d > 0.
    pub r_d: Rational,
    /// kap >= 0: how much of dq/de the map of the existence proof takes into its linear part; with 0 the form is that of
    /// 10.3, else that of 10.4.
    pub kap: Rational,
    /// Smaller r_x, r_e, r_d > 0, which hold at the periodic solution; those of existence, above, serve without.
    pub refined: Option<MeanSquares<Rational>>,
    /// D_x > 0.
    pub d_x: Rational,
    /// D_e > 0.
    pub d_e: Rational,
    /// w_x > 0.
    pub w_x: Rational,
    /// h > 0.
    pub h: Rational,
    /// k0, in units of x = omega/w.
    pub k0: Rational,
    /// k1, in units of x = omega/w.
    pub k1: Rational,
    /// Why T_N(x) <= k0 + k1 x^2.
    pub transfer: TransferProof,
    /// The initial set to be covered.
    pub set: ClaimedSet,
    /// Along which paths f and q are split on the error box.
    pub paths: Paths,
}

impl SharpWitness {
    /// r_x, r_e, r_d, with which existence is proved.
    #[must_use]
    pub fn squares(&self) -> MeanSquares<&Rational> {
        MeanSquares { x: &self.r_x, e: &self.r_e, e_rate: &self.r_d }
    }

    /// r_x, r_e, r_d of the periodic solution.
    #[must_use]
    pub fn squares_at_the_solution(&self) -> MeanSquares<&Rational> {
        match &self.refined {
            Some(MeanSquares { x, e, e_rate }) => MeanSquares { x, e, e_rate },
            None => self.squares(),
        }
    }

    /// How far |e| and the control are from those of the periodic solution, of every solution that begins at these distances from it in x, e and
    /// zeta: by the function that falls along their differences (section 5; 13.7, (M) and (Jm)).
    ///
    /// Hypotheses: the conditions of stability are proved for this witness, and solutions that begin so stay in the error box. Guarantee: the bounds hold at
    /// all times, at the gain of the witness, for every number of oscillators whose Nbar is at most that of `data`.
    #[must_use]
    pub fn reach(&self, data: &Data<'_>, distances: [&Enclosure; 3]) -> Reach<Enclosure> {
        let number = |value: &Rational| data.rational(value);
        if let Some(joint) = &data.spec.bounds.proved_values().joint_stability {
            return control::joint_reach(data, joint, number, &self.sigma, distances);
        }
        let [sigma, w_x, h, d_x, d_e] = [&self.sigma, &self.w_x, &self.h, &self.d_x, &self.d_e].map(number);
        let (start, _) = level_condition(data, distances, [&d_x, &d_e, &w_x, &h]);
        // At the gain b the weight of zeta is b h, by (M) tau/sigma times that (Theorem G3), and the level no larger than at b_hi.
        let share = match matrix_inequality::proved_for(data, &self.w_x, &self.h) {
            Some(known) => number(&known.value) / &sigma,
            None => Enclosure::one(data.precision),
        };
        let least = data.input_gain.as_ref().map_or_else(|| h.clone(), |gain| &gain.low * &h * &share);
        control::reach(data, [&sigma, &data.mu], &least, (&start, None))
    }
}

/// Everything the sharp derivation computes from a witness.
#[derive(Clone, Debug)]
pub struct SharpEvaluation {
    /// sigma.
    pub sigma: Enclosure,
    /// The bounding functions at (X_p, E_p).
    pub bounds: SetBounds<Enclosure>,
    /// r_x, r_e, r_d of the periodic solution.
    pub squares: MeanSquares<Enclosure>,
    /// R_q, R_1, e_per and x_per at sigma.
    pub periodic: PeriodicSize<Enclosure>,
    /// What drives the periodic error.
    pub excitation: Excitation,
    /// Z.
    pub z: Enclosure,
    /// The contraction matrix in mean squares: where its spectral radius is below 1, the periodic solution is the only one in
    /// the set. No condition asks for it.
    pub contraction: ContractionMatrix<Enclosure>,
    /// The error box.
    pub error_box: ErrorBox<Enclosure>,
    /// C5 by norms, of which nothing is asked where there is a matrix inequality.
    pub decay: DecayCondition<Enclosure>,
    /// The threshold of sigma by a matrix inequality, where there is one for the weights of the witness, and its place in the derivation.
    pub by_matrix: Option<(Enclosure, &'static str)>,
    /// How large the control gets at sigma.
    pub control: Control<Enclosure>,
    /// How large |e| gets at sigma on the way from the claimed set: e_per and how far from there.
    pub peak: Enclosure,
    /// All conditions in order.
    pub conditions: Vec<Condition>,
}

impl SharpEvaluation {
    /// Evaluates all quantities and conditions at the precision of `data`.
    ///
    /// Guarantee: if [`SharpEvaluation::truth`] is `True` and the bounding functions are finite, nonnegative where they bound
    /// norms, and nondecreasing (a rate nonincreasing) up to (max{X_p, X_b}, max{E_p, E_b}), then for every n_o >= 0 and every
    /// sigma' >= sigma (with an actuator, which then never saturates, for sigma alone) there is a T-periodic solution with sup|x| <= x_per, sup|e| <= e_per, sup|zeta|_N <= Z, and every
    /// solution from the claimed set, at any initial time, converges to it exponentially.
    #[must_use]
    pub fn new(data: &Data<'_>, witness: &SharpWitness) -> SharpEvaluation {
        let number = |value: &Rational| data.rational(value);
        let sigma = number(&witness.sigma);
        let origin = AtOrigin::new(data);
        let bounds = SetBounds::new(data, number(&witness.x_p), number(&witness.e_p));
        let gains = ErrorGains::new(data, &sigma).with_energy(energy::proved(data, &origin, &sigma));
        let squares = witness.squares_at_the_solution().map(|value| number(value));
        let periodic = PeriodicSize::new(data, &bounds, &origin, &gains, &squares);
        let z = gains.z_squared(data, &periodic.forcing, [&number(&witness.k0), &number(&witness.k1)]).sqrt();

        let (d_x, d_e) = (number(&witness.d_x), number(&witness.d_e));
        let (w_x, h) = (number(&witness.w_x), number(&witness.h));
        let error_box = ErrorBox::new(data, witness.paths, [&periodic.x_per, &periodic.e_per], [&d_x, &d_e]);
        let decay = DecayCondition::new(data, &error_box, [&w_x, &h], &sigma);

        let mut conditions = signs(data, witness);
        conditions.extend(set_conditions(data, &witness.set, &witness.x_p, &witness.e_p, &z));
        conditions.extend(domain_conditions(data, bounds.x_p.max(&error_box.x_b), bounds.e_p.max(&error_box.e_b)));
        conditions.push(transfer::decide(data, &witness.k0, &witness.k1, &witness.transfer).1);
        conditions.extend(energy::conditions(data, [&witness.x_p, &witness.e_p], &witness.sigma));
        conditions.extend(match gains.has_energy() {
            true => strict_existence_conditions(data, witness, &bounds, &origin, &gains),
            false => existence_conditions(data, witness, &bounds, &origin, &gains),
        });
        conditions.extend(refined_conditions(data, witness, &bounds, &origin, &gains));
        let [dist_x, dist_e, dist_z] = claimed_distances(data, &witness.set, [&periodic.x_per, &periodic.e_per, &z]);
        let distances = [&dist_x, &dist_e, &dist_z];
        let inequality = matrix_inequality::proved_for(data, &witness.w_x, &witness.h);
        let joint = data.spec.bounds.proved_values().joint_stability.as_ref();
        let reach = witness.reach(data, distances);
        if let Some(joint) = joint {
            conditions.extend(joint::conditions(
                data,
                joint,
                distances,
                [&d_x, &d_e],
                &error_box,
                (&witness.sigma, ""),
            ));
        } else {
            let (start, exit) = level_condition(data, distances, [&d_x, &d_e, &w_x, &h]);
            conditions.push(Condition::less("C4", level_words(data), start, exit));
            match inequality {
                Some(inequality) => {
                    let place = (witness.paths, [&periodic.x_per, &periodic.e_per], &error_box);
                    conditions.extend(matrix_inequality::conditions(data, inequality, place, &sigma, ""));
                }
                None => {
                    conditions.extend(one_sided(data, witness.paths.q.place_of_de(), &error_box.sector_at));
                    conditions.extend(by_norms_conditions(&decay, &sigma, ""));
                }
            }
        }
        let peak = &periodic.e_per + reach.error;
        let by_parts = control::by_parts(data, [&sigma, &data.mu], [&periodic.e_per, &z]);
        let steady = control::Answer::continuous(data).steady(&origin, &periodic.forcing, &by_parts);
        let nominal = data.spec.input_gain.as_ref().map(|gain| gain.nominal.enclose(data.precision));
        let control = Control { steady, transient: reach.transient }.over(nominal.as_ref());
        conditions.extend(control.condition(data));
        let by_matrix = match (joint, inequality) {
            (Some(joint), _) => Some((number(&joint.inequality.value), "section 13.7, (Jm)")),
            (None, Some(inequality)) => Some((number(&inequality.value), "section 13.7, (M)")),
            (None, None) => None,
        };
        let contraction = uniqueness::contraction(data, &bounds, &gains);
        let excitation = Excitation {
            q_rms: periodic.forcing.q_rms.clone(),
            q_rate_rms: periodic.forcing.q_rate_rms.clone(),
            x_gain: bounds.x_gain.clone(),
            split: origin
                .known
                .as_ref()
                .map(|known| [[known.rest_rms.clone(), known.rest_t_rms.clone()], periodic.forcing.change.clone()]),
        };
        SharpEvaluation {
            sigma,
            bounds,
            squares,
            periodic,
            excitation,
            z,
            contraction,
            error_box,
            decay,
            by_matrix,
            control,
            peak,
            conditions,
        }
    }

    /// What sigma must exceed for stability, or reach with joint metrics, and its place in the derivation.
    #[must_use]
    pub fn threshold(&self) -> (&Enclosure, &'static str) {
        let by_norms = (&self.decay.sigma_threshold, "section 5, C5");
        self.by_matrix.as_ref().map_or(by_norms, |(threshold, source)| (threshold, *source))
    }

    /// The truth of all conditions together.
    #[must_use]
    pub fn truth(&self) -> Truth {
        condition::all(&self.conditions)
    }
}

/// C5 by norms; `of` says of what.
pub(super) fn by_norms_conditions(decay: &DecayCondition<Enclosure>, sigma: &Enclosure, of: &str) -> [Condition; 2] {
    let (coupling, curvature) = (decay.coupling.clone(), decay.curvature.clone());
    let what = format!("{of}threshold of the quadratic form < sigma");
    [
        Condition::less("C5", format!("{of}(h/mu) k_x^2 < 4 w_x a_2"), coupling, curvature),
        Condition::less("C5b", what, decay.sigma_threshold.clone(), sigma.clone()),
    ]
}

/// The signs of the witness: all numbers are positive, kap may be 0.
fn signs(data: &Data<'_>, witness: &SharpWitness) -> Vec<Condition> {
    let mut named = vec![
        ("sigma", &witness.sigma),
        ("X_p", &witness.x_p),
        ("E_p", &witness.e_p),
        ("r_x", &witness.r_x),
        ("r_e", &witness.r_e),
        ("r_d", &witness.r_d),
        ("D_x", &witness.d_x),
        ("D_e", &witness.d_e),
        ("w_x", &witness.w_x),
        ("h", &witness.h),
        ("k1", &witness.k1),
    ];
    if witness.kap != 0 {
        named.push(("kap", &witness.kap));
    }
    if let Some(refined) = &witness.refined {
        named.extend([("refined r_x", &refined.x), ("refined r_e", &refined.e), ("refined r_d", &refined.e_rate)]);
    }
    sign_conditions(data, &named)
}

/// (M) -b_qe <= q_e_max where the one-sided bound is used: otherwise no plant has it.
pub(super) fn one_sided(data: &Data<'_>, place: &str, [x, e]: &[Enclosure; 2]) -> Option<Condition> {
    data.given(Bound::QeMax).then(|| {
        // As it is given, even where b_qe is smaller and serves in its place.
        let [below, above] = [Bound::Qe, Bound::QeMax].map(|which| data.spec.bounds.at(which, x, e));
        Condition::at_most("M", format!("-b_qe <= q_e_max at {place}"), below.negate(), above)
    })
}

/// (S1) and (S2).
fn existence_conditions(
    data: &Data<'_>,
    witness: &SharpWitness,
    bounds: &SetBounds<Enclosure>,
    origin: &AtOrigin<Enclosure>,
    gains: &ErrorGains<Enclosure>,
) -> Vec<Condition> {
    let squares = witness.squares().map(|value| data.rational(value));
    let kap = (witness.kap != 0).then(|| data.rational(&witness.kap));
    let by_squares = sup_by_mean_squares(data, &squares);
    let known = if data.q_0.is_some() { ", q_0 form" } else { "" };
    let [sup, rms, rate_rms] = match &kap {
        None => {
            let response = gains.response(origin, &Forcing::new(bounds, origin, &squares));
            [
                (format!("min{{bt R_q, tau R_1, sqrt(T r_e r_d){known}}}"), response.sup.min(&by_squares)),
                (format!("min{{R_q/sg, R_1/(Om sg){known}}}"), response.rms),
                ("min{R_q, R_1/sg}".to_owned(), response.rate_rms),
            ]
        }
        Some(kap) => {
            let damped = DampedResponse::new(bounds, origin, [&gains.sigma, kap], &squares);
            [
                ("sqrt(T r_e r_d)".to_owned(), by_squares),
                ("g_k Rt".to_owned(), damped.rms),
                ("Rt + kap r_e".to_owned(), damped.rate_rms),
            ]
        }
    };
    let x_rms = ("(c/a_1) b_fe r_e".to_owned(), bounds.x_rms(&squares));
    bounds.existence(data, &squares, Relation::LessOrEqual, [x_rms, sup, rms, rate_rms])
}

/// (S1) and (S2) with a matrix inequality of existence (derivation, 13.7, (E)).
///
/// All that bounds a periodic solution bounds those with l q(t,0,0) in the place of q(t,0,0), 0 < l <= 1, as long as no bound of q
/// as a whole is used, of which part of q(t,0,0) may be missing. Where each of them is strictly inside of the sizes X_p, E_p, r_x,
/// r_e, r_d, no such solution is on their boundary, and there is one for l = 1 (Leray and Schauder).
fn strict_existence_conditions(
    data: &Data<'_>,
    witness: &SharpWitness,
    bounds: &SetBounds<Enclosure>,
    origin: &AtOrigin<Enclosure>,
    gains: &ErrorGains<Enclosure>,
) -> Vec<Condition> {
    let squares = witness.squares().map(|value| data.rational(value));
    let kap = (witness.kap != 0).then(|| data.rational(&witness.kap));
    let of_changes = bounds.clone().of_changes();
    let image = at_the_solution(&of_changes, origin, gains, kap.as_ref(), &squares);
    let response = gains.response(origin, &Forcing::new(&of_changes, origin, &squares));
    let sup = response.sup.min(&sup_by_mean_squares(data, &squares));
    let [damped, damped_rate] = if kap.is_some() { ["g_k Rt, ", "Rt + kap r_e, "] } else { [""; 2] };
    let is_joint = data.spec.bounds.proved_values().joint_existence.is_some();
    let room = if is_joint { "c_e" } else { "2 (sigma - threshold)" };
    let rms = format!("min{{R_q/sg, R_1/(Om sg), q_0 form, {damped}r_y/sg, k_p Q_m/(2 sqrt({room} c_y))}}");
    let least = [
        ("min{(c/a_1) b_fe r_e, k_p Q_m/(2 sqrt(c_x c_y))}".to_owned(), image.x),
        ("min{bt R_q, tau R_1, sqrt(T r_e r_d), q_0 form, bt r_y}".to_owned(), sup),
        (rms, image.e),
        (format!("min{{R_q, R_1/sg, {damped_rate}r_y}}"), image.e_rate),
    ];
    bounds.existence(data, &squares, Relation::Less, least)
}

/// (S3), and (M) of section 10 where kap > 0.
fn refined_conditions(
    data: &Data<'_>,
    witness: &SharpWitness,
    bounds: &SetBounds<Enclosure>,
    origin: &AtOrigin<Enclosure>,
    gains: &ErrorGains<Enclosure>,
) -> Vec<Condition> {
    let kap = (witness.kap != 0).then(|| data.rational(&witness.kap));
    let mut conditions = Vec::new();
    if kap.is_some() {
        conditions.extend(one_sided(data, "(X_p, E_p)", &[bounds.x_p.clone(), bounds.e_p.clone()]));
    }
    if let Some(refined) = &witness.refined {
        let refined = refined.map(|value: &Rational| data.rational(value));
        let image = at_the_solution(bounds, origin, gains, kap.as_ref(), &refined);
        conditions.push(Condition::less("S3", "G_x(r') < r'_x", image.x, refined.x));
        conditions.push(Condition::less("S3b", "G_e(r') < r'_e", image.e, refined.e));
        conditions.push(Condition::less("S3c", "G_d(r') < r'_d", image.e_rate, refined.e_rate));
    }
    conditions
}
