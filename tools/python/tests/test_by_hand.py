"""Runs by hand, callbacks, threads and interruption."""

import re
import shutil
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import hamel
from conftest import SUSLOV, environment


def test_the_builder_has_the_names_of_the_keywords():
    built = hamel.simulate("suslov").inertia([2, 3, 4]).start(momentum=[1, 1, 0])
    built = built.scheme("lift").s(0.5).retraction("cayley").solver("newton", tolerance=1e-13)
    built = built.step(0.01).until(2).every(1)
    np.testing.assert_array_equal(built.run().values, hamel.run("suslov", until=2, **SUSLOV).values)
    assert hamel.simulate("suslov").scheme("lfit").mistakes()[0].startswith("unknown scheme 'lfit'")
    with pytest.raises(AttributeError):
        built._no_such_name  # noqa: B018


@pytest.mark.parametrize("options", [{"scheme": "lift", "step": 0.01}, {"rtol": 1e-9}])
def test_steps_by_hand_are_those_of_a_run(options):
    whole = hamel.run("rattleback", until=1, **options)
    by_hand = hamel.simulate("rattleback", until=1, **options).build()
    assert by_hand.complete()
    np.testing.assert_array_equal(by_hand.velocity, whole["xi"][-1])
    run = hamel.simulate("rattleback", **options).build()
    while run.time < 1:
        assert run.step_towards(1.0)
    np.testing.assert_array_equal(run.velocity, whole["xi"][-1])
    assert [run[name] for name in run.names[-3:]] == list(run.velocity[-3:])
    assert run["t"] == run.time == run.state.time and run["energy"] == run.state.energy
    with pytest.raises(KeyError, match="did you mean"):
        run["energi"]


def test_turning_back_restarting_and_dense_output():
    run = hamel.simulate("suslov", step=0.01, scheme="lift").build()
    begin = run.coordinates
    assert run.step(10_000) and run.time == pytest.approx(100)
    run.turn_back()
    assert run.step(10_000)
    np.testing.assert_allclose(run.coordinates, begin, atol=1e-9)
    run.restart(momentum=[1, 0, 0])
    assert run.time == 0 and run.step()
    assert run.at(0.005).time == pytest.approx(0.005)
    result = run.finish()
    assert result and result.steps == 1
    with pytest.raises(hamel.ConfigError, match="finished"):
        run.step()


def test_inputs_by_hand():
    run = hamel.simulate("segway", step=0.001).input("right_torque", 0).build()
    run.input("right_torque", 3)
    free = hamel.simulate("segway", step=0.001).build()
    assert run.step(100) and free.step(100) and run["omega"] > free["omega"]
    with pytest.raises(hamel.ConfigError, match="did you mean 'left_torque'"):
        run.input("left_torqe", 1)
    with pytest.raises(hamel.ConfigError, match="built without inputs"):
        free.input("right_torque", 1)


def test_observers_impacts_and_their_exceptions():
    seen = []

    def watch(state):
        seen.append(state.time)
        return state.time < 0.495

    stopped = hamel.run("suslov", step=0.01, until=1, observe=watch)
    assert stopped and stopped.last.time == pytest.approx(0.5) and len(seen) == len(stopped)
    assert stopped.last["omega1"] == stopped["omega1"][-1]

    def brake(state):
        state.velocity *= 0.5

    hit = hamel.run("chaplygin_sleigh", until=3, rtol=1e-9, on_event={"t=1": brake})
    assert [event.time for event in hit.events] == pytest.approx([1])
    assert hit["energy"][-1] == pytest.approx(hit["energy"][0] / 4, rel=1e-6)

    def broken(state):
        raise LookupError("mine")

    for options in ({"observe": broken}, {"on_event": {"t=1": broken}}):
        with pytest.raises(LookupError, match="mine"):
            hamel.run("chaplygin_sleigh", until=3, **options)
    reported = []
    hamel.run("suslov", until=1, progress=reported.append)
    assert reported[-1] == 1
    assert hamel.run("suslov", until=1, progress=True)  # a bar, by tqdm if that is installed


def test_options_that_are_none():
    with pytest.raises(hamel.ConfigError, match="unknown option 'sheme'.* mean 'scheme'"):
        hamel.run("suslov", sheme="lift")
    with pytest.raises(hamel.ConfigError, match="every: got 1.5|every: '1.5'"):
        hamel.run("suslov", every=1.5)
    with pytest.raises(hamel.ConfigError, match="every: "):
        hamel.run("suslov", every=1e300)
    for wrong, text in (
        ({"step": []}, r"step: got \[\], expected a number"),
        ({"until": None}, "until: got None, expected a number"),
        ({"inertia": "heavy"}, "inertia: 'heavy' in 'heavy' is not a number"),
        ({"inertia": [1, "x"]}, "inertia: got 'x', expected a number"),
        ({"inertia": None}, "inertia: got None, expected a number"),
        ({"scheme": 3}, "scheme: got 3, expected a text"),
        ({"inputs": 3}, "inputs: got 3, expected a dict"),
        ({"parameters": 3}, "parameters: got 3, expected a dict"),
    ):
        with pytest.raises(hamel.ConfigError, match=text):
            hamel.run("suslov", **wrong)
    assert hamel.run("suslov", until=1, inertia="2,3,4").record["parameters"]["inertia"] == [2, 3, 4]
    with pytest.raises((TypeError, hamel.ConfigError), match="system"):
        hamel.run(3)


@pytest.mark.skipif(shutil.which("valgrind") is None, reason="needs valgrind")
def test_a_call_costs_little_more_than_its_run(tmp_path):
    """Keywords and the builder: 6,200 instructions, some 2 of the 20 µs allowed."""
    script = tmp_path / "calls.py"
    script.write_text("""import sys, hamel
options = {"step": 0.01, "until": 0.1}
simulation = hamel.simulate("suslov", **options)
for _ in range(int(sys.argv[2])):
    hamel.run("suslov", **options) if sys.argv[1] == "call" else simulation.run()
""")

    def collected(what: str, times: int) -> int:
        done = subprocess.run(
            ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null"]
            + [sys.executable, str(script), what, str(times)],
            capture_output=True,
            text=True,
            env={**environment(), "PYTHONHASHSEED": "0"},
            check=True,
        )
        return int(re.search(r"Collected : (\d+)", done.stderr)[1])

    more = (collected("call", 30) - collected("run", 30)) / 30
    assert 0 < more < 20_000


def test_long_calls_leave_the_interpreter_free():
    done = threading.Event()

    def work():
        hamel.run("rattleback", scheme="lift", step=1e-4, until=100, every=10_000)
        done.set()

    worker = threading.Thread(target=work)
    worker.start()
    for _ in range(20):  # each waits for the interpreter, which a call of several seconds releases
        time.sleep(0.001)
    assert not done.is_set()
    worker.join()


def test_threads_have_the_results_of_one():
    expected = [hamel.run("rattleback", until=1, skew=0.01 * k).values for k in range(1, 7)]
    results = [None] * 6

    def work(first):
        for k in range(first, 6, 2):
            results[k] = hamel.run("rattleback", until=1, skew=0.01 * (k + 1)).values

    workers = [threading.Thread(target=work, args=(k,)) for k in range(2)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    for ours, theirs in zip(results, expected, strict=True):
        np.testing.assert_array_equal(ours, theirs)


def test_one_thread_at_a_time_steps_a_run():
    run = hamel.simulate("rattleback", scheme="lift", step=1e-4).build()
    worker = threading.Thread(target=lambda: run.step(3_000_000))  # two seconds
    worker.start()
    time.sleep(0.05)
    with pytest.raises(RuntimeError, match="in use"):
        run.step()
    worker.join()
    assert run.step()


INTERRUPTED = """
import sys, threading, hamel
try:
    print("begins", flush=True)
    {call}
except KeyboardInterrupt:
    print("interrupted")
    print(hamel.run("suslov", until=1).status.ok)
"""


@pytest.mark.parametrize(
    "call",
    [
        "hamel.run('rattleback', scheme='lift', step=1e-5, until=1e4, every=10**6)",
        "hamel.simulate('rattleback', scheme='lift', step=1e-5).build().step(10**9)",
        "hamel.simulate('rattleback', scheme='lift', step=1e-5, until=1e4, every=10**6).build().complete()",
        "hamel.study(system='rattleback', scheme=['lift'], step=[1e-4, 1e-5], until=100)",
    ],
)
def test_ctrl_c(call):
    with subprocess.Popen(
        [sys.executable, "-c", INTERRUPTED.format(call=call)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=environment(),
    ) as process:
        assert process.stdout.readline() == "begins\n"
        time.sleep(1)
        process.send_signal(signal.SIGINT)
        output, errors = process.communicate(timeout=60)
        assert output == "interrupted\nTrue\n", errors
