//! The smallest X_p and E_p of a search, where nothing in the data gives them a size.

use super::model::FloatModel;
use super::obstacle::Obstacle;
use super::periodic::Floors;

/// The share of an ordinary size below which a set is as good as a point.
const TINY: f64 = 1e-40;

/// Shares of the ordinary size that are tried where nothing else gives X_p or E_p a size, the largest first.
const SHARES: [f64; 10] = [1.0, 1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-13, 1e-17, 1e-22, 1e-30];

/// X_p and E_p of ordinary size: those of the initial set or of the domain, where there is one.
pub(super) fn ordinary(model: &FloatModel) -> Floors {
    let [x0, e0] = model.set.given();
    let size = |start: Option<&f64>, domain: f64| {
        let size = start.copied().filter(|size| *size > 0.0).unwrap_or(1.0);
        size.min(0.1 * domain)
    };
    Floors { x_p: size(x0, model.domain.0), e_p: size(e0, model.domain.1) }
}

/// Floors that are as good as none.
pub(super) fn tiny(model: &FloatModel) -> Floors {
    let Floors { x_p, e_p } = ordinary(model);
    Floors { x_p: TINY * x_p, e_p: TINY * e_p }
}

/// Where nothing in the data asks for an X_p or E_p above the smallest one, the largest of a few that are worth what they cost: an
/// initial set that follows from it is then worth something.
///
/// `size` is X_p and E_p at some floors; `again` what is found with others, where that is accepted.
///
/// # Errors
/// Those of `size`.
pub(super) fn raised<T>(
    start: (Floors, T),
    ordinary: Floors,
    size: impl Fn(Floors, &T) -> Result<[f64; 2], Obstacle>,
    again: impl Fn(Floors, &T) -> Option<T>,
) -> Result<(Floors, T), Obstacle> {
    let (mut floors, mut found) = start;
    for side in [0, 1] {
        if size(floors, &found)?[side] > [floors.x_p, floors.e_p][side] {
            continue;
        }
        let raised = SHARES.into_iter().find_map(|share| {
            let floors = match side {
                0 => Floors { x_p: share * ordinary.x_p, ..floors },
                _ => Floors { e_p: share * ordinary.e_p, ..floors },
            };
            again(floors, &found).map(|found| (floors, found))
        });
        if let Some(raised) = raised {
            (floors, found) = raised;
        }
    }
    Ok((floors, found))
}
