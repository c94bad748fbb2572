"""Heat maps of the report page as inline SVG."""

from __future__ import annotations

import html
import math
from typing import Any

from hamel._chart import BOTTOM, LEFT, RIGHT, TOP, WIDTH, Axis, Figure, figure_of, titles


def heat_map(block: dict[str, Any]) -> Figure | None:
    """Cells, darker for larger values, or a colour for each class; rows as on the page."""
    rows, texts = block["values"], [str(y) for y in block["y_values"]]
    values = [v for row in rows for v in row if v is not None and (v > 0 or not block["log"])]
    if not values:
        return None
    rising = all(isinstance(y, int | float) for y in block["y_values"])
    rising = rising and block["y_values"] == sorted(block["y_values"])
    shade = Axis(values, 0.12, 0.95, bool(block["log"]))
    wide = (WIDTH - LEFT - RIGHT) / len(rows[0])
    tall = min(22.0, 260 / len(rows))
    height = TOP + BOTTOM + tall * len(rows)
    parts = titles(height, block)
    every_x, every_y = (max(1, math.ceil(n)) for n in (len(rows[0]) / 8, 14 / tall))
    for i, row in enumerate(rows):
        top = TOP + tall * (len(rows) - 1 - i if rising else i)
        if i % every_y == 0:
            parts.append(
                f'<text x="{LEFT - 6}" y="{top + tall / 2 + 4:.1f}" text-anchor="end">'
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
                f'<rect x="{LEFT + wide * j:.1f}" y="{top:.1f}" width="{wide:.1f}" '
                f'height="{tall:.1f}" fill="{fill}" fill-opacity="{opacity:.2f}" '
                f'stroke="var(--grid)"><title>{html.escape(words)}</title></rect>'
            )
    for j in range(0, len(rows[0]), every_x):
        parts.append(
            f'<text x="{LEFT + wide * (j + 0.5):.1f}" y="{height - BOTTOM + 15:.1f}" '
            f'text-anchor="middle">{html.escape(_short(str(block["x_values"][j])))}</text>'
        )
    return figure_of(block, height, parts)


def _short(text: str) -> str:
    """A number with four digits, a longer word with its beginning."""
    try:
        return f"{float(text):.4g}"
    except ValueError:
        return text if len(text) <= 9 else text[:8] + "…"
