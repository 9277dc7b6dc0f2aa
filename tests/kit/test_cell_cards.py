"""Cells as models and cards: what is drawn where, and whether what is written is true."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial.transform import Rotation

from tests.kit.surface_checks import METHODS
from viewer.kit import cell_words, surface_words
from viewer.kit.cell_cards import CellCard, Look, case_at, microscope_card, room_for_card, sheet_card
from viewer.kit.cell_model import (
    INSIDE,
    NO_VALUE,
    OUTSIDE,
    case_classes,
    case_triangles,
    microscope_model,
    rotations,
    sheet_frames,
)
from viewer.kit.marching_cases import CORNERS, FACES, case_table
from viewer.kit.marching_cell import Cell, edge_name, examine
from viewer.kit.models import BALLS, RODS, WORLD, Model, box_edges, in_picture, rgb
from viewer.kit.models import FACES as FACE_NUMBERS

ASPECTS = (0.6, 1.0, 1.6, 2.4)
FRAME = (0.2, -0.3, 0.5)
ORANGE = (0.9, 0.5, 0.2)
CHECKERBOARD = np.array([-1.0, 1.0, 1.0, -3.0, 1.0, 1.0, 1.0, 1.0])


def view(yaw: float = 30.0, pitch: float = 20.0) -> NDArray[np.float64]:
    """A camera's rotation: its columns are the directions to the right, up, and to the eye."""
    matrix = np.eye(4)
    matrix[:3, :3] = Rotation.from_euler("YX", [yaw, -pitch], degrees=True).as_matrix()
    return matrix


def look(aspect: float = 1.6, method: str = "cubes") -> Look:
    """A camera, a picture and a colour."""
    return Look(view(), aspect, ORANGE, method == "tetrahedra")


def cells(method: str, count: int = 12) -> list[Cell]:
    """Random ones, and two without a surface."""
    chance = np.random.default_rng(41)
    broken = np.where(np.arange(8) == 2, np.nan, 1.0)
    return [examine(values, method) for values in (*chance.normal(size=(count, 8)), np.ones(8), broken)]


def words(card: CellCard) -> list[str]:
    """All that is written on a card."""
    return [line.text for line in card.lines]


# Models

def test_parts_are_rows_of_numbers() -> None:
    """Rods, balls and corners of faces, with radius, frame and colour; models add up."""
    model = Model()
    assert [part.shape for part in model.arrays()] == [(0, RODS), (0, BALLS), (0, FACE_NUMBERS)]
    model.rods([[0, 0, 0], [1, 1, 1]], [[1, 0, 0], [1, 2, 1]], 0.1, ORANGE, FRAME)
    model.balls([0.5, 0.25, 0], 0.2, ORANGE)
    other = Model()
    other.faces([[[0, 0, 0], [2, 0, 0], [0, 3, 0]]], ORANGE, FRAME)
    model.extend(other)
    rods, balls, faces = model.arrays()
    assert np.allclose(rods[1], [1, 1, 1, 1, 2, 1, 0.1, *FRAME, *ORANGE])
    assert np.allclose(balls, [[0.5, 0.25, 0, 0.2, *WORLD, *ORANGE]])
    assert np.allclose(faces, [[*corner, 0, 0, 1, *FRAME, *ORANGE] for corner in ([0, 0, 0], [2, 0, 0], [0, 3, 0])])
    assert {part.dtype for part in model.arrays()} == {np.dtype(np.float32)}


def test_a_box_has_twelve_edges() -> None:
    """Each along one axis, between its corners; a triangle of no area has no normal, and no NaN."""
    starts, ends = box_edges()
    assert (np.abs(ends - starts).sum(axis=1) == 1).all()
    assert len(np.unique(np.hstack([starts, ends]), axis=0)) == 12
    model = Model()
    model.box([1, 2, 3], [2, 4, 6], 0.1, ORANGE)
    model.faces(np.ones((1, 3, 3)), ORANGE)
    rods, _, faces = model.arrays()
    lengths = np.linalg.norm(rods[:, 3:6] - rods[:, :3], axis=1)
    assert np.unique(lengths, return_counts=True)[0].tolist() == [1, 2, 3]
    assert rods[:, :6].reshape(-1, 3).min(axis=0).tolist() == [1, 2, 3]
    assert rods[:, :6].reshape(-1, 3).max(axis=0).tolist() == [2, 4, 6]
    assert not faces[:, 3:6].any()


def test_colours_are_read_from_their_codes() -> None:
    """With or without the sign."""
    assert rgb("#ff0080") == rgb("ff0080") == (1.0, 0.0, 128.0 / 255.0)


def test_places_in_the_picture() -> None:
    """The middle of the cell stands in the middle of its frame; right, up and towards the eye are the camera's."""
    turned, middle = view(), np.full(3, 0.5)
    places = middle + np.stack([np.zeros(3), *turned[:3, :3].T])
    found = in_picture(places, FRAME, turned, 2.0)
    across, up, size = FRAME
    assert np.allclose(found, [[across, up], [across + size / 2.0, up], [across, up + size], [across, up]])


@pytest.mark.parametrize("method", METHODS)
def test_the_model_shows_the_cell(method: str) -> None:
    """A ball for each corner and each crossing, its triangles, their sides, and both answers on ambiguous faces."""
    for cell in cells(method):
        rods, balls, faces = microscope_model(cell, FRAME, ORANGE, method == "tetrahedra").arrays()
        assert len(balls) == 8 + len(cell.crossings)
        assert np.allclose(faces[:, :3], cell.places[cell.triangles].reshape(-1, 3)) or method == "tetrahedra"
        assert len(faces) == 3 * len(cell.triangles)
        diagonals = 7 if method == "tetrahedra" else 0
        assert len(rods) == 12 + diagonals + 3 * len(cell.triangles) + 4 * len(cell.ambiguous)
        assert all(np.isfinite(part).all() for part in (rods, balls, faces))


def test_corners_without_a_value_are_told_apart() -> None:
    """NaN or infinite: in the model's colours, on the card and in the table."""
    cell = examine([np.nan, np.inf, -np.inf, -1.0, 0.0, 1.0, 2.0, 3.0])
    _, balls, _ = microscope_model(cell, FRAME, ORANGE, False).arrays()
    shown = {tuple(ball[:3].astype(int).tolist()): tuple(ball[7:].tolist()) for ball in balls}
    written = {line.text[0]: line for line in microscope_card(cell, "Cell", look()).lines[2:]}
    expected = [NO_VALUE] * 3 + [INSIDE] + [OUTSIDE] * 4
    for corner, (color, row) in enumerate(zip(expected, cell_words.corner_rows(cell), strict=True)):
        assert shown[tuple(CORNERS[corner].tolist())] == pytest.approx(rgb(color))
        assert written[str(corner)].color == color
        assert row[1] == {NO_VALUE: "no value", INSIDE: "inside", OUTSIDE: "outside"}[color]
        assert ("no value" in written[str(corner)].text) == (color == NO_VALUE)


def test_the_right_answer_is_thicker() -> None:
    """Lines that join the inside corners of the checkerboard, on both sides of its saddle, and thin ones that part."""
    rods, _, _ = microscope_model(examine(CHECKERBOARD), FRAME, ORANGE, False).arrays()
    answers = rods[-4:]
    thick = answers[answers[:, 6] == answers[:, 6].max()]
    assert len(thick) == 2 and (answers[:, [2, 5]] == 0.0).all()
    for outside in ([1, 0, 0], [0, 1, 0]):
        distance = np.linalg.norm(thick[:, :3] - outside, axis=1) + np.linalg.norm(thick[:, 3:6] - outside, axis=1)
        assert distance.min() < 1.2 < distance.max()


# Cases

def turns() -> set[tuple[int, ...]]:
    """Where corners 0 to 7 go under each rotation of the octahedral group."""
    matrices = Rotation.create_group("O").as_matrix()
    turned = [np.rint((CORNERS - 0.5) @ matrix.T + 0.5).astype(int) @ [1, 2, 4] for matrix in matrices]
    return {tuple(corners.tolist()) for corners in turned}


def test_a_cell_can_be_turned_in_24_ways() -> None:
    """Those of the octahedral group."""
    assert len(turns()) == 24 and set(rotations()) == turns()


def test_there_are_15_kinds_of_cases() -> None:
    """As Lorensen and Cline counted: two cases are of a kind just where a turn or an exchange of signs relates them."""
    related = [(case, 255 - case) for case in range(256)]
    related += [(case, sum((case >> corner & 1) << way[corner] for corner in range(8)))
                for case in range(256) for way in turns()]
    first, second = np.array(related).T
    count, kinds = connected_components(coo_array((np.ones(len(first)), (first, second)), (256, 256)), False)
    assert count == 15 and len(set(zip(kinds.tolist(), case_classes(), strict=True))) == 15
    assert list(dict.fromkeys(case_classes())) == list(range(15))


@pytest.mark.parametrize("method", METHODS)
def test_triangles_of_cases_join_the_middles_of_edges(method: str) -> None:
    """Those of a cell with all values 1 or -1."""
    for case in range(256):
        cell = examine(np.where(case >> np.arange(8) & 1, -1.0, 1.0), method)
        assert cell.case == case
        assert np.allclose(case_triangles(method, case), cell.places[cell.triangles])


@pytest.mark.parametrize("aspect", ASPECTS)
def test_cases_stand_side_by_side(aspect: float) -> None:
    """256 cells inside their rectangle, none over another, of a size that fills it."""
    left, right, bottom, top = -0.9, 0.8, -0.7, 0.95
    frames = sheet_frames(aspect, left, right, bottom, top)
    assert list(frames) == list(range(256))
    x, y, size = np.array(list(frames.values())).T
    assert len(np.unique(size)) == 1
    half = 0.5 * size[0]
    assert (x - half / aspect > left).all() and (x + half / aspect < right).all()
    assert (y - half > bottom).all() and (y + half < top).all()
    apart = np.maximum(np.abs(x[:, None] - x) * aspect, np.abs(y[:, None] - y)) + 9.0 * np.eye(256)
    assert apart.min() > 1.5 * size[0]
    assert 256 * (2.0 * size[0])**2 > 0.6 * (right - left) * aspect * (top - bottom)


# Cards

@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("aspect", ASPECTS)
def test_the_card_says_all_about_the_cell(aspect: float, method: str) -> None:
    """Each corner's value, each crossing's t and each ambiguous face, on the card and not below it."""
    for cell in cells(method):
        card = microscope_card(cell, "Cell 3, 4, 5", look(aspect, method))
        written = words(card)
        assert written[0] == "Cell 3, 4, 5" and card.covers(card.lines[0].place)
        for corner, value in enumerate(cell.values):
            shown = cell_words.signed(value) if np.isfinite(value) else "no value"
            assert f"{corner}:  {shown}" in written
        for crossing in cell.crossings:
            assert edge_name(crossing.edge) in written and f"{crossing.t:.3f}" in written
        for line in (*card.lines[:2], *card.lines[10:]):
            assert card.covers(line.place)
        assert [line for line in cell_words.face_lines(cell) if line not in written] == []
        assert len(card.model.arrays()[0]) >= 12


@pytest.mark.parametrize("aspect", ASPECTS)
def test_the_rest_of_the_picture_moves_aside(aspect: float) -> None:
    """Its new middle is beside the card or above it; the card covers its own cell."""
    card = microscope_card(examine(CHECKERBOARD), "Cell", look(aspect))
    assert not card.covers(room_for_card(aspect))
    balls = card.model.arrays()[1]
    assert card.covers(tuple(balls[0, 4:6].tolist()))


@pytest.mark.parametrize("aspect", ASPECTS)
@pytest.mark.parametrize("chosen", [-1, 0, 105, 255])
def test_the_sheet_has_every_case(aspect: float, chosen: int) -> None:
    """By number; a click on one finds it, a click beside the sheet none; the chosen one is told of."""
    counts = {1: 7, 105: 2, 3: 0}
    card = sheet_card(look(aspect), counts, chosen)
    written = words(card)
    assert {str(case) for case in range(256)} <= set(written)
    assert card.frames is not None
    for case, (x, y, _) in card.frames.items():
        assert card.covers((x, y)) and case_at(card, (x, y), aspect) == case
    assert case_at(card, (0.0, 0.999), aspect) is None
    narrow = chosen >= 0 and aspect <= 1.2
    assert written[0] == (f"Case {chosen} = {chosen:08b}: {counts.get(chosen, 0)} cells of this surface" if narrow
                          else "Cubes: 256 cases, 2 of them in this surface")
    if chosen >= 0 and not narrow:
        assert f"Case {chosen}" in written
        assert f"triangles: {len(case_table('cubes').cases[chosen])}" in written
        assert f"cells of this surface: {counts.get(chosen, 0)}" in written
    else:
        assert not any(text.startswith("Case") for text in written[1:])
    assert case_at(microscope_card(examine(CHECKERBOARD), "Cell", look(aspect)), (0.5, 0.5), aspect) is None


# Words

def test_numbers_are_written_with_their_sign() -> None:
    """With a minus, not a hyphen."""
    assert [cell_words.signed(value) for value in (0.25, -1.23456, 0.0, -1e-5)] == ["+0.25", "−1.23", "+0", "−1e−5"]
    assert cell_words.signed(1.23456, 2) == "+1.2"


@pytest.mark.parametrize("method", METHODS)
def test_rows_tell_what_the_cell_is(method: str) -> None:
    """Every corner with its place and side, every crossing, every ambiguous face."""
    for cell in cells(method):
        for corner, (name, side, value) in enumerate(cell_words.corner_rows(cell)):
            assert name == f"{corner} ({''.join(map(str, CORNERS[corner]))})"
            assert side == ("no value" if np.isnan(value) else "inside" if value < 0.0 else "outside")
        rows = cell_words.crossing_rows(cell)
        assert all(t == pytest.approx(A / (A - B), abs=1e-4) for _, A, B, t in rows)
        assert len(rows) == len(cell.crossings) and len({row[0] for row in rows}) == len(rows)
        for (name, saddle, what, here), face in zip(cell_words.face_rows(cell), cell.ambiguous, strict=True):
            around = cell.values[list(FACES[face.face])]
            determinant = around[0] * around[2] - around[1] * around[3]
            assert name == face.name and np.sign(saddle) == np.sign(determinant) * np.sign(around[0])
            assert what == ("joined" if saddle < 0.0 else "parted") and here == "parted"
        decided = replace(cell, decided=np.empty((0, 3, 3)))
        assert all(row[2] == row[3] for row in cell_words.face_rows(decided))


def test_headlines_count_triangles() -> None:
    """One triangle, several, or a reason for none."""
    single = examine(np.where(np.arange(8) == 0, -1.0, 1.0))
    assert cell_words.headline(single, "Cell") == "Cell\ncase 1 = 00000001 in binary: 1 triangle"
    assert cell_words.headline(examine(CHECKERBOARD), "A") == "A\ncase 9 = 00001001 in binary: 2 triangles"
    assert cell_words.headline(examine(np.full(8, np.nan)), "A").endswith("yields nothing")
    assert list(cell_words.face_lines(examine(CHECKERBOARD))) == ["z = 0: saddle −0.33, would join"]


def test_emptiness_has_a_reason() -> None:
    """No value at all, one value only, a level out of range, or a jump."""
    values = np.array([np.nan, -1.0, 2.0, np.inf], np.float32)
    assert surface_words.about_emptiness(values[:1], 0.0, "The field") == (
        "The field has no value at any sample: there is no surface.")
    assert "is −1 everywhere" in surface_words.about_emptiness(values[:2], 0.0, "The field")
    assert surface_words.about_emptiness(values, 2.5, "The field") == (
        "No surface at level 2.5: the field lies between −1 and 2.")
    assert "No surface at level −1" in surface_words.about_emptiness(values, -1.0, "The field")
    assert "jumps" in surface_words.about_emptiness(values, 2.0, "The field")


def test_gaps_are_counted() -> None:
    """Only where there are any."""
    assert list(surface_words.about_gaps(0, 0, 100)) == []
    jump, missing = surface_words.about_gaps(1, 25, 100)
    assert "on one edge" in jump and missing.startswith("25 %")
    jump, missing = surface_words.about_gaps(12345, 1, 1000)
    assert "12\u2009345 edges" in jump and missing.startswith("less than 1 %")
