"""Tables and pictures, with packages that have to be installed for them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, List, Optional

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from pandas import DataFrame


def dataframe(columns: Dict[str, List[Any]]) -> DataFrame:
    """A table of pandas."""
    try:
        import pandas
    except ImportError as error:
        raise ImportError("to_dataframe needs pandas: pip install pandas") from error
    return pandas.DataFrame(columns)


def axes(ax: Optional[Axes], x: str, y: str) -> Axes:
    """The axes that are given, or new ones of matplotlib, with labels."""
    if ax is None:
        try:
            from matplotlib import pyplot
        except ImportError as error:
            raise ImportError("plot needs matplotlib: pip install matplotlib") from error
        ax = pyplot.figure().add_subplot()
    ax.set_xlabel(x)
    ax.set_ylabel(y)
    return ax
