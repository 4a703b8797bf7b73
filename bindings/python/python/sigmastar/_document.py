"""Documents: from files, and from dictionaries."""

from __future__ import annotations

import json
import os
from decimal import Decimal
from fractions import Fraction
from numbers import Integral
from typing import Any, Mapping, Tuple, Union

from . import _native
from ._exact import text
from ._formula import formula, is_sympy, with_powers

Document = Union[Mapping[str, Any], str, "os.PathLike[str]"]
"""A document: the path of its file (JSON, `.jsonc` or `.toml`), or its content as a dictionary, with formulas as texts or expressions of
SymPy."""

File = Tuple[str, bytes]


def file(document: Document, name: str) -> File:
    """What errors call a document, and its bytes; `name` is for a dictionary.

    Raises OSError for a file that cannot be read, TypeError and ValueError for what JSON cannot hold exactly.
    """
    if isinstance(document, Mapping):
        held = plain(document)
        # A certificate is what it is, to the letter.
        return (name, written(held if name == "certificate" else with_powers(held)).encode("utf-8"))
    if isinstance(document, (str, os.PathLike)):
        return read(os.fspath(document))
    raise TypeError(f"a {type(document).__name__} is no document: give a path or a dictionary")


def read(path: str) -> File:
    """A file, of which no more is read than a document may have and one byte."""
    with open(path, "rb") as stream:
        return (os.fsdecode(path), stream.read(_native.MAX_BYTES + 1))


def is_certificate(content: bytes) -> bool:
    """Whether these bytes are JSON that says of itself that it is a certificate."""
    try:
        held = json.loads(content)
    except (ValueError, RecursionError):
        return False
    return isinstance(held, dict) and held.get("format") == "sigmastar/certificate"


def written(held: Any) -> str:
    """What `plain` made, as JSON. Raises ValueError for a float that is not finite."""
    return json.dumps(held, allow_nan=False, ensure_ascii=False, indent=2)


def plain(value: Any) -> Any:
    """The same value of types that JSON has: floats are written as Python does it, a Fraction, a Decimal or an expression of SymPy
    becomes an exact constant or formula. Raises TypeError for what JSON cannot hold exactly."""
    if isinstance(value, Mapping):
        for key in value:
            if not isinstance(key, str):
                raise TypeError(f"{key!r} is no name of a field: names are texts")
        return {key: plain(one) for key, one in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(one) for one in value]
    if value is None or isinstance(value, (str, bool)):
        return value
    if isinstance(value, (Fraction, Decimal)):
        return text(value)
    if is_sympy(value) and not isinstance(value, Integral):
        return formula(value)
    if isinstance(value, Integral):
        return int(value)
    if isinstance(value, float):
        exact = getattr(value, "exact", None)
        return exact if isinstance(exact, str) else float(value)
    if hasattr(value, "tolist") and hasattr(value, "dtype"):
        # An array of doubles or integers is exact; one of another precision would change its numbers.
        if value.dtype.kind in "iu" or value.dtype == "float64":
            return plain(value.tolist())
        raise TypeError(f"numbers of the type {value.dtype} are not taken: convert them to float or Fraction yourself")
    raise TypeError(f"a {type(value).__name__} is nothing that a document has: give texts, numbers, lists and dictionaries")
