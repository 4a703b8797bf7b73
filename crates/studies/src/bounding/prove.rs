//! The bounding functions of a plant on a domain: polynomials that are proved.

use super::fit::Samples;
use rug::Rational;
use sigmastar_decide::bounds::{Engine, Majorant, Term};
use sigmastar_exact::number::{Direction, Portable, round_f64, round_rational};
use sigmastar_exact::parallel;
use sigmastar_lang::spec::Bound;
use sigmastar_propose::bounds::FloatSuprema;
use sigmastar_prove::attempt::prove_value;
use sigmastar_prove::reduction::PlantRefusal;
use sigmastar_theory::evidence::Entry;

/// Where suprema are sampled, as parts of the largest X and E.
const GRID: [f64; 6] = [0.0, 0.1, 0.25, 0.5, 0.75, 1.0];

/// What a proposal is enlarged by until it is proved, and the boxes that each attempt may take.
const ATTEMPTS: [(f64, usize); 5] = [(0.002, 4000), (0.006, 6000), (0.02, 10_000), (0.06, 15_000), (0.2, 20_000)];

/// The constant grows by this part more, so that what vanishes on the orbit has room there.
const ROOM: f64 = 0.1;

/// Significant digits of coefficients.
pub(super) const DIGITS: u32 = 4;

/// Powers of ten that are tried for a bound that nothing is known of, and how often the step down is halved then (in
/// logarithms).
const EXPONENTS: [i32; 10] = [-15, -12, -9, -6, -3, 0, 3, 6, 9, 12];
const HALVINGS: u32 = 10;

/// Boxes that a trial of one value may take.
const EFFORT: usize = 2000;

/// The bounding functions of a plant on `|y| <= X`, `|e| <= E`, relative to its orbit; each is proved there for every t by
/// itself: of the norms that the names say, q and q_t on the orbit alone. One for each [`Bound`], empty where none is proved.
pub(super) struct PlantBounds([Majorant; Bound::ALL.len()]);

/// The kinds that are fitted by a polynomial.
const FITTED: [Bound; 8] =
    [Bound::Fx, Bound::Fe, Bound::Qx, Bound::Qe, Bound::QeMax, Bound::Qtx, Bound::Qte, Bound::Rate];

impl PlantBounds {
    /// Proposes and proves them. `engine` and `samples` are of one plant and region, of which the period and smoothness on the
    /// whole domain have been proved.
    ///
    /// # Errors
    /// The first bounding function that is not proved within the effort.
    pub(super) fn prove(
        engine: &Engine,
        samples: &FloatSuprema,
        domain: [&Rational; 2],
    ) -> Result<PlantBounds, PlantRefusal> {
        let stateless = engine.states() == 0;
        let fitted = parallel::map(&FITTED, |&kind| {
            let found = match kind {
                // Without states every rate is as good as any other.
                Bound::Rate if stateless => Some(Majorant::constant(Rational::from(1))),
                _ => majorant(engine, samples, kind, domain),
            };
            (kind, found)
        });
        let corner = domain.map(Rational::clone);
        let origin = [Rational::new(), Rational::new()];
        let single = [(Bound::Q, &origin), (Bound::Qt, &origin), (Bound::Fxx, &corner), (Bound::Fex, &corner)];
        let single = parallel::map(&single, |&(kind, at)| (kind, least(engine, kind, at).map(Majorant::constant)));
        let mut bounds = Bound::ALL.map(|_| Majorant::default());
        for (kind, found) in fitted.into_iter().chain(single) {
            let refusal = || PlantRefusal::NotProved { bound: kind.field(), at: domain.map(Rational::to_f64) };
            bounds[kind as usize] = found.ok_or_else(refusal)?;
        }
        Ok(PlantBounds(bounds))
    }

    /// The bounding functions as fields of a specification, with coefficients of a few digits, and the rate.
    ///
    /// f, q and q_t follow from their derivatives along the segment from the orbit: `|f(t,x,e) - f(t,x_0,0)|` is at most
    /// `int_0^1 f_x(sX,sE) X + f_e(sX,sE) E ds`, and so on.
    pub(super) fn fields(&self) -> (Vec<(&'static str, Majorant)>, Majorant) {
        let of = |kind: Bound| &self.0[kind as usize];
        let added = |start: &Majorant, x: Bound, e: Bound| {
            let sum = start.plus(&of(x).along_segment([1, 0])).plus(&of(e).along_segment([0, 1]));
            sum.map(|coefficient| round_rational(coefficient, DIGITS, Direction::Up))
        };
        let on_the_orbit = [
            (Bound::F, added(&Majorant::default(), Bound::Fx, Bound::Fe)),
            (Bound::Q, added(of(Bound::Q), Bound::Qx, Bound::Qe)),
            (Bound::Qt, added(of(Bound::Qt), Bound::Qtx, Bound::Qte)),
        ];
        // From above and from below it is the same: then one of the two is enough.
        let one_sided = (!of(Bound::QeMax).is_above(of(Bound::Qe))).then_some(Bound::QeMax);
        let first = [Bound::Fx, Bound::Fe, Bound::Fxx, Bound::Fex, Bound::Qx, Bound::Qe];
        let own = first.into_iter().chain(one_sided).chain([Bound::Qtx, Bound::Qte]);
        let all = on_the_orbit.into_iter().chain(own.map(|kind| (kind, of(kind).clone())));
        (all.map(|(kind, majorant)| (kind.field(), majorant)).collect(), of(Bound::Rate).clone())
    }
}

/// A polynomial that is proved, near the least that the samples allow; the constant at the far corner where none is.
fn majorant(engine: &Engine, samples: &FloatSuprema, kind: Bound, domain: [&Rational; 2]) -> Option<Majorant> {
    let corner = || {
        let proved = prove_value(engine, samples, kind, domain[0], domain[1])?;
        let direction = if kind.is_rate() { Direction::Down } else { Direction::Up };
        Some(round_rational(&proved.value, DIGITS, direction))
    };
    // What is 0 at every sample may be a little more, as x_0' is known to a radius.
    let small = || if kind.is_rate() { None } else { least(engine, kind, &domain.map(Rational::clone)) };
    proposal(engine, samples, kind, domain).or_else(|| corner().or_else(small).map(Majorant::constant))
}

fn proposal(engine: &Engine, samples: &FloatSuprema, kind: Bound, domain: [&Rational; 2]) -> Option<Majorant> {
    let sampled = sampled(engine, samples, kind, domain);
    let size = sampled.size();
    if !size.is_finite() {
        return None;
    }
    if size == 0.0 {
        let zero = Majorant::default();
        return engine.decide_majorant(kind, &zero, domain, EFFORT).truth.is_true().then_some(zero);
    }
    let fitted = sampled.fit(kind.is_signed())?;
    ATTEMPTS.into_iter().find_map(|(slack, effort)| {
        let term = |&(x, e, c): &(u32, u32, f64)| {
            let room = if (x, e) == (0, 0) { ROOM * slack * size } else { 0.0 };
            let enlarged = c + c.abs() * slack + room;
            let (value, direction) =
                if kind.is_rate() { (-enlarged, Direction::Down) } else { (enlarged, Direction::Up) };
            Some(Term { x, e, coefficient: round_f64(value, DIGITS, direction)? })
        };
        let tried = Majorant { terms: fitted.iter().map(term).collect::<Option<_>>()? };
        engine.decide_majorant(kind, &tried, domain, effort).truth.is_true().then_some(tried)
    })
}

/// Suprema over the grid; the negatives of a rate.
fn sampled(engine: &Engine, samples: &FloatSuprema, kind: Bound, domain: [&Rational; 2]) -> Samples {
    let [x, e] = domain.map(|end| {
        let end = end.to_f64();
        if end > 0.0 { GRID.map(|part| part * end).to_vec() } else { vec![0.0] }
    });
    let x = if engine.states() == 0 { vec![0.0] } else { x };
    let radius = engine.radius();
    let pairs = x.iter().flat_map(|x| e.iter().map(move |e| (*x, *e)));
    let values = pairs.map(|(x, e)| {
        let value = samples.refined(kind, x + radius, e).value;
        if kind.is_rate() { -value } else { value }
    });
    let values = values.collect();
    Samples { x, e, values }
}

/// A value of few digits that is proved at one argument, near the least of which that holds.
fn least(engine: &Engine, kind: Bound, [x, e]: &[Rational; 2]) -> Option<Rational> {
    let proved = |value: f64| {
        let value = round_f64(value, DIGITS, Direction::Up)?;
        let entry = Entry { bound: kind, x: x.clone(), e: e.clone(), value };
        engine.decide(&entry, EFFORT).truth.is_true().then_some(entry.value)
    };
    if let Some(zero) = proved(0.0) {
        return Some(zero);
    }
    let (exponent, mut best) =
        EXPONENTS.into_iter().find_map(|exponent| Some((exponent, proved(10f64.portable_powi(exponent))?)))?;
    let (mut low, mut high) = (f64::from(exponent - 3), f64::from(exponent));
    for _ in 0..HALVINGS {
        let middle = (low + high) / 2.0;
        match proved(libm::exp10(middle)) {
            Some(value) => (best, high) = (value, middle),
            None => low = middle,
        }
    }
    Some(best)
}
