"""Numbers of meshes, against trimesh and SciPy."""

from __future__ import annotations

import math

import numpy as np
import pytest
import trimesh
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from viewer.kit.marching import marching_cubes
from viewer.kit.mesh import cube_sphere, ico_sphere
from viewer.kit.mesh_measure import area, components, mesh_numbers, unique_edges, volume

EMPTY = np.empty((0, 3), np.float32), np.empty((0, 3), np.int32)


@pytest.mark.parametrize("method", ["cubes", "tetrahedra"])
@pytest.mark.parametrize("closed", [True, False])
@pytest.mark.parametrize("seed", range(4))
def test_numbers_of_noise(seed: int, closed: bool, method: str) -> None:
    """Of surfaces in many pieces with many holes: as trimesh counts and measures."""
    values = np.random.default_rng(seed).normal(size=(7, 6, 8))
    if closed:
        values = np.pad(values, 1, constant_values=1.0)
    vertices, triangles = marching_cubes(values, -1.2, (1.0, 0.5, 2.0), method)
    found = mesh_numbers(vertices, triangles)
    peer = trimesh.Trimesh(vertices.astype(np.float64), triangles, process=False)
    assert (found.vertices, found.triangles) == (len(vertices), len(triangles))
    assert found.euler_characteristic == peer.euler_number
    assert found.components == peer.body_count > 1
    assert found.area == pytest.approx(peer.area)
    assert peer.is_watertight == closed
    assert found.volume == pytest.approx(peer.volume) if closed else math.isnan(found.volume)


def test_edges_are_listed_once_with_their_uses() -> None:
    """Smaller vertex first, ascending."""
    triangles = np.array([[0, 1, 2], [2, 1, 3], [4, 2, 1]])
    edges, uses = unique_edges(triangles, 5)
    assert dict(zip(map(tuple, edges.tolist()), uses.tolist(), strict=True)) == {
        (0, 1): 1, (0, 2): 1, (1, 2): 3, (1, 3): 1, (2, 3): 1, (1, 4): 1, (2, 4): 1}
    solid = trimesh.Trimesh(*cube_sphere(5), process=False)
    edges, uses = unique_edges(solid.faces, len(solid.vertices))
    assert np.array_equal(edges, np.array(sorted(map(tuple, solid.edges_unique.tolist())))) and (uses == 2).all()


def test_spheres_have_the_volume_of_spheres() -> None:
    """Also far from the middle of the world, and inside out."""
    vertices, triangles = ico_sphere(5)
    for places in (vertices, vertices + 1e5, (vertices + 50.0).astype(np.float32)):
        found = mesh_numbers(places, triangles)
        assert found.volume == pytest.approx(4.0 * math.pi / 3.0, rel=2e-3)
        assert found.area == pytest.approx(4.0 * math.pi, rel=2e-3)
    assert (found.euler_characteristic, found.components) == (2, 1)
    assert volume(vertices, triangles[:, ::-1]) == pytest.approx(-4.0 * math.pi / 3.0, rel=2e-3)


def test_only_closed_meshes_have_a_volume() -> None:
    """Not one with a hole, nor one where four triangles meet."""
    vertices, triangles = cube_sphere(1)
    assert math.isnan(mesh_numbers(vertices, triangles[1:]).volume)
    twice = np.concatenate([triangles, triangles])
    assert math.isnan(mesh_numbers(vertices, twice).volume)
    assert mesh_numbers(vertices, twice).area == pytest.approx(2.0 * area(vertices, triangles))


def test_nothing_has_no_size() -> None:
    """Zero throughout, and a single triangle is half its base times its height."""
    assert mesh_numbers(*EMPTY) == (0, 0, 0, 0, 0.0, 0.0)
    single = mesh_numbers(np.array([[0.0, 0.0, 5.0], [3.0, 0.0, 5.0], [0.0, 4.0, 5.0]]), np.array([[0, 1, 2]]))
    assert single[:5] == (3, 1, 1, 1, 6.0)


@pytest.mark.parametrize("seed", range(12))
def test_pieces_of_random_graphs(seed: int) -> None:
    """From lone vertices to one piece; chains and stars with their vertices numbered at random too."""
    chance = np.random.default_rng(seed)
    count = int(chance.integers(1, 400))
    shuffled = chance.permutation(count)
    chain = np.stack([shuffled[:-1], shuffled[1:]], axis=1)
    star = np.stack([np.full(count, shuffled[0]), shuffled], axis=1)
    for edges in (chance.integers(0, count, (int(count * chance.random() * 1.5), 2)), chain, chain[::2], star,
                  np.stack([np.arange(count - 1), np.arange(1, count)], axis=1), np.empty((0, 2), np.int64)):
        graph = coo_array((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), (count, count))
        assert components(edges.astype(np.int64), count) == connected_components(graph, directed=False)[0]
