"""Simulations and attempts to break a certificate: floating point, no claim."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, Dict, List, Literal, Optional

from ._exact import digits
from ._report import Reported
from ._table import axes, dataframe

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from pandas import DataFrame


@dataclass(frozen=True, repr=False)
class Simulation(Reported):
    """The steady state of a loop with its figures, and a run from the initial condition of the plant. It claims nothing."""

    is_complete: bool
    """Whether the steady state was found and the run reached its end; otherwise the report says why and what to try."""
    _csv: Optional[str] = field(repr=False)
    _reports: Dict[str, str] = field(repr=False)

    @property
    def steady_state(self) -> Dict[str, Any]:
        """The figures of the steady state, as in the JSON of the report: `sup_e`, `rms_e`, `sup_u`, `amplitudes` and others."""
        found: Dict[str, Any] = self.data["steady_state"]
        return found

    @cached_property
    def run(self) -> Dict[str, List[float]]:
        """The run: `t`, the states, `e`, `u` and the states of the regulator; nothing where it ended early."""
        if self._csv is None:
            return {}
        head, *rows = self._csv.splitlines()
        numbers = [[float(number) for number in row.split(",")] for row in rows]
        return {name: [row[at] for row in numbers] for at, name in enumerate(head.split(","))}

    def to_csv(self) -> str:
        """The run as the file of `sigmastar simulate --csv`."""
        return self._csv or ""

    def to_dataframe(self) -> DataFrame:
        """The run as a table of pandas, which has to be installed."""
        return dataframe(dict(self.run))

    def plot(self, ax: Optional[Axes] = None) -> Axes:
        """The error along the run, with matplotlib, which has to be installed."""
        ax = axes(ax, "t", "e")
        ax.plot(self.run.get("t", []), self.run.get("e", []))
        return ax

    def __repr__(self) -> str:
        sup = (self.steady_state or {}).get("sup_e")
        shown = "no steady state" if sup is None else f"sup|e|={digits(sup)}, rms(e)={digits(self.steady_state['rms_e'])}"
        return f"<Simulation: {shown}{'' if self.is_complete else ', not complete'}>"


@dataclass(frozen=True, repr=False)
class Falsification(Reported):
    """What random plants did to a certificate. What is not found is no proof."""

    outcome: Literal["held", "broken", "unfinished"]
    """`held`: every bound held in every trial that was finished; `broken`: one did not; `unfinished`: no trial was finished."""
    _counterexample: Optional[str] = field(repr=False)
    _reports: Dict[str, str] = field(repr=False)

    @property
    def trials(self) -> List[Dict[str, Any]]:
        """What became of each trial, as in the JSON of the report."""
        found: List[Dict[str, Any]] = self.data["trials"]
        return found

    @property
    def counterexample(self) -> Optional[str]:
        """The plant of the first trial in which a bound did not hold, as JSON that `simulate` takes as a file."""
        return self._counterexample

    def __repr__(self) -> str:
        return f"<Falsification: {self.outcome} in {len(self.trials)} trials>"
