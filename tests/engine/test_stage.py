"""A stage: time that can be sought, changes that can fail, and pictures that are nobody else's."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import moderngl
import numpy as np
import pytest

from tests import packs
from tests.conftest import MakeStage
from viewer.engine.camera import Orbit
from viewer.engine.clock import FRAME_SECONDS
from viewer.engine.fields import ParameterError
from viewer.engine.gpu import GpuError
from viewer.engine.scene import SceneError, Studio
from viewer.engine.stage import Stage
from viewer.errors import DemoscopeError

# A card that hovers over the floor where ``place`` says, so that its shadow can be followed.
CARD = {"shaders/card/card.vert": """#version 330 core
#include "lib/frame.glsl"
uniform float u_place;
void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) - 0.5;
    gl_Position = u_frame.view_projection * vec4(corner.y + u_place, 0.0, corner.x, 1.0);
}
""", "shaders/card/card.frag": "#version 330 core\nout vec4 out_color;\nvoid main() { out_color = vec4(1.0); }\n"}
CARD_SCENE = '''
import moderngl
from viewer import Parameters, Scene, slider

class Card(Scene):
    """A card that moves."""

    class Params(Parameters):
        offset: float = slider(0.0, -1.0, 1.0, "Where it starts")
        place_by: float = slider(0.02, 0.0, 1.0, "How far a frame moves it")

    def __init__(self, gpu, params):
        self.params = params
        self.program = gpu.program("card/card.vert", "card/card.frag")
        self.array = gpu.vertex_array(self.program, mode=moderngl.TRIANGLE_STRIP)
        self.place = 0.0
        self.draws = 0
UPDATE
    def draw(self):
        self.draws += 1
        self.program["u_place"] = self.params.offset + PLACE
        self.array.render(vertices=4)
'''
STILL = CARD_SCENE.replace("UPDATE", "").replace("PLACE", "0.0")
TIMED = CARD_SCENE.replace("UPDATE", "").replace("PLACE", "self.time")
SIMULATED = CARD_SCENE.replace("UPDATE", "\n    def update(self, dt):\n        self.place += self.params.place_by\n")
SIMULATED = SIMULATED.replace("PLACE", "self.place")


@pytest.fixture
def walk(make_stage: MakeStage) -> Iterator[Stage]:
    """A stage whose frames follow from those before."""
    yield make_stage(packs.WALK, seed=3)


def test_seeking_gives_what_playing_gives(make_stage: MakeStage) -> None:
    """Forwards at once, backwards from beyond, in steps, by the clock: the same picture and numbers."""
    played, sought = make_stage(packs.WALK, seed=3), make_stage(packs.WALK, seed=3)
    pictures = []
    for frame in range(41):
        if frame:
            played.step()
        pictures.append(played.pixels())
        assert played.frame == frame
    assert len({picture.tobytes() for picture in pictures}) > 30

    for frame in (40, 7, 7, 0, 23, 22, 40, 1):
        sought.seek(frame)
        assert np.array_equal(sought.pixels(), pictures[frame]), frame
        assert sought.measure()["steps"] == frame
    sought.step(-5)
    assert sought.frame == 0
    steps = 0
    while sought.frame < 23:
        steps += sought.advance(1.7 * FRAME_SECONDS)
        if sought.frame > 23:
            sought.seek(23)
    assert steps >= 23
    assert np.array_equal(sought.pixels(), pictures[23])


def test_the_seed_is_the_only_source_of_chance(make_stage: MakeStage) -> None:
    """The same seed walks the same way, another another."""
    places = []
    for seed in (1, 1, 2):
        stage = make_stage(packs.WALK, seed=seed)
        stage.seek(10)
        places.append(stage.measure()["place"])
    assert places[0] == places[1] != places[2]


def test_a_frame_before_the_first_is_refused(walk: Stage) -> None:
    """And nothing moves."""
    walk.seek(5)
    with pytest.raises(ParameterError, match="frame = -1 is before the first, which is 0"):
        walk.seek(-1)
    assert walk.frame == 5


def test_paused_stages_stand_still(walk: Stage) -> None:
    """The wall clock moves a scene only while it plays."""
    walk.clock.toggle()
    assert walk.advance(1.0) == 0
    walk.clock.toggle()
    assert walk.advance(0.1) == 6


def test_a_rebuild_keeps_camera_clock_and_values(make_stage: MakeStage) -> None:
    """Only the scene is new; it stands where the old one stood."""
    stage = make_stage(packs.WALK.replace('"How far a step goes")', '"How far a step goes", rebuild=True)'), seed=3)
    stage.camera.pose(Orbit(11, 12, 13))
    stage.set(stride=0.4)
    stage.seek(12)
    place, scene = stage.measure()["place"], stage.scene
    stage.set(stride=0.7)
    assert stage.scene is not scene
    assert (stage.frame, stage.measure()["steps"], stage.camera.yaw, stage.params.stride) == (12, 12, 11, 0.7)
    assert stage.measure()["place"] != place
    stage.set(stride=0.4)
    assert stage.measure()["place"] == place


@pytest.mark.parametrize("change", [{"sides": 7}, {"shade": 0.9, "sides": "7"}, {"sides": 7, "height": 1}])
def test_a_rebuild_that_fails_changes_nothing(make_stage: MakeStage, change: dict[str, object]) -> None:
    """Values, scene and picture are the last good ones, and go on."""
    stage = make_stage(params={"sides": 5})
    stage.seek(4)
    before, picture, scene = stage.params.stored(), stage.pixels(), stage.scene
    line = packs.line_of(packs.TILE, "raise ValueError")
    with pytest.raises(SceneError, match=f"^tile failed to build: tile.py:{line}: ValueError: seven sides"):
        stage.set(**change)
    assert stage.params.stored() == before
    assert stage.scene is scene
    assert np.array_equal(stage.pixels(), picture)
    stage.set(sides=6)
    assert stage.measure() == {"sides": 6, "frame": 4}


def test_a_rebuild_that_fails_on_the_way_to_the_frame_changes_nothing(make_stage: MakeStage) -> None:
    """A scene that builds but cannot be played to where it stood does not take the old one's place."""
    stage = make_stage(packs.WALK)
    stage.seek(10)
    before, picture = stage.params.stored(), stage.pixels()
    with pytest.raises(SceneError, match=r"tile failed in update: tile.py:.*stumbled"):
        stage.set(breaks_at=5)
    assert (stage.frame, stage.params.stored()) == (10, before)
    assert stage.measure()["steps"] == 10
    assert np.array_equal(stage.pixels(), picture)
    stage.seek(11)
    assert stage.measure()["steps"] == 11


def test_seeking_back_that_fails_stays_where_it_was(make_stage: MakeStage) -> None:
    """The last good frame stays in the picture."""
    stage = make_stage(packs.WALK.replace(", rebuild=True)", ")"))
    stage.seek(10)
    stage.set(breaks_at=5)
    with pytest.raises(SceneError, match="stumbled"):
        stage.seek(7)
    assert (stage.frame, stage.measure()["steps"]) == (10, 10)


@pytest.mark.parametrize(("where", "doing"), [
    ("__init__", "failed to build"), ("draw", "failed in draw"), ("geometry", "failed in geometry"),
    ("measure", "failed in measure"), ("update", "failed in update")])
def test_what_a_scene_raises_is_told_by_file_and_line(make_stage: MakeStage, where: str, doing: str) -> None:
    """In one line, whichever of its methods it was."""
    source = packs.failing(where)
    line = packs.line_of(source, "raise KeyError")
    with pytest.raises(SceneError, match=rf"^tile {doing}: tile\.py:{line}: KeyError: 'depth'$"):
        stage = make_stage(source)
        stage.seek(1)
        stage.render()
        stage.geometry()
        stage.measure()


def test_an_error_deep_in_a_library_names_the_scene_s_line(make_stage: MakeStage) -> None:
    """The line of the scene that called it, not the library's."""
    source = "import json\n" + packs.failing("measure", "json.loads('{')\n")
    with pytest.raises(SceneError, match=rf"tile\.py:{packs.line_of(source, 'json.loads')}: JSONDecodeError: "):
        make_stage(source).measure()


def test_a_draw_that_fails_leaves_the_last_picture(make_stage: MakeStage) -> None:
    """And the next good one is drawn as ever, shadow included."""
    stage = make_stage(packs.failing("draw", "assert self.params.shade < 0.8"), size=(16, 16))
    picture = stage.pixels()
    stage.set(shade=0.9)
    for _ in range(2):
        with pytest.raises(SceneError, match="failed in draw"):
            stage.render()
        assert np.array_equal(stage.picture.pixels(), picture)
    stage.set(shade=0.25)
    assert np.array_equal(stage.pixels(), picture)


@pytest.mark.parametrize(("source", "moves"), [(STILL, False), (TIMED, True), (SIMULATED, True)])
def test_a_shadow_is_cast_again_only_where_it_can_have_changed(make_stage: MakeStage, source: str, moves: bool) -> None:
    """Twice drawn, for the shadow and in colour, or once, for the colour alone."""
    stage = make_stage(source, files=CARD)

    def draws() -> int:
        before = stage.scene.draws
        stage.render()
        return int(stage.scene.draws - before)

    assert draws() == 2
    stage.render()
    assert draws() == 1
    stage.camera.drag(0.2, 0.1)
    assert draws() == 1
    stage.resize((40, 20))
    assert draws() == 1
    stage.set(offset=0.5)
    assert draws() == 2
    stage.step()
    assert draws() == (2 if moves else 1)
    assert draws() == 1


@pytest.mark.parametrize("source", [TIMED, SIMULATED])
def test_a_shadow_follows_what_moves(make_stage: MakeStage, source: str) -> None:
    """A picture reached by playing, each frame drawn, has the shadow of one that was sought."""
    played, sought = make_stage(source, files=CARD, size=(64, 48)), make_stage(source, files=CARD, size=(64, 48))
    first = played.pixels()
    for _ in range(20):
        played.step()
        played.render()
    sought.seek(20)
    assert np.array_equal(played.pixels(), sought.pixels())
    assert not np.array_equal(played.pixels(), first)
    played.seek(0)
    assert np.array_equal(played.pixels(), first)


def test_a_shadow_darkens_the_floor(make_stage: MakeStage) -> None:
    """Against a scene that draws nothing."""
    stage, bare = (make_stage(STILL.replace("vertices=4", f"vertices={n}"), files=CARD, size=(64, 48)) for n in (4, 0))
    card, floor = stage.pixels()[..., 0].astype(int), bare.pixels()[..., 0].astype(int)
    assert (card < floor - 15).sum() > 20


def test_pictures_are_upright_opaque_and_encoded(make_stage: MakeStage) -> None:
    """Top row first, alpha 255, brighter for brighter."""
    upper = "vec3(u_shade) * (gl_FragCoord.y > 9.0 ? 1.0 : 0.0)"
    up = packs.SHADERS["shaders/tile/draw.frag"].replace("vec3(u_shade)", upper)
    stage = make_stage(files={"shaders/tile/draw.frag": up}, params={"shade": 0.5})
    pixels = stage.pixels()
    assert pixels.shape == (18, 32, 4)
    assert pixels.dtype == np.uint8
    assert (pixels[..., 3] == 255).all()
    assert pixels[:9, :, :3].min() > 100
    assert pixels[9:, :, :3].max() < 5
    brighter = [int(stage.pixels()[0, 0, 0]) for shade in (0.0, 0.1, 0.2, 0.5, 1.0) if stage.set(shade=shade) is None]
    assert brighter == sorted(set(brighter))


def test_samples_smooth_edges(make_stage: MakeStage) -> None:
    """More shades along the card's edge with four samples than with one, at the same colours."""
    shades = {}
    for samples in (0, 4):
        stage = make_stage(STILL.replace("class Card(Scene):", "class Card(Scene):\n    studio = Studio(ground=None)")
                           .replace("import Parameters", "import Studio, Parameters"), files=CARD, size=(64, 48),
                           samples=samples)
        shades[samples] = stage.pixels()[..., 0].astype(int)
        assert stage.picture.samples == samples
    edge = np.abs(shades[0] - shades[4]) > 8
    assert 10 < edge.sum() < 500


@pytest.mark.parametrize(("size", "samples", "message"), [
    ((0, 0), 0, "a picture of 0x0 is outside 1x1 to"),
    ((99999, 99999), 0, "a picture of 99999x99999 is outside 1x1 to"),
    ((16, 16), 17, "samples = 17 is outside 0 to 16"), ((16, 16), -1, "samples = -1 is outside 0 to 16"),
    ((16000, 16000), 16, "needs [0-9.]+ GiB; at most 4 GiB is allowed"),
])
def test_a_size_beyond_the_limits_keeps_the_present_one(make_stage: MakeStage, size: tuple[int, int], samples: int,
                                                        message: str) -> None:
    """Refused before anything is given up."""
    stage = make_stage()
    picture = stage.pixels()
    with pytest.raises(GpuError, match=message):
        stage.resize(size, samples)
    assert stage.size == (32, 18)
    assert np.array_equal(stage.pixels(), picture)
    with pytest.raises(GpuError, match=message):
        make_stage(size=size, samples=samples)


def test_resizing_keeps_everything_else(walk: Stage) -> None:
    """There and back is the same picture."""
    walk.seek(9)
    before = walk.pixels()
    walk.resize((100, 50), 4)
    assert walk.pixels().shape == (50, 100, 4)
    walk.resize((32, 18), 0)
    assert np.array_equal(walk.pixels(), before)


FEEDBACK = packs.TILE + '''
    def update(self, dt):
        self.built_with = float(self.array.capture({"v_value": 3}, 4)["v_value"][3, 1])
'''


def test_an_update_may_use_the_gpu_whatever_came_before(make_stage: MakeStage) -> None:
    """Transform feedback needs some framebuffer to be bound, which resizing and other stages take away."""
    stage, other = make_stage(FEEDBACK), make_stage()
    stage.seek(1)
    assert stage.measure()["sides"] == 3.0
    stage.resize((8, 8))
    stage.seek(2)
    assert stage.measure()["sides"] == 3.0
    other.release()
    stage.seek(3)
    stage.seek(1)
    assert stage.measure()["sides"] == 3.0


def test_a_scene_is_always_built_at_the_first_frame(make_stage: MakeStage) -> None:
    """What its constructor computes on the GPU may depend on the time; that is 0, however late it is rebuilt."""
    vertex = packs.SHADERS["shaders/tile/draw.vert"].replace("out vec3", '#include "lib/frame.glsl"\nout vec3')
    source = packs.TILE.replace("self.built_with = params.sides",
                                'self.built_with = float(self.array.capture({"v_value": 3}, 1)["v_value"][0, 2])')
    vertex = vertex.replace("1.0);\n    gl", "u_frame.number);\n    gl")
    stage = make_stage(source, files={"shaders/tile/draw.vert": vertex})
    assert stage.measure()["sides"] == 0.0
    stage.seek(50)
    stage.set(sides=5)
    assert stage.measure() == {"sides": 0.0, "frame": 50}


def test_two_stages_do_not_disturb_each_other(make_stage: MakeStage) -> None:
    """Drawn in turns they give what each gives alone, whatever the other is set to."""
    alone = []
    for seed, stride in ((1, 0.3), (2, 0.8)):
        stage = make_stage(packs.WALK, seed=seed, params={"stride": stride})
        stage.seek(6)
        alone.append(stage.pixels())
    one = make_stage(packs.WALK, seed=1, params={"stride": 0.3})
    other = make_stage(packs.WALK, seed=2, params={"stride": 0.8}, size=(32, 18))
    for _ in range(6):
        for stage in (one, other):
            stage.step()
            stage.render()
            stage.measure()
    assert np.array_equal(one.pixels(), alone[0])
    assert np.array_equal(other.pixels(), alone[1])
    other.resize((64, 64), 4)
    other.release()
    assert np.array_equal(one.pixels(), alone[0])


def test_stages_can_follow_one_another(context: moderngl.Context, make_stage: MakeStage) -> None:
    """Each freed before the next, as a window that goes through the scenes does."""
    pictures = set()
    for source in (packs.TILE, packs.WALK, packs.TILE, packs.WALK):
        stage = make_stage(source)
        stage.seek(3)
        pictures.add((source, stage.pixels().tobytes()))
        stage.release()
    assert len(pictures) == 2
    assert context.error == "GL_NO_ERROR"


def reloaded(stage: Stage, source: str) -> None:
    Path(stage.entry.file).write_text(source, encoding="utf-8")
    stage.reload_scene()


def test_an_edited_scene_file_takes_over_with_its_values(make_stage: MakeStage) -> None:
    """Values that still apply stay, the rest go to the default; camera and clock stay."""
    stage = make_stage(params={"shade": 0.75, "sides": 9, "height": 4})
    stage.seek(30)
    stage.camera.drag(0.3, 0.1)
    yaw = stage.camera.yaw
    reloaded(stage, packs.TILE.replace("height: float = slider(2.0, 0.0, 5.0,", "height: float = slider(2.0, 0.0, 3.0,")
             .replace('"frame": self.frame', '"frame": self.frame, "new": 1'))
    assert stage.params.stored() == {"shade": 0.75, "height": 2.0, "sides": 9}
    assert stage.measure() == {"sides": 9, "frame": 30, "new": 1}
    assert stage.camera.yaw == yaw


@pytest.mark.parametrize("source", [
    "class", packs.TILE.replace("Scene)", "Seen)"), packs.failing("__init__"), packs.failing("update")])
def test_a_bad_edit_of_a_scene_file_leaves_the_scene(make_stage: MakeStage, source: str) -> None:
    """The last good one goes on, and a good edit takes over later."""
    stage = make_stage(params={"shade": 0.75})
    stage.seek(3)
    picture = stage.pixels()
    with pytest.raises(SceneError, match=r"tile\.py"):
        reloaded(stage, source)
    assert stage.frame == 3
    assert np.array_equal(stage.pixels(), picture)
    reloaded(stage, packs.TILE)
    assert np.array_equal(stage.pixels(), picture)


def test_an_edited_scene_may_move_to_another_set(make_stage: MakeStage) -> None:
    """Its floor and backdrop come with it."""
    stage = make_stage(packs.TILE.replace("vertices=3", "vertices=0"))
    before = stage.pixels()
    reloaded(stage, packs.TILE.replace("vertices=3", "vertices=0")
             .replace("Studio(ground=None)", 'Studio(ground=None, backdrop=("#300000", "#300000"))'))
    pixels = stage.pixels()
    assert not np.array_equal(pixels, before)
    assert int(pixels[..., 0].min()) > int(pixels[..., 2].max())


@pytest.mark.parametrize("mess", [
    "context.wireframe = True", "context.polygon_offset = 5.0, 5.0", "context.fbo.viewport = 0, 0, 4, 4",
    "context.scissor = 0, 0, 4, 4", "context.fbo.depth_mask = False", "context.cull_face = 'front_and_back'",
    "context.enable_only(context.CULL_FACE | context.BLEND)", "self.aside.use()"])
def test_what_a_scene_leaves_behind_ends_with_its_draw(make_stage: MakeStage, mess: str) -> None:
    """Floor and backdrop are the same, the next frame too, and so is another stage's picture."""
    aside = "        self.aside = gpu.framebuffer([gpu.texture((4, 4), 4)])\n        self.built_with"
    source = packs.TILE.replace("studio = Studio(ground=None)", "studio = Studio()")
    source = source.replace("        self.built_with", aside, 1)
    tidy = make_stage(source.replace("self.array.render(vertices=3)", "pass"))
    expected = tidy.pixels()
    messy = make_stage(source.replace("self.array.render(vertices=3)", f"context = self.gpu.context; {mess}"))
    assert np.array_equal(messy.pixels(), expected)
    messy.set(shade=0.5)
    assert np.array_equal(messy.pixels(), expected)
    tidy.set(shade=0.5)
    assert np.array_equal(tidy.pixels(), expected)


@pytest.mark.parametrize("frame", [1.5, float("nan"), "3", None, 10**400])
def test_a_frame_is_a_whole_number(walk: Stage, frame: object) -> None:
    walk.seek(np.int64(2))
    with pytest.raises(ParameterError, match=r"^frame = "):
        walk.seek(frame)  # type: ignore[arg-type]
    assert walk.frame == 2


@pytest.mark.parametrize("size", [(32.5, 18), "32x18", (32,), 32, None])
def test_a_size_is_two_whole_numbers(make_stage: MakeStage, size: object) -> None:
    stage = make_stage()
    with pytest.raises(GpuError, match="is not a width and a height"):
        stage.resize(size)  # type: ignore[arg-type]
    stage.resize(np.array([16, 9]))  # type: ignore[arg-type]
    assert stage.size == (16, 9)


def test_a_step_that_fails_is_still_to_be_made(make_stage: MakeStage) -> None:
    """Playing on would leave it out, and the same frame would no longer be the same picture."""
    stage = make_stage(packs.WALK, name="walk", params={"breaks_at": 3})
    with pytest.raises(SceneError, match="stumbled"):
        stage.seek(5)
    assert stage.frame == 2


def test_a_stage_that_was_released_says_so(make_stage: MakeStage) -> None:
    stage = make_stage()
    stage.release()
    for use in (stage.render, stage.pixels, stage.geometry, stage.measure, stage.rebuild,
                lambda: stage.resize((8, 8))):
        with pytest.raises(DemoscopeError, match="has been released"):
            use()


def test_generated_text_that_cannot_be_made_undoes_the_change(make_stage: MakeStage) -> None:
    source = packs.TILE.replace('"tile/draw.frag")', '"tile/draw.frag", generated={'
                                '"generated/a.glsl": lambda: f"{1 / (params.height - 1)}"})')
    stage = make_stage(source)
    with pytest.raises(DemoscopeError, match=r"generated/a\.glsl: cannot be made: ZeroDivisionError"):
        stage.set(height=1.0)
    assert stage.params.height == 2.0
    assert stage.refresh_shaders() is None


def test_another_set_that_fails_leaves_the_present_one(make_stage: MakeStage) -> None:
    broken = {"shaders/studio/ground.frag": "#version 330 core\nvoid main() { x }\n"}
    stage = make_stage()
    before = stage.pixels()
    place = stage.entry.shaders.folders[0] / "studio" / "ground.frag"
    place.parent.mkdir()
    place.write_text(broken["shaders/studio/ground.frag"])
    with pytest.raises(DemoscopeError, match=r"studio/ground\.frag:2"):
        stage.painter.furnish(Studio(ground=-2.0))
    place.unlink()
    assert np.array_equal(stage.pixels(), before)


@pytest.mark.parametrize("size", [(5, 1), (1, 5), (1, 1)])
def test_pixels_are_the_caller_s_to_change(make_stage: MakeStage, size: tuple[int, int]) -> None:
    """However low the picture is."""
    picture = make_stage(size=size).pixels()
    picture[...] = 0
    assert picture.flags["C_CONTIGUOUS"]
