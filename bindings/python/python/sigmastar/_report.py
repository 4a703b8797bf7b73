"""Results that have a report in the formats of the program."""

from __future__ import annotations

import html
import json
from functools import cached_property
from typing import Any, Dict, Literal, cast

Format = Literal["text", "markdown", "html", "json"]
"""A form of a report."""

FORMATS = ("text", "markdown", "html", "json")


class Reported:
    """A result with a report. In a notebook it shows itself as the page of `--format html`."""

    _reports: Dict[str, str]

    def report(self, format: Format = "text") -> str:
        """The report as `text`, `markdown`, `html` or `json`: the bytes of the program with `--format`."""
        if format not in FORMATS:
            raise ValueError(f"there is no format {format!r}: give one of {', '.join(FORMATS)}")
        return self._reports[format]

    @cached_property
    def data(self) -> Dict[str, Any]:
        """The report in JSON as a dictionary: every figure by name (docs/formats.md), numbers as text where they are exact."""
        return cast(Dict[str, Any], json.loads(self._reports["json"]))

    def _repr_html_(self) -> str:
        return framed(self._reports["html"])


def framed(page: str) -> str:
    """A page in a frame of its own, so that its styles and those of a notebook do not meet. No script runs in it."""
    # Links within the page are links within the frame.
    page = page.replace("<head>", '<head><base href="about:srcdoc">', 1)
    style = "width: 100%; height: 40em; border: 0"
    return f'<iframe sandbox="" style="{style}" title="report of sigmastar" srcdoc="{html.escape(page)}"></iframe>'
