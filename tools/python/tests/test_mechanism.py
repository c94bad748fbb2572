"""Mechanisms by parts, with signals of Python and compiled ones."""

import ctypes
import pickle

import numpy as np
import pytest

import hamel


def scooter(name: str = "scooter") -> hamel.Mechanism:
    mechanism = hamel.Mechanism(name)
    deck = mechanism.body("deck", mass=5, at=[0.3, 0, 0.1], box=[0.8, 0.2, 0.05])
    fork = mechanism.body("fork", mass=2, at=np.array([0.7, 0, 0.4]), inertia=[0.1, 0.1, 0.01])
    mechanism.planar("road", deck)
    mechanism.hinge("steer", deck, fork, at=[0.7, 0, 0], axis=[0, 0, 1], damping=0.1)
    mechanism.blade("rear", deck)
    mechanism.blade("front", fork, at=[0.7, 0, 0])
    mechanism.start({"speed": 2, "steer.angle": 0.3})
    return mechanism


SCOOTER = """
name = "scooter"
body = [
  { name = "deck", mass = 5, at = [0.3, 0, 0.1], box = [0.8, 0.2, 0.05] },
  { name = "fork", mass = 2, at = [0.7, 0, 0.4], inertia = [0.1, 0.1, 0.01] },
]
blade = [
  { name = "rear", body = "deck", at = [0, 0, 0] },
  { name = "front", body = "fork", at = [0.7, 0, 0] },
]
motor = [{ joint = "steer" }]
[[joint]]
name = "road"
kind = "planar"
child = "deck"
[[joint]]
name = "steer"
kind = "hinge"
parent = "deck"
child = "fork"
at = [0.7, 0, 0]
axis = [0, 0, 1]
damping = 0.1
[start]
speed = 2
"steer.angle" = 0.3
"""


def test_a_mechanism_by_parts_is_that_of_the_text(tmp_path):
    by_parts = scooter()
    by_parts.motor("steer", least=-5, most=5)
    (tmp_path / "scooter.toml").write_text(SCOOTER)
    texts = (
        SCOOTER,
        hamel.Mechanism.from_toml(SCOOTER),
        hamel.Mechanism.from_file(tmp_path / "scooter.toml"),
        str(tmp_path / "scooter.toml"),
        pickle.loads(pickle.dumps(hamel.SystemText(SCOOTER))),
    )
    options = {"step": 0.01, "until": 2, "inputs": {"steer.torque": 0.5}}
    expected = hamel.run(by_parts, **options)
    for text in texts:
        np.testing.assert_array_equal(hamel.run(text, **options).values, expected.values)
    description = by_parts.describe()
    assert description.parts == ["deck", "fork"] and description.inputs[0].name == "steer.torque"
    assert description.coordinate_units[-1] == "rad"
    assert hamel.describe(SCOOTER).velocities == description.velocities
    with pytest.raises(hamel.ConfigError, match="toml:2:9"):
        hamel.run('name = "x"\ngroup = 3\n')
    with pytest.raises(hamel.ConfigError, match="wheel"):
        wrong = scooter()
        wrong.wheel("odd", "deck", radius=-1)
        hamel.run(wrong)


def test_outputs_states_torques_and_ground():
    m = hamel.Mechanism("ball")
    m.body("ball", mass=2, at=(0, 0, 0.1), sphere=0.1)
    m.free("root", "ball", at=(0, 0, 0.1))
    m.ball("contact", "ball", at=(0, 0, 0.1), radius=0.1)
    m.sensor("centre", "ball", at=(0, 0, 0.1))
    m.output("fallen", "-centre.z", unit="m")
    m.ground_height("-slope*x", constants={"slope": [0.2]})
    run = hamel.run(m, until=1, rtol=1e-11)
    distance = 0.5 * 5 / 7 * 9.81 * 0.2 / np.hypot(1, 0.2)
    assert abs(run["centre.path"][-1] - distance) < 1e-7
    np.testing.assert_array_equal(run["fallen"], -run["centre.z"])

    arm = hamel.Mechanism("arm")
    arm.gravity((0, 0, 0))
    arm.body("arm", mass=1, at=(1, 0, 0), inertia=[0.1, 0.1, 0.1])
    arm.hinge("turn", "ground", "arm")
    arm.state("lag", "(turn.angle - lag)/T", constants={"T": [0.3]})
    arm.torque("push", "arm", (0, 0, 1.1), time_dependent=False)
    run = hamel.run(arm, until=1, step=1e-3)
    assert abs(run["turn.rate"][-1] - 1) < 1e-9
    assert abs(run["lag"][-1] - (0.5 - 0.3 + 0.09 * (1 - np.exp(-1 / 0.3)))) < 1e-5


def test_signals_of_python_and_compiled():
    compiled = ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_double, *[ctypes.c_void_p] * 3)

    runs = []
    for effort in (0.25, lambda t, q, v, u: 0.25, compiled(lambda t, q, v, u: 0.25)):
        mechanism = scooter()
        mechanism.motor("steer", effort, time_dependent=False)
        runs.append(hamel.run(mechanism, step=0.01, until=1))
    for other in runs[1:]:
        np.testing.assert_array_equal(other.values, runs[0].values)

    mechanism = scooter()
    mechanism.motor("steer", lambda t, q, v, u: -2 * q[3])
    mechanism.event("straight", lambda t, q, v: q[3])
    assert hamel.run(mechanism, until=5, events="straight").events
    broken = scooter()
    broken.motor("steer", lambda t, q, v, u: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        hamel.run(broken, until=1)


def test_friction_stops_and_walls():
    block = hamel.Mechanism("block")
    block.body("block", mass=1, at=[0, 0, 0.1], box=[0.2, 0.2, 0.2])
    block.slider("way", "ground", "block", axis=[1, 0, 0], friction=2, stop=[-1, 1], restitution=0.5)
    block.wall("wall", distance="0.3 - way.position", restitution=1)
    block.start({"way.rate": 1})
    result = hamel.run(block, until=10, rtol=1e-10)
    assert [event.name for event in result.events] == ["way.sticks"]
    assert abs(result.events[0].time - 0.5) < 1e-12
    assert result["way.position"][-1] == pytest.approx(0.25, abs=1e-12)

    sled = hamel.Mechanism("sled")
    sled.body("sled", mass=2, at=[0, 0, 0.1], box=[0.2, 0.2, 0.2])
    sled.planar("floor", "sled")
    sled.point("skid", "sled", friction=0.3)
    sled.start({"v1": 3})
    result = hamel.run(sled, until=3, slip=True, rtol=1e-10)
    assert abs(result.events[0].time - 3 / (0.3 * 9.81)) < 1e-10
    assert result["skid.mode"][0] == 2 and result["skid.mode"][-1] == 1
    with pytest.raises(hamel.ConfigError, match="friction: got -1"):
        sled.point("other", "sled", friction=-1)
        hamel.run(sled, until=1)


def test_mechanisms_in_ensembles_and_studies(tmp_path):
    def driven(wrong=False):
        mechanism = scooter()
        mechanism.motor("steer", lambda t, q, v, u: (1 / 0 if wrong else -2 * q[3]))
        return mechanism

    options = {
        "until": 0.5,
        "step": 0.01,
        "vary": {"speed": {"values": [1, 2]}},
        "keep": ["end.x", "end.steer.angle"],
    }
    many = hamel.ensemble(driven(), threads=2, **options)
    same = hamel.ensemble({"system": driven(), **options}, threads=1)
    for speed, x, angle in zip(many["speed"], many["end.x"], many["end.steer.angle"]):
        one = hamel.run(driven(), until=0.5, step=0.01, speed=speed)
        assert (x, angle) == (one["x"][-1], one["steer.angle"][-1])
    np.testing.assert_array_equal(same["end.x"], many["end.x"])
    with pytest.raises(ZeroDivisionError):
        hamel.ensemble(driven(wrong=True), threads=2, **options)
    with pytest.raises(hamel.ConfigError, match="a journal cannot have 'scooter'"):
        hamel.ensemble(driven(), folder=tmp_path / "many", **options)
    with pytest.raises(hamel.ConfigError, match="keys beside a file"):
        hamel.ensemble("many.toml", until=1)

    cells = hamel.study(driven(), until=0.5, repeats=1, scheme=["lift", "rkmk4"], step=[0.1, 0.05])
    assert cells and len(cells) == 4
    named = hamel.study(
        system=[{"system": driven(), "label": "mine"}, "suslov"],
        until=0.5,
        repeats=1,
        scheme=["lift", "rkmk4"],
        step=[0.1, 0.05],
    )
    assert named["system"] == ["mine"] * 4 + ["suslov"] * 4
    np.testing.assert_array_equal(cells["error"], named["error"][:4])
    with pytest.raises(hamel.ConfigError, match="a journal cannot have 'scooter'"):
        hamel.study(driven(), folder=tmp_path / "cells", step=[0.1])
    for name, result in (("many", many), ("cells", cells)):
        try:
            result.write_page(tmp_path / f"{name}.html")
        except hamel.ConfigError as error:
            pytest.skip(str(error))
        assert "steer" in (tmp_path / f"{name}.html").read_text() or name == "cells"
    with pytest.raises(hamel.ConfigError, match="output format '.htm'"):
        many.write_page(tmp_path / "many.htm")
