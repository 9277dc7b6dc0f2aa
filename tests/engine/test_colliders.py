"""What particles bounce off: the shader's distances and normals against closed forms, in NumPy."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from viewer.engine.fields import ParameterError
from viewer.engine.gpu import Gpu, GpuError
from viewer.engine.particles.colliders import ColliderParameters, Colliders
from viewer.engine.particles.solid import Solid
from viewer.engine.shaders import ShaderFolders
from viewer.kit import mesh

SHADERS = Path(__file__).parents[2] / "shaders"
PROBE = """#version 330 core
#include "particles/collider.glsl"
in vec3 in_place;
out float v_distance;
out vec3 v_normal;
void main() {
    v_distance = collider_distance(in_place);
    v_normal = collider_normal(in_place);
    gl_Position = vec4(0.0);
}
"""
Points = NDArray[np.float64]
Answer = tuple[NDArray[np.float32], NDArray[np.float32]]
Probe = Callable[..., Answer]
NO_GROUND: dict[str, Any] = {"ground": False}
PLACE: dict[str, Any] = {"obstacle_x": 0.4, "obstacle_y": 0.9, "obstacle_z": -0.3}
CENTER = np.array([0.4, 0.9, -0.3])


@pytest.fixture
def gpu(context: moderngl.Context, tmp_path: Path) -> Iterator[Gpu]:
    (tmp_path / "probe.vert").write_text(PROBE)
    arena = Gpu(context, ShaderFolders([tmp_path, SHADERS]))
    arena.framebuffer([arena.texture((4, 4), 4)]).use()
    yield arena
    arena.release()


@pytest.fixture
def probe(gpu: Gpu) -> Probe:
    """Distances (n,) and normals (n, 3) at places (n, 3), for colliders with these parameters."""

    def ask(places: Points, **values: object) -> Answer:
        colliders = Colliders(gpu, ColliderParameters(values))
        colliders.prepare()
        program = gpu.program("probe.vert", generated={"generated/collider.glsl": colliders.constants})
        array = gpu.vertex_array(program, [(gpu.buffer(places.astype("f4")), "3f", "in_place")])
        colliders.bind(program, 3)
        captured = array.capture({"v_distance": 1, "v_normal": 3}, len(places))
        return captured["v_distance"], captured["v_normal"]

    return ask


def places(count: int = 4000, width: float = 3.0, seed: int = 1) -> Points:
    return np.random.default_rng(seed).uniform(-width, width, (count, 3)).astype("f4").astype("f8")


def turned(turn: float, lean: float) -> Points:
    """From the obstacle's own directions to the world's."""
    t, s = np.radians(turn), np.radians(lean)
    about_y = np.array([[np.cos(t), 0, np.sin(t)], [0, 1, 0], [-np.sin(t), 0, np.cos(t)]])
    return about_y @ np.array([[np.cos(s), -np.sin(s), 0], [np.sin(s), np.cos(s), 0], [0, 0, 1]])


def box_distance(p: Points, half_extents: Points) -> Points:
    beyond = np.abs(p) - half_extents
    return np.linalg.norm(np.maximum(beyond, 0.0), axis=-1) + np.minimum(beyond.max(axis=-1), 0.0)


def slope(distance: Callable[[Points], Points], p: Points, step: float = 1e-5) -> Points:
    return np.stack([distance(p + step * axis) - distance(p - step * axis) for axis in np.eye(3)], axis=1) / (2 * step)


def check_against(found: Answer, distance: Callable[[Points], Points], p: Points) -> None:
    """Both agree with the closed form; normals where that has one slope and not two."""
    np.testing.assert_allclose(found[0], distance(p), atol=3e-6)
    expected = slope(distance, p)
    smooth = np.abs(slope(distance, p, 1e-2) - expected).max(axis=1) < 0.05
    assert smooth.mean() > 0.7
    np.testing.assert_allclose(found[1][smooth], expected[smooth], atol=2e-4)


def write_obj(path: Path, vertices: Points, triangles: NDArray[np.int32]) -> Path:
    lines = [f"v {x} {y} {z}" for x, y, z in vertices] + [f"f {a} {b} {c}" for a, b, c in triangles + 1]
    path.write_text("\n".join(lines))
    return path


def test_without_colliders_everything_is_far(probe: Probe) -> None:
    distance, normal = probe(places(10), **NO_GROUND)
    assert (distance == 1e9).all()
    assert (normal == [0, 1, 0]).all()


def test_tilted_ground_passes_through_its_height_at_the_origin(probe: Probe) -> None:
    p = places()
    normal = np.array([-np.sin(np.radians(25.0)), np.cos(np.radians(25.0)), 0.0])
    check_against(probe(p, ground_tilt=25, ground_height=0.4), lambda q: (q - [0.0, 0.4, 0.0]) @ normal, p)


@pytest.mark.parametrize("hollow", [False, True])
@pytest.mark.parametrize("obstacle", ["sphere", "box", "torus"])
def test_distance_and_normal_are_those_of_the_closed_form(probe: Probe, obstacle: str, hollow: bool) -> None:
    p, turn = places(), turned(35.0, -20.0)
    around = {"obstacle_size": 0.8, "obstacle_thickness": 0.25, "obstacle_turn": 35, "obstacle_lean": -20, **PLACE}

    def distance(q: Points) -> Points:
        own = (q - CENTER) @ turn
        found = {"sphere": np.linalg.norm(own, axis=1) - 0.8, "box": box_distance(own, np.array([0.8, 0.25, 0.8])),
                 "torus": np.hypot(np.hypot(own[:, 0], own[:, 2]) - 0.8, own[:, 1]) - 0.25}[obstacle]
        return -found if hollow else found

    check_against(probe(p, obstacle=obstacle, hollow=hollow, **around, **NO_GROUND), distance, p)


def test_ground_and_obstacle_are_one(probe: Probe) -> None:
    p = places()
    check_against(probe(p, obstacle="sphere", obstacle_size=0.5, **PLACE),
                  lambda q: np.minimum(q[:, 1], np.linalg.norm(q - CENTER, axis=1) - 0.5), p)


@pytest.mark.parametrize("obstacle", ["sphere", "box", "torus", "formula"])
def test_normal_is_of_length_one_even_where_there_is_none(probe: Probe, obstacle: str) -> None:
    special = np.array([[0, 0, 0], [0.8, 0, 0], [0, 5, 0], [0.8, 0.25, 0.8], [1e6, 0, 0], [1e25, -1e25, 0]], float)
    special = np.concatenate([special, places(500)])
    distance, normal = probe(special, obstacle=obstacle, obstacle_y=0, obstacle_size=0.8, obstacle_thickness=0.25,
                             **NO_GROUND)
    assert not np.isnan(distance).any()
    np.testing.assert_allclose(np.linalg.norm(normal, axis=1), 1.0, atol=1e-5)


@pytest.mark.parametrize("values", [
    {"obstacle": "box", "obstacle_lean": 40}, {"obstacle": "torus", "hollow": True}, {"obstacle": "sphere"},
    {"obstacle": "formula", "obstacle_detail": 32, "ground": False},
    {"obstacle": "formula", "obstacle_detail": 32, "obstacle_scale": 0.3, "hollow": True, "obstacle_turn": 70},
    {"obstacle": "formula", "obstacle_detail": 24, "obstacle_formula": "max(abs(x), abs(y), abs(z)) - 0.6"},
])
def test_distance_changes_by_no_more_than_the_way(probe: Probe, values: dict[str, Any]) -> None:
    generator = np.random.default_rng(3)
    start = places(20_000, 2.0)
    reach = 10.0 ** generator.uniform(-1.5, 0.3, (len(start), 1))
    end = (start + reach * generator.normal(size=start.shape)).astype("f4").astype("f8")
    one, other = (probe(p, obstacle_y=0, **values)[0].astype("f8") for p in (start, end))
    assert (np.abs(one - other) <= np.linalg.norm(start - end, axis=1) * (1 + 1e-3) + 3e-6).all()


def test_mesh_from_a_file_is_where_its_sphere_is(probe: Probe, tmp_path: Path) -> None:
    vertices, triangles = mesh.ico_sphere(4)
    path = write_obj(tmp_path / "ball.obj", vertices, triangles)
    p = np.concatenate([places(width=1.6), CENTER + 0.5 * places(width=1.3)])
    distance, normal = probe(p, obstacle="mesh", obstacle_file=path, obstacle_scale=0.5, **PLACE, **NO_GROUND)
    away = p - CENTER
    expected = np.linalg.norm(away, axis=1) - 0.5
    cell = 0.5 * 2.0 / 59
    near = np.abs(expected) < 2 * cell
    assert near.sum() > 200
    np.testing.assert_allclose(distance[near], expected[near], atol=0.2 * cell)
    assert ((distance < 0) == (expected < 0))[np.abs(expected) > 0.1 * cell].all()
    cosine = np.einsum("ij,ij->i", normal, away) / np.linalg.norm(away, axis=1)
    assert cosine[near].min() > np.cos(np.radians(4.0))


def test_surface_lies_where_the_distance_is_zero(gpu: Gpu, probe: Probe, tmp_path: Path) -> None:
    path = write_obj(tmp_path / "ball.obj", *mesh.ico_sphere(3))
    shared: dict[str, Any] = {"obstacle_turn": 20, "obstacle_lean": 50, "obstacle_file": path, **PLACE, **NO_GROUND}
    for obstacle in ("sphere", "box", "torus", "mesh", "formula"):
        colliders = Colliders(gpu, ColliderParameters({"obstacle": obstacle, **shared}))
        colliders.prepare()
        surface = colliders.surface()
        assert surface is not None
        vertices, normals, triangles = surface
        assert (vertices.dtype, normals.dtype, triangles.dtype) == (np.float32, np.float32, np.int32)
        distance, normal = probe(vertices.astype("f8"), obstacle=obstacle, **shared)
        assert np.abs(distance).max() < {"mesh": 0.01, "formula": 0.01}.get(obstacle, 2e-6)
        np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0, atol=1e-4)
        if obstacle != "box":
            assert np.einsum("ij,ij->i", normals, normal).min() > 0.8
        a, b, c = (vertices[triangles[:, corner]].astype("f8") for corner in range(3))
        assert np.einsum("ij,ij->i", np.cross(b - a, c - a), normals[triangles[:, 0]]).mean() > 0


def test_generation_grows_only_with_what_the_surface_depends_on(gpu: Gpu) -> None:
    params = ColliderParameters({"obstacle": "sphere"})
    colliders = Colliders(gpu, params)
    seen = []
    for change in ({}, {"restitution": 0.9}, {"hollow": True}, {"obstacle_x": 1}, {"obstacle": "none"}):
        params.update(change)
        colliders.prepare()
        seen.append(colliders.generation)
    assert seen == [1, 1, 1, 2, 3]
    assert colliders.surface() is None


def test_what_cannot_be_an_obstacle_is_refused_and_the_former_one_stays(gpu: Gpu, tmp_path: Path) -> None:
    params = ColliderParameters({"obstacle": "formula"})
    colliders = Colliders(gpu, params)
    colliders.prepare()
    before = colliders.surface()
    broken = tmp_path / "broken.obj"
    broken.write_text("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")
    for change, words in (({"obstacle_formula": "x*x + 1"}, "nowhere below 0"),
                          ({"obstacle_formula": "sqrt(-1-x*x)"}, "no value"),
                          ({"obstacle": "mesh"}, "needs a mesh"),
                          ({"obstacle_file": broken}, "obstacle_file = broken.obj: has no area")):
        params.update(change)
        with pytest.raises(ParameterError, match=words):
            colliders.prepare()
        assert colliders.surface() is before


def test_thinnest_tells_what_a_fast_particle_might_jump_over(gpu: Gpu) -> None:
    def thinnest(**values: object) -> float:
        colliders = Colliders(gpu, ColliderParameters(values))
        colliders.prepare()
        return colliders.thinnest

    around = {"obstacle_size": 0.8, "obstacle_thickness": 0.25}
    assert thinnest() > 1e6
    assert thinnest(obstacle="sphere", **around) == pytest.approx(1.6)
    assert thinnest(obstacle="torus", **around) == thinnest(obstacle="box", **around) == pytest.approx(0.5)
    assert thinnest(obstacle="box", hollow=True) > 1e6
    assert thinnest(obstacle="formula", obstacle_detail=44) == pytest.approx(2.0 / 40)


def test_ground_to_draw_lies_where_its_distance_is_zero(gpu: Gpu, probe: Probe) -> None:
    values = {"ground_tilt": -30, "ground_height": 0.7}
    colliders = Colliders(gpu, ColliderParameters(values))
    vertices, normals, triangles = colliders.ground_surface(5.0)
    distance, normal = probe(vertices.astype("f8"), **values)
    np.testing.assert_allclose(distance, 0.0, atol=2e-6)
    np.testing.assert_allclose(normals, normal, atol=1e-6)
    assert np.linalg.norm(vertices - [0.0, 0.7, 0.0], axis=1).max() == pytest.approx(5.0)
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    assert (np.einsum("ij,ij->i", np.cross(b - a, c - a), normals[triangles[:, 0]]) > 0.0).all()


def test_volume_beyond_the_limit_is_refused(gpu: Gpu) -> None:
    with pytest.raises(GpuError, match="volume of 100000x2x2"):
        gpu.volume((100_000, 2, 2), 1)


def test_solid_makes_room_for_a_larger_mesh(gpu: Gpu) -> None:
    target = gpu.framebuffer([gpu.texture((16, 16), 4)])
    target.use()
    solid = Solid(gpu)
    for level in (0, 3, 1):
        vertices, triangles = mesh.ico_sphere(level)
        solid.show((vertices, vertices, triangles))
        solid.draw((0.5, 0.5, 0.5))
        solid.draw_glass((0.5, 0.5, 0.5))
        solid.draw_near_glass((0.5, 0.5, 0.5))
    solid.show(None)
    solid.draw((0.5, 0.5, 0.5))
    assert target.depth_mask
