"""Studies, case by case: the same bytes as the program."""

import json
import pickle
import runpy
from pathlib import Path

import pytest
import sigmastar
from conftest import ROOT, STUDY

EXAMPLE = Path(__file__).resolve().parents[1] / "examples" / "sweep_dask.py"


@pytest.fixture(scope="module")
def swept(program, tmp_path_factory):
    """The file that the program writes."""
    file = tmp_path_factory.mktemp("sweep") / "results.csv"
    assert program("sweep", STUDY, "-o", file, "--quiet")[0] == 0
    return file.read_bytes()


@pytest.fixture(scope="module")
def lines():
    return [sigmastar.run_case(STUDY, index) for index in range(15)]


def test_the_cases_are_those_of_the_program(program):
    study = sigmastar.load_study(STUDY)
    cases = sigmastar.study_cases(study)
    assert len(cases) == len(study) == 15 and study.name.startswith("Linear zero dynamics")
    assert cases[12].index == 12 and cases[12].values == {"alpha": "1.5", "p_up": "11/10"}
    assert program("sweep", STUDY, "--case", "12")[1] == cases[12].json.encode()
    assert sigmastar.certify(json.loads(cases[12].json), compare=False).sha256 == cases[12].sha256


def test_the_results_are_the_bytes_of_the_program(lines, swept, tmp_path):
    assert sigmastar.results(STUDY, reversed(lines)).encode() == swept
    file = tmp_path / "results.csv"
    sigmastar.write_results(STUDY, lines, file)
    assert file.read_bytes() == swept


def test_what_is_not_of_the_study_is_refused(lines, tmp_path):
    claimed = json.loads(lines[0])
    forged = {**claimed, "index": 1}
    other = [*lines[:1], json.dumps(forged, separators=(",", ":")), *lines[2:]]
    contradicting = lines[0].replace(claimed["sigma_star"], "1")
    assert contradicting != lines[0]
    for wrong, words in [
        (lines[:-1], "1 of 15 cases are missing"),
        (other, "is not of case 1"),
        ([*lines, contradicting], "another thing"),
        ([*lines, "{}"], "is no result"),
        ([lines[0] + " ", *lines[1:]], "not as it was written"),
    ]:
        with pytest.raises(sigmastar.InputError) as caught:
            sigmastar.write_results(STUDY, wrong, tmp_path / "results.csv")
        assert caught.value.kind == "results" and words in str(caught.value)
    assert list(tmp_path.iterdir()) == []


def test_a_study_crosses_processes_without_its_files(lines, tmp_path):
    study = pickle.loads(pickle.dumps(sigmastar.load_study(STUDY)))
    assert sigmastar.run_case(study, 3) == lines[3]
    with pytest.raises(IndexError):
        sigmastar.run_case(study, 15)
    with pytest.raises(IndexError):
        sigmastar.run_case(study, -1)


def test_a_study_in_a_dictionary(lines):
    study = json.loads(STUDY.read_text())
    study["subject"] = json.loads((ROOT / "specs" / "linear.json").read_text())
    assert sigmastar.run_case(study, 2) == lines[2]
    study["subject"] = "nowhere.json"
    with pytest.raises(FileNotFoundError):
        sigmastar.load_study(study)
    study["parameters"] = []
    with pytest.raises(sigmastar.InputError) as caught:
        sigmastar.load_study({**study, "subject": {}})
    assert caught.value.diagnostics[0].file == "study"


def test_a_refused_case_has_a_line_that_says_so():
    study = json.loads(STUDY.read_text())
    study["subject"] = json.loads((ROOT / "specs" / "linear.json").read_text())
    study["parameters"] = [{"pointer": "/lyapunov/alpha", "values": ["-1", "0.58"]}]
    refused, certified = (json.loads(sigmastar.run_case(study, index)) for index in range(2))
    assert (refused["verdict"], certified["verdict"]) == ("bad-input", "certified")
    assert "sigma_star" not in refused and refused["errors"][0]["pointer"] == "/lyapunov/alpha"


def test_two_processes_of_dask_give_the_same_bytes(swept, tmp_path):
    pytest.importorskip("distributed")
    file = tmp_path / "results.csv"
    runpy.run_path(str(EXAMPLE))["sweep"](str(STUDY), str(file), processes=2)
    assert file.read_bytes() == swept
