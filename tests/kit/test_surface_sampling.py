"""Tables to draw points from: the chances they give, edges and their angles, and what lies inside."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

from tests.kit.surface_checks import triangle_soup
from viewer.kit import mesh, shapes
from viewer.kit.interior_points import clearance, interior_spans, volume_table
from viewer.kit.surface_sampling import (
    alias_table,
    edge_table,
    faces_inward,
    is_closed,
    mesh_edges,
    surface_table,
    welded,
)

CHANCE = np.random.default_rng(8)


def chances(threshold: NDArray[np.float64], alias: NDArray[np.int64]) -> NDArray[np.float64]:
    """How likely each entry is, added up over who chooses it."""
    count = len(threshold)
    return (threshold + np.bincount(alias, 1 - threshold, count)) / count


@pytest.mark.parametrize("weights", [
    CHANCE.random(1000), CHANCE.random(1000) ** 30, np.ones(7), np.array([3.0]), np.eye(9)[4], np.full(3, 1e-300),
    np.where(np.arange(100) % 3 == 0, CHANCE.random(100), 0.0), np.array([1e-12, 1.0, 1e12]), np.arange(5000.0) ** 4,
])
def test_an_alias_table_gives_each_weight_its_chance(weights: NDArray[np.float64]) -> None:
    """To the rounding of sums."""
    threshold, alias = alias_table(weights)
    assert (threshold >= 0).all() and (threshold <= 1).all() and set(alias) <= set(range(len(weights)))
    expected = weights / weights.sum()
    assert np.allclose(chances(threshold, alias), expected, rtol=1e-9, atol=1e-12)
    assert (chances(threshold, alias)[expected == 0] == 0).all()


def test_a_million_weights_keep_their_chances_in_single_precision() -> None:
    """As the shader has them: a threshold is a part of one entry, not of all."""
    weights = CHANCE.random(1_000_000)
    threshold, alias = alias_table(weights)
    found = chances(threshold.astype(np.float32).astype(np.float64), alias.astype(np.float32).astype(np.int64))
    assert np.abs(found * 1e6 - weights / weights.mean()).max() < 1e-5


def test_surface_entries_are_triangles_by_area() -> None:
    """Those without area left out; face normals where the mesh has none of its own."""
    vertices, triangles = shapes.box((1, 2, 3))
    table = surface_table(vertices, np.concatenate([triangles, [[0, 0, 1], [2, 2, 2]]]).astype(np.int32))
    assert table.places.shape == (12, 3, 4) and table.normals.shape == (12, 3, 3)
    area = trimesh.Trimesh(vertices, triangles, process=False).area_faces
    found = chances(table.places[:, 0, 3].astype(float), table.places[:, 1, 3].astype(int))
    assert np.allclose(found, area / area.sum(), atol=1e-7)
    assert np.allclose(table.normals, shapes.face_normals(vertices, triangles)[:, None])
    assert np.array_equal(table.places[:, :, :3], vertices[triangles])


def test_normals_of_the_mesh_count_where_they_look_outwards() -> None:
    """Not one that is zero, nor one that points into its triangle."""
    vertices, triangles = mesh.ico_sphere(1)
    own = vertices.copy()
    own[0], own[1] = 0.0, -own[1]
    table = surface_table(vertices, triangles, own)
    faces = shapes.face_normals(vertices, triangles)
    for vertex in (0, 1):
        where = triangles == vertex
        assert np.allclose(table.normals[where], np.repeat(faces, 3, axis=0).reshape(-1, 3, 3)[where], atol=1e-6)
    assert np.allclose(table.normals[triangles > 1], vertices[triangles[triangles > 1]], atol=1e-6)


def test_edges_agree_with_trimesh() -> None:
    """As many, and sharp where neighbouring faces meet at more than 30 degrees."""
    for vertices, triangles in (shapes.cone(1, 2, 24, 3), shapes.torus(1, 0.4, 13, 7), mesh.ico_sphere(2)):
        solid = trimesh.Trimesh(vertices, triangles, process=False)
        edges = mesh_edges(vertices, triangles)
        assert len(edges.ends) == len(solid.edges_unique)
        sharp = solid.face_adjacency_edges[solid.face_adjacency_angles > np.radians(30)]
        assert set(map(tuple, np.sort(edges.ends[edges.marked], axis=1).tolist())) == set(map(tuple, sharp.tolist()))
        assert np.allclose(np.linalg.norm(edges.normals, axis=1), 1)


def test_borders_and_edges_of_many_faces_are_marked() -> None:
    """A square's diagonal is not; a book's spine is."""
    edges = mesh_edges(*shapes.square(1.0))
    assert len(edges.ends) == 5 and edges.marked.sum() == 4
    assert np.allclose(edges.normals, [0, 1, 0])
    spine = np.array([[0, 0, 0], [0, 0, 1], [1, 0, 0], [1, 0.1, 0], [1, 0.2, 0.0]])
    book = mesh_edges(spine, np.array([[0, 1, 2], [1, 0, 3], [0, 1, 4]], np.int32))
    assert book.marked.all() and np.isfinite(book.normals).all()


def test_where_no_edge_is_sharp_all_of_them_count() -> None:
    """By length; and with vertices written for each triangle anew as without."""
    vertices, triangles = mesh.ico_sphere(3)
    table = edge_table(vertices, triangles)
    assert table.places.shape == (len(triangles) * 3 // 2, 2, 4) and table.normals.shape[1:] == (1, 3)
    soup, own = triangle_soup(vertices, triangles)
    again = edge_table(soup, own)
    assert len(again.places) == len(table.places)
    length = np.linalg.norm(table.places[:, 0, :3] - table.places[:, 1, :3], axis=1)
    found = chances(table.places[:, 0, 3].astype(float), table.places[:, 1, 3].astype(int))
    assert np.allclose(found, length / length.sum(), atol=1e-7)


def test_vertices_at_one_place_are_one() -> None:
    """Minus zero is zero; neighbours of the last bit are two."""
    vertices = np.array([[0.0, 1, 2], [-0.0, 1, 2], [0, np.nextafter(1, 2), 2], [5, 5, 5]])
    assert welded(vertices, np.array([[0, 1, 2], [3, 1, 0]], np.int32)).tolist() == [[0, 0, 2], [3, 0, 0]]


def test_closed_means_an_inside() -> None:
    """Also for two solids at once, not with a triangle missing or turned."""
    vertices, triangles = mesh.ico_sphere(1)
    assert is_closed(vertices, triangles) and not faces_inward(vertices, triangles)
    assert faces_inward(vertices, triangles[:, ::-1])
    assert not is_closed(vertices, triangles[1:]) and not faces_inward(vertices, triangles[1:, ::-1])
    turned = triangles.copy()
    turned[0] = turned[0, ::-1]
    assert not is_closed(vertices, turned)
    soup, own = triangle_soup(vertices, triangles)
    assert is_closed(soup, own)


SOLIDS = {"torus": (shapes.torus(1.0, 0.3), 2 * np.pi**2 * 0.09), "box": (shapes.box((1, 0.05, 2)), 0.8),
          "cone": (shapes.cone(1, 2), 2 * np.pi / 3), "sphere": (mesh.ico_sphere(4), 4 * np.pi / 3)}


@pytest.mark.parametrize("name", SOLIDS)
def test_lines_inside_add_up_to_the_volume(name: str) -> None:
    """A square of the lattice for each line."""
    (vertices, triangles), volume = SOLIDS[name]
    spans, square = interior_spans(vertices, triangles, np.random.default_rng(2))
    assert (spans.high - spans.low).sum() * square == pytest.approx(volume, rel=0.01)


def test_solids_may_overlap_and_hold_a_hollow() -> None:
    """Two boxes count once where they overlap; a shell turned inside out is empty."""
    one, triangles = shapes.box((1, 1, 1))
    both = np.concatenate([one, one + np.array([1, 0, 0])]), np.concatenate([triangles, triangles + 8])
    spans, square = interior_spans(*both, np.random.default_rng(2))
    assert (spans.high - spans.low).sum() * square == pytest.approx(12, rel=0.01)
    hollow = np.concatenate([one, 0.5 * one]), np.concatenate([triangles, triangles[:, ::-1] + 8])
    spans, square = interior_spans(*hollow, np.random.default_rng(2))
    assert (spans.high - spans.low).sum() * square == pytest.approx(7, rel=0.01)
    points = volume_table(*hollow, count=4096).places[:, 0, :3]
    assert np.abs(points).max(axis=1).min() >= 0.5


@pytest.mark.parametrize("name", SOLIDS)
def test_points_inside_have_the_room_they_claim(name: str) -> None:
    """Against the distance to the nearest triangle by trimesh; the same ones in every run."""
    (vertices, triangles), _ = SOLIDS[name]
    if name == "torus":
        vertices, triangles = shapes.torus(1.0, 0.3, 24, 12)
    table = volume_table(vertices, triangles, count=8192)
    assert np.array_equal(table.places, volume_table(vertices, triangles, count=8192).places)
    some = table.places[::40, 0].astype(np.float64)
    corners = vertices[triangles]
    nearest = np.array([np.linalg.norm(trimesh.triangles.closest_point(corners, np.broadcast_to(
        place[:3], (len(corners), 3))) - place[:3], axis=1).min() for place in some])
    assert (some[:, 3] <= nearest + 1e-6).all()
    assert (some[:, 3] > 0).mean() > (0.5 if name != "box" else 0.1)
    assert np.allclose(np.linalg.norm(table.normals, axis=2), 1, atol=1e-5)


def test_room_is_never_overestimated_for_large_triangles() -> None:
    """A ball's size as told beside a big flat side."""
    room, nearest = clearance(*shapes.box((1, 1, 1)), np.array([[0.9, 0, 0], [0.0, -0.95, 0.3], [0, 0, 0]]), 0.3)
    assert 0.0 < room[0] <= 0.1 and 0.0 <= room[1] <= 0.05 and room[2] == 0.3
    normals = shapes.face_normals(*shapes.box((1, 1, 1)))[nearest]
    assert np.allclose(normals[:2], [[1, 0, 0], [0, -1, 0]])


def test_nothing_to_draw_from_is_refused() -> None:
    """No area, no inside."""
    flat = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0.0]])
    with pytest.raises(ValueError, match="nothing to draw points from"):
        surface_table(flat, np.array([[0, 1, 2]], np.int32))
    vertices, triangles = shapes.square(1.0)
    with pytest.raises(ValueError, match="encloses no volume"):
        volume_table(vertices, np.concatenate([triangles, triangles[:, ::-1]]))
