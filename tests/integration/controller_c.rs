//! The exported C code: the operations of the Rust stepper, bit for bit, and names that two regulators can share a program with.

use crate::controller::{constant, controller, example, installed, signal};
use crate::support::{ROOT, process, specification, utf8};
use sigmastar_regulator::{Design, Stepper};
use std::path::{Path, PathBuf};
use std::process::Command as Process;

/// How the code is compiled; nothing may be said of it.
const STRICT: [&str; 6] = ["-std=c99", "-O2", "-Wall", "-Wextra", "-pedantic", "-Werror"];

pub fn gcc(arguments: &[&Path], program: &Path) {
    build(arguments, program).unwrap_or_else(|said| panic!("{said}"));
}

/// What compiler or linker say where they refuse.
fn build(arguments: &[&Path], program: &Path) -> Result<(), String> {
    let gcc = Process::new("gcc").args(STRICT).arg("-o").arg(program).args(arguments).output().unwrap();
    if gcc.status.success() { Ok(()) } else { Err(String::from_utf8_lossy(&gcc.stderr).into_owned()) }
}

/// The exports of `specs/linear.json` with these numbers of oscillators and the same prefix, each in a folder of its own.
fn exported(folder: &Path, counts: [&str; 2]) -> [PathBuf; 2] {
    counts.map(|n_o| {
        std::fs::create_dir(folder.join(n_o)).unwrap();
        let source = folder.join(n_o).join("reg.c");
        let call = ["specs/linear.json", "--sigma", "2", "--n-o", n_o, "--discretise", "1/100", "--format", "c", "-o"];
        controller(&call).arg(&source).assert().success();
        source
    })
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
    outputs(&source, steps)
}

/// The bits of every output of an exported regulator over the signal.
pub fn outputs(source: &Path, steps: u32) -> Vec<u64> {
    let inputs: Vec<String> = (0..steps).map(|k| format!("0x{:016x}ULL", signal(k).to_bits())).collect();
    let main = format!(
        "#include \"regulator.h\"\n#include <stdio.h>\n#include <string.h>\n\
         static const unsigned long long inputs[] = {{ {} }};\n\
         int main(void) {{ sigmastar_controller c; unsigned i; sigmastar_reset(&c);\n\
         for (i = 0; i < {steps}; i++) {{ double e, u; unsigned long long bits; memcpy(&e, &inputs[i], 8);\n\
         u = sigmastar_step(&c, e); memcpy(&bits, &u, 8); printf(\"%llx\\n\", bits); }} return 0; }}\n",
        inputs.join(", ")
    );
    let (main_file, program) = (source.with_file_name("main.c"), source.with_file_name("main"));
    std::fs::write(&main_file, main).unwrap();
    gcc(&[source, &main_file], &program);
    let output = Process::new(&program).output().unwrap();
    utf8(output.stdout).lines().map(|line| u64::from_str_radix(line, 16).unwrap()).collect()
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
fn a_source_is_not_built_with_the_header_of_another() {
    if !installed("gcc", &["--version"]) {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let [few, many] = exported(folder.path(), ["1", "9"]);
    let program = folder.path().join("main");
    let with_header_of = |n_o: &str| {
        let main = folder.path().join("main.c");
        let text = format!(
            "#include \"{n_o}/reg.h\"\n\
             int main(void) {{ sigmastar_controller c; sigmastar_reset(&c); return !(sigmastar_step(&c, 1.0) < -2.0); }}\n"
        );
        std::fs::write(&main, text).unwrap();
        main
    };
    for (source, n_o, other) in [(&few, "1", "9"), (&many, "9", "1")] {
        gcc(&[source, &with_header_of(n_o)], &program);
        assert!(Process::new(&program).status().unwrap().success());
        let said = build(&[source, &with_header_of(other)], &program).unwrap_err();
        assert!(said.contains("undefined reference to `sigmastar_step_"), "{said}");
    }
    std::fs::copy(many.with_extension("h"), few.with_extension("h")).unwrap();
    let said = build(&[&few, &with_header_of("1")], &program).unwrap_err();
    assert!(said.contains("this source and its header are of different regulators"), "{said}");
}

#[test]
fn two_regulators_of_one_prefix_share_a_program_and_no_file() {
    if !installed("gcc", &["--version"]) {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let [few, many] = exported(folder.path(), ["1", "9"]);
    let (program, main) = (folder.path().join("main"), folder.path().join("main.c"));
    let user = |n_o: &str| {
        let file = folder.path().join(format!("user_{n_o}.c"));
        let text = format!(
            "#include \"{n_o}/reg.h\"\n#include \"{n_o}/reg.h\"\ndouble run_{n_o}(void);\n\
             double run_{n_o}(void) {{ sigmastar_controller c; double u = 0.0; int i; sigmastar_reset(&c);\n\
             for (i = 0; i < 7; i++) {{ u = sigmastar_step(&c, 1.0); }} return u; }}\n"
        );
        std::fs::write(&file, text).unwrap();
        file
    };
    let text = "#include <stdio.h>\n#include <string.h>\ndouble run_1(void);\ndouble run_9(void);\n\
        static void put(double u) { unsigned long long bits; memcpy(&bits, &u, 8); printf(\"%llx\\n\", bits); }\n\
        int main(void) { put(run_1()); put(run_9()); return 0; }\n";
    std::fs::write(&main, text).unwrap();
    gcc(&[&few, &many, &user("1"), &user("9"), &main], &program);
    let printed = utf8(Process::new(&program).output().unwrap().stdout);
    let spec = specification("linear");
    let sigma = constant("2");
    let expected = [1, 9].map(|n_o| {
        let design = Design::new(&spec.internal_model, &sigma, n_o);
        let mut stepper = Stepper::new(design.regulator(), design.discretise(&constant("1/100")).unwrap());
        let last = (0..7).map(|_| stepper.step(1.0)).last().unwrap();
        format!("{:x}\n", last.to_bits())
    });
    assert_eq!(printed, expected.concat());

    std::fs::write(&main, "#include \"1/reg.h\"\n#include \"9/reg.h\"\nint main(void) { return 0; }\n").unwrap();
    let said = build(&[&main], &program).unwrap_err();
    assert!(said.contains("another regulator has this prefix; export this one with --prefix"), "{said}");
}
