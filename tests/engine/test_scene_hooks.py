"""What a scene may do around its drawing: prepare, draw over, move the middle, answer clicks, offer ranges."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray

from tests import packs
from tests.conftest import MakeStage
from viewer import integer, interval, slider, text, toggle
from viewer.engine.annotations import Click
from viewer.engine.camera import Orbit, OrbitCamera
from viewer.engine.fields import ParameterError
from viewer.engine.params import Parameters
from viewer.engine.scene import SceneError
from viewer.engine.stage import Stage

# Everything a stage may ask of a scene, written down in the order in which it does.
DIARY = '''
from viewer import Parameters, Scene, Studio, slider

class Diary(Scene):
    """Writes down what it is asked."""

    class Params(Parameters):
        shade: float = slider(0.25, 0.0, 1.0, "How bright")

    studio = Studio(ground=None)
    lines = ()

    def __init__(self, gpu, params):
        self.array = gpu.vertex_array(gpu.program("tile/draw.vert", "tile/draw.frag"))

    def wrote(self, line):
        self.lines = (*self.lines, line)

    def prepare(self):
        self.prepared = self.frame, self.params.shade, self.view.copy(), self.aspect
        self.wrote("prepare")

    def draw(self):
        self.wrote("shadow" if self.gpu.casting_shadows else "draw")
        self.array.render(vertices=3)

    def draw_over(self):
        self.wrote("draw_over")

    def labels(self):
        self.wrote("labels")
        return ()

    def geometry(self):
        self.wrote("geometry")
        return {}

    def measure(self):
        self.wrote("measure")
        return {}

    def remarks(self):
        self.wrote("remarks")
        return []

    def click(self, click):
        self.wrote("click")
        self.clicked = click
        return {"shade": 0.5}
'''

# A small bright ball at a place, on a dark set without a floor.
BALL = '''
import numpy as np
from viewer import Orbit, Parameters, Scene, Studio, slider
from viewer.engine.insets import Insets
from viewer.kit.models import Model

class Ball(Scene):
    """A small ball, and where it is to be seen."""

    class Params(Parameters):
        x: float = slider(0.0, -3.0, 3.0, "Where it is")
        y: float = slider(0.0, -3.0, 3.0, "Where it is")
        z: float = slider(0.0, -3.0, 3.0, "Where it is")
        across: float = slider(0.0, -1.0, 1.0, "Where the target appears")
        up: float = slider(0.0, -1.0, 1.0, "Where the target appears")

    camera = Orbit(yaw=20, pitch=15, distance=5)
    studio = Studio(ground=None, backdrop=("#000000", "#000000"))

    def __init__(self, gpu, params):
        self.ball = Insets(gpu)

    def prepare(self):
        model, p = Model(), self.params
        model.balls([[p.x, p.y, p.z]], 0.12, (1.0, 1.0, 1.0))
        self.ball.show(model)

    def draw(self):
        self.ball.draw()

    def middle(self):
        return self.params.across, self.params.up
'''

# A card above the floor that is drawn before the set, after it, or turned towards the camera.
CARD = {"shaders/card/card.vert": """#version 330 core
#include "lib/frame.glsl"
uniform vec3 u_aside;
void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) - 0.5;
    gl_Position = u_frame.view_projection * vec4(vec3(corner.y, 0.0, corner.x) + u_aside, 1.0);
}
""", "shaders/card/card.frag": "#version 330 core\nout vec4 out_color;\n"
                               "void main() { out_color = vec4(1.0, 0.0, 0.0, 1.0); }\n"}
FLOATING = '''
import moderngl
from viewer import Parameters, Scene, choice

class Card(Scene):
    """A card over the floor."""

    class Params(Parameters):
        comes: str = choice("before", ["before", "after", "never"], "When it is drawn")

    turns, below = False, 0.0

    def __init__(self, gpu, params):
        self.program = gpu.program("card/card.vert", "card/card.frag")
        self.array = gpu.vertex_array(self.program, mode=moderngl.TRIANGLE_STRIP)
        self.draws = 0

    def turns_with_camera(self):
        return self.turns

    def draw(self):
        self.draws += 1
        if self.params.comes == "before":
            self.render()

    def draw_over(self):
        if self.params.comes == "after":
            self.render()

    def render(self):
        aside = 0.8 * self.view[:3, 0] if self.turns else (0.0, 0.0, 0.0)
        self.program["u_aside"] = (float(aside[0]), float(aside[1]) - self.below, float(aside[2]))
        self.array.render(vertices=4)
'''


def red(pixels: NDArray[np.uint8]) -> NDArray[np.bool_]:
    """Where the card is seen, which is red."""
    return np.asarray((pixels[..., 0] > 120) & (pixels[..., 1] < 60))


# The order of things

@pytest.mark.parametrize(("ask", "expected"), [
    (Stage.render, ["prepare", "shadow", "draw", "labels", "draw_over"]),
    (Stage.geometry, ["prepare", "geometry"]), (Stage.measure, ["prepare", "measure"]),
    (Stage.remarks, ["prepare", "remarks"]), (lambda stage: stage.clicked(3, 4), ["prepare", "click"])])
def test_a_scene_is_prepared_before_it_is_asked(make_stage: MakeStage, ask: Callable[[Stage], object],
                                                expected: list[str]) -> None:
    """For the frame, the values, the camera and the picture's shape as they then are."""
    stage = make_stage(DIARY)
    ask(stage)
    assert list(stage.scene.lines) == expected
    assert stage.scene.prepared[:2] == (0, 0.25)
    stage.seek(7)
    stage.set(shade=0.75)
    stage.camera.drag(0.3, 0.1)
    stage.resize((50, 20))
    ask(stage)
    frame, shade, view, aspect = stage.scene.prepared
    assert (frame, shade, aspect) == (7, 0.75, 2.5)
    assert np.array_equal(view, stage.camera.view())


def test_a_scene_is_prepared_once_for_a_picture(make_stage: MakeStage) -> None:
    """However often it is drawn for it: for the shadow and in colour, or, where that stays, in colour alone."""
    stage = make_stage(DIARY)
    stage.render()
    stage.render()
    assert stage.scene.lines.count("prepare") == 2 and stage.scene.lines.count("shadow") == 1


def test_prepare_may_draw_elsewhere(make_stage: MakeStage) -> None:
    """Whatever it binds and clears, the picture is the same."""
    plain = make_stage(packs.TILE).pixels()
    target = "        self.aside = gpu.framebuffer([gpu.texture((4, 4), 4)])\n        self.built_with"
    stage = make_stage(packs.TILE.replace("        self.built_with", target, 1) + """
    def prepare(self):
        self.aside.use()
        self.aside.clear(1.0, 0.0, 0.0)
        self.gpu.context.enable_only(self.gpu.context.BLEND)
        self.gpu.context.depth_func = ">"
""")
    assert np.array_equal(stage.pixels(), plain)
    assert set(np.frombuffer(stage.scene.aside.read(components=3), np.uint8).reshape(-1, 3).T[1]) == {0}


# Mistakes

ASKED = {"draw_over": Stage.render, "middle": Stage.render, "labels": Stage.render,
         "turns_with_camera": Stage.render, "remarks": Stage.remarks, "click": lambda stage: stage.clicked(1, 1)}
BAD = {"middle": "def middle(self):\n        CHECK\n        return 0.0, 0.0",
       "click": "def click(self, click):\n        CHECK\n        return {}",
       "remarks": "def remarks(self):\n        CHECK\n        return []",
       "labels": "def labels(self):\n        CHECK\n        return []",
       "turns_with_camera": "def turns_with_camera(self):\n        CHECK\n        return False"}


@pytest.mark.parametrize("where", ASKED)
def test_what_a_hook_raises_is_one_line_and_leaves_the_picture(make_stage: MakeStage, where: str) -> None:
    """By scene, hook, file and line; the last picture stays, and once it is mended the next one comes."""
    check = "assert self.params.shade < 0.8, 'too\\n bright'"
    method = BAD.get(where, f"def {where}(self):\n        CHECK").replace("CHECK", check)
    source = f"{packs.TILE}\n    {method}\n"
    stage = make_stage(source)
    picture = stage.pixels()
    ASKED[where](stage)
    stage.set(shade=0.9)
    line = packs.line_of(source, "too\\n")
    for _ in range(2):
        with pytest.raises(SceneError, match=rf"^tile failed in {where}: tile\.py:{line}: AssertionError: too bright$"):
            ASKED[where](stage)
        assert np.array_equal(stage.picture.pixels(), picture)
    stage.set(shade=0.25)
    ASKED[where](stage)
    assert np.array_equal(stage.pixels(), picture)


def test_a_change_that_cannot_be_prepared_is_undone(make_stage: MakeStage) -> None:
    """It raises where it is made, in one line; value, picture and what can be changed after that stay."""
    source = f"{packs.TILE}\n    def prepare(self):\n        assert self.params.shade < 0.8, 'too bright'\n"
    stage = make_stage(source)
    picture, before = stage.pixels(), stage.params.shade
    with pytest.raises(SceneError, match=r"^tile failed in prepare: tile\.py:\d+: AssertionError: too bright$"):
        stage.set(shade=0.9)
    assert stage.params.shade == before
    assert np.array_equal(stage.pixels(), picture)
    stage.set(shade=0.7)
    assert not np.array_equal(stage.pixels(), picture)


def test_a_scene_that_cannot_prepare_can_still_be_changed(make_stage: MakeStage) -> None:
    """Else nobody could set what would let it prepare again."""
    source = f"{packs.TILE}\n    def prepare(self):\n        assert self.frame < 5 or self.params.shade < 0.3\n"
    stage = make_stage(source)
    stage.set(shade=0.6)
    stage.seek(6)
    with pytest.raises(SceneError):
        stage.render()
    stage.set(shade=0.5)
    with pytest.raises(SceneError):
        stage.render()
    stage.set(shade=0.25)
    stage.render()


@pytest.mark.parametrize("where", ["prepare", "draw_over", "middle"])
def test_a_scene_that_exits_in_a_hook_is_a_mistake_of_its_own(make_stage: MakeStage, where: str) -> None:
    stage = make_stage(f"{packs.TILE}\n    def {where}(self):\n        raise SystemExit(3)\n")
    with pytest.raises(SceneError, match=rf"^tile failed in {where}: .*SystemExit: 3$"):
        stage.render()


@pytest.mark.parametrize("gives", ["(0.0,)", "'aside'", "None", "(0.0, float('nan'))", "(0.0, 0.0, 0.0)"])
def test_a_middle_that_is_no_place_is_a_mistake_of_the_scene_s(make_stage: MakeStage, gives: str) -> None:
    """Told in one line as such, not drawn and not an error of the engine's."""
    stage = make_stage(packs.TILE)
    picture = stage.pixels()
    stage = make_stage(f"{packs.TILE}\n    def middle(self):\n        return {gives}\n")
    for ask in (stage.render, lambda: stage.clicked(1, 1)):
        with pytest.raises(SceneError, match=r"^tile failed in middle: .*is not a place in the picture$"):
            ask()
    assert not np.array_equal(stage.picture.pixels(), picture)


@pytest.mark.parametrize("gives", ["None", "5", "[1]", "'xy'"])
def test_a_click_that_gives_no_mapping_is_a_mistake_of_the_scene_s(make_stage: MakeStage, gives: str) -> None:
    stage = make_stage(f"{packs.TILE}\n    def click(self, click):\n        return {gives}\n")
    with pytest.raises(SceneError, match=r"^tile failed in click: .+"):
        stage.clicked(1, 1)


# Over the set

def test_what_comes_over_the_set_has_no_shadow(make_stage: MakeStage) -> None:
    """Drawn before it a card throws a shadow on the floor; drawn after it the floor is as without it."""
    pictures = {}
    for comes in ("never", "before", "after"):
        pictures[comes] = make_stage(FLOATING, files=CARD, size=(96, 72), params={"comes": comes}).pixels()
    card = red(pictures["after"])
    assert card.sum() > 100 and np.array_equal(red(pictures["before"]), card)
    darker = pictures["never"].astype(int).sum(axis=2) - pictures["before"].astype(int).sum(axis=2)
    assert (darker[~card] > 40).sum() > 30
    assert np.array_equal(pictures["after"][~card], pictures["never"][~card])


def test_what_comes_over_the_set_lies_behind_what_is_nearer(make_stage: MakeStage) -> None:
    """It shares the depth of the scene and of the floor: a card under the floor is hidden by it."""
    lowered = FLOATING.replace("below = False, 0.0", "below = False, 1.5")
    pictures = [make_stage(lowered, files=CARD, size=(48, 36), params={"comes": comes}).pixels()
                for comes in ("after", "never")]
    assert np.array_equal(*pictures)


# The camera

POSES = [Orbit(30, 20, 4), Orbit(-110, -40, 7, (0.5, -1.0, 2.0), 60), Orbit(200, 80, 0.3, (3.0, 0.0, 0.0), 15)]


@pytest.mark.parametrize("pose", POSES)
@pytest.mark.parametrize("aspect", [0.4, 1.0, 16 / 9])
@pytest.mark.parametrize("middle", [(0.0, 0.0), (-0.46, 0.0), (0.3, 0.45)])
def test_a_ray_goes_through_what_is_seen_there(pose: Orbit, aspect: float, middle: tuple[float, float]) -> None:
    """The inverse of the projection: points along it project to where it started, wherever the lens is."""
    camera = OrbitCamera(pose)
    chance = np.random.default_rng(5)
    for place in chance.uniform(-1.0, 1.0, (20, 2)):
        origin, direction = camera.ray(tuple(place.tolist()), aspect, middle)
        assert np.linalg.norm(direction) == pytest.approx(1.0)
        point = origin + chance.uniform(0.1, 20.0) * pose.distance * direction
        clip = np.append(point, 1.0) @ camera.view() @ camera.projection(aspect, middle)
        assert clip[3] > 0.0
        assert clip[:2] / clip[3] == pytest.approx(place, abs=1e-6)


@pytest.mark.parametrize("size", [(90, 60), (60, 90)])
@pytest.mark.parametrize("middle", [(0.0, 0.0), (-0.5, 0.25), (0.4, -0.6)])
def test_the_target_appears_in_the_middle_that_the_scene_gives(make_stage: MakeStage, size: tuple[int, int],
                                                               middle: tuple[float, float]) -> None:
    """The pixels of a ball at the target lie around that place; one beside it is where the matrices have it."""
    stage = make_stage(BALL, size=size, params={"across": middle[0], "up": middle[1]})
    right, up = stage.camera.view()[:3, 0], stage.camera.view()[:3, 1]
    for aside in (np.zeros(3), 0.3 * right - 0.25 * up):
        stage.set(x=aside[0], y=aside[1], z=aside[2])
        rows, columns = np.nonzero(stage.pixels()[..., 0] > 60)
        assert len(rows) > 12
        clip = np.append(aside, 1.0) @ stage.camera.view() @ stage.camera.projection(size[0] / size[1], middle)
        across, high = (clip[:2] / clip[3]).tolist()
        if not aside.any():
            assert (across, high) == pytest.approx(middle, abs=1e-6)
        assert columns.mean() + 0.5 == pytest.approx((across + 1) / 2 * size[0], abs=0.7)
        assert rows.mean() + 0.5 == pytest.approx((1 - high) / 2 * size[1], abs=0.7)


def test_a_click_is_told_with_the_ray_under_it(make_stage: MakeStage) -> None:
    """Places from corner to corner, the picture's shape, and, with the lens shifted, a ray to what is drawn there."""
    stage = make_stage(DIARY, size=(40, 20))
    for pixel, place in (((0, 0), (-1, 1)), ((40, 0), (1, 1)), ((0, 20), (-1, -1)), ((40, 20), (1, -1)),
                         ((20, 10), (0, 0)), ((30, 10), (0.5, 0)), ((20, 2.5), (0, 0.75))):
        assert stage.clicked(*pixel) == {"shade": 0.5}
        click: Click = stage.scene.clicked
        assert click.place == pytest.approx(place)
        assert (click.aspect, click.height) == (2.0, 20)
        assert np.array_equal(click.origin, stage.camera.eye)
    assert np.allclose(stage.scene.clicked.direction, stage.camera.ray((0.0, 0.75), 2.0)[1])
    assert stage.params.shade == 0.25                                       # asked for, not done

    source = BALL + "\n    def click(self, click):\n        self.clicked = click\n        return {}\n"
    stage = make_stage(source, size=(80, 60), params={"across": -0.4, "up": 0.3, "x": 0.4, "y": -0.2})
    rows, columns = np.nonzero(stage.pixels()[..., 0] > 60)
    stage.clicked(columns.mean() + 0.5, rows.mean() + 0.5)
    click = stage.scene.clicked
    towards = np.array([0.4, -0.2, 0.0]) - click.origin
    assert np.linalg.norm(np.cross(towards, click.direction)) < 0.06        # half the ball's radius


def test_a_shadow_that_turns_with_the_camera_is_cast_again(make_stage: MakeStage) -> None:
    """Where the scene says so, and only then; a scene that says otherwise keeps the shadow it had."""
    turning = FLOATING.replace("turns, below = False,", "turns, below = True,")
    for source, draws in ((FLOATING, [2, 1, 1]), (turning, [2, 1, 2])):
        stage = make_stage(source, files=CARD, size=(96, 72))
        counted = [0]
        for drag in (0.0, 0.0, 0.4):
            stage.camera.drag(drag, 0.0)
            stage.render()
            counted.append(stage.scene.draws)
        assert [after - before for before, after in pairwise(counted)] == draws
    fresh = make_stage(turning, files=CARD, size=(96, 72))
    fresh.camera.drag(0.4, 0.0)
    assert np.array_equal(stage.picture.pixels(), fresh.pixels())


# Parameters on screen

class Offered(Parameters):
    level: float = slider(0.0, -1e6, 1e6, "A level", handy=(-3.0, 3.0))
    plain: float = slider(0.5, 0.0, 1.0, "A share")
    count: int = integer(4, 1, 100, "How many")
    wide: tuple[float, float] = interval((0.0, 1.0), -5.0, 5.0, "From where to where")
    shown: bool = toggle(True, "Whether")
    cell: str = text("", "A cell", pattern=r"\d{1,6}( *, *\d{1,6}){2}", example="3,0,7")
    free: str = text("anything", "A text")


def test_a_handy_range_is_what_the_slider_offers() -> None:
    """Without one it offers all; values beyond it are taken all the same."""
    params = Offered()
    assert params.offered("level").widget_range == (-3.0, 3.0)
    assert params.offered("plain").widget_range == (0.0, 1.0)
    params.set("level", 5e5)
    assert params.level == 5e5
    with pytest.raises(ParameterError, match=r"level = 2000000.0 is outside -1e\+06 to 1e\+06"):
        params.set("level", 2e6)
    assert (Offered.declared["level"].limits()["minimum"], Offered.declared["level"].limits()["maximum"]) == (-1e6, 1e6)


def test_an_offer_changes_the_slider_on_screen_only() -> None:
    """Neither the value, its limits, the revision, nor what another instance offers."""
    params, other = Offered(), Offered()
    params.offer("level", 200.0, 1e9)
    params.offer("count", 0, 7)
    assert params.offered("level").widget_range == (200.0, 1e6)             # cut to what is allowed
    assert params.offered("count").widget_range == (1, 7)
    assert (params.level, params.revision, params.stored()) == (0.0, other.revision, other.stored())
    assert params.set("level", -5.0) is None and params.level == -5.0
    assert other.offered("level").widget_range == (-3.0, 3.0)
    assert params.field("level").widget_range == (-3.0, 3.0)
    for low, high in ((1.0, 1.0), (2.0, 1.0), (float("nan"), 1.0)):
        params.offer("level", low, high)
        assert params.offered("level").widget_range == (200.0, 1e6)         # no range, no offer
    params.offer("shown", 0, 1)                                             # no number, no slider
    assert params.offered("shown") is params.field("shown")
    with pytest.raises(ParameterError, match="unknown parameter leve; did you mean level"):
        params.offer("leve", 0, 1)


@pytest.mark.parametrize("low", [2e6, -3e6])
def test_an_offer_beyond_the_limits_is_none(low: float) -> None:
    """A range that the parameter cannot reach leaves the slider as it was."""
    params = Offered()
    params.offer("level", low, low + 1e6 - 1)
    assert params.offered("level").widget_range == (-3.0, 3.0)


@pytest.mark.parametrize("value", ["", "   ", "3,0,7", " 3 , 0,  7 ", "000001,2,999999"])
def test_a_text_like_its_example_is_taken_as_typed(value: str) -> None:
    params = Offered()
    params.set("cell", value)
    assert params.cell == value


@pytest.mark.parametrize("value", [
    "3", "3,0", "3,0,7,1", "a,b,c", "-1,0,0", "3;0;7", "3,0,7x", "x3,0,7", "1234567,0,0", "3,0,", "1.0,2,3"])
def test_a_text_unlike_its_example_is_refused(value: str) -> None:
    params = Offered()
    with pytest.raises(ParameterError, match=rf"^cell = {value} is not written like 3,0,7$"):
        params.set("cell", value)
    assert params.cell == ""
    params.set("free", value)                                               # without a pattern, anything


def test_pattern_and_example_are_described() -> None:
    """For scripts, which check before they set."""
    about = Offered.declared["cell"].describe()
    assert (about["pattern"], about["example"]) == (r"\d{1,6}( *, *\d{1,6}){2}", "3,0,7")
    assert Offered.declared["free"].describe()["pattern"] == ""


def test_a_scene_that_is_not_furnished_draws_its_own_set(make_stage: MakeStage) -> None:
    """No floor and no backdrop where it draws nothing; a furnished one has both."""
    empty = packs.TILE.replace("        self.array.render(vertices=3)\n", "        pass\n")
    bare = empty.replace("Studio(ground=None)", "Studio(furnished=False)")
    assert not make_stage(bare, name="bare").pixels()[..., :3].any()
    assert make_stage(empty.replace("Studio(ground=None)", "Studio()")).pixels()[..., :3].all()
