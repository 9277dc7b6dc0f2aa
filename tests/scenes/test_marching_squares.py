"""The marching squares scene: numbers against closed forms, geometry against the kit, clicks and remarks."""

from __future__ import annotations

import json
from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import viewer
from viewer import cli
from viewer.engine.catalog import Catalog
from viewer.engine.presets import presets_for
from viewer.engine.stage import Stage
from viewer.kit.marching_squares import AMBIGUOUS, cell_cases, marching_squares
from viewer.kit.marching_squares_board import case_at, tile_corner

pytestmark = pytest.mark.usefixtures("context")
CIRCLE = {"formula": "length(x-0.5, y-0.5) - 0.31"}
POLE = {"formula": "1/(x - 0.52)"}
SIZE = (160, 120)


@pytest.fixture
def stage() -> Iterator[Stage]:
    """The scene as it comes, small."""
    with viewer.headless("marching_squares", size=SIZE, samples=0) as made:
        yield made


def numbers(stage: Stage) -> dict[str, Any]:
    """What the scene measures."""
    return dict(stage.measure())


def samples(stage: Stage) -> NDArray[np.float64]:
    """The default formula's values on the stage's grid, worked out here."""
    place = np.arange(stage.params.resolution + 1) / stage.params.resolution
    x, y = np.meshgrid(place, place, indexing="ij")
    return np.asarray(np.hypot(x - 0.22, y - 0.28) * np.hypot(x - 0.68, y - 0.82) - 0.128)


def pixel(stage: Stage, x: float, y: float) -> tuple[float, float]:
    """Where the place (x, y) of the square is in the picture, from its upper left corner."""
    width, height = stage.size
    projected = np.array([2 * x - 1, 2 * y - 1, 0, 1]) @ stage.camera.view() @ stage.camera.projection(
        width / height, stage.scene.middle())
    return (projected[0] / projected[3] + 1) / 2 * width, (1 - projected[1] / projected[3]) / 2 * height


def test_a_circle_in_numbers(stage: Stage) -> None:
    """One closed curve; length and distance approach the truth with the square of the cell."""
    off, length_off = [], []
    for resolution in (16, 32, 64, 128):
        stage.set(**CIRCLE, resolution=resolution)
        read = numbers(stage)
        assert read["curves"] == 1 and read["jumps"] == 0 and read["segments"] >= read["crossed_cells"] > 0
        assert 0 < read["max_distance"] <= 1 / resolution**2 / (2 * 0.31)
        off.append(read["max_distance"])
        length_off.append(abs(read["length"] - 2 * np.pi * 0.31))
    assert np.log2(off[0] / off[-1]) / 3 > 1.8
    assert np.log2(length_off[0] / length_off[-1]) / 3 > 1.8
    curve = read["error_vs_resolution"]
    assert curve.now == 128 and np.allclose(curve.series["max_distance"][2:6], off)


@pytest.mark.parametrize("values", [
    {}, {"resolution": 77}, {"saddle": "separate"}, {"saddle": "connect", "level": 0.05}, {"resolution": 512}])
def test_the_geometry_is_the_kit_s(stage: Stage, values: dict[str, Any]) -> None:
    """What is exported is what marching squares makes of the same samples, to the bit, in a GPU's precision."""
    stage.set(**values)
    exported = stage.geometry()["segments"]
    n = stage.params.resolution
    expected = marching_squares(samples(stage), stage.params.level, (1 / n, 1 / n), stage.params.saddle)
    assert exported.dtype == np.float32 and exported.shape == expected.shape
    assert np.allclose(exported, expected, atol=2e-6)
    assert numbers(stage)["segments"] == len(expected)


def test_the_default_has_an_ambiguous_cell_that_matters(stage: Stage) -> None:
    """Connected it is one curve, separated two; the decider sides with the true curve."""
    assert numbers(stage)["ambiguous_cells"] == 1
    curves = {}
    for saddle in ("connect", "separate", "decider"):
        stage.set(saddle=saddle)
        curves[saddle] = numbers(stage)["curves"]
    assert curves == {"connect": 1, "separate": 2, "decider": 1}


def test_clicks_on_cells(stage: Stage) -> None:
    """Each cell's middle chooses it, wherever the camera and the microscope's card put it; empty places clear."""
    for camera, cell in (({}, ""), ({"yaw": 25.0, "pitch": 18.0}, ""), ({}, "9,9"), ({"distance": 3.0}, "")):
        stage.camera.stand(camera)
        stage.set(cell=cell)
        stage.render()
        for i, j in ((0, 0), (3, 4), (7, 9), (9, 2)):
            across, down = pixel(stage, (i + 0.5) / 10, (j + 0.5) / 10)
            if 0 <= across < SIZE[0] and 0 <= down < SIZE[1]:
                assert stage.clicked(across, down) == {"cell": f"{i},{j}"}
    stage.camera.reset()
    stage.set(cell="")
    assert stage.clicked(2, 2) == {"cell": "", "case": "all"}
    stage.set(cell="3,4")
    assert stage.clicked(SIZE[0] - 12, 20) == {}            # on the card


def test_clicks_on_the_sheet(stage: Stage) -> None:
    """A case is shown on the board; beside the tiles every case is."""
    stage.set(view="cases")
    stage.render()
    for case in range(16):
        x, y = tile_corner(case)
        assert case_at((x + 0.1, y + 0.1)) == case
        assert stage.clicked(*pixel(stage, x + 0.12, y + 0.12)) == {"case": str(case), "view": "board"}
    assert stage.clicked(1, 1) == {"case": "all", "view": "board"}


def test_the_sheet_counts_what_is_there(stage: Stage) -> None:
    """The counts on the sheet are those of the kit's cases, and sum to all cells."""
    stage.set(view="cases")
    stage.render()
    counted = {}
    words = [label.text for label in stage.scene.labels()]
    for number, text in enumerate(words):
        if "=" in text:
            following = words[number + 1] if number + 1 < len(words) else ""
            counted[int(text.split(" =")[0])] = int(following[2:]) if following.startswith("×") else 0
    expected = np.bincount(cell_cases(samples(stage)).ravel(), minlength=16)
    assert [counted[case] for case in range(16)] == expected.tolist()
    assert sum(counted.values()) == 100


def test_one_case_alone(stage: Stage) -> None:
    """Only segments from cells of that case are drawn; the export has all of them, as the numbers do."""
    whole = len(stage.geometry()["segments"])
    cases = cell_cases(samples(stage))
    drawn = 0
    for case in range(16):
        stage.set(case=str(case))
        stage.render()
        count = stage.scene.count
        assert len(stage.geometry()["segments"]) == whole
        assert count == (cases == case).sum() * (2 if case in AMBIGUOUS else int(case not in (0, 15)))
        drawn += count
    assert drawn == whole


def test_the_walk_depends_on_the_frame_alone(stage: Stage) -> None:
    """The same picture forwards, backwards and in a new stage; at the end everything is done."""
    stage.set(walk=True, cells_per_second=10)
    counts, pictures = [], []
    for frame in (0, 200, 400, 599, 600, 900):
        stage.seek(frame)
        pictures.append(stage.pixels())
        counts.append(stage.scene.count)
        assert len(stage.geometry()["segments"]) == 32
    assert counts[0] == 0 and counts == sorted(counts) and counts[-1] == 32
    assert stage.scene.cell is None
    stage.seek(200)
    assert np.array_equal(stage.pixels(), pictures[1]) and stage.scene.cell == (3, 3)
    anew = viewer.render("marching_squares", 200, size=SIZE, params={"walk": True, "cells_per_second": 10})
    assert (np.abs(anew.astype(int) - pictures[1]).mean()) < 3          # that one has more samples


def test_refinement_depends_on_the_frame_alone(stage: Stage) -> None:
    """Twice as many cells every 90 frames, smaller errors, and from the start again."""
    stage.set(refine=True, resolution=5)
    seen, off = [], []
    for frame in range(0, 90 * 9 + 1, 90):
        stage.seek(frame)
        stage.render()
        seen.append(stage.scene.square.resolution)
        off.append(numbers(stage)["max_distance"])
    assert seen == [5, 10, 20, 40, 80, 160, 320, 320, 320, 5]
    assert all(later < 0.5 * earlier for earlier, later in pairwise(off[:7]))


def test_a_pole_draws_no_wall(stage: Stage) -> None:
    """Cut, counted and remarked on; kept on request. The true curve knows no wall either way."""
    stage.set(**POLE)
    read = numbers(stage)
    assert (read["segments"], read["curves"], read["jumps"]) == (0, 0, 10) and np.isnan(read["max_distance"])
    assert stage.remarks() == ["The function jumps through the level in 10 cells: no curve is drawn there."]
    with_curve = stage.pixels().astype(int)
    stage.set(true_curve=False)
    assert np.array_equal(with_curve, stage.pixels())
    stage.set(jumps="keep")
    read = numbers(stage)
    assert (read["segments"], read["curves"], read["jumps"]) == (10, 1, 10)
    stage.pixels()
    for steps in ("x > 0.47", "floor(5*x) - 2.5", "sign(x - 0.513) + y/3"):
        stage.set(formula=steps, level=0.5 if ">" in steps else 0.0, jumps="cut")
        assert numbers(stage)["segments"] == 0 and numbers(stage)["jumps"] > 0


@pytest.mark.parametrize("formula", [
    "log(x)", "sqrt(x - 0.5)", "1/x", "(x-x)/(y-y)", "exp(1000*x)", "tan(300*x)", "noise(9*x, 9*y, t)", "3", "x/0",
    "0*x", "x > y", "turbulence(4*x, 4*y) - 0.4", "abs(x - y)", "cbrt(x - 0.513)", "1e30*(x - y - 0.01)",
    "input*x - n*y", "z*x - 0.2"])
def test_any_formula_is_a_picture(stage: Stage, formula: str) -> None:
    """Without a value, without a curve, or wild: finite segments, numbers, and pixels."""
    stage.set(formula=formula, cell="4,5")
    stage.seek(20)
    assert np.isfinite(stage.geometry()["segments"]).all()
    read = numbers(stage)
    assert all(np.isfinite(value) for name, value in read.items() if not isinstance(value, (viewer.Curve, viewer.Table))
               and name != "max_distance")
    stage.pixels()
    json.dumps([str(remark) for remark in stage.remarks()])


def test_remarks(stage: Stage) -> None:
    """None as long as all is well; constants, levels out of reach and samples without a value are told."""
    assert stage.remarks() == []
    for values, words in (({"formula": "3"}, "The function is 3 everywhere: there is no curve."),
                          ({"formula": "x + y", "level": -1}, "The samples go from 0 to 2, all on one side of -1."),
                          ({"formula": "log(x) + 1", "level": 0}, 
                           "10 cells touch a sample without a value and yield nothing."),
                          ({"formula": "0/(0*x)"}, "The function has no value at any sample.")):
        stage.set(**values)
        assert stage.remarks()[0] == words


def test_cells_by_name(stage: Stage, capsys: pytest.CaptureFixture[str]) -> None:
    """Malformed ones are refused in one line; one outside the grid is told and not shown."""
    for name in ("3", "3,4,5", "a,b", "-1,2", "3;4", "1e3,2", "²,3"):
        with pytest.raises(viewer.ParameterError, match="is not written like 3,4"):
            viewer.render("marching_squares", size=SIZE, params={"cell": name})
    assert cli.main(["measure", "marching_squares", "--set", "cell=x"]) == 2
    assert capsys.readouterr().err == "error: cell = x is not written like 3,4\n"
    stage.set(cell=" 8, 9 ")
    stage.render()
    assert stage.scene.cell == (8, 9) and stage.remarks() == []
    stage.set(resolution=8)
    stage.render()
    assert stage.scene.cell is None and stage.remarks() == ["cell = 8, 9 is outside 0,0 to 7,7."]


def test_the_microscope_s_tables(stage: Stage) -> None:
    """Values from the grid, t = A / (A - B), and points on the exported segments."""
    stage.set(cell="4,5")
    read = numbers(stage)
    values = samples(stage)
    corners = read["cell"].records()
    assert [row["value"] for row in corners] == pytest.approx([values[4, 5], values[5, 5], values[4, 6], values[5, 6]])
    assert [row["sign"] for row in corners] == ["-", "+", "+", "-"]
    crossings = read["crossings"].records()
    assert [row["edge"] for row in crossings] == ["bottom", "right", "top", "left"]
    ends = stage.geometry()["segments"].reshape(-1, 2)
    for row in crossings:
        assert row["t"] == pytest.approx(row["A"] / (row["A"] - row["B"]))
        assert np.abs(ends - [row["x"], row["y"]]).max(axis=1).min() < 1e-6


def test_presets(stage: Stage) -> None:
    """All can be applied and drawn, and no two look alike."""
    presets = presets_for(Catalog().find("marching_squares"))
    assert len(presets) >= 12
    pictures = []
    for preset in presets:
        assert preset.title and preset.description.endswith(".")
        stage.apply_preset(preset)
        stage.seek(30)
        pictures.append(stage.pixels().tobytes())
    assert len(set(pictures)) == len(pictures)


@pytest.mark.parametrize(("name", "value"), [
    ("formula", "x - y + 0.03"), ("level", 0.05), ("resolution", 20), ("refine", True), ("saddle", "separate"),
    ("view", "cases"), ("show", "values"), ("show", "signs"), ("show", "cases"), ("show", "crossings"),
    ("true_curve", False), ("colouring", "viridis"), ("case", "3"), ("cell", "3,4"), ("walk", True)])
def test_every_parameter_shows(name: str, value: object) -> None:
    """A change of what one sees changes the picture."""
    one = viewer.render("marching_squares", 100, size=SIZE)
    other = viewer.render("marching_squares", 100, size=SIZE, params={name: value})
    assert (np.abs(one.astype(int) - other).max(axis=2) > 3).sum() > 20


@pytest.mark.parametrize("size", [(64, 48), (90, 200), (400, 90), (1, 1)])
def test_any_shape_of_picture(size: tuple[int, int]) -> None:
    """With the card beside, below, and in no room at all."""
    for values in ({}, {"cell": "4,5"}, {"view": "cases"}):
        assert viewer.render("marching_squares", size=size, params=values).shape == (size[1], size[0], 4)
