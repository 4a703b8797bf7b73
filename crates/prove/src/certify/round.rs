//! From floating-point proposals to short rational witnesses.
//!
//! Rounding spends a little of sigma: each attempt takes a sigma a bit larger than the last, recomputes the dependent
//! numbers for it, rounds, and asks for a rigorous decision; the first witness that is proved is returned.

use super::certification::ExactClaim;
use rug::Rational;
use sigmastar_decide::conditions::Ladder;
use sigmastar_decide::conditions::{Decidable, Proof, RepairedProof, SharpProof};
use sigmastar_decide::conditions::{decide, decide_exact};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, round_f64, round_rational};
use sigmastar_lang::spec::model::{InitialSet, StartSizes};
use sigmastar_propose::search::{
    ByMatrix, FloatModel, RepairedProposal, SharpProposal, active_level, at_sigma, largest_e_repaired, perron_repaired,
    search_exact, weight_h,
};
use sigmastar_theory::data::Data;
use sigmastar_theory::derivation::energy;
use sigmastar_theory::derivation::exact_regulation::{ExactWitness, steady_state_norm};
use sigmastar_theory::derivation::existence::PeriodicBounds;
use sigmastar_theory::derivation::harmonics::AtOrigin;
use sigmastar_theory::derivation::initial_set::{ClaimedSet, Size, claimed_distances, required_set};
use sigmastar_theory::derivation::mean_squares::{ErrorGains, Gains, MeanSquares, PeriodicSize, SetBounds};
use sigmastar_theory::derivation::repaired::RepairedWitness;
use sigmastar_theory::derivation::sharp::SharpWitness;
use sigmastar_theory::transfer::{TransferProof, closed_form_pair, prove_above};

/// Significant digits of sigma*.
const SIGMA_DIGITS: u32 = 6;
/// Significant digits of the , and of X_p, E_p where they do.
pub(super) const SHORT_DIGITS: u32 = 8;
/// Significant digits of numbers in which a condition is active.
pub(super) const LONG_DIGITS: u32 = 14;
/// Relative slacks of sigma that are tried in turn.
const SLACKS: [f64; 12] = [1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 1.0, 10.0, 1e3];

/// Digits of X_p, E_p and slacks, in the order in which they are tried: where a candidate is so near the edge of what is
/// possible that short numbers leave it, long ones are better than a larger sigma.
fn attempts() -> impl Iterator<Item = (u32, f64)> {
    let short = SLACKS.into_iter().take_while(|slack| *slack <= 1e-6).map(|slack| (SHORT_DIGITS, slack));
    short.chain(SLACKS.into_iter().map(|slack| (LONG_DIGITS, slack)))
}

/// Decides one witness after the other: the first attempt that is proved, or the last one.
pub(super) fn first_proved<W: Decidable>(
    data: &Data<'_>,
    ladder: Ladder,
    mut witness: impl FnMut((u32, f64)) -> Option<W>,
) -> Option<Proof<W>> {
    let mut last = None;
    for attempt in attempts() {
        let Some(witness) = witness(attempt) else { continue };
        let proof = decide(data.spec, witness, ladder);
        let proved = proof.truth().is_true();
        last = Some(proof);
        if proved {
            break;
        }
    }
    last
}

pub(super) fn nearest(value: f64, digits: u32) -> Option<Rational> {
    round_f64(value, digits, Direction::Nearest)
}

pub(super) fn upper(value: &Enclosure, digits: u32) -> Option<Rational> {
    value.upper_rational().map(|exact| round_rational(&exact, digits, Direction::Up))
}

pub(super) fn rounded_sigma(sigma: f64, slack: f64) -> Option<Rational> {
    round_f64(sigma * (1.0 + slack), SIGMA_DIGITS, Direction::Up)
}

/// E_p rounded up, which helps C2, unless C1 (at the rounded X_p) allows no more than `largest`; then down.
fn rounded_e(e_p: f64, largest: f64, digits: u32) -> Option<Rational> {
    let up = round_f64(e_p, digits, Direction::Up)?;
    if up.to_f64() < largest * (1.0 - 1e-12) {
        return Some(up);
    }
    round_f64(e_p.min(largest), digits, Direction::Down)
}

/// The claimed set for X_p, E_p and Z: what the specification requires, rounded up where it is not a short rational.
pub(super) fn claimed_set(data: &Data<'_>, x_p: &Rational, e_p: &Rational, z: &Enclosure) -> Option<ClaimedSet> {
    let digits = if matches!(data.spec.initial_set, InitialSet::Paper) { SHORT_DIGITS } else { LONG_DIGITS };
    let StartSizes { x0, e0, z0 } = required_set(data, x_p, e_p, z).map(|size| match size {
        Size::Exact(exact) => Some(exact.clone()),
        Size::Enclosed(value) => upper(value, digits),
    });
    Some(ClaimedSet { x0: x0?, e0: e0?, z0: z0.map_or(Some(None), |z0| z0.map(Some))? })
}

/// Which proof of the transfer bound the sharp derivation uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TransferKind {
    ClosedForm,
    Matched,
    Boxes,
}

impl TransferKind {
    /// That of a proof.
    pub(super) fn of(proof: &TransferProof) -> TransferKind {
        match proof {
            TransferProof::ClosedForm => TransferKind::ClosedForm,
            TransferProof::Matched { .. } => TransferKind::Matched,
            TransferProof::Boxes(_) => TransferKind::Boxes,
        }
    }
}

/// The transfer constants proposed by the trade-off, rounded up, with their proof.
fn transfer_pair(data: &Data<'_>, pair: (f64, f64, u32), kind: TransferKind) -> Option<ProvedPair> {
    let up = |value: f64| round_f64(value * (1.0 + 1e-12), SHORT_DIGITS, Direction::Up);
    match kind {
        TransferKind::ClosedForm => {
            let (k0, k1) = closed_form_pair(data);
            Some((upper(&k0, SHORT_DIGITS)?, upper(&k1, SHORT_DIGITS)?, TransferProof::ClosedForm))
        }
        TransferKind::Matched => Some((up(pair.0)?, up(pair.1)?, TransferProof::Matched { k: pair.2 })),
        TransferKind::Boxes => {
            // The sampled curve may be a little low: take the first pair above it that can be proved.
            let (k0, k1, proof) = prove_above(data, pair.0, pair.1, SHORT_DIGITS)?;
            Some((k0, k1, TransferProof::Boxes(proof)))
        }
    }
}

/// k0 and k1 with their proof.
pub(super) type ProvedPair = (Rational, Rational, TransferProof);

/// The room between both sides of S1 and S2 that numbers of so many digits need: a hundred times their last digit.
pub(super) fn room(digits: u32) -> f64 {
    if digits == SHORT_DIGITS { 1e-6 } else { 1e-12 }
}

/// Rounds a sharp proposal and decides it, at the gain that is given where one is.
pub(super) fn round_sharp(
    data: &Data<'_>,
    model: &FloatModel,
    proposal: &SharpProposal,
    (kind, given): (TransferKind, Option<&Rational>),
    ladder: Ladder,
) -> Option<SharpProof> {
    let mut known = None;
    let mut pair = |found: (f64, f64, u32)| {
        // The slack does not move the pair, nor the boxes that prove it.
        if known.as_ref().is_none_or(|(pair, _)| *pair != found) {
            known = Some((found, transfer_pair(data, found, kind)));
        }
        known.as_ref().and_then(|(_, proved)| proved.clone())
    };
    first_proved(data, ladder, |(digits, slack)| {
        let sigma = given.cloned().or_else(|| rounded_sigma(proposal.sigma, slack))?;
        sharp_witness(data, model, (proposal, sigma), &mut pair, (digits, slack))
    })
}

fn sharp_witness(
    data: &Data<'_>,
    model: &FloatModel,
    (proposal, sigma): (&SharpProposal, Rational),
    pair: &mut dyn FnMut((f64, f64, u32)) -> Option<ProvedPair>,
    (digits, slack): (u32, f64),
) -> Option<SharpWitness> {
    let (found, at) = at_sigma(model, &proposal.parameters, sigma.to_f64(), room(digits)).ok()?;
    let (k0, k1, transfer) = pair(found.pair)?;

    let up = |value: f64| round_f64(value, digits, Direction::Up);
    let squares = |r: &MeanSquares<f64>| Some(MeanSquares { x: up(r.x)?, e: up(r.e)?, e_rate: up(r.e_rate)? });
    let (x_p, e_p, kap) = (up(found.x_p)?, up(found.e_p)?, nearest(found.kap, LONG_DIGITS)?);
    let existence = squares(&found.squares)?;
    let refined = match &found.refined {
        Some(refined) => Some(squares(refined)?),
        None => None,
    };
    let origin = AtOrigin::new(data);
    let gain = data.rational(&sigma);
    let gains = ErrorGains::new(data, &gain).with_energy(energy::proved(data, &origin, &gain));
    let bounds = SetBounds::new(data, data.rational(&x_p), data.rational(&e_p));
    let at_the_solution = refined.as_ref().unwrap_or(&existence).map(|value| data.rational(value));
    let periodic = PeriodicSize::new(data, &bounds, &origin, &gains, &at_the_solution);
    let z = gains.z_squared(data, &periodic.forcing, [&data.rational(&k0), &data.rational(&k1)]).sqrt();
    let set = claimed_set(data, &x_p, &e_p, &z)?;

    // From the claimed set itself, which is rounded up; the candidate's own distances keep its floors.
    let [dist_x, dist_e, dist_z] =
        claimed_distances(data, &set, [&periodic.x_per, &periodic.e_per, &z]).map(|distance| distance.upper_f64());
    let d_x = at.d_x.max(at.rho * model.c * dist_x);
    let far = [at.dist_e.max(dist_e), at.dist_z.max(model.weighed(dist_z))];
    let box_of =
        |[w_x, h]: [&Rational; 2]| box_with(model, [w_x, h], [d_x / (at.rho * model.c), far[0], far[1]], slack);
    let given = model.by_matrix.as_ref().and_then(ByMatrix::weights).map(box_of);
    let RoundedBox { d_x, d_e, w_x, h } =
        given.unwrap_or_else(|| rounded_box(model, d_x, at.rho, far, at.eta, slack))?;
    let MeanSquares { x: r_x, e: r_e, e_rate: r_d } = existence;
    Some(SharpWitness {
        sigma,
        x_p,
        e_p,
        r_x,
        r_e,
        r_d,
        kap,
        refined,
        d_x,
        d_e,
        w_x,
        h,
        k0,
        k1,
        transfer,
        set,
        paths: at.paths,
    })
}

/// D_x, D_e, w_x, h of an error box whose level condition holds with a small slack after rounding.
pub(super) struct RoundedBox {
    pub(super) d_x: Rational,
    pub(super) d_e: Rational,
    pub(super) w_x: Rational,
    pub(super) h: Rational,
}

pub(super) fn rounded_box(
    model: &FloatModel,
    d_x: f64,
    rho: f64,
    [dist_e, dist_z]: [f64; 2],
    eta: f64,
    slack: f64,
) -> Option<RoundedBox> {
    let d_x = nearest(d_x, LONG_DIGITS)?;
    let level = active_level(eta, dist_e, rho) * enlargement(slack);
    let width = d_x.to_f64();
    Some(RoundedBox {
        d_e: nearest(level.sqrt(), LONG_DIGITS)?,
        w_x: nearest(level / (model.p_low * width * width), LONG_DIGITS)?,
        h: nearest(weight_h(eta, dist_e, dist_z), LONG_DIGITS)?,
        d_x,
    })
}

/// The same with weights that are given: the least box of their level.
pub(super) fn box_with(
    model: &FloatModel,
    [w_x, h]: [&Rational; 2],
    distances: [f64; 3],
    slack: f64,
) -> Option<RoundedBox> {
    let [dist_x, dist_e, dist_z] = distances;
    let of_x = w_x.to_f64() * model.p_up * dist_x * dist_x;
    let level = (of_x + dist_e * dist_e + h.to_f64() * dist_z * dist_z) * enlargement(slack);
    Some(RoundedBox {
        d_x: nearest((level / (w_x.to_f64() * model.p_low)).sqrt(), LONG_DIGITS)?,
        d_e: nearest(level.sqrt(), LONG_DIGITS)?,
        w_x: w_x.clone(),
        h: h.clone(),
    })
}

/// Enough for rounding, and well below the room that candidates keep.
fn enlargement(slack: f64) -> f64 {
    1.0 + (0.1 * slack).clamp(1e-11, 1e-7)
}

/// Rounds a repaired proposal and decides it.
pub(super) fn round_repaired(
    data: &Data<'_>,
    model: &FloatModel,
    proposal: &RepairedProposal,
    ladder: Ladder,
) -> Option<RepairedProof> {
    first_proved(data, ladder, |attempt| repaired_witness(data, model, proposal, attempt))
}

fn repaired_witness(
    data: &Data<'_>,
    model: &FloatModel,
    proposal: &RepairedProposal,
    (digits, slack): (u32, f64),
) -> Option<RepairedWitness> {
    let x = nearest(proposal.x, digits)?;
    let e = rounded_e(proposal.e, largest_e_repaired(model, x.to_f64())?, digits)?;
    let (k0, k1, transfer) = transfer_pair(data, (0.0, 0.0, 0), TransferKind::ClosedForm)?;
    let bounds = PeriodicBounds::new(data, data.rational(&x), data.rational(&e));
    let [kappa_0, kappa_1] = data.kappas(&data.rational(&k0), &data.rational(&k1));
    let z = bounds.z_squared_printed(data, &kappa_0, &kappa_1).sqrt();
    let set = claimed_set(data, &x, &e, &z)?;
    let h = nearest(proposal.h, LONG_DIGITS)?;
    let [dist_x, dist_e, dist_z] = claimed_distances(data, &set, [&data.rational(&x), &data.rational(&e), &z]);
    let start = &data.p_up * dist_x.sqr() + dist_e.sqr() + data.rational(&h) * dist_z.sqr();
    let level = start.upper_rational()? * Rational::from_f64(1.0 + 1e-11)?;
    let sigma = rounded_sigma(proposal.sigma, slack)?;
    let [p_x, p_e] = perron_repaired(model, x.to_f64(), e.to_f64(), sigma.to_f64());
    let scale = p_x.max(p_e);
    Some(RepairedWitness {
        sigma,
        level: round_rational(&level, LONG_DIGITS, Direction::Up),
        h,
        p_x: nearest(p_x / scale, LONG_DIGITS)?,
        p_e: nearest(p_e / scale, LONG_DIGITS)?,
        x,
        e,
        k0,
        k1,
        transfer,
        set,
    })
}

/// Searches and decides exact regulation for a claimed set; `None` when nothing was proved.
pub(super) fn exact_claim(data: &Data<'_>, model: &FloatModel, set: &ClaimedSet, ladder: Ladder) -> Option<ExactClaim> {
    let z = steady_state_norm(data);
    let [dist_x, dist_e, dist_z] =
        claimed_distances(data, set, [&data.zero(), &data.zero(), &z]).map(|distance| distance.upper_f64());
    // Floors keep the box open where a distance is 0.
    let scale = if dist_e > 0.0 { dist_e } else { 1.0 };
    let dist_x = if dist_x > 0.0 { dist_x } else { scale * 1e-6 };
    let dist_e = if dist_e > 0.0 { dist_e } else { dist_x * 1e-6 };
    let dist_z = model.weighed(dist_z.max(1e-6 * model.n_bar * dist_e));
    let at = search_exact(model, [dist_x, dist_e, dist_z]).ok()?;
    SLACKS.iter().find_map(|&slack| {
        let given = model.by_matrix.as_ref().and_then(ByMatrix::weights);
        let given = given.map(|weights| box_with(model, weights, [dist_x, dist_e, dist_z], slack));
        let RoundedBox { d_x, d_e, w_x, h } =
            given.unwrap_or_else(|| rounded_box(model, at.d_x, at.rho, [dist_e, dist_z], at.eta, slack))?;
        let witness = ExactWitness { sigma: rounded_sigma(at.threshold, slack)?, d_x, d_e, w_x, h, paths: at.paths };
        let evaluation = decide_exact(data.spec, set, &witness, ladder);
        evaluation.truth().is_true().then_some(ExactClaim { witness, evaluation })
    })
}
