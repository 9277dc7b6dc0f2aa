"""Fish as meshes: closed pieces that hold together, alike on both sides, one metre long at every detail."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from viewer.kit.fish import (
    ANAL,
    BODY,
    DETAILS,
    DORSAL,
    EYE,
    PECTORAL,
    PELVIC,
    SPECIES,
    TAIL,
    FishError,
    fish,
    fish_mesh,
    fish_pieces,
    fish_rig,
    fish_skeleton,
)
from viewer.kit.fish_pieces import Piece

EVERY = [(species, detail) for species in SPECIES for detail in range(len(DETAILS))]
FINE = [(species, detail) for species, detail in EVERY if detail >= 2]


def solid(piece: Piece) -> trimesh.Trimesh:
    """A piece whose vertices at one place are one."""
    places, index = np.unique(piece.positions.round(9) + 0.0, axis=0, return_inverse=True)
    return trimesh.Trimesh(places, index.reshape(-1)[piece.triangles], process=False)


@pytest.mark.parametrize(("species", "detail"), FINE)
def test_each_piece_is_closed_and_faces_outwards(species: str, detail: int) -> None:
    """Like a ball without handles, with no empty triangle."""
    for name, piece in fish_pieces(species, detail).items():
        closed = solid(piece)
        assert closed.is_watertight and closed.is_winding_consistent and closed.euler_number == 2, name
        assert closed.volume > 0 and closed.area_faces.min() > 0 and closed.body_count == 1, name
        assert len(np.unique(piece.triangles)) >= len(piece.positions) - 2, name     # but for the seam at the poles


@pytest.mark.parametrize(("species", "detail"), EVERY)
def test_normals_point_the_way_their_triangles_face(species: str, detail: int) -> None:
    """For every triangle of the fish: the corners' normals point to the side from which it is counter-clockwise."""
    mesh = fish(species, detail)
    a, b, c = np.moveaxis(mesh.positions[mesh.triangles].astype(float), 1, 0)
    assert (np.einsum("ij,ij->i", np.cross(b - a, c - a), mesh.normals[mesh.triangles].sum(axis=1)) > 0).all()
    assert np.allclose(np.linalg.norm(mesh.normals, axis=1), 1, atol=1e-6)


@pytest.mark.parametrize(("species", "detail"), EVERY)
def test_a_fish_is_one_metre_long(species: str, detail: int) -> None:
    """Nose at +0.5, tail tip at -0.5, to the last digit of float32; and the body's nose is the pole."""
    mesh = fish(species, detail)
    assert mesh.positions[:, 0].max() == pytest.approx(0.5, abs=1e-7)
    assert mesh.positions[:, 0].min() == pytest.approx(-0.5, abs=1e-7)
    assert mesh.parts[mesh.positions[:, 0].argmin()] == TAIL
    assert mesh.coordinates[mesh.positions[:, 0].argmax(), 0] == 0.0


@pytest.mark.parametrize(("species", "detail"), EVERY)
def test_left_and_right_are_mirror_images(species: str, detail: int) -> None:
    """Of every vertex there is one on the other side, with the mirrored normal and of the same part."""
    mesh = fish(species, detail)
    rows = np.column_stack([mesh.positions, mesh.normals, mesh.parts]).astype(float)
    mirrored = rows * np.array([1, 1, -1, 1, 1, -1, 1])
    away, _ = cKDTree(mirrored).query(rows)
    assert away.max() < 1e-5


@pytest.mark.parametrize(("detail", "least", "most"), [(0, 60, 120), (1, 400, 1000), (2, 2500, 6000),
                                                       (3, 15000, 25000), (4, 45000, 65536)])
def test_details_keep_to_their_number_of_vertices(detail: int, least: int, most: int) -> None:
    """Any species; and whatever is made is used, but for the poles' ends of the seam."""
    for species in SPECIES:
        mesh = fish(species, detail)
        assert least <= len(mesh.positions) <= most, species
        assert len(mesh.positions) - len(np.unique(mesh.triangles)) <= 10


@pytest.mark.parametrize("detail", [1, 2])
@pytest.mark.parametrize("species", SPECIES)
def test_fins_eyes_and_barbels_stand_in_the_body(species: str, detail: int) -> None:
    """The whole of each root is inside the body and most else is outside: nothing floats, nothing is lost within."""
    pieces = fish_pieces(species, detail)
    body = pieces.pop("body")
    for name, piece in pieces.items():
        some = np.random.default_rng(0).choice(len(piece.positions), 60)
        inside = winding(piece.positions[some], body.positions[body.triangles]) > 0.5
        assert inside.mean() < (0.8 if "eye" in name else 0.6), name
        if piece.parts[0] in (BODY, EYE):
            assert inside.any(), name
        else:
            root = piece.positions[piece.coordinates[:, 1] == 0][::3]
            assert (winding(root, body.positions[body.triangles]) > 0.5).all(), name


def winding(points: NDArray[np.float64], corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """How often triangles (m, 3, 3) go around each point: 1 inside (Van Oosterom and Strackee 1983)."""
    a, b, c = np.moveaxis(corners - points[:, None, None], 2, 0)
    la, lb, lc = (np.linalg.norm(each, axis=-1) for each in (a, b, c))
    upper = np.einsum("pti,pti->pt", a, np.cross(b, c))
    dots = [np.einsum("pti,pti->pt", *pair) for pair in ((a, b), (b, c), (c, a))]
    return np.arctan2(upper, la * lb * lc + dots[0] * lc + dots[1] * la + dots[2] * lb).sum(axis=1) / (2 * np.pi)


@pytest.mark.parametrize("species", SPECIES)
def test_parts_tell_left_from_right_by_z(species: str) -> None:
    """Paired fins and eyes lie on their own side; the others in the middle, within their thickness."""
    mesh = fish(species)
    for part in (PECTORAL, PELVIC, EYE):
        assert (np.abs(mesh.positions[mesh.parts == part, 2]) > 1e-3).all()
    for part in (TAIL, DORSAL, ANAL):
        assert (mesh.parts == part).any()
        assert np.abs(mesh.positions[mesh.parts == part, 2]).max() < 0.011
    left = fish_pieces(species)["left pectoral"]
    assert left.positions[:, 2].max() < 0


@pytest.mark.parametrize(("species", "detail"), EVERY)
def test_coordinates_run_along_and_around(species: str, detail: int) -> None:
    """0 to 1 on body and fins, -1 to 1 on the eyes' discs; a quarter of the way around is the left flank."""
    mesh = fish(species, detail)
    on_eye = mesh.parts == EYE
    assert mesh.coordinates[~on_eye].min() == 0 and mesh.coordinates[~on_eye].max() == 1
    assert (np.linalg.norm(mesh.coordinates[on_eye], axis=1) <= 1 + 1e-6).all()
    body = fish_pieces(species, detail)["body"]
    along, around = body.coordinates.T
    flank = (along > 0.1) & (along < 0.9) & (body.positions[:, 2] != 0)
    assert ((body.positions[flank, 2] < -1e-9) == (around[flank] < 0.5))[np.abs(around[flank] - 0.5) < 0.499].all()
    jump = np.ptp(around[body.triangles], axis=1)
    assert jump.max() < 0.25        # no triangle smears once around


@pytest.mark.parametrize("species", SPECIES)
def test_eyes_look_out_with_the_pupil_in_the_middle(species: str) -> None:
    """The pupil's normal points away from the fish, x on the disc is ahead and y up, on both sides."""
    for side, sign in (("left", -1), ("right", 1)):
        eye = fish_pieces(species, 3)[f"{side} eye"]
        pupil = np.flatnonzero((np.abs(eye.coordinates).max(axis=1) < 1e-9) & (eye.normals[:, 2] * sign > 0))
        assert len(pupil) == 1 and eye.normals[pupil[0], 2] * sign > 0.5
        ahead, up = eye.coordinates.argmax(axis=0)
        middle = eye.positions[pupil[0]]
        assert eye.positions[ahead, 0] > middle[0] and eye.positions[up, 1] > middle[1]


def test_the_eel_wears_one_ribbon() -> None:
    """Back, tail and belly fin are one piece, in this order along its root."""
    ribbon = fish_pieces("eel")["dorsal 0"]
    along = [ribbon.coordinates[ribbon.parts == part, 0] for part in (DORSAL, TAIL, ANAL)]
    assert along[0].max() < along[1].min() < along[1].max() < along[2].min()
    assert not any("tail" in name or "anal" in name or "pelvic" in name for name in fish_pieces("eel"))


def test_a_mesh_for_all_who_want_shared_vertices() -> None:
    """`fish_mesh` is closed as it stands, and of the same size."""
    vertices, triangles = fish_mesh()
    assert vertices.dtype == np.float64 and triangles.dtype == np.int32
    whole = trimesh.Trimesh(vertices, triangles, process=False)
    assert whole.is_watertight and whole.is_winding_consistent
    assert whole.euler_number == 2 * len(fish_pieces("koi"))
    assert whole.volume == pytest.approx(sum(solid(piece).volume for piece in fish_pieces("koi").values()), rel=1e-5)


def test_what_is_shared_by_all_cannot_be_changed() -> None:
    """Neither a mesh without its seams, nor joints and how they are bound."""
    rig = fish_rig("koi", 0)
    skeleton = rig.skeleton
    assert fish_skeleton("koi") is skeleton
    assert not any(array.flags.writeable for array in (
        *fish_mesh("koi", 0), rig.bones, rig.inverse_bind, skeleton.parents, skeleton.translations,
        skeleton.rotations, skeleton.scales))


def test_meshes_are_shared_and_cannot_be_changed() -> None:
    """Asking again costs nothing, so nobody may write into what others hold."""
    assert fish("koi", 1) is fish("koi", 1)
    with pytest.raises(ValueError, match="read-only"):
        fish("koi", 1).positions[0, 0] = 7.0
    assert (fish("koi", 1).parts == BODY).any()


@pytest.mark.parametrize(("species", "detail", "message"), [
    ("shark", 3, "species = shark is none of clownfish, tuna, koi, eel"),
    ("koi", 5, "detail = 5 is outside 0 to 4"), ("koi", -1, "detail = -1 is outside 0 to 4")])
def test_what_there_is_not_is_refused(species: str, detail: int, message: str) -> None:
    """In one line that names it."""
    with pytest.raises(FishError, match=message):
        fish(species, detail)
