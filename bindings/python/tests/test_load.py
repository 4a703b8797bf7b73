"""Certificates that were saved."""

import json
import pickle

import pytest
import sigmastar
from conftest import EXAMPLE, PLANT, ROOT

JACOBIAN = ROOT / "specs" / "paper-example-jacobian.json"


@pytest.mark.parametrize(
    "document, options",
    [
        (EXAMPLE, {}),
        (EXAMPLE, {"compare": False}),
        (EXAMPLE, {"sampling_period": "1/500"}),
        (EXAMPLE, {"sigma": 60, "n_o": [0, 2]}),
        (JACOBIAN, {}),
        (PLANT, {}),
    ],
)
def test_what_was_saved_comes_back(document, options, tmp_path):
    certificate = sigmastar.certify(document, **options)
    path = tmp_path / "certificate.json"
    certificate.save(path)
    again = sigmastar.load(path)
    assert type(again) is type(certificate) and repr(again) == repr(certificate)
    # But for the repaired derivation, which is beside the claim and not in the witness.
    stored, made = (json.loads(text) for text in (path.read_text(encoding="utf-8"), again.to_json()))
    for name in stored.keys() - {"comparison", "constants"}:
        assert made[name] == stored[name], name
    for name in ("sigma_star_exact", "statement", "initial_set", "conditions", "name", "sha256", "error_bounds", "rates"):
        assert getattr(again, name) == getattr(certificate, name), name
    step = options.get("sampling_period")
    assert sigmastar.check(again, document, sampling_period=step)
    # Another sampling period, or none, is another document.
    assert not sigmastar.check(again, document, sampling_period="1/250" if step else "1/500")
    assert step is None or not sigmastar.check(again, document)
    with pytest.raises(ValueError):
        sigmastar.check(again, sampling_period="1/500")
    assert pickle.loads(pickle.dumps(again)) == again
    assert sigmastar.controller(again, 2).step == sigmastar.controller(certificate, 2).step


def altered(certificate, path, change):
    document = json.loads(certificate.to_json())
    change(document)
    path.write_text(json.dumps(document))
    with pytest.raises(sigmastar.SigmastarError) as caught:
        sigmastar.load(path)
    return caught.value


def test_what_was_altered_does_not(tmp_path):
    certificate, path = sigmastar.certify(EXAMPLE), tmp_path / "certificate.json"

    def gain(document):
        document["claim"]["sigma_star"] = "50"

    def set_(document):
        document["claim"]["initial_set"]["X0"] = "1"

    def data(document):
        document["specification"]["bounds"]["q_t"] = "1"

    def witness(document):
        document["witness"]["D_e"] = "1/1000"

    def no_data(document):
        del document["specification"]

    for change, kind in [(gain, "claim"), (set_, "not-certified"), (data, "claim"), (witness, "not-certified"), (no_data, "field")]:
        error = altered(certificate, path, change)
        assert error.kind == kind, (change.__name__, str(error))
    assert "witness" in str(altered(certificate, path, gain))
    path.write_text("{")
    with pytest.raises(sigmastar.InputError):
        sigmastar.load(path)
    # A specification is no certificate.
    with pytest.raises(sigmastar.InputError):
        sigmastar.load(EXAMPLE)
    with pytest.raises(FileNotFoundError):
        sigmastar.load(tmp_path / "nowhere.json")


def test_the_path_of_a_certificate_stands_for_its_document(tmp_path):
    path = tmp_path / "certificate.json"
    made = sigmastar.certify(PLANT)
    made.save(path)
    assert sigmastar.certify(path).sigma_star_exact == made.sigma_star_exact
    runs = [sigmastar.simulate(of, n_o=1, periods=2).report("json") for of in (path, made)]
    assert runs[0] == runs[1]
    assert sigmastar.controller(path, 2).step is None
    document = json.loads(path.read_text(encoding="utf-8"))
    document["claim"]["sigma_star"] = "50"
    path.write_text(json.dumps(document))
    # One that was altered does not.
    with pytest.raises(sigmastar.SigmastarError):
        sigmastar.certify(path)
