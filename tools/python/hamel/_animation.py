"""The motion of a result in a notebook: the bodies of its drawing, to be played and turned.

The page (animation.html) stands in a frame of its own, so that a notebook may show several, and
loads nothing.
"""

from __future__ import annotations

import html
import json
import os
import pathlib

from hamel._hamel import Result


class Animation:
    """A motion; a notebook shows it, write() saves it as a page."""

    def __init__(self, result: Result, height: int = 320) -> None:
        if len(result) < 2:
            raise ValueError("animation: the result has fewer than two rows")
        blocks = json.loads(result._figures()).values()
        motion = next((block for block in blocks if block["kind"] == "animation"), None)
        if motion is None:
            raise ValueError(f"animation: {result.config.system} has no drawing")
        motion["title"] = f"Motion of {result.config.system}"
        self.height = height
        self.poses = len(motion["times"])
        self._data = json.dumps(motion, separators=(",", ":")).replace("</", "<\\/")

    def page(self) -> str:
        """The page, HTML with all that it needs."""
        text = pathlib.Path(__file__).with_name("animation.html").read_text(encoding="utf-8")
        return text.replace("__MOTION__", self._data)

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes the page to a file."""
        pathlib.Path(path).write_text(self.page(), encoding="utf-8")

    def _repr_html_(self) -> str:
        return (
            f'<iframe srcdoc="{html.escape(self.page())}" title="motion" '
            f'style="width: 100%; max-width: 640px; height: {self.height}px; border: 0"></iframe>'
        )

    def __repr__(self) -> str:
        return f"<hamel animation of {self.poses} poses>"
