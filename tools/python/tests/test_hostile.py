"""Circles of callbacks, odd objects, damaged pickles, the end of Python amid a run."""

import ctypes
import gc
import pickle
import random
import sys
import weakref

import numpy as np
import pytest
from conftest import run_python

import hamel

DISK = {"step": 0.01, "until": 0.1}


def pendulum() -> hamel.Mechanism:
    mechanism = hamel.Mechanism("pendulum")
    mechanism.body("rod", mass=1, at=(0, 0, -0.5), inertia=[0.1, 0.1, 0.1])
    mechanism.hinge("pivot", hamel.WORLD, "rod", axis=(0, 1, 0))
    return mechanism


class Large:
    """What a callback holds: seen to be freed."""

    def __init__(self) -> None:
        self.data = bytearray(1_000_000)


def circle_of_run():
    large = Large()
    box = {}
    simulation = hamel.simulate("falling_disk", **DISK)
    box["run"] = simulation.observe(lambda s: (box, large) and True).build()
    box["run"].step(2)
    return weakref.ref(large)


def circle_of_simulation():
    large = Large()
    box = {}
    box["simulation"] = hamel.simulate("falling_disk", **DISK)
    box["simulation"].on_event("z=0.4", lambda e: (box, large)).progress(lambda f: (box, large))
    return weakref.ref(large)


def circle_of_mechanism():
    large = Large()
    mechanism = pendulum()
    mechanism.motor("pivot", lambda t, q, v, u: 0.0 if (mechanism, large) else 1.0)
    return weakref.ref(large)


def circle_of_all():
    large = Large()
    box = {}
    mechanism = box["mechanism"] = pendulum()
    mechanism.motor("pivot", lambda t, q, v, u: 0.1 if (box, large) else 1.0)
    simulation = box["simulation"] = hamel.simulate(mechanism, **DISK).observe(lambda s: bool(box))
    box["run"] = simulation.build()
    box["run"].step(3)
    box["result"] = simulation.run()
    box["copy"] = hamel.simulate(simulation)
    return weakref.ref(large)


@pytest.mark.parametrize(
    "circle", [circle_of_run, circle_of_simulation, circle_of_mechanism, circle_of_all]
)
def test_circles_are_freed(circle):
    freed = [circle() for _ in range(3)]
    gc.collect()
    assert [ref() for ref in freed] == [None] * 3


def test_callbacks_live_as_long_as_an_owner():
    calls = []
    simulation = hamel.simulate("falling_disk", **DISK)
    run = simulation.observe(lambda state: calls.append(state.time)).build()
    del simulation
    mechanism = pendulum()
    mechanism.motor("pivot", lambda t, q, v, u: calls.append(t) or 0.2)
    result = hamel.run(mechanism, **DISK)
    swing = hamel.simulate(mechanism, **DISK).build()
    del mechanism
    gc.collect()
    before = len(calls)
    assert run.step(3) and len(calls) > before
    before = len(calls)
    assert swing.step(3) and len(calls) > before
    assert result and result.report()
    ended = run.finish()
    del run
    gc.collect()
    assert ended.last.time > 0


def test_an_observer_has_names():
    seen = []
    result = hamel.run("falling_disk", observe=lambda s: seen.append((s["z"], s["omega1"])), **DISK)
    np.testing.assert_array_equal([z for z, _ in seen], result["z"])
    seen.clear()
    trailers = hamel.simulate("n_trailer", step=0.01).set("trailers", 2)
    run = trailers.observe(lambda s: seen.append(s["v1"])).build()
    run.step()
    assert len(seen) == 2


ENDS = """
import threading, time, hamel
def pendulum():
    m = hamel.Mechanism("p")
    m.body("rod", mass=1, at=(0, 0, -0.5), inertia=[0.1, 0.1, 0.1])
    m.hinge("pivot", hamel.WORLD, "rod", axis=(0, 1, 0))
    m.motor("pivot", lambda t, q, v, u: 0.1)
    return m
def observed():
    hamel.run("falling_disk", step=1e-3, until=1e6, every=1, keep_rows=10, observe=lambda s: True)
def driven():
    hamel.run(pendulum(), step=1e-3, until=1e6, every=10**6, keep_rows=10)
def by_hand():
    run = hamel.simulate(pendulum(), step=1e-3).build()
    run.step(10**9)
def watched():
    hamel.run("falling_disk", step=1e-3, until=1e6, every=10**6, keep_rows=10,
              progress=lambda f: None)
threading.Thread(target=%s, daemon=True).start()
time.sleep(0.3)
"""


@pytest.mark.parametrize("what", ["observed", "driven", "by_hand", "watched"])
def test_python_ends_amid_a_run(what):
    for _ in range(3):
        done = run_python(ENDS % what)
        assert done.returncode == 0, done.stderr


def test_surrogates_are_refused_by_name():
    lone = "a\udc80b"
    for call in (
        lambda: hamel.run(lone),
        lambda: hamel.run("suslov", scheme=lone),
        lambda: hamel.run("suslov", **{lone: 1}),
        lambda: hamel.run("suslov", inputs={lone: 1}),
        lambda: hamel.run("suslov", inertia=lone),
        lambda: hamel.run("suslov", record_to=lone),
        lambda: hamel.run("suslov", events=[lone]),
        lambda: hamel.describe(lone),
        lambda: hamel.steady("bicycle", vary=lone),
        lambda: pendulum().start(**{lone: 1}),
    ):
        with pytest.raises((hamel.ConfigError, TypeError)) as raised:
            call()
        assert "bad_cast" not in str(raised.value)

    class Odd:
        def __repr__(self):
            return lone

    with pytest.raises(hamel.ConfigError, match="expected"):
        hamel.run("suslov", inertia=Odd())


def test_objects_that_ravel_into_themselves():
    class Same:
        def ravel(self):
            return self

        def tolist(self):
            return self

        def __getattr__(self, name):
            return lambda *a: self

    with pytest.raises(hamel.ConfigError, match="inertia: got"):
        hamel.run("suslov", inertia=Same())


def test_an_address_is_no_function():
    class Address:
        address = 12345

        def __call__(self, *arguments):
            return 0.25

    class Bare:
        address = 0xDEADBEEF

    runs = []
    for effort in (0.25, Address()):
        mechanism = pendulum()
        mechanism.motor("pivot", effort, time_dependent=False)
        runs.append(hamel.run(mechanism, **DISK))
    np.testing.assert_array_equal(runs[0].values, runs[1].values)
    with pytest.raises(hamel.ConfigError, match="expected a number"):
        pendulum().motor("pivot", Bare())
    real, pointer = ctypes.c_double, ctypes.POINTER(ctypes.c_double)
    fits = ctypes.CFUNCTYPE(real, real, pointer, pointer, pointer)(lambda t, q, v, u: 0.25)
    mechanism = pendulum()
    mechanism.motor("pivot", fits, time_dependent=False)
    np.testing.assert_array_equal(hamel.run(mechanism, **DISK).values, runs[0].values)
    for other in (
        ctypes.CFUNCTYPE(ctypes.c_int, real, pointer, pointer, pointer)(lambda t, q, v, u: 1),
        ctypes.CFUNCTYPE(real, real)(lambda t: 1),
    ):
        with pytest.raises(hamel.ConfigError, match="of other types, expected float64"):
            pendulum().motor("pivot", other)
    broken = pendulum()
    broken.motor("pivot", lambda t, q, v, u: "text")
    with pytest.raises(hamel.ConfigError, match="effort: got 'text', expected a number"):
        hamel.run(broken, **DISK)


def damage(value, dice):
    """The value with one part of it another one."""
    if isinstance(value, dict) and value and dice.random() < 0.9:
        key = dice.choice(list(value))
        out = dict(value)
        if dice.random() < 0.2:
            del out[key]
        else:
            out[key] = damage(value[key], dice)
        return out
    if isinstance(value, list | tuple) and value and dice.random() < 0.8:
        out = list(value)
        i = dice.randrange(len(out))
        match dice.randrange(4):
            case 0:
                del out[i]
            case 1:
                out.append(out[i])
            case _:
                out[i] = damage(out[i], dice)
        return type(value)(out)
    if isinstance(value, bytes) and dice.random() < 0.7:
        return value[: dice.randrange(len(value) + 1)]
    others = [None, 0, -1, 10**30, 1.5, float("nan"), "", "x\udc80", b"abc", (), [], {}]
    return dice.choice([*others, [1.0] * 3, ["a"] * 40])


def use(thing):
    for act in (
        str,
        repr,
        bool,
        lambda r: r.report(),
        lambda r: r.record,
        lambda r: r.last.velocity,
        lambda r: r["omega1"],
        lambda r: r.values,
        lambda r: r.figures(),
        lambda r: r.animation(),
        lambda r: r.write("/dev/null/x.csv"),
        lambda r: pickle.dumps(r),
        lambda r: r.run(),
        lambda r: r.at(0.3),
        lambda r: r.mistakes(),
    ):
        try:
            act(thing)
        except Exception:  # noqa: BLE001, PERF203  (any of them, but no crash)
            pass


@pytest.mark.filterwarnings("ignore:nanobind. attempted to access an uninitialized instance")
def test_damaged_pickles():
    dice = random.Random(34)
    things = [
        hamel.run("suslov", **DISK),
        hamel.run("falling_disk", events="z=0.4", **DISK),
        hamel.simulate("suslov", **DISK),
        hamel.simulate("suslov", **DISK).config,
        hamel.InputTable([0, 1], [2, 3]),
        hamel.SystemText('group = "so2"\ninertia = [1]\nvelocity = [1]\n'),
    ]
    for thing in things:
        for _ in range(150):
            fresh = type(thing).__new__(type(thing))
            state = damage(thing.__getstate__(), dice)
            try:
                fresh.__setstate__(state)
            except Exception:  # noqa: BLE001
                use(fresh)  # not made: refused
                continue
            use(fresh)
    for state in ({"last": ()}, {}):
        with pytest.raises(hamel.ConfigError, match="damaged pickle"):
            hamel.Result.__new__(hamel.Result).__setstate__(state)


def test_a_figure_is_svg(tmp_path):
    figure = next(iter(hamel.run("suslov", **DISK).figures().values()))
    for name in ("x.pdf", "x.png", "x"):
        with pytest.raises(hamel.ConfigError, match="ends with .svg"):
            figure.write(tmp_path / name)
        assert not (tmp_path / name).exists()
    figure.write(tmp_path / "x.svg")
    assert (tmp_path / "x.svg").read_text().startswith("<svg")


@pytest.mark.skipif(sys.version_info >= (3, 13), reason="the module has another name there")
@pytest.mark.parametrize("first", ["", "import hamel; "])
def test_a_subinterpreter_is_refused(first):
    done = run_python(
        first + "import _xxsubinterpreters as s\n"
        "i = s.create(isolated=False)\n"
        "try:\n"
        "    s.run_string(i, 'import hamel; hamel.run(\"suslov\", observe=lambda s: True)')\n"
        "except s.RunFailedError as e:\n"
        "    print(e)\n"
    )
    assert done.returncode == 0, done.stderr
    assert "subinterpreter" in done.stdout
