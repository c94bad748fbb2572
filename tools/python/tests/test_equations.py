"""The equations of a system: at a state, as functions, as text."""

import numpy as np
import pytest

import hamel


def test_equations_at_a_state():
    run = hamel.simulate("bicycle").speed(5).build()
    run.step(3)
    equations = hamel.equations("bicycle", speed=5)
    state = run.state
    rate = equations.rate(state.time, state)
    rows = equations.rows(state)
    assert rows.a.shape == (len(rows.names), len(equations.velocities))
    np.testing.assert_allclose(rows.a @ state.velocity, rows.b, atol=1e-12)
    np.testing.assert_allclose(
        equations.inertia(state) @ state.velocity, equations.momentum(state), rtol=1e-13
    )
    assert equations.reactions(state).shape == rows.b.shape
    jacobian = equations.jacobian("rate", "steer.torque", state)
    pushed = hamel.equations("bicycle", speed=5, inputs={"steer.torque": 2.0})
    np.testing.assert_allclose(
        rate + 2 * np.asarray(jacobian)[:, 0], pushed.rate(state.time, state), atol=1e-9
    )
    with pytest.raises(hamel.ConfigError, match="did you mean 'velocity'"):
        equations.jacobian("rate", "velocty")


@pytest.mark.parametrize(
    "name",
    [
        "chaplygin_sleigh",
        "bicycle",
        "falling_disk",
        "segway",
        "car",
        "routh_sphere",
        "snakeboard",
        "n_trailer",
    ],
)
def test_equations_as_numpy(name):
    equations = hamel.equations(name)
    functions = equations.as_numpy()
    run = hamel.simulate(name, rtol=1e-12, until=1).build()
    for t in (0.0, 0.1, 0.3, 0.6):
        run.advance_to(t)
        state = run.state
        expected = equations.rate(t, state)
        u = [0.0] * len(hamel.describe(name).inputs)
        got = functions.rate(t, state.coordinates, state.velocity, u)
        np.testing.assert_allclose(got, expected, rtol=0, atol=1e-12 * (1 + abs(expected).max()))
        assert functions.coordinate_rates(state.coordinates, state.velocity).shape == (
            len(equations.columns),
        )


def test_equations_as_text():
    text = "group = 'r2'\ninertia = [1, 2]\npotential = 'sin(x1)*x2^3'\nvelocity = [1, 0]"
    equations = hamel.SystemText(text, "well.toml").equations()
    assert "\\dot{x_{1}'}" not in equations.formulas()
    assert "np.cos(x1)" in equations.formulas("numpy")
    assert "$$" in equations._repr_latex_()
    with pytest.raises(hamel.ConfigError, match="did you mean 'latex'"):
        equations.formulas("latx")
    assert hamel.equations("roller_racer")._repr_latex_() is None
    part = hamel.Mechanism("sled")
    part.body("sled", mass=1, box=(1, 1, 1))
    part.planar("floor", "sled")
    part.blade("axle", "sled", at=(0, 0, 0))
    assert "rate[2] = 0" in part.equations().formulas("numpy")


def test_equations_as_sympy():
    sympy = pytest.importorskip("sympy")
    symbols = hamel.equations("chaplygin_sleigh").as_sympy()
    omega, v1, _ = symbols.xi
    assert sympy.simplify(symbols.rate[1] - 0.2 * omega**2) == 0
    assert symbols.coordinate_rates[1] == v1 * sympy.cos(symbols.q[0])
