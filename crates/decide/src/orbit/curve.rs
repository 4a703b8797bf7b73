//! Formulas along the curve xb(t): their Taylor series on each cell of the period.

pub(super) use super::cells::PRECISION;
use super::cells::{Cells, Wave};
use super::members::{Members, ParameterBox};
use super::recurrences::combine;
use super::taylor::{Taylor, TaylorAlgebra};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::expr::Walk;
use sigmastar_lang::spec::Constant;

/// xb(t) over the cells of a period.
pub(super) struct Curve {
    pub(super) cells: Cells,
    pub(super) members: Members,
    /// T; with a clock its nominal value, and time is the nominal one.
    pub(super) period: Enclosure,
    /// T of every member.
    pub(super) elapsed: Enclosure,
}

impl Curve {
    /// The curves over `2^exponent` cells; `others` are waves that are to be expanded on them as well, all of them up to `order`.
    pub(super) fn new<'a>(
        members: &'a Members,
        others: impl Iterator<Item = &'a Wave>,
        period: &Constant,
        exponent: u32,
        order: usize,
    ) -> Curve {
        let harmonics = members.all().chain(others).map(|wave| wave.harmonics.len()).max().unwrap_or(0);
        let period = period.enclose(PRECISION);
        Curve {
            elapsed: members.parameters.elapsed(&period),
            period,
            cells: Cells::new(exponent, PRECISION, harmonics, order),
            members: members.clone(),
        }
    }

    /// The states of the nominal plant up to an order about the middle of a cell, and over it.
    pub(super) fn states(&self, cell: usize, order: usize) -> [Vec<Taylor>; 2] {
        let (mut middle, mut over) = (Vec::new(), Vec::new());
        for wave in &self.members.waves {
            let [about, all] = self.cells.expand(wave, cell, order);
            middle.push(about);
            over.push(all);
        }
        [middle, over]
    }

    /// The sensitivities in the same way, for each parameter.
    pub(super) fn sensitivities(&self, cell: usize, order: usize) -> Vec<[Vec<Taylor>; 2]> {
        let of_one = |waves: &Vec<Wave>| {
            let both: Vec<[Taylor; 2]> = waves.iter().map(|wave| self.cells.expand(wave, cell, order)).collect();
            [0, 1].map(|which| both.iter().map(|pair| pair[which].clone()).collect())
        };
        self.members.sensitivities.iter().map(of_one).collect()
    }

    /// The states of the members with these parameters, from those of the nominal plant.
    pub(super) fn of_members(
        &self,
        states: &[Vec<Taylor>; 2],
        sensitivities: &[[Vec<Taylor>; 2]],
        parameters: &ParameterBox,
    ) -> [Vec<Taylor>; 2] {
        let mut all = states.clone();
        for (part, deviation) in sensitivities.iter().zip(&parameters.deviations) {
            for (own, part) in all.iter_mut().zip(part) {
                for (own, part) in own.iter_mut().zip(part) {
                    *own = combine(own, &part.iter().map(|c| c * deviation).collect::<Taylor>(), 1);
                }
            }
        }
        all
    }

    /// The outputs of a walk at e = 0 along the given states and with these parameters, up to an order, about the middle of a cell
    /// and over it.
    pub(super) fn along(
        &self,
        walk: &Walk,
        cell: usize,
        (states, parameters): (&[Vec<Taylor>; 2], &[Enclosure]),
        order: usize,
    ) -> [Vec<Taylor>; 2] {
        let time = self.cells.time(cell, &self.period);
        [0, 1].map(|which| {
            let (time, states) = (&time[which], &states[which]);
            walk.evaluate(&mut TaylorAlgebra { time, states, parameters, order, precision: PRECISION })
        })
    }

    /// Whether the outputs of a walk are proved to be smooth at e = 0, every point of a box of times and states, and every member.
    pub(super) fn in_box(&self, walk: &Walk, time: &Enclosure, states: &[Enclosure]) -> bool {
        // The first coefficient of a series is defined only where the operations are smooth.
        let states: Vec<Taylor> = states.iter().map(|value| vec![value.clone()]).collect();
        let (time, parameters) = (&vec![time.clone()], &self.members.parameters.values);
        let mut algebra = TaylorAlgebra { time, states: &states, parameters, order: 0, precision: PRECISION };
        walk.evaluate(&mut algebra).iter().flatten().all(Enclosure::is_defined)
    }
}
