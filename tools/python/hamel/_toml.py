"""The text of a TOML file from a dict: what a study or an ensemble in a program is read from."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from hamel._hamel import ConfigError


def dumps(table: Mapping[str, Any]) -> str:
    """Keys in their order, one a line; ConfigError names the key of a value that TOML has not."""
    return "".join(f"{_text(str(key))} = {_value(value, str(key))}\n" for key, value in table.items())


def _text(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + "".join(c if c >= " " and c != "\x7f" else f"\\u{ord(c):04x}" for c in escaped) + '"'


def _value(value: Any, key: str) -> str:
    if hasattr(value, "tolist"):  # NumPy
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return repr(value) if math.isfinite(value) else str(value)
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, Mapping):
        entries = (f"{_text(str(name))} = {_value(entry, f'{key}.{name}')}" for name, entry in value.items())
        return "{ " + ", ".join(entries) + " }"
    if isinstance(value, (list, tuple, range)):
        return "[" + ", ".join(_value(entry, key) for entry in value) + "]"
    raise ConfigError(
        f"{key}: got a {type(value).__name__}, expected a number, a text, a list or a dict"
    )
