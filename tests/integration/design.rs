//! `sigmastar design`: the pair to take is the first of the table that is proved to meet every requirement, and its certificate says so.

use super::support::{
    EXAMPLE, EXAMPLE_TEXT, PLANT_TEXT, ROOT, assert_valid, in_one_line, json, number, program, read, stored, told, utf8,
};
use predicates::str::contains;
use serde_json::{Value, json};
use std::path::Path;

/// `v' = -v + e + cos(phase)`, with two harmonics in q; period 2.
fn plant() -> Value {
    json!({
        "format": "sigmastar/plant", "version": 1, "name": "designed", "period": 2, "states": ["v"],
        "f": ["-v + e + cos(phase)"], "q": "v/2 + e/2 + sin(phase) + sin(6*phase)/2",
        "initial_set": { "kind": "aligned", "X0": "1/2", "E0": "1/2" },
        "internal_model": {
            "mu": 1, "base_frequency": "pi", "matched": true, "weights": { "family": "power", "n0": 2, "epsilon": "1/2" },
        },
    })
}

fn design(file: &Path, flags: &[&str], code: i32) -> Value {
    let mut command = program();
    command.arg("design").arg(file).args(flags).args(["-q", "--format", "json"]);
    json(&command.assert().code(code).get_output().stdout)
}

const REQUIRED: [&str; 3] = ["steady_error", "peak_error", "max_control"];

/// The rows as (sigma, n_o, bounds), in the order of the table.
fn pairs(report: &Value) -> Vec<(String, u64, [f64; 3])> {
    let of_row = |row: &Value| {
        let sigma = row["sigma"].as_str().unwrap().to_owned();
        let cells = row["cells"].as_array().unwrap().iter();
        cells
            .map(|cell| (sigma.clone(), cell["n_o"].as_u64().unwrap(), REQUIRED.map(|name| number(&cell[name]))))
            .collect::<Vec<_>>()
    };
    report["rows"].as_array().unwrap().iter().flat_map(of_row).collect()
}

#[test]
fn the_pair_to_take_is_the_first_that_meets_every_requirement() {
    let folder = tempfile::tempdir().unwrap();
    let file = stored(folder.path(), "plant.json", &plant());
    let table = pairs(&design(&file, &["--n-o", "0,1,2", "--no-simulation"], 0));
    // What the second gain has with one oscillator, which the first has not.
    let (_, _, [steady, peak, control]) = &table[4];
    assert!(*peak < table[1].2[1]);
    let above = |bound: &f64| format!("{:.6}", 1.001 * bound);
    let flags = ["--steady-error", &above(steady), "--peak-error", &above(peak), "--max-control", &above(control)];
    let output = folder.path().join("c.json");
    let report = design(&file, &[&flags[..], &["--n-o", "0,1,2", "-o", output.to_str().unwrap()]].concat(), 0);
    let take = &report["take"];
    assert_eq!((&take["met"], take["requirements"].as_array().unwrap().len()), (&json!(true), 3));
    let limits = [steady, peak, control].map(|bound| number(&json!(above(bound))));
    let meets = |bounds: &[f64; 3]| bounds.iter().zip(limits).all(|(bound, limit)| *bound <= limit);
    let rows = pairs(&report);
    let (sigma, n_o, _) = rows.iter().find(|(_, _, bounds)| meets(bounds)).unwrap();
    assert_eq!((take["sigma"].as_str(), take["n_o"].as_u64()), (Some(sigma.as_str()), Some(*n_o)));
    let gains: Vec<f64> = report["rows"].as_array().unwrap().iter().map(|row| number(&row["sigma"])).collect();
    assert!(gains.windows(2).all(|pair| pair[0] < pair[1]), "{gains:?}");
    // The certificate is of that gain, has its numbers, and the checker decides it.
    let certificate = read(&output);
    assert_eq!(certificate["claim"]["sigma_star"], take["sigma"]);
    let entry = certificate["claim"]["by_n_o"].as_array().unwrap().iter().find(|entry| entry["n_o"] == *n_o).unwrap();
    let in_certificate = [&entry["steady"]["e"], &entry["largest"]["e"], &entry["largest"]["u"]].map(number);
    for (compared, (limit, stated)) in
        take["requirements"].as_array().unwrap().iter().zip(limits.iter().zip(in_certificate))
    {
        assert!(stated <= *limit && (stated / number(&compared["proved"]) - 1.0).abs() < 1e-11, "{stated} {compared}");
    }
    assert_valid(&output);
    // What is simulated is below what is proved, and not far.
    for row in report["rows"].as_array().unwrap() {
        for cell in row["cells"].as_array().unwrap() {
            for name in REQUIRED {
                let (found, bound) = (cell["simulated"][name].as_f64().unwrap(), number(&cell[name]));
                assert!(
                    found <= bound * (1.0 + 1e-6) + 1e-12 && (name == "steady_error" || bound < 3.0 * found),
                    "{name} {cell}"
                );
            }
        }
    }
}

#[test]
fn what_is_missed_is_told_and_writes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let (file, output) = (stored(folder.path(), "plant.json", &plant()), folder.path().join("c.json"));
    let flags = ["--steady-error", "0.2", "--max-control", "0.001", "--n-o", "0,2", "--no-simulation"];
    let mut command = program();
    command.arg("design").arg(&file).args(flags).arg("-o").arg(&output);
    let assert = command.assert().code(3).stderr(contains("not all that is required is proved"));
    let text = in_one_line(&utf8(assert.get_output().stdout.clone()));
    assert!(text.contains("comes closest; not met: largest |u|"), "{text}");
    assert!(!output.exists());
    // A rate is proved, so it settles; at once it does not.
    let settles = |periods| {
        let flags = ["--steady-error", "0.2", "--settle", periods, "--n-o", "2", "--no-simulation"];
        program().arg("design").arg(&file).args(flags).arg("-q").output().unwrap().status.code()
    };
    assert_eq!([settles("60"), settles("0.01")], [Some(0), Some(3)]);
}

#[test]
fn at_samples_of_gains_and_of_a_specification() {
    let folder = tempfile::tempdir().unwrap();
    let file = stored(folder.path(), "plant.json", &plant());
    let report = design(&file, &["--sampling-period", "1/100", "--sigma", "12,8", "--n-o", "0,1"], 0);
    assert_eq!(report["sampling"], json!({ "sampling_period": "0.01", "samples": 200 }));
    let gains: Vec<&Value> = report["rows"].as_array().unwrap().iter().map(|row| &row["sigma"]).collect();
    assert_eq!(gains, ["8", "12"]);
    let found = &report["rows"][1]["cells"][0]["simulated"];
    assert!(found["peak_error"].as_f64().unwrap() <= number(&report["rows"][1]["cells"][0]["peak_error"]), "{found}");
    // Of a specification there is no plant to simulate, and bounds are by the conditions.
    let report = design(Path::new(EXAMPLE), &["--n-o", "0,3"], 0);
    assert_eq!(report["rows"][0]["cells"][0]["simulated"], Value::Null);
    assert_eq!(report["rows"][0]["sigma"], "39.8018");
    // At samples nothing of it depends on their number, which is told.
    let said = "more oscillators do not lower this bound";
    let text = |flags: &[&str]| told(program().args(["design", EXAMPLE, "-q", "--sigma", "60"]).args(flags)).1;
    let sampled = text(&["--sampling-period", "1/1000", "--n-o", "0,3"]);
    assert!(sampled.contains(said), "{sampled}");
    assert!(
        !text(&["--n-o", "0,3"]).contains(said) && !text(&["--sampling-period", "1/1000", "--n-o", "3"]).contains(said)
    );
}

#[test]
fn calls_without_an_answer() {
    let folder = tempfile::tempdir().unwrap();
    let file = stored(folder.path(), "plant.json", &plant());
    let many = (1..=21).map(|gain| gain.to_string()).collect::<Vec<_>>().join(",");
    for (flags, said) in [
        (&["--noise", "0.1"][..], "--noise: the document states neither noise nor a disturbance"),
        (&["--settle", "3"], "--steady-error"),
        (&["--n-o", "0..20"], "--n-o: 21 numbers of oscillators"),
        (&["--steady-error", "-1"], "--steady-error"),
        (&["--sigma", &many], "--sigma: 21 gains"),
        (&["--sigma", "0.1,x"], "--sigma"),
        (&["--sampling-period", "1/5", "--n-o", "0,5"], "half of the samples"),
    ] {
        program().arg("design").arg(&file).args(flags).assert().code(2).stderr(contains(said));
    }
    // A gain that is too small is told with its reason, and beside others.
    let (code, text) = told(program().arg("design").arg(&file).args(["--sigma", "0.001"]));
    assert!(code == 3 && text.contains("0.001 is below the smallest one found"), "{text}");
    let report = design(&file, &["--sigma", "0.001,2", "--n-o", "0", "--no-simulation"], 0);
    assert_eq!((&report["not_certified"], &report["rows"][0]["sigma"]), (&json!(["0.001"]), &json!("2")));
    let flags = ["--sigma", "0.001,2", "--n-o", "0", "--no-simulation", "-q"];
    let (_, text) = told(program().arg("design").arg(&file).args(flags));
    // The reason is whole, however long it is.
    let reason = text.split("not certified: sigma = 0.001: ").nth(1).expect("a reason");
    assert!(reason.contains("the gain 0.001") && !reason.contains("..."), "{text}");
}

/// What is missed is told with what helps, and with its cause where nothing does; of a table without a pair to take nothing is said of that pair.
#[test]
fn what_is_missed_is_told_with_what_helps() {
    let folder = tempfile::tempdir().unwrap();
    let file = stored(folder.path(), "plant.json", &plant());
    let told_of = |flags: &[&str]| {
        let (code, text) =
            told(program().arg("design").arg(&file).args(flags).args(["--sigma", "2,3", "-q", "--no-simulation"]));
        (code, text)
    };
    let (code, text) = told_of(&["--n-o", "0", "--steady-error", "1e-6", "--settle", "4", "--max-control", "1e-3"]);
    assert_eq!(code, 3);
    for said in [
        "steady |e|: more oscillators (`--n-o`)",
        "largest |u|: another gain hardly helps, because along the periodic solution alone the bound of |u| is ",
        "periods to settle: the steady error is not proved to be below",
    ] {
        assert!(text.contains(said), "{said}: {text}");
    }
    assert!(!text.contains("gain to take") && !text.contains("next:"), "{text}");
    let (code, text) = told_of(&["--n-o", "2", "--steady-error", "0.2", "--settle", "0.01", "--peak-error", "0.001"]);
    assert!(code == 3 && text.contains("periods to settle: fewer oscillators"), "{text}");
    assert!(text.contains("no gain can do that, because the initial set has |e| up to "), "{text}");
    // Where E0 is left open it falls with the gain.
    let mut open = plant();
    open["initial_set"] = json!({ "kind": "aligned" });
    let open = stored(folder.path(), "open.json", &open);
    let flags = ["--sigma", "3", "--n-o", "2", "--peak-error", "0.001", "-q", "--no-simulation"];
    let (code, text) = told(program().arg("design").arg(&open).args(flags));
    assert!(code == 3 && text.contains("state a smaller `E0`, or take a larger gain"), "{text}");
    assert!(!text.contains("no gain can do that"), "{text}");
    let (code, text) = told_of(&["--n-o", "2", "--steady-error", "0.2"]);
    assert!(code == 0 && text.contains("next: the certificate of the gain to take is what `-o FILE` writes"), "{text}");
}

/// What is proved is what the certificate says, so a limit between that and what the search found is missed.
#[test]
fn what_counts_is_the_number_of_the_certificate() {
    let folder = tempfile::tempdir().unwrap();
    let file = stored(folder.path(), "plant.json", &plant());
    let flags = ["--sigma", "3", "--n-o", "0", "--no-simulation"];
    let output = folder.path().join("c.json");
    let report = design(&file, &[&flags[..], &["-o", output.to_str().unwrap()]].concat(), 0);
    let bound = number(&report["rows"][0]["cells"][0]["peak_error"]);
    let stated = number(&read(&output)["claim"]["by_n_o"][0]["largest"]["e"]);
    assert!((bound / stated - 1.0).abs() < 1e-11, "{bound} {stated}");
    let with = |limit: f64, code| {
        let limit = format!("{limit:.9}");
        let report = design(&file, &[&flags[..], &["--peak-error", &limit]].concat(), code);
        report["take"]["met"].as_bool().unwrap()
    };
    assert!(with(bound * (1.0 + 1e-8), 0) && !with(bound * (1.0 - 1e-8), 3));
    let unstated = &report["rows"][0]["cells"][0]["not_in_certificate"];
    assert_eq!((unstated, &report["without_noise"]), (&json!([]), &json!(false)));
    // A specification has no bounds by the number of oscillators in its certificate.
    let report = design(Path::new(EXAMPLE), &["--n-o", "1", "--sigma", "50"], 0);
    assert_eq!(report["rows"][0]["cells"][0]["not_in_certificate"], json!(["steady_error", "peak_error"]));
}

#[test]
fn noise_and_data_of_no_plant_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let mut document = plant();
    document["measurement"] = json!({ "noise": "1/1000" });
    let file = stored(folder.path(), "noisy.json", &document);
    let flags = ["--sigma", "9", "--n-o", "0", "--no-simulation", "-q", "--noise", "1/10"];
    let with = |more: &[&str]| {
        let flags = [&flags[..], more].concat();
        in_one_line(&utf8(program().arg("design").arg(&file).args(flags).output().unwrap().stdout))
    };
    let text = with(&[]);
    assert!(text.contains("every requirement is proved to be met in the loop with noise."), "{text}");
    let text = with(&["--max-control", "1000000"]);
    assert!(text.contains("met in the loop with noise.") && text.contains("largest |u| with noise"), "{text}");
    document["actuator"] = json!({ "max": "100" });
    let file = stored(folder.path(), "actuator.json", &document);
    let text = in_one_line(&utf8(program().arg("design").arg(&file).args(&flags[..6]).output().unwrap().stdout));
    assert!(text.contains("nothing is proved about these"), "{text}");
    program().arg("design").arg(&file).args(flags).assert().code(2).stderr(contains("nothing is proved of noise with"));
}

/// With noise the requirements are about the loop with it: the steady error has the limit of noise besides, and so has the peak, with what misleads an
/// aligned start; it is far below the peak of the certificate, which is of every plant. Continuous and at samples.
#[test]
fn requirements_are_about_the_loop_with_noise() {
    let folder = tempfile::tempdir().unwrap();
    let flags = ["--sigma", "9", "--n-o", "1", "--no-simulation"];
    let cell = |document: &Value, more: &[&str]| {
        let file = stored(folder.path(), "plant.json", document);
        let report = design(&file, &[&flags[..], more].concat(), 0);
        report["rows"][0]["cells"][0].clone()
    };
    for at_samples in [&[][..], &["--sampling-period", "1/500"]] {
        let mut document = plant();
        assert_eq!(cell(&document, at_samples)["with_noise"], Value::Null);
        document["measurement"] = json!({ "noise": "1/1000" });
        document["disturbance"] = json!("1/200");
        for (kind, is_misled) in [("aligned", true), ("at-rest", false)] {
            document["initial_set"]["kind"] = json!(kind);
            let found = cell(&document, &[at_samples, &["--steady-error", "1/2", "--settle", "50"]].concat());
            let of = |name: &str| number(&found[name]);
            let with = |name: &str| number(&found["with_noise"][name]);
            let limit = of("noise");
            assert!(limit > 0.0 && (with("steady_error") - of("steady_error") - limit).abs() < 1e-9, "{found}");
            let misled = with("peak_error") - of("peak_error") - limit;
            // The one from the error box may be less.
            assert!(misled < if is_misled { 0.1 } else { 1e-9 }, "{kind}: {found}");
            // By the exponential, its limit and what misleads the start; at samples between the samples, too, where the peak is.
            let room = 0.5 - with("steady_error");
            let periods = |misled: f64| ((of("factor") + misled) / room).ln() / (2.0 * of("rate"));
            let settle = of("settle");
            assert!(
                settle > periods(0.0) - 1e-9 && settle < periods(if is_misled { 0.1 } else { 0.0 }) + 1e-6,
                "{kind}: {settle} {found}"
            );
        }
        // Each limit lies between what is proved without noise and with it.
        let between = |name: &str, found: &Value| (number(&found[name]) + number(&found["with_noise"][name])) / 2.0;
        let found = cell(&document, at_samples);
        let named =
            [("steady_error", "--steady-error"), ("peak_error", "--peak-error"), ("max_control", "--max-control")];
        for (name, flag) in named {
            let limit = between(name, &found).to_string();
            let file = stored(folder.path(), "plant.json", &document);
            let report = design(&file, &[&flags[..], at_samples, &[flag, &limit]].concat(), 3);
            let words = report["sentence"].as_str().unwrap();
            assert!(
                words.ends_with(if name == "max_control" { "|u| with noise." } else { "|e| with noise." }),
                "{words}"
            );
        }
    }
}

/// What holds with noise holds without: the peak without noise is never above the one with it, although the two have proofs of their own. Of a
/// nonlinear plant and of a specification; with one oscillator the proof with noise has the smaller peak.
#[test]
fn the_peak_without_noise_is_not_above_the_peak_with_noise() {
    let folder = tempfile::tempdir().unwrap();
    for (shipped, sigma) in [(PLANT_TEXT, "30"), (EXAMPLE_TEXT, "60")] {
        let mut document = json(shipped.as_bytes());
        document["measurement"] = json!({ "noise": "1/1000" });
        let file = stored(folder.path(), "noisy.json", &document);
        let report = design(&file, &["--sigma", sigma, "--n-o", "0,1", "--no-simulation"], 0);
        let peaks = |cell: &Value| [&cell["peak_error"], &cell["with_noise"]["peak_error"]].map(number);
        let [[none, none_noisy], [one, one_noisy]] =
            [0, 1].map(|index: usize| peaks(&report["rows"][0]["cells"][index]));
        assert!(none < none_noisy && one <= one_noisy, "{report:#}");
        // Of the plant trials have the smaller peak.
        assert!(
            shipped == PLANT_TEXT || one == one_noisy,
            "the proof with noise has the smaller peak no more: take another case"
        );
    }
}

/// A plant whose error decays by itself has a smallest gain of 1e-10: the others of the table, and the larger one that a report leads with, are such as a loop
/// is fast with.
#[test]
fn larger_gains_of_a_tiny_one_go_with_the_period() {
    let plant = Path::new(ROOT).join("specs/plants/linear.json");
    let report = design(&plant, &["--n-o", "0,1", "--no-simulation"], 0);
    let rows = report["rows"].as_array().unwrap();
    let gains: Vec<f64> = rows.iter().map(|row| number(&row["sigma"])).collect();
    assert!(gains[0] < 1e-9 && gains[1..] == [1.2, 1.5, 2.0, 3.0, 5.0], "{gains:?}");
    // mu = 1 and T = 1: a rate is near 1 with the larger gains, and none counts with the smallest.
    let rates: Vec<f64> =
        rows.iter().map(|row| row["cells"][0]["rate"].as_str().map_or(0.0, |rate| rate.parse().unwrap())).collect();
    assert!(rates[0] < 1e-9 && rates[1..].iter().all(|rate| *rate > 1.0), "{rates:?}");
    let text = utf8(program().args(["certify", "--n-o", "0,1", "-q"]).arg(&plant).output().unwrap().stdout);
    assert!(text.contains("  - larger gain: sigma = 5 keeps"), "{text}");
}

/// The longest sampling period of a row is certified with its gain, and is that of `sampling`.
#[test]
fn the_longest_sampling_period_of_each_gain() {
    let folder = tempfile::tempdir().unwrap();
    let file = stored(folder.path(), "plant.json", &plant());
    let flags = ["--sigma", "2,9", "--n-o", "0", "--no-simulation", "--sampling-periods"];
    let report = design(&file, &flags, 0);
    let pairs =
        program().arg("sampling").arg(&file).args(["--sigma", "2,9", "-q", "--format", "json"]).output().unwrap();
    let pairs = json(&pairs.stdout);
    for (index, row) in report["rows"].as_array().unwrap().iter().enumerate() {
        let round = &row["longest_h"]["round"];
        assert_eq!(round["sampling_period"], pairs["round"][index]["sampling_period"], "{row}");
        let [longest, round_samples] =
            ["longest", "round"].map(|name| row["longest_h"][name]["samples"].as_u64().unwrap());
        assert!(longest <= round_samples, "{row}");
        let step = round["sampling_period"].as_str().unwrap();
        let sigma = row["sigma"].as_str().unwrap();
        let call = ["--sigma", sigma, "--sampling-period", step, "-q", "--no-alternatives"];
        program().arg("certify").arg(&file).args(call).assert().code(0);
    }
    let (_, text) = told(program().arg("design").arg(&file).args(flags).arg("-q"));
    let taken = report["rows"].as_array().unwrap().iter().find(|row| row["sigma"] == report["take"]["sigma"]).unwrap();
    let step = taken["longest_h"]["round"]["sampling_period"].as_str().unwrap();
    assert!(text.contains(&format!("At samples it is certified with the sampling period h = {step}")), "{text}");
    // A gain that asks for more samples than are taken has none; of samples that are given nothing is asked.
    let flags = ["--sigma", "100000", "--n-o", "0", "--no-simulation", "--sampling-periods"];
    assert_eq!(design(&file, &flags, 0)["rows"][0]["longest_h"], Value::Null);
    let (_, text) = told(program().arg("design").arg(&file).args(flags).arg("-q"));
    assert!(text.contains("No sampling period was found that is certified with sigma = 100000"), "{text}");
    let flags = ["--sampling-periods", "--sampling-period", "1/100"];
    program().arg("design").arg(&file).args(flags).assert().code(2).stderr(contains("cannot be used with"));
    let mut sampled = plant();
    sampled["internal_model"]["sampling_period"] = json!("1/100");
    let sampled = stored(folder.path(), "sampled.json", &sampled);
    let call = program().arg("design").arg(&sampled).arg("--sampling-periods").assert();
    call.code(2).stderr(contains("--sampling-periods: the table is about samples that are given"));
}

/// Of the values of mu that are tried the best one is in the certificate, and no better one was seen.
#[test]
fn values_of_free_numbers_are_chosen() {
    let folder = tempfile::tempdir().unwrap();
    let (file, output) = (stored(folder.path(), "plant.json", &plant()), folder.path().join("c.json"));
    let required = ["--steady-error", "0.2", "--n-o", "2", "--sigma", "4,6", "--no-simulation"];
    let report =
        design(&file, &[&required[..], &["--choose", "mu=1/8..2", "-o", output.to_str().unwrap()]].concat(), 0);
    let tried = report["values"]["tried"].as_array().unwrap();
    // Its own first, then those in the middle of four equal parts of the range in logarithms.
    let values: Vec<&str> = tried.iter().map(|one| one["values"]["mu"].as_str().unwrap()).collect();
    assert_eq!(values, ["1", "0.18", "0.35", "0.71", "1.4"]);
    let taken = report["values"]["taken"]["mu"].as_str().unwrap();
    let best = tried.iter().find(|one| one["values"]["mu"] == taken).unwrap();
    let rate = |one: &Value| if one["rate"].is_null() { 0.0 } else { number(&one["rate"]) };
    for one in tried {
        let missed = |one: &Value| one["missed"].as_u64().unwrap();
        assert!((missed(best), -rate(best)) <= (missed(one), -rate(one)), "{taken}: {one}");
    }
    assert!(rate(best) > rate(&tried[0]), "{tried:?}");
    // The row is that of the file with this value, and so is the certificate.
    let mut with = plant();
    with["internal_model"]["mu"] = json!(taken);
    let with = stored(folder.path(), "with.json", &with);
    let same = design(&with, &required, 0);
    assert_eq!((&same["rows"], &same["specification"]), (&report["rows"], &report["specification"]));
    assert_eq!(read(&output)["plant"]["internal_model"]["mu"], taken);
    assert_valid(&output);
    let said = format!("with n_o = 2 and mu = {taken}: every requirement is proved to be met");
    assert!(report["sentence"].as_str().unwrap().contains(&said), "{}", report["sentence"]);
    // With the values of the file alone nothing is told of values, and it is the same file.
    let plain = design(&file, &required, 0);
    assert_eq!(plain["values"], Value::Null);
    for (numbers, said) in [
        ("nu", "--choose: `nu` is no number that can be tuned here"),
        ("mu=2..1", "--choose: `2..1` is no range for `mu`"),
        ("base_frequency", "--choose: the base frequency is not free"),
    ] {
        program().arg("design").arg(&file).args(["--choose", numbers]).assert().code(2).stderr(contains(said));
    }
}

/// Each group of gains is told before it is proved, where that is asked for; and that sizes are open where some are.
#[test]
fn what_is_proved_next_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let file = stored(folder.path(), "plant.json", &plant());
    let with = |file: &Path, more: &[&str]| {
        let flags = ["--sigma", "2,9", "--n-o", "0", "--no-simulation", "--steady-error", "1"];
        let output = program().arg("design").arg(file).args(flags).args(more).output().unwrap();
        [output.stdout, output.stderr].map(|bytes| in_one_line(&utf8(bytes)))
    };
    let [text, said] = with(&file, &["--choose", "mu=1..2", "--progress"]);
    assert!(
        said.contains("proving a table with mu = 1 (after ") && said.contains("proving sigma = 2, 9 (after "),
        "{said}"
    );
    assert_eq!(said.matches("proving a table").count(), 5, "{said}");
    assert!(!text.contains("sizes of it open") && text.contains("settles in: after so many periods"), "{text}");
    let [quiet, said] = with(&file, &["-q"]);
    assert!(said.is_empty() && !quiet.is_empty(), "{said}");
    let mut open = plant();
    open["initial_set"] = json!({ "kind": "aligned", "X0": "1/2" });
    let [text, _] = with(&stored(folder.path(), "open.json", &open), &["-q"]);
    assert!(text.contains("the file leaves sizes of it open, which differ from gain to gain"), "{text}");
}

/// What is simulated settles no later than what is proved; a limit that no run exceeds is kept from the start; without a limit nothing settles.
#[test]
fn simulations_settle_before_the_proved_time() {
    let folder = tempfile::tempdir().unwrap();
    let file = stored(folder.path(), "plant.json", &plant());
    for sampling in [&[][..], &["--sampling-period", "1/50"]] {
        let flags =
            |limit: &'static str| [&["--sigma", "9", "--n-o", "1,2", "--steady-error", limit], sampling].concat();
        for cell in design(&file, &flags("1/5"), 0)["rows"][0]["cells"].as_array().unwrap() {
            let (proved, found) = (number(&cell["settle"]), cell["simulated"]["settle"].as_f64().unwrap());
            assert!(0.01 < found && found <= proved, "{cell}");
        }
        let report = design(&file, &flags("100"), 0);
        assert!(report["rows"][0]["cells"][0]["simulated"]["settle"] == 0.0, "{report:#}");
        let without = [&["--sigma", "9", "--n-o", "1"], sampling].concat();
        assert!(design(&file, &without, 0)["rows"][0]["cells"][0]["simulated"]["settle"].is_null());
    }
}

/// A set of harmonics stands in the table by its number of oscillators, with the bounds and the rate of its own that its certificate has; each row is about
/// every set. With it the first and the sixth harmonic of q are met by two oscillators, where n_o = 2 leaves the sixth.
#[test]
fn sets_of_harmonics_are_in_the_table() {
    let folder = tempfile::tempdir().unwrap();
    let file = stored(folder.path(), "plant.json", &plant());
    let output = folder.path().join("c.json");
    let flags = ["--sigma", "9", "--n-o", "1,2,3", "--harmonics", "0,1,6", "--steady-error", "1e-3", "-o"];
    let report = design(&file, &[&flags[..], &[output.to_str().unwrap()]].concat(), 0);
    assert_eq!((&report["take"]["n_o"], &report["take"]["harmonics"]), (&json!(null), &json!([0, 1, 6])));
    let cells = report["rows"][0]["cells"].as_array().unwrap();
    let which: Vec<_> = cells.iter().map(|cell| [cell["n_o"].clone(), cell["harmonics"].clone()]).collect();
    let none = json!(null);
    assert_eq!(
        which,
        [[json!(1), none.clone()], [json!(2), none.clone()], [none.clone(), json!([0, 1, 6])], [json!(3), none]]
    );
    let [of_two, of_set] = [&cells[1], &cells[2]];
    assert!(number(&of_two["steady_error"]) > 0.01 && number(&of_set["steady_error"]) < 1e-6);
    // What simulations with exactly these oscillators come to is below, and near for the error.
    let simulated = |cell: &Value, name: &str| cell["simulated"][name].as_f64().unwrap();
    assert!(simulated(of_two, "steady_error") > 0.9 * number(&of_two["steady_error"]));
    assert!(simulated(of_set, "steady_error") < 1e-6);
    for cell in cells {
        assert!(
            ["peak_error", "max_control"].iter().all(|name| simulated(cell, name) <= number(&cell[*name])),
            "{cell}"
        );
    }
    let certificate = read(&output);
    assert_valid(&output);
    assert!(!certificate["claim"]["harmonics"].is_null());
    let rates = certificate["claim"]["for_n_o"].as_array().unwrap();
    let own = rates.iter().find(|rate| rate["harmonics"] == json!([0, 1, 6])).unwrap();
    assert_eq!([&own["rate"], &own["factor"]], [&of_set["rate"], &of_set["factor"]]);
    let told = program().arg("design").arg(&file).args(&flags[..8]).assert().code(0).get_output().stdout.clone();
    let text = in_one_line(&utf8(told));
    assert!(
        text.contains("oscillators at the harmonics 0, 1, 6: every") && text.contains("--harmonics 0,1,6"),
        "{text}"
    );
    // A set of harmonics that the samples do not tell apart, or without 0, is refused.
    for (flags, why) in [
        (&["--harmonics", "0,60", "--sampling-period", "1/50"][..], "half of the samples"),
        (&["--harmonics", "1,2"], "0"),
        (&["--harmonics", "0,2", "--n-o", "0..7"], "at most 8"),
    ] {
        program().arg("design").arg(&file).args(flags).assert().code(2).stderr(contains(why));
    }
}
