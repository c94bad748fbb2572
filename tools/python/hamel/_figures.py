"""The display of results in a notebook: a table, and the figures of the report page as inline SVG.

The figures have the names of `hamel report --figure`. Its motion is result.animation().
"""

from __future__ import annotations

import html
import json
import math
from collections.abc import Sequence
from typing import Any

from hamel._chart import Figure, in_frame, plot
from hamel._hamel import EnsembleResult, Result, SteadySweep, StudyResult
from hamel._heat_map import heat_map

_Figures = dict[str, Figure]
_KINDS = {"plot": plot, "path": plot, "heatmap": heat_map}


def figures_of(result: Result | StudyResult | EnsembleResult | SteadySweep) -> _Figures:
    """The figures of the page by their names, but those in space and in pairs."""
    if isinstance(result, Result) and len(result) < 2:
        return {}
    blocks = json.loads(result._figures())
    drawn = {name: _KINDS[b["kind"]](b) for name, b in blocks.items() if b["kind"] in _KINDS}
    return {name: figure for name, figure in drawn.items() if figure is not None}


def html_of(result: Result) -> str:
    """A table of a run and its measurements, its velocities, and the other figures folded."""
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
    figures = figures_of(result)
    velocities = ("angular-velocity", "velocity", "body-velocity-xi")
    shown = [name for name in figures if name in velocities]
    folded = "".join(figure.svg for name, figure in figures.items() if name not in shown)
    more = f"<details><summary>more figures</summary>{folded}</details>" if folded else ""
    return in_frame(_table(rows) + "".join(figures[name].svg for name in shown) + more)


def html_of_study(study: StudyResult) -> str:
    """The first twenty cells: the axes that most studies vary, errors and orders; the error."""
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
    table = f"<table><tr>{head}</tr>{body}</table>"
    return in_frame(table + more + _all(figures_of(study)))


def html_of_sweep(sweep: SteadySweep) -> str:
    """The crossings of a branch, and its eigenvalues."""
    values = sweep.values
    rows = []
    if len(values):
        rows.append(("values", f"{len(values)} from {values[0]:g} to {values[-1]:g}"))
    rows += [(crossing.kind, f"at {crossing.value:.6g}") for crossing in sweep.crossings]
    return in_frame(_table(rows) + _all(figures_of(sweep)))


def html_of_ensemble(ensemble: EnsembleResult) -> str:
    """How many members, their kept numbers, and a figure of each."""
    record = ensemble.record
    rows = [("members", f"{record['members']}, of which {record['failed']} failed")]
    for name, kept in record["kept"].items():
        numbers = (f"{key} {_short(kept[key])}" for key in ("mean", "deviation", "least", "most"))
        unit = ensemble.units.get(name, "1")
        rows.append((name if unit in ("", "1") else f"{name} [{unit}]", ", ".join(numbers)))
    return in_frame(_table(rows) + _all(figures_of(ensemble)))


def _all(figures: _Figures) -> str:
    return "".join(figure.svg for figure in figures.values())


def _short(value: Any) -> str:
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
