//! The report on a tuning: what it brings, and what it costs.

use super::descent::{Tried, Tuning};
use super::figures::{Figures, Goal};
use super::parameter::Parameter;
use serde_json::{Value, json};
use sigmastar_document::number::{estimate, exact, full, upper};
use sigmastar_document::{Block, Readable, Table, clean, plain, plain_all};
use sigmastar_exact::number::{Direction, write_exact};
use sigmastar_prove::certificate::set_fields;

/// The format of the JSON.
const FORMAT: &str = "sigmastar/tune";

/// Its version.
const VERSION: u64 = 1;

/// A tuning of what has this name.
pub struct TuningReport<'t> {
    /// What became of it.
    pub tuning: &'t Tuning,
    /// The name of the specification or plant.
    pub name: &'t str,
    /// SHA-256 of its canonical form as it was.
    pub sha256: &'t str,
}

impl Readable for TuningReport<'_> {
    fn blocks(&self) -> Vec<Block> {
        let tuning = self.tuning;
        let mut blocks = vec![
            Block::Title(format!("{}: tuning", clean(self.name))),
            Block::says(self.sentence()),
            Block::says(BASIS),
        ];
        blocks.push(Block::heading("The free numbers"));
        blocks.push(Block::Table(parameters(tuning)));
        if tuning.has_claim() {
            blocks.push(Block::heading("What it brings, and what it costs"));
            blocks.push(Block::Table(self.comparison()));
        }
        let remarks = self.remarks();
        if !remarks.is_empty() {
            blocks.push(Block::List(remarks));
        }
        blocks.push(Block::heading("What was tried"));
        blocks.push(Block::facts(self.tries()));
        blocks
    }

    /// As JSON: `{"format": "sigmastar/tune", "version": 1, ...}`.
    fn json(&self) -> Value {
        let tuning = self.tuning;
        let parameters: Vec<Value> =
            tuning.parameters.iter().enumerate().map(|(index, parameter)| self.parameter(index, parameter)).collect();
        let after = tuning.after.as_ref().map(|(tried, document)| {
            let mut after = self.tried(tried);
            after["sha256"] = document.root().sha256().into();
            after
        });
        json!({
            "format": FORMAT, "version": VERSION, "sentence": plain(&self.sentence()), "basis": BASIS,
            "specification": { "name": self.name, "sha256": self.sha256 },
            "minimised": tuning.settings.goal.name(), "n_o": tuning.settings.n_o,
            "parameters": parameters, "before": self.tried(&tuning.before), "after": after,
            "tries": { "at_most": tuning.settings.tries, "certified": tuning.certified, "without_claim": tuning.without_claim },
            "remarks": plain_all(self.remarks()),
        })
    }
}

/// What is claimed, and what is not.
const BASIS: &str = "Each proposal was certified as `sigmastar certify` certifies a file with these values (an `actuator` is judged by the conditions alone). The figures \
                     that are shown are certified. Other values in the ranges may be better.";

impl TuningReport<'_> {
    /// What came of it, in a sentence.
    fn sentence(&self) -> String {
        let tuning = self.tuning;
        let what = match tuning.settings.goal {
            Goal::Sigma => self.gain(),
            Goal::Feedback => "$`sigma* + mu Nbar^2`$".to_owned(),
            Goal::Error(n_o) => format!("the bound of $`sup|e|`$ with {n_o} oscillators"),
        };
        let shown =
            |tried: &Tried| tried.outcome.as_ref().map_or_else(|_| "nothing".to_owned(), |figures| self.goal(figures));
        let values = |tried: &Tried| {
            let each = tuning.parameters.iter().zip(&tried.values);
            each.map(|(parameter, value)| format!("$`{} = {}`$", parameter.name, clean(value)))
                .collect::<Vec<_>>()
                .join(", ")
        };
        match (&tuning.after, &tuning.before.outcome) {
            (Some((after, _)), Ok(_)) => {
                let less = self.less(after);
                format!(
                    "Certified: with {} {what} is {}, {less}from {}.",
                    values(after),
                    shown(after),
                    shown(&tuning.before)
                )
            }
            (Some((after, _)), Err(verdict)) => format!(
                "Certified: with {} {what} is {}. With the values of the file the verdict is {verdict}.",
                values(after),
                shown(after)
            ),
            (None, Ok(_)) => format!(
                "Nothing better was found than the values of the file, {}, which are certified: {what} is {}.",
                values(&tuning.before),
                shown(&tuning.before)
            ),
            (None, Err(verdict)) => format!(
                "Undecided: nothing was certified, neither with the values of the file ({verdict}) nor with any other that \
                 was tried. `sigmastar certify` says why."
            ),
        }
    }

    /// What the certified gain is called: at samples it is no threshold.
    fn gain(&self) -> String {
        let period = self.tuning.figures().find_map(|figures| figures.sampling_period.as_ref());
        period.map_or_else(|| "$`sigma*`$".to_owned(), |step| format!("the gain for samples {step} apart"))
    }

    /// What was to be small.
    fn goal(&self, figures: &Figures) -> String {
        match self.tuning.settings.goal {
            Goal::Sigma => exact(&figures.sigma, Direction::Up),
            Goal::Feedback => figures.feedback.as_ref().map(upper).unwrap_or_default(),
            Goal::Error(_) => figures.error.as_ref().map(|[_, sup]| upper(sup)).unwrap_or_default(),
        }
    }

    /// By how much it fell, in percent.
    fn less(&self, after: &Tried) -> String {
        let value =
            |tried: &Tried| tried.outcome.as_ref().ok().and_then(|figures| figures.value(self.tuning.settings.goal));
        match (value(&self.tuning.before), value(after)) {
            (Some(before), Some(after)) if before > 0 => {
                let left = 100.0 * (after / before).to_f64();
                match left {
                    // Three digits of 99.96 would say that nothing is left.
                    ..10.0 => format!("about {} % of what it was, down ", estimate(left)),
                    _ => format!("about {} % less, down ", estimate(100.0 - left)),
                }
            }
            _ => String::new(),
        }
    }

    fn comparison(&self) -> Table {
        let tuning = self.tuning;
        let mut table = Table::new(&["<", "before", "after"]);
        let after = tuning.after.as_ref().map(|(after, _)| after);
        let mut row = |name: &str, of: &dyn Fn(&Figures) -> Option<String>| {
            let cell = |tried: Option<&Tried>| tried.and_then(|tried| of(tried.outcome.as_ref().ok()?));
            let cells = [cell(Some(&tuning.before)), cell(after)];
            if cells.iter().any(Option::is_some) {
                let [before, after] = cells.map(|cell| cell.unwrap_or_else(|| "-".to_owned()));
                table.push([name.to_owned(), before, after]);
            }
        };
        row(&self.gain(), &|figures| Some(exact(&figures.sigma, Direction::Up)));
        row("$`sigma* + mu Nbar^2`$, at most", &|figures| figures.feedback.as_ref().map(upper));
        for (index, name) in ["$`rms(e)`$", "$`sup|e|`$"].into_iter().enumerate() {
            let name = format!("{name} at $`sigma*`$, $`n_o = {}`$, at most", tuning.settings.n_o);
            row(&name, &|figures| figures.error.as_ref().map(|error| upper(&error[index])));
        }
        let state = tuning.figures().find_map(|figures| figures.state);
        // Of a plant without states there is no size of a state.
        let norms = |others: &[&str]| -> Vec<(usize, String)> {
            let others = others.iter().map(|name| Some((*name).to_owned()));
            let all = std::iter::once(state.map(|name| format!("$`|{name}|`$"))).chain(others);
            all.enumerate().filter_map(|(index, name)| Some((index, name?))).collect()
        };
        for (index, name) in norms(&["$`|e|`$", "$`|z|_N`$"]) {
            let size = |figures: &Figures| {
                let size = figures.initial_set.named().nth(index);
                Some(size.map_or_else(|| "$`z = M e`$".to_owned(), |(_, size)| exact(size, Direction::Down)))
            };
            row(&format!("initial set: {name}"), &size);
        }
        for (index, name) in norms(&["$`|e|`$", "$`|zeta|_N`$", "$`|z|_N`$"]) {
            row(&format!("periodic solution: {name}, at most"), &|figures| figures.periodic.get(index).map(upper));
        }
        table
    }

    fn remarks(&self) -> Vec<String> {
        let tuning = self.tuning;
        let mut remarks = Vec::new();
        if tuning.figures().any(|figures| figures.feedback.is_some()) {
            remarks.push(
                "$`sigma* + mu Nbar^2`$ is the largest factor by which the law multiplies $`e`$, for every $`n_o`$: \
                 $`u = -(sigma + mu (n_0 + ... + n_(n_o))) e + mu M'N z`$. If it grows, it is the price of a smaller $`sigma*`$"
                    .to_owned(),
            );
        }
        if let Some((after, _)) = &tuning.after {
            let at_an_end =
                |parameter: &Parameter, value: &str| parameter.range.iter().any(|end| write_exact(end) == value);
            let pairs = tuning.parameters.iter().zip(&after.values).filter(|(one, value)| at_an_end(one, value));
            let names: Vec<&str> = pairs.map(|(parameter, _)| parameter.name.as_str()).collect();
            if !names.is_empty() {
                remarks.push(format!(
                    "at an end of its range, which may decide more than the plant does: {}",
                    names.join(", ")
                ));
            }
        }
        if matches!(tuning.settings.goal, Goal::Error(_)) {
            remarks.push(
                "$`mu`$ and the weights enter the bounds of the error through $`sigma*`$ alone: at one gain, `certify --sigma V`, \
                 they are the same before and after. A smaller bound at $`sigma*`$ is one at a larger gain"
                    .to_owned(),
            );
        }
        if tuning.figures().any(|figures| figures.no_plant) {
            remarks
                .push("it is proved that no plant with a state has these data: see the report of `certify`".to_owned());
        }
        remarks
    }

    /// How many proposals there were, and what came of them.
    fn tries(&self) -> Vec<(String, String)> {
        let tuning = self.tuning;
        let count: usize = tuning.without_claim.values().sum();
        let words: Vec<String> = tuning.without_claim.iter().map(|(word, count)| format!("{count} {word}")).collect();
        let without = if count == 0 { "none".to_owned() } else { format!("{count} ({})", words.join(", ")) };
        vec![
            ("proposals beside the values of the file".to_owned(), (tuning.certified + count).to_string()),
            ("certified".to_owned(), tuning.certified.to_string()),
            ("without a claim, taken as infinitely bad".to_owned(), without),
            ("at most".to_owned(), tuning.settings.tries.saturating_sub(1).to_string()),
        ]
    }

    fn parameter(&self, index: usize, parameter: &Parameter) -> Value {
        let after = self.tuning.after.as_ref().and_then(|(after, _)| after.values.get(index));
        json!({
            "name": parameter.name, "pointer": parameter.pointer,
            "range": parameter.range.each_ref().map(write_exact), "before": parameter.written, "after": after,
        })
    }

    fn tried(&self, tried: &Tried) -> Value {
        match &tried.outcome {
            Err(verdict) => json!({ "verdict": verdict.to_string() }),
            Ok(figures) => {
                let [x, e, zeta, z] = figures.periodic.each_ref().map(full);
                let mut value = json!({
                    "verdict": "certified", "sigma_star": write_exact(&figures.sigma),
                    "sampling_period": figures.sampling_period, "feedback": figures.feedback.as_ref().map(full),
                    "initial_set": set_fields(&figures.initial_set).collect::<Value>(),
                    "periodic_solution": { "x": x, "e": e, "zeta": zeta, "z": z },
                    "no_plant": figures.no_plant,
                });
                value["error"] = match &figures.error {
                    None => Value::Null,
                    Some([rms, sup]) => json!({ "rms": full(rms), "sup": full(sup) }),
                };
                value
            }
        }
    }
}

fn parameters(tuning: &Tuning) -> Table {
    let mut table = Table::new(&["<", "from", "to", "before", "after"]);
    for (index, parameter) in tuning.parameters.iter().enumerate() {
        let [from, to] = parameter.range.each_ref().map(write_exact);
        let after = tuning.after.as_ref().and_then(|(after, _)| after.values.get(index));
        let after = after.cloned().unwrap_or_else(|| "-".to_owned());
        table.push([format!("$`{}`$", parameter.name), from, to, clean(&parameter.written), after]);
    }
    table
}
