"""The fixed-step loop of the paper's example with four oscillators in NumPy: argv[1] steps of 1e-4."""
import sys
import time

import numpy as np

N_O = 4
SIGMA, MU, TWO_PI = 2.0, 1.0, 2 * np.pi
weight = np.array([2.0] + [l**-1.5 for l in range(1, N_O + 1)])
frequency = TWO_PI * np.arange(1, N_O + 1)


def right_side(t, y):
    x1, x2, e = y[:3]
    z = y[3:]
    dy = np.empty_like(y)
    c = np.cos(TWO_PI * t)
    s = weight @ (z[[0, 1, 3, 5, 7]] - e)
    dy[0] = -x1 / 5 + np.sqrt(3) * x2 + np.sin(x2) / 10 + np.sin(TWO_PI * t)
    dy[1] = -np.sqrt(3) * x1 - x2 + x2**2 / 10 + x2 * e + np.cos(2 * TWO_PI * t) * (1 + np.sin(TWO_PI * t))
    dy[2] = 1 + x1 + np.arctan(e * x2) + c + c**2 + c**3 + c**4 - SIGMA * e + MU * s
    dy[3] = -SIGMA * e
    dy[4::2] = frequency * z[2::2] - SIGMA * e
    dy[5::2] = frequency * (e - z[1::2])
    return dy


steps, h = int(sys.argv[1]), 1e-4
y = np.zeros(4 + 2 * N_O)
y[:3] = [1.0, -2.0, 4.0]
start = time.process_time()
for step in range(steps):
    t = step % 10000 * h
    k1 = right_side(t, y)
    k2 = right_side(t + 0.5 * h, y + 0.5 * h * k1)
    k3 = right_side(t + 0.5 * h, y + 0.5 * h * k2)
    k4 = right_side(t + h, y + h * k3)
    y = y + h / 6 * (k1 + 2 * (k2 + k3) + k4)
print(f"{time.process_time() - start:.9f} {y[2]:.17g}")
