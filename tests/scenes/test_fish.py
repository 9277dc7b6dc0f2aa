"""The fish: what its motion has to keep, measured from exported frames; its pictures, its school and its bad values."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Iterator
from itertools import product
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import moderngl
import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

import viewer
from viewer import cli
from viewer.engine.catalog import Catalog
from viewer.engine.fish import look, model
from viewer.engine.fish.look import FishLookParameters
from viewer.engine.presets import presets_for
from viewer.engine.program import VertexArray
from viewer.engine.underwater import WaterParameters
from viewer.kit.fish import BODY, EYE, PECTORAL, SPECIES, fish, fish_pieces
from viewer.kit.fish_body import body_surface

Numbers = NDArray[np.float64]
pytestmark = pytest.mark.usefixtures("context")
PRESETS = {preset.name: preset for preset in presets_for(Catalog().find("fish"))}
SMALL = {"size": (96, 54), "samples": 0}


def stage(**params: object) -> Any:
    """A small fish."""
    return viewer.headless("fish", size=(32, 18), samples=0, params=params)


def centre_line(rest: NDArray[Any], parts: NDArray[Any], vertices: NDArray[Any]) -> Numbers:
    """The middle between the ridges of back and belly from nose to tail, (80, 3), as the exported vertices have it."""
    ridge = (parts == BODY) & (np.abs(rest[:, 2]) < 1e-6)
    places = np.linspace(*np.quantile(rest[ridge, 0], (0.98, 0.02)), 80)
    sides = []
    for sign in (1.0, -1.0):
        middle = np.interp(rest[:, 0], *slim(rest[ridge]))
        side = np.flatnonzero(ridge & (sign * (rest[:, 1] - middle) > 0.0))
        side = side[np.argsort(rest[side, 0], kind="stable")]
        sides.append([np.interp(places, rest[side, 0], vertices[side, axis]) for axis in range(3)])
    return np.asarray(0.5 * (np.array(sides[0]) + np.array(sides[1])).T)


def slim(ridge: NDArray[Any]) -> tuple[Numbers, Numbers]:
    """Where between back and belly the points (n, 3) of both ridges lie, roughly: places along x and heights."""
    places = np.linspace(ridge[:, 0].min(), ridge[:, 0].max(), 24)
    near = [ridge[np.abs(ridge[:, 0] - place) < 0.03, 1] for place in places]
    return places, np.array([0.5 * (heights.min() + heights.max()) for heights in near])


def line_of(geometry: dict[str, NDArray[Any]]) -> Numbers:
    """The centre line of exported geometry."""
    return centre_line(geometry["rest"], geometry["parts"], geometry["vertices"])


def length_of(line: Numbers) -> float:
    """How long a line (n, 3) is."""
    return float(np.linalg.norm(np.diff(line, axis=0), axis=1).sum())


def beat(params: dict[str, object], frames: int) -> Iterator[dict[str, NDArray[Any]]]:
    """The exported geometry of every fourth of so many frames."""
    with stage(detail="middling", **params) as swimming:
        for frame in range(0, frames, 4):
            swimming.seek(frame)
            yield swimming.geometry()


def measured(capsys: pytest.CaptureFixture[str], *words: str) -> dict[str, Any]:
    """What the command line measures."""
    assert cli.main(["measure", "fish", *words]) == 0
    read: dict[str, Any] = json.loads(capsys.readouterr().out)
    return read


# How it swims

@pytest.mark.parametrize("params", [
    {}, {"species": "eel", "stiffness": 0.0, "wavelength": 0.7}, {"species": "tuna", "turn": 60.0, "amplitude": 0.15}])
def test_the_body_keeps_its_length(params: dict[str, object]) -> None:
    """Along the middles of its cross sections, within 2 %, all through a beat."""
    rest = fish(str(params.get("species", "clownfish")), 2)
    along = length_of(centre_line(rest.positions, rest.parts, rest.positions))
    lengths = [length_of(line_of(geometry)) for geometry in beat({"tail_beat_hz": 3.0, **params}, 20)]
    assert 0.7 < along < 1.01
    assert np.abs(np.array(lengths) / along - 1.0).max() < 0.02


@pytest.mark.parametrize(("hertz", "wavelength"), [(1.5, 1.0), (3.0, 0.75), (2.5, 1.4)])
def test_the_wave_runs_as_fast_as_frequency_times_wavelength(hertz: float, wavelength: float) -> None:
    """By when each place of the body swings, in the frames of one beat."""
    frames = round(60 / hertz)
    lines = np.array([line_of(geometry) for geometry in beat(
        {"tail_beat_hz": hertz, "wavelength": wavelength, "twist": False, "stiffness": 0.2}, frames)])
    swing = np.exp(-2j * np.pi * np.arange(0, frames, 4) / frames) @ lines[:, :, 2]
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(lines[0], axis=0), axis=1))])
    back = along > 0.3
    delay = -np.unwrap(np.angle(swing))[back] / (2.0 * np.pi * hertz)       # seconds after the nose
    speed = 1.0 / np.polyfit(along[back], delay, 1)[0]
    assert speed == pytest.approx(hertz * wavelength, rel=0.03)


@pytest.mark.parametrize("species", list(SPECIES))
def test_the_head_moves_less_than_the_tail(species: str) -> None:
    """And both as `measure` says."""
    with stage(species=species, stiffness=0.5) as swimming:
        numbers = swimming.measure()
    assert 0.0 < numbers["head_amplitude"] < 0.3 * numbers["tail_amplitude"]
    assert numbers["tail_amplitude"] == pytest.approx(0.1, rel=0.01)
    assert numbers["wave_speed"] == pytest.approx(1.8, rel=0.01)
    assert numbers["body_length_ratio"] == pytest.approx(1.0, abs=0.001)


@pytest.mark.parametrize(("part", "head", "tail"), [
    ({"side_to_side": True, "sway": 0.11}, 0.11, 0.11),
    ({"yaw": True, "yaw_angle": 20.0}, 0.5 * np.sin(np.radians(20.0)), 0.5 * np.sin(np.radians(20.0))),
    ({"roll": True, "roll_angle": 30.0}, 0.0, 0.0), ({"twist": True, "twist_angle": 30.0}, 0.0, 0.0)])
def test_each_part_of_the_motion_alone(part: dict[str, object], head: float, tail: float) -> None:
    """By how far nose and tail swing; none of them makes a wave of the spine."""
    with stage(**{"wave": False, "twist": False, **part}) as swimming:
        numbers = swimming.measure()
        assert (numbers["head_amplitude"], numbers["tail_amplitude"]) == pytest.approx((head, tail), abs=1e-4)
        assert "wave_speed" not in numbers
        still = swimming.geometry()["vertices"]
        swimming.seek(7)
        assert np.abs(swimming.geometry()["vertices"] - still).max() > 0.01


@pytest.mark.parametrize("params", [
    {}, {"species": "eel", "stiffness": 0.0, "wavelength": 0.7, "turn": -50.0},
    {"species": "koi", "roll": True, "twist_angle": 40.0, "yaw": True, "amplitude": 0.14}])
def test_normals_are_those_of_the_bent_skin(params: dict[str, object]) -> None:
    """Within 0.1 degrees of the plane through moved neighbours that are far closer than those of any mesh."""
    surface = body_surface(SPECIES[str(params.get("species", "clownfish"))])
    turn, angle = (grid.ravel() for grid in np.meshgrid(np.linspace(0.4, 2.9, 40), np.linspace(0.1, 6.2, 24)))

    def spread(step: float) -> Numbers:
        """Points (5, n, 3) of the skin: in the middle, and a step ahead, back, to the left and to the right."""
        steps = [(0.0, 0.0), (step, 0.0), (-step, 0.0), (0.0, step), (0.0, -step)]
        return np.array([surface(turn + ahead, angle + aside).real for ahead, aside in steps])

    fine, coarse = spread(1e-5), spread(4e-3)
    smooth = angles(plane(fine), plane(coarse)) < 0.03          # not in the mouth, where that step is too wide
    assert smooth.mean() > 0.7
    normals = plane(fine) * np.sign((plane(fine) * (fine[0] - fine[0].mean(axis=0))).sum(axis=1))[:, None]
    with stage(**params) as swimming:
        swimming.seek(33)
        moved, bent = captured(swimming, coarse.reshape(-1, 3), np.tile(normals, (5, 1)))
    assert angles(bent[:len(turn)], plane(moved.reshape(coarse.shape)))[smooth].max() < 0.1


def plane(spread: Numbers) -> Numbers:
    """The normals (n, 3) of the planes through points around each of n, (5, n, 3)."""
    _, ahead, back, left, right = spread
    normals = np.cross(ahead - back, left - right)
    return np.asarray(normals / np.linalg.norm(normals, axis=1, keepdims=True))


def captured(swimming: Any, points: Numbers, normals: Numbers) -> tuple[Numbers, Numbers]:
    """Where the scene's own shader puts points (n, 3) of the body, and how it turns their normals."""
    scene = swimming.scene
    program, gpu = scene.models[0].program(True), scene.gpu
    weights = np.tile(np.array([1.0, 0.0, 0.0, 0.0], "f4"), (len(points), 1))
    array = gpu.vertex_array(program, [
        (gpu.buffer(np.hstack([points, normals]).astype("f4")), "3f 3f", "in_position", "in_normal"),
        (gpu.buffer(weights), "4f", "in_weights")])
    swimming.geometry()         # so that the program knows the moment
    found = array.capture({"v_position": 3, "v_normal": 3}, len(points))
    return found["v_position"].astype(float), found["v_normal"].astype(float)


def angles(one: Numbers, other: Numbers) -> Numbers:
    """Between vectors (n, 3) of any length, in degrees."""
    sine = np.linalg.norm(np.cross(one, other), axis=1)
    return np.degrees(np.arctan2(sine, np.abs((one * other).sum(axis=1))))


def test_another_frequency_changes_the_pace_and_not_the_place() -> None:
    """In mid-swim, with the phase far from where frequency times time would have it."""
    with stage(detail="small", tail_beat_hz=1.0) as swimming:
        swimming.seek(217)
        before = swimming.geometry()["vertices"]
        swimming.set(tail_beat_hz=4.5)
        assert np.array_equal(swimming.geometry()["vertices"], before)
        swimming.step()
        farthest = np.linalg.norm(swimming.geometry()["vertices"] - before, axis=1).max()
    assert 0.0 < farthest < 2.0 * np.pi * 4.5 / 60 * 0.15


@pytest.mark.parametrize("params", [{}, {"school": 40}, {"school": 12, "mixed": True}])
def test_seeking_is_playing(params: dict[str, object]) -> None:
    """To and fro, the pictures are those of playing from the beginning."""
    with viewer.headless("fish", **SMALL, params=params) as one:
        for _ in range(20):
            one.step()
        played, geometry = one.pixels(), one.geometry()
        one.seek(30)
        one.pixels()
        one.seek(5)
        one.seek(20)
        assert np.array_equal(one.pixels(), played)
        assert all(np.array_equal(values, geometry[name]) for name, values in one.geometry().items())


# Fins

def test_a_twisted_fin_collapses_and_is_cured() -> None:
    """Its skin has less area where matrices are blended, and no less than its own where motions are."""
    area = {}
    for method, twist in product(("linear", "dual_quaternion"), (0.0, 180.0)):
        with stage(fin_twist=twist, fin_method=method, fin_stroke=0.0, fin_feather=0.0) as swimming:
            geometry = swimming.geometry()
        fin = geometry["triangles"][(geometry["parts"][geometry["triangles"]] == PECTORAL).all(axis=1)]
        area[method, twist] = trimesh.Trimesh(geometry["vertices"], fin, process=False).area
    assert area["linear", 180.0] < 0.9 * area["linear", 0.0]
    assert area["dual_quaternion", 180.0] > 0.99 * area["dual_quaternion", 0.0]


def test_the_way_of_blending_may_change_before_the_first_picture() -> None:
    """And after it: the fins stand as if it had been so from the start."""
    with stage(fin_twist=90.0, fin_method="dual_quaternion") as one:
        wanted = one.geometry()["vertices"]
    with stage(fin_twist=90.0) as one:
        one.set(fin_method="dual_quaternion")
        assert np.array_equal(one.geometry()["vertices"], wanted)
        one.set(fin_method="linear")
        assert np.abs(one.geometry()["vertices"] - wanted).max() > 1e-3
        one.set(fin_method="dual_quaternion")
        assert np.array_equal(one.geometry()["vertices"], wanted)


def test_only_fins_have_rays() -> None:
    """Neither the body, nor what feels and sees."""
    for species in SPECIES:
        parts, found = fish(species, 3).parts, look.rays(species, 3)
        assert found.shape == parts.shape
        assert np.array_equal(found > 0, (parts != BODY) & (parts != EYE))


# Pictures

@pytest.fixture(scope="module")
def default_picture(only_context: object) -> NDArray[np.uint8]:
    """The fish as it comes."""
    return viewer.render("fish", 12, **SMALL)


@pytest.mark.parametrize("name", PRESETS)
def test_every_preset_opens_and_is_another_picture(name: str, default_picture: NDArray[np.uint8]) -> None:
    """With a title, a sentence, and far from the default; a school at once, others in mid-swim."""
    preset = PRESETS[name]
    assert preset.title and preset.description.endswith(".")
    picture = viewer.render("fish", 2 if "school" in preset.values else 12, **SMALL, preset=name)
    assert np.abs(picture.astype(int) - default_picture).max(axis=2).mean() > 3.0


def test_the_presets_that_were_asked_for_are_there() -> None:
    """Each part alone, all species, schools, the fin's collapse and cure."""
    assert {"side-to-side", "yaw", "wave", "roll", "twist", "tuna", "koi", "eel", "school", "mixed-school", "bait-ball",
            "fin-collapse", "fin-cure", "turning", "needles"} <= set(PRESETS)


NEEDLES, OWN_COLORS = {"show_normals": True}, {"recolour": True}
CHANGES: list[tuple[str, object, dict[str, object]]] = [
    ("species", "tuna", {}), ("detail", "far", {}), ("mixed", True, {"school": 12}), ("pattern_seed", 5, {}),
    ("scale_size", 2.5, {}), ("iridescence", 0.0, {}), ("recolour", True, {}), ("ground_color", "#20c040", OWN_COLORS),
    ("pattern_color", "#20c040", OWN_COLORS), ("colouring", "normals", {}), ("colouring", "parts", {}),
    ("colouring", "weights", {}), ("colouring", "swing", {}), ("show_midline", True, {}), ("show_normals", True, {}),
    ("needles", 100, NEEDLES), ("needle_length", 0.2, NEEDLES), ("water", "ocean", {}), ("seabed", False, {}),
    ("caustics", 0.0, {}), ("motes", False, {})]


@pytest.fixture(scope="module")
def picture_of(only_context: object) -> Callable[..., NDArray[np.int64]]:
    """Makes pictures of a koi, each once."""
    made: dict[object, NDArray[np.int64]] = {}

    def make(**params: object) -> NDArray[np.int64]:
        key = tuple(params.items())
        if key not in made:
            made[key] = viewer.render("fish", 5, size=(160, 90), samples=0,
                                      params={"species": "koi", **params}).astype(np.int64)
        return made[key]

    return make


@pytest.mark.parametrize(("name", "value", "params"), CHANGES)
def test_every_parameter_of_the_look_shows(name: str, value: object, params: dict[str, object],
                                           picture_of: Callable[..., NDArray[np.int64]]) -> None:
    """A change of it changes the picture."""
    changed = np.abs(picture_of(**params) - picture_of(**params, **{name: value})).max(axis=2)
    assert (changed > 0).sum() > 4


def test_every_parameter_of_the_look_is_tried() -> None:
    """So that none is declared in vain."""
    assert {name for name, _, _ in CHANGES} == {*FishLookParameters.declared, *WaterParameters.declared}


@pytest.mark.parametrize("species", list(SPECIES))
def test_each_species_has_its_own_coat(species: str) -> None:
    """On the flank the clownfish is orange, the koi pale, the tuna blue-grey, the eel dim."""
    with viewer.headless("fish", size=(160, 90), samples=0, params={
            "species": species, "caustics": 0.0, "motes": False}) as one:
        distance = 0.3 if species == "eel" else 0.8
        one.camera.stand({"yaw": 0.0, "pitch": 0.0, "distance": distance, "target": (0.0, 0.0, 0.0)})
        flank = one.pixels()[35:55, 40:120, :3].reshape(-1, 3)
        red, green, blue = flank.mean(axis=0)
    wanted = {"clownfish": red > 1.35 * blue, "koi": np.quantile(flank.min(axis=1), 0.8) > 120, "tuna": blue > red,
              "eel": max(red, green, blue) < 140}
    assert wanted[species], (red, green, blue)


def test_lines_of_light_take_as_much_as_they_give() -> None:
    """The waves move light about and make none: on average the floor is as bright as below still water."""
    with viewer.headless("fish", size=(16, 9), samples=0) as one:
        for frame in (0, 200):
            one.seek(frame)
            one.pixels()
            net = one.scene.water._light.texture
            light = np.frombuffer(net.read(), np.float16).astype(float).reshape(net.size)
            assert light.mean() == pytest.approx(1.0, abs=0.08)
            assert light.max() > 3.0
            for axis in (0, 1):
                steps = np.abs(light - np.roll(light, -1, axis)).mean(axis=1 - axis)
                assert steps[-1] < 1.5 * max(steps[-2], steps[0])       # as much over the seam as beside it


def test_light_falls_once_for_each_moment(monkeypatch: pytest.MonkeyPatch) -> None:
    """However often one asks; another frame has another light, and the one before the same again."""
    falls: list[str] = []
    render = VertexArray.render

    def noted(self: VertexArray, **options: int) -> None:
        falls.extend([self.program.name] if "light_net" in self.program.name else [])
        render(self, **options)

    with stage() as one:
        one.seek(3)
        first = one.pixels()
        monkeypatch.setattr(VertexArray, "render", noted)
        one.geometry()
        one.measure()
        assert np.array_equal(one.pixels(), first)
        assert not falls
        one.seek(40)
        one.pixels()
        assert len(falls) == 2
        one.seek(3)
        assert np.array_equal(one.pixels(), first)


def test_what_is_drawn_after_the_fish_is_drawn_as_ever(context: moderngl.Context) -> None:
    """Not blended; and where one asks for that, by its cover and not added."""
    clear = context.program("""#version 330 core
        void main() { gl_Position = vec4(4 * (gl_VertexID % 2) - 1, 4 * (gl_VertexID / 2) - 1, 0.0, 1.0); }""",
                            "#version 330 core\nout vec4 color; void main() { color = vec4(0.5, 0.5, 0.5, 0.0); }")
    screen = context.vertex_array(clear, [])
    with stage() as one:
        one.pixels()
        target = one.scene.gpu.framebuffer([one.scene.gpu.texture((1, 1), 4)])
        target.use()
        one.scene.draw()
        target.clear()
        screen.render(vertices=3)
        assert target.read(components=3)[0] in (127, 128)
        one.seek(9)
        one.scene.prepare()
        context.enable(moderngl.BLEND)
        target.use()
        target.clear()
        screen.render(vertices=3)
        assert target.read(components=3)[0] == 0
        context.disable(moderngl.BLEND)
    screen.release()
    clear.release()


def test_a_fish_is_as_fine_as_it_is_large_in_the_picture() -> None:
    """As long as a metre is at its distance, in pictures of any shape."""
    for size in ((160, 90), (90, 160)):
        with viewer.headless("fish", size=size, samples=0) as one:
            one.pixels()
            one.picture.use()
            away = np.linalg.norm(one.camera.eye)
            metre = 0.5 * size[1] * one.camera.projection(size[0] / size[1])[1, 1] / away
            assert one.scene.pixels_of_nearest() == pytest.approx(metre, rel=1e-6)


def test_no_finer_fish_is_built_than_is_drawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nor a coarser one."""
    asked: list[int] = []
    monkeypatch.setattr(model, "fish", lambda species, detail: asked.append(detail) or fish(species, detail))
    assert model.detail_of(SimpleNamespace(detail="fine", species="koi", school=1), 0.0) == 3
    assert model.detail_of(SimpleNamespace(detail="by_size", species="koi", school=20), 200.0) == 2
    assert asked == [3, 2]


def test_a_far_fish_s_shadow_is_that_of_its_body() -> None:
    """Of the triangles that come first none belongs to what follows, such as barbels."""
    for species, detail in product(SPECIES, range(3)):
        body = fish_pieces(species, detail)["body"]
        count = model.body_triangles(species, detail)
        triangles = fish(species, detail).triangles
        assert triangles[:count].max() < len(body.positions) <= triangles[count:].min()


def test_needles_are_as_long_as_the_fish_s_size_has_them() -> None:
    """In a school of small ones too."""
    with stage(school=2, fish_size=(0.4, 0.401), show_normals=True, needle_length=0.2) as one:
        one.pixels()
        corners = one.scene.needles.capture({"v_position": 3}, 12)["v_position"].reshape(4, 3, 3)
    root, tip = corners[:, 0].mean(axis=0), corners[0, 2]
    assert np.linalg.norm(tip - root) == pytest.approx(0.4 * 0.2, rel=0.01)


# A school

def drawn_fish(monkeypatch: pytest.MonkeyPatch, **params: object) -> Counter[int]:
    """How many instances each draw call of fish in one picture had."""
    calls: Counter[int] = Counter()
    render = VertexArray.render

    def counted(self: VertexArray, *, instances: int = -1, **options: int) -> None:
        if self.program.name == "fish/fish.frag" and not self.program.gpu.casting_shadows:
            calls[instances] += 1
        render(self, instances=instances, **options)

    monkeypatch.setattr(VertexArray, "render", counted)
    viewer.render("fish", **SMALL, params=params)
    return calls


def test_a_school_is_one_draw_call_a_species(monkeypatch: pytest.MonkeyPatch) -> None:
    """However many there are."""
    assert drawn_fish(monkeypatch, school=300) == {300: 1}
    monkeypatch.undo()
    assert drawn_fish(monkeypatch, school=303, mixed=True) == {76: 3, 75: 1}


def test_a_school_is_told(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    """Its numbers, and in a file where everybody is beside the mesh of the first."""
    read = measured(capsys, "--set", "school=50", "--frame", "20")
    assert read["fish"] == 50
    assert 0.0 <= read["polarisation"] <= 1.0
    assert read["nearest_distance"] > 0.0
    assert cli.main(["export", "fish", "--out", str(tmp_path / "school.npz"), "--set", "school=50"]) == 0
    with np.load(tmp_path / "school.npz") as arrays:
        assert arrays["school_position"].shape == arrays["school_velocity"].shape == (50, 3)
        assert arrays["vertices"].shape == arrays["normals"].shape
    assert cli.main(["export", "fish", "--out", str(tmp_path / "fish.ply")]) == 0
    solid = trimesh.load(tmp_path / "fish.ply", process=False)
    assert len(solid.vertices) == fish("clownfish", 3).positions.shape[0]


def test_many_fish_are_cut_coarsely() -> None:
    """However fine one asks for them; a single one is as fine as asked."""
    with stage(school=1000, detail="finest") as one:
        assert one.measure()["vertices"] < 250
    with stage(detail="finest") as one:
        assert one.measure()["vertices"] > 40_000


def test_what_a_single_fish_cannot_be_is_said() -> None:
    """Of all species at once."""
    with stage(mixed=True) as one:
        assert any("mixed" in remark for remark in one.remarks())
    with stage(mixed=True, school=4) as one:
        assert not any("mixed" in remark for remark in one.remarks())


# Bad values

@pytest.mark.parametrize(("name", "value", "allowed"), [
    ("species", "shark", "clownfish"), ("school", 0, "1 to 10000"), ("school", 20000, "1 to 10000"),
    ("detail", "coarse", "by_size"), ("tail_beat_hz", -1, "0 to 15"), ("pattern_seed", 1.5, "whole"),
    ("water", "lava", "lagoon"), ("iridescence", "nan", "number"), ("scales", 3, "scale_size")])
def test_bad_values_are_told_in_a_line(capsys: pytest.CaptureFixture[str], name: str, value: object,
                                       allowed: str) -> None:
    """With the name and what is allowed."""
    assert cli.main(["measure", "fish", "--set", f"{name}={value}"]) == 2
    line = capsys.readouterr().err.strip()
    assert line.startswith("error: ") and "\n" not in line
    assert name in line and allowed in line
