"""Formulas: SymPy's, and Python's spelling of powers, in the notation of documents."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, Tuple

if TYPE_CHECKING:
    import sympy
    from typing_extensions import TypeGuard

_FUNCTIONS = {
    "sin": "sin", "cos": "cos", "tan": "tan", "atan": "atan", "tanh": "tanh", "exp": "exp", "log": "log", "Abs": "abs", "Min": "min",
    "Max": "max", "sinc": "sinc",
}
"""Of SymPy, and of documents. SymPy's sinc is sin(x)/x as well; x/(exp(x) - 1) has no name there, and is written as text."""

_SUM, _PRODUCT, _POWER, _ATOM = range(4)
"""How tightly an expression binds."""


def is_sympy(value: object) -> TypeGuard[sympy.Basic]:
    """Whether a value is of SymPy, which need not be installed."""
    return any(str(one.__module__).partition(".")[0] == "sympy" for one in type(value).__mro__)


def formula(value: sympy.Basic) -> str:
    """An expression of SymPy, exactly: a Float is the decimal that Python writes for it, as a float is.

    Raises TypeError for what documents have no notation for.
    """
    return _written(value)[0]


def powers(text: str) -> str:
    """A formula in which powers may be `**`, which binds as `^` does."""
    return text.replace("**", "^")


def _refused(value: Any, why: str) -> TypeError:
    return TypeError(f"`{value}` of SymPy has no notation in a document: {why}")


def _written(value: Any) -> Tuple[str, int]:
    """The text, and how tightly it binds."""
    import sympy

    if not isinstance(value, sympy.Expr):
        raise _refused(value, "give expressions, in lists")
    if value.is_Symbol:
        return (_name(value), _ATOM)
    if value.is_Integer:
        return (str(int(value)), _ATOM if value >= 0 else _SUM)
    if isinstance(value, sympy.Rational):
        return (f"{int(value.p)}/{int(value.q)}", _PRODUCT if value.p >= 0 else _SUM)
    if value.is_Float:
        return _float(value)
    if value is sympy.pi:
        return ("pi", _ATOM)
    if value is sympy.E:
        return ("exp(1)", _ATOM)
    if value.is_Add:
        return (_sum(value), _SUM)
    if value.is_Pow and not _divides(value):
        base, exponent = value.args
        if exponent == sympy.Rational(1, 2):
            return (f"sqrt({_within(base, _SUM)})", _ATOM)
        return (f"{_within(base, _ATOM)}^{_within(exponent, _ATOM)}", _POWER)
    if value.is_Mul or value.is_Pow:
        return _product(value)
    name = _FUNCTIONS.get(type(value).__name__)
    # One of SymPy, and not a symbol's that has its name.
    if name is not None and value.func is getattr(sympy, type(value).__name__):
        return (f"{name}({', '.join(_within(argument, _SUM) for argument in value.args)})", _ATOM)
    raise _refused(value, f"there are {', '.join(_FUNCTIONS.values())}, sqrt, powers, names, pi and real numbers")


def _within(value: Any, least: int) -> str:
    text, binds = _written(value)
    return text if binds >= least else f"({text})"


def _sum(value: Any) -> str:
    text = ""
    for term in value.as_ordered_terms():
        one = _within(term, _PRODUCT) if term.is_Add else _written(term)[0]
        text += one if not text else f" - {one[1:]}" if one.startswith("-") else f" + {one}"
    return text


def _product(value: Any) -> Tuple[str, int]:
    """The factors, divided by those with a negative power."""
    coefficient, rest = value.as_coeff_Mul()
    above, below = [], []
    for factor in (abs(coefficient), *rest.as_ordered_factors()):
        if factor.is_Rational:
            above += [str(int(factor.p))] if factor.p != 1 else []
            below += [str(int(factor.q))] if factor.q != 1 else []
        elif _divides(factor):
            below.append(_within(factor.args[0] ** -factor.args[1], _POWER))
        else:
            above.append(_within(factor, _POWER))
    text = "/".join(["*".join(above) or "1", *below])
    return (f"-{text}", _SUM) if coefficient < 0 else (text, _PRODUCT)


def _divides(value: Any) -> bool:
    """Whether it is a power with a negative number as exponent."""
    return bool(value.is_Pow and value.args[1].is_Rational and value.args[1].is_negative)


def _name(symbol: Any) -> str:
    name = str(symbol.name)
    if not name.isidentifier() or not name.isascii():
        raise _refused(symbol, "a name has letters, digits and `_`")
    return name


def _float(value: Any) -> Tuple[str, int]:
    double = float(value)
    if value._prec > 53 or double != value or double != double or abs(double) == float("inf"):
        raise _refused(value, "it is no double; give a Rational")
    return (repr(double), _ATOM if double >= 0 else _SUM)


_WORDS = ("name", "description", "$schema", "format")
"""The fields of documents that are no formulas."""


def with_powers(document: Dict[str, Any]) -> Dict[str, Any]:
    """A document with `^` for every `**` of its formulas; names and descriptions stay."""
    return {key: value if key in _WORDS else _of(value) for key, value in document.items()}


def _of(value: Any) -> Any:
    if isinstance(value, str):
        return powers(value)
    if isinstance(value, list):
        return [_of(one) for one in value]
    if isinstance(value, dict):
        return with_powers(value)
    return value
