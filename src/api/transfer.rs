//! The transfer bound by itself.

use super::error::{Error, ErrorKind};
use super::report::Report;
use super::subject::Subject;
use super::{positive, rounded_up};
use rug::Rational;
use sigmastar_document::plot::Figure;
use sigmastar_exact::enclosure::DEFAULT_PRECISION;
use sigmastar_exact::number::write_exact;
use sigmastar_lang::spec::Specification;
use sigmastar_prove::reduction::Subject as Read;
use sigmastar_report::{TransferReport, transfer_figure};
use sigmastar_theory::data::Data;
use sigmastar_theory::transfer::{self, CertifiedPair, OscillatorCount, PairChoice, rational_k0, smallest_k1};

pub use sigmastar_theory::transfer::PairError;

/// A proved bound `T_N(x) <= k0 + k1 x^2` of the internal model, for every number of oscillators N >= 0 and every
/// `x = omega/w >= 0`.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct TransferBound {
    k0: String,
    k1: String,
    up: [f64; 2],
    excess: Option<f64>,
}

impl TransferBound {
    /// k0, exactly.
    #[must_use]
    pub fn k0(&self) -> &str {
        &self.k0
    }

    /// k1, exactly.
    #[must_use]
    pub fn k1(&self) -> &str {
        &self.k1
    }

    /// k0 as a double, rounded up: with it the bound holds too.
    #[must_use]
    pub fn k0_f64(&self) -> f64 {
        self.up[0]
    }

    /// k1 as a double, rounded up.
    #[must_use]
    pub fn k1_f64(&self) -> f64 {
        self.up[1]
    }

    /// By how much, relatively, k1 exceeds a proved lower bound of every k1 that would do with this k0; rounded up. `None`
    /// where no such bound is proved.
    #[must_use]
    pub fn excess(&self) -> Option<f64> {
        self.excess
    }

    fn new(data: &Data<'_>, pair: &CertifiedPair) -> TransferBound {
        TransferBound::with(data, pair, &pair.k1)
    }

    /// The same with another k1.
    fn with(data: &Data<'_>, pair: &CertifiedPair, k1: &Rational) -> TransferBound {
        let excess = pair.excess_of(data, k1).map(|excess| excess.upper_f64());
        let up = [rounded_up(&pair.k0), rounded_up(k1)];
        TransferBound { k0: write_exact(&pair.k0), k1: write_exact(k1), up, excess }
    }
}

/// Proves the transfer bound of the internal model of a specification or plant with nearly the smallest k1 for a given k0, an
/// exact positive constant. A k0 that is not rational is rounded up.
///
/// # Errors
/// What is wrong with k0; [`Refuted`](ErrorKind::Refuted) where k0 lies below T_N(0), which the message names;
/// [`Undecided`](ErrorKind::Undecided) where no proof was found within the effort; what keeps the data of a plant from being
/// proved.
///
/// ```no_run
/// # fn run(specification: &sigmastar::Specification) -> Result<(), sigmastar::Error> {
/// let bound = sigmastar::transfer_bound(specification, "20")?;
/// println!("T_N(x) <= {} + {} x^2", bound.k0(), bound.k1());
/// # Ok(())
/// # }
/// ```
pub fn transfer_bound(subject: impl Into<Subject>, k0: &str) -> Result<TransferBound, Error> {
    let k0 = positive("k0", k0)?;
    let exact = rational_k0(&k0, DEFAULT_PRECISION);
    let exact = exact.ok_or_else(|| Error::new(ErrorKind::Overflow, "k0 is too large", "choose a smaller k0"))?;
    let spec = specification(subject.into())?;
    let data = Data::new(&spec, DEFAULT_PRECISION);
    let pair = smallest_k1(&data, &exact).map_err(no_pair)?;
    Ok(TransferBound::new(&data, &pair))
}

/// Which pair (k0, k1) is wanted, and which numbers of oscillators are looked at. The defaults are those of the command
/// `sigmastar transfer`.
///
/// ```
/// use sigmastar::TransferOptions;
/// let options = TransferOptions::new().k0("20").n_o([Some(0), Some(10), None]);
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct TransferOptions {
    pair: Wanted,
    n_o: Vec<Option<u64>>,
    every_set: bool,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Wanted {
    ForData,
    SmallestK1(String),
    Cheapest(String, String),
}

impl Default for TransferOptions {
    fn default() -> TransferOptions {
        let finite = [0, 1, 2, 3, 5, 10, 20, 50, 1_000_000_000].map(Some);
        let n_o = finite.into_iter().chain([None]).collect();
        TransferOptions { pair: Wanted::ForData, n_o, every_set: false }
    }
}

impl TransferOptions {
    /// The most numbers of oscillators of one call.
    pub const MOST: usize = 10_000;

    /// The defaults.
    #[must_use]
    pub fn new() -> TransferOptions {
        TransferOptions::default()
    }

    /// The smallest k1 for this k0, an exact positive constant. It takes the place of weights.
    #[must_use]
    pub fn k0(mut self, k0: impl Into<String>) -> TransferOptions {
        self.pair = Wanted::SmallestK1(k0.into());
        self
    }

    /// The pair with the smallest `a k0 + b k1`, exact positive constants; those of the data at X = E = 0 where neither this nor
    /// a k0 is given. It takes the place of a k0.
    #[must_use]
    pub fn cheapest(mut self, a: impl Into<String>, b: impl Into<String>) -> TransferOptions {
        self.pair = Wanted::Cheapest(a.into(), b.into());
        self
    }

    /// The numbers of oscillators, `None` for infinitely many.
    #[must_use]
    pub fn n_o(mut self, n_o: impl IntoIterator<Item = Option<u64>>) -> TransferOptions {
        self.n_o = n_o.into_iter().collect();
        self
    }

    /// Also a pair that serves every finite set of harmonics that contains 0.
    #[must_use]
    pub fn every_set(mut self) -> TransferOptions {
        self.every_set = true;
        self
    }

    /// What they say, for the layers below.
    #[doc(hidden)]
    pub fn checked(&self) -> Result<(PairChoice, Vec<OscillatorCount>, bool), Error> {
        if self.n_o.len() > TransferOptions::MOST {
            let message = format!("n_o has {} numbers of oscillators", self.n_o.len());
            let help =
                format!("ask for at most {}: what holds for every n_o is said without them", TransferOptions::MOST);
            return Err(Error::new(ErrorKind::Range, message, &help));
        }
        let pair = match &self.pair {
            Wanted::ForData => PairChoice::ForData,
            Wanted::SmallestK1(k0) => PairChoice::SmallestK1(positive("k0", k0)?),
            Wanted::Cheapest(a, b) => PairChoice::Cheapest { a: positive("a", a)?, b: positive("b", b)? },
        };
        let count = |n_o: &Option<u64>| n_o.map_or(OscillatorCount::Infinite, OscillatorCount::Finite);
        Ok((pair, self.n_o.iter().map(count).collect(), self.every_set))
    }
}

/// A proved transfer bound, and how much of it some numbers of oscillators use.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct TransferStudy {
    bound: TransferBound,
    every_set: Option<TransferBound>,
    shares: Vec<OscillatorShare>,
    report: Report,
}

/// How much of the bound a number of oscillators uses.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct OscillatorShare {
    /// The number; `None` for infinitely many.
    pub n_o: Option<u64>,
    /// The largest `T_N(x)/(k0 + k1 x^2)` lies between these doubles, rounded outward.
    pub ratio: [f64; 2],
}

impl TransferStudy {
    /// The bound, for every number of oscillators.
    #[must_use]
    pub fn bound(&self) -> &TransferBound {
        &self.bound
    }

    /// With the same k0 the bound `T_H(x) <= k0 + k1 x^2` for every finite set H of harmonics that contains 0 and every `x >= 0`, where it was asked for;
    /// `None` also where no proof was found within the effort.
    #[must_use]
    pub fn every_set(&self) -> Option<&TransferBound> {
        self.every_set.as_ref()
    }

    /// One for each number of oscillators that was asked for, in that order.
    #[must_use]
    pub fn shares(&self) -> &[OscillatorShare] {
        &self.shares
    }

    /// The report of `sigmastar transfer`.
    #[must_use]
    pub fn report(&self) -> &Report {
        &self.report
    }
}

/// Proves the transfer bound of the internal model of a specification or plant, and what belongs to it. No certificate carries
/// it.
///
/// # Errors
/// Those of [`transfer_bound`], and what is wrong with the options.
pub fn transfer_study(subject: impl Into<Subject>, options: &TransferOptions) -> Result<TransferStudy, Error> {
    let asked = options.checked()?;
    let study = transfer_of(&specification(subject.into())?, &asked, false, || {});
    study.map(|(study, _)| study).map_err(no_pair)
}

/// [`transfer_study`] of data that are proved, with its figure where that is wanted; `done` is called after each number of oscillators.
///
/// # Errors
/// There is no certified pair.
pub fn transfer_of(
    spec: &Specification,
    (pair, n_o, every_set): &(PairChoice, Vec<OscillatorCount>, bool),
    figure: bool,
    done: impl Fn() + Sync,
) -> Result<(TransferStudy, Option<Figure>), PairError> {
    let study = transfer::TransferStudy::new(spec, DEFAULT_PRECISION, pair, (n_o, *every_set), done)?;
    let share = |of: &transfer::Uniformity| OscillatorShare {
        n_o: match of.sup.n_o {
            OscillatorCount::Finite(n) => Some(n),
            OscillatorCount::Infinite => None,
        },
        ratio: [of.sup.ratio.lower_f64(), of.sup.ratio.upper_f64()],
    };
    let told = TransferStudy {
        bound: TransferBound::new(&study.data, &study.pair),
        every_set: study
            .every_set
            .as_ref()
            .and_then(|sets| sets.pair.as_ref())
            .map(|pair| TransferBound::with(&study.data, &study.pair, &pair.k1)),
        shares: study.uniformity.iter().map(share).collect(),
        report: Report::of(&TransferReport(&study)),
    };
    Ok((told, figure.then(|| transfer_figure(&study))))
}

/// The data of the subject, proved where it is a plant. The internal model needs no Lyapunov triple.
fn specification(subject: Subject) -> Result<Specification, Error> {
    match subject.read {
        Read::Specification(spec) => Ok(*spec),
        plant @ Read::Plant(_) => Ok(plant.proved().map_err(|all| Error::documents(&all))?.0),
    }
}

fn no_pair(error: PairError) -> Error {
    let kind = if error.is_refuted() { ErrorKind::Refuted } else { ErrorKind::Undecided };
    Error::new(kind, error.to_string(), error.way_out())
}
