"""The display of a result in a notebook: a small table and a figure as inline SVG.

Colours are CSS properties with a second set for dark pages; no external file is loaded.
"""

from __future__ import annotations

import html
import math
from collections.abc import Sequence

from hamel._hamel import Result, StudyResult

_STYLE = """<style>
.hamel { --ink: #222; --faint: #888; --grid: #e3e3e3; --c0: #0b62a4; --c1: #c4541a; --c2: #2b7f3b;
  --c3: #7a3e9d; --c4: #9a7500; --c5: #a3123d; color: var(--ink); max-width: 640px;
  font: 13px/1.4 system-ui, sans-serif; }
@media (prefers-color-scheme: dark) { .hamel { --ink: #ddd; --faint: #999; --grid: #444;
  --c0: #6db3ec; --c1: #f0955f; --c2: #76cf88; --c3: #c79be6; --c4: #dcbc4e; --c5: #f0769a; } }
[data-theme="dark"] .hamel, [data-jp-theme-light="false"] .hamel, .vscode-dark .hamel {
  --ink: #ddd; --faint: #999; --grid: #444; --c0: #6db3ec; --c1: #f0955f; --c2: #76cf88;
  --c3: #c79be6; --c4: #dcbc4e; --c5: #f0769a; }
.hamel table { border-collapse: collapse; margin: 0 0 6px; background: none; color: inherit;
  font: inherit; }
.hamel tr { background: none !important; }
.hamel td, .hamel th { padding: 1px 14px 1px 0; text-align: left; vertical-align: top; border: 0; }
.hamel th { color: var(--faint); font-weight: normal; white-space: nowrap; }
.hamel svg { width: 100%; height: auto; display: block; }
.hamel svg text { fill: var(--ink); font: 11px system-ui, sans-serif; }
</style>"""

_MOST_POINTS = 600
_MOST_CURVES = 6


def html_of(result: Result) -> str:
    """A table of a run and its measurements, and a figure of its velocities over time."""
    rows = [
        ("system", result.config.system),
        ("method", _method(result)),
        ("status", _status(result)),
    ]
    measured = (
        ("error", "exact_error_max", "against the exact motion, at most"),
        ("estimated", "estimated_error", "error by two finer runs"),
        ("energy", "energy_error_max", "relative change, at most"),
        ("constraint", "constraint_max", "residual, at most"),
    )
    for title, name, meaning in measured:
        value = getattr(result, name)
        if math.isfinite(value):
            rows.append((title, f"{value:.2e} {meaning}"))
    rows += [("note", note) for note in result.notes]
    figure = velocities_svg(result) if len(result) > 1 else ""
    return f'{_STYLE}<div class="hamel">{_table(rows)}{figure}</div>'


def html_of_study(study: StudyResult) -> str:
    """The first twenty cells: the axes that most studies vary, errors and orders."""
    usual = ("system", "scheme", "step", "error", "order")
    shown_columns = [name for name in usual if name in study.columns]
    shown = min(len(study), 20)
    head = "".join(f"<th>{html.escape(name)}</th>" for name in shown_columns)
    columns = [study[name] for name in shown_columns]
    body = "".join(
        "<tr>"
        + "".join(f"<td>{html.escape(_short(column[i]))}</td>" for column in columns)
        + "</tr>"
        for i in range(shown)
    )
    more = f"<p>{len(study) - shown} more cells</p>" if len(study) > shown else ""
    return f'{_STYLE}<div class="hamel"><table><tr>{head}</tr>{body}</table>{more}</div>'


def _short(value: object) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def _method(result: Result) -> str:
    config = result.config
    steps = f"h = {config.step:g} s" if config.rtol is None else f"rtol = {config.rtol:g}"
    return f"{config.scheme}, {config.retraction}, {steps}"


def _status(result: Result) -> str:
    status = result.status
    if status.ok:
        return f"ok, {result.steps} steps to t = {result.last.time:g} s"
    return f"failed in step {status.step} at t = {status.time:g} s: {status.reason}"


def _table(rows: Sequence[tuple[str, str]]) -> str:
    lines = "".join(
        f"<tr><th>{html.escape(title)}</th><td>{html.escape(text)}</td></tr>"
        for title, text in rows
    )
    return f"<table>{lines}</table>"


def velocities_svg(result: Result) -> str:
    """At most six velocities over time, each with its name and unit."""
    import numpy as np

    width, height, left, right, top, bottom = 640, 220, 52, 112, 10, 30
    t = result.t
    picked = np.unique(np.linspace(0, len(t) - 1, min(len(t), _MOST_POINTS)).astype(int))
    names = result.names[:_MOST_CURVES]
    curves = [result[name][picked] for name in names]
    if not curves:
        return ""
    finite = np.concatenate([curve[np.isfinite(curve)] for curve in curves])
    if finite.size == 0:
        return ""
    low, high = float(finite.min()), float(finite.max())
    if high - low < 1e-12 * max(1.0, abs(high)):
        low, high = low - 0.5, high + 0.5
    times = t[picked]
    start, end = float(times[0]), float(times[-1])

    def x_of(value: float) -> float:
        return left + (width - left - right) * (value - start) / (end - start)

    def y_of(value: float) -> float:
        return height - bottom - (height - top - bottom) * (value - low) / (high - low)

    parts = []
    for tick in _ticks(low, high):
        y = y_of(tick)
        parts.append(
            f'<line x1="{left}" x2="{width - right}" y1="{y:.1f}" y2="{y:.1f}" '
            'stroke="var(--grid)"/>'
            f'<text x="{left - 6}" y="{y + 4:.1f}" text-anchor="end">{tick:g}</text>'
        )
    for tick in _ticks(min(start, end), max(start, end)):
        parts.append(
            f'<text x="{x_of(tick):.1f}" y="{height - bottom + 16}" text-anchor="middle">'
            f"{tick:g}</text>"
        )
    parts.append(f'<text x="{width - right}" y="{height - 2}" text-anchor="end">t [s]</text>')
    units = result.units
    labels = _spaced([y_of(float(curve[-1])) for curve in curves], 13, top + 8, height - bottom)
    for k, (name, curve) in enumerate(zip(names, curves, strict=True)):
        points = " ".join(
            f"{x_of(float(a)):.1f},{y_of(float(b)):.1f}"
            for a, b in zip(times, curve, strict=True)
            if math.isfinite(b)
        )
        unit = f" [{units[name]}]" if units.get(name) else ""
        parts.append(
            f'<polyline points="{points}" fill="none" stroke="var(--c{k})" stroke-width="1.5"/>'
            f'<text x="{width - right + 6}" y="{labels[k] + 4:.1f}" style="fill:var(--c{k})">'
            f"{html.escape(name + unit)}</text>"
        )
    title = html.escape(f"Velocities of {result.config.system} over time")
    return (
        f'<svg viewBox="0 0 {width} {height}" role="img" aria-label="{title}">'
        f"<title>{title}</title>{''.join(parts)}</svg>"
    )


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
