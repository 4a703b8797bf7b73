"""What certifying, checking and the other proofs find."""

from __future__ import annotations

import json
import os
import tempfile
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Dict, List, Literal, Optional, Tuple, Union

from ._condition import Condition, conditions
from ._exact import Exact, Shown, digits, stated
from ._report import Reported
from ._table import axes

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True, repr=False)
class InitialSet(Shown):
    """The set `|x| <= x0`, `|e| <= e0`, `sqrt(z'Nz) <= z0`, each number rounded down: the smaller set is covered too.

    Without z0 the regulator sets `z = M e` at its first instant.

    Of a plant by its formulas it is `|L^-1 (x - x_0(t))| <= x0` in the place of `|x| <= x0`, with the orbit x_0 and the
    coordinates L of its certificate.
    """

    _sides = {"x0": "down", "e0": "down", "z0": "down"}

    x0: Exact
    e0: Exact
    z0: Optional[Exact]
    ball: Optional[str]
    """Of a plant: a radius such that the set contains all x with `|x - x_0(t)|` up to it, exactly."""


@dataclass(frozen=True, repr=False)
class PeriodicSolution(Shown):
    """Upper bounds of the periodic solution, rounded up: of |x|, |e|, |zeta|_N and |z|_N."""

    _sides = {"x": "up", "e": "up", "zeta": "up", "z": "up"}

    x: float
    e: float
    zeta: float
    z: float


@dataclass(frozen=True)
class Samples:
    """The samples of a regulator that a computer runs."""

    period: str
    """The sampling period, exactly."""
    count: int
    """How many of them are in a period of the disturbance."""
    gain: str
    """K of the law u = -sigma e + K v, a double, exactly."""


@dataclass(frozen=True, repr=False)
class ErrorBound(Shown):
    """Upper bounds of the error along the periodic solution with a number of oscillators. They follow from the claim; no independent
    program checks them."""

    _sides = {"sup": "up", "rms": "up"}

    n_o: int
    """The number of oscillators."""
    sup: Exact
    """Of sup|e|, rounded up."""
    rms: Exact
    """Of the root mean square of e, rounded up."""


@dataclass(frozen=True, repr=False)
class ClaimedRate(Shown):
    """What the claim says of oscillators at some harmonics, at its gain alone: `|e - e_per| <= factor exp(-rate (t - t_0))`
    in the undisturbed loop; at samples at the sampling instants. With the noise, disturbance and rounding of the document
    `|e - e_per|` is at most `noise_limit` in the end and `noise_peak` at all times."""

    _sides = {"rate": "down", "factor": "up", "noise_limit": "up", "noise_peak": "up"}

    n_o: Optional[int]
    """The number of oscillators; None where their harmonics are not the first ones."""
    harmonics: Tuple[int, ...]
    """Their harmonics, 0 among them."""
    rate: Exact
    """The rate, in 1/time, rounded down."""
    factor: Exact
    """The factor, for every start in the initial set, rounded up."""
    noise_limit: Optional[Exact] = None
    """Rounded up; None where the document states nothing of this kind, or nothing is proved."""
    noise_peak: Optional[Exact] = None
    """Rounded up; None where `noise_limit` is."""


@dataclass(frozen=True, repr=False)
class ClaimedBounds(Shown):
    """What the claim says of oscillators at some harmonics, at its gain alone, for every plant and gain of the actuator of the claim. Each number is
    rounded up. The certificate has them, so that `check` decides them."""

    _sides = {
        "steady_error": "up",
        "steady_rms": "up",
        "steady_control": "up",
        "largest_error": "up",
        "largest_control": "up",
    }

    n_o: Optional[int]
    """The number of oscillators; None where their harmonics are not the first ones."""
    harmonics: Tuple[int, ...]
    """Their harmonics, 0 among them."""
    or_more: bool
    """Whether every larger number of oscillators has these bounds, too."""
    steady_error: Exact
    """Of |e| along the periodic solution."""
    steady_rms: Exact
    """Of the root mean square of e along the periodic solution."""
    steady_control: Exact
    """Of what is put out along the periodic solution."""
    largest_error: Optional[Exact]
    """Of |e| at all times, for every solution from the initial set; None where that is not proved."""
    largest_control: Optional[Exact]
    """Of what is put out at all times; None where `largest_error` is."""


@dataclass(frozen=True, repr=False)
class Certificate(Reported):
    """A certified claim, the conditions that prove it, and the file from which both can be checked again.

    There is one only where every condition is proved. It can be sent to other processes.
    """

    sigma_star: Exact
    """The gain. The claim holds for it and every larger one; the double is rounded up, so that it holds for the double too.
    Where `samples` is given, and with an `actuator`, the claim is about exactly `sigma_star.exact`, and the double is the nearest one."""
    samples: Optional[Samples]
    """The samples of the regulator that the claim is about; None where it is about the one in continuous time."""
    statement: str
    """The claim in words, with what it speaks of and what is given and not proved."""
    initial_set: InitialSet
    """The initial conditions from which convergence is proved."""
    periodic_solution: PeriodicSolution
    """Upper bounds of the periodic solution."""
    conditions: List[Condition]
    """The conditions, all of which are proved."""
    remarks: List[str]
    """What the data are to be looked at for. The claim holds all the same."""
    name: str
    """The name of the specification or plant."""
    is_plant: bool
    """Whether the claim is about one plant by its formulas, and not about all plants of bounding functions."""
    sha256: str
    """SHA-256 of the specification or plant."""
    _json: str = field(repr=False)
    _subject: str = field(repr=False)
    _reports: Dict[str, str] = field(repr=False)

    @property
    def verdict(self) -> Literal["certified"]:
        """`certified`: what is not certified is an exception and no certificate."""
        return "certified"

    @property
    def sigma_star_exact(self) -> str:
        """The gain exactly: a decimal or a fraction."""
        return self.sigma_star.exact

    @property
    def error_bounds(self) -> List[ErrorBound]:
        """Bounds of the error by the number of oscillators, at the gain and at every larger one that is certified; of the regulator at samples, and
        with an `actuator`, at its gain alone."""
        rows = (self.data.get("consequences") or {}).get("error_bounds", [])
        return [ErrorBound(row["n_o"], stated(row["sup"], "up"), stated(row["rms"], "up")) for row in rows]

    @property
    def rates(self) -> List[ClaimedRate]:
        """What `certify` was asked with `n_o` and `harmonics`."""
        return [_rate(row) for row in self.data.get("for_n_o") or []]

    @property
    def bounds(self) -> List[ClaimedBounds]:
        """Bounds of the error and of the control by the number of oscillators, and for the sets of `harmonics`: far smaller, as a rule, than `error_bounds`.
        None of a bounding specification."""
        return [_bounds(part) for part in json.loads(self._json)["claim"].get("by_n_o", [])]

    def plot(self, ax: Optional[Axes] = None) -> Axes:
        """The bounds of the error against the number of oscillators, with matplotlib, which has to be installed."""
        bounds = self.error_bounds
        ax = axes(ax, "n_o + 1", "bound of e")
        for label, values in (("sup|e|", [one.sup for one in bounds]), ("rms(e)", [one.rms for one in bounds])):
            ax.loglog([one.n_o + 1 for one in bounds], values, "o-", label=label)
        ax.legend()
        return ax

    def __repr__(self) -> str:
        # A claim about one gain is about all its digits.
        exactly = self.samples is not None or "actuator" in json.loads(self._subject)
        sigma = self.sigma_star_exact if exactly else digits(self.sigma_star, "up")
        at = "" if self.samples is None else f", sampling_period={self.samples.period}"
        return f"<{type(self).__name__} of {self.name!r}: sigma_star={sigma}{at}>"

    def to_json(self) -> str:
        """The certificate file, self-contained; the bytes are those of `sigmastar certify -o`."""
        return self._json

    def save(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Writes the certificate file; it appears whole or not at all."""
        write(path, self._json)


@dataclass(frozen=True, repr=False)
class SampledCertificate(Certificate):
    """A certified claim about the regulator at samples, for exactly its gain and sampling period."""

    samples: Samples


@dataclass(frozen=True, repr=False)
class Check(Reported):
    """The answer of the independent checker. It is true only where the claim is proved again."""

    verdict: Literal["valid", "invalid", "bad-input", "undecided"]
    """`valid`, `invalid`, `bad-input` or `undecided`."""
    statement: Optional[str]
    """The claim that is proved; None where none is."""
    sha256: Optional[str]
    """SHA-256 of what the proved claim is about."""
    assumed: List[str]
    """What the proved claim assumes of the plant, in sentences."""
    _reports: Dict[str, str] = field(repr=False)

    @property
    def is_valid(self) -> bool:
        """Whether the claim is proved."""
        return self.verdict == "valid"

    def __bool__(self) -> bool:
        return self.is_valid

    def __repr__(self) -> str:
        return f"<Check: {self.verdict}>"

    def __str__(self) -> str:
        return self._reports["text"]


@dataclass(frozen=True)
class Share:
    """How much of the transfer bound a number of oscillators uses."""

    n_o: Optional[int]
    """The number; None for infinitely many."""
    ratio: Tuple[float, float]
    """The largest T_N(x)/(k0 + k1 x^2) lies between these, rounded outward."""


@dataclass(frozen=True, repr=False)
class TransferBound(Reported):
    """A proved bound T_N(x) <= k0 + k1 x^2, for every number of oscillators and every x >= 0. No certificate carries it."""

    k0: Exact
    """k0, rounded up: with it the bound holds too."""
    k1: Exact
    """k1, rounded up."""
    excess: Optional[float]
    """By how much, relatively, k1 exceeds a proved lower bound of every k1 that would do with this k0; rounded up."""
    shares: List[Share]
    """How much of the bound some numbers of oscillators use."""
    _reports: Dict[str, str] = field(repr=False)

    def __repr__(self) -> str:
        return f"<TransferBound: k0={digits(self.k0, 'up')}, k1={digits(self.k1, 'up')}>"


def _rate(row: Dict[str, Any]) -> ClaimedRate:
    noise = row.get("noise") or {}
    limit, peak = (None if noise.get(name) is None else stated(noise[name], "up") for name in ("limit", "peak"))
    return ClaimedRate(row.get("n_o"), _harmonics(row), stated(row["rate"], "down"), stated(row["factor"], "up"), limit, peak)


def _harmonics(part: Dict[str, Any]) -> Tuple[int, ...]:
    """At which the oscillators are that a part of the claim is about."""
    n_o = part.get("n_o")
    return tuple(part["harmonics"] if n_o is None else range(n_o + 1))


def _bounds(part: Dict[str, Any]) -> ClaimedBounds:
    steady = (stated(part["steady"][name], "up") for name in ("e", "e_rms", "u"))
    largest = part.get("largest")
    of_all = (None, None) if largest is None else (stated(largest[name], "up") for name in ("e", "u"))
    return ClaimedBounds(part.get("n_o"), _harmonics(part), part.get("or_more", False), *steady, *of_all)


def exact(told: Optional[Tuple[float, str]]) -> Any:
    """A number with its text."""
    return None if told is None else Exact(told[0], told[1])


def certificate(told: Dict[str, Any]) -> Certificate:
    """A certificate from the library's answer."""
    x0, e0, z0 = map(exact, told["initial_set"])
    fields: Dict[str, Any] = dict(
        sigma_star=exact(told["sigma_star"]),
        statement=told["statement"],
        initial_set=InitialSet(x0, e0, z0, told["ball"]),
        periodic_solution=PeriodicSolution(*told["periodic_solution"]),
        conditions=conditions(told["conditions"]),
        remarks=told["remarks"],
        name=told["name"],
        is_plant=told["is_plant"],
        sha256=told["sha256"],
        _json=told["json"],
        _subject=told["subject"],
        _reports=told["reports"],
    )
    if told["samples"] is None:
        return Certificate(samples=None, **fields)
    return SampledCertificate(samples=Samples(*told["samples"]), **fields)


def check(told: Dict[str, Any]) -> Check:
    """The checker's answer."""
    return Check(
        verdict=told["verdict"],
        statement=told["statement"],
        sha256=told["sha256"],
        assumed=told["assumed"],
        _reports=told["reports"],
    )


def transfer(told: Dict[str, Any]) -> TransferBound:
    """A transfer bound."""
    return TransferBound(
        k0=exact(told["k0"]),
        k1=exact(told["k1"]),
        excess=told["excess"],
        shares=[Share(n_o, (low, high)) for n_o, low, high in told["shares"]],
        _reports=told["reports"],
    )


def write(path: Union[str, "os.PathLike[str]"], content: str) -> None:
    """Writes a file through a temporary one in the same folder: it appears whole or not at all."""
    target = os.path.realpath(os.fspath(path))
    handle, temporary = tempfile.mkstemp(dir=os.path.dirname(target))
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(content.encode("utf-8"))
        # A temporary file is the owner's alone; a file that is written has the usual permissions, or those it had.
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(temporary, os.stat(target).st_mode & 0o7777 if os.path.exists(target) else 0o666 & ~mask)
        os.replace(temporary, target)
    except BaseException:
        os.unlink(temporary)
        raise
