"""Tuning, and a certificate in the place of what it is about."""

import json

import pytest
import sigmastar
from conftest import EXAMPLE, ROOT

LINEAR = ROOT / "specs" / "linear.json"
PLANT = ROOT / "specs" / "plants" / "linear.json"


def test_tuning_is_that_of_the_program(program, tmp_path):
    both = sigmastar.tune(LINEAR, {"mu": ("1/10", 10), "n0": None}, tries=3)
    assert [one.name for one in both.values] == ["mu", "n0"]
    tuning = sigmastar.tune(EXAMPLE, {"mu": ("1/10", 10)}, tries=8)
    call = ("tune", EXAMPLE, "--over", "mu=1/10..10", "--tries", "8", "--quiet")
    assert tuning.report("json").encode() == program(*call, "--format", "json")[1]
    assert tuning and tuning.is_better and [one.name for one in tuning.values] == ["mu"]
    assert repr(tuning) == f"<Tuning: mu={tuning.values[0].after}>"
    tuning.save(tmp_path / "tuned.json")
    assert json.loads((tmp_path / "tuned.json").read_text()) == tuning.document
    assert tuning.document["internal_model"]["mu"] == tuning.values[0].after
    certificate = sigmastar.certify(tmp_path / "tuned.json")
    assert certificate.sigma_star_exact == tuning.data["after"]["sigma_star"]
    assert tuning.data["before"]["sigma_star"] == sigmastar.certify(EXAMPLE).sigma_star_exact
    feedback = sigmastar.tune(LINEAR, "mu", minimise="feedback", tries=3)
    assert feedback.data["minimised"] == "feedback"
    assert sigmastar.tune(LINEAR, ["mu"], error_at=2, tries=3).data["minimised"] == "error"


def test_what_cannot_be_tuned():
    for over, more, kind in [("mo", {}, "options"), ("mu=1..", {}, "options"), ("mu", {"tries": 1}, "range"), ("mu,mu", {}, "options")]:
        with pytest.raises(sigmastar.InputError) as caught:
            sigmastar.tune(LINEAR, over, **more)
        assert caught.value.kind == kind
    with pytest.raises(ValueError):
        sigmastar.tune(LINEAR, minimise="sigma")
    none = sigmastar.tune(LINEAR, "mu=1..1.0000001", tries=2)
    if not none.is_better:
        assert none.document is None and repr(none) == "<Tuning: nothing better was found>"
        with pytest.raises(ValueError):
            none.save("x.json")


def test_a_certificate_stands_for_what_it_is_about():
    certificate = sigmastar.certify(LINEAR)
    assert sigmastar.certify(certificate).to_json() == certificate.to_json()
    for call in (
        lambda document: sigmastar.transfer(document, n_o=[0]),
        lambda document: sigmastar.sampling(document, ["1/100"]),
        lambda document: sigmastar.tune(document, "mu", tries=3),
    ):
        assert call(certificate).report("json") == call(LINEAR).report("json")
    with pytest.raises(sigmastar.InputError):
        sigmastar.simulate(certificate, n_o=1)


def test_a_simulation_takes_the_gain_of_a_certificate():
    certificate = sigmastar.certify(PLANT, sigma=2)
    assert sigmastar.simulate(certificate, n_o=1, periods=2) == sigmastar.simulate(PLANT, sigma=2, n_o=1, periods=2)
    sampled = sigmastar.certify(PLANT, sigma=2, sampling_period="1/100")
    run = sigmastar.simulate(sampled, n_o=1, periods=2)
    assert run == sigmastar.simulate(PLANT, sigma=2, sampling_period="1/100", n_o=1, periods=2)
    assert sigmastar.bound(certificate).to_json() == sigmastar.bound(PLANT).to_json()
    with pytest.raises(ValueError):
        sigmastar.simulate(PLANT, n_o=1)


def test_round_sampling_periods():
    pairs = sigmastar.sampling(LINEAR, sigmas=[3])
    (pair,), (longest,) = pairs.round, pairs.by_sigma
    assert pair.sigma == longest.sigma == 3 and pair.samples >= longest.samples
    assert str(pair.sampling_period).strip("0.") in ("1", "2", "5")


def test_numbers_are_shown_in_four_digits_on_their_side():
    certificate = sigmastar.certify(EXAMPLE)
    e0, sup = certificate.initial_set.e0, certificate.error_bounds[1].sup
    shown = repr(certificate.initial_set)
    assert shown.startswith("InitialSet(x0=0.1042, e0=0.3333, z0=14.48, ball=None)") and float("0.3333") <= e0
    shown = repr(certificate.error_bounds[1])
    assert shown.startswith("ErrorBound(n_o=1, sup=") and float(shown.split("sup=")[1].split(",")[0]) >= sup
    assert len(shown) < 45
    # A pair is about all digits of its gain.
    pair = sigmastar.sampling(LINEAR, ["1/100"]).by_sampling_period[0]
    assert f"sigma={pair.sigma.exact}," in repr(pair)


def test_toml_is_read(tmp_path, program):
    for name, kind in (("plant.toml", "plant"), ("plant.jsonc", "plant"), ("study.toml", "study")):
        assert program("new", kind, "-o", tmp_path / name)[0] == 0
    first, second = (sigmastar.certify(tmp_path / name, compare=False) for name in ("plant.toml", "plant.jsonc"))
    assert first.to_json() == second.to_json()
    study = sigmastar.load_study(tmp_path / "study.toml")
    assert study.cases == 6 and json.loads(sigmastar.run_case(study, 0))["verdict"] == "certified"
