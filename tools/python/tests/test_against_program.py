"""Runs, steady motions, studies and errors are those of the command line, bit for bit."""

import csv
import math

import numpy as np
import pytest

import hamel
from conftest import ROOT

EXAMPLES = ROOT / "tests/examples"

# For each case: the system and its options in Python and on the command line.
RUNS = {
    "left-invariant": (
        "suslov",
        {"inertia": [1, 10, 100], "momentum": [1, 1, 0], "scheme": "lift", "step": 0.01},
        "--set inertia=1,10,100 --momentum 1,1,0 --scheme lift --step 0.01",
    ),
    "steps chosen by the error": ("rattleback", {"rtol": 1e-9}, "--rtol 1e-9"),
    "nothing given": ("rolling_disk", {}, ""),
    "composed": (
        "rolling_disk",
        {"compose": "suzuki4", "velocity": (0.7, 1, 0, 2), "step": 0.02},
        "--compose suzuki4 --velocity 0.7,1,0,2 --step 0.02",
    ),
    "checked": ("chaplygin_sleigh", {"step": 0.05, "check": True}, "--step 0.05 --check"),
    "events": (
        "chaplygin_sleigh",
        {"events": ["cusp", "x=0.5"], "output_step": 0.1, "offset": np.float64(0.3)},
        "--events cusp,x=0.5 --output-step 0.1 --set offset=0.3",
    ),
    "inputs": (
        "segway",
        {"inputs": {"right_torque": 2, "left_torque": ([0, 1, 3], [0, 1, 0.5])}, "step": 0.002},
        "--input right_torque=2 --input left_torque=table.csv --step 0.002",
    ),
    "mechanism": ("bicycle", {"speed": 5, "rider_mass": 80}, "--speed 5 --set rider_mass=80"),
    "general, implicit": (
        "falling_disk",
        {"scheme": "balance", "step": 0.005, "retraction": "exp"},
        "--scheme balance --step 0.005 --retraction exp",
    ),
    "formulas": (str(EXAMPLES / "skate_in_a_bowl.toml"), {"step": 0.01}, "--step 0.01"),
}


def untimed(record: dict) -> dict:
    return {key: value for key, value in record.items() if key not in ("timing", "git", "host")}


@pytest.mark.parametrize("name", RUNS)
def test_rows_and_record(name, cli, cli_json, tmp_path):
    system, options, line = RUNS[name]
    (tmp_path / "table.csv").write_text("t,value\n0,0\n1,1\n3,0.5\n")
    arguments = ["run", system, *line.split(), "--until", "2"]
    cli(*arguments, "-o", "run.csv", "--quiet")
    with open(tmp_path / "run.csv", newline="") as file:
        lines = [line for line in file if not line.startswith("#")]
    header, *rows = csv.reader(lines)
    written = np.array([[float(x) if x else math.nan for x in row] for row in rows])

    result = hamel.run(system, until=2, **options)
    assert result.columns == header
    np.testing.assert_array_equal(result.values, written)

    # Rows of the record are counted in the run that writes no files.
    ours, theirs = untimed(result.record), untimed(cli_json(*arguments))
    if "inputs" in options:
        ours.pop("inputs"), theirs.pop("inputs")  # a table by numbers, and by its file
    assert ours == theirs


def test_screen(cli):
    ours = hamel.run("suslov", until=1).report().splitlines()
    theirs = cli("run", "suslov", "--until", "1").stdout.splitlines()
    timed = len([line for line in ours if line.split()[:1] == ["time"]])
    assert timed == 1
    same = [line for line in ours if line.split()[:1] != ["time"]]
    assert same == [line for line in theirs if line.split()[:1] != ["time"]]


def test_files(cli, tmp_path):
    cli("run", "suslov", "--until", 1, "-o", "theirs.csv")
    hamel.run("suslov", until=1).write(tmp_path / "ours.csv")

    def rows(name):
        return [x for x in (tmp_path / name).read_text().splitlines() if x[:1] != "#"]

    assert rows("ours.csv") == rows("theirs.csv")


def test_steady_motion(cli_json):
    theirs = cli_json("steady", "bicycle", "--speed", 5)
    ours = hamel.steady("bicycle", speed=5)
    assert ours and ours.stable and ours.growing == 0
    np.testing.assert_array_equal(ours.velocity, theirs["motion"]["velocity"])
    np.testing.assert_array_equal(ours.round_off, theirs["eigenvalue_errors"])
    rounded = np.array([complex(*pair) for pair in theirs["eigenvalues"]])  # to the known digits
    assert np.all(np.abs(ours.eigenvalues - rounded) <= 10 * ours.round_off + 1e-15)
    linear = hamel.linearisation("bicycle", speed=5)
    for name in "ABC":
        written = theirs["linearisation"]
        np.testing.assert_array_equal(getattr(linear, name), written[name])
        np.testing.assert_array_equal(getattr(linear, name + "_error"), written["errors"][name])
    assert linear.states == theirs["linearisation"]["states"]


def test_steady_branch(cli_json):
    theirs = cli_json("steady", "bicycle", "--vary", "speed=3:7:9")
    for vary in ("speed=3:7:9", ("speed", 3, 7, 9), ("speed", np.linspace(3, 7, 9))):
        ours = hamel.steady("bicycle", vary=vary)
        for motion, written in zip(ours.motions, theirs["vary"], strict=True):
            np.testing.assert_array_equal(motion.velocity, written["motion"]["velocity"])
        kinds = [crossing.kind for crossing in ours.crossings]
        assert kinds == [crossing["bifurcation"] for crossing in theirs["crossings"]]


STUDY = """
title = "two schemes"
until = 2
repeats = 1
scheme = ["lift", "balance"]
step = [0.1, 0.05, 0.025]
[[system]]
name = "suslov"
[[system]]
name = "chaplygin_sleigh"
"""


def test_study(cli, tmp_path):
    (tmp_path / "study.toml").write_text(STUDY)
    cli("study", "study.toml", "-o", "theirs", "--quiet")
    ours = hamel.study(
        system=["suslov", {"system": "chaplygin_sleigh"}],
        scheme=["lift", "balance"],
        step=[0.1, 0.05, 0.025],
        until=2,
        repeats=1,
        title="two schemes",
        threads=2,
    )
    assert ours and len(ours) == 12
    with open(tmp_path / "theirs/cells.csv", newline="") as file:
        theirs = list(csv.DictReader(line for line in file if not line.startswith("#")))
    mine = list(csv.DictReader(line for line in ours.csv().splitlines() if line[:1] != "#"))
    for a, b in zip(mine, theirs, strict=True):
        for timed in ("ns_per_step", "seconds"):
            a.pop(timed), b.pop(timed)
        assert a == b
    from_file = hamel.study(tmp_path / "study.toml", folder=tmp_path / "ours")
    np.testing.assert_array_equal(from_file["error"], ours["error"])
    assert (tmp_path / "ours").is_dir()
    again = hamel.study(STUDY, folder=tmp_path / "ours")
    assert again.resumed == 12
    from_file.write(tmp_path / "written")
    assert (tmp_path / "written/cells.csv").exists()


MISTAKES = {
    "names": (
        lambda: hamel.run("suslof", scheme="lfit", s=1.5, step=0),
        "run suslof --scheme lfit --s 1.5 --step 0",
    ),
    "shape": (lambda: hamel.run("suslov", inertia=[1, 2]), "run suslov --set inertia=1,2"),
    "parameter": (lambda: hamel.run("suslov", inertai=1), "run suslov --set inertai=1"),
    "input": (
        lambda: hamel.run("segway", inputs={"right_torqe": 1}),
        "run segway --input right_torqe=1",
    ),
    "start": (lambda: hamel.run("suslov", velocity=[1]), "run suslov --velocity 1"),
    "event": (lambda: hamel.run("suslov", events="fallen"), "run suslov --events fallen"),
    "description": (lambda: hamel.describe("suslof.toml"), "describe suslof.toml"),
    "file": (lambda: hamel.run("no_such_file.toml"), "run no_such_file.toml"),
}


@pytest.mark.parametrize("name", MISTAKES)
def test_errors_have_the_same_text(name, cli):
    call, line = MISTAKES[name]
    with pytest.raises(hamel.ConfigError) as raised:
        call()
    assert isinstance(raised.value, ValueError)
    assert raised.value.mistakes == str(raised.value).split("\n")
    printed = cli(*line.split(), status=2).stderr
    for mistake in raised.value.mistakes:
        assert mistake in printed


def test_a_numerical_failure_is_a_status(cli):
    options = {"velocity": [0.05, -1, 0], "retraction": "exp", "step": 1.5, "until": 60}
    failed = hamel.run("chaplygin_sleigh", **options)
    assert not failed and not failed.status.ok
    assert len(failed) == failed.steps + 1 and failed.status.step == failed.steps + 1
    line = "run chaplygin_sleigh --velocity 0.05,-1,0 --retraction exp --step 1.5 --until 60"
    assert failed.status.reason in cli(*line.split(), status=1).stderr


def test_names(cli_json):
    for kind, names in hamel.list().items():
        assert names == hamel.list(kind)
        assert {entry["name"] for entry in cli_json("list", kind)} >= set(names) - {"x"}
    described = cli_json("describe", "segway")
    ours = hamel.describe("segway")
    assert [p.name for p in ours.parameters] == [p["name"] for p in described["parameters"]]
    assert [p.unit for p in ours.inputs] == [p["unit"] for p in described["inputs"]]
    assert ours.summary == described["summary"] and ours.group == described["group"]


def test_an_ensemble(cli_json, tmp_path):
    (tmp_path / "many.toml").write_text(
        'system = "suslov"\nuntil = 1\nmembers = 40\nseed = 3\nkeep = ["end.omega1"]\n'
        "[vary]\nstart.omega1 = { normal = [1, 0.1] }\n"
    )
    record = cli_json("ensemble", "many.toml", "-o", "there")
    shares = [
        hamel.ensemble(tmp_path / "many.toml", folder=tmp_path / "here", shard=(i, 2))
        for i in (1, 2)
    ]
    ours = hamel.ensemble(tmp_path / "many.toml", folder=tmp_path / "here", merge=True)
    assert len(ours) == 40 and ours.complete and sum(map(len, shares)) == 40
    assert ours.record["kept"] == record["kept"]
    with open(tmp_path / "there/ensemble.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    np.testing.assert_array_equal(ours["end.omega1"], [float(row["end.omega1"]) for row in rows])


def test_a_section(cli_json):
    there = cli_json("section", "rattleback", "--event", "reversed", "--count", "2")
    ours = hamel.section("rattleback", "reversed", 2)
    assert ours.columns == there["columns"] and len(ours) == 2 and ours
    for j, name in enumerate(ours.columns):
        np.testing.assert_array_equal(ours[name], [row[j] for row in there["rows"]])
    with pytest.raises(hamel.ConfigError, match="reversed"):
        hamel.section("rattleback", "revresed", 2)
