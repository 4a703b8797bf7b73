//! What is proved at one gain, for each number of oscillators and each set of harmonics that is asked about.

use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_lang::spec::Oscillators;
use sigmastar_prove::certify::{BoundsOfCount, Stated, UnderNoise};
use sigmastar_prove::reduction::Run;

/// A gain with which everything in its cells is proved, each an upper bound for every solution from the initial set there, in the loop without noise but for what
/// says otherwise. Where
/// the certificate of the gain has a bound, it is the number that stands there.
#[derive(Clone, Debug)]
pub struct Row {
    /// The gain.
    pub sigma: Rational,
    /// E0 of the initial set. Where the document states no sizes they go with the gain.
    pub e0: Rational,
    /// One for each number of oscillators or set of harmonics, those with the fewest oscillators first.
    pub cells: Vec<Cell>,
}

/// What is proved with given oscillators.
#[derive(Clone, Debug)]
pub struct Cell {
    /// The oscillators.
    pub oscillators: Oscillators,
    /// Of |e| along the periodic solution.
    pub steady_error: Enclosure,
    /// Of |e| at all times.
    pub peak_error: Enclosure,
    /// Whether these two are in the certificate, so that the independent checker decides them; the others are.
    pub are_in_certificate: [bool; 2],
    /// Of what is put out at all times.
    pub control: Enclosure,
    /// Of what is put out along the periodic solution.
    pub steady_control: Enclosure,
    /// The rate in 1/time, and the factor in the unit of e, where they are proved: `|e - e_per| <= factor exp(-rate (t - t_0))`, at samples at the
    /// sampling instants.
    pub decay: Option<Decay>,
    /// What is proved of the loop with the noise, disturbance and rounding of the document.
    pub noise: Noise,
    /// What simulations of the nominal plant came to; it proves nothing.
    pub simulated: Option<Simulated>,
}

/// What is proved of a loop with noise.
#[derive(Clone, Debug)]
pub enum Noise {
    /// The document has none, or none of which anything may be proved: the loop is the one without.
    Absent,
    /// Nothing.
    NotProved,
    /// Upper bounds.
    Proved(Box<UnderNoise>),
}

/// An exponential bound.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Decay {
    /// In 1/time.
    pub rate: Rational,
    /// In the unit of e.
    pub factor: Rational,
}

/// Figures of simulations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Simulated {
    /// sup|e| of the periodic solution.
    pub steady_error: f64,
    /// The largest |e| and |u| of the runs from the initial set that were tried; none where a run was not finished.
    pub largest: Option<[f64; 2]>,
    /// After how many periods |e| is at most the required steady error for good in them; none where nothing is required, or they do not say.
    pub settling: Option<f64>,
}

impl Row {
    /// What a run proves at its gain, its rates included, for these oscillators, those with the fewest first; `None` where nothing is certified. Hypothesis: the
    /// claim is about all of them.
    #[must_use]
    pub fn of(run: &Run<'_>, asked: &[Oscillators]) -> Option<Row> {
        let certified = run.certified()?;
        let said = run.of_counts();
        let counts_noise = run.counts_noise();
        let cell = |oscillators: &Oscillators| {
            let BoundsOfCount { steady_error, peak_error, control, steady_control, .. } = run.bounds_of(oscillators)?;
            let noise = match run.under_noise(oscillators) {
                Some(found) => Noise::Proved(Box::new(found)),
                None if counts_noise => Noise::NotProved,
                None => Noise::Absent,
            };
            // What holds with noise holds without.
            let with_noise = if let Noise::Proved(found) = &noise { Some(&found.peak_error) } else { None };
            let peak_error = match with_noise.filter(|with_noise| with_noise.lt(&peak_error.bound).is_true()) {
                Some(bound) => Stated { bound: bound.clone(), is_in_certificate: false },
                None => peak_error,
            };
            let said = said.iter().find(|said| said.oscillators == oscillators);
            Some(Cell {
                oscillators: oscillators.clone(),
                are_in_certificate: [steady_error.is_in_certificate, peak_error.is_in_certificate],
                steady_error: steady_error.bound,
                peak_error: peak_error.bound,
                control,
                steady_control,
                decay: said.map(|said| Decay { rate: said.rate.clone(), factor: said.factor.clone() }),
                noise,
                simulated: None,
            })
        };
        let cells = asked.iter().map(cell).collect::<Option<_>>()?;
        Some(Row { sigma: certified.sigma.clone(), e0: certified.set.e0.clone(), cells })
    }
}

impl Cell {
    /// The flag of `controller` and others: "--n-o 3", or "--harmonics 0,1,5".
    #[must_use]
    pub fn flag(&self) -> String {
        let all = || self.oscillators.all().map(|harmonic| harmonic.to_string()).collect::<Vec<_>>().join(",");
        self.oscillators.n_o().map_or_else(|| format!("--harmonics {}", all()), |n_o| format!("--n-o {n_o}"))
    }

    /// S of the loop with noise, where it is proved.
    #[must_use]
    pub fn noise_limit(&self) -> Option<&Rational> {
        match &self.noise {
            Noise::Proved(found) => Some(&found.limit),
            Noise::Absent | Noise::NotProved => None,
        }
    }

    /// Of |e| in the end and at all times in the loop as the document has it, with its noise; `None` where nothing is proved of that.
    #[must_use]
    pub fn in_all(&self) -> Option<[&Enclosure; 2]> {
        match &self.noise {
            Noise::Absent => Some([&self.steady_error, &self.peak_error]),
            Noise::NotProved => None,
            Noise::Proved(found) => Some([&found.steady_error, &found.peak_error]),
        }
    }

    /// The same of what is put out at all times.
    #[must_use]
    pub fn control_in_all(&self) -> Option<&Enclosure> {
        match &self.noise {
            Noise::Absent => Some(&self.control),
            Noise::NotProved => None,
            Noise::Proved(found) => found.control.as_ref(),
        }
    }

    /// After how many periods |e| is at most a limit for good, at samples at the sampling instants, at most: `log(factor/(limit - steady error))/(rate T)`, or 0 where the factor is at most
    /// that difference; with noise the steady error has its limit, and the factor what misleads an aligned start. `None` where no rate is proved, or the
    /// steady error is not proved to be below the limit. Hypothesis: `period` is positive, and no period of the document is shorter.
    #[must_use]
    pub fn settling(&self, limit: &Rational, period: &Enclosure) -> Option<Enclosure> {
        let Decay { rate, factor } = self.decay.as_ref()?;
        let precision = period.precision();
        let exact = |value: &Rational| Enclosure::from_rational(value, precision);
        let [steady, _] = self.in_all()?;
        let misled = match &self.noise {
            Noise::Proved(found) => exact(&found.misled),
            Noise::Absent | Noise::NotProved => exact(&Rational::new()),
        };
        let room = &exact(limit) - steady;
        if !room.is_positive().is_true() || !exact(rate).is_positive().is_true() {
            return None;
        }
        let ratio = (&exact(factor) + misled) / &room;
        let least = ratio.max(&exact(&Rational::from(1)));
        Some(&least.log() / &(&exact(rate) * period))
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A cell with these bounds of the steady error, the peak and the control, without a rate.
    pub fn cell(n_o: u32, [steady_error, peak_error, control]: [f64; 3]) -> Cell {
        let bound = Enclosure::exactly;
        Cell {
            oscillators: n_o.into(),
            steady_error: bound(steady_error),
            are_in_certificate: [true; 2],
            peak_error: bound(peak_error),
            control: bound(control),
            steady_control: bound(control),
            decay: None,
            noise: Noise::Absent,
            simulated: None,
        }
    }

    /// The same with a rate and a factor.
    pub fn falling(cell: Cell, rate: (u32, u32), factor: (u32, u32)) -> Cell {
        Cell { decay: Some(Decay { rate: rate.into(), factor: factor.into() }), ..cell }
    }

    /// The same with noise that adds this in the limit, and to an aligned start, and 7 to the control.
    pub fn noisy(cell: Cell, limit: (u32, u32), misled: u32) -> Cell {
        let (limit, misled) = (Rational::from(limit), Rational::from(misled));
        let add = |bound: &Enclosure, more: &Rational| bound + Enclosure::from_rational(more, 64);
        let steady_error = add(&cell.steady_error, &limit);
        let peak_error = add(&cell.peak_error, &Rational::from(&limit + &misled));
        let control = Some(add(&cell.control, &Rational::from(7)));
        Cell { noise: Noise::Proved(Box::new(UnderNoise { limit, misled, steady_error, peak_error, control })), ..cell }
    }

    #[test]
    fn settling_is_what_the_exponential_bound_says() {
        let period = Enclosure::exactly(0.5);
        let of = |cell: &Cell, limit: (u32, u32)| cell.settling(&limit.into(), &period).map(|found| found.upper_f64());
        let falls = falling(cell(0, [1.0, 9.0, 1.0]), (2, 1), (8, 1));
        // 1 + 8 exp(-2 t) is 3 at t = log 4/2, and one period is 0.5.
        let found = of(&falls, (3, 1)).unwrap();
        assert!((found - 4f64.ln()).abs() < 1e-12 && found >= 4f64.ln(), "{found}");
        // At once; never to what the periodic solution has.
        assert_eq!(of(&falls, (9, 1)), Some(0.0));
        assert_eq!(of(&falls, (20, 1)), Some(0.0));
        assert_eq!([of(&falls, (1, 1)), of(&falls, (1, 2)), of(&cell(0, [1.0, 9.0, 1.0]), (3, 1))], [None; 3]);
        // With noise 3/2 + (8 + 1) exp(-2 t) is 3 at t = log 6/2; where nothing is proved of it, nothing is of the time.
        let found = of(&noisy(falls.clone(), (1, 2), 1), (3, 1)).unwrap();
        assert!((found - 6f64.ln()).abs() < 1e-12, "{found}");
        assert_eq!(of(&noisy(falls.clone(), (2, 1), 0), (3, 1)), None);
        assert_eq!(of(&Cell { noise: Noise::NotProved, ..falls }, (3, 1)), None);
    }
}
