//! Making a family of plants smaller until it is proved to lie within the bounding functions.

use super::claim::TriedClaim;
use super::contraction;
use super::family::{Family, FamilyBound};
use super::forcing;
use super::limits::{Limits, positive};
use super::membership::respects;
use super::shape::{Number, Shape};
use sigmastar_exact::number::Portable;
use sigmastar_lang::expr::{Expr, Variables};
use sigmastar_theory::data::Bound;

/// What is kept of a coefficient that is too large.
const FACTOR: f64 = 0.93;

/// What is kept of a bounding function in the end.
const ROOM: f64 = 0.99;

/// Points of each side of the grid on which that is looked at.
const GRID: i32 = 40;

/// Times that a plant is made smaller before it is given up.
const ATTEMPTS: usize = 60;

/// The bounding functions that the specification of a claim has, but for the rate. They are met in this order: the damping,
/// which also lowers dq/de, is made smaller for q only, and that comes before `q_e_max`.
fn conditions(claim: &TriedClaim) -> impl Iterator<Item = (Bound, &Expr)> {
    claim.spec.bounds.named().filter(|(bound, _)| *bound != Bound::Rate)
}

/// Whether a bound of a family is proved to be at most a bounding function, up to the reach of a claim.
fn is_met(bound: Bound, by: &FamilyBound, allowed: &Expr, claim: &TriedClaim, left: &mut u64) -> bool {
    respects(bound, &by.text(), allowed, &claim.reach, left)
}

/// Whether a family is proved to be as the specification says where no coefficient has a say in it.
fn is_admissible(family: &Family, claim: &TriedClaim, left: &mut u64) -> bool {
    forcing::is_within(family, claim) && contraction::is_met(family, claim, left)
}

/// Whether a family is proved to lie within the families of a claim, with the operations that are `left`.
pub(super) fn fits(family: &Family, claim: &TriedClaim, left: &mut u64) -> bool {
    is_admissible(family, claim, left)
        && conditions(claim)
            .all(|(bound, allowed)| family.bound(bound).is_some_and(|by| is_met(bound, &by, allowed, claim, left)))
}

/// Makes a family smaller until nothing exceeds what is allowed; false where that is not proved of any size with the
/// operations that are `left`.
pub(super) fn fit(family: &mut Family, claim: &TriedClaim, left: &mut u64) -> bool {
    let limits = Limits::new(claim);
    // A little more than it has to be, as nine digits are exact to 5e-9.
    let least_damping = Number::new(limits.sector().least_damping() * (1.0 + 1e-8));
    // A bound only falls as coefficients become smaller, so what fits once need not be looked at again.
    let fits = conditions(claim).all(|(bound, allowed)| {
        (0..ATTEMPTS).any(|_| {
            let Some(by) = family.bound(bound) else { return false };
            // The norm of F is given, so f may have no room to spare.
            let room = bound == Bound::F || leaves_room(bound, &by, allowed, limits.reach);
            let fits = room && is_met(bound, &by, allowed, claim, left);
            if !fits {
                shrink(family, bound, least_damping);
            }
            fits
        })
    });
    fits && is_admissible(family, claim, left)
}

/// Whether the moving part of a bound stays a little below what is allowed of it at the points of a grid, so that the
/// proof is short.
fn leaves_room(which: Bound, bound: &FamilyBound, allowed: &Expr, reach: [f64; 2]) -> bool {
    let parse = |text: &str| Expr::parse(text, Variables::XAndE).map(|expr| expr.to_float());
    let (Ok(moving), Ok(fixed)) = (parse(&bound.moving), parse(bound.fixed.as_deref().unwrap_or("0"))) else {
        return false;
    };
    let allowed = allowed.to_float();
    let along = |end: f64, at: i32| if at == GRID { 0.0 } else { end * 0.8_f64.portable_powi(at) };
    (0..=GRID).all(|i| {
        (0..=GRID).all(|j| {
            let (x, e) = (along(reach[0], i), along(reach[1], j));
            let allowed = allowed.eval(x, e);
            let allowed = if which.is_signed() { allowed } else { positive(allowed) };
            moving.eval(x, e) <= ROOM * (allowed - fixed.eval(x, e))
        })
    })
}

/// Makes smaller what a bounding function does not allow; the damping not below its least value.
fn shrink(family: &mut Family, condition: Bound, least_damping: Number) {
    let smaller = |numbers: &mut [&mut Number]| numbers.iter_mut().for_each(|number| **number = number.times(FACTOR));
    let Family { g, g_1, kappa, beta, damping, c, delta, saturation, harmonics, .. } = family;
    match condition {
        Bound::F | Bound::Fe => {
            g.0.iter_mut().for_each(|part| *part = part.times(FACTOR));
            smaller(&mut [&mut g.1, g_1]);
            if condition == Bound::F {
                smaller(&mut [kappa]);
            }
        }
        Bound::Fxx | Bound::Fx => smaller(&mut [kappa, g_1]),
        Bound::Fex => smaller(&mut [g_1]),
        Bound::Qe | Bound::QeMax | Bound::Qte => smaller(&mut [c, delta]),
        Bound::Qx | Bound::Qtx => smaller(&mut [beta, delta]),
        Bound::Q | Bound::QRms | Bound::Qt | Bound::QtRms => {
            smaller(&mut [beta, c, delta]);
            if let Shape::Tanh(scale) | Shape::Sin(scale) = saturation {
                smaller(&mut [scale]);
            }
            let of_time = matches!(condition, Bound::Qt | Bound::QtRms);
            // Where the damping cannot become smaller, A has to.
            let damped = least_damping.value() > 0.0 && *damping <= least_damping;
            if of_time || damped {
                harmonics.iter_mut().for_each(|harmonic| harmonic.amplitude = harmonic.amplitude.times(FACTOR));
            }
            if !of_time && *damping > least_damping {
                let less = damping.times(FACTOR);
                *damping = if less > least_damping { less } else { least_damping };
            }
        }
        Bound::Rate | Bound::RateExistence => {}
    }
}
