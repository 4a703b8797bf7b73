"""Results that have a report in the formats of the program."""

from __future__ import annotations

import html
from typing import Dict

FORMATS = ("text", "markdown", "html", "json")


class Reported:
    """A result with a report. In a notebook it shows itself as the page of `--format html`."""

    _reports: Dict[str, str]

    def report(self, format: str = "text") -> str:
        """The report as `text`, `markdown`, `html` or `json`: the bytes of the program with `--format`."""
        if format not in FORMATS:
            raise ValueError(f"there is no format {format!r}: give one of {', '.join(FORMATS)}")
        return self._reports[format]

    def _repr_html_(self) -> str:
        return framed(self._reports["html"])


def framed(page: str) -> str:
    """A page in a frame of its own, so that its styles and those of a notebook do not meet. No script runs in it."""
    # Links within the page are links within the frame.
    page = page.replace("<head>", '<head><base href="about:srcdoc">', 1)
    style = "width: 100%; height: 40em; border: 0"
    return f'<iframe sandbox="" style="{style}" title="report of sigmastar" srcdoc="{html.escape(page)}"></iframe>'
