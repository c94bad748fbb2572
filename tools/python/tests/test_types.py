"""The stubs are those of the module, and the examples have the types that they state."""

import os
import pathlib
import subprocess
import sys

import hamel
from conftest import ROOT

PACKAGE = ROOT / "tools/python"


def check(module: str, *arguments: str, config: str, folder: pathlib.Path) -> None:
    place = str(pathlib.Path(hamel.__file__).parents[1])
    done = subprocess.run(
        [sys.executable, "-m", module, config, str(PACKAGE / "pyproject.toml"), *arguments],
        capture_output=True,
        text=True,
        check=False,
        cwd=folder,
        env={**os.environ, "MYPYPATH": place, "PYTHONPATH": place},
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_stubs(tmp_path):
    allowed = str(PACKAGE / "stubtest.allow")
    check(
        "mypy.stubtest",
        "hamel",
        "--allowlist",
        allowed,
        config="--mypy-config-file",
        folder=tmp_path,
    )


def test_examples(tmp_path):
    examples = sorted((PACKAGE / "examples").glob("*.py"))
    check("mypy", *map(str, examples), config="--config-file", folder=tmp_path)
