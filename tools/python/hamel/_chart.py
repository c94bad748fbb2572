"""Figures of the report page as inline SVG: plots and paths, with their style.

A figure is the block of the page's data (tools/report/README.md), which C++ makes. Colours are CSS
properties with a second set for dark pages; no external file is loaded.
"""

from __future__ import annotations

import html
import math
import os
import pathlib
from collections.abc import Iterator, Sequence
from typing import Any

from hamel._hamel import ConfigError

_LIGHT = (
    "--ink: #222; --faint: #888; --grid: #e3e3e3; --c0: #0b62a4; --c1: #c4541a; --c2: #2b7f3b; "
    "--c3: #7a3e9d; --c4: #9a7500; --c5: #a3123d;"
)
_DARK = (
    "--ink: #ddd; --faint: #999; --grid: #444; --c0: #6db3ec; --c1: #f0955f; --c2: #76cf88; "
    "--c3: #c79be6; --c4: #dcbc4e; --c5: #f0769a;"
)
STYLE = f"""<style>
.hamel {{ {_LIGHT} color: var(--ink); max-width: 640px; font: 13px/1.4 system-ui, sans-serif; }}
@media (prefers-color-scheme: dark) {{ .hamel {{ {_DARK} }} }}
[data-theme="dark"] .hamel, [data-jp-theme-light="false"] .hamel, .vscode-dark .hamel {{ {_DARK} }}
.hamel table {{ border-collapse: collapse; margin: 0 0 6px; background: none; color: inherit;
  font: inherit; }}
.hamel tr {{ background: none !important; }}
.hamel td, .hamel th {{ padding: 1px 14px 1px 0; text-align: left; vertical-align: top;
  border: 0; }}
.hamel th {{ color: var(--faint); font-weight: normal; white-space: nowrap; }}
.hamel summary {{ color: var(--faint); cursor: pointer; }}
.hamel svg {{ width: 100%; height: auto; display: block; }}
.hamel svg text {{ fill: var(--ink); font: 11px system-ui, sans-serif; }}
</style>"""

WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 640, 220, 58, 130, 24, 34
_MOST_CURVES = 6
_Point = tuple[float, float]


def in_frame(content: str) -> str:
    """The content in the style of hamel."""
    return f'{STYLE}<div class="hamel">{content}</div>'


class Figure:
    """A figure: a notebook shows it, svg is its text, data its curves, write() saves it."""

    def __init__(self, data: dict[str, Any], svg: str) -> None:
        self.title: str = data["title"]
        self.data = data
        self.svg = svg

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes the figure as an SVG file, x.svg, in the light colours."""
        if pathlib.Path(path).suffix.lower() != ".svg":
            text = (
                f"write: got {os.fspath(path)!r}, expected a name that ends with .svg; the program "
                "draws .pdf and .png: hamel report FILE.h5 --figure NAME -o FILE.pdf"
            )
            mistake = ConfigError(text)
            mistake.mistakes = [text]
            raise mistake
        style = f".hamel {{ {_LIGHT} }} text {{ fill: var(--ink); font: 11px sans-serif; }}"
        head, tail = self.svg.split(">", 1)
        text = f'{head} class="hamel" xmlns="http://www.w3.org/2000/svg"><style>{style}</style>'
        pathlib.Path(path).write_text(text + tail, encoding="utf-8")

    def _repr_html_(self) -> str:
        return in_frame(self.svg)

    def __repr__(self) -> str:
        return f"<hamel figure: {self.title}>"


class Axis:
    """A scale from values to pixels; `first` and `last` are the pixels of its ends."""

    def __init__(self, values: Sequence[float], first: float, last: float, log: bool) -> None:
        low, high = min(values), max(values)
        if log:
            low, high = math.log10(low), math.log10(high)
        if high - low < 1e-12 * max(1.0, abs(high)):
            low, high = low - 0.5, high + 0.5
        self.low, self.high, self.first, self.last, self.log = low, high, first, last, log

    def at(self, value: float) -> float:
        place = math.log10(value) if self.log else value
        return self.first + (self.last - self.first) * (place - self.low) / (self.high - self.low)

    def ticks(self) -> list[float]:
        if not self.log:
            return _ticks(self.low, self.high)
        least, most = math.ceil(self.low - 1e-9), math.floor(self.high + 1e-9)
        decades = [10.0**k for k in range(least, most + 1, max(1, (most - least) // 4))]
        if len(decades) > 1:
            return decades
        near = [m * 10.0**k for k in range(least - 1, most + 1) for m in (1, 2, 3, 5, 7)]
        inner = [v for v in near if self.low - 1e-9 <= math.log10(v) <= self.high + 1e-9]
        return inner if len(inner) > 1 else [10**self.low, 10**self.high]


class _Drawn:
    """A curve of a block as it is drawn: without gaps and what an axis cannot show."""

    def __init__(self, series: dict[str, Any], log_x: bool, log_y: bool) -> None:
        self.name: str = series["name"]
        self.dots = bool(series.get("dots"))
        self.dashed = bool(series["dashed"])
        self.fit: str = series.get("fit", {}).get("text", "")
        low = series.get("low") or [None] * len(series["x"])
        self.points: list[_Point] = []
        self.below: list[_Point] = []
        for x, y, under in zip(series["x"], series["y"], low, strict=True):
            if x is None or y is None or (log_x and x <= 0) or (log_y and y <= 0):
                continue
            self.points.append((x, y))
            if under is not None and not (log_y and under <= 0):
                self.below.append((x, under))

    def svg(self, across: Axis, up: Axis, colour: str) -> str:
        places = [f"{across.at(x):.1f},{up.at(y):.1f}" for x, y in self.points]
        title = f"<title>{html.escape(f'{self.name} {self.fit}')}</title>"
        if self.dots:
            return "".join(
                '<circle cx="{}" cy="{}" r="2" fill="{}"/>'.format(*place.split(","), colour)
                for place in places
            )
        places = [a for a, before in zip(places, ["", *places], strict=False) if a != before]
        out = ""
        if self.below:
            back = [f"{across.at(x):.1f},{up.at(y):.1f}" for x, y in reversed(self.below)]
            out = (
                f'<polygon points="{" ".join(places + back)}" fill="{colour}" '
                'fill-opacity="0.35"/>'
            )
        dashes = ' stroke-dasharray="5 4"' if self.dashed else ""
        return out + (
            f'<polyline points="{" ".join(places)}" fill="none" stroke="{colour}" '
            f'stroke-width="1.5"{dashes}>{title}</polyline>'
        )


def plot(block: dict[str, Any]) -> Figure | None:
    """A plot or a path; None where fewer than two points are.

    At most six curves, each with its name at its end, of the first value of each filter.
    """
    log_x, log_y = bool(block.get("log_x")), bool(block.get("log_y"))
    first = {f["name"]: f["values"][0] for f in block.get("filters", []) if f["values"]}
    curves = []
    for series in block["series"]:
        tags = series.get("tags", {})
        if all(tags.get(name, value) == value for name, value in first.items()):
            curves.append(_Drawn(series, log_x, log_y))
    curves = [curve for curve in curves if curve.points]
    drawn = curves[:_MOST_CURVES]
    points = [point for curve in drawn for point in curve.points + curve.below]
    if len(set(points)) < 2:
        return None
    across = Axis([x for x, _ in points], LEFT, WIDTH - RIGHT, log_x)
    height = float(HEIGHT)
    heights = [y for _, y in points]
    if block["kind"] == "path":
        scale = (WIDTH - LEFT - RIGHT) / (across.high - across.low)
        height = TOP + BOTTOM + min(max(scale * (max(heights) - min(heights)), 80.0), 320.0)
    up = Axis(heights, height - BOTTOM, TOP, log_y)
    if block["kind"] == "path":
        _equalise(across, up)
    shown = {**block, "title": ": ".join([block["title"], *first.values()])}
    parts = [_grid(across, up, height, shown), *_markings(block, across, up)]
    alone = len(curves) == 1 and curves[0].name in ("", block["title"])
    ends = _spaced([up.at(c.points[-1][1]) for c in drawn], 13, TOP + 4, height - BOTTOM)
    for k, curve in enumerate(drawn):
        parts.append(curve.svg(across, up, f"var(--c{k})"))
        if not alone:
            parts.append(
                f'<text x="{WIDTH - RIGHT + 6}" y="{ends[k] + 4:.1f}" '
                f'style="fill:var(--c{k})">{html.escape(curve.name)}</text>'
            )
    if len(curves) > _MOST_CURVES:
        more = f"{len(curves) - _MOST_CURVES} more"
        parts.append(f'<text x="{WIDTH - RIGHT + 6}" y="{height - 6:.1f}">{more}</text>')
    return figure_of(block, height, parts)


def figure_of(block: dict[str, Any], height: float, parts: Sequence[str]) -> Figure:
    label = html.escape(block["title"])
    return Figure(
        block,
        f'<svg viewBox="0 0 {WIDTH} {height:.0f}" role="img" aria-label="{label}">'
        f"<title>{label}</title>{''.join(parts)}</svg>",
    )


def _markings(block: dict[str, Any], across: Axis, up: Axis) -> Iterator[str]:
    """Shaded intervals, moments on the x axis, the floor of round-off; where they are in sight."""
    for band in block.get("bands", []):
        a, b = across.at(band["from"]), across.at(band["to"])
        yield (
            f'<rect x="{min(a, b):.1f}" y="{up.last}" width="{abs(b - a):.1f}" '
            f'height="{up.first - up.last:.1f}" fill="var(--grid)" opacity="0.6">'
            f"<title>{html.escape(band['text'])}</title></rect>"
        )
    for mark in block.get("marks", []):
        at = across.at(mark["x"])
        if across.first <= at <= across.last:
            yield (
                f'<line x1="{at:.1f}" x2="{at:.1f}" y1="{up.first}" y2="{up.last}" '
                f'stroke="var(--faint)" stroke-dasharray="5 4"><title>'
                f"{html.escape(mark['text'])}</title></line>"
            )
    if up.log and block.get("floor", 0) > 0 and up.last <= up.at(block["floor"]) <= up.first:
        at = up.at(block["floor"])
        yield (
            f'<line x1="{across.first}" x2="{across.last}" y1="{at:.1f}" y2="{at:.1f}" '
            'stroke="var(--faint)" stroke-dasharray="5 4"><title>round-off</title></line>'
        )


def _equalise(across: Axis, up: Axis) -> None:
    """Widens the axis with the smaller range for its pixels, about its middle."""
    ratio = abs(across.last - across.first) / abs(up.last - up.first)
    wide, high = across.high - across.low, up.high - up.low
    axis, size = (across, high * ratio) if wide < high * ratio else (up, wide / ratio)
    middle = (axis.low + axis.high) / 2
    axis.low, axis.high = middle - size / 2, middle + size / 2


def titles(height: float, block: dict[str, Any]) -> list[str]:
    """The title, and the names of the axes at their ends."""
    end = WIDTH - RIGHT
    title, x, y = (html.escape(block[name]) for name in ("title", "x", "y"))
    return [
        f'<text x="{LEFT}" y="13" style="font-weight:600">{title}</text>',
        f'<text x="{end}" y="{height - 5:.1f}" text-anchor="end">{x}</text>',
        f'<text x="{end}" y="13" text-anchor="end">{y}</text>',
    ]


def _grid(across: Axis, up: Axis, height: float, block: dict[str, Any]) -> str:
    end = WIDTH - RIGHT
    parts = titles(height, block)
    for tick in up.ticks():
        at = up.at(tick)
        parts.append(
            f'<line x1="{LEFT}" x2="{end}" y1="{at:.1f}" y2="{at:.1f}" stroke="var(--grid)"/>'
            f'<text x="{LEFT - 6}" y="{at + 4:.1f}" text-anchor="end">{tick:.4g}</text>'
        )
    for tick in across.ticks():
        parts.append(
            f'<text x="{across.at(tick):.1f}" y="{height - BOTTOM + 15:.1f}" '
            f'text-anchor="middle">{tick:.4g}</text>'
        )
    return "".join(parts)


def _ticks(low: float, high: float) -> list[float]:
    raw = (high - low) / 4
    power = 10.0 ** math.floor(math.log10(raw))
    step = next(m * power for m in (1, 2, 5, 10) if m * power >= raw * 0.999)
    first = math.ceil(low / step - 1e-9)
    return [round(k * step, 12) for k in range(first, math.floor(high / step + 1e-9) + 1)]


def _spaced(wanted: Sequence[float], least: float, top: float, bottom: float) -> list[float]:
    """The heights of labels: close to `wanted`, and at least `least` apart."""
    order = sorted(range(len(wanted)), key=lambda k: wanted[k])
    placed = [0.0] * len(wanted)
    at = top - least
    for k in order:
        at = placed[k] = max(wanted[k], at + least)
    overflow = at - bottom
    if overflow > 0:
        limit = bottom
        for k in reversed(order):
            limit = placed[k] = min(placed[k], limit)
            limit -= least
    return placed
