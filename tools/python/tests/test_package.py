"""The additions of Python: views, frames, files, pickles, notebooks, help."""

import gc
import pickle
import runpy
import sys

import numpy as np
import pytest

import hamel
from conftest import ROOT, SUSLOV, run_python

PACKAGE = ROOT / "tools/python"


def test_rows_are_read_only_views_that_outlive_the_result():
    result = hamel.run("suslov", until=1, **SUSLOV)
    omega, xi, values = result["omega1"], result["xi"], result.values
    assert omega.shape == (101,) and xi.shape == (101, 3) and values.shape == (101, 26)
    assert np.shares_memory(omega, xi) and np.shares_memory(xi, values)
    assert np.shares_memory(result["xi1"], omega) and np.shares_memory(result.t, values)
    for view in (omega, xi, values):
        with pytest.raises(ValueError, match="read-only"):
            view[0] = 1
    first = omega.copy()
    del result, xi, values
    gc.collect()
    np.testing.assert_array_equal(omega, first)


def test_names_units_and_unknown_columns():
    result = hamel.run("rolling_disk", until=0.1)
    assert "omega" in result and "xi1" in result and "omega1" not in result
    assert result.units["t"] == "s" and result.units[result.names[0]] == result.units["xi1"]
    assert set(result.units) >= set(result.columns)
    assert dict(result)["t"] is not None and list(result) == result.columns
    with pytest.raises(KeyError, match="did you mean 'energy'"):
        result["enrgy"]


def test_frames():
    pandas, xarray = pytest.importorskip("pandas"), pytest.importorskip("xarray")
    result = hamel.run("suslov", until=1, **SUSLOV)
    frame = result.to_pandas()
    assert isinstance(frame, pandas.DataFrame) and frame.index.name == "t"
    np.testing.assert_array_equal(frame["omega1"], result["xi1"])
    assert "xi1" not in frame
    assert frame.attrs["units"]["omega1"] == "rad/s"
    data = result.to_xarray()
    assert isinstance(data, xarray.Dataset) and data["xi"].dims == ("t", "xi_column")
    np.testing.assert_array_equal(data["configuration"], result["configuration"])
    assert data["energy"].attrs["units"] == "J"


def test_rows_in_files(tmp_path):
    result = hamel.run("suslov", until=1, record_to=[tmp_path / "x.csv", tmp_path / "x.csv.gz"])
    assert (tmp_path / "x.csv").exists() and len(result) == 0 and result.last.time == 1
    kept = hamel.run("suslov", until=1, record_to=tmp_path / "y.csv", keep_rows=10)
    assert 2 < len(kept) < 30
    assert "t" not in result and kept.steps == result.steps


def test_an_h5_is_read_by_h5py(tmp_path):
    h5py = pytest.importorskip("h5py")
    result = hamel.run("suslov", until=1)
    result.write(tmp_path / "x.h5")
    with h5py.File(tmp_path / "x.h5") as file:
        np.testing.assert_array_equal(file["xi"][:], result["xi"])


def test_an_unfinished_file_is_resumed(tmp_path):
    pytest.importorskip("h5py")
    options = {"scheme": "lift", "step": 0.001, "until": 20}

    def fail(state):
        if state.time > 15:
            raise LookupError("the machine stops here")

    path = tmp_path / "x.h5"
    with pytest.raises(LookupError):
        hamel.run("rolling_disk", record_to=path, observe=fail, **options)
    left = hamel.read_recorded(path)
    assert not left.finished and left.config.until == 20
    resumed = hamel.run(left.config, resume=left.path, record_to=left.path, keep_rows=10)
    whole = hamel.run("rolling_disk", record_to=tmp_path / "y.h5", keep_rows=10, **options)
    assert hamel.read_recorded(path).finished
    np.testing.assert_array_equal(resumed["xi"][-1], whole["xi"][-1])
    assert resumed.last.step == whole.last.step == 20_000


@pytest.mark.parametrize(
    "system, options",
    [
        ("suslov", SUSLOV),
        ("chaplygin_sleigh", {"events": "cusp", "inputs": {}}),
        ('group = "se2"\ninertia = [1, 2, 2]\nconstraints = [[0, 0, 1]]\nvelocity = [1, 1, 0]', {}),
        ("chaplygin_sleigh", {"velocity": [0.05, -1, 0], "retraction": "exp", "step": 1.5}),
    ],
)
def test_results_pickle(system, options, tmp_path):
    result = hamel.run(system, until=20, **options)
    again = pickle.loads(pickle.dumps(result))
    np.testing.assert_array_equal(again.values, result.values)
    assert again.columns == result.columns and again.units == result.units
    assert again.record == result.record and again.report() == result.report()
    assert again.report(verbose=True) == result.report(verbose=True)
    assert bool(again) == bool(result) and again.status.reason == result.status.reason
    assert again.config == result.config and again.notes == result.notes
    assert [e.time for e in again.events] == [e.time for e in result.events]
    assert again.exact_error_max == result.exact_error_max or np.isnan(result.exact_error_max)
    result.write(tmp_path / "a.csv")
    again.write(tmp_path / "b.csv")
    assert (tmp_path / "a.csv").read_bytes() == (tmp_path / "b.csv").read_bytes()
    assert pickle.loads(pickle.dumps(again)).record == result.record


def test_configurations_pickle_and_run():
    config = hamel.Config("segway", step=0.002, until=1, inputs={"right_torque": ([0, 2], [0, 1])})
    again = pickle.loads(pickle.dumps(config))
    assert again == config and again != config.replace(step=0.001)
    assert hamel.Config.from_toml(config.to_toml()) == config
    a, b = hamel.run(config), hamel.run(again)
    np.testing.assert_array_equal(a.values, b.values)
    simulation = pickle.loads(pickle.dumps(hamel.simulate(config).retraction("exp")))
    assert simulation.config == config.replace(retraction="exp")
    with pytest.raises(TypeError, match="does not pickle"):
        pickle.dumps(hamel.simulate("suslov").observe(lambda state: True))


def test_a_result_shows_itself():
    text = hamel.run("suslov", until=1, **SUSLOV)._repr_html_()
    assert text.split("<details>")[0].count("<polyline") == 3
    assert "prefers-color-scheme: dark" in text
    assert "suslov" in text and "<script" not in text and "http" not in text
    failed = hamel.run("chaplygin_sleigh", velocity=[0.05, -1, 0], step=1.5, retraction="exp")
    assert "failed in step" in failed._repr_html_()
    back = hamel.run("suslov", from_=1, until=0, step=-0.01)._repr_html_()
    assert back.split("<details>")[0].count("<polyline") == 3
    assert "<td>" in hamel.study(system="suslov", step=[0.1], until=1, repeats=1)._repr_html_()


def test_each_option_is_a_method_of_the_builder():
    options = {name for name, of in vars(hamel.Config).items() if isinstance(of, property)}
    others = {"system", "parameters", "configuration", "velocity", "momentum"}
    assert len(options - others) > 20
    assert all(callable(vars(hamel.Simulation).get(name)) for name in options - others)
    builder = hamel.simulate("suslov").rtol(1e-9).check().steps_max(7).output_times([0.1])
    config = builder.events("omega1=0.5").force_at("base").config
    assert (config.rtol, config.check, config.steps_max) == (1e-9, True, 7)
    assert (config.output_times, config.events) == ([0.1], ["omega1=0.5"])
    with pytest.raises(hamel.ConfigError, match="step: 'no' is not a number"):
        builder.step("no")


def test_an_ensemble_by_functions():
    text = 'system = "suslov"\nuntil = 1\nmembers = 40\nkeep = ["end.omega1", "end.energy"]\n'
    ours = hamel.ensemble(
        text,
        threads=2,
        vary_by={"inertia1": lambda member: 1 + member / 40},
        keep_by={"twice": lambda state: 2 * state["omega1"], "e": lambda state: state.energy},
    )
    assert ours and len(ours) == 40
    np.testing.assert_array_equal(ours["inertia1"], 1 + np.arange(40) / 40)
    np.testing.assert_array_equal(ours["twice"], 2 * ours["end.omega1"])
    np.testing.assert_array_equal(ours["e"], ours["end.energy"])

    def wrong(state):
        raise ValueError("not this one")

    def wrong_index(member):
        raise IndexError("out of it")

    failed = hamel.ensemble(text, keep_by={"x": wrong})
    assert failed.record["failed"] == 40
    assert failed.record["failures"][0]["reason"] == "ValueError: not this one"
    failed = hamel.ensemble(text, keep_by={"x": lambda state: "two"})
    assert failed.record["failures"][0]["reason"] == "a function returned no number"
    with pytest.raises(hamel.ConfigError, match="inertia1.*IndexError: out of it"):
        hamel.ensemble(text, vary_by={"inertia1": wrong_index})


LINK = """name = "link"
body = [{ name = "rod", mass = 1, at = [0, 0, 0.5], box = [0.1, 0.1, 1] }]
joint = [{ name = "pivot", kind = "hinge", child = "rod", at = [0, 0, 1], axis = [0, 1, 0], damping = "d" }]
[parameters]
d = { value = 0, unit = "N m s" }
[start]
pivot.rate = 1
"""


@pytest.mark.parametrize("system", [LINK, hamel.Mechanism.from_toml(LINK, "link.toml")])
def test_systems_as_texts_in_studies_and_ensembles(system):
    table = {
        "system": system,
        "until": 1,
        "output_step": 0.5,
        "vary": {"d": {"values": np.array([0.0, 0.1])}},
        "keep": ["end.pivot.rate"],
    }
    many = hamel.ensemble(table, threads=1)
    assert many["d"].tolist() == [0, 0.1]
    for d, rate in zip(many["d"], many["end.pivot.rate"]):
        one = hamel.run(system, until=1, d=d)
        assert rate == pytest.approx(one["pivot.rate"][-1], rel=1e-12)
    cells = hamel.study({"system": system, "until": 1, "scheme": ["lift"], "step": [0.1, 0.05]})
    assert len(cells) == 2 and bool(cells)
    with pytest.raises(hamel.ConfigError, match="expected one of"):
        hamel.ensemble({**table, "vry": {}})
    with pytest.raises(hamel.ConfigError, match="keep: got a set"):
        hamel.ensemble({**table, "keep": {"x"}})


@pytest.mark.parametrize("name", ["first_steps", "segway"])
def test_examples(name):
    runpy.run_path(str(PACKAGE / "examples" / f"{name}.py"))


def test_the_program_of_the_readme(tmp_path, monkeypatch):
    pytest.importorskip("pandas"), pytest.importorskip("xarray"), pytest.importorskip("h5py")
    monkeypatch.chdir(tmp_path)  # it writes a file
    block = (PACKAGE / "README.md").read_text().split("```python\n")[1].split("```")[0]
    names: dict[str, object] = {}
    exec(block, names)
    assert names["omega"].shape == (2001,) and (tmp_path / "suslov.h5").exists()


def test_help_has_every_option():
    for option in ("scheme", "rtol", "output_times", "momentum", "from_", "record_to"):
        assert f"\n    {option}: " in hamel.run.__doc__
    for public in vars(hamel).values():
        if isinstance(public, type):
            assert public.__doc__, public


def test_import_loads_no_numpy():
    """NumPy is imported with the first array, since it takes longer than the rest."""
    code = "import sys, hamel; print('numpy' in sys.modules, 'pandas' in sys.modules)"
    assert run_python(code).stdout.split() == ["False", "False"]


def test_names_of_earlier_releases():
    result = hamel.run("segway", step=0.01, until=0.1)
    assert result.columns[1:8] == ["theta", "x", "y", "right", "left", "pitch", "omega"]
    assert result.names[-1] == "pitch'"
    again = pickle.loads(pickle.dumps(result))
    run = hamel.simulate("segway", step=0.01, until=0.1).build()
    for name, others in {"pitch": ("4_theta", "theta_4"), "pitch'": ("xi6", "angle_4'")}.items():
        for other in others:
            np.testing.assert_array_equal(result[other], result[name])
            np.testing.assert_array_equal(again[other], result[name])
            assert result.last[other] == result.last[name] and run[other] == run[name]
            assert other in result and result.units[other] == result.units[name]
    points = hamel.section("routh_sphere", "1_R33=0.9", 2)
    np.testing.assert_array_equal(points["xi1"], points["omega1"])
