"""The regulator as matrices."""

import math

import numpy
import pytest
import sigmastar
from conftest import EXAMPLE, PLANT


def test_the_matrices():
    regulator = sigmastar.controller(EXAMPLE, 2, sigma=48)
    w = 2 * math.pi
    assert (regulator.sigma, regulator.mu, regulator.step) == (48.0, 1.0, None)
    assert regulator.Phi.dtype == numpy.float64 and regulator.Phi.shape == (5, 5)
    assert regulator.Phi[1].tolist() == [0, 0, w, 0, 0] and regulator.Phi[4].tolist() == [0, 0, 0, -2 * w, 0]
    assert regulator.Gamma.tolist() == [-48, -48, w, -48, 2 * w]
    assert regulator.M.tolist() == [1, 1, 0, 1, 0] and regulator.N[:3].tolist() == [2, 1, 1]
    shapes = [matrix.shape for matrix in (regulator.A, regulator.B, regulator.C, regulator.D)]
    assert shapes == [(5, 5), (5, 1), (1, 5), (1, 1)]
    # u = -sigma e + mu M'N(z - M e).
    z, e = numpy.array([0.3, -1, 2, 0.5, 4]), 0.7
    expected = -48 * e + (regulator.M * regulator.N) @ (z - regulator.M * e)
    assert abs(regulator.control(z, e) - expected) < 1e-13
    assert abs((regulator.C @ z + regulator.D[0] * e)[0] - expected) < 1e-13


def test_the_law_at_samples():
    regulator = sigmastar.controller(EXAMPLE, 2, sigma="48", step="1/1000")
    assert (regulator.step, regulator.B[0, 0]) == (1e-3, -0.048) and regulator.spectral_radius < 1
    assert regulator.A[1, 1] == math.cos(2 * math.pi / 1000) and regulator.C.shape == (1, 5)
    assert regulator.control([1, 0, 0, 0, 0], 0) == regulator.C[0, 0]
    with pytest.raises(sigmastar.InputError):
        sigmastar.controller(EXAMPLE, 2, sigma=48, step="1/24")


def test_of_a_certificate():
    certificate = sigmastar.certify(EXAMPLE, compare=False)
    regulator = sigmastar.controller(certificate)
    assert regulator.sigma == float(certificate.sigma_star) and regulator.Phi.shape == (9, 9)
    assert sigmastar.controller(certificate, 0, step="1/1000").step == 1e-3
    with pytest.raises(ValueError):
        sigmastar.controller(certificate, sigma=1)
    sampled = sigmastar.certify(EXAMPLE, sampling_period="1/100", compare=False)
    law = sigmastar.controller(sampled, 3)
    assert law.step == 0.01 and law.gain == float(sampled.samples.gain)
    for wrong in ({"sigma": 50}, {"step": "1/200"}):
        with pytest.raises(ValueError):
            sigmastar.controller(sampled, **wrong)
    # The claim is about fewer oscillators than half of the samples.
    with pytest.raises(sigmastar.InputError):
        sigmastar.controller(sampled, 50)


def test_what_is_refused():
    with pytest.raises(ValueError):
        sigmastar.controller(EXAMPLE)
    for n_o in (-1, 0.5, True, 1 << 40):
        with pytest.raises(ValueError):
            sigmastar.controller(EXAMPLE, n_o, sigma=1)
    with pytest.raises(sigmastar.InputError) as caught:
        sigmastar.controller(EXAMPLE, sigma="1e4000")
    assert caught.value.kind == "overflow"
    assert sigmastar.controller(PLANT, 1, sigma=3).Phi.shape == (3, 3)


def test_python_control():
    control = pytest.importorskip("control")
    regulator = sigmastar.controller(EXAMPLE, 2, sigma=48)
    system = regulator.to_control()
    assert isinstance(system, control.StateSpace) and system.isctime() and system.input_labels == ["e"]
    # The integrator and the oscillators are poles.
    assert numpy.allclose(sorted(system.poles().imag), [-4 * math.pi, -2 * math.pi, 0, 2 * math.pi, 4 * math.pi])
    s = 1 + 2j
    direct = regulator.C @ numpy.linalg.solve(s * numpy.eye(5) - regulator.A, regulator.B) + regulator.D
    assert numpy.allclose(system(s), direct[0, 0])
    sampled = sigmastar.controller(EXAMPLE, 2, sigma=48, step="1/1000").to_control()
    assert sampled.dt == 1e-3 and sampled.nstates == 5
