//! The exported C code: the operations of the Rust stepper, bit for bit, and names that two regulators can share a program with.

use crate::controller::{constant, controller, example, installed, signal};
use crate::support::{ROOT, process, utf8};
use sigmastar_regulator::{Design, Stepper};
use std::path::{Path, PathBuf};
use std::process::Command as Process;

/// How the code is compiled; nothing may be said of it.
const STRICT: [&str; 6] = ["-std=c99", "-O2", "-Wall", "-Wextra", "-pedantic", "-Werror"];

pub fn gcc(arguments: &[&Path], program: &Path) {
    let gcc = Process::new("gcc").args(STRICT).arg("-o").arg(program).args(arguments).output().unwrap();
    assert!(gcc.status.success(), "{}", String::from_utf8_lossy(&gcc.stderr));
}

/// Runs the exported C code over the signal and returns the bits of every output.
fn run_c(folder: &Path, n_o: u32, limit: Option<&str>, steps: u32) -> Vec<u64> {
    let source = folder.join("regulator.c");
    let n_o_text = n_o.to_string();
    let arguments = ["specs/paper-example.json", "--sigma", "97/2", "--n-o", &n_o_text, "--discretise", "1/500"];
    let mut call = controller(&arguments);
    if let Some(limit) = limit {
        call.args(["--saturation", limit]);
    }
    call.args(["--format", "c", "-o"]).arg(&source).assert().success().stdout("").stderr("");
    let inputs: Vec<String> = (0..steps).map(|k| format!("0x{:016x}ULL", signal(k).to_bits())).collect();
    let main = format!(
        "#include \"regulator.h\"\n#include <stdio.h>\n#include <string.h>\n\
         static const unsigned long long inputs[] = {{ {} }};\n\
         int main(void) {{ sigmastar_controller c; unsigned i; sigmastar_reset(&c);\n\
         for (i = 0; i < {steps}; i++) {{ double e, u; unsigned long long bits; memcpy(&e, &inputs[i], 8);\n\
         u = sigmastar_step(&c, e); memcpy(&bits, &u, 8); printf(\"%llx\\n\", bits); }} return 0; }}\n",
        inputs.join(", ")
    );
    let (main_file, program): (PathBuf, PathBuf) = (folder.join("main.c"), folder.join("main"));
    std::fs::write(&main_file, main).unwrap();
    gcc(&[&source, &main_file], &program);
    let output = Process::new(&program).output().unwrap();
    let text = utf8(output.stdout);
    text.lines().map(|line| u64::from_str_radix(line, 16).unwrap()).collect()
}

#[test]
fn c_code_agrees_with_the_stepper_bit_for_bit() {
    if !installed("gcc", &["--version"]) {
        return;
    }
    let (spec, sigma) = (example(), constant("97/2"));
    for n_o in [0, 1, 7, 50] {
        for limit in [None, Some("20"), Some("1/3")] {
            let folder = tempfile::tempdir().unwrap();
            let outputs = run_c(folder.path(), n_o, limit, 3000);
            let design = Design::new(&spec.internal_model, &sigma, n_o);
            let limit = limit.map(|text| constant(text).to_f64());
            let discrete = design.discretise(&constant("1/500")).unwrap().saturated(limit);
            let mut stepper = Stepper::new(design.regulator(), discrete);
            let controls: Vec<f64> = (0..3000).map(|k| stepper.step(signal(k))).collect();
            let expected: Vec<u64> = controls.iter().map(|u| u.to_bits()).collect();
            assert_eq!(outputs, expected, "n_o = {n_o} {limit:?}");
            if let Some(limit) = limit {
                let clipped = controls.iter().filter(|u| u.abs() == limit).count();
                assert!(controls.iter().all(|u| u.abs() <= limit) && (100..3000).contains(&clipped), "{n_o} {clipped}");
            }
        }
    }
}

#[test]
fn two_regulators_share_a_program() {
    if !installed("gcc", &["--version"]) {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let write = |prefix: &str, sigma: &str, more: &[&str]| {
        let source = folder.path().join(format!("{prefix}.c"));
        let call = ["specs/linear.json", "--sigma", sigma, "--n-o", "2", "--discretise", "1/100", "--prefix", prefix];
        controller(&call).args(more).args(["--format", "c", "-o"]).arg(&source).assert().success();
        source
    };
    let (first, second) = (write("axis_1", "2", &[]), write("axis_2", "3", &["--saturation", "0.5"]));
    let main = folder.path().join("main.c");
    let text = "#include \"axis_1.h\"\n#include \"axis_2.h\"\n#include <stdio.h>\n\
        int main(void) { axis_1_controller a; axis_2_controller b; axis_1_reset(&a); axis_2_reset(&b);\n\
        printf(\"%.17g %.17g %.17g %d\\n\", axis_1_step(&a, 1.0), axis_2_step(&b, 1.0), AXIS_2_SATURATION, AXIS_1_STATES);\n\
        return 0; }\n";
    std::fs::write(&main, text).unwrap();
    let program = folder.path().join("main");
    gcc(&[&first, &second, &main], &program);
    let printed = utf8(Process::new(&program).output().unwrap().stdout);
    let numbers: Vec<f64> = printed.split_whitespace().map(|word| word.parse().unwrap()).collect();
    assert!(numbers[0] < -2.0 && numbers[1..] == [-0.5, 0.5, 5.0], "{printed}");
    for bad in ["Axis", "1a", "a-b", ""] {
        let call = ["specs/linear.json", "--sigma", "2", "--n-o", "2", "--discretise", "1/100", "--format", "c"];
        let assert = controller(&call).args(["--prefix", bad, "-o"]).arg(folder.path().join("bad.c")).assert();
        assert.code(2).stderr(predicates::str::contains("lower-case letter"));
    }
}

#[test]
fn the_example_runs_and_converges() {
    if !installed("gcc", &["--version"]) {
        return;
    }
    for (n_o, more, below) in [("4", &[][..], 0.003), ("4", &["--saturation", "2"][..], 0.003), ("0", &[][..], 1.0)] {
        let folder = tempfile::tempdir().unwrap();
        let source = folder.path().join("regulator.c");
        let call = ["specs/paper-example.json", "--sigma", "5", "--n-o", n_o, "--discretise", "1/100", "--example"];
        controller(&call).args(more).args(["--format", "c", "-o"]).arg(&source).assert().success();
        let program = folder.path().join("main");
        gcc(&[&source, &folder.path().join("regulator_example.c")], &program);
        let printed = utf8(Process::new(&program).output().unwrap().stdout);
        let errors: Vec<f64> = printed.lines().map(|line| line.rsplit(' ').next().unwrap().parse().unwrap()).collect();
        assert!(errors.len() == 20 && errors[19] < below && errors[19] <= errors[0], "{printed}");
    }
}

#[cfg(unix)]
#[test]
fn the_header_stays_where_the_source_cannot_be_written() {
    let folder = tempfile::tempdir().unwrap();
    let source = folder.path().join("regulator.c");
    let call = |n_o: &str| {
        let mut shell = Process::new("bash");
        // Files of at most 16 KiB: the header fits, the source of 200 oscillators does not, as on a disk that is full.
        let script = "trap '' XFSZ; ulimit -f 16; exec \"$@\"";
        shell.args(["-c", script, "bash"]).arg(process().get_program()).current_dir(ROOT);
        shell.args([
            "controller",
            "specs/paper-example.json",
            "--sigma",
            "2",
            "--discretise",
            "1/1000",
            "--format",
            "c",
        ]);
        shell.args(["--n-o", n_o, "--force", "-o"]).arg(&source).output().unwrap()
    };
    let read = || ["c", "h"].map(|extension| std::fs::read_to_string(source.with_extension(extension)).unwrap());
    assert!(call("1").status.success());
    let before = read();
    let failed = call("200");
    let told = String::from_utf8_lossy(&failed.stderr).into_owned();
    assert_eq!(failed.status.code(), Some(2), "{told}");
    assert!(told.contains("none of the files that belong together was changed"), "{told}");
    assert_eq!(read(), before);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);
}

#[test]
fn a_source_does_not_compile_with_the_header_of_another() {
    if !installed("gcc", &["--version"]) {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let source = folder.path().join("regulator.c");
    let write = |sigma: &str| {
        let call =
            ["specs/linear.json", "--sigma", sigma, "--n-o", "1", "--discretise", "1/100", "--format", "c", "-o"];
        controller(&call).arg(&source).arg("--force").assert().success();
    };
    let compiles = || {
        let gcc = Process::new("gcc")
            .args(["-std=c99", "-Wall", "-pedantic", "-Werror", "-fsyntax-only"])
            .arg(&source)
            .output();
        gcc.unwrap().status.success()
    };
    write("2");
    assert!(compiles());
    let old = std::fs::read(&source).unwrap();
    write("3");
    assert!(compiles());
    std::fs::write(&source, old).unwrap();
    assert!(!compiles());
}
