"""Where particles are born, captured from the shader: as many everywhere, with the normals of closed forms."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import moderngl
import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray
from scipy import stats

from viewer.engine.fields import ParameterError
from viewer.engine.gpu import Gpu
from viewer.engine.particles.emitter import Emitter, EmitterParameters, turning
from viewer.engine.shaders import ShaderFolders
from viewer.kit.fish import SPECIES, fish_mesh
from viewer.kit.mesh_file import MeshFileError

Floats = NDArray[np.float64]
SHADERS = Path(__file__).parents[2] / "shaders"
COUNT = 100_000
UNLIKELY = 1e-4         # the random numbers are fixed: a test passes always or never
PROBE = """#version 330 core
#include "particles/emitter.glsl"
uniform float u_probe_spread;
out vec3 v_place;
out vec3 v_normal;
out vec3 v_direction;
void main() {
    uint random_state = pcg(uint(gl_VertexID) + 977u);
    emission_place(random_state, v_place, v_normal);
    v_direction = emission_direction(random_state, v_normal, u_probe_spread);
    gl_Position = vec4(0.0);
}
"""


class Bench:
    """An emitter and a program that draws from it."""

    def __init__(self, gpu: Gpu, **values: object) -> None:
        self.gpu, self.params = gpu, EmitterParameters(values)
        self.emitter = Emitter(gpu, self.params)
        self.program = gpu.program("probe.vert", generated={"generated/emitter.glsl": self.emitter.constants})
        self.array = gpu.vertex_array(self.program)
        self.target = gpu.framebuffer([gpu.texture((1, 1), 4)])     # GL runs nothing without one

    def draw(self, spread: float = 0.0, **values: object) -> tuple[Floats, Floats, Floats]:
        """Places, normals and directions, (COUNT, 3) each."""
        self.params.update(values)
        self.emitter.prepare()
        self.gpu.share(self.params)
        assert self.gpu.refresh() is None
        self.emitter.bind(self.program, 3)
        self.program["u_probe_spread"] = spread
        self.target.use()
        found = self.array.capture({"v_place": 3, "v_normal": 3, "v_direction": 3}, COUNT)
        assert all(np.isfinite(each).all() for each in found.values())
        place, normal, direction = (found[name].astype(np.float64) for name in ("v_place", "v_normal", "v_direction"))
        assert np.allclose(np.linalg.norm(normal, axis=1), 1.0, atol=1e-5)
        return place, normal, direction


@pytest.fixture
def bench(context: moderngl.Context, tmp_path: Path) -> Iterator[Callable[..., Bench]]:
    folder = tmp_path / "shaders"
    folder.mkdir()
    (folder / "probe.vert").write_text(PROBE)
    gpu = Gpu(context, ShaderFolders([folder, SHADERS]))
    yield lambda **values: Bench(gpu, **values)
    gpu.release()


def straight(places: Floats, tilt: float, heading: float, height: float) -> Floats:
    """Points or, with height 0, vectors of the world as the shape itself has them."""
    return (places - np.array([0.0, height, 0.0])) @ turning(tilt, heading)


def uniform(values: Floats, low: float = 0.0, high: float = 1.0, parts: int = 50) -> None:
    """The values fill ``low`` to ``high`` evenly: chi-square over so many parts."""
    assert values.min() >= low - 1e-5 and values.max() <= high + 1e-5
    counts, _ = np.histogram(np.clip(values, low, high), bins=parts, range=(low, high))
    assert stats.chisquare(counts).pvalue > UNLIKELY


def as_expected(counts: NDArray[np.int64], shares: Floats) -> None:
    """Counts follow shares, those that expect less than ten taken together."""
    expected = shares / shares.sum() * counts.sum()
    few = expected < 10.0
    counts, expected = (np.append(each[~few], each[few].sum()) for each in (counts, expected))
    keep = expected > 0
    assert counts[~keep].sum() == 0
    assert stats.chisquare(counts[keep], expected[keep]).pvalue > UNLIKELY


def around(places: Floats) -> Floats:
    return np.arctan2(places[:, 0], places[:, 2]) / (2 * np.pi) + 0.5


def test_the_axis_leans_towards_x_and_turns_counter_clockwise() -> None:
    """By 90 degrees up becomes +x, and from there -z."""
    assert np.allclose(turning(0, 0), np.eye(3))
    assert np.allclose(turning(90, 0) @ [0, 1, 0], [1, 0, 0])
    assert np.allclose(turning(90, 90) @ [0, 1, 0], [0, 0, -1])
    assert np.linalg.det(turning(31, -77)) == pytest.approx(1.0)


@pytest.mark.parametrize("source", ["surface", "edge", "volume"])
def test_a_point_is_exact(bench: Callable[..., Bench], source: str) -> None:
    """At the origin, at its height; its normal up, or as the axis leans."""
    point = bench(emitter="point", emit_from=source, emitter_height=1.25)
    place, normal, _ = point.draw()
    assert (place == [0, 1.25, 0]).all() and (normal == [0, 1, 0]).all()
    assert np.allclose(point.draw(emitter_tilt=90.0)[1], [1, 0, 0], atol=1e-6)
    assert point.emitter.surface() is None


@pytest.mark.parametrize(("tilt", "heading", "height"), [(0.0, 0.0, 0.0), (35.0, -120.0, 2.5)])
class TestShapes:
    """Each shape as it stands and tilted, turned and lifted."""

    def drawn(self, bench: Callable[..., Bench], tilt: float, heading: float, height: float,
              **values: object) -> tuple[Floats, Floats]:
        made = bench(emitter_tilt=tilt, emitter_heading=heading, emitter_height=height, **values)
        place, normal, _ = made.draw()
        return straight(place, tilt, heading, height), straight(normal, tilt, heading, 0.0)

    def test_a_disc(self, bench: Callable[..., Bench], tilt: float, heading: float, height: float) -> None:
        """The square of the distance is uniform; at the rim it is the radius."""
        for source in ("surface", "volume", "edge"):
            place, normal = self.drawn(bench, tilt, heading, height, emitter="disc", emit_from=source, emitter_size=2)
            square = (place[:, 0] ** 2 + place[:, 2] ** 2) / 4.0
            if source == "edge":
                assert np.allclose(square, 1.0, atol=1e-5)
            else:
                uniform(square)
            uniform(around(place))
            assert np.allclose(place[:, 1], 0, atol=1e-5) and np.allclose(normal, [0, 1, 0], atol=1e-5)

    def test_a_sphere(self, bench: Callable[..., Bench], tilt: float, heading: float, height: float) -> None:
        """Archimedes: y is uniform; in the volume, so is the cube of the distance."""
        for source in ("surface", "volume", "edge"):
            place, normal = self.drawn(bench, tilt, heading, height, emitter="sphere", emit_from=source,
                                       emitter_size=1.5)
            distance = np.linalg.norm(place, axis=1)
            assert np.allclose(normal, place / distance[:, None], atol=2e-5)
            uniform(around(place))
            if source == "edge":
                assert np.allclose(normal[:, 1], 0, atol=1e-5)
            else:
                uniform(normal[:, 1], -1.0, 1.0)
            if source == "volume":
                uniform((distance / 1.5) ** 3)
            else:
                assert np.allclose(distance, 1.5, atol=1e-5)

    @pytest.mark.parametrize("tube", [0.1, 0.45, 1.0, 5.0])
    def test_a_torus(self, bench: Callable[..., Bench], tilt: float, heading: float, height: float,
                     tube: float) -> None:
        """Around the tube as 1 + k cos(a), which integrates to a + k sin(a); a thicker tube is as thick as the ring."""
        given, tube = tube, min(tube, 1.0)
        for source in ("surface", "volume", "edge"):
            place, normal = self.drawn(bench, tilt, heading, height, emitter="torus", emit_from=source,
                                       emitter_size=1, emitter_thickness=given)
            axial = np.hypot(place[:, 0], place[:, 2]) - 1.0
            reach = np.hypot(axial, place[:, 1])
            safe = reach > 1e-3
            ring = np.stack([place[:, 0], 0 * axial, place[:, 2]], axis=1) / (axial + 1.0)[:, None].clip(1e-9)
            expected = (axial[:, None] * ring + place * [0, 1, 0]) / reach[:, None]
            off_axis = safe & (axial > -0.99)
            assert np.allclose(normal[off_axis], expected[off_axis], atol=2e-3)
            uniform(around(place))
            angle = np.arctan2(place[:, 1], axial)
            if source == "edge":
                assert np.allclose(axial, tube, atol=1e-5) and np.allclose(place[:, 1], 0, atol=1e-5)
                continue
            uniform((angle + np.minimum(reach, tube) * np.sin(angle)) / (2 * np.pi) + 0.5)
            if source == "volume":
                uniform((reach / tube) ** 2)
            else:
                assert np.allclose(reach, tube, atol=1e-5)

    def test_a_box(self, bench: Callable[..., Bench], tilt: float, heading: float, height: float) -> None:
        """Sides by area, edges by length, and evenly within each."""
        half = np.array([2.0, 0.5, 2.0])
        for source in ("surface", "edge", "volume"):
            place, normal = self.drawn(bench, tilt, heading, height, emitter="box", emit_from=source,
                                       emitter_size=2, emitter_thickness=0.5)
            if source == "volume":
                assert np.allclose(normal, [0, 1, 0], atol=1e-5)
                for axis in range(3):
                    uniform(place[:, axis], -half[axis], half[axis])
                continue
            ways = np.round(normal * (1 if source == "surface" else np.sqrt(2))).astype(int)
            assert np.allclose(normal * np.linalg.norm(ways, axis=1)[:, None], ways, atol=2e-5)
            kinds, which, counts = np.unique(ways, axis=0, return_inverse=True, return_counts=True)
            assert len(kinds) == (6 if source == "surface" else 12)
            as_expected(counts, np.where(kinds == 0, 2 * half, 1.0).prod(axis=1))
            touching = ways != 0
            assert np.allclose(place[touching], (ways * half)[touching], atol=1e-5)
            for kind in range(len(kinds)):
                for axis in np.nonzero(kinds[kind] == 0)[0]:
                    uniform(place[which.ravel() == kind, axis], -half[axis], half[axis])

    @pytest.mark.parametrize(("radius", "rise"), [(1.0, 2.0), (2.0, 0.3)])
    def test_a_cone(self, bench: Callable[..., Bench], tilt: float, heading: float, height: float, radius: float,
                    rise: float) -> None:
        """Mantle and base by area; the distance from the apex squared on the mantle, cubed in the volume."""
        slant = np.hypot(radius, rise)
        for source in ("surface", "edge", "volume"):
            place, normal = self.drawn(bench, tilt, heading, height, emitter="cone", emit_from=source,
                                       emitter_size=radius, emitter_thickness=rise)
            across = np.hypot(place[:, 0], place[:, 2])
            outward = np.stack([place[:, 0], 0 * across, place[:, 2]], axis=1) / across[:, None]
            mantle_normal = (rise * outward + [0, radius, 0]) / slant
            uniform(around(place))
            clear = across > 0.01
            if source == "edge":
                assert np.allclose(place[:, 1], 0, atol=1e-5) and np.allclose(across, radius, atol=1e-5)
                mean = mantle_normal - [0, 1, 0]
                assert np.allclose(normal, mean / np.linalg.norm(mean, axis=1)[:, None], atol=1e-4)
            elif source == "volume":
                uniform(((rise - place[:, 1]) / rise) ** 3)
                uniform((across / radius / (1 - place[:, 1] / rise)) ** 2)
                assert np.allclose(normal[clear], outward[clear], atol=2e-3)
            else:
                base = normal[:, 1] < -0.9
                as_expected(np.array([base.sum(), (~base).sum()]), np.array([radius, slant]))
                assert np.allclose(place[base, 1], 0, atol=1e-5)
                uniform((across[base] / radius) ** 2)
                uniform((across[~base] / radius) ** 2)
                assert np.allclose(across[~base] / radius + place[~base, 1] / rise, 1.0, atol=1e-4)
                assert np.allclose(normal[clear & ~base], mantle_normal[clear & ~base], atol=2e-3)

    def test_the_ground(self, bench: Callable[..., Bench], tilt: float, heading: float, height: float) -> None:
        """Level at its height, whatever the tilt; its border by length."""
        made = bench(emitter="ground", emitter_size=3, emitter_tilt=tilt, emitter_heading=heading,
                     emitter_height=height)
        place, normal, _ = made.draw()
        assert (normal == [0, 1, 0]).all() and (place[:, 1] == height).all()
        for axis in (0, 2):
            uniform(place[:, axis], -3.0, 3.0)
        border, normal, _ = made.draw(emit_from="edge")
        assert (normal == [0, 1, 0]).all() and np.allclose(np.abs(border[:, [0, 2]]).max(axis=1), 3.0)
        side = np.argmax(np.abs(border[:, [0, 2]]), axis=1) * 2 + (border[:, 0] + border[:, 2] > 0)
        uniform(border[side < 2, 2], -3.0, 3.0)
        uniform(border[side >= 2, 0], -3.0, 3.0)
        whole = around(border)
        as_expected(np.bincount((np.floor(whole * 4 + 0.5) % 4).astype(int)), np.ones(4))


def test_a_mesh_gives_each_triangle_its_share(bench: Callable[..., Bench], tmp_path: Path) -> None:
    """By area, evenly within a triangle, with the face's normal; scaled and lifted."""
    mesh = trimesh.creation.icosphere(2).apply_scale([1.0, 3.0, 0.4])
    mesh.export(tmp_path / "egg.stl")
    place, normal, _ = bench(emitter="mesh", emitter_file=tmp_path / "egg.stl", emitter_scale=2,
                             emitter_height=1).draw()
    own = trimesh.load_mesh(tmp_path / "egg.stl", process=False)
    which = np.argmax(normal @ own.face_normals.T, axis=1)
    assert np.allclose(normal, own.face_normals[which], atol=1e-5)
    as_expected(np.bincount(which, minlength=len(own.faces)), own.area_faces)
    local = (place - [0, 1, 0]) / 2
    part = trimesh.triangles.points_to_barycentric(own.triangles[which], local)
    assert np.allclose(np.einsum("ij,ij->i", local - own.triangles[which][:, 0], normal), 0, atol=1e-5)
    uniform((1 - part[:, 0].clip(0, 1)) ** 2)
    assert part.min() > -1e-3 and np.allclose(part.mean(axis=0), 1 / 3, atol=0.01)


def test_a_mesh_with_normals_is_smooth(bench: Callable[..., Bench], tmp_path: Path) -> None:
    """Those in the file, interpolated: on a ball nearly the direction from the centre."""
    mesh = trimesh.creation.icosphere(3)
    mesh.vertex_normals  # noqa: B018
    mesh.export(tmp_path / "ball.ply", vertex_normal=True)
    ball = bench(emitter="mesh", emitter_file=tmp_path / "ball.ply")
    place, normal, _ = ball.draw()
    away = place / np.linalg.norm(place, axis=1)[:, None]
    assert np.einsum("ij,ij->i", away, normal).min() > np.cos(np.radians(0.6))
    uniform(away[:, 1], -1.0, 1.0)
    surface = ball.emitter.surface()
    assert surface is not None and np.allclose(surface[0], surface[1], atol=1e-2)


def test_a_meshs_edges_are_drawn_by_length(bench: Callable[..., Bench], tmp_path: Path) -> None:
    """Of a box its twelve, not the diagonals of its sides."""
    half = np.array([1.0, 2.0, 0.5])
    trimesh.creation.box(2 * half).export(tmp_path / "box.obj")
    place, normal, _ = bench(emitter="mesh", emit_from="edge", emitter_file=tmp_path / "box.obj").draw()
    ways = np.round(normal * np.sqrt(2)).astype(int)
    assert np.allclose(normal * np.sqrt(2), ways, atol=1e-4)
    assert np.allclose(place[ways != 0], (ways * half)[ways != 0], atol=1e-5)
    kinds, which, counts = np.unique(ways, axis=0, return_inverse=True, return_counts=True)
    assert len(kinds) == 12
    as_expected(counts, np.where(kinds == 0, half, 1.0).prod(axis=1))
    for kind in range(12):
        axis = int(np.nonzero(kinds[kind] == 0)[0][0])
        uniform(place[which.ravel() == kind, axis], -half[axis], half[axis])


def test_a_meshs_volume_is_filled_and_never_left(bench: Callable[..., Bench], tmp_path: Path) -> None:
    """A box, evenly along each axis; the normals are those of sides."""
    trimesh.creation.box([2.0, 1.0, 3.0]).export(tmp_path / "box.stl")
    place, normal, _ = bench(emitter="mesh", emit_from="volume", emitter_file=tmp_path / "box.stl").draw()
    half = np.array([1.0, 0.5, 1.5])
    assert (np.abs(place) <= half).all()
    for axis in range(3):
        uniform(place[:, axis], -half[axis], half[axis], 16)
    assert np.allclose(np.abs(normal).max(axis=1), 1.0)
    cells = np.floor((place / half + 1) * 3).astype(int).clip(0, 5) @ [36, 6, 1]
    as_expected(np.bincount(cells, minlength=216), np.ones(216))


@pytest.mark.parametrize("species", SPECIES)
def test_particles_come_from_the_fish_that_is_chosen(bench: Callable[..., Bench], species: str) -> None:
    """As long and as slim as it is; another choice takes effect at once."""
    fish = bench(emitter="fish", emitter_species="koi")
    fish.draw()
    place, _, _ = fish.draw(emitter_species=species)
    extent = np.ptp(fish_mesh(species)[0], axis=0)
    assert np.ptp(place, axis=0) == pytest.approx(extent, rel=0.15, abs=0.02)


def test_a_fish_is_one_metre_long(bench: Callable[..., Bench]) -> None:
    """Its triangles by area, counted along x; inside, nothing beyond it."""
    fish = bench(emitter="fish", emitter_scale=2)
    place, _, _ = fish.draw()
    vertices, triangles = fish_mesh()
    corners = vertices[triangles]
    area = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    body = place[:, 0] > 0.5        # nose and head, with no fins
    share = area[corners[:, :, 0].mean(axis=1) > 0.25].sum() / area.sum()
    assert body.mean() == pytest.approx(share, abs=0.006)
    assert place[:, 0].min() >= -1.0 - 1e-5 and 0.9 < place[:, 0].max() <= 1.0 + 1e-5
    inside, _, _ = fish.draw(emit_from="volume")
    assert inside[:, 0].min() >= -1.0 and inside[:, 0].max() <= 1.0
    edge, _, _ = fish.draw(emit_from="edge")
    assert np.ptp(edge[:, 0]) > 1.0


@pytest.mark.parametrize("emitter", ["point", "sphere"])
@pytest.mark.parametrize("spread", [0.0, 0.01, 1.0, 30.0, 90.0, 180.0])
def test_directions_fill_the_cone_of_the_spread(bench: Callable[..., Bench], emitter: str, spread: float) -> None:
    """1 - cos(angle), taken as sin(angle / 2) squared, is uniform; no spread gives the normal to the bit."""
    _, normal, direction = bench(emitter=emitter, emitter_tilt=20).draw(spread)
    assert np.allclose(np.linalg.norm(direction, axis=1), 1.0, atol=1e-5)
    if spread == 0.0:
        assert (direction == normal).all()
        return
    if spread >= 1.0:
        half_sine = 0.5 * np.linalg.norm(direction - normal, axis=1)
        uniform((half_sine / np.sin(np.radians(spread) / 2)) ** 2, 0.0, 1.0)
    if emitter == "point" and spread >= 1.0:
        side, other = turning(20, 0)[:, 0], turning(20, 0)[:, 2]
        uniform(np.arctan2(direction @ side, direction @ other) / (2 * np.pi) + 0.5)
    assert np.degrees(np.arccos(np.clip((direction * normal).sum(axis=1), -1, 1))).max() <= spread + 0.05


@pytest.mark.parametrize("values", [
    {"emitter": "disc"}, {"emitter": "sphere"}, {"emitter": "torus", "emitter_thickness": 0.2}, {"emitter": "box"},
    {"emitter": "cone", "emitter_thickness": 1.0}, {"emitter": "ground"}, {"emitter": "fish"},
])
def test_the_surface_to_draw_is_where_particles_come_from(bench: Callable[..., Bench],
                                                          values: dict[str, object]) -> None:
    """In the world: every place lies close to the triangles, and the normals look outwards."""
    made = bench(**values, emitter_tilt=40, emitter_heading=70, emitter_height=1)
    place, _, _ = made.draw()
    surface = made.emitter.surface()
    assert surface is not None
    vertices, normals, triangles = surface
    assert (vertices.dtype, normals.dtype, triangles.dtype) == (np.float32, np.float32, np.int32)
    assert np.allclose(place.min(axis=0), vertices.min(axis=0), atol=0.02)
    assert np.allclose(place.max(axis=0), vertices.max(axis=0), atol=0.02)
    faces = trimesh.Trimesh(vertices, triangles, process=False).face_normals
    agreement = np.einsum("tci,ti->tc", normals[triangles], faces)
    assert (agreement > 0).mean() > 0.99
    assert made.emitter.surface()[2] is triangles        # type: ignore[index]


def test_nothing_is_made_anew_without_need(bench: Callable[..., Bench]) -> None:
    """Neither a table when the shape moves, nor a program when only its size changes."""
    fish = bench(emitter="fish")
    fish.draw()
    textures, generation = list(fish.emitter._textures), fish.program.generation
    fish.draw(emitter_scale=3.0, emitter_tilt=10.0)
    assert fish.emitter._textures == textures and fish.program.generation == generation
    fish.draw(emit_from="edge")
    assert fish.emitter._textures != textures and fish.program.generation == generation + 1


def test_an_edited_mesh_is_read_again(bench: Callable[..., Bench], tmp_path: Path) -> None:
    """Its points, and the surface to draw."""
    trimesh.creation.icosphere(1).export(tmp_path / "mesh.ply")
    made = bench(emitter="mesh", emitter_file=tmp_path / "mesh.ply")
    made.draw()
    textures, stamp = list(made.emitter._textures), made.emitter.stamp
    trimesh.creation.box((4.0, 4.0, 4.0)).export(tmp_path / "mesh.ply")
    made.draw()
    assert made.emitter._textures != textures and made.emitter.stamp != stamp
    surface = made.emitter.surface()
    assert surface is not None and np.abs(surface[0]).max() == pytest.approx(2.0)
    (tmp_path / "mesh.ply").unlink()
    textures = list(made.emitter._textures)
    with pytest.raises(MeshFileError, match=r"mesh\.ply does not exist"):
        made.draw()
    assert made.emitter._textures == textures


def test_bad_meshes_are_refused_and_the_last_good_one_stays(bench: Callable[..., Bench], tmp_path: Path) -> None:
    """No file, an open mesh asked for its volume, one without area."""
    made = bench(emitter="mesh")
    with pytest.raises(ParameterError, match=r"^emitter = mesh needs a file: set emitter_file"):
        made.draw()
    good = trimesh.creation.icosphere(1)
    good.export(tmp_path / "good.ply")
    made.draw(emitter_file=tmp_path / "good.ply")
    textures = list(made.emitter._textures)
    open_mesh = trimesh.Trimesh(good.vertices, good.faces[1:], process=False)
    open_mesh.export(tmp_path / "open.ply")
    with pytest.raises(MeshFileError, match=r"open\.ply cannot be emitted from: it is not closed"):
        made.draw(emitter_file=tmp_path / "open.ply", emit_from="volume")
    (tmp_path / "flat.obj").write_text("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")
    with pytest.raises(MeshFileError, match=r"flat\.obj has no area"):
        made.draw(emitter_file=tmp_path / "flat.obj", emit_from="surface")
    assert made.emitter._textures == textures
    made.draw(emitter_file=tmp_path / "good.ply")


def test_a_ball_turned_inside_out_still_emits_outwards(bench: Callable[..., Bench], tmp_path: Path) -> None:
    """A closed mesh has an outside, whichever way its file winds it."""
    ball = trimesh.creation.icosphere(2)
    trimesh.Trimesh(ball.vertices, ball.faces[:, ::-1], process=False).export(tmp_path / "inverted.stl")
    made = bench(emitter="mesh", emitter_file=tmp_path / "inverted.stl")
    for source in ("surface", "edge", "volume"):
        place, normal, _ = made.draw(emit_from=source)
        assert (np.einsum("ij,ij->i", place, normal) > 0).mean() > 0.995
