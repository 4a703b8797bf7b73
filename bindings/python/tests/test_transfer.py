"""The transfer bound by itself."""

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


def test_of_a_plant():
    assert sigmastar.transfer(PLANT, n_o=[1]).k1 > 0
