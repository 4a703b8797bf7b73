"""The design table, and the pair to take."""

import pytest
import sigmastar
from conftest import ROOT

PLANT = ROOT / "specs" / "plants" / "linear.json"


def test_a_design_is_that_of_the_program(program):
    design = sigmastar.design(PLANT, steady_error="1/10", max_control=40, n_o=[0, 1], sigmas=[2, 4])
    call = ("design", PLANT, "--steady-error", "1/10", "--max-control", "40", "--n-o", "0,1", "--sigma", "2,4", "--quiet")
    assert design.report("json").encode() == program(*call, "--format", "json")[1]
    take = design.data["take"]
    assert (design.sigma.exact, design.n_o, design.is_met) == (take["sigma"], take["n_o"], take["met"])
    assert design and design.certificate.sigma_star == design.sigma and sigmastar.check(design.certificate)
    assert repr(design) == f"<Design: sigma={take['sigma']}, n_o={take['n_o']}>"
    (row,) = [row for row in design.rows if row["sigma"] == take["sigma"] and row["n_o"] == design.n_o]
    assert float(row["steady_error"]) <= 0.1 and float(row["max_control"]) <= 40
    assert row["simulated"]["steady_error"] <= float(row["steady_error"]) * (1 + 1e-6) + 1e-12


def test_what_is_not_met_is_false_and_what_is_wrong_an_error():
    design = sigmastar.design(PLANT, max_control="1/1000000", n_o=0, sigmas=[2, 4], simulate=False)
    assert not design and design.rows[0]["simulated"] is None and "not all that is required" in repr(design)
    assert [row["sigma"] for row in design.rows] == ["2", "4"]
    for wrong in ({"settle": 3}, {"noise": 1}, {"n_o": []}, {"n_o": range(9)}):
        with pytest.raises(sigmastar.InputError) as caught:
            sigmastar.design(PLANT, **wrong)
        assert caught.value.kind == "options"


def test_the_table_as_a_table_of_pandas():
    pytest.importorskip("pandas")
    table = sigmastar.design(PLANT, n_o=[0, 1], sigmas=[2], simulate=False).to_dataframe()
    assert list(table["n_o"]) == [0, 1] and (table["peak_error"] >= table["steady_error"]).all()


def test_numbers_are_chosen_and_sampling_periods_told(program):
    design = sigmastar.design(
        PLANT, n_o=1, sigmas=[4], simulate=False, choose={"mu": ("1/2", 4)}, sampling_periods=True
    )
    call = ("design", PLANT, "--n-o", "1", "--sigma", "4", "--no-simulation", "--choose", "mu=1/2..4", "--sampling-periods", "--quiet")
    assert design.report("json").encode() == program(*call, "--format", "json")[1]
    assert design.values == design.data["values"]["taken"] and set(design.values) == {"mu"}
    (row,) = design.rows
    h = row["longest_h"]
    assert sigmastar.certify(design.certificate, sigma=4, sampling_period=h, compare=False).samples.period == h
    plain = sigmastar.design(PLANT, n_o=1, sigmas=[4], simulate=False)
    assert plain.values == {} and "longest_h" not in plain.rows[0]
    with pytest.raises(sigmastar.InputError, match="did you mean `mu`"):
        sigmastar.design(PLANT, choose="mo")


def test_progress_tells_the_gains_and_may_end_the_call():
    told = []
    design = sigmastar.design(PLANT, n_o=1, sigmas=[2, 4], simulate=False, progress=told.append)
    assert told == ["proving sigma = 2, 4"] and design.sigma.exact in ("2", "4")

    class Enough(Exception):
        pass

    def stop(_):
        raise Enough

    with pytest.raises(Enough):
        sigmastar.design(PLANT, n_o=1, sigmas=[2], simulate=False, progress=stop)
