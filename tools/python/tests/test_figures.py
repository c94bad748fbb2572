"""Figures and motions: as the page draws them, as files."""

import json
import pickle
import re
import xml.etree.ElementTree

import numpy as np
import pytest

import hamel


def test_the_figures_of_a_run_are_those_of_the_page(cli, tmp_path):
    """All that `hamel report --figure` names, but the motion (animation()) and figures in space."""
    for system in ("suslov", "rattleback", "falling_disk"):
        cli("run", system, "--until", 1, "--step", 0.01, "--quiet", "-o", "run.h5")
        said = cli("report", "run.h5", "--figure", "none", status=2).stderr
        names = said.split("expected one of ")[1].strip().split(", ")
        figures = hamel.run(system, until=1, step=0.01).figures()
        assert sorted(figures) == sorted(set(names) - {"motion", "axes"})
        cli("report", "run.h5", "-o", "page.html")
        text = (tmp_path / "page.html").read_text().split('id="hamel-data">')[1]
        sections = json.loads(text.split("</script>")[0])["sections"]
        kinds = ("plot", "path", "sphere", "animation")
        blocks = [b for section in sections for b in section["blocks"] if b["kind"] in kinds]
        for name, block in zip(names, blocks, strict=True):
            assert name not in figures or figures[name].data == block
    assert figures["path"].svg.count("<polyline") == 2  # of the disk and of its contact
    figures["path"].write(tmp_path / "path.svg")
    xml.etree.ElementTree.parse(tmp_path / "path.svg")
    assert hamel.run("suslov", until=0.01, step=0.01, output_times=[0.01]).figures() == {}


def test_figures_of_studies_branches_and_ensembles():
    study = hamel.study(
        system="suslov", scheme=["lift", "rkmk4"], step=[0.1, 0.05], until=1, repeats=1
    )
    error = study.figures()["error"]
    assert error.svg.count("<polyline") == 2 and ">rkmk4<" in error.svg
    assert error.title == "Error against step" and error.data["slopes"] == [2, 4]
    assert error.svg in study._repr_html_()
    # Two decades of a logarithmic axis are as long as twice one: the fourth order falls faster.
    lines = [
        [[float(x) for x in pair.split(",")] for pair in points.split()]
        for points in re.findall(r'points="([^"]*)"', error.svg)
    ]
    slopes = [(b[1] - a[1]) / (b[0] - a[0]) for a, b in lines]
    assert slopes[1] / slopes[0] == pytest.approx(4 / 2, rel=0.05)
    branch = hamel.steady("bicycle", vary=("speed", 1, 8, 15))
    growth = branch.figures()["growth"].data
    drawn = [x for curve in growth["series"] for x in curve["y"] if x is not None]
    assert len(drawn) == sum(len(motion.eigenvalues) for motion in branch.motions)
    assert growth["x"] == "speed [m/s]" and growth["bands"]
    assert "hopf" in branch._repr_html_()
    text = 'system = "suslov"\nuntil = 1\nmembers = 40\nkeep = ["end.omega1"]\n[vary]\n'
    one = hamel.ensemble(text + "start.omega1 = { normal = [1, 0.1] }\n")
    assert one.figures()["end.omega1"].svg.count("<circle") == 40
    more = "start.omega1 = { normal = [1, 0.1] }\ninertia1 = { uniform = [1, 2] }"
    two = hamel.ensemble(text + more)
    assert two.figures()["end.omega1"].title == "Members by end.omega1"
    assert "end.omega1-over-inertia1" in two.figures()
    grid = hamel.ensemble(
        'system = "suslov"\nuntil = 1\ngrid = true\nkeep = ["end.omega1"]\n[vary]\n'
        "start.omega1 = { values = [1, 2] }\ninertia1 = { values = [1, 2, 3] }"
    )
    assert grid.figures()["end.omega1"].svg.count("<rect") == 6
    assert "40, of which 0 failed" in two._repr_html_()


def test_a_result_moves(tmp_path, monkeypatch):
    result = hamel.run("rattleback", until=1, output_step=0.1)
    animation = result.animation()
    assert "<iframe" in animation._repr_html_() and "http" not in animation.page()
    data = json.loads(
        animation.page().split('id="motion">')[1].split("</script>")[0].replace("<\\/", "</")
    )
    np.testing.assert_allclose(data["times"], result.t, rtol=1e-14)
    pose = data["bodies"][0]["poses"][-1]
    np.testing.assert_allclose(pose[:3], [result[x][-1] for x in "xyz"], atol=1e-6)
    w, x, y, z = pose[3:]
    assert 2 * (x * y + w * z) == pytest.approx(result["R21"][-1], abs=1e-5)
    assert pickle.loads(pickle.dumps(result)).animation().page() == animation.page()
    animation.write(tmp_path / "motion.html")
    assert (tmp_path / "motion.html").read_text() == animation.page()
    with pytest.raises(hamel.ConfigError, match="program hamel, which is not on the PATH"):
        monkeypatch.setenv("HAMEL_PROGRAM", "/nowhere/hamel")
        animation.write(tmp_path / "motion.png")
    with pytest.raises(ValueError, match="fewer than two rows"):
        hamel.run("rattleback", until=1, record_to=str(tmp_path / "x.csv")).animation()


def test_a_film_is_drawn_by_the_program(tmp_path, monkeypatch):
    program = tmp_path / "hamel"
    program.write_text(f"#!/bin/sh\necho \"$@\" > {tmp_path}/said\ntest -s $2 && touch $5\n")
    program.chmod(0o755)
    monkeypatch.setenv("HAMEL_PROGRAM", str(program))
    animation = hamel.run("rattleback", until=1, output_step=0.1).animation()
    animation.write(tmp_path / "m.svg", at=0.5, strobe=4, size=(640, 360), transparent=True)
    assert (tmp_path / "m.svg").exists()
    said = (tmp_path / "said").read_text().split()
    assert said[0] == "report" and said[2:4] == ["--motion", "-o"]
    assert said[5:] == "--at 0.5 --strobe 4 --size 640x360 --transparent".split()
    program.write_text("#!/bin/sh\necho 'hamel: --at: got 9' >&2\nexit 2\n")
    with pytest.raises(hamel.ConfigError, match="^--at: got 9$"):
        animation.write(tmp_path / "m.svg", at=9)
