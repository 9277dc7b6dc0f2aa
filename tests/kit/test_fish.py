"""The fish: one metre long, in closed pieces that hold together, alike on both sides."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from viewer.kit.fish import STALK_END, body_section, fish_mesh, fish_pieces


@pytest.mark.parametrize(("rings", "segments", "rays"), [(96, 64, 14), (8, 6, 2), (200, 100, 24)])
def test_each_piece_is_closed_and_faces_outwards(rings: int, segments: int, rays: int) -> None:
    """Like a ball without handles, at any resolution."""
    for name, (vertices, triangles) in fish_pieces(rings, segments, rays).items():
        solid = trimesh.Trimesh(vertices, triangles, process=False)
        assert solid.is_watertight and solid.is_winding_consistent and solid.euler_number == 2, name
        assert solid.volume > 0 and solid.area_faces.min() > 0 and solid.body_count == 1, name
        assert len(np.unique(triangles)) == len(vertices), name


def test_the_fish_is_its_pieces_and_one_metre_long() -> None:
    """Nose at +x; no thicker than it is high."""
    vertices, triangles = fish_mesh()
    assert vertices.dtype == np.float64 and triangles.dtype == np.int32
    assert len(triangles) == sum(len(piece[1]) for piece in fish_pieces().values())
    assert vertices[:, 0].min() == pytest.approx(-0.5) and vertices[:, 0].max() == 0.5
    length, height, width = np.ptp(vertices, axis=0)
    assert length > height > width > 0.2


def test_left_and_right_are_mirror_images() -> None:
    """Each piece, or each pair."""
    pieces = fish_pieces()
    for name in (name for name in pieces if "right" not in name):
        vertices = pieces[name][0]
        other = pieces[name.replace("left", "right")][0]
        own, mirrored = (np.sort(each.round(7), axis=0) for each in (vertices * [1, 1, -1] + 0.0, other))
        assert np.allclose(own, mirrored, atol=1e-6), name


def test_fins_and_eyes_stand_in_the_body() -> None:
    """Some of each is inside, some outside."""
    body = trimesh.Trimesh(*fish_pieces()["body"], process=False)
    for name, (vertices, _) in fish_pieces().items():
        height, width, middle = body_section(vertices[:, 0])
        with np.errstate(divide="ignore", invalid="ignore"):
            reach = ((vertices[:, 1] - middle) / height) ** 2 + (vertices[:, 2] / (0.86 * width)) ** 2
        if name != "body":
            assert (reach < 0.95).any() and (~(reach < 1.1)).any(), name
    assert body.bounds[0][0] == pytest.approx(STALK_END)


def test_the_body_is_slimmest_before_its_tail() -> None:
    """A stalk, and no more body beyond its ends."""
    x = np.linspace(-0.3, 0.4, 141)
    height, width, _ = body_section(x)
    assert x[np.argmax(height)] == pytest.approx(0.16, abs=0.03)
    assert height[:10].max() < 0.4 * height.max()
    assert (width < height).all()
    assert np.allclose(body_section([0.6, -0.4])[0], 0, atol=1e-9)
