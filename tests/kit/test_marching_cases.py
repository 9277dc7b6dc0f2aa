"""The case tables, against what the signs of a cell's corners alone dictate."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from tests.kit.surface_checks import METHODS
from viewer.kit.marching_cases import CORNERS, FACES, TETRAHEDRA, Edge, ambiguous_faces, case_table, middle

# The lecture's list, which has corner 2 where 3 belongs.
WRONG_TETRAHEDRA = ((0, 1, 2, 7), *TETRAHEDRA[1:])
CELL_EDGES = [(a, b) for a in range(8) for b in range(a + 1, 8) if np.abs(CORNERS[a] - CORNERS[b]).sum() == 1]


def ends(edge: Edge) -> tuple[int, int]:
    """The corners that an edge joins."""
    return edge[0], edge[0] + edge[1]


def inside_corners(case: int) -> set[int]:
    """The corners that are inside."""
    return {corner for corner in range(8) if case >> corner & 1}


def crossed(case: int) -> set[tuple[int, int]]:
    """The cell's edges between a corner inside and one outside."""
    return {(a, b) for a, b in CELL_EDGES if (a in inside_corners(case)) != (b in inside_corners(case))}


def outline(method: str, case: int) -> set[tuple[Edge, Edge]]:
    """The sides that only one triangle of a case has, in its direction."""
    sides = Counter((t[i], t[(i + 1) % 3]) for t in case_table(method).cases[case] for i in range(3))
    assert all(count == 1 for count in sides.values())
    return {side for side in sides if side[::-1] not in sides}


def pieces(count: int, pairs: list[tuple[int, int]]) -> NDArray[np.int32]:
    """Which piece each of ``count`` things belongs to once pairs are joined."""
    rows, columns = np.array(pairs, int).reshape(-1, 2).T
    return np.asarray(connected_components(coo_array((np.ones(len(rows)), (rows, columns)), (count, count)), False)[1])


def loops_dictated(case: int) -> int:
    """How many closed curves part inside from outside on the cell's boundary, inside corners parted on each face.

    The boundary is a sphere: each closed curve on it makes one region more.
    """
    inside = inside_corners(case)
    joined = [pair for pair in CELL_EDGES if (pair[0] in inside) == (pair[1] in inside)]
    for a, b, c, d in FACES:
        if {a, c} == inside & {a, b, c, d}:
            joined.append((b, d))
        if {b, d} == inside & {a, b, c, d}:
            joined.append((a, c))
    return int(pieces(8, joined).max())


def holding(tetrahedra: tuple[tuple[int, ...], ...], points: NDArray[np.float64]) -> NDArray[np.intp]:
    """How many of the tetrahedra each point is in, by its barycentric coordinates."""
    count = np.zeros(len(points), np.intp)
    for corners in tetrahedra:
        matrix = np.vstack([CORNERS[list(corners)].T, np.ones(4)])
        count += (np.linalg.solve(matrix, np.vstack([points.T, np.ones(len(points))])) > 0.0).all(axis=0)
    return count


def test_faces_are_seen_from_outside_and_name_their_plane() -> None:
    """Face 2 a + s lies at s on axis a, its corners counter-clockwise."""
    for face, corners in enumerate(FACES):
        a, b, c, d = CORNERS[list(corners)]
        axis, side = divmod(face, 2)
        assert (CORNERS[list(corners), axis] == side).all()
        assert np.array_equal(a + c, b + d)
        assert np.cross(b - a, c - b)[axis] == 2 * side - 1


@pytest.mark.parametrize(("method", "most"), [("cubes", 5), ("tetrahedra", 12)])
def test_vertices_lie_on_crossed_edges(method: str, most: int) -> None:
    """In all 256 cases; three different ones a triangle, and no more triangles than there can be."""
    table = case_table(method)
    assert len(table.cases) == 256 and table.counts.tolist() == list(map(len, table.cases))
    assert table.counts.max() == most
    for case, triangles in enumerate(table.cases):
        used = {edge for triangle in triangles for edge in triangle}
        assert all(len({*triangle}) == 3 for triangle in triangles)
        assert all((ends(edge)[0] in inside_corners(case)) != (ends(edge)[1] in inside_corners(case)) for edge in used)
        assert {ends(edge) for edge in used if edge[1] in (1, 2, 4)} == crossed(case)
        assert bool(triangles) == (case not in (0, 255))
    assert set(table.edges) == {edge for case in table.cases for triangle in case for edge in triangle}
    assert set(table.directions) == {edge[1] for edge in table.edges}
    assert len(table.edges) == {"cubes": 12, "tetrahedra": 19}[method]


def test_cubes_have_one_sheet_for_each_loop() -> None:
    """As many sheets as the signs dictate, each a disc: n corners, n - 2 triangles, Euler characteristic 1."""
    for case, triangles in enumerate(case_table("cubes").cases):
        edges = sorted({edge for triangle in triangles for edge in triangle})
        sides = {frozenset((edges.index(t[i]), edges.index(t[i - 1]))) for t in triangles for i in range(3)}
        sheets = len(np.unique(pieces(len(edges), [(min(side), max(side)) for side in sides])))
        assert sheets == loops_dictated(case)
        assert len(triangles) == len(crossed(case)) - 2 * sheets
        assert len(edges) - len(sides) + len(triangles) == sheets
        assert len(outline("cubes", case)) == len(edges)


def test_lines_on_a_face_follow_from_its_own_signs() -> None:
    """Seen from outside, a line has the inside to its right; an inside corner opposite another is cut off alone."""
    for case in range(256):
        inside, lines = inside_corners(case), {(ends(a), ends(b)) for a, b in outline("cubes", case)}
        expected = set()
        for corners in FACES:
            around = [corner in inside for corner in corners]
            steps = {place: tuple(sorted((corners[place], corners[(place + 1) % 4]))) for place in range(4)}
            entering = [i for i in range(4) if not around[i] and around[(i + 1) % 4]]
            for enter in entering:
                leave = next(i % 4 for i in range(enter + 1, enter + 4) if around[i % 4] and not around[(i + 1) % 4])
                expected.add((steps[enter], steps[leave]))
        assert lines == expected


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("axis", range(3))
def test_neighbours_draw_the_same_lines(method: str, axis: int) -> None:
    """On the face between two cells, one from each side, whatever the rest of either cell is."""
    step = 1 << axis
    upper, lower = {}, {}
    for case in range(256):
        signs = tuple(case >> corner & 1 for corner in range(8) if not corner & step)
        far_signs = tuple(case >> corner & 1 for corner in range(8) if corner & step)
        sides = outline(method, case)
        near = {pair for pair in sides if all(not corner & step for edge in pair for corner in ends(edge))}
        far = {pair for pair in sides if all(corner & step for edge in pair for corner in ends(edge))}
        moved = {((a[0] ^ step, a[1]), (b[0] ^ step, b[1])) for b, a in far}
        assert lower.setdefault(signs, near) == near
        assert upper.setdefault(far_signs, moved) == moved
    assert lower == upper and len(lower) == 16


def test_no_side_inside_a_cell_lies_in_a_face() -> None:
    """There a third and a fourth triangle might meet it."""
    faces = [set(corners) for corners in FACES]
    for case, triangles in enumerate(case_table("cubes").cases):
        sides = {(t[i], t[(i + 1) % 3]) for t in triangles for i in range(3)}
        for first, second in sides - outline("cubes", case):
            assert not any({*ends(first), *ends(second)} <= face for face in faces)


def test_exchanging_signs_turns_a_case_over_unless_a_face_is_ambiguous() -> None:
    """Where one is, inside stays parted: a table that stores only half the cases and turns them would crack."""
    different = 0
    for case in range(256):
        turned = {side[::-1] for side in outline("cubes", 255 - case)}
        same = outline("cubes", case) == turned
        assert same == (not ambiguous_faces(case))
        different += not same
    assert different > 100


def test_ambiguous_faces_are_checkerboards() -> None:
    """Each of the six faces in 2 of 16 patterns, so in 32 of 256 cases; all six in two cases."""
    counts = Counter(face for case in range(256) for face in ambiguous_faces(case))
    assert counts == dict.fromkeys(range(6), 32)
    assert [case for case in range(256) if len(ambiguous_faces(case)) == 6] == [0b01101001, 0b10010110]
    assert ambiguous_faces(0b00001001) == [4] and ambiguous_faces(0b00000110) == [4]


@pytest.mark.parametrize("method", METHODS)
def test_triangles_face_the_larger_values(method: str) -> None:
    """One corner inside, or all but one: the normal points away from the inside."""
    for corner in range(8):
        for case, sign in ((1 << corner, 1), (255 - (1 << corner), -1)):
            corners = np.array([[middle(edge) for edge in triangle] for triangle in case_table(method).cases[case]])
            normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
            away = corners.mean(axis=1) - CORNERS[corner]
            assert (sign * np.einsum("ij,ij->i", normals, away) > 0.0).all()


def test_the_middle_of_an_edge_is_between_its_ends() -> None:
    """For every edge of either table."""
    for method in METHODS:
        for edge in case_table(method).edges:
            assert np.array_equal(middle(edge), CORNERS[list(ends(edge))].mean(axis=0))


def test_six_tetrahedra_fill_the_cell() -> None:
    """Each a sixth of it; every point is in one, and the diagonals of opposite faces match."""
    volumes = [abs(np.linalg.det(CORNERS[list(t[1:])] - CORNERS[t[0]])) / 6.0 for t in TETRAHEDRA]
    assert np.allclose(volumes, 1.0 / 6.0)
    points = np.random.default_rng(1).random((4000, 3))
    assert (holding(TETRAHEDRA, points) == 1).all()
    pairs = {frozenset((a, b)) for t in TETRAHEDRA for a in t for b in t if a != b}
    for axis in range(3):
        near = {pair for pair in pairs if not any(corner >> axis & 1 for corner in pair)}
        far = {pair for pair in pairs if all(corner >> axis & 1 for corner in pair)}
        assert {frozenset(corner | 1 << axis for corner in pair) for pair in near} == far and len(near) == 5


def test_the_lectures_tetrahedra_overlap() -> None:
    """With 0, 1, 2, 7 for 0, 1, 3, 7 the volumes still add up, but part of the cell is in two and part in none."""
    volumes = [abs(np.linalg.det(CORNERS[list(t[1:])] - CORNERS[t[0]])) / 6.0 for t in WRONG_TETRAHEDRA]
    assert np.allclose(volumes, 1.0 / 6.0)
    found = holding(WRONG_TETRAHEDRA, np.random.default_rng(1).random((4000, 3)))
    assert (found == 2).mean() == pytest.approx(1.0 / 12.0, abs=0.02)
    assert (found == 0).mean() == pytest.approx(1.0 / 12.0, abs=0.02)


def test_an_unknown_method_is_refused() -> None:
    """As documented, with KeyError."""
    with pytest.raises(KeyError):
        case_table("spheres")
