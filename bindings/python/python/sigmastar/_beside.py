"""What is asked beside one claim: a bounding specification, a Lyapunov triple, pairs of a gain and a sampling period."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Dict, List, Optional, Tuple, Union

from ._exact import Exact, Shown, Side, digits, stated
from ._report import Reported
from ._results import Certificate, write
from ._table import axes, dataframe

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from pandas import DataFrame


@dataclass(frozen=True, repr=False)
class BoundedPlant(Shown):
    """A bounding specification whose every number is proved of a plant. `certify` takes its `document`."""

    domain: Tuple[Exact, Exact]
    """X and E: the bounds hold for `|y| <= X`, `|e| <= E`, in coordinates y relative to the orbit. Rounded down."""
    is_limited: bool
    """Whether the domain ends with that of the plant."""
    _json: str = field(repr=False)

    @property
    def document(self) -> Dict[str, Any]:
        """The specification as a dictionary."""
        found: Dict[str, Any] = json.loads(self._json)
        return found

    def to_json(self) -> str:
        """The specification; the bytes are those of `sigmastar bound`."""
        return self._json

    def save(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Writes the specification; it appears whole or not at all."""
        write(path, self._json)


@dataclass(frozen=True, repr=False)
class Lyapunov(Reported):
    """The proved Lyapunov triple of a Jacobian, or the proved orbit of a plant with the coordinates in which it contracts. Every number
    is in `data`, as in the JSON of the report."""

    _reports: Dict[str, str] = field(repr=False)

    @property
    def triple(self) -> Tuple[Exact, Exact, Exact]:
        """p_low, p_up and alpha, rounded down, up and down; of a plant in the coordinates that `data` has."""
        return (stated(self.data["p_low"], "down"), stated(self.data["p_up"], "up"), stated(self.data["alpha"], "down"))

    def __repr__(self) -> str:
        low, up, alpha = self.triple
        return f"<Lyapunov: p_low={digits(low, 'down')}, p_up={digits(up, 'up')}, alpha={digits(alpha, 'down')}>"


@dataclass(frozen=True, repr=False)
class Pair(Shown):
    """A certified pair of a gain and a sampling period."""

    sigma: Exact
    """The gain."""
    sampling_period: Exact
    """The sampling period."""
    samples: int
    """How many of them are in a period of the disturbance."""
    limit: str
    """What keeps the gain from being smaller or the sampling period from being longer, in a sentence."""


@dataclass(frozen=True, repr=False)
class SamplingPairs(Reported):
    """Certified pairs of a gain and a sampling period. Each is certified by itself; between them nothing is said. It is true where
    there is one."""

    has_pair: bool
    """Whether any pair is certified."""
    _reports: Dict[str, str] = field(repr=False)

    @property
    def by_sampling_period(self) -> List[Pair]:
        """For each sampling period with a certified gain the smallest one that was found."""
        return self._pairs("by_sampling_period")

    @property
    def by_sigma(self) -> List[Pair]:
        """For each gain with a certified sampling period the longest one that was found."""
        return self._pairs("by_sigma")

    @property
    def round(self) -> List[Pair]:
        """For each gain of `by_sigma` the longest round sampling period that was tried and certified: 1, 2 or 5 times a power of ten, or with
        such a number of samples where no such period fits (`data` says which)."""
        return self._pairs("round")

    def _pairs(self, part: str) -> List[Pair]:
        rows = [row for row in self.data[part] if row["outcome"] == "certified"]
        return [
            Pair(stated(row["sigma"]), stated(row["sampling_period"]), row["samples"], row["limit"]["sentence"]) for row in rows
        ]

    def to_dataframe(self) -> DataFrame:
        """All pairs as a table of pandas, which has to be installed."""
        pairs = self.by_sampling_period + self.by_sigma
        names = ("sigma", "sampling_period", "samples")
        return dataframe({name: [getattr(pair, name) for pair in pairs] for name in names})

    def plot(self, ax: Optional[Axes] = None) -> Axes:
        """The pairs, with matplotlib, which has to be installed."""
        ax = axes(ax, "sampling period", "sigma")
        for pairs, label in ((self.by_sampling_period, "smallest sigma"), (self.by_sigma, "longest sampling period")):
            ax.plot([pair.sampling_period for pair in pairs], [pair.sigma for pair in pairs], "o", label=label)
        ax.legend()
        return ax

    def __bool__(self) -> bool:
        return self.has_pair

    def __repr__(self) -> str:
        return f"<SamplingPairs: {len(self.by_sampling_period) + len(self.by_sigma)} certified>"


@dataclass(frozen=True, repr=False)
class Design(Reported):
    """What is proved at several gains with several numbers of oscillators, beside what is required, and the pair to take. It is true where
    every requirement is proved to be met."""

    sigma: Exact
    """The gain to take."""
    n_o: Optional[int]
    """The number of oscillators to take; None where nothing is required, as the gain is for each number of the table, and where it is a set of harmonics."""
    harmonics: Optional[List[int]]
    """The set of harmonics to take, 0 the first; None where it is a number of oscillators, and where nothing is required."""
    is_met: bool
    """Whether every requirement is proved to be met with this pair; so it is where nothing is required."""
    certificate: Certificate
    """The certificate of the gain to take."""
    _reports: Dict[str, str] = field(repr=False)

    @property
    def rows(self) -> List[Dict[str, Any]]:
        """The cells of the table, each with its `sigma`: `n_o` or `harmonics` (the other is None), `steady_error`, `peak_error`, `max_control`, `rate`, `factor`, `settle`, `noise`, of
        which each is text or None, and `not_in_certificate` and `simulated` (docs/formats.md); with `sampling_periods` also `longest_h`, of the
        regulator at samples: the longest round sampling period that is certified with the gain, or None."""
        return [
            {"sigma": row["sigma"], **_longest(row), **cell} for row in self.data["rows"] for cell in row["cells"]
        ]

    @property
    def values(self) -> Dict[str, str]:
        """The values of the numbers that were chosen, exactly; all else is about the document with these."""
        return dict((self.data["values"] or {}).get("taken") or {})

    def to_dataframe(self) -> DataFrame:
        """The table of pandas, which has to be installed: proved numbers rounded to their side."""
        sides: Dict[str, Side] = {"steady_error": "up", "peak_error": "up", "max_control": "up", "rate": "down", "factor": "up", "settle": "up", "noise": "up"}
        columns: Dict[str, List[Any]] = {"sigma": [float(stated(row["sigma"])) for row in self.rows]}
        columns["n_o"] = [row["n_o"] for row in self.rows]
        columns["harmonics"] = [row["harmonics"] for row in self.rows]
        for name, side in sides.items():
            columns[name] = [None if row[name] is None else float(stated(row[name], side)) for row in self.rows]
        return dataframe(columns)

    def __bool__(self) -> bool:
        return self.is_met

    def __repr__(self) -> str:
        met = "" if self.is_met else ", not all that is required"
        which = f"n_o={self.n_o}" if self.harmonics is None else f"harmonics={self.harmonics}"
        return f"<Design: sigma={self.sigma.exact}, {which}{met}>"


def _longest(row: Dict[str, Any]) -> Dict[str, Optional[str]]:
    if "longest_h" not in row:
        return {}
    found = row["longest_h"]
    return {"longest_h": found and (found["round"] or found["longest"])["sampling_period"]}


@dataclass(frozen=True, repr=False)
class Tuned(Shown):
    """A number that was tuned."""

    name: str
    """Its name."""
    before: str
    """Its value in the document as it was."""
    after: Optional[str]
    """Its better value, exactly; None where nothing better was found."""


@dataclass(frozen=True, repr=False)
class Tuning(Reported):
    """Better values of free numbers, each certified by itself; that nothing better exists is not claimed. It is true where anything is
    certified, before or after."""

    has_claim: bool
    """Whether anything is certified."""
    _document: Optional[str] = field(repr=False)
    _reports: Dict[str, str] = field(repr=False)

    @property
    def is_better(self) -> bool:
        """Whether better values were found."""
        return self._document is not None

    @property
    def values(self) -> List[Tuned]:
        """The numbers, before and after."""
        return [Tuned(row["name"], row["before"], row["after"]) for row in self.data["parameters"]]

    @property
    def document(self) -> Optional[Dict[str, Any]]:
        """The document with the better values and nothing else changed; None where nothing better was found."""
        found: Optional[Dict[str, Any]] = None if self._document is None else json.loads(self._document)
        return found

    def save(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Writes that document as JSON; it appears whole or not at all.

        Raises ValueError where nothing better was found.
        """
        if self._document is None:
            raise ValueError("nothing better was found: there is no document to write")
        write(path, self._document)

    def __bool__(self) -> bool:
        return self.has_claim

    def __repr__(self) -> str:
        if not self.is_better:
            return "<Tuning: nothing better was found>"
        return f"<Tuning: {', '.join(f'{one.name}={one.after}' for one in self.values)}>"
