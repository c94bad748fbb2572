"""The display of results in a notebook: a table, and the figures of the report page as inline SVG.

The figures have the names of `hamel report --figure`. Its motion is result.animation().
"""

from __future__ import annotations

import html
import math
import re
from collections.abc import Sequence
from typing import Any

from hamel._chart import Curve, Figure, chart, in_frame, peaks, with_unit
from hamel._hamel import EnsembleResult, Result, StudyResult, SteadySweep

_Figures = dict[str, Figure]
_TIME = "t [s]"
# name, title, and the columns with the names of their curves.
_ERRORS = (
    (
        "error",
        "Error against the exact motion",
        {"exact_error": "configuration", "exact_velocity_error": "velocity"},
    ),
    ("energy-error", "Energy error", {"energy_error": "|E - E0| / E0"}),
    ("constraint", "Constraint residual", {"constraint": "|A xi / h|"}),
    ("holonomic", "Holonomic residual", {"holonomic": "|phi(g)|"}),
    ("group-defect", "Group defect", {"group_defect": "defect"}),
)
_VELOCITIES = {"rad/s": ("angular-velocity", "Angular velocity"), "m/s": ("velocity", "Velocity")}
_MOMENTA = {
    "N m s": ("angular-momentum-in-the-body", "Angular momentum in the body"),
    "N s": ("momentum-in-the-body", "Momentum in the body"),
}


def figures_of(result: Result) -> _Figures:
    """The figures of a run by their names; fewer than two rows have none."""
    out: _Figures = {}
    if len(result) < 2:
        return out
    columns, units = result.columns, result.units
    reactions = [name for name in columns if re.search(r"^lambda\d+$|\.reaction\d*$", name)]
    momenta = [name for name in columns if re.fullmatch(r"mu\d+", name)]
    _add_by_unit(out, result, result.names, _VELOCITIES, ("body-velocity-xi", "Body velocity"))
    _add_path(out, result, columns)
    curves = [
        Curve(with_unit(name, units.get(name, "")), result.t, result[name]) for name in reactions
    ]
    _add(out, "reactions", chart("Reaction forces", _TIME, "", curves))
    _add_by_unit(out, result, momenta, _MOMENTA, ("momentum", "Momentum"))
    for name, title, curve_names in _ERRORS:
        curves = [
            peaks(Curve(curve_name, result.t, result[column]))
            for column, curve_name in curve_names.items()
            if column in columns
        ]
        if name == "energy-error" and "work" in columns:
            title = "Defect of the energy balance"
            curves = [Curve("|E - E0 - W| / max E", curve.x, curve.y) for curve in curves]
        _add(out, name, chart(title, _TIME, "", curves, log_y=True))
    return out


def figures_of_study(study: StudyResult) -> _Figures:
    """The error over the step or the tolerance, where that is varied: a curve for the rest."""
    import numpy as np

    columns = {name: list(study[name]) for name in study.columns}
    axes = study.columns[: study.columns.index("status")]
    varied = [name for name in axes if len({str(v) for v in columns[name]}) > 1]
    along = next((name for name in ("step", "rtol") if name in varied), None)
    if along is None or not np.isfinite(np.asarray(study["error"], float)).any():
        return {}
    names: list[str] = []  # axes that tell cells apart; schemes also differ in options of their own
    for name in varied:
        if name != along and _parts(columns, [*names, name]) > _parts(columns, names):
            names.append(name)
    groups: dict[str, list[int]] = {}
    for i in range(len(study)):
        rest = ", ".join(_short(columns[name][i]) for name in names)
        groups.setdefault(rest or str(columns["system"][i]), []).append(i)
    curves = []
    for name, at in groups.items():
        at = sorted(at, key=lambda i: float(columns[along][i]))
        x, y = ([columns[axis][i] for i in at] for axis in (along, "error"))
        curves.append(Curve(name, x, y))
    out: _Figures = {}
    label = with_unit(along, study.units.get(along, ""))
    _add(out, "error", chart(f"Error over {along}", label, "error", curves, log_x=True, log_y=True))
    return out


def figures_of_sweep(sweep: SteadySweep) -> _Figures:
    """The real and the imaginary parts of the eigenvalues along the parameter."""
    found = [(v, m) for v, m in zip(sweep.values, sweep.motions, strict=True) if m.found]
    points = [(v, e) for v, motion in found for e in motion.eigenvalues]
    at = [v for v, _ in points]
    out: _Figures = {}
    for name, title, of in (
        ("growth", "Growth rates of the steady motions", [e.real for _, e in points]),
        ("frequency", "Frequencies of the steady motions", [abs(e.imag) for _, e in points]),
    ):
        _add(out, name, chart(title, "parameter", "[1/s]", [Curve("", at, of)], dots=True))
    return out


def figures_of_ensemble(ensemble: EnsembleResult) -> _Figures:
    """Each kept number: over the varied one, or how many members have it where more are varied."""
    import numpy as np

    kept = list(ensemble.record["kept"])
    varied = ensemble.columns[: ensemble.columns.index(kept[0])] if kept else []
    numeric = [name for name in varied if isinstance(ensemble[name], np.ndarray)]
    out: _Figures = {}
    for name in kept:
        values, label = ensemble[name], with_unit(name, ensemble.units.get(name, ""))
        if not isinstance(values, np.ndarray):
            continue
        if len(varied) == 1 and numeric:
            x = with_unit(numeric[0], ensemble.units.get(numeric[0], ""))
            curve = Curve("", ensemble[numeric[0]], values)
            _add(out, name, chart(f"{name} over {numeric[0]}", x, label, [curve], dots=True))
            continue
        finite = values[np.isfinite(values)]
        if finite.size < 2 or not finite.min() < finite.max():
            continue
        counts, edges = np.histogram(finite, min(50, math.ceil(math.sqrt(finite.size))))
        stairs = Curve("", np.repeat(edges, 2), np.concatenate([[0], np.repeat(counts, 2), [0]]))
        _add(out, name, chart(f"Members by {name}", label, "members", [stairs]))
    return out


def _add(out: _Figures, name: str, figure: Figure | None) -> None:
    if figure is not None:
        out[name] = figure


def _add_by_unit(
    out: _Figures,
    result: Result,
    names: Sequence[str],
    known: dict[str, tuple[str, str]],
    other: tuple[str, str],
) -> None:
    by_unit: dict[str, list[Curve]] = {}
    for name in names:
        curve = Curve(name, result.t, result[name])
        by_unit.setdefault(result.units.get(name, ""), []).append(curve)
    for unit, curves in by_unit.items():
        figure, title = known.get(unit, other)
        label = f"[{unit}]" if unit and unit != "1" else ""
        _add(out, figure, chart(title, _TIME, label, curves))


def _add_path(out: _Figures, result: Result, columns: Sequence[str]) -> None:
    def first(name: str) -> str | None:
        return next((c for c in columns if c == name or re.fullmatch(rf"\d+_{name}", c)), None)

    x, y = first("x"), first("y")
    if x is None or y is None:
        return
    path = Curve("", result[x], result[y])
    if float(path.x.max() - path.x.min()) + float(path.y.max() - path.y.min()) > 0:
        _add(out, "path", chart("Path in the plane", f"{x} [m]", f"{y} [m]", [path], equal=True))


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
    return in_frame(table + more + _all(figures_of_study(study)))


def html_of_sweep(sweep: SteadySweep) -> str:
    """The crossings of a branch, and its eigenvalues."""
    values = sweep.values
    rows = []
    if len(values):
        rows.append(("values", f"{len(values)} from {values[0]:g} to {values[-1]:g}"))
    rows += [(crossing.kind, f"at {crossing.value:.6g}") for crossing in sweep.crossings]
    return in_frame(_table(rows) + _all(figures_of_sweep(sweep)))


def html_of_ensemble(ensemble: EnsembleResult) -> str:
    """How many members, their kept numbers, and a figure of each."""
    record = ensemble.record
    rows = [("members", f"{record['members']}, of which {record['failed']} failed")]
    for name, kept in record["kept"].items():
        numbers = (f"{key} {_short(kept[key])}" for key in ("mean", "deviation", "least", "most"))
        rows.append((with_unit(name, ensemble.units.get(name, "")), ", ".join(numbers)))
    return in_frame(_table(rows) + _all(figures_of_ensemble(ensemble)))


def _parts(columns: dict[str, list[Any]], names: Sequence[str]) -> int:
    """Into how many parts the axes of these names divide the cells."""
    cells = range(len(columns["system"]))
    return len({tuple(str(columns[name][i]) for name in names) for i in cells})


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
