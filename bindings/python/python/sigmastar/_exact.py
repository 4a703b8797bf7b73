"""Exact numbers: those that are given, and those that come back."""

from __future__ import annotations

from decimal import Decimal
from fractions import Fraction
from numbers import Integral
from typing import Tuple, Union

Number = Union[str, int, float, Fraction, Decimal]
"""An exact constant: a text in the notation of specifications (`"1/3"`, `"2*pi"`), or a number. A float is the decimal that
Python writes for it: 0.1 is exactly 1/10."""


class Exact(float):
    """A double that stands for an exact number. It is rounded to the side that is stated where it comes from.

    `str` is the exact number, arithmetic is that of the double.
    """

    exact: str
    """The number exactly: a decimal or a fraction."""

    def __new__(cls, value: float, exact: str) -> Exact:
        self = super().__new__(cls, value)
        self.exact = exact
        return self

    @property
    def fraction(self) -> Fraction:
        """The number exactly."""
        return Fraction(self.exact)

    def __str__(self) -> str:
        return self.exact

    def __getnewargs__(self) -> Tuple[float, str]:  # type: ignore[override]
        return (float(self), self.exact)


def text(value: Number) -> str:
    """A number as an exact constant.

    Raises TypeError for what is no such number, ValueError for one that is not finite.
    """
    if isinstance(value, str):
        return value
    if isinstance(value, bool):
        raise TypeError("a Boolean is no number here")
    if isinstance(value, Exact):
        return value.exact
    if isinstance(value, Integral):
        return str(int(value))
    if isinstance(value, Fraction):
        return f"{value.numerator}/{value.denominator}" if value.denominator != 1 else str(value.numerator)
    if isinstance(value, float):
        if value != value or value in (float("inf"), float("-inf")):
            raise ValueError(f"{float.__repr__(value)} is no number here")
        return float.__repr__(value)
    if isinstance(value, Decimal):
        if not value.is_finite():
            raise ValueError(f"{value} is no number here")
        return str(value)
    raise TypeError(f"a {type(value).__name__} is no exact number: give a text, an int, a float, a Fraction or a Decimal")
