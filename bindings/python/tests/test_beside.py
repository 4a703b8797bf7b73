"""What is asked beside one claim: the answers of the program."""

import json
from fractions import Fraction

import pytest
import sigmastar
from conftest import EXAMPLE, ROOT

PLANT = ROOT / "specs" / "plants" / "linear.json"
LINEAR = ROOT / "specs" / "linear.json"
JACOBIAN = ROOT / "specs" / "paper-example-jacobian.json"


def test_bounds_of_a_plant(program, tmp_path):
    bounded = sigmastar.bound(PLANT)
    assert bounded.to_json().encode() == program("bound", PLANT, "--quiet")[1]
    assert bounded.document["domain"] == {"X": str(bounded.domain[0]), "E": str(bounded.domain[1])}
    bounded.save(tmp_path / "bounds.json")
    assert sigmastar.check(sigmastar.certify(tmp_path / "bounds.json"))
    asked = sigmastar.bound(PLANT, ("1/2", 2))
    assert asked.to_json().encode() == program("bound", PLANT, "--domain", "1/2,2", "--quiet")[1]
    for document, domain in [(EXAMPLE, None), (PLANT, (0, 1)), (PLANT, ("pi", 1))]:
        with pytest.raises(sigmastar.InputError):
            sigmastar.bound(document, domain)


def test_a_triple_and_an_orbit(program):
    found = sigmastar.lyapunov(JACOBIAN)
    assert json.loads(found.report("json")) == json.loads(program("lyapunov", JACOBIAN, "--format", "json")[1]) == found.data
    low, up, alpha = found.triple
    assert 0 < low <= up and alpha.fraction > Fraction(1, 2) and repr(found).startswith("<Lyapunov: p_low=0.9999, p_up=1.551, alpha=0.5")
    of_plant = sigmastar.lyapunov(PLANT)
    assert of_plant.triple == (1, 1, 1) and of_plant.data["orbit"] is not None
    assert of_plant.data == json.loads(program("lyapunov", PLANT, "--format", "json")[1])
    with pytest.raises(sigmastar.InputError) as caught:
        sigmastar.lyapunov(EXAMPLE)
    assert caught.value.kind == "options"


def test_pairs_for_samples(program):
    pairs = sigmastar.sampling(LINEAR, ["1/100", "1/10"], sigmas=[3])
    call = ("sampling", LINEAR, "--sampling-period", "1/100,1/10", "--sigma", "3", "--quiet", "--format", "json")
    assert pairs.report("json").encode() == program(*call)[1]
    first = pairs.by_sampling_period[0]
    assert bool(pairs) and first.samples == 100 and pairs.by_sigma[0].sigma == 3 and "certified" in repr(pairs)
    assert sigmastar.certify(LINEAR, sampling_period=first.sampling_period, sigma=first.sigma).samples.count == 100
    for periods in (["3/10"], ["0"], ["x"]):
        with pytest.raises(sigmastar.InputError):
            sigmastar.sampling(LINEAR, periods)


def test_tables(tmp_path):
    pytest.importorskip("pandas")
    pairs = sigmastar.sampling(LINEAR, ["1/100"])
    assert list(pairs.to_dataframe().columns) == ["sigma", "sampling_period", "samples"]
    study = sigmastar.load_study(ROOT / "specs" / "studies" / "linear.json")
    lines = [sigmastar.run_case(study, index) for index in (1, 0)]
    table = study.to_dataframe(lines)
    assert list(table.columns) == ["index", "alpha", "p_up", "verdict", "sigma_star"]
    assert list(table["alpha"]) == [0.5, 0.5] and list(table["p_up"]) == [1.1, 1.5512] and (table["sigma_star"] > 1).all()


def test_pictures(tmp_path):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    study = sigmastar.load_study(ROOT / "specs" / "studies" / "linear.json")
    lines = [sigmastar.run_case(study, index) for index in range(2)]
    for ax in [
        sigmastar.certify(LINEAR).plot(),
        sigmastar.sampling(LINEAR, ["1/100"]).plot(),
        sigmastar.simulate(PLANT, sigma=2, n_o=1, periods=2).plot(),
        study.plot(lines, "p_up"),
    ]:
        assert ax.lines and ax.get_xlabel() and ax.get_ylabel()
    given = study.plot(lines, ax=ax)
    assert given is ax
    with pytest.raises(ValueError):
        study.plot(lines, "q_up")


def test_a_rate_that_is_asked_for_and_one_number_of_oscillators():
    motor = ROOT / "specs" / "motor-axis.json"
    one = sigmastar.certify(motor, n_o=4, rate=3)
    assert [rate.n_o for rate in one.rates] == [4] and one.rates[0].rate >= 3 and one.sigma_star > 2400
    with pytest.raises(sigmastar.UndecidedError, match="the largest one found"):
        sigmastar.certify(motor, n_o=4, rate=1000)
    with pytest.raises(sigmastar.InputError, match="a rate is one for given n_o"):
        sigmastar.certify(motor, rate=3)


def test_a_sampled_claim_has_bounds_by_the_number_of_oscillators():
    sampled = sigmastar.certify(ROOT / "specs" / "paper-example-at-rest.json", sampling_period="1/1000")
    bounds = sampled.error_bounds
    assert bounds[0].n_o == 0 and bounds[-1].n_o == 499
    assert all(one.sup >= other.sup for one, other in zip(bounds, bounds[1:])) and bounds[3].sup < bounds[0].sup / 2
