//! The report of `sigmastar rate`.

use rug::Rational;
use serde_json::{Value, json};
use sigmastar_document::number::{estimate, exact, margin};
use sigmastar_document::plot::{Curve, Figure, Scale, Style};
use sigmastar_document::{Block, Readable, Table, clean};
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, write_exact};
use sigmastar_prove::certify::Certification;
use sigmastar_studies::rate::Rates;

/// Rates for several n_o at one gain.
pub struct RateReport {
    name: String,
    sigma: Rational,
    sigma_star: Rational,
    /// Whether e is a filtered error: then it depends on x whether the rates speak of xi_1, ..., xi_(r-1).
    filtered: bool,
    /// What converges, in words.
    state: &'static str,
    /// Whether the claim is about a plant by its formulas.
    of_plant: bool,
    rates: Vec<Rates>,
}

impl RateReport {
    /// The report; `None` if the run is not certified.
    #[must_use]
    pub fn new(run: &Certification<'_>, sigma: &Rational, rates: Vec<Rates>) -> Option<RateReport> {
        let sigma_star = run.sigma_star()?.clone();
        let filtered = run.spec.relative_degree.is_some();
        let (of_plant, state) = (run.spec.plant().is_some(), run.spec.state_name().map_or("(e, z)", |_| "(x, e, z)"));
        Some(RateReport {
            name: clean(&run.spec.name),
            sigma: sigma.clone(),
            sigma_star,
            filtered,
            state,
            of_plant,
            rates,
        })
    }

    /// The rates over n_o + 1, which is positive, so that both axes are logarithmic. It is drawn from doubles and claims nothing.
    fn figure(&self) -> Figure {
        let curve = |label: &str, of: &dyn Fn(&Rates) -> Option<f64>| {
            let points = self.rates.iter().filter_map(|rates| Some((f64::from(rates.n_o) + 1.0, of(rates)?)));
            // A rate of 0 has no place on the axis.
            let mut points: Vec<(f64, f64)> = points.filter(|(_, rate)| *rate > 0.0).collect();
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            Curve { label: label.to_owned(), points, style: Style::Marked }
        };
        let curves = [
            curve("closed loop", &|rates| rates.closed_loop.as_ref().map(|(rate, _)| rate.to_f64())),
            curve("oscillators alone", &|rates| rates.oscillators.as_ref().map(Rational::to_f64)),
            curve("by Lemma 1", &|rates| rates.lemma.as_ref().map(|(_, rate)| rate.to_f64())),
            curve("by c and kappa", &|rates| rates.by_kappa.as_ref().map(Enclosure::lower_f64)),
        ];
        Figure {
            title: format!("Proved rates at sigma = {}", exact(&self.sigma, Direction::Nearest)),
            x: "n_o + 1 [pure number]".to_owned(),
            y: "rate [1/time]".to_owned(),
            scale: Scale::LogLog,
            floor: 0.0,
            curves: curves.into_iter().filter(|curve| !curve.points.is_empty()).collect(),
        }
    }
}

impl Readable for RateReport {
    fn blocks(&self) -> Vec<Block> {
        let mut table = Table::new(&[
            "n_o",
            "spectral abscissa of the oscillators alone (estimate)",
            "their decay rate, of Phi - mu M M'N",
            "by Lemma 1, any kappa",
            "p",
            "closed loop",
            "proved by",
            "by c and kappa",
        ]);
        let unknown = || "not proved".to_owned();
        for rates in &self.rates {
            table.push([
                rates.n_o.to_string(),
                rates.spectral.map_or_else(|| "unknown".to_owned(), |rate| estimate(-rate)),
                rates.oscillators.as_ref().map_or_else(unknown, |rate| exact(rate, Direction::Down)),
                rates.lemma.as_ref().map_or_else(unknown, |(_, rate)| exact(rate, Direction::Down)),
                rates.lemma.as_ref().map_or_else(unknown, |(largest, _)| exact(largest, Direction::Up)),
                rates.closed_loop.as_ref().map_or_else(unknown, |(rate, _)| exact(rate, Direction::Down)),
                rates.closed_loop.as_ref().map_or_else(String::new, |(_, method)| method.to_string()),
                rates.by_kappa.as_ref().map_or_else(unknown, margin),
            ]);
        }
        // A rate of the closed loop is proved for this gain, not for the one that it is rounded to.
        let mut blocks = vec![Block::Title(format!("{}: rates at sigma = {}", self.name, write_exact(&self.sigma)))];
        if self.filtered {
            blocks.push(Block::says(
                "The closed loop is that of x, e and z. With a relative degree above 1 the states xi_1, ..., xi_(r-1) belong to x, \
                 and so to this table, where f or q depends on them. Where the specification leaves them out of x they follow \
                 from e by the filter: they approach the periodic solution no faster than the filter itself lets them, and its \
                 rate is not in this table.",
            ));
        }
        blocks.extend([
            Block::says(format!(
                "sigma* = {} serves every n_o; the rates tend to 0 as n_o grows. All in 1/time, computed with enclosures and \
                 rounded down, but for the spectral abscissa, which is floating point, and of the oscillators alone, not of the \
                 closed loop; no certificate carries them, and no independent program checks them. The rate of the closed loop \
                 is that at which {} is proved to approach the periodic solution from the initial set of the certificate, for \
                 this n_o and this gain: a lower bound for {}.",
                exact(&self.sigma_star, Direction::Up),
                self.state,
                if self.of_plant { "this plant" } else { "every plant with these bounding functions" }
            )),
            Block::Table(table),
            Block::Drawing(self.figure()),
            Block::says(
                "Lemma 1: P_zeta with P_zeta (Phi - mu M M'N) + (.)' <= -N is proved, and p bounds N^(-1/2) P_zeta N^(-1/2). Every \
                 kappa > 0 is admissible, and the rate of N + kappa P_zeta tends to 1/(2p) as kappa grows.",
            ),
            Block::says(
                "Closed loop, riccati: a Lyapunov function for this n_o and gain, from a Riccati equation, proved by a matrix \
                 inequality in the error box. By c and kappa: the Lyapunov function of the certificate and the paper's argument, \
                 with its constant repaired; at sigma* it is tiny, because C5 only just holds there.",
            ),
        ]);
        blocks
    }

    /// As JSON: `{"format": "sigmastar/rates", "version": 1, ...}`.
    fn json(&self) -> Value {
        let one = |rates: &Rates| {
            json!({
                "n_o": rates.n_o,
                "spectral_abscissa_estimate": rates.spectral.map(|rate| (-rate).to_string()),
                "oscillators": rates.oscillators.as_ref().map(write_exact),
                "lemma_1": rates.lemma.as_ref().map(|(largest, rate)| json!({
                    "p": write_exact(largest), "kappa": "every kappa > 0", "rate": write_exact(rate),
                })),
                "closed_loop": rates.closed_loop.as_ref().map(|(rate, _)| write_exact(rate)),
                "closed_loop_by": rates.closed_loop.as_ref().map(|(_, method)| method.to_string()),
                "closed_loop_by_kappa": rates.by_kappa.as_ref().map(|rate| rate.lower_decimal(6)),
            })
        };
        json!({
            "format": "sigmastar/rates", "version": 1, "verdict": "certified", "independent_check": "none", "state": self.state,
            "sigma": write_exact(&self.sigma), "sigma_star": write_exact(&self.sigma_star),
            "rates": self.rates.iter().map(one).collect::<Vec<_>>(),
        })
    }
}
