"""Labels: where their letters appear, how they look, what they cost, and what happens to wrong ones."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tests import packs
from tests.conftest import MakeStage
from viewer.engine import lettering_faces, lettering_sheet, lettering_type
from viewer.engine.annotations import Label
from viewer.engine.inscriptions import LONGEST_TEXT, checked_labels
from viewer.engine.lettering_faces import Faces, stand_in
from viewer.engine.lettering_type import RECTANGLE, Typesetter
from viewer.engine.scene import SceneError
from viewer.engine.stage import Stage

ROOT = Path(__file__).parents[2]
SIZE = (320, 180)
Box = tuple[int, int, int, int]
# Shows whatever ``shown`` holds, over an even grey.
SCENE = packs.TILE.replace("import Parameters", "import Label, Parameters") + '''
    shown = ()
    aside = 0.0, 0.0

    def labels(self):
        return self.shown

    def middle(self):
        return self.aside
'''


@pytest.fixture
def stage(make_stage: MakeStage) -> Stage:
    return make_stage(SCENE, size=SIZE)


def show(stage: Stage, *labels: Any, aside: tuple[float, float] = (0.0, 0.0)) -> NDArray[np.uint8]:
    stage.scene.shown, stage.scene.aside = labels, aside  # type: ignore[attr-defined]
    return stage.pixels()


def inked(stage: Stage, *labels: Any, aside: tuple[float, float] = (0.0, 0.0)) -> NDArray[np.bool_]:
    """Which pixels the labels change, bottom row first."""
    bare = show(stage, aside=aside)
    return (show(stage, *labels, aside=aside) != bare).any(2)[::-1]


def box(mask: NDArray[np.bool_]) -> Box:
    """Left, bottom, right and top edge of what is marked, in pixels from the lower left corner."""
    rows, columns = np.flatnonzero(mask.any(1)), np.flatnonzero(mask.any(0))
    assert rows.size, "nothing is drawn"
    return int(columns[0]), int(rows[0]), int(columns[-1]) + 1, int(rows[-1]) + 1


def near(found: Any, expected: Any, pixels: float = 2.0) -> bool:
    return bool(np.abs(np.asarray(found, float) - np.asarray(expected, float)).max() <= pixels)


@pytest.mark.parametrize("samples", [0, 4])
@pytest.mark.parametrize("align", [(0.0, 0.0), (0.5, 0.5), (1.0, 1.0), (0.0, 1.0), (1.0, 0.5)])
@pytest.mark.parametrize("anchor", [(0.0, 0.0), (-0.5, 0.25)])
def test_letters_stand_where_they_are_aligned(make_stage: MakeStage, samples: int, align: tuple[float, float],
                                              anchor: tuple[float, float]) -> None:
    """A capital's ink, with its side bearing left and right and the room for descenders below and above."""
    stage = make_stage(SCENE, size=SIZE, samples=samples)
    left, bottom, right, top = box(inked(stage, Label("H", anchor, 4.0, align=align)))
    assert near((right - left, top - bottom), (0.60 * 48, 0.71 * 48))
    place = (np.array(anchor) + 1.0) / 2.0 * SIZE
    width, height = 0.71 * 48, (0.71 + 0.42) * 48
    assert near(((left + right) / 2, (bottom + top) / 2),
                place + (0.5 - np.array(align)) * (width, height))


def test_the_middle_of_a_capital_is_exactly_in_the_middle(stage: Stage) -> None:
    """So that a digit in a small round mark looks right."""
    left, bottom, right, top = box(inked(stage, Label("H", (0.0, 0.0), 4.0)))
    assert near(((left + right) / 2, (bottom + top) / 2), (160, 90), 0.6)


@pytest.mark.parametrize(("size", "em"), [((320, 180), 12), ((200, 720), 20), ((40, 1080), 30)])
def test_letters_grow_with_the_picture(make_stage: MakeStage, size: tuple[int, int], em: int) -> None:
    """A standard letter is a 36th of its height, and 12 pixels at least."""
    stage = make_stage(SCENE, size=size)
    _, bottom, _, top = box(inked(stage, Label("H", (0.0, 0.0))))
    assert near(top - bottom, 0.71 * em, 1.0)
    _, bottom, _, top = box(inked(stage, Label("H", (0.0, 0.0), 2.0)))
    assert near(top - bottom, 1.42 * em, 1.0)


@pytest.mark.parametrize("aside", [(0.0, 0.0), (0.4, -0.3)])
@pytest.mark.parametrize("place", [(0.0, 0.0, 0.0), (0.5, 0.3, -0.2), (-0.4, 0.2, 0.6)])
def test_a_place_in_the_world_is_where_the_camera_sees_it(stage: Stage, place: tuple[float, float, float],
                                                          aside: tuple[float, float]) -> None:
    """Shifted lens included, and after the camera has moved."""
    for drag in (0.0, 0.2):
        stage.camera.drag(drag, drag)
        left, bottom, right, top = box(inked(stage, Label("H", place, 2.0), aside=aside))
        clip = np.array([*place, 1.0]) @ stage.camera.view() @ stage.camera.projection(SIZE[0] / SIZE[1], aside)
        expected = (clip[:2] / clip[3] + 1.0) / 2.0 * SIZE
        assert near(((left + right) / 2, (bottom + top) / 2), expected, 1.2)


def test_what_has_no_place_in_the_picture_is_not_drawn(stage: Stage) -> None:
    """Behind the eye, nowhere, beyond the edge, without letters or without a size."""
    behind = tuple(map(float, 2.0 * stage.camera.eye))
    infinite, nan = float("inf"), float("nan")
    for label in (Label("behind", behind, plate="#ff0000"),  # type: ignore[arg-type]
                  Label("nowhere", (nan, 0.0), plate="#ff0000"), Label("nowhere", (0.0, infinite, 0.0)),
                  Label("far", (1e30, -1e30, 0.0)), Label("farther", (1e300, -1e300, 1e306)), Label("out", (9.0, 0.0)),
                  Label("aside", (0.0, 0.0), align=(1e300, 0.0)), Label("aside", (0.0, 0.0), align=(0.0, -1e307)),
                  Label("", (0.0, 0.0), plate="#ff0000"),
                  Label(" \n ", (0.0, 0.0), plate="#ff0000"), Label("none", (0.0, 0.0), 0.0, plate="#ff0000"),
                  Label("\u200b", (0.0, 0.0))):
        assert not inked(stage, label).any(), label
    cut_off = inked(stage, Label("HHHHHHHHHHHHH", (0.0, 0.0), 9.0))
    assert cut_off[:, 0].any()
    assert cut_off[:, -1].any()


def test_a_plate_has_its_colour_and_round_corners(stage: Stage) -> None:
    """Exactly the colour beside the letters, exactly in pixels, nothing of it in the very corner."""
    mask = inked(stage, Label("HI", (0.0, 0.0), 4.0, plate="#0072b2"))
    left, bottom, right, top = box(mask)
    picture = show(stage, Label("HI", (0.0, 0.0), 4.0, plate="#0072b2", color="#ffffff"))[::-1]
    assert picture[top - 1, (left + right) // 2].tolist() == [0, 0x72, 0xb2, 255]
    assert picture[bottom, (left + right) // 2].tolist() == [0, 0x72, 0xb2, 255]
    assert (picture[(bottom + top) // 2, left:left + 5] == [0, 0x72, 0xb2, 255]).all()
    assert (picture == 255).all(2).any()
    for row, column in ((bottom, left), (bottom, right - 1), (top - 1, left), (top - 1, right - 1)):
        assert not mask[row, column]
    margins = box((picture == 255).all(2))
    assert near(np.abs(np.subtract(margins, (left, bottom, right, top))), (0.48 * 48, 0.39 * 48, 0.48 * 48, 0.39 * 48),
                3)


def test_a_plate_may_let_the_picture_through(stage: Stage) -> None:
    """Half of one and half of the other, in the picture's own encoding."""
    bare = show(stage)[90, 160, :3].astype(float)
    plate = show(stage, Label(".", (0.0, 0.0), 6.0, plate="#ff000080"))[85, 160, :3]
    assert near(plate, bare + (np.array([255.0, 0.0, 0.0]) - bare) * 128 / 255, 1.5)


def test_later_labels_lie_over_earlier_ones(stage: Stage) -> None:
    """Letters and plate, whatever the order in which they were lettered."""
    red, blue = (Label("HHHH", (0.0, 0.0), 3.0, plate=color, color=color) for color in ("#ff0000", "#0000ff"))
    assert show(stage, red, blue)[90, 160].tolist() == [0, 0, 255, 255]
    assert show(stage, blue, red)[90, 160].tolist() == [255, 0, 0, 255]


def test_the_picture_stays_opaque(make_stage: MakeStage) -> None:
    """However transparent letters and plates are."""
    for samples in (0, 4):
        stage = make_stage(SCENE, size=SIZE, samples=samples)
        picture = show(stage, Label("half", (0.0, 0.0), 4.0, "#ff000040", plate="#00ff0080"))
        assert (picture[..., 3] == 255).all()


@pytest.mark.parametrize("samples", [0, 4])
def test_the_same_labels_are_the_same_bytes(make_stage: MakeStage, samples: int) -> None:
    """Again, in another stage, after others that filled the sheet, and in another order of making."""
    labels = [Label("f(x, y) = 0.75\nsecond", (0.1, 0.2, 0.3), 1.3, plate="#ffffffc0"),
              Label("Bold", (-0.9, 0.9), 2.0, "#d55e00", (0.0, 1.0), bold=True)]
    one, other = (make_stage(SCENE, size=SIZE, samples=samples) for _ in range(2))
    expected = show(one, *labels)
    show(other, Label("quite different", (0.0, 0.0), 1.7), *labels[::-1])
    assert np.array_equal(show(other, *labels), expected)
    assert np.array_equal(show(one, *labels), expected)
    other.resize((100, 100))
    show(other, *labels)
    other.resize(SIZE)
    assert np.array_equal(show(other, *labels), expected)


def test_letters_are_the_same_with_any_number_of_samples(make_stage: MakeStage) -> None:
    """They are drawn after the samples have been averaged."""
    label = Label("crisp", (0.0, 0.0), 2.0, plate="#ffffff")
    pictures = [show(make_stage(SCENE, size=SIZE, samples=samples), label) for samples in (0, 4)]
    assert np.array_equal(*pictures)


def test_bold_is_heavier(stage: Stage, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where there is a bold typeface, and where there is none."""
    for folder in (lettering_faces.font_folder(), None):
        monkeypatch.setattr(lettering_faces, "font_folder", lambda folder=folder: folder)
        weights = [int(sum(face.raster(one, 24).coverage.sum() for character in "weigh 128"
                           for face, one in faces.spelled(character))) for faces in (Faces(False), Faces(True))]
        assert weights[1] > 1.15 * weights[0]
    light, heavy = (inked(stage, Label("weigh", (0.0, 0.0), 3.0, bold=bold)).sum() for bold in (False, True))
    assert heavy > 1.05 * light


def test_lines_are_parted_and_aligned(stage: Stage) -> None:
    """One beneath the other, the short one on the side of the anchor."""
    for side, check in ((0.0, lambda short, long: short[0] - long[0]), (1.0, lambda short, long: short[2] - long[2]),
                        (0.5, lambda short, long: short[0] + short[2] - long[0] - long[2])):
        mask = inked(stage, Label("H\nHHHH", (0.0, 0.0), 3.0, align=(side, 0.5)))
        short, long = (box(half) for half in (np.where(np.arange(180)[:, None] >= 90, mask, False),
                                              np.where(np.arange(180)[:, None] < 90, mask, False)))
        assert abs(check(short, long)) <= 2
        assert near(short[1] - long[1], 1.25 * 36, 1.0)
    one, other = (inked(stage, Label(text, (0.0, 0.0))) for text in ("A\r\nB", "A\nB"))
    assert np.array_equal(one, other)


@pytest.mark.parametrize("fonts", [True, False])
@pytest.mark.parametrize("bold", [True, False])
def test_no_character_is_a_box_or_a_gap(fonts: bool, bold: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """With the usual fonts and with Pillow's alone: what a typeface lacks is spelled with what it has."""
    if not fonts:
        monkeypatch.setattr(lettering_faces, "font_folder", lambda: None)
    faces = Faces(bold)
    ours = "".join(map(chr, range(33, 127))) + "−×·→←≥≤≠°½α∇Σ²³₁πθΔ∂∞√≈–—…•éßÅŁ⟨⟩∈ℝ漢א\ud800\uffff"
    for character in ours:
        spelled = faces.spelled(character)
        assert spelled
        assert all(face.has(one) for face, one in spelled), character
        if character.isascii() or (fonts and character in "−×·→≥≤≠°½α∇Σ²³"):
            assert [one for _, one in spelled] == [character]
    found = "".join(one for character in "−→²½αÅ漢" for _, one in faces.spelled(character))
    assert found == ("−→²½αÅ?" if fonts else "-->^21⁄2alphaA?")
    assert [one for _, one in faces.spelled("\t")] == [one for _, one in faces.spelled("\u00a0")] == [" "]


@pytest.mark.parametrize(("character", "simple"), [
    ("→", "->"), ("é", "e"), ("⁵", "^5"), ("₂", "_2"), ("Σ", "Sigma"), ("ω", "omega"), ("漢", "?"), ("\uffff", "?")])
def test_what_stands_in(character: str, simple: str) -> None:
    assert stand_in(character) == simple


@pytest.mark.parametrize(("labels", "message"), [
    ("['words']", "TypeError: 'words' is not a Label"), ("3", "TypeError"), ("Label('x', (0, 0))", "TypeError"),
    ("[Label(3, (0, 0))]", "TypeError: label text = 3 is not text"),
    ("[Label('x', (0,))]", r"label 'x' has anchor = \(0,\)"), ("[Label('x', (0, 0, 0, 0))]", "two or three numbers"),
    ("[Label('x', 'ab')]", "has anchor = 'ab'"), ("[Label('x', None)]", "has anchor = None"),
    ("[Label('x', (0, 0), -1)]", "size = -1"), ("[Label('x', (0, 0), float('nan'))]", "size = nan"),
    ("[Label('x', (0, 0), align=(0, float('inf')))]", r"align = \(0, inf\)"),
    ("[Label('x', (0, 0), color='red')]", "'red' is not a colour such as #ff8800 or #ff8800c0"),
    ("[Label('x', (0, 0), plate='#12345g')]", "'#12345g' is not a colour"), ("{}['none']", r"tile\.py:\d+: KeyError"),
])
def test_wrong_labels_are_one_line(make_stage: MakeStage, labels: str, message: str) -> None:
    """That names the scene; the picture that was there stays, and so does the stage."""
    stage = make_stage(SCENE.replace("return self.shown", f"return {labels} if self.params.height > 4 else ()"))
    picture = stage.pixels()
    stage.set(height=5.0)
    with pytest.raises(SceneError, match=message) as caught:
        stage.render()
    assert str(caught.value).startswith("tile failed in labels: ")
    assert "\n" not in str(caught.value)
    assert np.array_equal(stage.picture.pixels(), picture)
    stage.set(height=2.0)
    assert np.array_equal(stage.pixels(), picture)


def test_numbers_may_be_anybody_s(stage: Stage) -> None:
    """NumPy's, whole ones, arrays and lists; none at all gives no labels."""
    expected = show(stage, Label("x", (0.0, 0.0, 1.0), 2.0, align=(0.0, 1.0)))
    for label in (Label("x", np.array([0, 0, 1]), np.float32(2), align=[0, 1]),  # type: ignore[arg-type]
                  Label(np.str_("x"), [0, 0.0, np.float64(1)], 2, align=np.array([0, 1]))):  # type: ignore[arg-type]
        assert np.array_equal(show(stage, label), expected)
    stage.scene.labels = lambda: None  # type: ignore[method-assign, assignment, return-value]
    stage.pixels()


def test_an_anchor_that_moves_in_place_is_followed(stage: Stage) -> None:
    """A scene may keep one array and change it."""
    anchor = np.array([-0.5, 0.0])
    label = Label("H", anchor)  # type: ignore[arg-type]
    left = box(inked(stage, label))[0]
    anchor[0] = 0.5
    assert near(box(inked(stage, label))[0] - left, SIZE[0] / 2)


def test_the_same_labels_are_not_set_again(stage: Stage, monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing is made nor sent while they stay the same, though the camera moves; changed ones make no GL objects."""
    many = [Label(f"{number}", (np.cos(number), np.sin(number), 0.0), plate="#ffffff80") for number in range(600)]
    before = show(stage, *many)
    with monkeypatch.context() as patch:
        for name in ("buffer", "texture", "vertex_array", "program"):
            patch.setattr(moderngl.Context, name, lambda *_, **__: pytest.fail("a GL object is made"))
        again = [Label(f"{number}", (np.cos(number), np.sin(number), 0.0), plate="#ffffff80") for number in range(600)]
        changed = [Label(f"{number + 7}", (0.0, 0.0)) for number in range(1200)]
        assert not np.array_equal(show(stage, *changed), before)
        assert np.array_equal(show(stage, *again), before)
        patch.setattr(Typesetter, "set", lambda *_: pytest.fail("set again"))
        stage.camera.drag(0.1, 0.0)
        assert not np.array_equal(show(stage, *again), before)


def test_labels_do_not_touch_the_rest(make_stage: MakeStage) -> None:
    """Floor, shadow, backdrop and scene are what they are without, and another stage too."""
    source = SCENE.replace("Studio(ground=None)", "Studio()").replace("self.array.render(vertices=3)", "pass")
    stage, other = make_stage(source, size=SIZE), make_stage(source, size=SIZE)
    bare = show(other)
    labelled = show(stage, Label("H", (0.0, 0.0), plate="#ffffff"))
    outside = np.ones(bare.shape[:2], bool)
    outside[75:105, 145:175] = False
    assert np.array_equal(labelled[outside], bare[outside])
    assert np.array_equal(show(stage), bare)
    assert np.array_equal(show(other), bare)


@pytest.mark.parametrize("mess", ["context.wireframe = True", "context.scissor = 0, 0, 4, 4",
                                  "context.fbo.viewport = 0, 0, 4, 4", "context.enable_only(context.CULL_FACE)"])
def test_what_labels_leaves_behind_ends_with_it(make_stage: MakeStage, mess: str) -> None:
    """It may compute on the GPU."""
    tidy = make_stage(SCENE, size=SIZE)
    messy = make_stage(SCENE.replace("return self.shown", f"context = self.gpu.context; {mess}; return self.shown"),
                       size=SIZE)
    label = Label("H", (0.0, 0.0), 4.0)
    assert np.array_equal(show(messy, label), show(tidy, label))


def test_labels_that_read_the_time_move_with_it(make_stage: MakeStage) -> None:
    """A window draws again when the frame changes."""
    stage = make_stage(SCENE.replace("return self.shown", "return [Label(str(self.frame), (0, 0), 3)]"), size=SIZE)
    before, shown = stage.pixels(), stage.showing
    stage.step()
    assert stage.showing != shown
    assert not np.array_equal(stage.pixels(), before)


def test_an_edited_label_shader_is_taken_over(make_stage: MakeStage) -> None:
    """And one that does not compile is reported while the last good one draws."""
    text = (ROOT / "shaders" / "studio" / "label.frag").read_text("utf-8")
    stage = make_stage(SCENE, size=SIZE, files={"shaders/studio/label.frag": text})
    before, label = show(stage, Label("H", (0.0, 0.0))), stage.entry.shaders.folders[0] / "studio" / "label.frag"
    assert stage.refresh_shaders() is None
    shown = stage.showing
    label.write_text(text.replace("v_color.rgb", "vec3(1.0, 0.0, 0.0)"))
    assert stage.refresh_shaders() is None
    assert stage.showing != shown
    after = stage.pixels()
    assert not np.array_equal(after, before)
    label.write_text(text.replace("v_color.rgb", "no_such_color"))
    assert "studio/label.frag" in str(stage.refresh_shaders())
    assert np.array_equal(stage.pixels(), after)


def typeset(labels: list[Label], height: int = 180) -> NDArray[Any]:
    return Typesetter().set(checked_labels(labels), height)


def test_enormous_texts_are_cut() -> None:
    """A long one ends in an ellipsis; more letters than a buffer should hold are left out."""
    one, = checked_labels([Label("x" * 100_000, (0, 0))])
    assert len(one.text) == LONGEST_TEXT
    assert one.text.endswith("x…")
    assert checked_labels([Label("x" * LONGEST_TEXT, (0, 0))])[0].text == "x" * LONGEST_TEXT
    assert len(typeset([Label("x" * 4000, (0, 0))] * 30)) == lettering_type.MOST_RECTANGLES
    assert int(typeset([Label("x", (0, 0), 1.7e308)])["rectangle"][0, 3]) < 320


@pytest.fixture
def small_sheets(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setattr(lettering_type, "LARGEST_EXTENT", 96)
    monkeypatch.setattr(lettering_sheet.Sheet.__init__, "__defaults__", (48,))
    yield


def test_a_sheet_that_is_full_starts_anew_or_grows(small_sheets: None) -> None:
    """Same letters either way; what does not fit the largest is left out, and nothing fails."""
    typesetter = Typesetter()
    word = checked_labels([Label("abc", (0, 0))])
    first = typesetter.set(word, 180)
    sheet = typesetter.sheet
    for size in (1.1, 1.2, 1.5, 1.8, 2.0, 2.2):
        typesetter.set(checked_labels([Label("abc", (0, 0), size)]), 180)
    assert typesetter.sheet is not sheet
    assert typesetter.sheet.extent == 48
    typesetter.set(checked_labels([Label("abcdefghijklm", (0, 0), 2.2)]), 180)
    assert typesetter.sheet.extent == 96
    assert np.array_equal(typesetter.set(word, 180)["rectangle"], first["rectangle"])
    many = [Label(chr(65 + number), (0, 0), 3.0) for number in range(26)]
    assert 0 < len(typesetter.set(checked_labels(many), 180)) < 26
    assert typesetter.set(checked_labels([Label("W", (0, 0), 20.0)]), 180).size == 0
    assert typesetter.set(word, 180).dtype == RECTANGLE


def test_a_larger_sheet_draws_alike(make_stage: MakeStage, monkeypatch: pytest.MonkeyPatch) -> None:
    """The texture is exchanged while the program stays."""
    labels = [Label("first", (0.0, 0.5)), Label("The quick brown fox", (0.0, 0.0), 2.0, plate="#ffffff")]
    expected = show(make_stage(SCENE, size=SIZE), *labels)
    monkeypatch.setattr(lettering_sheet.Sheet.__init__, "__defaults__", (64,))
    stage = make_stage(SCENE, size=SIZE)
    show(stage, labels[0])
    assert np.array_equal(show(stage, *labels), expected)
    assert stage.context.error == "GL_NO_ERROR"


def test_a_scene_without_labels_loads_no_fonts() -> None:
    """Pillow and what letters need cost a start nothing before there is a word to set."""
    code = "import sys, viewer.engine.stage; "
    code += "assert not {'PIL', 'imgui_bundle', 'viewer.engine.lettering_faces'} & set(sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True)
