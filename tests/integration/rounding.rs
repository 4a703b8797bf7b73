//! The rounding of the exported law (docs/mathematics.md, 13.6, Proposition A): the counts against the operations of the C code, bit for bit, and
//! what claims for given n_o say of it.

use crate::controller::constant;
use crate::support::{Shipped, certified, certified_in, document, every, json, number, program, read, stored, told};
use rug::Rational;
use serde_json::{Value, json as object};
use sigmastar_decide::conditions::Ladder;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, round_rational};
use sigmastar_lang::spec::{Constant, Oscillators, Sampling, Specification};
use sigmastar_prove::certify::{SampledCertification, certify_sampled};
use sigmastar_prove::rate::sampled::rounding::{ComputedLaw, Rounded};
use sigmastar_regulator::{Design, Stepper};

/// Bits of what is compared with.
const PRECISION: u32 = 200;

const COUNTS: [u32; 4] = [0, 1, 4, 10];

/// The samples of a period that are tried, in this order.
const SAMPLES: [u32; 6] = [120, 250, 500, 2000, 8000, 30000];

struct Random(u64);

impl Random {
    fn word(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) ^ (self.0 << 20)
    }

    fn unit(&mut self) -> f64 {
        (self.word() >> 11) as f64 / 2f64.powi(52) - 1.0
    }

    /// Of a random size between powers of 2.
    fn of_size(&mut self, [low, high]: [i32; 2]) -> f64 {
        let exponent = low + (self.word() % (high - low) as u64) as i32;
        self.unit() * 2f64.powi(exponent)
    }
}

fn exact(value: f64) -> Enclosure {
    Enclosure::from_rational(&Rational::from_f64(value).expect("finite"), PRECISION)
}

/// From a state and a measured error the control and the next state.
type Code = dyn Fn(&[f64], f64) -> (f64, Vec<f64>);

/// The exact law, and the code.
struct Pair {
    law: ComputedLaw,
    /// cos and sin of l w h, exactly, for l = 1, ..., n_o.
    turns: Vec<[Enclosure; 2]>,
    stepper: Box<Code>,
}

fn pair(spec: &Specification, sigma: &Constant, samples: u32, n_o: u32) -> Pair {
    let step = constant(&format!("({})/{samples}", spec.period.nominal().text));
    let design = Design::new(&spec.internal_model, sigma, n_o).for_actuator(spec.input_gain.as_ref());
    let (regulator, discrete) = (design.regulator(), design.discretise(&step).expect("a law"));
    let of = |constant: &Constant| constant.enclose(PRECISION);
    let one = Enclosure::one(PRECISION);
    let weights = &spec.internal_model.weights;
    let law = ComputedLaw {
        gain: Enclosure::from_rational(&spec.internal_model.sampled_gain(&step).expect("a gain").gain, PRECISION),
        decay: &one - of(sigma) * of(&step),
        sigma: of(sigma),
        nominal: spec.input_gain.as_ref().map_or(one, |gain| of(&gain.nominal)),
        n_bar: weights.total(PRECISION).sqrt(),
        roots: (0..=u64::from(n_o)).map(|l| weights.weight(l, PRECISION).sqrt()).collect(),
    };
    let turn = |l: i64| {
        let angle = Enclosure::pi(PRECISION) * (2 * l) / Enclosure::from_integer(i64::from(samples), PRECISION);
        [angle.cos(), angle.sin()]
    };
    let stepper = move |z: &[f64], e: f64| {
        let mut stepper = Stepper::starting(regulator.clone(), discrete.clone(), z.to_vec()).expect("of this size");
        let u = stepper.step(e);
        (u, stepper.state().to_vec())
    };
    Pair { law, turns: (1..=i64::from(n_o)).map(turn).collect(), stepper: Box::new(stepper) }
}

/// How much of du and of dz a step takes; fails beyond 1.
fn shares(pair: &Pair, z: &[f64], m: f64) -> [f64; 2] {
    let Pair { law, turns, stepper } = pair;
    let (u, next) = stepper(z, m);
    let n = |l: usize| law.roots[l].sqr();
    let measured = exact(m);
    let w: Vec<Enclosure> = z
        .iter()
        .enumerate()
        .map(|(i, z)| if i == 0 || i % 2 == 1 { exact(*z) - &measured } else { exact(*z) })
        .collect();
    let mut sum = n(0) * &w[0];
    let mut square = n(0) * w[0].sqr();
    let carry = &law.decay * &measured;
    let mut wrong = n(0) * (exact(next[0]) - (&w[0] + &carry)).sqr();
    for (at, [cos, sin]) in turns.iter().enumerate() {
        let (l, first) = (at + 1, 2 * at + 1);
        let turned = [cos * &w[first] + sin * &w[first + 1], cos * &w[first + 1] - sin * &w[first]];
        sum = sum + n(l) * &turned[0];
        square = square + n(l) * (w[first].sqr() + w[first + 1].sqr());
        let off = [exact(next[first]) - (&turned[0] + &carry), exact(next[first + 1]) - &turned[1]];
        wrong = wrong + n(l) * (off[0].sqr() + off[1].sqr());
    }
    let control = &law.gain * sum - &law.sigma * &measured;
    let off = (exact(u) * &law.nominal - control).abs();
    let (m, w) = (measured.abs(), square.sqrt());
    assert_eq!(law.extraordinary(&m, &w, &w), None);
    let Rounded { control, state } = law.rounded(&m, &w);
    let wrong = wrong.sqrt();
    assert!(
        off.le(&control).is_true() && wrong.le(&state).is_true(),
        "{z:?} {m:?}: {off:?} {control:?}, {wrong:?} {state:?}"
    );
    [(off / control).upper_f64(), (wrong / state).upper_f64()]
}

/// Random states and errors of all sizes, at the edge of cancelling, with and without a nominal gain that no double is; subnormal numbers too.
#[test]
fn the_code_never_rounds_more_than_is_counted() {
    let mut document = document("paper-example");
    let plain = document.clone();
    document["input_gain"] = object!({ "nominal": "3/7", "low": "0.4", "high": "0.5" });
    let mut random = Random(11);
    for (name, document) in [("plain", plain), ("nominal", document)] {
        let spec = Specification::from_json(name, &document.to_string()).expect("sound");
        for n_o in [0, 1, 2, 4, 7, 10] {
            let mut worst = [0.0_f64; 2];
            for (sigma, samples) in [("30", 40), ("100/3", 60), ("7.77", 500), ("61.1", 1000), ("400", 400)] {
                let pair = pair(&spec, &constant(sigma), samples, n_o);
                let sizes = [[-3, 3], [-30, 30], [-3, 0], [-1060, -1000]];
                for trial in 0..120 {
                    let within = sizes[trial % sizes.len()];
                    let m = random.of_size(within);
                    let near = trial % 3 == 0;
                    let z: Vec<f64> = (0..2 * n_o as usize + 1)
                        .map(|i| match near && (i == 0 || i % 2 == 1) {
                            true => m * (1.0 + random.of_size([-50, 1])),
                            false => random.of_size(within),
                        })
                        .collect();
                    let found = shares(&pair, &z, m);
                    worst = [worst[0].max(found[0]), worst[1].max(found[1])];
                }
            }
            println!("{name} n_o = {n_o}: of du {:.3}, of dz {:.3}", worst[0], worst[1]);
            assert!(worst.iter().all(|share| *share > 1e-3), "{name} {n_o}: {worst:?}");
        }
    }
}

/// A claim at samples in doubles, at 1.5 times its least gain, with what it says of the counts; `None` where there is none.
fn in_doubles(spec: &Specification) -> Option<Specification> {
    SAMPLES.iter().find_map(|samples| {
        let mut document = spec.document.clone();
        document["internal_model"]["sampling_period"] = format!("({})/{samples}", spec.period.nominal().text).into();
        document["arithmetic"] = "double".into();
        let spec = Specification::from_json("doubles", &document.to_string()).ok()?;
        claim(&spec, spec.internal_model.sampling.as_ref()?).is_some().then_some(spec)
    })
}

/// The claim at 1.5 times the least gain at samples.
pub fn claim<'s>(spec: &'s Specification, sampling: &Sampling) -> Option<SampledCertification<'s>> {
    let least = certify_sampled(spec, sampling, None, None, Ladder::default()).ok()?;
    let gain = round_rational(&(&least.claim()?.witness.sigma * Rational::from((3, 2))), 6, Direction::Up);
    let run = certify_sampled(spec, sampling, Some(&gain), None, Ladder::default()).ok()?;
    run.claim().is_some().then_some(run)
}

/// Rounding alone is far below what the claim allows the error on the way from the start, sqrt(L_0), for each shipped specification.
#[test]
fn rounding_alone_is_small() {
    let (stride, mut seen) = (every(6), 0);
    for Shipped { name, spec, .. } in certified().iter().step_by(stride) {
        let Some(spec) = in_doubles(spec) else {
            println!("{name}: no claim at samples");
            continue;
        };
        let sampling = spec.internal_model.sampling.as_ref().expect("given");
        let mut run = claim(&spec, sampling).expect("found");
        run.prove_rates(&COUNTS.map(Oscillators::first)).expect("by norms");
        let start = run.claim().expect("certified").witness.set.e0.to_f64();
        for found in &run.for_n_o {
            match found.noise.as_ref().expect("asked for") {
                Ok(bound) => {
                    let [limit, peak] = [&bound.limit, &bound.peak].map(Rational::to_f64);
                    println!(
                        "{name} N_s = {} n_o = {}: limit {limit:.3e}, of E_0 {:.2e}, of the peak {:.2e}",
                        run.sampling.samples,
                        found.oscillators.largest(),
                        limit / start,
                        limit / peak
                    );
                    assert!(limit < 1e-9 * peak, "{name} {}: {limit} {peak}", found.oscillators);
                    seen += 1;
                }
                Err(reason) => println!("{name} {}: {}", found.oscillators, reason.message()),
            }
        }
    }
    assert!(seen * stride >= 40, "{seen}");
}

/// Plants with a sampling period, and what their smallest gain at samples has to be replaced by, for the rounding of the code to be far below the
/// set that they start in: in an ordinary run the first two.
const PLANTS: [(&str, &str, &[&str]); 12] = [
    ("linear", "1/100", &["--sigma", "1", "--peak-error", "2"]),
    ("motor-axis", "1/20000", &[]),
    ("relative-degree-2", "1/1000", &[]),
    ("relative-degree-2-domain", "1/1000", &[]),
    ("pendulum", "1/1000", &[]),
    ("converter", "1/100000", &["--sigma", "3400"]),
    ("duffing", "1/500", &[]),
    ("chain", "1/1000", &[]),
    ("paper-example", "1/1000", &[]),
    ("paper-example-ball", "1/2000", &[]),
    ("paper-example-paper-set", "1/1000", &[]),
    ("paper-example-rotated", "1/1000", &[]),
];

/// Of every shipped plant: what rounding alone makes of e in the limit is below 1e-9 of E_0, for up to 10 oscillators.
#[test]
fn rounding_alone_is_small_of_plants() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("plant.json");
    for (name, step, more) in PLANTS.iter().take(if every(2) == 1 { PLANTS.len() } else { 2 }) {
        let mut plant = json(&std::fs::read(format!("specs/plants/{name}.json")).unwrap());
        plant["arithmetic"] = "double".into();
        std::fs::write(&file, plant.to_string()).unwrap();
        let call = ["--sampling-period", step, "--n-o", "0,4,10", "--no-alternatives", "--format", "json", "-q"];
        let output = program().arg("certify").arg(&file).args(call).args(*more).output().unwrap();
        let report = json(&output.stdout);
        assert_eq!(output.status.code(), Some(0), "{name}: {report:#}");
        let e_0 = number(&report["initial_set"]["E0"]);
        for found in report["for_n_o"].as_array().unwrap() {
            let share = number(&found["noise"]["limit"]) / e_0;
            println!("{name} {step} n_o = {}: {share:.2e} of E_0 = {e_0}", found["n_o"]);
            assert!(share < 1e-9, "{name} {}: {share}", found["n_o"]);
        }
    }
}

/// A certificate of the paper's example with these members, and its report.
fn written(members: &[(&str, Value)], arguments: &[&str]) -> (Value, Value) {
    let folder = tempfile::tempdir().expect("a folder");
    let mut document = document("paper-example-at-rest");
    members.iter().for_each(|(name, value)| document[*name] = value.clone());
    let flags = [&["--no-alternatives", "--sigma", "60"], arguments].concat();
    let (certificate, report) = certified_in(folder.path(), &document, &flags);
    (report, read(certificate))
}

const AT: [&str; 4] = ["--sampling-period", "1/500", "--n-o", "0,2"];
const OF_ROUNDING: [&str; 4] = ["z_low", "z_up", "z_noise", "level"];

#[test]
fn a_certificate_in_doubles_says_so() {
    let noise = [("measurement", object!({ "noise": "0.0001" })), ("disturbance", object!("0.002"))];
    let double = ("arithmetic", object!("double"));
    for (members, parts, inputs) in [
        (vec![double.clone()], "computed in double precision as exported", [true, true, false]),
        (
            [noise.to_vec(), vec![double.clone()]].concat(),
            "noise of at most 0.0001 on the measurement of e, a disturbance of at most 0.002 added to q, computed in double precision as exported",
            [true, true, true],
        ),
    ] {
        let (report, certificate) = written(&members, &AT);
        for i in 0..2 {
            let [claim, witness] = ["claim", "witness"].map(|part| &certificate[part]["for_n_o"][i]);
            assert_eq!(claim["noise"], report["for_n_o"][i]["noise"]);
            assert!(OF_ROUNDING.iter().all(|name| witness["noise"][*name].is_string()), "{witness}");
            assert_eq!(["g_d", "g_v", "g_r"].map(|name| witness["noise"][name].is_string()), inputs);
            let [limit, peak] = ["limit", "peak"].map(|name| claim["noise"][name].as_str().expect("a number"));
            let said = format!(
                " With n_o = {} and sigma = 60 exactly, {parts}: |e(t) - e_per(t)| <= {peak} for these starts and all t >= t_0, and its \
                 limit superior is at most {limit}.",
                claim["n_o"]
            );
            assert!(certificate["claim"]["statement"].as_str().expect("words").contains(&said), "{said}");
        }
    }
    // Without it the claim is what it was, and the field says so too.
    let (_, plain) = written(&noise, &AT);
    let exact = ("arithmetic", object!("exact"));
    let (_, named) = written(&[noise.to_vec(), vec![exact]].concat(), &AT);
    assert_eq!((&plain["claim"], &plain["witness"]), (&named["claim"], &named["witness"]));
    let without = |name: &&str| plain["witness"]["for_n_o"][0]["noise"][*name].is_null();
    assert!(OF_ROUNDING.iter().all(without));
}

/// From an aligned start, which measures with rounding, factor and limit do not add up to a bound of the way.
#[test]
fn the_way_from_an_aligned_start_is_bounded_by_the_peak() {
    let folder = tempfile::tempdir().expect("a folder");
    for (kind, expected) in [("aligned", [true, false]), ("at-rest", [false, true])] {
        let mut document = document("paper-example");
        document["arithmetic"] = object!("double");
        document["initial_set"] = object!({ "kind": kind });
        let file = stored(folder.path(), "spec.json", &document);
        let mut call = program();
        call.args(["certify", "--no-alternatives", "--sigma", "60"]).args(AT).arg(file);
        let (code, text) = told(&mut call);
        let words = [" if computed exactly, and if rounded at most ", " more if rounded"];
        assert_eq!((code, words.map(|words| text.contains(words))), (0, expected), "{text}");
    }
}

#[test]
fn where_rounding_does_not_count_a_remark_or_a_reason_says_so() {
    let double = ("arithmetic", object!("double"));
    // In continuous time, and at samples without numbers of oscillators.
    let (report, certificate) = written(std::slice::from_ref(&double), &["--n-o", "1"]);
    assert!(report["remarks"].to_string().contains("--sampling-period H --n-o LIST"), "{}", report["remarks"]);
    let (_, plain) = written(&[], &["--n-o", "1"]);
    assert_eq!((&plain["claim"], &plain["witness"]), (&certificate["claim"], &certificate["witness"]));
    let (report, _) = written(std::slice::from_ref(&double), &AT[..2]);
    assert!(report["remarks"].to_string().contains("--n-o LIST"), "{}", report["remarks"]);
    let actuator = ("actuator", object!({ "max": "1000" }));
    let (report, certificate) = written(&[double, actuator], &AT);
    let said = report["for_n_o"][0]["noise"]["reason"].as_str().expect("a reason");
    assert!(said.contains("`actuator`") && said.contains("rounding"), "{said}");
    assert!(certificate["claim"]["for_n_o"][0]["noise"].is_null());
}

/// Single precision is an error that says what the code does.
#[test]
fn single_precision_is_refused() {
    let mut document = document("paper-example");
    document["arithmetic"] = "single".into();
    let errors = Specification::from_json("single", &document.to_string()).expect_err("refused");
    assert!(errors.to_string().contains("double precision"), "{errors}");
}
