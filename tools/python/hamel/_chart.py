"""Figures of the report page as inline SVG: plots, paths and heat maps, with their style.

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

_WIDTH, _HEIGHT, _LEFT, _RIGHT, _TOP, _BOTTOM = 640, 220, 58, 130, 24, 34
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


class _Axis:
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

    def svg(self, across: _Axis, up: _Axis, colour: str) -> str:
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


def draw(block: dict[str, Any]) -> Figure | None:
    """A plot, a path or a heat map; None of other kinds, and where fewer than two points are."""
    if block["kind"] == "heatmap":
        return _heat_map(block)
    return _plot(block) if block["kind"] in ("plot", "path") else None


def _plot(block: dict[str, Any]) -> Figure | None:
    """At most six curves, each with its name at its end, of the first value of each filter."""
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
    across = _Axis([x for x, _ in points], _LEFT, _WIDTH - _RIGHT, log_x)
    height = float(_HEIGHT)
    heights = [y for _, y in points]
    if block["kind"] == "path":
        scale = (_WIDTH - _LEFT - _RIGHT) / (across.high - across.low)
        height = _TOP + _BOTTOM + min(max(scale * (max(heights) - min(heights)), 80.0), 320.0)
    up = _Axis(heights, height - _BOTTOM, _TOP, log_y)
    if block["kind"] == "path":
        _equalise(across, up)
    shown = {**block, "title": ": ".join([block["title"], *first.values()])}
    parts = [_grid(across, up, height, shown), *_markings(block, across, up)]
    alone = len(curves) == 1 and curves[0].name in ("", block["title"])
    ends = _spaced([up.at(c.points[-1][1]) for c in drawn], 13, _TOP + 4, height - _BOTTOM)
    for k, curve in enumerate(drawn):
        parts.append(curve.svg(across, up, f"var(--c{k})"))
        if not alone:
            parts.append(
                f'<text x="{_WIDTH - _RIGHT + 6}" y="{ends[k] + 4:.1f}" '
                f'style="fill:var(--c{k})">{html.escape(curve.name)}</text>'
            )
    if len(curves) > _MOST_CURVES:
        more = f"{len(curves) - _MOST_CURVES} more"
        parts.append(f'<text x="{_WIDTH - _RIGHT + 6}" y="{height - 6:.1f}">{more}</text>')
    return _figure(block, height, parts)


def _figure(block: dict[str, Any], height: float, parts: Sequence[str]) -> Figure:
    label = html.escape(block["title"])
    return Figure(
        block,
        f'<svg viewBox="0 0 {_WIDTH} {height:.0f}" role="img" aria-label="{label}">'
        f"<title>{label}</title>{''.join(parts)}</svg>",
    )


def _markings(block: dict[str, Any], across: _Axis, up: _Axis) -> Iterator[str]:
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


def _heat_map(block: dict[str, Any]) -> Figure | None:
    """Cells, darker for larger values, or a colour for each class; rows as on the page."""
    rows, texts = block["values"], [str(y) for y in block["y_values"]]
    values = [v for row in rows for v in row if v is not None and (v > 0 or not block["log"])]
    if not values:
        return None
    rising = all(isinstance(y, int | float) for y in block["y_values"])
    rising = rising and block["y_values"] == sorted(block["y_values"])
    shade = _Axis(values, 0.12, 0.95, bool(block["log"]))
    wide = (_WIDTH - _LEFT - _RIGHT) / len(rows[0])
    tall = min(22.0, 260 / len(rows))
    height = _TOP + _BOTTOM + tall * len(rows)
    parts = _titles(height, block)
    every_x, every_y = (max(1, math.ceil(n)) for n in (len(rows[0]) / 8, 14 / tall))
    for i, row in enumerate(rows):
        top = _TOP + tall * (len(rows) - 1 - i if rising else i)
        if i % every_y == 0:
            parts.append(
                f'<text x="{_LEFT - 6}" y="{top + tall / 2 + 4:.1f}" text-anchor="end">'
                f"{html.escape(_short(texts[i]))}</text>"
            )
        for j, value in enumerate(row):
            mark = block["marks"][i][j] if block.get("marks") else ""
            shown = value is not None and (value > 0 or not block["log"])
            if block.get("classes"):
                fill = f"var(--c{int(value) % 6})" if shown else "none"
                words, opacity = block["classes"][int(value)] if shown else mark, 1.0
            else:
                fill = "var(--c0)" if shown else "none"
                words, opacity = f"{value:.3g}" if shown else mark, shade.at(value) if shown else 1
            parts.append(
                f'<rect x="{_LEFT + wide * j:.1f}" y="{top:.1f}" width="{wide:.1f}" '
                f'height="{tall:.1f}" fill="{fill}" fill-opacity="{opacity:.2f}" '
                f'stroke="var(--grid)"><title>{html.escape(words)}</title></rect>'
            )
    for j in range(0, len(rows[0]), every_x):
        parts.append(
            f'<text x="{_LEFT + wide * (j + 0.5):.1f}" y="{height - _BOTTOM + 15:.1f}" '
            f'text-anchor="middle">{html.escape(_short(str(block["x_values"][j])))}</text>'
        )
    return _figure(block, height, parts)


def _short(text: str) -> str:
    """A number with four digits, a longer word with its beginning."""
    try:
        return f"{float(text):.4g}"
    except ValueError:
        return text if len(text) <= 9 else text[:8] + "…"


def _equalise(across: _Axis, up: _Axis) -> None:
    """Widens the axis with the smaller range for its pixels, about its middle."""
    ratio = abs(across.last - across.first) / abs(up.last - up.first)
    wide, high = across.high - across.low, up.high - up.low
    axis, size = (across, high * ratio) if wide < high * ratio else (up, wide / ratio)
    middle = (axis.low + axis.high) / 2
    axis.low, axis.high = middle - size / 2, middle + size / 2


def _titles(height: float, block: dict[str, Any]) -> list[str]:
    """The title, and the names of the axes at their ends."""
    end = _WIDTH - _RIGHT
    title, x, y = (html.escape(block[name]) for name in ("title", "x", "y"))
    return [
        f'<text x="{_LEFT}" y="13" style="font-weight:600">{title}</text>',
        f'<text x="{end}" y="{height - 5:.1f}" text-anchor="end">{x}</text>',
        f'<text x="{end}" y="13" text-anchor="end">{y}</text>',
    ]


def _grid(across: _Axis, up: _Axis, height: float, block: dict[str, Any]) -> str:
    end = _WIDTH - _RIGHT
    parts = _titles(height, block)
    for tick in up.ticks():
        at = up.at(tick)
        parts.append(
            f'<line x1="{_LEFT}" x2="{end}" y1="{at:.1f}" y2="{at:.1f}" stroke="var(--grid)"/>'
            f'<text x="{_LEFT - 6}" y="{at + 4:.1f}" text-anchor="end">{tick:.4g}</text>'
        )
    for tick in across.ticks():
        parts.append(
            f'<text x="{across.at(tick):.1f}" y="{height - _BOTTOM + 15:.1f}" '
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
