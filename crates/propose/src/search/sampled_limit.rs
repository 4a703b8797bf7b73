//! What keeps the sampling period, or the gain, of the law at samples from being better; in floating point, claimed by nothing.

use super::candidate::Shape;
use super::effort::ROOM;
use super::form_radius::radius;
use super::sampled::{LARGEST, SampledProposal, SampledSearch};
use super::sharp::search_sharp;
use sigmastar_theory::derivation::sampled::Part;

/// By what share a gain would have to be smaller without what the sampling does, for a part of that to limit it; how far down gains
/// without a part are sought, and in how many steps.
const WORTH_SAYING: f64 = 0.05;
const LEAST_SHARE: f64 = 0.1;
const SHARE_STEPS: usize = 10;

/// What keeps the sampling period, or the gain, from being better.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SampledLimit {
    /// S2.
    Existence,
    /// Q_0, which the continuous-time law has too.
    Continuous,
    /// theta in Q_h.
    Theta,
    /// h sigma in Q_h.
    Hold,
    /// h k_e and h k_x in Q_h.
    Motion,
    /// The matrix inequality, which is in the place of Q_0 and Q_h.
    Matrix,
}

impl SampledLimit {
    /// Its name in JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            SampledLimit::Existence => "existence",
            SampledLimit::Continuous => "gain",
            SampledLimit::Theta => "theta",
            SampledLimit::Hold => "hold",
            SampledLimit::Motion => "motion",
            SampledLimit::Matrix => "matrix",
        }
    }

    /// What it is, and what helps.
    #[must_use]
    pub fn describe(self) -> &'static str {
        match self {
            SampledLimit::Existence => "S2: the periodic solution; a shorter sampling period or a larger gain helps",
            SampledLimit::Continuous => {
                "Q_0: the gain itself, by norms as in continuous time; a larger gain (up to h sigma = 1) or sharper data help"
            }
            SampledLimit::Theta => {
                "theta = h mu Nbar^2/2 in Q_h: what the oscillators lose to the sampling; a smaller mu or a shorter sampling \
                 period helps"
            }
            SampledLimit::Hold => {
                "h sigma in Q_h: e is held over a sample; a shorter sampling period or a smaller gain helps"
            }
            SampledLimit::Motion => {
                "h dq/de and h dq/dx in Q_h: how far q changes within a sample; a shorter sampling period helps, or a smaller initial set if q is \
                 steeper further out"
            }
            SampledLimit::Matrix => {
                "the matrix inequality over the derivatives; a larger gain or a shorter sampling period helps, or a smaller initial set if the \
                 derivatives vary"
            }
        }
    }
}

impl SampledSearch<'_> {
    /// What limits a witness: the part of the forms without which the smallest gain would be least. Where a gain that is smaller by a share
    /// that matters would not do in continuous time either, it is the gain itself; where it has no periodic solution, that; where the given
    /// one does with room, the part without which there would be most.
    #[must_use]
    pub fn limit(&self, proposal: &SampledProposal) -> SampledLimit {
        const PARTS: [(Part, SampledLimit); 3] = [
            (Part::Theta, SampledLimit::Theta),
            (Part::Hold, SampledLimit::Hold),
            (Part::Motion, SampledLimit::Motion),
        ];
        if self.model.at_samples.stability.is_some() {
            return SampledLimit::Matrix;
        }
        let given = proposal.sigma;
        let smaller = given * (1.0 - WORTH_SAYING);
        if search_sharp(self.model).is_ok_and(|found| smaller < found.sigma) {
            return SampledLimit::Continuous;
        }
        let Some([_, end]) = self.radii(smaller, proposal, None) else { return SampledLimit::Existence };
        // No gain is above 1/h.
        if end <= LARGEST && given * self.law.step > 1.0 - 1e-6 {
            return SampledLimit::Hold;
        }
        let cost = |part: Part| {
            if end <= LARGEST {
                return self.radii(given, proposal, Some(part)).map_or(f64::INFINITY, |[_, end]| end);
            }
            let does = |sigma: f64| {
                let radii = self.radii(sigma, proposal, Some(part));
                radii.is_some_and(|radii| radii.iter().all(|radius| *radius <= LARGEST))
            };
            let (mut below, mut above) = (given * LEAST_SHARE, given);
            for _ in 0..SHARE_STEPS {
                let middle = (below * above).sqrt();
                if does(middle) { above = middle } else { below = middle }
            }
            above
        };
        let costs = PARTS.map(|(part, limit)| (cost(part), limit));
        costs.into_iter().min_by(|a, b| a.0.total_cmp(&b.0)).map_or(SampledLimit::Continuous, |(_, limit)| limit)
    }

    /// The radii of the forms near the shape of a proposal, at another gain and without a part; `None` where that gain has no periodic
    /// solution.
    fn radii(&self, sigma: f64, near: &SampledProposal, without: Option<Part>) -> Option<[f64; 2]> {
        let (set, at) = self.at(sigma, near.floors, Some((near.rho, near.eta)), ROOM).ok()?;
        let shape = Shape::of(self.model, (set.x_per, set.e_per), &at);
        let gm = at.past.map_or(0.0, |past| past.weight(at.eta, at.dist_e));
        let forms = self.forms(sigma, (&shape, gm), without);
        Some([&forms.start, &forms.end].map(|form| radius(form).unwrap_or(f64::INFINITY)))
    }
}
