"""Charts as inline SVG: curves or points over linear or logarithmic axes, with their style.

Colours are CSS properties with a second set for dark pages; no external file is loaded.
"""

from __future__ import annotations

import html
import math
import os
import pathlib
from collections.abc import Sequence
from dataclasses import dataclass
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
_MOST_POINTS = 600
_MOST_CURVES = 6


def in_frame(content: str) -> str:
    """The content in the style of hamel."""
    return f'{STYLE}<div class="hamel">{content}</div>'


@dataclass(frozen=True)
class Curve:
    """A curve with its name; x and y are arrays of equal shape (points,)."""

    name: str
    x: Any
    y: Any


class Figure:
    """A figure: a notebook shows it, svg is its text, write() saves it."""

    def __init__(self, title: str, svg: str) -> None:
        self.title = title
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


def with_unit(name: str, unit: str) -> str:
    """'v1 [m/s]'; the name alone without a unit."""
    return f"{name} [{unit}]" if unit and unit != "1" else name


def peaks(curve: Curve) -> Curve:
    """The magnitudes; of long curves the largest of each of 300 windows, so that none is lost."""
    import numpy as np

    y = np.abs(curve.y)
    if len(y) <= _MOST_POINTS:
        return Curve(curve.name, curve.x, y)
    windows = np.array_split(np.arange(len(y)), _MOST_POINTS // 2)
    at = np.array([w[np.argmax(np.where(np.isfinite(y[w]), y[w], -1))] for w in windows])
    return Curve(curve.name, curve.x[at], y[at])


class _Axis:
    """A scale from values to pixels; `first` and `last` are the pixels of its ends."""

    def __init__(self, values: Any, first: float, last: float, log: bool) -> None:
        low, high = float(values.min()), float(values.max())
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


def chart(
    title: str,
    x: str,
    y: str,
    curves: Sequence[Curve],
    *,
    log_x: bool = False,
    log_y: bool = False,
    equal: bool = False,
    dots: bool = False,
) -> Figure | None:
    """At most six curves, each with its name at its end; None where they have no point.

    log_x and log_y omit what is not positive, equal gives both axes one scale, dots draws points.
    """
    import numpy as np

    drawn = []
    for curve in curves[:_MOST_CURVES]:
        cx, cy = np.asarray(curve.x, float), np.asarray(curve.y, float)
        seen = np.isfinite(cx) & np.isfinite(cy)
        seen &= ((cx > 0) | (not log_x)) & ((cy > 0) | (not log_y))
        at = np.flatnonzero(seen)
        at = at[np.unique(np.linspace(0, len(at) - 1, min(len(at), _MOST_POINTS)).astype(int))]
        if len(at):
            drawn.append((curve.name, cx[at], cy[at]))
    if not drawn:
        return None
    all_x = np.concatenate([cx for _, cx, _ in drawn])
    all_y = np.concatenate([cy for _, _, cy in drawn])
    across = _Axis(all_x, _LEFT, _WIDTH - _RIGHT, log_x)
    height = float(_HEIGHT)
    if equal:
        scale = (_WIDTH - _LEFT - _RIGHT) / (across.high - across.low)
        height = _TOP + _BOTTOM + min(max(scale * float(np.ptp(all_y)), 80.0), 320.0)
    up = _Axis(all_y, height - _BOTTOM, _TOP, log_y)
    if equal:
        _equalise(across, up)
    parts = [_grid(across, up, height, x, y, title)]
    ends = _spaced([up.at(float(cy[-1])) for _, _, cy in drawn], 13, _TOP + 4, height - _BOTTOM)
    for k, (name, cx, cy) in enumerate(drawn):
        at_points = [(across.at(float(a)), up.at(float(b))) for a, b in zip(cx, cy, strict=True)]
        if dots:
            parts += [
                f'<circle cx="{a:.1f}" cy="{b:.1f}" r="2" fill="var(--c{k})"/>'
                for a, b in at_points
            ]
        else:
            points = " ".join(f"{a:.1f},{b:.1f}" for a, b in at_points)
            parts.append(
                f'<polyline points="{points}" fill="none" stroke="var(--c{k})" '
                'stroke-width="1.5"/>'
            )
        parts.append(
            f'<text x="{_WIDTH - _RIGHT + 6}" y="{ends[k] + 4:.1f}" style="fill:var(--c{k})">'
            f"{html.escape(name)}</text>"
        )
    if len(curves) > _MOST_CURVES:
        more = f"{len(curves) - _MOST_CURVES} more"
        parts.append(f'<text x="{_WIDTH - _RIGHT + 6}" y="{height - 6:.1f}">{more}</text>')
    label = html.escape(title)
    return Figure(
        title,
        f'<svg viewBox="0 0 {_WIDTH} {height:.0f}" role="img" aria-label="{label}">'
        f"<title>{label}</title>{''.join(parts)}</svg>",
    )


def _equalise(across: _Axis, up: _Axis) -> None:
    """Widens the axis with the smaller range for its pixels, about its middle."""
    ratio = abs(across.last - across.first) / abs(up.last - up.first)
    wide, high = across.high - across.low, up.high - up.low
    axis, size = (across, high * ratio) if wide < high * ratio else (up, wide / ratio)
    middle = (axis.low + axis.high) / 2
    axis.low, axis.high = middle - size / 2, middle + size / 2


def _grid(across: _Axis, up: _Axis, height: float, x: str, y: str, title: str) -> str:
    end = _WIDTH - _RIGHT
    parts = [f'<text x="{_LEFT}" y="13" style="font-weight:600">{html.escape(title)}</text>']
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
    parts.append(
        f'<text x="{end}" y="{height - 5:.1f}" text-anchor="end">{html.escape(x)}</text>'
        f'<text x="{end}" y="13" text-anchor="end">{html.escape(y)}</text>'
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
