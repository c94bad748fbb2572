"""Plans, their feedback, and fits."""

import numpy as np
import pytest

import hamel
from conftest import ROOT

EXAMPLES = ROOT / "tests/examples"


def test_a_plan_is_that_of_its_file_and_its_feedback_corrects_it():
    plan = hamel.plan(EXAMPLES / "parking.toml")
    assert plan and plan.status == "ok" and plan.reason == ""
    assert plan.objective == pytest.approx(4.36573, abs=5e-6)
    assert len(plan.t) == plan.steps + 1 and set(plan.inputs) == {"torque", "force"}
    assert plan.states["y"][-1] == pytest.approx(1, abs=1e-9)
    at_rest = plan.feedback(0, [0, 0, 0], [0, 0, 0])
    assert at_rest["force"] == pytest.approx(plan.inputs["force"][0], abs=1e-12)
    behind = plan.feedback(0, [0, -0.01, 0], [0, 0, 0])
    assert behind["force"] > at_rest["force"]
    rows = plan.gains().splitlines()
    assert len(rows) == plan.steps + 1 and rows[0].startswith("t,d(torque)/d(eta.omega),")
    with pytest.raises(ValueError, match="expected 0 to 99"):
        plan.feedback(100, [0, 0, 0], [0, 0, 0])


def test_a_plan_refuses_a_wrong_name_with_its_place(tmp_path):
    file = tmp_path / "plan.toml"
    file.write_text('system = "segway"\nuntil = 1\nsteps = 5\ninputs = ["left_torqe"]\n')
    with pytest.raises(hamel.ConfigError, match=r"plan\.toml:4:10: .*did you mean 'left_torque'"):
        hamel.plan(file)


def test_a_fit_returns_the_numbers_of_its_recording():
    t = np.linspace(0, 2, 41)
    run = hamel.run(
        "chaplygin_sleigh", offset=0.3, velocity=[1, 1, 0], rtol=1e-11, output_times=list(t)
    )
    data = {"t": run.t, "omega": run["omega"], "v1": run["v1"]}
    fit = hamel.fit(
        "chaplygin_sleigh", data, {"offset": (0.2, 0, 1)}, velocity=[1, 1, 0], rtol=1e-11
    )
    assert fit.converged, fit.reason
    assert fit.parameters[0].name == "offset"
    assert fit.parameters[0].value == pytest.approx(0.3, abs=1e-8)
    assert fit.undetermined == []
    names, options = {"offset": (0.2, 0, 1)}, {"velocity": [1, 1, 0], "rtol": 1e-11}
    parts = hamel.fit("chaplygin_sleigh", data, names, segments=3, **options)
    assert (fit.segments, parts.segments) == ([1], [3])
    assert parts["offset"].value == pytest.approx(fit["offset"].value, abs=1e-9)
    with pytest.raises(hamel.ConfigError, match="offset"):
        hamel.fit("chaplygin_sleigh", data, ["ofset"])


def test_derivatives_of_a_run_are_those_of_its_neighbours():
    def sleigh():
        builder = hamel.simulate("chaplygin_sleigh").offset(0.2).start(velocity=[1, 1, 0])
        return builder.tolerance(relative=1e-11).until(2)

    along = sleigh().sensitivities(["offset", "start.omega"])
    assert along and along.names == ["offset", "start.omega"]
    end = hamel.run("chaplygin_sleigh", offset=0.2, velocity=[1, 1, 0], rtol=1e-11, until=2)
    far = hamel.run("chaplygin_sleigh", offset=0.2001, velocity=[1, 1, 0], rtol=1e-11, until=2)
    near = hamel.run("chaplygin_sleigh", offset=0.1999, velocity=[1, 1, 0], rtol=1e-11, until=2)
    expected = (far["x"][-1] - near["x"][-1]) / 2e-4
    assert along["d(x)/d(offset)"][-1] == pytest.approx(expected, abs=1e-6)
    gradient = sleigh().gradient("x", ["offset"])
    assert gradient and gradient["offset"] == pytest.approx(expected, abs=1e-6)
    assert gradient.value == pytest.approx(end["x"][-1], abs=1e-9)
    run = sleigh().build()
    run.advance_to(2)
    matrix = run.tangent()
    assert matrix.shape == (6, 6)
    assert matrix[3, 3] == pytest.approx(along["d(omega)/d(start.omega)"][-1], abs=1e-7)
    with pytest.raises(hamel.ConfigError, match="did you mean 'offset'"):
        sleigh().gradient("x", ["ofset"])
