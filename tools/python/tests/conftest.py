"""The program that the package is compared with: HAMEL_PROGRAM in the environment."""

import json
import os
import pathlib
import subprocess
import sys
from collections.abc import Callable
from typing import Any

import pytest

import hamel

ROOT = pathlib.Path(__file__).resolve().parents[3]
SUSLOV = {"inertia": [2, 3, 4], "momentum": [1, 1, 0], "scheme": "lift", "step": 0.01}


def environment() -> dict[str, str]:
    """The environment in which Python imports the package under test."""
    place = str(pathlib.Path(hamel.__file__).parents[1])
    return {**os.environ, "PYTHONPATH": place}


def run_python(code: str, **options) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        env=environment(),
        check=False,
        timeout=120,
        **options,
    )


@pytest.fixture(scope="session")
def program() -> str:
    path = os.environ.get("HAMEL_PROGRAM", str(ROOT / "build/tools/hamel"))
    if not pathlib.Path(path).exists():
        pytest.skip(f"no program at {path}")
    return path


@pytest.fixture
def cli(program: str, tmp_path: pathlib.Path) -> Callable[..., subprocess.CompletedProcess[str]]:
    def call(*arguments: object, status: int = 0) -> subprocess.CompletedProcess[str]:
        done = subprocess.run(
            [program, *map(str, arguments)],
            capture_output=True,
            text=True,
            cwd=tmp_path,
            check=False,
        )
        assert done.returncode == status, done.stderr
        return done

    return call


@pytest.fixture
def cli_json(cli: Callable[..., subprocess.CompletedProcess[str]]) -> Callable[..., Any]:
    return lambda *arguments: json.loads(cli(*arguments, "--json").stdout)
