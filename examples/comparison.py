"""The magnetic bearing of specs/machines by a scaled small-gain test, one number of oscillators at a time.

pip install control; python examples/comparison.py. Floating point, on a grid of frequencies.
"""

import control as ct
import numpy as np

# specs/machines/magnetic-bearing.toml; the force's slope is known to an interval for |p| <= 0.2 mm.
LAMBDA, MASS, GAP, REACH, MU, OMEGA = 500.0, 1.637, 0.78, 0.2, 500.0, 200 * np.pi
LOW, HIGH = 172000 / MASS, 210000 / MASS * (1 + 6 * REACH**2 / GAP**2)
MEAN, RADIUS, GAIN = (LOW + HIGH) / 2, (HIGH - LOW) / 2, 0.1


def loop(sigma: float, n_o: int) -> ct.StateSpace:
    """The loop that two uncertainties of size 1 see, of the actuator's gain and of the slope."""
    weights = np.array([2.0] + [l**-1.5 for l in range(1, n_o + 1)])
    size = 2 * n_o + 1
    m, n, phi = np.zeros(size), np.zeros(size), np.zeros((size, size))
    m[0], n[0] = 1, weights[0]
    for l in range(1, n_o + 1):
        m[2 * l - 1] = 1
        n[2 * l - 1 : 2 * l + 1] = weights[l]
        phi[2 * l - 1, 2 * l], phi[2 * l, 2 * l - 1] = l * OMEGA, -l * OMEGA
    gamma = -(phi + sigma * np.eye(size)) @ m
    u = np.concatenate([[0, -sigma - MU * m @ (n * m)], MU * n * m])  # of p, e, z
    a = np.zeros((size + 2, size + 2))
    a[0, :2] = -LAMBDA, 1
    a[1, :2] = MEAN - LAMBDA**2, LAMBDA
    a[1] += u
    a[2:, 1], a[2:, 2:] = gamma, phi
    b = np.zeros((size + 2, 2))
    b[1] = 1, 1
    c = np.zeros((2, size + 2))
    c[0], c[1, 0] = GAIN * u, RADIUS
    return ct.StateSpace(a, b, c, np.zeros((2, 2)))


def norm(sigma: float, n_o: int) -> float:
    """The least norm over constant scalings on the grid, below 1 where the test is passed; infinite where the loop is unstable."""
    system = loop(sigma, n_o)
    if np.real(system.poles()).max() >= 0:
        return np.inf
    near = [l * OMEGA * (1 + s * 10.0**-k) for l in range(1, n_o + 1) for k in range(1, 5) for s in (-1, 1)]
    answer = np.moveaxis(system(1j * np.unique(np.concatenate([np.logspace(0, 5.5, 500), near]))), -1, 0)
    scalings = [np.array([[1, scale], [1 / scale, 1]]) for scale in np.logspace(-2, 2, 81)]
    return min(float(np.linalg.norm(answer * scaling, 2, axis=(1, 2)).max()) for scaling in scalings)


NUMBERS = (0, 1, 3, 10, 30)
print("sigma   " + "".join(f"  n_o = {n_o:2}" for n_o in NUMBERS))
for sigma in (1, 10, 100, 657.387, 3000):
    print(f"{sigma:<8}" + "".join(f"  {norm(sigma, n_o):8.4f}" for n_o in NUMBERS))
