"""The regulator as matrices."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Dict, Protocol

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from control import StateSpace

Matrix = NDArray[np.float64]


class _Matrices(Protocol):
    """What a linear system from the error e to the control u has, with the state z."""

    @property
    def A(self) -> Matrix: ...
    @property
    def B(self) -> Matrix: ...
    @property
    def C(self) -> Matrix: ...
    @property
    def D(self) -> Matrix: ...
    @property
    def step(self) -> float | None: ...


class _System:
    """A linear system from the error e to the control u, with the state z."""

    def control(self: _Matrices, z: Any, e: float) -> float:
        """The control u for a state z and a measured error e."""
        return float(self.C[0] @ np.asarray(z, dtype=float) + self.D[0, 0] * e)

    def to_control(self: _Matrices) -> StateSpace:
        """The system of python-control, which has to be installed: input `e`, output `u`."""
        try:
            import control
        except ImportError as error:
            raise ImportError("to_control needs python-control: pip install control") from error
        names: Dict[str, Any] = {"inputs": ["e"], "outputs": ["u"], "name": "regulator"}
        time = 0 if self.step is None else self.step
        return control.StateSpace(self.A, self.B, self.C, self.D, time, **names)


@dataclass(frozen=True, eq=False)
class Regulator(_System):
    """The regulator `z' = Phi z + Gamma e`, `u = (-sigma e + mu M'N(z - M e))/nominal`, in double precision; no claim is made of
    the rounded numbers."""

    sigma: float
    """The gain sigma."""
    mu: float
    """The gain mu."""
    Phi: Matrix
    """Phi, square of order 2 n_o + 1."""
    Gamma: Matrix
    """Gamma, a vector."""
    M: Matrix
    """M, a vector."""
    N: Matrix
    """The diagonal of N."""
    step: None = None
    """There is no sampling time."""
    nominal: float = 1.0
    """The nominal gain of the actuator, by which u is divided; 1 where the document states none."""

    @property
    def A(self) -> Matrix:
        """Phi."""
        return self.Phi

    @property
    def B(self) -> Matrix:
        """Gamma as a column."""
        return self.Gamma[:, np.newaxis]

    @property
    def C(self) -> Matrix:
        """mu M'N over the nominal gain, as a row."""
        return self.mu * (self.M * self.N)[np.newaxis, :] / self.nominal

    @property
    def D(self) -> Matrix:
        """-sigma - mu M'N M over the nominal gain, as a matrix of one entry."""
        return np.array([[(-self.sigma - self.mu * float(np.sum(self.M * self.N * self.M))) / self.nominal]])


@dataclass(frozen=True, eq=False)
class SampledRegulator(_System):
    """The regulator at samples, its control held between them: `u(k) = C z(k) + D e(k)`, `z(k+1) = A z(k) + B e(k)`. A claim
    covers it only where it is about the regulator at samples, with the same gain and sampling time."""

    step: float
    """The sampling time."""
    gain: float
    """The gain K."""
    A: Matrix
    """The transition matrix."""
    B: Matrix
    """The input matrix, a column."""
    C: Matrix
    """The output matrix, a row."""
    D: Matrix
    """The feedthrough, a matrix of one entry."""
    spectral_radius: float
    """The spectral radius of the sampled loop on the plant e' = u, in floating point."""


def regulator(told: Dict[str, Any]) -> Regulator:
    """The regulator in continuous time from the library's answer."""
    phi, gamma, m, n = (np.array(told[name]) for name in ("phi", "gamma", "m", "n"))
    return Regulator(sigma=told["sigma"], mu=told["mu"], Phi=phi, Gamma=gamma, M=m, N=n, nominal=told["nominal"])


def sampled(told: Dict[str, Any]) -> SampledRegulator:
    """The regulator at samples."""
    return SampledRegulator(
        step=told["step"],
        gain=told["gain"],
        A=np.array(told["phi"]),
        B=np.array(told["gamma"])[:, np.newaxis],
        C=np.array(told["c"])[np.newaxis, :],
        D=np.array([[told["d"]]]),
        spectral_radius=told["spectral_radius"],
    )
