"""The transfer bound and the rates by themselves."""

import json
from fractions import Fraction

import pytest
import sigmastar
from conftest import EXAMPLE, PLANT


def test_the_transfer_bound(program):
    bound = sigmastar.transfer(EXAMPLE)
    report = json.loads(program("transfer", EXAMPLE, "--quiet", "--format", "json")[1])
    assert json.loads(bound.report("json")) == report
    assert (str(bound.k0), str(bound.k1)) == (report["k0"], report["k1"])
    assert Fraction(float(bound.k0)) >= bound.k0.fraction and Fraction(float(bound.k1)) >= bound.k1.fraction
    assert bound.shares[-1].n_o is None and 0 < bound.shares[-1].ratio[0] <= bound.shares[-1].ratio[1] <= 1
    assert bound._repr_html_().startswith("<iframe")


def test_a_wanted_pair():
    bound = sigmastar.transfer(EXAMPLE, k0=20, n_o=[0, None])
    assert str(bound.k0) == "20" and 70 < bound.k1 < 75 and bound.excess < 0.01
    assert [share.n_o for share in bound.shares] == [0, None]
    assert sigmastar.transfer(EXAMPLE, minimise=(1, Fraction(2, 3)), n_o=[]).k0 > 19.7
    with pytest.raises(sigmastar.RefutedError) as caught:
        sigmastar.transfer(EXAMPLE, k0="19.7")
    assert caught.value.verdict == "refuted" and "19.739" in str(caught.value)
    with pytest.raises(sigmastar.InputError):
        sigmastar.transfer(EXAMPLE, k0=-1)
    with pytest.raises(ValueError):
        sigmastar.transfer(EXAMPLE, k0=20, minimise=(1, 1))


def test_rates(program):
    rates = sigmastar.rate(EXAMPLE, [0, 2], sigma=50)
    report = json.loads(program("rate", EXAMPLE, "--n-o", "0,2", "--sigma", "50", "--format", "json")[1])
    assert json.loads(rates.report("json")) == report
    assert [rate.n_o for rate in rates.rates] == [0, 2] and (rates.sigma, rates.sigma_star) == ("50", "39.8018")
    for rate, told in zip(rates.rates, report["rates"]):
        assert (str(rate.closed_loop), rate.method) == (told["closed_loop"], told["closed_loop_by"])
        assert 0 < Fraction(float(rate.closed_loop)) <= rate.closed_loop.fraction
    # At sigma* by default.
    assert sigmastar.rate(EXAMPLE, [0]).sigma == "39.8018"


def test_rates_that_there_are_not(document):
    for n_o, options in ([[0], {"sigma": 39}], [[201], {}]):
        with pytest.raises(sigmastar.InputError):
            sigmastar.rate(EXAMPLE, n_o, **options)
    for wrong in ([-1], [0.5], [True]):
        with pytest.raises(ValueError):
            sigmastar.rate(EXAMPLE, wrong)
    # The initial set is too large for the domain: no certificate, and no rate.
    document["domain"] = {"X": "1", "E": "1"}
    document["initial_set"] = {"kind": "box", "X0": "1", "E0": "4", "Z0": "0"}
    with pytest.raises(sigmastar.UndecidedError) as caught:
        sigmastar.rate(document, [0])
    assert caught.value.kind == "not-certified" and "domain" in str(caught.value)


def test_of_a_plant():
    assert sigmastar.rate(PLANT, [1]).rates[0].oscillators > 0
    assert sigmastar.transfer(PLANT, n_o=[1]).k1 > 0
