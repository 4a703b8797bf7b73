"""Certifying: what goes in exactly, what comes back, and what is refused."""

import json
import os
import pickle
import threading
import time
from decimal import Decimal
from fractions import Fraction

import numpy
import pytest
import sigmastar
from conftest import EXAMPLE, PLANT, ROOT


@pytest.fixture(scope="module")
def example():
    return sigmastar.certify(EXAMPLE)


def test_the_example(example):
    assert str(example.sigma_star) == "39.8018" == example.sigma_star_exact
    assert isinstance(example.sigma_star, float) and example.sigma_star.fraction == Fraction("39.8018")
    assert Fraction(float(example.sigma_star)) >= Fraction("39.8018")
    assert abs(example.sigma_star - 39.8018) < 1e-14
    for size in (example.initial_set.x0, example.initial_set.e0, example.initial_set.z0):
        assert Fraction(float(size)) <= size.fraction
    assert "every gain sigma >= 39.8018" in example.statement
    assert {"S1", "S2", "C4", "C5"} <= {condition.id for condition in example.conditions}
    assert example.verdict == "certified" and example.samples is None and not example.is_plant
    assert example.initial_set.ball is None
    assert 0.16 < example.periodic_solution.e < 0.17
    with pytest.raises(AttributeError):
        example.sigma_star = 1.0


def test_certificate_and_reports_are_those_of_the_program(example, program, tmp_path):
    written, saved = tmp_path / "program.json", tmp_path / "python.json"
    assert program("certify", EXAMPLE, "-o", written)[0] == 0
    example.save(saved)
    assert saved.read_bytes() == written.read_bytes() == example.to_json().encode()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["program.json", "python.json"]
    for form in ("text", "markdown", "json"):
        assert program("certify", EXAMPLE, "--format", form, "--full")[1] == example.report(form).encode()
    # The page of the program has a simulation besides, which is of no report.
    page, own = program("certify", EXAMPLE, "--format", "html", "--full")[1], example.report("html").encode()
    before = len(os.path.commonprefix([own, page]))
    added = page[before : before + len(page) - len(own)]
    assert own == page[:before] + page[before + len(added) :] and b"a simulation" in added
    with pytest.raises(ValueError):
        example.report("pdf")


def test_a_file_that_cannot_be_written_leaves_nothing(example, tmp_path):
    with pytest.raises(OSError):
        example.save(tmp_path)
    with pytest.raises(OSError):
        example.save(tmp_path / "none" / "file.json")
    assert list(tmp_path.iterdir()) == []


def test_a_notebook_shows_the_page_in_a_frame(example):
    shown = example._repr_html_()
    assert shown.startswith('<iframe sandbox="" ') and shown.endswith("</iframe>")
    inside = shown[shown.index('srcdoc="') + 8 : shown.rindex('"')]
    assert "<" not in inside and '"' not in inside
    assert "&lt;!DOCTYPE html&gt;" in inside and "about:srcdoc" in inside
    assert sigmastar.check(example)._repr_html_().startswith("<iframe")


def test_a_certificate_crosses_processes(example):
    again = pickle.loads(pickle.dumps(example))
    assert again == example and again.sigma_star.exact == "39.8018" and again.report() == example.report()


def test_a_dictionary_is_the_file(document, example):
    assert sigmastar.certify(document).to_json() == example.to_json()
    assert sigmastar.certify(str(EXAMPLE)).sha256 == example.sha256


def test_numbers_of_a_dictionary_are_exact(document):
    def embedded(alpha):
        document["lyapunov"]["alpha"] = alpha
        certificate = sigmastar.certify(document, compare=False)
        return certificate.sigma_star_exact, json.loads(certificate.to_json())["specification"]["lyapunov"]["alpha"]

    gain = embedded("0.58")[0]
    # A float is the decimal that Python writes for it, not the double.
    assert embedded(0.58) == (gain, 0.58)
    assert embedded(numpy.float64(0.58)) == (gain, 0.58)
    assert embedded(Decimal("0.58")) == (gain, "0.58")
    assert embedded(Decimal("58E-2")) == (gain, "0.58")
    assert embedded(Fraction(58, 100)) == (gain, "29/50")
    # The double itself is a little smaller or larger, and is refused nowhere.
    assert embedded(Fraction(0.58))[1] == f"{Fraction(0.58).numerator}/{Fraction(0.58).denominator}"
    document["period"], document["internal_model"]["mu"] = 1, Fraction(1)
    assert embedded("0.58")[0] == gain


@pytest.mark.parametrize("value", [float("nan"), float("inf"), Decimal("nan"), numpy.float32(0.5), 1j, b"1", object(), {1}])
def test_what_json_cannot_hold_exactly_is_refused(document, value):
    document["lyapunov"]["alpha"] = value
    with pytest.raises((TypeError, ValueError)):
        sigmastar.certify(document)


def test_arrays_of_doubles_are_lists(document):
    document["lyapunov"] = {"jacobian": numpy.array([[-0.5, 2.0], [-2.0, -0.5]])}
    certificate = sigmastar.certify(document, compare=False)
    assert json.loads(certificate.to_json())["specification"]["lyapunov"]["jacobian"] == [[-0.5, 2.0], [-2.0, -0.5]]
    document["lyapunov"] = {"jacobian": numpy.array([[-0.5]], dtype="float32")}
    with pytest.raises(TypeError):
        sigmastar.certify(document)
    with pytest.raises(TypeError):
        sigmastar.certify({1: 2})
    with pytest.raises(TypeError):
        sigmastar.certify(1)


def test_a_given_gain(document):
    certificate = sigmastar.certify(document, sigma=Fraction(85, 2), compare=False)
    assert certificate.sigma_star_exact == "42.5"
    with pytest.raises(sigmastar.UndecidedError) as caught:
        sigmastar.certify(document, sigma="39", compare=False)
    assert caught.value.kind == "not-certified" and caught.value.conditions is not None
    assert "no sigma is certified" in str(caught.value) and "What to try" in caught.value.report()


def test_an_aligned_start_has_no_z0(document):
    document["initial_set"] = {"kind": "aligned"}
    certificate = sigmastar.certify(document, compare=False)
    assert certificate.initial_set.z0 is None and certificate.initial_set.e0 > 0
    assert certificate.sigma_star < 26 and ", z = M e, at any" in certificate.statement
    assert sigmastar.check(certificate)


def test_the_regulator_at_samples(reported):
    certificate = sigmastar.certify(EXAMPLE, sampling_period="1/500")
    report = reported(EXAMPLE, "--sampling-period", "1/500")
    assert certificate.sigma_star_exact == report["sigma"] and certificate.samples.gain == report["gain"]
    assert (certificate.samples.period, certificate.samples.count) == (report["sampling_period"], report["samples"])
    assert certificate.report("json") and json.loads(certificate.report("json")) == report
    assert "For the digital regulator with the gain sigma = " in certificate.statement
    check = sigmastar.check(certificate)
    assert check and check.statement == certificate.statement
    with pytest.raises(sigmastar.InputError) as caught:
        sigmastar.certify(EXAMPLE, sampling_period="1/500", transfer="boxes")
    assert caught.value.kind == "options"


def test_a_plant():
    certificate = sigmastar.certify(PLANT)
    assert certificate.is_plant and "the plant of these formulas" in certificate.statement
    assert certificate.initial_set.ball is not None
    assert sigmastar.check(certificate, PLANT).is_valid


def test_options_that_are_none():
    with pytest.raises(ValueError):
        sigmastar.certify(EXAMPLE, transfer="worst")
    for options in ({"precision_limit": 1}, {"sigma": -1}, {"sampling_period": 0}, {"sampling_period": "1/3.5"}):
        with pytest.raises(sigmastar.InputError):
            sigmastar.certify(EXAMPLE, **options)
    with pytest.raises(TypeError):
        sigmastar.certify(EXAMPLE, sigma=True)
    for value in (float("nan"), float("inf"), Decimal("nan")):
        with pytest.raises(sigmastar.InputError) as caught:
            sigmastar.certify(EXAMPLE, sigma=value)
        assert caught.value.kind == "range" and caught.value.diagnostics[0].message.endswith("is no number here")


def test_errors_have_places(document, tmp_path):
    document["lyapunov"]["alpha"] = -1
    with pytest.raises(sigmastar.InputError) as caught:
        sigmastar.certify(document)
    error = caught.value
    assert (error.kind, error.verdict) == ("range", "bad-input")
    (one,) = error.diagnostics
    assert (one.pointer, one.file, one.code) == ("/lyapunov/alpha", "document", "out-of-range")
    assert one.line > 1 and one.column > 1 and one.message in str(error)
    assert error.report() is None and isinstance(error, ValueError)
    again = pickle.loads(pickle.dumps(error))
    assert type(again) is sigmastar.InputError and again.diagnostics == error.diagnostics and str(again) == str(error)
    wrong = tmp_path / "wrong.json"
    wrong.write_text('{ "format": ')
    with pytest.raises(sigmastar.InputError) as caught:
        sigmastar.certify(wrong)
    assert caught.value.diagnostics[0].file == str(wrong) and caught.value.kind == "document"
    with pytest.raises(FileNotFoundError):
        sigmastar.certify(tmp_path / "none.json")


def test_the_checker(example, document, tmp_path):
    path = tmp_path / "certificate.json"
    example.save(path)
    check = sigmastar.check(path, EXAMPLE)
    assert check and check.is_valid and check.statement == example.statement
    assert check.sha256 == example.sha256 and check.assumed and str(check).startswith("valid")
    document["period"], document["internal_model"]["base_frequency"] = "2", "pi"
    other = sigmastar.check(path, document)
    assert other.verdict == "invalid" and not other and other.statement is None
    path.write_text(example.to_json().replace('"sigma_star": "39.8018"', '"sigma_star": "39"'))
    forged = sigmastar.check(path)
    assert forged.verdict == "invalid" and not forged and "rule:" in str(forged)
    whole = example.to_json().encode()
    for bytes in (b"\xff", whole + b"\xff", whole.replace(b"Example of", b"Example\xffof"), whole[:-3], b""):
        path.write_bytes(bytes)
        assert sigmastar.check(path).verdict == "bad-input" and not sigmastar.check(path)
    assert sigmastar.check(json.loads(example.to_json())).is_valid


def test_other_threads_go_on():
    ticks, done = 0, threading.Event()

    def work():
        sigmastar.certify(PLANT)
        done.set()

    threading.Thread(target=work).start()
    while not done.is_set():
        ticks += 1
        time.sleep(0.001)
    assert ticks > 10


def test_an_interrupt_is_heard(tmp_path):
    import signal
    import subprocess
    import sys

    code = (
        "import signal, sigmastar, sys\n"
        # A shell that runs tests in the background hands down a SIGINT that is ignored.
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "print('started', flush=True)\n"
        "try:\n"
        f"    sigmastar.certify({str(ROOT / 'specs' / 'plants' / 'converter.json')!r})\n"
        "except KeyboardInterrupt:\n"
        "    sys.exit(7)\n"
    )
    process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE)
    assert process.stdout.readline() == b"started\n"
    time.sleep(0.3)
    process.send_signal(signal.SIGINT)
    assert process.wait(timeout=60) == 7


def test_what_noise_does_is_a_part_of_a_rate():
    plant = json.loads((ROOT / "specs" / "plants" / "linear.json").read_text())
    plain = sigmastar.certify(plant, sigma=4, n_o=1, compare=False)
    assert [(rate.noise_limit, rate.noise_peak) for rate in plain.rates] == [(None, None)]
    plant["measurement"] = {"noise": "1/1000"}
    noisy = sigmastar.certify(plant, sigma=4, n_o=1, compare=False)
    (rate,) = noisy.rates
    (row,) = json.loads(noisy.to_json())["claim"]["for_n_o"]
    assert (rate.noise_limit.exact, rate.noise_peak.exact) == (row["noise"]["limit"], row["noise"]["peak"])
    assert 0.001 < rate.noise_limit <= rate.noise_peak


def test_the_stages_are_told():
    told = []
    plant = ROOT / "specs" / "plants" / "linear.json"
    certificate = sigmastar.certify(plant, n_o=1, compare=False, progress=told.append)
    assert told[0] == "finding and proving the periodic orbit" and told[-1] == "letting the independent checker decide"
    assert "proving rates" in told
    assert certificate.to_json() == sigmastar.certify(plant, n_o=1, compare=False).to_json()

    class Enough(Exception):
        pass

    def stop(_):
        raise Enough

    with pytest.raises(Enough):
        sigmastar.certify(plant, progress=stop)


def test_bounds_by_the_number_of_oscillators_and_for_sets():
    plant = ROOT / "specs" / "plants" / "linear.json"
    certificate = sigmastar.certify(plant, sigma=5, n_o=1, harmonics=[[0, 1, 3], [0, 2]])
    entries = json.loads(certificate.to_json())["claim"]["by_n_o"]
    bounds = certificate.bounds
    assert [one.n_o for one in bounds] == [entry.get("n_o") for entry in entries]
    assert [one.harmonics for one in bounds[-2:]] == [(0, 1, 3), (0, 2)] and bounds[1].harmonics == (0, 1)
    for one, entry in zip(bounds, entries):
        stated = [*(entry["steady"][name] for name in ("e", "e_rms", "u")), *(entry["largest"][name] for name in ("e", "u"))]
        found = [one.steady_error, one.steady_rms, one.steady_control, one.largest_error, one.largest_control]
        assert [number.exact for number in found] == stated
        assert one.or_more == entry.get("or_more", False)
        assert 0 <= one.steady_rms <= one.steady_error <= one.largest_error
    # Rates of the number, and of the sets.
    assert [rate.n_o for rate in certificate.rates] == [1, None, None]
    assert [rate.harmonics for rate in certificate.rates] == [(0, 1), (0, 1, 3), (0, 2)]
    assert all(rate.rate > 0 and rate.factor > 0 for rate in certificate.rates)
    # With one oscillator the error is smaller than without.
    assert bounds[1].steady_error < bounds[0].steady_error
    assert sigmastar.check(certificate)
    # One set may stand alone; 0 belongs to each.
    assert sigmastar.certify(plant, sigma=5, harmonics=[0, 1, 3]).bounds[-1].harmonics == (0, 1, 3)
    with pytest.raises(sigmastar.InputError, match="without it there is no integrator"):
        sigmastar.certify(plant, harmonics=[1, 3])
    # Of bounding functions there are none.
    assert sigmastar.certify(ROOT / "specs" / "linear.json", compare=False).bounds == []
