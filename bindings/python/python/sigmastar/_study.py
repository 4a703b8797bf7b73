"""Parameter studies, case by case, wherever the cases run."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TYPE_CHECKING, Any, Dict, Iterable, List, Optional, Union

from . import _native
from ._document import Document, File, file, read
from ._errors import found
from ._results import write
from ._table import axes, dataframe

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from pandas import DataFrame


@dataclass(frozen=True)
class Case:
    """One case of a study: what `certify` is asked about."""

    index: int
    """Its number, from 0 on."""
    values: Dict[str, str]
    """The values of the parameters by their names, exactly."""
    json: str = field(repr=False)
    """The specification or plant with the values in it."""
    sha256: str
    """SHA-256 of the document."""


@dataclass(frozen=True)
class Study:
    """A study with its subject, as it was read. It can be sent to other processes, which need no files then."""

    name: str
    """Its name."""
    cases: int
    """How many cases there are."""
    _file: File = field(repr=False)
    _subject: Optional[bytes] = field(repr=False)

    def __len__(self) -> int:
        return self.cases

    def to_dataframe(self, lines: Iterable[str]) -> DataFrame:
        """Lines of `run_case` as a table of pandas, which has to be installed: the values of the parameters, the verdict, and sigma_star
        with the nearest double, not a number where nothing is certified."""
        return dataframe(self._columns(lines))

    def plot(self, lines: Iterable[str], parameter: Optional[str] = None, ax: Optional[Axes] = None) -> Axes:
        """The gain of the lines of `run_case` against a parameter, the first one by default, with matplotlib, which has to be
        installed."""
        columns = self._columns(lines)
        names = self._parameters()
        name = names[0] if parameter is None else parameter
        if name not in names:
            raise ValueError(f"the study has no parameter {name!r}")
        ax = axes(ax, name, "sigma_star")
        ax.plot(columns[name], columns["sigma_star"], "o")
        return ax

    def _parameters(self) -> List[str]:
        return [name for name, _ in found(_native.study_case((self._file, self._subject), 0))["values"]]

    def _columns(self, lines: Iterable[str]) -> Dict[str, List[Any]]:
        rows = sorted((json.loads(line) for line in lines), key=lambda row: row["index"])
        columns: Dict[str, List[Any]] = {"index": [row["index"] for row in rows]}
        for at, name in enumerate(self._parameters()):
            columns[name] = [_number(row["values"][at]) for row in rows]
        columns["verdict"] = [row["verdict"] for row in rows]
        columns["sigma_star"] = [float(Fraction(row["sigma_star"])) if "sigma_star" in row else float("nan") for row in rows]
        return columns


def _number(value: str) -> Union[float, str]:
    """A value of a parameter as a double, or its text where it is no rational number."""
    try:
        return float(Fraction(value))
    except ValueError:
        return value


StudyLike = Union[Study, Document]
"""A study, the path of its file, or its content as a dictionary."""


def load_study(study: StudyLike) -> Study:
    """Reads a study and its subject: the path of its file, or its content as a dictionary. The path of a subject is relative to
    the file, or to the current folder.

    Raises InputError for what is wrong with either, and OSError for a file that cannot be read.
    """
    if isinstance(study, Study):
        return study
    document = file(study, "study")
    path = _native.study_subject(document)
    subject = None
    if path is not None:
        folder = os.path.dirname(os.fspath(study)) if isinstance(study, (str, os.PathLike)) else ""
        subject = read(os.path.join(folder, path))[1]
    name, cases = found(_native.study_count((document, subject)))
    return Study(name, cases, document, subject)


def study_cases(study: StudyLike) -> List[Case]:
    """The cases of a study."""
    loaded = load_study(study)
    files = (loaded._file, loaded._subject)
    told = [found(_native.study_case(files, index)) for index in range(loaded.cases)]
    return [Case(one["index"], dict(one["values"]), one["json"], one["sha256"]) for one in told]


def run_case(study: StudyLike, index: int) -> str:
    """Certifies one case and returns it as a line of JSON, without a line feed, from which `results` makes the table.

    A case that is refused or not certified is no exception: its line says why. The same case has the same line in every process.
    """
    loaded = load_study(study)
    if not 0 <= index < loaded.cases:
        raise IndexError(f"there is no case {index}: the study has {loaded.cases}")
    line: str = found(_native.run_case((loaded._file, loaded._subject), index))
    return line


def results(study: StudyLike, lines: Iterable[str]) -> str:
    """The table of results (CSV) from the lines of all cases, in any order: the bytes of `sigmastar sweep STUDY -o FILE`.

    Raises InputError for a line that is not of this study or not as it was written, for two that contradict each other, and for
    a case without a line.
    """
    loaded = load_study(study)
    text: str = found(_native.study_results((loaded._file, loaded._subject), list(lines)))
    return text


def write_results(study: StudyLike, lines: Iterable[str], path: Union[str, "os.PathLike[str]"]) -> None:
    """Writes the table of `results`; it appears whole or not at all."""
    write(path, results(study, lines))
