"""Exact numbers: those that are given, and those that come back."""

from __future__ import annotations

import math
from dataclasses import fields
from decimal import ROUND_CEILING, ROUND_FLOOR, ROUND_HALF_EVEN, Context, Decimal
from fractions import Fraction
from numbers import Integral
from typing import ClassVar, Dict, Literal, Tuple, Union

from ._errors import no_number
from ._formula import formula, is_sympy, powers

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


Side = Literal["nearest", "up", "down"]
"""Where a number is rounded to."""

_ROUNDING = {"nearest": ROUND_HALF_EVEN, "up": ROUND_CEILING, "down": ROUND_FLOOR}


def stated(text: str, side: Side = "nearest") -> Exact:
    """A number that a report states, with the double on this side of it."""
    if text == "inf":
        return Exact(math.inf, text)
    exact = Fraction(text)
    double = float(exact)
    if side == "up" and Fraction(double) < exact:
        double = math.nextafter(double, math.inf)
    elif side == "down" and Fraction(double) > exact:
        double = math.nextafter(double, -math.inf)
    return Exact(double, text)


def digits(value: Union[float, str], side: Side = "nearest") -> str:
    """Four digits of a number, as people are shown it."""
    if value in (math.inf, -math.inf) or value != value:
        return str(value)
    exact = Fraction(value.exact if isinstance(value, Exact) else str(value))
    context = Context(prec=4, rounding=_ROUNDING[side])
    return format(context.divide(Decimal(exact.numerator), Decimal(exact.denominator)), "g")


class Shown:
    """A dataclass that shows of its doubles four digits, each rounded to the side on which what is said of it stays true; of exact numbers
    all."""

    _sides: ClassVar[Dict[str, Side]] = {}

    def __repr__(self) -> str:
        shown = (f"{one.name}={self._told(one.name)}" for one in fields(self) if one.repr)  # type: ignore[arg-type]
        return f"{type(self).__name__}({', '.join(shown)})"

    def _told(self, name: str) -> str:
        value, side = getattr(self, name), self._sides.get(name)
        if side is not None and isinstance(value, float):
            return digits(value, side)
        return value.exact if isinstance(value, Exact) else repr(value)


def text(value: Number) -> str:
    """A number as an exact constant.

    Raises TypeError for what is no such number, InputError for one that is not finite.
    """
    if isinstance(value, str):
        return powers(value)
    if isinstance(value, bool):
        raise TypeError("a Boolean is no number here")
    if is_sympy(value) and not isinstance(value, Integral):
        return formula(value)
    if isinstance(value, Exact):
        return value.exact
    if isinstance(value, Integral):
        return str(int(value))
    if isinstance(value, Fraction):
        return f"{value.numerator}/{value.denominator}" if value.denominator != 1 else str(value.numerator)
    if isinstance(value, float):
        if value != value or value in (float("inf"), float("-inf")):
            raise no_number(float.__repr__(value))
        return float.__repr__(value)
    if isinstance(value, Decimal):
        if not value.is_finite():
            raise no_number(value)
        return str(value)
    raise TypeError(f"a {type(value).__name__} is no exact number: give a text, an int, a float, a Fraction or a Decimal")
