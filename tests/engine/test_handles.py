"""What a scene lets a hand hold: asked for when everything is prepared, and checked before anybody uses it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from tests import packs
from tests.conftest import MakeStage
from viewer.engine.annotations import Handle
from viewer.engine.scene import SceneError
from viewer.engine.stage import Stage

# A handle at the height of the shade, which follows the frame too.
DIAL = packs.TILE.replace("from viewer import", "import numpy as np\nfrom viewer.engine.annotations import Handle\n"
                                                "from viewer import") + '''
    asked = 0

    def prepare(self):
        self.prepared = self.params.shade + self.frame

    def handle(self):
        self.asked += 1
        matrix = np.eye(4, dtype=int if self.params.shade == 1.0 else float)
        matrix[1, 3] = self.prepared
        return HANDLE

    def drag_handle(self, handle):
        return {"shade": handle.matrix[1, 3]}
'''
WELL = 'Handle(matrix, "shade", moves=True)'


def ask_handle(stage: Stage) -> object:
    return stage.handle()


def drag(stage: Stage) -> object:
    return stage.dragged(Handle(np.eye(4)))


def test_a_scene_offers_nothing_unless_it_says_so(make_stage: MakeStage) -> None:
    """And then nobody has to prepare it for that."""
    stage = make_stage(f"{packs.TILE}\n    def prepare(self):\n        raise ValueError('asked')\n")
    assert stage.handle() is None


def test_nothing_is_set_by_a_handle_that_nobody_follows(make_stage: MakeStage) -> None:
    assert make_stage(packs.TILE).dragged(Handle(np.eye(4))) == {}


def test_a_handle_stands_where_values_and_frame_have_it(make_stage: MakeStage) -> None:
    """The scene is prepared before it is asked; what is changed in the answer does not reach the scene."""
    stage = make_stage(DIAL.replace("HANDLE", WELL))
    stage.set(shade=0.75)
    stage.seek(7)
    handle = stage.handle()
    assert (handle.name, handle.turns, handle.moves) == ("shade", True, True)
    expected = np.eye(4)
    expected[1, 3] = 7.75
    assert handle.matrix.dtype == np.float64 and np.array_equal(handle.matrix, expected)
    handle.matrix[:] = 0.0
    assert np.array_equal(stage.handle().matrix, expected)


def test_a_matrix_of_whole_numbers_will_do(make_stage: MakeStage) -> None:
    handle = make_stage(DIAL.replace("HANDLE", WELL), params={"shade": 1.0}).handle()
    assert handle.matrix.dtype == np.float64 and handle.matrix[1, 3] == 1.0


def test_a_drag_is_answered_with_parameters(make_stage: MakeStage) -> None:
    stage = make_stage(DIAL.replace("HANDLE", WELL))
    moved = stage.handle()
    moved.matrix[1, 3] = 0.5
    assert stage.dragged(moved) == {"shade": 0.5}
    stage.update_params(stage.dragged(moved))
    assert stage.handle().matrix[1, 3] == 0.5


@pytest.mark.parametrize(("gives", "message"), [
    ("matrix", "TypeError: handle gives neither a Handle nor None"),
    ("Handle(matrix[:3], 'a')", r"ValueError: handle a has a matrix of shape \(3, 4\); .* \(4, 4\), a rotation and"),
    ("Handle(None, 'a')", r"ValueError: handle a has a matrix of shape \(\)"),
    ("Handle('up', 'a')", "TypeError: handle a has a matrix that is not one of numbers"),
    ("Handle(matrix * np.nan, 'a')", "ValueError: handle a has a matrix that is not finite"),
    ("Handle(matrix * (2.0, 1.0, 1.0, 1.0), 'a')", "ValueError: handle a has a matrix that scales or shears"),
    ("Handle(matrix * (0.0, 1.0, 1.0, 1.0), 'a')", "ValueError: handle a has a matrix that scales or shears"),
    ("Handle(matrix * (-1.0, 1.0, 1.0, 1.0), 'a')", "ValueError: handle a has a matrix that mirrors"),
    ("Handle(matrix.T, 'a')", "ValueError: handle a has a matrix whose last row is not 0, 0, 0, 1"),
])
def test_what_is_no_handle_is_a_mistake_of_the_scene_s(make_stage: MakeStage, gives: str, message: str) -> None:
    """A matrix in the order of row vectors among it. Told in one line, and the picture can still be drawn."""
    stage = make_stage(DIAL.replace("HANDLE", gives))
    with pytest.raises(SceneError, match=f"^tile failed in handle: .*{message}") as caught:
        stage.handle()
    assert "\n" not in str(caught.value)
    stage.render()


def test_a_rotation_in_single_precision_is_one(make_stage: MakeStage) -> None:
    """After a hundred products in float32, as scenes and ImGuizmo make them."""
    step = "np.array([[0.8, -0.6, 0, 0], [0.6, 0.8, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]], np.float32)"
    turned = f"Handle(np.linalg.multi_dot(100 * [{step}]))"
    assert make_stage(DIAL.replace("HANDLE", turned)).handle() is not None


@pytest.mark.parametrize(("hook", "ask"), [("handle", ask_handle), ("drag_handle", drag)])
@pytest.mark.parametrize("raised", ["ValueError('too\\n far')", "SystemExit(3)"])
def test_what_they_raise_is_one_line(make_stage: MakeStage, hook: str, ask: Callable[[Stage], object],
                                     raised: str) -> None:
    parameters = "self" if hook == "handle" else "self, handle"
    source = f"{packs.TILE}\n    def {hook}({parameters}):\n        raise {raised}\n"
    line = packs.line_of(source, f"raise {raised}")
    said = "ValueError: too far" if "far" in raised else "SystemExit: 3"
    with pytest.raises(SceneError, match=rf"^tile failed in {hook}: tile\.py:{line}: {said}$"):
        ask(make_stage(source))


@pytest.mark.parametrize("gives", ["None", "5", "[1]", "'xy'"])
def test_a_drag_that_gives_no_mapping_is_a_mistake_of_the_scene_s(make_stage: MakeStage, gives: str) -> None:
    stage = make_stage(f"{packs.TILE}\n    def drag_handle(self, handle):\n        return {gives}\n")
    with pytest.raises(SceneError, match=r"^tile failed in drag_handle: .+"):
        drag(stage)
