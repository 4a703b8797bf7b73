//! Bounds of a family of plants: they hold of every member, and are no larger than the members ask for.

use super::*;

/// `x' = -k x + e + cos(2 pi t)/10 + c x^2` and this q, k in [1, 2] with the nominal value 3/2, c in [-1/4, 1/2] with 0.
fn family(q: &str) -> Plant {
    let text = r#"{ "format": "sigmastar/plant", "version": 1, "name": "family", "period": "1", "states": ["x"],
        "parameters": { "k": { "nominal": "3/2", "low": 1, "high": 2 }, "c": { "nominal": 0, "low": "-1/4", "high": "1/2" } },
        "f": ["-k*x + e + cos(2*pi*t)/10 + c*x^2"], "q": "Q", "internal_model": { "mu": "1", "base_frequency": "2*pi",
        "matched": true, "weights": { "family": "power", "n0": "2", "epsilon": "1/2" } } }"#;
    Plant::from_json("family", &text.replacen('Q', q, 1)).unwrap()
}

const Q: &str = "k*x*e + c*e";

fn engine(q: &str, sensitivities: [&str; 2]) -> Case {
    let plant = family(q);
    let still = |mean: &str| TrigonometricVector { mean: vec![rational(mean)], harmonics: Vec::new() };
    let orbit =
        sigmastar_lang::spec::OrbitCurve { centre: still("0"), sensitivities: sensitivities.map(still).to_vec() };
    let p = identity(1);
    let samples = FloatSuprema::new(&plant, FloatCurve::from(&orbit), vec![vec![1.0]], [Some(&p), None]);
    let region = Region::new(vec![vec![rational("1")]], orbit, rational("0")).unwrap();
    Case { engine: Engine::new(&plant, region, Some(p), None).unwrap(), samples }
}

/// With the orbit at 0 and |x| <= 1/2, |e| <= 1: J = -k + 2 c x has the rate 1 - 1/2; q_e = k x + c lies in [-1.25, 1.5]; q_x = k e.
#[test]
fn bounds_are_those_of_the_worst_member() {
    let case = engine(Q, ["0", "0"]);
    let [x, e] = [rational("0.5"), rational("1")];
    for (bound, worst) in
        [(Bound::Rate, 0.5), (Bound::QeMax, 1.5), (Bound::Qe, 1.5), (Bound::Qx, 2.0), (Bound::Fx, 2.5)]
    {
        let proved = prove_value(&case.engine, &case.samples, bound, &x, &e).unwrap();
        let value = proved.value.to_f64();
        let sound = if bound.is_rate() { value <= worst } else { value >= worst };
        assert!(sound && (value - worst).abs() < 0.01 * worst, "{bound:?}: {value}");
        let beyond = Rational::from_f64(if bound.is_rate() { worst * 1.01 } else { worst * 0.99 }).unwrap();
        let entry = Entry { bound, x: x.clone(), e: e.clone(), value: beyond };
        assert!(!case.engine.decide(&entry, 4000).truth.is_true(), "{bound:?}");
    }
}

/// An orbit that moves with c takes q_e to k (x + c) + c.
#[test]
fn a_state_moves_with_the_orbit_of_its_member() {
    let case = engine(Q, ["0", "1"]);
    let [x, e] = [rational("0.5"), rational("1")];
    let decide = |value: &str| {
        case.engine
            .decide(&Entry { bound: Bound::QeMax, x: x.clone(), e: e.clone(), value: rational(value) }, 4000)
            .truth
    };
    // k (1/2 + 1/2) + 1/2 at k = 2, c = 1/2.
    assert!(decide("2.51").is_true() && !decide("2.49").is_true());
    let proved = prove_value(&case.engine, &case.samples, Bound::QeMax, &x, &e).unwrap();
    assert!((proved.value.to_f64() - 2.5).abs() < 0.03, "{}", proved.value.to_f64());
}

/// What the formula does not name moves the states that it names.
#[test]
fn a_parameter_counts_where_only_the_orbit_depends_on_it() {
    let case = engine("x*e*cos(2*pi*t)", ["0", "1"]);
    let decide = |value: &str| {
        let [x, e] = [rational("0.5"), rational("1")];
        case.engine.decide(&Entry { bound: Bound::Qe, x, e, value: rational(value) }, 4000).truth
    };
    // |x| reaches 1/2 + 1/2 at c = 1/2.
    assert!(decide("1.01").is_true() && !decide("0.99").is_true());
}

/// The velocity `-k x_0 + cos(2 pi t)/10 + c x_0^2` is that of the member, here x_0 = c: q_te = k x_0' gets down to -1.95 at k = 2, c = 1/2,
/// and is within 0.2 with the nominal c = 0.
#[test]
fn an_orbit_moves_as_that_of_its_member() {
    let case = engine(Q, ["0", "1"]);
    let decide = |value: &str| {
        let [x, e] = [rational("0.1"), rational("1")];
        case.engine.decide(&Entry { bound: Bound::Qte, x, e, value: rational(value) }, 4000).truth
    };
    assert!(decide("2.4").is_true() && !decide("1.9").is_true());
}

#[test]
fn a_region_without_the_sensitivities_is_refused() {
    let still = TrigonometricVector { mean: vec![rational("0")], harmonics: Vec::new() };
    let region = Region::new(vec![vec![rational("1")]], still, rational("0")).unwrap();
    assert!(matches!(Engine::new(&family(Q), region, Some(identity(1)), None), Err(RegionError::Shape)));
}

/// The family in two halves along k, each about its own middle with an orbit of its own: a bound is that of the worse one, whichever comes first.
#[test]
fn of_cells_the_worst_counts() {
    let plant = family(Q);
    let p = identity(1);
    let still = |mean: &str| TrigonometricVector { mean: vec![rational(mean)], harmonics: Vec::new() };
    // In the half with the smaller k the orbit is at 1/4, in the other one at 0.
    let halves = [(["1", "1.5"], "0.25"), (["1.5", "2"], "0")].map(|([low, high], mean)| {
        let cell = plant.parameters.in_cell(&[[rational(low), rational(high)], [rational("-0.25"), rational("0.5")]]);
        let orbit =
            sigmastar_lang::spec::OrbitCurve { centre: still(mean), sensitivities: ["0", "0"].map(still).to_vec() };
        (cell, orbit)
    });
    let case = |order: &[usize]| {
        let cells = || order.iter().map(|i| (&halves[*i].0, &halves[*i].1));
        let curves = cells().map(|(cell, orbit)| (cell, FloatCurve::from(orbit)));
        let samples = FloatSuprema::of_cells(&plant, curves, vec![vec![1.0]], [Some(&p), None]);
        let regions = cells()
            .map(|(cell, orbit)| (cell, Region::new(vec![vec![rational("1")]], orbit.clone(), rational("0")).unwrap()));
        Case { engine: Engine::of_cells(&plant, regions, Some(p.clone()), None).unwrap(), samples }
    };
    let [x, e] = [rational("0.5"), rational("1")];
    // J = -k + 2 c x: in the first half at least 1 - 3/4 is left, in the second 3/2 - 1/2. q_e = k x + c: 1.5*0.75 + 0.5, and 2*0.5 + 0.5.
    for order in [&[0, 1][..], &[1, 0], &[0, 1, 1, 1, 1, 1, 1, 1]] {
        let case = case(order);
        for (bound, worst) in [(Bound::Rate, 0.25), (Bound::QeMax, 1.625), (Bound::Qx, 2.0)] {
            let proved = prove_value(&case.engine, &case.samples, bound, &x, &e).unwrap().value.to_f64();
            let sound = if bound.is_rate() { proved <= worst } else { proved >= worst };
            assert!(sound && (proved - worst).abs() < 0.02 * worst, "{bound:?} {order:?}: {proved}");
            let beyond = Rational::from_f64(if bound.is_rate() { worst * 1.02 } else { worst * 0.98 }).unwrap();
            let entry = Entry { bound, x: x.clone(), e: e.clone(), value: beyond };
            assert!(!case.engine.decide(&entry, 4000).truth.is_true(), "{bound:?} {order:?}");
            // Of eight each has an eighth of the effort.
            let parts = if order.len() > 4 { 8 } else { 1 };
            let entry = Entry { bound, x: x.clone(), e: e.clone(), value: Rational::from_f64(proved).unwrap() };
            let needed = case.engine.decide(&entry, 4000).boxes;
            assert!(needed % parts == 0 && case.engine.decide(&entry, needed).truth.is_true(), "{bound:?} {order:?}");
            assert!(
                needed == parts || !case.engine.decide(&entry, needed - parts).truth.is_true(),
                "{bound:?} {order:?}"
            );
        }
    }
    let none: [(&sigmastar_lang::spec::Parameters, Region); 0] = [];
    assert!(matches!(Engine::of_cells(&plant, none, None, None), Err(RegionError::Shape)));
    let lengths =
        ["1", "2"].map(|length| Region::new(vec![vec![rational(length)]], halves[0].1.clone(), rational("0")).unwrap());
    let other = lengths.map(|region| (&halves[0].0, region));
    assert!(matches!(Engine::of_cells(&plant, other, None, None), Err(RegionError::Shape)));
}

/// In a tube of radius 1/10 around 0, where |J| = 3, x_0' is at most 3/10; a program that knows eps <= r |J| and r alone has to take eps + r |J|.
#[test]
fn bounds_along_the_orbit_leave_what_another_program_does_not_know() {
    let text = r#"{ "format": "sigmastar/plant", "version": 1, "name": "tube", "period": "1", "states": ["x"], "f": ["-3*x"],
        "q": "x^2/2 + x*e", "internal_model": { "mu": "1", "base_frequency": "2*pi", "matched": true,
        "weights": { "family": "power", "n0": "2", "epsilon": "1/2" } } }"#;
    let plant = Plant::from_json("tube", text).unwrap();
    let orbit = || TrigonometricVector { mean: vec![Rational::new()], harmonics: Vec::new() };
    let p = identity(1);
    let samples = FloatSuprema::new(&plant, FloatCurve::from(&orbit()), vec![vec![1.0]], [Some(&p), None]);
    let [x, e] = [rational("0.5"), rational("1")];
    for (radius, least) in [("0.1", 0.6), ("0", 0.0)] {
        let curve = sigmastar_lang::spec::OrbitCurve { centre: orbit(), sensitivities: Vec::new() };
        let region = Region::new(vec![vec![rational("1")]], curve, rational(radius)).unwrap();
        let engine = Engine::new(&plant, region, Some(p.clone()), None).unwrap();
        for bound in [Bound::Qtx, Bound::Qte] {
            let value = prove_value(&engine, &samples, bound, &x, &e).unwrap().value.to_f64();
            assert!(value >= least && value <= 1.01 * least, "{bound:?} with r = {radius}: {value}");
        }
    }
}
