"""The motion of a result: in a notebook, to be played and turned, and as a film or a picture.

The page (animation.html) stands in a frame of its own, so that a notebook may show several, and
loads nothing. Films and pictures are those of `hamel report --motion`, which draws them.
"""

from __future__ import annotations

import html
import json
import os
import pathlib
import shutil
import subprocess
import tempfile

from hamel._hamel import ConfigError, Result


class Animation:
    """A motion; a notebook shows it, write() saves it as a page, a film or a picture."""

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
        self._result = result

    def page(self) -> str:
        """The page, HTML with all that it needs."""
        text = pathlib.Path(__file__).with_name("animation.html").read_text(encoding="utf-8")
        return text.replace("__MOTION__", self._data)

    def write(
        self,
        path: str | os.PathLike[str],
        *,
        at: float | None = None,
        strobe: int | None = None,
        size: tuple[int, int] | None = None,
        speed: float | None = None,
        transparent: bool = False,
    ) -> None:
        """Writes the motion by the extension of the path.

        .html is the page, which needs nothing. .webm and .gif are films (speed: so many times
        faster), .png, .svg and .pdf pictures at a time `at`, with the bodies at `strobe` times up
        to it; both are drawn by the program `hamel` (on the PATH, or HAMEL_PROGRAM), with chromium
        and, for films, ffmpeg. size: pixels. ConfigError names what is missing.
        """
        path = pathlib.Path(path)
        options: list[str] = []
        for name, value in {"at": at, "strobe": strobe, "speed": speed}.items():
            if value is not None:
                options += [f"--{name}", repr(value)]
        if size is not None:
            options += ["--size", "x".join(str(pixels) for pixels in size)]
        if transparent:
            options.append("--transparent")
        if path.suffix == ".html" and not options:
            path.write_text(self.page(), encoding="utf-8")
        else:
            self._draw(path, options)

    def _draw(self, path: pathlib.Path, options: list[str]) -> None:
        program = shutil.which(os.environ.get("HAMEL_PROGRAM", "hamel"))
        if program is None:
            raise ConfigError(
                f"animation: '{path}' is drawn by the program hamel, which is not on the PATH: "
                "apt install ./hamel_*.deb, or set HAMEL_PROGRAM to build/tools/hamel; "
                "write('motion.html') needs none"
            )
        with tempfile.TemporaryDirectory() as folder:
            run = pathlib.Path(folder) / "run.h5"
            self._result.write(run)
            command = [program, "report", str(run), "--motion", "-o", str(path), *options]
            done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            message = done.stderr.strip().removeprefix("hamel: ")
            raise (ConfigError if done.returncode == 2 else RuntimeError)(message)

    def _repr_html_(self) -> str:
        return (
            f'<iframe srcdoc="{html.escape(self.page())}" title="motion" '
            f'style="width: 100%; max-width: 640px; height: {self.height}px; border: 0"></iframe>'
        )

    def __repr__(self) -> str:
        return f"<hamel animation of {self.poses} poses>"
