//! Specifications: from JSON, or built in Rust. Either way the strict reader of [`sigmastar_lang::spec`] reads the document.

use super::error::Error;
use super::json_text;
use serde_json::{Map, Value};
use sigmastar_lang::spec::{self, Bound as BoundingFunction};

/// What errors call the document.
const LABEL: &str = "specification";

/// A bounding specification that was read: every number is exact or enclosed, and proved to lie in its range; the weights
/// are proved to satisfy W1 to W3; a matched base frequency, where asserted, is proved.
///
/// That the bounding functions are finite and nondecreasing is proved by [`certify`](sigmastar_prove::certify). That they bound the
/// plant is the user's part.
#[derive(Clone, Debug)]
pub struct Specification {
    pub(super) read: spec::Specification,
}

impl Specification {
    /// Reads a specification from the text of its JSON file (`docs/formats.md`). Never panics, whatever the text.
    ///
    /// # Errors
    /// Everything that was found wrong, each with its place; kind [`Undecided`](crate::ErrorKind::Undecided) where nothing
    /// is wrong and something could not be decided.
    ///
    /// ```
    /// let error = sigmastar::Specification::from_json("{ \"format\": 1 }").unwrap_err();
    /// assert_eq!(error.kind(), sigmastar::ErrorKind::Field);
    /// assert!(error.to_string().contains("specification:1:13"));
    /// ```
    pub fn from_json(text: &str) -> Result<Specification, Error> {
        Ok(Specification { read: spec::Specification::from_json(LABEL, text)? })
    }

    /// Starts a specification that is built in Rust; `name` is for reports.
    #[must_use]
    pub fn builder(name: impl Into<String>) -> SpecificationBuilder {
        SpecificationBuilder::new(name)
    }

    /// The name of the plant.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.read.name
    }

    /// The document as it was read, indented, with every number as it was written.
    #[must_use]
    pub fn to_json(&self) -> String {
        json_text(&self.read.document)
    }

    /// SHA-256, in hexadecimal, of the canonical form of the document: what a certificate names.
    #[must_use]
    pub fn sha256(&self) -> &str {
        &self.read.sha256
    }
}

/// An entry of a Jacobian `df/dx(t,0,0)`.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum JacobianEntry {
    /// A constant, or a trigonometric polynomial in `t` with the period of the specification.
    Function(String),
    /// Any continuous function of time between the two constants.
    Interval(String, String),
}

impl From<&str> for JacobianEntry {
    /// A function.
    fn from(text: &str) -> JacobianEntry {
        JacobianEntry::Function(text.to_owned())
    }
}

impl From<(&str, &str)> for JacobianEntry {
    /// An interval.
    fn from((low, up): (&str, &str)) -> JacobianEntry {
        JacobianEntry::Interval(low.to_owned(), up.to_owned())
    }
}

/// Builds a [`Specification`]. Numbers are exact constants in the notation of specifications (`"0.58"`, `"1/3"`,
/// `"2*pi"`, `"sqrt(3)/2"`), bounding functions are expressions in `X` and `E`.
///
/// Nothing has a default: what is missing is an error of [`SpecificationBuilder::build`], as it is in a file. What is given
/// twice is replaced.
#[derive(Clone, Debug)]
pub struct SpecificationBuilder {
    document: Map<String, Value>,
}

impl SpecificationBuilder {
    /// An empty specification with the name of the plant.
    #[must_use]
    pub fn new(name: impl Into<String>) -> SpecificationBuilder {
        let version = spec::VERSIONS[spec::VERSIONS.len() - 1];
        let document = object([("format", text(spec::FORMAT)), ("version", version.into()), ("name", text(name))]);
        SpecificationBuilder { document }
    }

    /// Free text for reports.
    #[must_use]
    pub fn description(self, description: impl Into<String>) -> SpecificationBuilder {
        self.with("description", text(description))
    }

    /// The period T > 0 of f and q.
    #[must_use]
    pub fn period(self, period: &str) -> SpecificationBuilder {
        self.with("period", text(period))
    }

    /// The Lyapunov triple of the zero dynamics, 0 < p_low <= p_up and alpha > 0, for which the user vouches. It takes the
    /// place of a Jacobian.
    #[must_use]
    pub fn lyapunov(self, p_low: &str, p_up: &str, alpha: &str) -> SpecificationBuilder {
        let triple = object([("p_low", text(p_low)), ("p_up", text(p_up)), ("alpha", text(alpha))]);
        self.with("lyapunov", triple.into())
    }

    /// The Jacobian `df/dx(t,0,0)`, row by row, for which [`certify`](sigmastar_prove::certify) finds and proves a Lyapunov triple. It
    /// takes the place of a triple.
    ///
    /// ```
    /// use sigmastar::{JacobianEntry, Specification};
    /// let rows: [[JacobianEntry; 2]; 2] = [["-1/5".into(), ("1.7", "1.9").into()], ["-2".into(), "-1".into()]];
    /// let builder = Specification::builder("a plant").jacobian(rows);
    /// ```
    #[must_use]
    pub fn jacobian<R>(self, rows: impl IntoIterator<Item = R>) -> SpecificationBuilder
    where
        R: IntoIterator<Item = JacobianEntry>,
    {
        let entry = |entry| match entry {
            JacobianEntry::Function(function) => text(function),
            JacobianEntry::Interval(low, up) => Value::Array(vec![text(low), text(up)]),
        };
        let rows = rows.into_iter().map(|row| Value::Array(row.into_iter().map(entry).collect())).collect();
        self.with("lyapunov", object([("jacobian", Value::Array(rows))]).into())
    }

    /// A bounding function; those without a replacement that are not [optional](BoundingFunction::is_required) are needed.
    /// A [rate](BoundingFunction::Rate) stands next to a triple: give that first.
    #[must_use]
    pub fn bound(self, which: BoundingFunction, expression: &str) -> SpecificationBuilder {
        self.within(which.section(), which.field(), text(expression))
    }

    /// What is known of `q(t,0,0) = sum c_k exp(2 pi i k t/period) + rest`: bounds of `|c_0|`, `|c_1|`, ..., of the root mean
    /// square of the rest and, if there is one, of that of its derivative.
    ///
    /// ```
    /// use sigmastar::Specification;
    /// let builder = Specification::builder("a plant").known_forcing(["1.88", "0.8"], "1/100", None);
    /// ```
    #[must_use]
    pub fn known_forcing<'v>(
        self,
        harmonics: impl IntoIterator<Item = &'v str>,
        rest_rms: &str,
        rest_t_rms: Option<&str>,
    ) -> SpecificationBuilder {
        let harmonics = Value::Array(harmonics.into_iter().map(text).collect());
        let rest_t_rms = rest_t_rms.map(|bound| ("rest_t_rms", text(bound)));
        let known = [("harmonics", harmonics), ("rest_rms", text(rest_rms))].into_iter().chain(rest_t_rms);
        self.with("q_0", object(known).into())
    }

    /// The box `|x| <= x`, `|e| <= e` on which the bounding functions hold; they hold everywhere where none is given.
    #[must_use]
    pub fn domain(self, x: &str, e: &str) -> SpecificationBuilder {
        self.with("domain", object([("X", text(x)), ("E", text(e))]).into())
    }

    /// The gain mu > 0 of the internal model.
    #[must_use]
    pub fn mu(self, mu: &str) -> SpecificationBuilder {
        self.within("internal_model", "mu", text(mu))
    }

    /// The base frequency w > 0 of the internal model, which need not fit the period.
    #[must_use]
    pub fn base_frequency(self, frequency: &str) -> SpecificationBuilder {
        self.with_base_frequency(frequency, false)
    }

    /// The base frequency of the internal model, with the assertion that it is exactly `2 pi / period`. That is proved, or
    /// refused.
    #[must_use]
    pub fn matched_base_frequency(self, frequency: &str) -> SpecificationBuilder {
        self.with_base_frequency(frequency, true)
    }

    fn with_base_frequency(self, frequency: &str, matched: bool) -> SpecificationBuilder {
        let model = "internal_model";
        self.within(model, "base_frequency", text(frequency)).within(model, "matched", matched.into())
    }

    /// An actuator whose gain is one constant from `low` to `high`, `low <= nominal <= high`: the regulator divides its control by
    /// `nominal`, and a claim covers every such gain. Without it the gain is 1.
    #[must_use]
    pub fn input_gain(self, nominal: &str, low: &str, high: &str) -> SpecificationBuilder {
        let ends = [("nominal", text(nominal)), ("low", text(low)), ("high", text(high))];
        self.with("input_gain", object(ends).into())
    }

    /// An actuator that takes what is put out up to `max` in size and cuts off what is beyond: a claim is about one gain, and keeps to it from
    /// its initial set.
    #[must_use]
    pub fn actuator(self, max: &str) -> SpecificationBuilder {
        self.with("actuator", object([("max", text(max))]).into())
    }

    /// Noise of at most `noise` on the measured e, and a measurement in steps of `quantum`, of which at least one is given: decimals or
    /// fractions. They count in what is said of given numbers of oscillators.
    #[must_use]
    pub fn measurement(self, noise: Option<&str>, quantum: Option<&str>) -> SpecificationBuilder {
        let given = [("noise", noise), ("quantum", quantum)];
        let part = object(given.into_iter().filter_map(|(name, value)| Some((name, text(value?)))));
        self.with("measurement", part.into())
    }

    /// A disturbance of at most `most` that is added to q, a decimal or a fraction. It counts in what is said of given numbers of oscillators.
    #[must_use]
    pub fn disturbance(self, most: &str) -> SpecificationBuilder {
        self.with("disturbance", text(most))
    }

    /// That what is said of given numbers of oscillators at samples counts the rounding of the exported C code, which computes in doubles.
    #[must_use]
    pub fn in_doubles(self) -> SpecificationBuilder {
        self.with("arithmetic", text("double"))
    }

    /// The weights n_0 and `n_l = l^-(1 + epsilon)` for l >= 1.
    #[must_use]
    pub fn power_weights(self, n0: &str, epsilon: &str) -> SpecificationBuilder {
        let weights = object([("family", text("power")), ("n0", text(n0)), ("epsilon", text(epsilon))]);
        self.within("internal_model", "weights", weights.into())
    }

    /// The weights n_0, n_1, ... as listed, and `n_l = coefficient l^-exponent` for every l beyond the list.
    #[must_use]
    pub fn explicit_weights<'v>(
        self,
        values: impl IntoIterator<Item = &'v str>,
        coefficient: &str,
        exponent: &str,
    ) -> SpecificationBuilder {
        let values = Value::Array(values.into_iter().map(text).collect());
        let tail = object([("coefficient", text(coefficient)), ("exponent", text(exponent))]);
        let weights = object([("family", text("explicit")), ("values", values), ("tail", tail.into())]);
        self.within("internal_model", "weights", weights.into())
    }

    /// The initial set of theorem 1 of the paper: twice the bounds of the periodic solution.
    #[must_use]
    pub fn initial_set_of_the_paper(self) -> SpecificationBuilder {
        self.with("initial_set", object([("kind", text("paper"))]).into())
    }

    /// The regulator starts at rest, `z = 0`; `|x| <= x0` and `|e| <= e0`, twice the bounds of the periodic solution where
    /// they are not given.
    #[must_use]
    pub fn initial_set_at_rest(self, x0: Option<&str>, e0: Option<&str>) -> SpecificationBuilder {
        self.initial_set_of_sizes("at-rest", x0, e0)
    }

    /// The regulator sets `z = M e` at its first instant; `|x| <= x0` and `|e| <= e0` as at rest.
    #[must_use]
    pub fn initial_set_aligned(self, x0: Option<&str>, e0: Option<&str>) -> SpecificationBuilder {
        self.initial_set_of_sizes("aligned", x0, e0)
    }

    fn initial_set_of_sizes(self, kind: &str, x0: Option<&str>, e0: Option<&str>) -> SpecificationBuilder {
        let mut set = object([("kind", text(kind))]);
        let given = [("X0", x0), ("E0", e0)];
        set.extend(given.into_iter().filter_map(|(name, value)| Some((name.to_owned(), text(value?)))));
        self.with("initial_set", set.into())
    }

    /// The initial set `|x| <= x0`, `|e| <= e0`, `sqrt(z'Nz) <= z0`.
    #[must_use]
    pub fn initial_set_box(self, x0: &str, e0: &str, z0: &str) -> SpecificationBuilder {
        let set = [("kind", text("box")), ("X0", text(x0)), ("E0", text(e0)), ("Z0", text(z0))];
        self.with("initial_set", object(set).into())
    }

    /// The rational coefficients a_1, ..., a_(r-1) of `e = xi_r + a_(r-1) xi_(r-1) + ... + a_1 xi_1`, for a plant of
    /// relative degree r = 2, 3, 4.
    #[must_use]
    pub fn relative_degree<'v>(self, coefficients: impl IntoIterator<Item = &'v str>) -> SpecificationBuilder {
        let a = Value::Array(coefficients.into_iter().map(text).collect());
        self.with("relative_degree", object([("a", a)]).into())
    }

    /// The document as it stands, indented; [`Specification::from_json`] reads it.
    #[must_use]
    pub fn to_json(&self) -> String {
        json_text(&Value::Object(self.document.clone()))
    }

    /// Reads what was given, as strictly as a file.
    ///
    /// # Errors
    /// Those of [`Specification::from_json`]; places are those of [`SpecificationBuilder::to_json`].
    pub fn build(&self) -> Result<Specification, Error> {
        Specification::from_json(&self.to_json())
    }

    fn with(mut self, field: &str, value: Value) -> SpecificationBuilder {
        self.document.insert(field.to_owned(), value);
        self
    }

    fn within(mut self, part: &str, field: &str, value: Value) -> SpecificationBuilder {
        let part = self.document.entry(part).or_insert_with(|| Value::Object(Map::new()));
        // Only this function makes these parts, and it makes objects.
        if let Value::Object(fields) = part {
            fields.insert(field.to_owned(), value);
        }
        self
    }
}

fn text(value: impl Into<String>) -> Value {
    Value::String(value.into())
}

fn object<'n>(fields: impl IntoIterator<Item = (&'n str, Value)>) -> Map<String, Value> {
    fields.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
}
