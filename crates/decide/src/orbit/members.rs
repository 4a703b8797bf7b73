//! The members of a family of plants and the curve that follows them (derivation, 13.2), in enclosures. A single plant is a
//! family of no parameters.

use super::cells::{PRECISION, Wave, waves};
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::OrbitCurve;

/// The parameters of which intervals are known, over all of these and at the nominal values.
#[derive(Clone, Debug)]
pub(super) struct ParameterBox {
    /// p_i.
    pub(super) values: Vec<Enclosure>,
    /// p_i^0.
    pub(super) nominal: Vec<Enclosure>,
    /// `p_i - p_i^0`.
    pub(super) deviations: Vec<Enclosure>,
    /// The largest `|p_i - p_i^0|`.
    pub(super) reaches: Vec<Enclosure>,
    /// Which of them is the clock.
    pub(super) clock: Option<usize>,
}

impl ParameterBox {
    pub(super) fn new(plant: &Plant) -> ParameterBox {
        let [values, nominal, deviations, reaches] = [const { Vec::new() }; 4];
        let mut all = ParameterBox { values, nominal, deviations, reaches, clock: plant.parameters.clock() };
        for interval in plant.parameters.intervals() {
            let [low, high] = interval.deviations();
            all.values.push(Enclosure::between(&interval.low, &interval.high, PRECISION));
            all.nominal.push(Enclosure::from_rational(&interval.nominal, PRECISION));
            all.reaches.push(Enclosure::from_rational(&interval.reach(), PRECISION));
            all.deviations.push(Enclosure::between(&low, &high, PRECISION));
        }
        all
    }
}

impl ParameterBox {
    /// T of all members, from what it is nominally.
    pub(super) fn elapsed(&self, period: &Enclosure) -> Enclosure {
        self.clock.map_or_else(|| period.clone(), |clock| period / &self.values[clock])
    }

    /// Two boxes that cover this one, halves along the parameter of which most is left; none where there is nothing to halve.
    pub(super) fn halves(&self) -> Option<[ParameterBox; 2]> {
        let left = |i: &usize| {
            let (deviation, reach) = (&self.deviations[*i], self.reaches[*i].upper_f64());
            (deviation.upper_f64() - deviation.lower_f64()) / reach
        };
        let at = (0..self.deviations.len()).max_by(|i, j| left(i).total_cmp(&left(j)))?;
        let [low, high] = [self.deviations[at].lower_rational()?, self.deviations[at].upper_rational()?];
        let middle = Rational::from(&low + &high) / 2;
        Some([(&low, &middle), (&middle, &high)].map(|(from, to)| {
            let mut half = self.clone();
            half.deviations[at] = Enclosure::between(from, to, PRECISION);
            // From the deviation, so that both are of the same members.
            half.values[at] = &half.nominal[at] + &half.deviations[at];
            half
        }))
    }
}

/// The curve, and what moves it.
#[derive(Clone, Debug)]
pub(super) struct Members {
    /// The centre, one wave for each state.
    pub(super) waves: Vec<Wave>,
    /// One list of waves for each parameter.
    pub(super) sensitivities: Vec<Vec<Wave>>,
    pub(super) parameters: ParameterBox,
}

impl Members {
    pub(super) fn new(plant: &Plant, orbit: &OrbitCurve) -> Members {
        Members {
            waves: waves(&orbit.centre),
            sensitivities: orbit.sensitivities.iter().map(waves).collect(),
            parameters: ParameterBox::new(plant),
        }
    }

    /// The centre and the sensitivities.
    pub(super) fn all(&self) -> impl Iterator<Item = &Wave> {
        self.waves.iter().chain(self.sensitivities.iter().flatten())
    }

    /// The most harmonics.
    pub(super) fn harmonics(&self) -> usize {
        self.all().map(|wave| wave.harmonics.len()).max().unwrap_or(0)
    }
}
