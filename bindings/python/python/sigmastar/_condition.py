"""The conditions that prove a claim."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Dict, List, Optional, Tuple


@dataclass(frozen=True)
class Condition:
    """A comparison of two real numbers, each known between two doubles."""

    id: str
    """Its name: `S1`, `C4`, ..."""
    text: str
    """What it says, in a few words."""
    lhs: Tuple[float, float]
    """The left side lies between these, rounded outward; NaN where it is not known to be defined."""
    relation: str
    """`<` or `<=`."""
    rhs: Tuple[float, float]
    """The right side lies between these."""
    holds: Optional[bool]
    """Whether it holds, decided at a higher precision than these doubles; None where that is not known."""


def conditions(told: List[Dict[str, Any]]) -> List[Condition]:
    """The conditions of a list from the library."""
    return [Condition(**one) for one in told]
