"""The marching cubes scene: surfaces in numbers, cells on their cards, clicks, volumes from files, and mistakes."""

from __future__ import annotations

import json
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import nrrd
import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

import viewer
from viewer import cli
from viewer.engine.catalog import Catalog
from viewer.engine.presets import presets_for
from viewer.engine.stage import Stage
from viewer.errors import DemoscopeError

pytestmark = pytest.mark.usefixtures("context")
Numbers = NDArray[np.float64]
SIZE = (160, 90)
N = 16                                                      # cells along each axis
SPHERE = "length(x, y, z) - 1"
TORUS = "length(length(x, y) - 0.9, z) - 0.4"
TANGLE = "16*(x^4 + y^4 + z^4) - 20*(x^2 + y^2 + z^2) + 11.8"
TWO = "min(length(x - 0.7, y, z), length(x + 0.7, y, z)) - 0.5"
SINES = "sin(waves*tau*x/3)*sin(waves*tau*y/3)*sin(waves*tau*z/3) - 0.05"
PRESETS = presets_for(Catalog().find("marching_cubes"))


@pytest.fixture
def stage() -> Iterator[Stage]:
    """The scene as it comes, but small and coarse."""
    with viewer.headless("marching_cubes", size=SIZE, samples=0, params={"resolution": N}) as made:
        yield made


def numbers(stage: Stage) -> dict[str, Any]:
    """What the scene measures."""
    return dict(stage.measure())


def words(stage: Stage) -> list[str]:
    """What stands in the picture."""
    stage.render()
    return [label.text for label in stage.scene.labels()]


def plain(text: str) -> float:
    """A number as it stands in the picture."""
    return float(text.replace("\u2212", "-"))


def changed(one: NDArray[np.uint8], other: NDArray[np.uint8]) -> NDArray[np.bool_]:
    """Where two pictures differ visibly."""
    return np.asarray(np.abs(one.astype(int) - other).max(axis=2) > 3)


# Surfaces in numbers

def test_an_exported_sphere_is_one(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Closed, manifold, of Euler characteristic 2, and within a thousandth of its area."""
    file = tmp_path / "sphere.ply"
    words = ["export", "marching_cubes", "--set", f"formula={SPHERE}", "--set", "resolution=64", "--out", str(file)]
    assert cli.main(words) == 0
    assert capsys.readouterr().err == ""
    mesh = trimesh.load_mesh(file, process=False)
    assert mesh.is_watertight and mesh.is_winding_consistent and mesh.volume > 0
    edges = np.sort(mesh.edges, axis=1)
    assert set(np.unique(edges, axis=0, return_counts=True)[1]) == {2}
    assert mesh.euler_number == 2 and mesh.body_count == 1
    assert mesh.area == pytest.approx(4 * np.pi, rel=1e-3)
    assert np.abs(np.linalg.norm(mesh.vertices, axis=1) - 1).max() < 1e-3
    assert np.abs(mesh.vertex_normals - mesh.vertices).max() < 0.02


@pytest.mark.parametrize("method", ["cubes", "tetrahedra"])
@pytest.mark.parametrize(("formula", "euler", "components", "area", "volume"), [
    (SPHERE, 2, 1, 4 * np.pi, 4 / 3 * np.pi),
    (TORUS, 0, 1, 4 * np.pi ** 2 * 0.9 * 0.4, 2 * np.pi ** 2 * 0.9 * 0.4 ** 2),
    (TANGLE, -8, 1, None, None), (TWO, 4, 2, 2 * np.pi, np.pi / 3)])
def test_surfaces_in_numbers(stage: Stage, method: str, formula: str, euler: int, components: int,
                             area: float | None, volume: float | None) -> None:
    """Shape in the large, area and volume by their closed forms."""
    stage.set(formula=formula, method=method, resolution=40)
    read = numbers(stage)
    assert list(read) == ["vertices", "triangles", "euler_characteristic", "components", "area", "volume",
                          "active_cells", "ambiguous_faces", "jumps", "evaluate_ms", "extract_ms"]
    assert (read["euler_characteristic"], read["components"], read["jumps"]) == (euler, components, 0)
    if area and volume:
        assert (read["area"], read["volume"]) == pytest.approx((area, volume), rel=0.02)
    mesh = stage.geometry()
    assert (read["vertices"], read["triangles"]) == (len(mesh["vertices"]), len(mesh["triangles"]))
    assert 0 < read["active_cells"] < read["triangles"]
    assert read["evaluate_ms"] > 0 and read["extract_ms"] > 0


def test_ambiguous_faces_and_what_is_decided_about_them(stage: Stage) -> None:
    """A product of two waves a side has 32 bubbles; parted by the table some run together, decided none does."""
    stage.set(formula=SINES, waves=2, resolution=11)
    table = numbers(stage)
    assert table["ambiguous_faces"] > 100 and table["components"] < 32
    stage.set(topology="trilinear")
    decided = numbers(stage)
    assert decided["components"] == 32 and decided["euler_characteristic"] == 64
    assert decided["ambiguous_faces"] == table["ambiguous_faces"]
    stage.set(formula=TANGLE)
    assert numbers(stage)["ambiguous_faces"] == 0
    stage.set(method="tetrahedra")                          # nothing to decide, and nothing said about it
    assert stage.remarks() == [] and numbers(stage)["euler_characteristic"] == -8


def test_a_surface_that_moves(stage: Stage) -> None:
    """With t in its formula, picture, geometry and numbers follow the frame, there and back."""
    stage.set(formula="length(x, y, z) - 0.5 - 0.25*t", resolution=24)
    seen = {}
    for frame in (0, 60, 120, 60, 0):
        stage.seek(frame)
        radius = 0.5 + 0.25 * frame / 60
        assert numbers(stage)["area"] == pytest.approx(4 * np.pi * radius ** 2, rel=0.02)
        assert np.linalg.norm(stage.geometry()["vertices"], axis=1) == pytest.approx(radius, abs=0.01)
        assert np.array_equal(seen.setdefault(frame, stage.pixels()), stage.pixels())
    assert not np.array_equal(seen[0], seen[60])


# The picture

def test_every_preset_is_a_surface() -> None:
    """Each file can be read, is drawn, and is as it should be: no remark but about the pole."""
    folder = Path(__file__).parents[2] / "assets" / "presets" / "marching_cubes"
    assert len(PRESETS) == len(list(folder.glob("*.toml"))) >= 12
    pictures = set()
    for preset in PRESETS:
        with viewer.headless("marching_cubes", size=(48, 27), samples=0, preset=preset.name) as stage:
            stage.set(resolution=min(stage.params.resolution, 32))
            pictures.add(stage.pixels().tobytes())
            remarks = stage.remarks()
            assert bool(remarks) == (preset.name == "pole"), (preset.name, remarks)
            assert len(stage.geometry()["triangles"]) > 100, preset.name
        assert preset.title and preset.description.endswith((".", "?")), preset.name
    assert len(pictures) == len(PRESETS)


@pytest.mark.parametrize(("values", "name", "value"), [
    ({}, "formula", SPHERE), ({}, "level", 2.0), ({}, "resolution", 9), ({}, "extent", 1.3),
    ({}, "method", "tetrahedra"), ({"formula": SINES, "waves": 2, "resolution": 11}, "topology", "trilinear"),
    ({}, "view", "compare"), ({}, "view", "cases"), ({}, "colouring", "normal"), ({}, "colouring", "curvature"),
    ({}, "colouring", "case"), ({}, "colouring", "difference"), ({}, "color", "#0000ff"),
    ({"colouring": "curvature"}, "curvature_scale", 30.0), ({}, "wireframe", True), ({}, "case", 15),
    ({"colouring": "difference", "formula": SINES}, "difference_scale", 0.3),
    ({}, "slice", "x"), ({"slice": "x"}, "slice", "y"), ({"slice": "x"}, "slice", "z"),
    ({"slice": "x"}, "slice_at", 0.3), ({"slice": "x"}, "slice_range", 40.0),
    ({"formula": "1/(x - 0.013)"}, "jumps", "keep"), ({"formula": "1/(x - 0.013)"}, "marks", False),
    ({}, "cell", "11,10,13"), ({}, "walk", True)])
def test_every_parameter_shows(stage: Stage, values: dict[str, object], name: str, value: object) -> None:
    """A change of what one sees changes the picture; undone, it is the same again."""
    stage.seek(30)
    stage.set(**values)
    before = stage.pixels()
    was = stage.params.stored()[name]
    stage.set(**{name: value})
    assert changed(before, stage.pixels()).sum() > 40
    stage.set(**{name: was})
    assert np.array_equal(before, stage.pixels())


def test_a_wireframe_darkens_lines(stage: Stage) -> None:
    """On the surface only, in lines, and without moving it."""
    stage.resize((320, 180))
    smooth = stage.pixels().astype(int).sum(axis=2)
    stage.set(wireframe=True)
    wired = stage.pixels().astype(int).sum(axis=2)
    darker = smooth - wired > 60
    assert 0.01 < darker.mean() < 0.2
    assert (wired - smooth).max() < 6


def test_a_slice_cuts_what_lies_beyond(stage: Stage) -> None:
    """Nothing of the near half is left before the plane, which is coloured by how far inside each sample is."""
    stage.set(formula=SPHERE, slice="x", slice_range=1.0)
    stage.camera.stand({"yaw": 90.0, "pitch": 0.0, "distance": 5.0})
    shown = stage.pixels()
    brightness = []
    for place in ((0.0, 0.0, 0.0), (0.0, 0.45, 0.3), (0.0, 0.75, -0.9), (0.0, 1.3, 1.3)):
        across, down = pixel(stage, np.array(place) / 1.5)
        brightness.append(int(shown[int(down), int(across), :3].sum()))
    assert brightness == sorted(set(brightness))            # viridis grows brighter outwards
    stage.set(color="#0000ff")
    assert np.array_equal(stage.pixels(), shown)            # the far half is hidden
    stage.set(slice_at=0.99)
    assert changed(shown, stage.pixels()).sum() > 200
    whole = numbers(stage)
    stage.set(slice="none")
    assert {**numbers(stage), "evaluate_ms": 0, "extract_ms": 0} == {**whole, "evaluate_ms": 0, "extract_ms": 0}


@pytest.mark.parametrize(("values", "expected"), [
    ({}, None), ({"colouring": "normal"}, None), ({"colouring": "curvature", "curvature_scale": 7}, (-7, 7)),
    ({"colouring": "difference", "difference_scale": 0.5}, (0, 0.5)), ({"slice": "z", "slice_range": 9}, (-9, 9)),
    ({"slice": "z", "slice_range": 9, "colouring": "curvature"}, (-9, 9)), ({"view": "cases", "slice": "x"}, None)])
def test_colour_scales(stage: Stage, values: dict[str, object], expected: tuple[float, float] | None) -> None:
    """Their ends are the parameters'; without numbers in the colours there is none."""
    stage.set(**values)
    scale = stage.color_scale()
    assert (scale and (scale.low, scale.high)) == expected
    assert scale is None or scale.title


def test_both_methods_side_by_side(stage: Stage) -> None:
    """Each under its name with its count, cubes at the left whichever is chosen; counts again in a table."""
    stage.set(view="compare")
    shown, labels = stage.pixels(), words(stage)
    rows = numbers(stage)["comparison"].records()
    assert [row["method"] for row in rows] == ["cubes", "tetrahedra"]
    assert labels == [f"{row['method']}\n{row['triangles']:,} triangles".replace(",", "\u2009") for row in rows]
    for row in rows:
        stage.set(view="surface", method=row["method"])
        assert (row["triangles"], row["vertices"]) == tuple(numbers(stage)[name] for name in ("triangles", "vertices"))
    stage.set(view="compare")                               # with tetrahedra chosen now
    assert np.array_equal(stage.pixels(), shown)
    assert [row["method"] for row in numbers(stage)["comparison"].records()] == ["cubes", "tetrahedra"]
    stage.set(walk=True)                                    # which is for one surface alone
    assert np.array_equal(stage.pixels(), shown)
    stage.set(walk=False, resolution=8)
    stage.resize((320, 180))
    smooth = stage.pixels()
    stage.set(wireframe=True)
    lines = changed(stage.pixels(), smooth)[:140]           # above the labels
    assert lines[:, 160:].sum() > 1.1 * lines[:, :160].sum() > 100      # more triangles, more lines


# Cells

def pixel(stage: Stage, place: Numbers) -> tuple[float, float]:
    """Where a place of the world is in the picture, from its upper left corner."""
    width, height = stage.size
    clip = np.append(place, 1.0) @ stage.camera.view() @ stage.camera.projection(width / height, stage.scene.middle())
    return (clip[0] / clip[3] + 1) / 2 * width, (1 - clip[1] / clip[3]) / 2 * height


def cell_seen(stage: Stage, across: float, down: float) -> str:
    """The cell of the triangle that, projected, covers a place in the picture and is nearest there."""
    width, height = stage.size
    mesh, lattice = stage.geometry(), stage.scene.samples.lattice
    corner, step = np.array(lattice.corner), np.array(lattice.step)
    reach = step * (np.array(lattice.samples) - 1) / 2
    vertices = mesh["vertices"].astype(np.float64)
    world = np.hstack([(vertices - corner - reach) / reach.max(), np.ones((len(vertices), 1))])
    clip = world @ stage.camera.view() @ stage.camera.projection(width / height, stage.scene.middle())
    flat = np.stack([(clip[:, 0] / clip[:, 3] + 1) / 2 * width, (1 - clip[:, 1] / clip[:, 3]) / 2 * height], axis=1)
    a, b, c = (flat[mesh["triangles"][:, corner]] - (across, down) for corner in range(3))
    cross = [one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0] for one, other in ((b, c), (c, a), (a, b))]
    weights = np.stack(cross, axis=1) / np.sum(cross, axis=0)[:, None]
    covers = np.flatnonzero((weights >= 0).all(axis=1))
    if not len(covers):
        return ""
    nearness = (weights * (1 / clip[:, 3])[mesh["triangles"]]).sum(axis=1)      # 1/w is linear in the picture
    triangle = mesh["triangles"][covers[np.argmax(nearness[covers])]]
    i, j, k = np.floor((vertices[triangle].mean(axis=0) - corner) / step).astype(int)
    return f"{i},{j},{k}"


@pytest.mark.parametrize("values", [{}, {"method": "tetrahedra", "extent": 2.0}, {"resolution": 9},
                                    {"formula": SINES, "waves": 2, "resolution": 11, "topology": "trilinear"}])
@pytest.mark.parametrize("camera", [{}, {"yaw": -70.0, "pitch": 50.0, "distance": 3.0}])
def test_a_click_chooses_the_cell_that_one_sees(stage: Stage, values: dict[str, object],
                                                camera: dict[str, float]) -> None:
    """The one whose triangle is nearest under the pixel, not merely on the way; the background clears."""
    stage.set(**values)
    stage.camera.stand(camera)
    found = 0
    for across in np.linspace(0.5, 159.5, 9):
        for down in np.linspace(0.5, 89.5, 6):
            seen = cell_seen(stage, across, down)
            assert stage.clicked(across, down) == {"cell": seen}
            found += bool(seen)
    assert 3 < found < 54


def test_a_click_beside_the_card(stage: Stage) -> None:
    """With a card open the surface stands aside, and so do clicks; on the card they mean nothing."""
    stage.set(cell="11,10,13")
    stage.render()
    seen = {cell_seen(stage, across, 45.0) for across in range(4, 80, 6)}
    for across in range(4, 80, 6):
        assert stage.clicked(across, 45.0) == {"cell": cell_seen(stage, across, 45.0)}
    assert len(seen) > 5
    assert stage.clicked(130, 45) == {}
    stage.set(walk=True, cell="")
    assert stage.clicked(20, 45) == {}


def test_a_click_with_a_slice(stage: Stage) -> None:
    """What is cut away is not there: the plane's own cells are seen from before it, the rest from behind."""
    stage.set(formula=SPHERE, slice="x", slice_at=0.25)     # at sample 10
    stage.camera.stand({"yaw": 90.0, "pitch": 0.0})
    stage.render()
    for j, k in ((8, 8), (3, 5), (14, 1), (0, 15), (10, 2)):
        place = np.array([0.25, (j + 0.4) / 8 - 1, (k + 0.6) / 8 - 1])
        assert stage.clicked(*pixel(stage, place)) == {"cell": f"9,{j},{k}"}
    assert stage.clicked(1, 1) == {"cell": ""}
    stage.camera.stand({"yaw": -90.0, "pitch": 0.0})
    stage.render()
    for y, z in ((0.0, 0.0), (0.3, -0.2), (-0.4, 0.35)):
        across, down = pixel(stage, np.array([-np.sqrt(1 - y * y - z * z), y, z]) / 1.5)
        assert stage.clicked(across, down) == {"cell": cell_seen(stage, across, down)}
    assert stage.clicked(*pixel(stage, np.array([0.25, 0.9, 0.9]))) == {"cell": "9,15,15"}      # past the sphere
    stage.set(slice_at=-0.375)                              # at sample 5; what lies behind it is cut away
    stage.render()
    assert stage.clicked(*pixel(stage, np.array([-0.375, 0.58, 0.1]))) == {"cell": "4,12,8"}


@pytest.mark.parametrize(("method", "topology"), [("cubes", "table"), ("cubes", "trilinear"), ("tetrahedra", "table")])
def test_the_microscope_says_how_it_comes_about(stage: Stage, method: str, topology: str) -> None:
    """The case in binary from the corners' signs, and t = A / (A - B) from the corners' values."""
    stage.set(cell="11,10,13", method=method, topology=topology)
    step = 3 / N
    corners = np.array([11, 10, 13]) + [[c >> axis & 1 for axis in range(3)] for c in range(8)]
    x, y, z = corners.T * step - 1.5
    values = 16 * (x**4 + y**4 + z**4) - 20 * (x**2 + y**2 + z**2) + 11.8
    case = sum(1 << corner for corner in range(8) if values[corner] < 0)
    said = words(stage)
    assert said[0] == "Cell 11, 10, 13"
    assert said[1].startswith(f"case {case} = {case:08b} in binary: ")
    written = dict(text.split(":") for text in said if text[1:3] == ": ")
    assert [plain(written[str(corner)]) for corner in range(8)] == pytest.approx(values, rel=6e-3)
    read = numbers(stage)
    assert [row["value"] for row in read["cell_corners"].records()] == pytest.approx(values, abs=2e-4)
    assert [row["sign"] == "inside" for row in read["cell_corners"].records()] == (values < 0).tolist()
    crossings = read["cell_crossings"].records()
    assert len(crossings) == (4 if method == "cubes" else 9)
    for row in crossings:
        one, other = (int(end) for end in row["edge"].split("-"))
        assert (values[one] < 0) != (values[other] < 0)
        assert (row["A"], row["B"]) == pytest.approx((values[one], values[other]), abs=2e-4)
        assert row["t"] == pytest.approx(values[one] / (values[one] - values[other]), abs=1e-4)
        assert f"{row['t']:.3f}" in said[said.index(row["edge"]):]
    assert len(stage.scene.inspector.card.model.arrays()[2]) > 0


def test_cells_by_name(stage: Stage, capsys: pytest.CaptureFixture[str]) -> None:
    """Malformed ones are refused in one line; one outside the grid is told and not shown; an empty one is a cell."""
    for name in ("3", "3,4", "a,b,c", "-1,2,3", "1;2;3"):
        assert cli.main(["measure", "marching_cubes", "--set", f"cell={name}"]) == 2
        assert capsys.readouterr().err == f"error: cell = {name} is not written like 3,0,7\n"
    stage.set(cell=f" {N - 1} , 0,0")
    assert words(stage)[1] == "case 0 = 00000000 in binary: 0 triangles" and stage.remarks() == []
    for outside in (f"{N},0,0", f"0,{N},0", f"0,0,{N}", "999999,0,0"):
        stage.set(cell=outside)
        assert words(stage) == [] and "cell_corners" not in numbers(stage)
        assert stage.remarks() == [f"Cell {outside} is outside the grid: 0,0,0 to 15,15,15."]
    stage.set(view="compare")
    assert stage.remarks() == []


def test_the_walk_is_a_function_of_the_frame(stage: Stage, monkeypatch: pytest.MonkeyPatch) -> None:
    """Cell after cell, x fastest; what has been visited is drawn; the same picture however one gets there."""
    stage.set(walk=True, cells_per_second=120.0, formula=SPHERE)
    array = stage.scene.smooth[stage.scene.surface]
    drawn: list[int] = []
    cells, counts, pictures = [], [], {}
    for frame in (0, 1, 2, 50, 100, 200, 10_000):
        stage.seek(frame)
        pictures[frame] = stage.pixels()
        cells.append(stage.scene.chosen_cell())
        with monkeypatch.context() as spying:
            spying.setattr(array, "render", lambda vertices: drawn.append(vertices))
            stage.scene.draw()
        counts.append(drawn[-1] // 3)
        owners = np.floor((stage.geometry()["vertices"][stage.geometry()["triangles"]].mean(axis=1) + 1.5) * N / 3)
        before = [tuple(owner[::-1]) <= cells[-1][::-1] for owner in owners.astype(int).tolist()]
        assert counts[-1] == sum(before) and all(before[:counts[-1]])
    orders = [(z, y, x) for x, y, z in cells]
    assert all(one < other for one, other in pairwise(orders))
    assert all(one < other for one, other in pairwise(counts))
    assert counts[-1] == numbers(stage)["triangles"]
    active = numbers(stage)["active_cells"]
    assert words(stage)[0] == "Cell {}, {}, {}   ({} of {})".format(*cells[-1], active, active)
    for frame in (100, 2, 200, 0):
        stage.seek(frame)
        assert np.array_equal(stage.pixels(), pictures[frame])
    assert len({picture.tobytes() for picture in pictures.values()}) == len(pictures)


@pytest.mark.parametrize("size", [(160, 90), (90, 120)])
def test_clicks_on_the_sheet(stage: Stage, size: tuple[int, int]) -> None:
    """A case's tile chooses it, once more clears it, and so does the space beside the tiles."""
    stage.resize(size)
    stage.set(view="cases")
    for case in (0, 1, 15, 90, 128, 255):
        stage.render()
        across, up, _ = stage.scene.inspector.card.frames[case]
        at = (across + 1) / 2 * size[0], (1 - up) / 2 * size[1]
        assert stage.clicked(*at) == {"case": case}
        stage.set(case=case)
        stage.render()
        across, up, _ = stage.scene.inspector.card.frames[case]       # the tiles make room for the chosen one
        assert stage.clicked((across + 1) / 2 * size[0], (1 - up) / 2 * size[1]) == {"case": -1}
        stage.set(case=-1)
    assert stage.clicked(0.5, 0.5) == {"case": -1}


def test_the_sheet_counts_the_cases(stage: Stage) -> None:
    """How many there are and how often the chosen one is, from the signs of the samples."""
    axis = np.linspace(-1.5, 1.5, N + 1)
    x, y, z = np.meshgrid(axis, axis, axis, indexing="ij")
    inside = 16 * (x**4 + y**4 + z**4) - 20 * (x**2 + y**2 + z**2) + 11.8 < 0
    cases = sum(inside[c & 1:N + (c & 1), c >> 1 & 1:N + (c >> 1 & 1), c >> 2:N + (c >> 2)].astype(int) << c
                for c in range(8))
    counts = np.bincount(cases.ravel(), minlength=256)
    counts[[0, 255]] = 0
    stage.set(view="cases", case=15)
    said = words(stage)
    assert said[0] == f"Cubes: 256 cases, {(counts > 0).sum()} of them in this surface"
    assert said[-5:] == ["Case 15", "00001111 in binary, corner 7 first", "triangles: 2", "ambiguous faces: 0",
                         f"cells of this surface: {counts[15]}"]
    assert "255" in said


# What is unusual

@pytest.mark.parametrize(("formula", "level", "remarks"), [
    ("1/(x - 0.013)", 0, ["The function crosses the level only where it jumps or has no value: there is no surface.",
                          "The function jumps over the level on 100 edges; the cells there yield nothing."]),
    ("log(x) + 0.5", 0, ["50 % of the samples have no value; the cells that touch them yield nothing."]),
    ("3", 0, ["The function is 3 everywhere: there is no surface."]),
    ("x + y", 7, ["No surface at level 7: the function lies between \u22123 and 3."]),
    ("(x - x)/(y - y)", 0, ["The function has no value at any sample: there is no surface.",
                            "100 % of the samples have no value; the cells that touch them yield nothing."]),
    (SPHERE, 0, [])])
def test_remarks(capsys: pytest.CaptureFixture[str], formula: str, level: float, remarks: list[str]) -> None:
    """As notes beside a result that is none the worse; a surface as expected has none."""
    assert cli.main(["measure", "marching_cubes", "--set", f"formula={formula}", "--set", f"level={level}", "--set",
                     "resolution=9"]) == 0
    printed = capsys.readouterr()
    assert printed.err.splitlines() == [f"note: {remark}" for remark in remarks]
    read = json.loads(printed.out)
    assert bool(read["triangles"]) == (formula in (SPHERE, "log(x) + 0.5"))


def test_a_jump_can_be_kept(stage: Stage) -> None:
    """Then there is a wall, nothing is counted and nothing said; dots mark the cells that are cut."""
    stage.set(formula="1/(x - 0.013)")
    assert numbers(stage)["jumps"] == (N + 1) ** 2 and not numbers(stage)["triangles"]
    marked = stage.pixels()
    stage.set(marks=False)
    purple = marked[changed(marked, stage.pixels())].astype(int)
    assert len(purple) > 40 and (purple[:, 0] > purple[:, 1] + 20).mean() > 0.8
    stage.set(jumps="keep")
    assert numbers(stage)["jumps"] == 0 and numbers(stage)["triangles"] == 2 * N ** 2
    assert stage.remarks() == []


@pytest.mark.parametrize("formula", ["exp(1000*x)", "1e30*(x - y)", "0*x", "x/0", "tan(300*x)", "sqrt(x - 0.5) + y",
                                     "noise(9*x, 9*y, t)", "1 if x > y else z", "cbrt(x*y*z)"])
def test_any_formula_is_a_picture(stage: Stage, formula: str) -> None:
    """In every view: finite geometry, pixels, and words."""
    stage.set(formula=formula, resolution=8, cell="3,4,5")
    for values in ({}, {"method": "tetrahedra"}, {"view": "compare", "colouring": "difference"}, {"view": "cases"},
                   {"view": "surface", "method": "cubes", "topology": "trilinear", "colouring": "curvature",
                    "slice": "y"}):
        stage.set(**values)
        stage.pixels()
        mesh = stage.geometry()
        assert np.isfinite(mesh["vertices"]).all() and np.isfinite(mesh["normals"]).all()
        assert all(isinstance(remark, str) for remark in stage.remarks())
        json.dumps([row for table in numbers(stage).values() if isinstance(table, viewer.Table) for row in
                    table.records()])


def test_a_formula_that_is_wrong_leaves_everything(stage: Stage) -> None:
    """Values, numbers and picture; the next right one goes on."""
    before, read = stage.pixels(), numbers(stage)
    for wrong in ("sine(x)", "x +", "x" * 3000, ""):
        with pytest.raises(DemoscopeError):
            stage.set(formula=wrong, level=1.0)
        assert stage.params.formula.text == TANGLE and stage.params.level == 0.0
        assert np.array_equal(stage.pixels(), before) and numbers(stage)["area"] == read["area"]
    stage.set(formula=SPHERE)
    assert numbers(stage)["euler_characteristic"] == 2


def test_captures_are_byte_identical(tmp_path: Path) -> None:
    """Whatever the time it takes and whatever the seed."""
    taken = []
    for folder, seed in (("one", "0"), ("two", "0"), ("three", "5")):
        for preset in ("sphere", "sponge"):
            assert cli.main(["capture", "marching_cubes", "--preset", preset, "--set", "resolution=20", "--set",
                             "cell=9,9,9", "--frames", "0,30", "--size", "80x60", "--seed", seed, "--out",
                             str(tmp_path / folder / preset)]) == 0
        taken.append([file.read_bytes() for file in sorted((tmp_path / folder).rglob("*.png"))])
    assert len(taken[0]) == 4 and taken[0] == taken[1] == taken[2]


# Volumes

def ellipsoid(shape: tuple[int, int, int], spacing: tuple[float, float, float], axes: Numbers) -> Numbers:
    """1000 at an ellipsoid in the middle of the grid, less inside."""
    places = [(np.arange(count) - (count - 1) / 2) * step for count, step in zip(shape, spacing, strict=True)]
    x, y, z = np.meshgrid(*places, indexing="ij")
    return np.asarray(1000 * np.sqrt((x / axes[0])**2 + (y / axes[1])**2 + (z / axes[2])**2))


def ellipsoid_area(axes: Numbers) -> float:
    """By the midpoint rule over the sphere's latitude and longitude."""
    a, b, c = axes
    u, v = np.meshgrid((np.arange(400) + 0.5) * np.pi / 400, (np.arange(400) + 0.5) * np.pi / 200)
    normal = b * c * np.sin(u) * np.cos(v), a * c * np.sin(u) * np.sin(v), a * b * np.cos(u)
    return float((np.sqrt(sum(part**2 for part in normal)) * np.sin(u)).sum() * np.pi / 400 * np.pi / 200)


def measured(capsys: pytest.CaptureFixture[str], file: Path, **values: object) -> dict[str, Any]:
    """What the command line measures of a volume."""
    values = {"source": "volume", "volume": file, **values}
    chosen = [word for name, value in values.items() for word in ("--set", f"{name}={value}")]
    assert cli.main(["measure", "marching_cubes", *chosen]) == 0
    printed = capsys.readouterr()
    assert printed.err == ""
    return dict(json.loads(printed.out))


@pytest.mark.parametrize("topology", ["table", "trilinear"])
def test_a_volume_of_whole_numbers(tmp_path: Path, capsys: pytest.CaptureFixture[str], topology: str) -> None:
    """Sides of different lengths, samples one apart: an ellipsoid, closed and of its size."""
    axes = np.array([16.0, 12.0, 7.0])
    np.save(tmp_path / "stone.npy", np.round(ellipsoid((40, 31, 18), (1.0, 1.0, 1.0), axes)).astype(np.int16))
    read = measured(capsys, tmp_path / "stone.npy", level=1000, topology=topology)
    assert (read["euler_characteristic"], read["components"]) == (2, 1)
    assert read["area"] == pytest.approx(ellipsoid_area(axes), rel=0.01)
    assert read["volume"] == pytest.approx(4 / 3 * np.pi * axes.prod(), rel=0.01)


@pytest.mark.parametrize(("method", "topology"), [("cubes", "table"), ("cubes", "trilinear"), ("tetrahedra", "table")])
def test_a_volume_with_spacings(tmp_path: Path, capsys: pytest.CaptureFixture[str], method: str, topology: str) -> None:
    """In the file's own unit, along the right axes; turned inside out it is as large."""
    spacing, axes = (0.5, 1.0, 2.0), np.array([8.0, 13.0, 16.0])
    values = ellipsoid((40, 31, 20), spacing, axes).astype(np.float32)
    for name, sign in (("stone", 1), ("hollow", -1)):
        nrrd.write(str(tmp_path / f"{name}.nrrd"), sign * values, {"spacings": list(spacing)})
        read = measured(capsys, tmp_path / f"{name}.nrrd", level=sign * 1000, method=method,
                        topology=topology)
        assert read["euler_characteristic"] == 2
        assert read["area"] == pytest.approx(ellipsoid_area(axes), rel=0.01)
        assert read["volume"] == pytest.approx(4 / 3 * np.pi * axes.prod(), rel=0.01)
    file = tmp_path / "stone.ply"
    assert cli.main(["export", "marching_cubes", "--set", "source=volume", "--set",
                     f"volume={tmp_path / 'stone.nrrd'}", "--set", "level=1000", "--out", str(file)]) == 0
    sides = np.ptp(trimesh.load_mesh(file, process=False).vertices, axis=0)
    assert sides == pytest.approx(2 * axes, rel=0.01)


def test_a_volume_offers_its_range(tmp_path: Path, stage: Stage) -> None:
    """The level's slider runs over its values; its cells are those of the file; without one a choice is asked for."""
    stage.set(source="volume")
    assert stage.remarks() == ["Choose a volume: a file of samples, NumPy or NRRD."]
    assert numbers(stage)["triangles"] == 0
    stage.pixels()
    values = ellipsoid((9, 8, 7), (1.0, 1.0, 1.0), np.array([3.0, 3.0, 2.5])).astype(np.float32)
    values[0, 0, 0] = np.nan
    np.save(tmp_path / "stone.npy", values)
    stage.set(volume=tmp_path / "stone.npy", level=1000.0, cell="5,2,3")
    assert stage.params.offered("level").widget_range == pytest.approx((np.nanmin(values), np.nanmax(values)))
    assert stage.remarks() == ["less than 1 % of the samples have no value; the cells that touch them yield nothing."]
    corners = [values[5 + (c & 1), 2 + (c >> 1 & 1), 3 + (c >> 2)] - 1000 for c in range(8)]
    assert [row["value"] for row in numbers(stage)["cell_corners"].records()] == pytest.approx(corners, abs=1e-3)
    stage.set(cell="8,0,0")
    assert stage.remarks()[-1] == "Cell 8,0,0 is outside the grid: 0,0,0 to 7,6,5."
    stage.set(cell="", level=-50.0)
    assert stage.remarks()[0].startswith("No surface at level \u221250: the volume lies between ")
    stage.set(source="formula", level=0.0)
    assert numbers(stage)["euler_characteristic"] == -8


def test_clicks_on_a_volume(tmp_path: Path, stage: Stage) -> None:
    """Cells that are longer than wide, in a grid that does not start in the middle, are found as they are seen."""
    values = ellipsoid((12, 31, 9), (2.0, 0.5, 1.0), np.array([8.0, 5.0, 3.0])).astype(np.float32)
    nrrd.write(str(tmp_path / "stone.nrrd"), values, {"spacings": [2.0, 0.5, 1.0]})
    stage.set(source="volume", volume=tmp_path / "stone.nrrd", level=1000)
    seen = {}
    for across in np.linspace(60.5, 99.5, 8):
        for down in np.linspace(30.5, 59.5, 5):
            seen[across, down] = cell_seen(stage, across, down)
            assert stage.clicked(across, down) == {"cell": seen[across, down]}
    assert len(set(seen.values())) > 12


def test_changes_arrive_as_in_a_new_scene(stage: Stage) -> None:
    """Changed one after the other in a live stage, or there from the start: the same picture."""
    values: dict[str, object] = {"resolution": 11, "formula": SINES, "waves": 2.0}
    for name, value in (("colouring", "curvature"), ("topology", "trilinear"), ("level", 0.1), ("method", "tetrahedra"),
                        ("view", "compare"), ("colouring", "difference"), ("view", "cases"), ("view", "surface"),
                        ("walk", True), ("method", "cubes"), ("walk", False), ("case", 90)):
        values[name] = value
        stage.set(**values)
        fresh = viewer.render("marching_cubes", size=SIZE, samples=0, params=values)
        assert np.array_equal(stage.pixels(), fresh), name


def bad_volumes(folder: Path) -> dict[str, Path]:
    """Files that are no volumes, by what is wrong with them."""
    good = np.arange(64, dtype=np.float32).reshape(4, 4, 4)
    wrong = {"flat": good[0], "complex": good.astype(complex), "objects": np.full((2, 2, 2), None), "thin": good[:1],
             "hollow": np.full((4, 4, 4), np.nan)}
    for name, array in wrong.items():
        np.save(folder / f"{name}.npy", array)
    np.save(folder / "good.npy", good)
    whole = (folder / "good.npy").read_bytes()
    (folder / "truncated.npy").write_bytes(whole[:-9])
    (folder / "truncated.nrrd").write_bytes(b"NRRD0004\ntype: float\ndimension: 3\nsizes: 4 4 4\nencoding: raw\n"
                                            b"endian: little\n\n" + bytes(99))
    (folder / "empty.npy").touch()
    names = [*(f"{name}.npy" for name in wrong), "truncated.npy", "truncated.nrrd", "empty.npy", "missing.npy"]
    return {name: folder / name for name in names}


def test_what_is_no_volume_is_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Naming the file, status 2, and no traceback."""
    for file in bad_volumes(tmp_path).values():
        assert cli.main(["capture", "marching_cubes", "--set", "source=volume", "--set", f"volume={file}", "--size",
                         "8x8", "--out", str(tmp_path)]) == 2
        printed = capsys.readouterr()
        assert printed.out == "" and printed.err.count("\n") == 1, file
        assert printed.err.startswith("error: volume"), printed.err
        assert str(file) in printed.err or printed.err.endswith(" is not a file that exists\n")
    assert not list(tmp_path.glob("*.png"))


def test_what_is_no_volume_leaves_the_last_one(tmp_path: Path, stage: Stage) -> None:
    """Picture, parameters and numbers of a live stage stay, and it goes on."""
    bad = bad_volumes(tmp_path)
    stage.set(source="volume", volume=tmp_path / "good.npy", level=30.5)
    before, values, read = stage.pixels(), stage.params.stored(), numbers(stage)
    assert read["triangles"] > 0
    for file in bad.values():
        with pytest.raises(DemoscopeError, match="volume"):
            stage.set(volume=file, level=7.0)
        assert stage.params.stored() == values
        assert np.array_equal(stage.pixels(), before)
        assert numbers(stage)["area"] == read["area"]
    stage.set(level=7.0)
    assert numbers(stage)["triangles"] > 0 and not np.array_equal(stage.pixels(), before)
