"""Why there is no result."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Dict, List, Literal, Optional, Tuple

from ._condition import Condition, conditions
from ._report import Format


@dataclass(frozen=True)
class Diagnostic:
    """One thing that is wrong, or that could not be decided, with its place."""

    code: str
    """The word of its kind, as in the JSON of the program."""
    file: str
    """The document or argument, as it is called."""
    pointer: str
    """Its place as a JSON pointer; empty for a document as a whole and for arguments."""
    line: Optional[int]
    """The line, from 1 on; None where there is no document."""
    column: Optional[int]
    """The column in characters, from 1 on."""
    message: str
    """What is wrong, in a sentence."""
    expected: Optional[str]
    """What was expected."""
    help: Optional[str]
    """What to do about it."""


class SigmastarError(Exception):
    """Why there is no result. Nothing is claimed.

    Its text gives every error that was found: its place, what is wrong, what was expected and what to do.
    """

    def __init__(self, told: Dict[str, Any]) -> None:
        super().__init__(told["text"])
        self._told = told
        self.kind: str = told["kind"]
        """What kind of error it is: `document`, `format`, `field`, `expression`, `range`, `options`, `results`, `claim`,
        `refuted`, `undecided`, `not-certified`, `overflow` or `not-available`. Others may follow."""
        self.verdict: Literal["bad-input", "undecided", "refuted"] = told["verdict"]
        """The verdict of the program: `bad-input`, `undecided` or `refuted`."""
        self.diagnostics: List[Diagnostic] = [Diagnostic(**one) for one in told["diagnostics"]]
        """Everything that was found, in order, with its place."""
        self.conditions: List[Condition] = conditions(told["conditions"])
        """The conditions of the attempt that came nearest, where one was evaluated."""

    def report(self, format: Format = "text") -> Optional[str]:
        """The report of a run that certified nothing: what failed and what to try. None where no run was made."""
        reports: Optional[Dict[str, str]] = self._told["reports"]
        return None if reports is None else reports[format]

    def __reduce__(self) -> Tuple[Any, ...]:
        return (type(self), (self._told,))


class InputError(SigmastarError, ValueError):
    """A document, an option or a call is wrong."""


def no_number(value: object) -> InputError:
    """That a value which is not finite is no number."""
    message = f"{value} is no number here"
    help = "give a finite number: a text, an int, a float, a Fraction or a Decimal"
    told = Diagnostic("call", "", "", None, None, message, None, help)
    return InputError(
        {
            "text": f"{message}\n  help: {help}",
            "kind": "range",
            "verdict": "bad-input",
            "diagnostics": [vars(told)],
            "conditions": [],
            "reports": None,
        }
    )


class UndecidedError(SigmastarError):
    """Nothing was found to be wrong, and the claim could not be proved: nothing is claimed either way."""


class RefutedError(SigmastarError):
    """What was asked for is proved not to hold."""


def found(told: Dict[str, Any]) -> Any:
    """What was found, or the exception that says why nothing was."""
    error = told["error"]
    if error is None:
        return told["found"]
    kinds = {"undecided": UndecidedError, "refuted": RefutedError}
    raise kinds.get(error["verdict"], InputError)(error)
