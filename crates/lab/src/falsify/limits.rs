//! What the bounding functions of a claim allow, in double precision: sizes at which plants are drawn.

use super::claim::TriedClaim;
use sigmastar_lang::spec::Specification;
use sigmastar_theory::data::Bound;

/// What is kept of a bounding function at first.
pub(super) const SHARE: f64 = 0.98;

/// The bounding functions of a claim up to its reach. Nothing here decides.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits<'c> {
    spec: &'c Specification,
    /// The largest |x| and |e|.
    pub reach: [f64; 2],
}

/// The positive part, which is what a bounding function of a norm is; NaN stays.
pub(super) fn positive(value: f64) -> f64 {
    if value < 0.0 { 0.0 } else { value }
}

impl<'c> Limits<'c> {
    pub fn new(claim: &'c TriedClaim) -> Limits<'c> {
        Limits { spec: &claim.spec, reach: claim.reach.each_ref().map(rug::Rational::to_f64) }
    }

    /// The value of a bounding function or of its replacement, as it is written; infinite where there is neither.
    pub fn at(&self, which: Bound, x: f64, e: f64) -> f64 {
        which.of(self.spec).map_or(f64::INFINITY, |expr| expr.to_float().eval(x, e))
    }

    /// What is kept of its value at the origin.
    pub fn at_zero(&self, which: Bound) -> f64 {
        SHARE * positive(self.at(which, 0.0, 0.0))
    }

    /// What is kept of its slope in X, where it is linear.
    pub fn slope(&self, which: Bound) -> f64 {
        let small = self.reach[0] * 1e-3;
        let value = |x: f64| {
            let value = self.at(which, x, 0.0);
            if which.is_signed() { value } else { positive(value) }
        };
        SHARE * ((value(small) - value(0.0)) / small).max(0.0)
    }

    /// What dq/de may be at the origin.
    pub fn sector(&self) -> Sector {
        let norm = positive(self.at(Bound::Qe, 0.0, 0.0));
        let own = self.spec.bounds.own(Bound::QeMax).is_some();
        Sector { norm, above: if own { self.at(Bound::QeMax, 0.0, 0.0).min(norm) } else { norm }, one_sided: own }
    }
}

/// The end of the sector of dq/de that a linear plant takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SectorEnd {
    /// dq/de as large as it may be: m(0,0), which may be negative.
    Upper,
    /// As small as it may be: -b_qe(0,0).
    Lower,
}

/// The values -norm to `above` of dq/de at the origin: `above` is b_qe, or the smaller one of it and m.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sector {
    pub norm: f64,
    pub above: f64,
    /// Whether m is given.
    pub one_sided: bool,
}

impl Sector {
    /// The damping of its middle.
    pub fn damping(&self) -> f64 {
        positive(0.5 * (self.norm - self.above))
    }

    /// Half of its width.
    pub fn half_width(&self) -> f64 {
        positive(0.5 * (self.norm + self.above))
    }

    /// The least damping of a plant in it, enough for all X and E: m is nondecreasing.
    pub fn least_damping(&self) -> f64 {
        positive(-self.above)
    }
}
