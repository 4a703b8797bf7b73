"""Simulations and attempts to break a certificate: the answers of the program."""

import json

import pytest
import sigmastar
from conftest import EXAMPLE, ROOT

PLANT = ROOT / "specs" / "plants" / "linear.json"


@pytest.mark.parametrize(
    "options, flags",
    [
        ({"n_o": 2}, ("--n-o", "2")),
        ({}, ("--high-gain",)),
        ({"n_o": 1, "sampling_period": "1/100"}, ("--n-o", "1", "--sampled", "1/100")),
        ({"n_o": 1, "input_gain": "9/10", "periods": 3, "samples": 10, "harmonics": 3},
         ("--n-o", "1", "--input-gain", "9/10", "--periods", "3", "--samples", "10", "--coefficients", "3")),
    ],
)  # fmt: skip
def test_a_simulation_is_that_of_the_program(options, flags, program, tmp_path):
    simulation = sigmastar.simulate(PLANT, sigma=2, **options)
    csv = tmp_path / "run.csv"
    code, out = program("simulate", PLANT, "--sigma", "2", *flags, "--csv", csv, "--quiet", "--format", "json")
    assert code == 0 and simulation.is_complete
    assert simulation.report("json").encode() == out
    assert simulation.to_csv() == csv.read_text()
    run = simulation.run
    assert list(run)[:3] == ["t", "e", "u"] and len({len(column) for column in run.values()}) == 1
    assert "sup|e|=" in repr(simulation) and simulation.steady_state["sup_e"] > 0


def test_a_run_as_a_table():
    pytest.importorskip("pandas")
    table = sigmastar.simulate(PLANT, sigma=2, n_o=1, periods=2, samples=5).to_dataframe()
    assert list(table["t"])[:2] == [0.0, 0.2] and len(table) == 11


def test_what_cannot_be_simulated():
    for wrong in ({"n_o": 201}, {"n_o": 1, "periods": 0}, {"sampling_period": "1/100"}, {"n_o": 1, "input_gain": 0}):
        with pytest.raises(sigmastar.InputError):
            sigmastar.simulate(PLANT, sigma=2, **wrong)
    for document, sigma in [(EXAMPLE, 2), (PLANT, 0), (PLANT, "1e400")]:
        with pytest.raises(sigmastar.InputError):
            sigmastar.simulate(document, sigma=sigma, n_o=1)
    with pytest.raises(ValueError):
        sigmastar.simulate(PLANT, sigma=2, n_o=-1)


def test_trials_are_those_of_the_program(program, tmp_path):
    certificate = sigmastar.certify(ROOT / "specs" / "linear.json")
    path = tmp_path / "certificate.json"
    certificate.save(path)
    found = sigmastar.falsify(certificate, trials=4, seed=7)
    code, out = program("falsify", path, "--trials", "4", "--seed", "7", "--quiet", "--format", "json")
    assert code == 0 and found.report("json").encode() == out
    assert found.outcome == "held" and len(found.trials) == 4 and found.counterexample is None
    assert repr(found) == "<Falsification: held in 4 trials>"


def test_a_false_bound_is_broken(tmp_path):
    certificate = json.loads(sigmastar.certify(ROOT / "specs" / "linear.json").to_json())
    certificate["claim"]["periodic_solution"]["z"] = "1e-9"
    found = sigmastar.falsify(certificate, trials=4)
    assert found.outcome == "broken"
    plant = tmp_path / "counterexample.json"
    plant.write_text(found.counterexample)
    n_o = found.trials[[one["finding"] for one in found.trials].index("violated")]["n_o"]
    assert sigmastar.simulate(plant, sigma=2, n_o=n_o, periods=1).run["t"]
    for wrong in (0, 1_000_001):
        with pytest.raises(sigmastar.InputError):
            sigmastar.falsify(certificate, trials=wrong)
    with pytest.raises(sigmastar.InputError):
        sigmastar.falsify({})
