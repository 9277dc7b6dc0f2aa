"""What is translucent and many: the layer over the picture, its blending, its depth, and that others do without."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import moderngl
import numpy as np
import pytest
from numpy.typing import ArrayLike, NDArray

from tests.conftest import MakeStage
from viewer.engine.camera import Orbit
from viewer.engine.gpu import Gpu, GpuError
from viewer.engine.picture import MOST_BYTES, Picture
from viewer.engine.scene import SceneError
from viewer.engine.stage import Stage

Floats = NDArray[np.float64]
SIZE = (48, 32)
SAMPLES = pytest.mark.parametrize("samples", [0, 4])

# A triangle over all of the picture or over what lies left of a slanted line, in one colour, at a sloping depth.
FILES = {"shaders/flat/flat.vert": """#version 330 core
uniform float u_right;       // where the slanted line crosses the middle of the picture, in clip space
uniform vec3 u_depth;        // window depth in the middle, and how much it grows over half the picture
void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 9.0 : -9.0, gl_VertexID == 2 ? 30.0 : -10.0);
    if (u_right < 1.0)       // an edge that falls by 5 for each 1 to the right
        corner = gl_VertexID == 0 ? vec2(u_right + 2.0, -10.0) : gl_VertexID == 1
            ? vec2(u_right - 2.0, 10.0) : vec2(-30.0, 0.0);
    float depth = u_depth.x + dot(u_depth.yz, corner);
    gl_Position = vec4(corner, 2.0 * depth - 1.0, 1.0);
}
""", "shaders/flat/flat.frag": """#version 330 core
uniform vec4 u_color;
out vec4 out_color;
void main() { out_color = u_color; }
""", "shaders/flat/depth.frag": """#version 330 core
uniform sampler2D u_scene_depth;
out vec4 out_color;
void main() { out_color = vec4(texelFetch(u_scene_depth, ivec2(gl_FragCoord.xy), 0).rrr, 1.0); }
"""}
SCENE = '''
import moderngl
from viewer import Orbit, Scene, Studio

class Flat(Scene):
    """A solid triangle, and sprites as large as the picture over it."""

    studio = Studio(ground=None)
    solid = {"u_color": (0.1, 0.2, 0.3, 1.0), "u_right": 2.0, "u_depth": (0.5, 0.0, 0.0)}
    sprites = ()                # the colour and depth of each
    shows_depth = False

    def __init__(self, gpu, params):
        self.programs = [gpu.program("flat/flat.vert", f"flat/{name}.frag") for name in ("flat", "flat", "depth")]
        self.arrays = [gpu.vertex_array(program) for program in self.programs]

    def show(self, which, **uniforms):
        for name, value in uniforms.items():
            self.programs[which][name] = value
        self.arrays[which].render(vertices=3)

    def draw(self):
        self.show(0, **self.solid)

    def draw_sprites(self, scene_depth):
        self.scene_depth = scene_depth
        for color, depth in self.sprites:
            self.show(1, u_color=color, u_right=2.0, u_depth=(depth, 0.0, 0.0))
        if self.shows_depth:
            scene_depth.use(3)
            self.show(2, u_scene_depth=3, u_right=2.0, u_depth=(0.0, 0.0, 0.0))
'''
WITHOUT = SCENE.replace("def draw_sprites", "def drawn_nowhere")
RED, GREEN = ((0.6, 0.05, 0.0, 0.5), 0.4), ((0.0, 0.7, 0.1, 0.8), 0.3)


def flat(make_stage: MakeStage, source: str = SCENE, **attributes: Any) -> Stage:
    """A stage of the scene above, its attributes set."""
    samples, size = attributes.pop("samples", 0), attributes.pop("size", SIZE)
    stage = make_stage(source, name="flat", files=FILES, size=size, samples=samples)
    give(stage, **attributes)
    return stage


def give(stage: Stage, **attributes: Any) -> None:
    """The scene's attributes from now on."""
    vars(stage.scene).update(attributes)


def tone_mapped(light: ArrayLike) -> Floats:
    """The Khronos PBR Neutral tone mapper, from its specification: compress above 0.8 - F90, desaturate by 0.15."""
    color = np.maximum(np.asarray(light, float), 0.0)
    smallest = color.min(axis=-1, keepdims=True)
    color = color - np.where(smallest < 0.08, smallest - 6.25 * smallest**2, 0.04)
    peak = color.max(axis=-1, keepdims=True)
    room = 1.0 - 0.76
    squeezed = 1.0 - room**2 / (np.maximum(peak, 0.76) + room - 0.76)
    share = 1.0 - 1.0 / (0.15 * (peak - squeezed) + 1.0)
    compressed = color * squeezed / np.maximum(peak, 1e-9) * (1.0 - share) + squeezed * share
    return np.asarray(np.where(peak < 0.76, color, compressed))


def on_screen(mapped: ArrayLike) -> Floats:
    """IEC 61966-2-1, as numbers from 0 to 255."""
    linear = np.asarray(mapped, float)
    return 255.0 * np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 1e-9)**(1 / 2.4) - 0.055)


def blended(behind: ArrayLike, sprites: Any) -> Floats:
    """Light after one sprite after the other came over it: its own, and what it lets through."""
    light = np.asarray(behind, float)
    for (*color, alpha), _ in sprites:
        light = np.asarray(color) + (1.0 - alpha) * light
    return light


def assert_shows(picture: NDArray[np.uint8], expected: ArrayLike) -> None:
    """Up to the dither and the half floats' rounding."""
    assert np.abs(picture[..., :3] - np.asarray(expected, float)).max() <= 1.0


# Blending

@SAMPLES
@pytest.mark.parametrize("sprites", [
    (), [((0.2, 0.1, 0.05, 0.0), 0.4)], [((0.3, 0.0, 0.3, 1.0), 0.4)], [RED], [RED, GREEN], [GREEN, RED],
    [((0.05, 0.02, 0.01, 0.0), 0.4)] * 8 + [RED], [((0.0, 0.0, 0.0, 0.25), 0.4)] * 3, [((3.0, 1.0, 0.5, 0.1), 0.4)],
], ids=["none", "adding", "opaque", "half", "red first", "green first", "many", "smoke", "glowing"])
def test_sprites_come_over_the_picture_in_linear_light(make_stage: MakeStage, samples: int, sprites: Any) -> None:
    """Each adds its light to what it lets through of what lies behind; then tones are mapped, once."""
    stage = flat(make_stage, samples=samples, sprites=sprites)
    assert_shows(stage.pixels(), on_screen(tone_mapped(blended((0.1, 0.2, 0.3), sprites))))


def test_order_counts_only_where_something_is_hidden(make_stage: MakeStage) -> None:
    """Light adds up in any order, to the byte; of two that hide, the later lies in front, whatever their depths."""
    adding = [((0.25, 0.0, 0.0, 0.0), 0.4), ((0.0, 0.5, 0.125, 0.0), 0.2)]
    first, second = (flat(make_stage, sprites=sprites).pixels() for sprites in (adding, adding[::-1]))
    assert np.array_equal(first, second)
    for sprites in ([RED, GREEN], [GREEN, RED]):
        opaque = [((*color[:3], 1.0), depth) for color, depth in sprites]
        assert_shows(flat(make_stage, sprites=opaque).pixels(), on_screen(tone_mapped(opaque[-1][0][:3])))


@SAMPLES
def test_what_overflows_is_white(make_stage: MakeStage, samples: int) -> None:
    """More light than a half float holds is still light, in this frame and the next."""
    stage = flat(make_stage, samples=samples, sprites=[((60000.0, 60000.0, 60000.0, 0.0), 0.4)] * 4)
    assert (stage.pixels()[..., :3] >= 254).all()
    give(stage, sprites=())
    assert_shows(stage.pixels(), on_screen(tone_mapped((0.1, 0.2, 0.3))))


# Depth

@SAMPLES
@pytest.mark.parametrize(("depth", "seen"), [(0.3, True), (0.5, True), (0.5001, False), (0.9, False)])
def test_solid_things_hide_sprites_behind_them(make_stage: MakeStage, samples: int, depth: float, seen: bool) -> None:
    """Right of the edge there is but the backdrop; left of it only what is nearer, or as near, is seen."""
    solid = {"u_color": (0.1, 0.2, 0.3, 1.0), "u_right": 0.0, "u_depth": (0.5, 0.0, 0.0)}
    sprites = [((0.3, 0.0, 0.0, 1.0), depth)]
    picture = flat(make_stage, samples=samples, solid=solid, sprites=sprites).pixels()
    left, right = picture[:, :SIZE[0] // 4], picture[:, -SIZE[0] // 4:]
    red = on_screen(tone_mapped((0.3, 0.0, 0.0)))
    assert_shows(right, red)
    assert_shows(left, red if seen else on_screen(tone_mapped((0.1, 0.2, 0.3))))


def test_sprites_write_no_depth(make_stage: MakeStage) -> None:
    """One behind another is drawn too, and the next frame starts from the scene's depth again."""
    sprites = [((0.1, 0.0, 0.0, 0.0), 0.1), ((0.0, 0.1, 0.0, 0.0), 0.4)]
    stage = flat(make_stage, sprites=sprites)
    for _ in range(2):
        assert_shows(stage.pixels(), on_screen(tone_mapped(blended((0.1, 0.2, 0.3), sprites))))


@SAMPLES
def test_shaders_read_the_depth_of_the_scene(make_stage: MakeStage, samples: int) -> None:
    """The plane's at the first sample's place in the pixel; 1 where there is nothing."""
    slope = np.array([0.2, -0.15])
    solid = {"u_color": (0.1, 0.2, 0.3, 1.0), "u_right": 0.1, "u_depth": (0.5, *slope)}
    stage = flat(make_stage, samples=samples, solid=solid, shows_depth=True)
    stage.render()
    down, across = np.mgrid[0:SIZE[1], 0:SIZE[0]]
    x, y = 2.0 * (across + 0.5) / SIZE[0] - 1.0, 2.0 * (down + 0.5) / SIZE[1] - 1.0
    inside = 5.0 * (x - 0.1) < -y - 5.0 / SIZE[0] - 1.0 / SIZE[1]
    outside = 5.0 * (x - 0.1) > -y + 5.0 / SIZE[0] + 1.0 / SIZE[1]
    expected = 0.5 + slope[0] * x + slope[1] * y
    within_pixel = np.abs(slope) @ (1.0 / np.array(SIZE)) if samples else 1e-6

    layer = stage.picture.sprites
    assert layer is not None and inside.sum() > 500 and outside.sum() > 500
    held = np.frombuffer(layer.scene_depth.read(), "f4").reshape(SIZE[::-1])
    assert np.abs(held - expected)[inside].max() <= within_pixel
    assert np.ptp((held - expected)[inside]) <= 1e-6        # the same place in each pixel
    assert np.all(held[outside] == 1.0)
    read = np.frombuffer(layer.texture.read(), "f2").reshape(*SIZE[::-1], 4)
    assert np.abs(read[..., :3] - held[..., None]).max() <= 2.0**-11


@pytest.mark.parametrize("distance", [1.0, 5.0, 20.0])
def test_the_depth_is_the_camera_s(make_stage: MakeStage, distance: float) -> None:
    """A wall at a distance from the eye has the depth that the projection gives that distance."""
    wall = "#version 330 core\n#include \"lib/frame.glsl\"\nuniform float u_distance;\nvoid main() {\n" \
           "vec2 corner = vec2(gl_VertexID == 1 ? 300.0 : -100.0, gl_VertexID == 2 ? 300.0 : -100.0);\n" \
           "gl_Position = u_frame.projection * vec4(corner, -u_distance, 1.0); }\n"
    source = SCENE.replace('"flat/flat.vert", f"flat', '"flat/wall.vert", f"flat')
    stage = make_stage(source, name="flat", files=FILES | {"shaders/flat/wall.vert": wall}, size=SIZE)
    stage.camera.stand(Orbit(20, 10, 4.0))
    give(stage, solid={"u_color": (0.1, 0.2, 0.3, 1.0), "u_distance": distance})
    stage.render()
    clip = np.array([0.0, 0.0, -distance, 1.0]) @ stage.camera.projection(SIZE[0] / SIZE[1])
    held = np.frombuffer(vars(stage.scene)["scene_depth"].read(), "f4")
    assert held == pytest.approx(0.5 + 0.5 * clip[2] / clip[3], abs=1e-6)


# Edges

def test_edges_stay_smooth_under_sprites(make_stage: MakeStage) -> None:
    """A pixel that a solid covers by a quarter shows a quarter of its tone: all five shares occur, and no other."""
    solid = {"u_color": (4.0, 2.0, 1.0, 1.0), "u_right": 0.0, "u_depth": (0.5, 0.0, 0.0)}
    black = SCENE.replace("ground=None", 'ground=None, backdrop=("#000000", "#000000")')
    sprites = [((0.1, 0.0, 0.05, 0.6), 0.2)]
    picture = flat(make_stage, black, samples=4, solid=solid, sprites=sprites).pixels()[..., :3]
    bright, dark = tone_mapped(blended((4.0, 2.0, 1.0), sprites)), tone_mapped(blended((0.0, 0.0, 0.0), sprites))
    shares = np.linspace(0.0, 1.0, 5)[:, None]
    expected = on_screen(shares * bright + (1.0 - shares) * dark)
    off = np.abs(picture[:, :, None] - expected).max(axis=-1)
    assert off.min(axis=-1).max() <= 1.5
    assert set(off.argmin(axis=-1).ravel().tolist()) == {0, 1, 2, 3, 4}


# Sizes, samples and scenes that change

@SAMPLES
def test_the_layer_is_as_large_as_the_picture(make_stage: MakeStage, samples: int) -> None:
    """After each resize, with samples and without."""
    stage = flat(make_stage, samples=4 - samples, sprites=[RED], shows_depth=False)
    stage.render()
    for size in ((21, 40), (64, 8)):
        stage.resize(size, samples)
        assert_shows(stage.pixels(), on_screen(tone_mapped(blended((0.1, 0.2, 0.3), [RED]))))
        layer = stage.picture.sprites
        assert layer is not None and layer.texture.size == layer.scene_depth.size == stage.picture.size == size


@SAMPLES
def test_a_scene_without_sprites_does_without_the_layer(make_stage: MakeStage, samples: int) -> None:
    """Nothing more is made for it; with a layer that stays empty the picture is the same, to the byte."""
    solid = {"u_color": (0.1, 0.2, 0.3, 1.0), "u_right": 0.0, "u_depth": (0.5, 0.0, 0.0)}
    without = flat(make_stage, WITHOUT, samples=samples, solid=solid)
    picture = without.pixels()
    assert without.picture.sprites is None
    kind = "finish_samples" if samples else "finish"
    assert [program.name for program in without.picture.gpu.programs] == [f"studio/{kind}.frag"]
    assert np.array_equal(picture, flat(make_stage, samples=samples, solid=solid).pixels())


@SAMPLES
def test_the_layer_comes_and_goes_with_the_scene(make_stage: MakeStage, samples: int) -> None:
    """An edit that adds draw_sprites is followed at once, and so is one that takes it away."""
    with_red = SCENE.replace("sprites = ()", f"sprites = {[RED]}")
    stage = flat(make_stage, WITHOUT, samples=samples)
    plain = stage.pixels()
    for source in (with_red, WITHOUT, with_red):
        Path(stage.entry.file).write_text(source, encoding="utf-8")
        stage.reload_scene()
        picture = stage.pixels()
        assert (stage.picture.sprites is None) == (source == WITHOUT)
        assert stage.picture.samples == samples
        if source == WITHOUT:
            assert np.array_equal(picture, plain)
        else:
            assert_shows(picture, on_screen(tone_mapped(blended((0.1, 0.2, 0.3), [RED]))))


def test_an_edited_shader_of_the_layer_is_taken_over(make_stage: MakeStage) -> None:
    """As any other of the set."""
    stage = flat(make_stage, sprites=[RED])
    stage.render()
    override = stage.entry.pack / "shaders/studio/sprites.glsl"
    override.parent.mkdir()
    override.write_text("uniform sampler2D u_sprites;\nvec4 sprites_at(ivec2 pixel) { return vec4(0.0); }\n"
                        "vec3 behind(vec4 sprites, vec3 light) { return light; }\n")
    fresh = Stage(stage.context, stage.entry, size=SIZE, samples=0)
    try:
        give(fresh, sprites=[RED])
        assert_shows(fresh.pixels(), on_screen(tone_mapped((0.1, 0.2, 0.3))))
        override.write_text(override.read_text().replace("return light", "return vec3(0.5)"))
        assert fresh.refresh_shaders() is None
        assert_shows(fresh.pixels(), on_screen(tone_mapped((0.5, 0.5, 0.5))))
    finally:
        fresh.release()


# What goes wrong

def test_a_failure_in_draw_sprites_is_one_line(make_stage: MakeStage) -> None:
    """With file and line; the scene goes on once it is mended."""
    stage = flat(make_stage, sprites=[RED])
    good = stage.pixels()
    give(stage, sprites=[RED, ((1.0, 0.0), 0.2, "surplus")])
    with pytest.raises(SceneError, match=r"^flat failed in draw_sprites: flat\.py:\d+: ValueError: too many values"):
        stage.render()
    assert np.array_equal(stage.picture.pixels(), good)
    give(stage, sprites=[RED])
    assert np.array_equal(stage.pixels(), good)


def test_what_draw_sprites_leaves_behind_harms_nobody(make_stage: MakeStage) -> None:
    """State, framebuffer and scissor are put right for what follows, in this frame and the next."""
    untidy = SCENE.replace("        self.scene_depth = scene_depth\n", """
        self.scene_depth = scene_depth
        context = self.gpu.context
        context.fbo.scissor = 0, 0, 3, 3
        context.fbo.viewport = 0, 0, 5, 5
        context.fbo.depth_mask = True
        context.wireframe = True
        context.depth_func = "0"
        context.blend_equation = moderngl.MAX, moderngl.MAX
        context.blend_func = moderngl.ZERO, moderngl.ONE
        context.enable(moderngl.CULL_FACE | moderngl.PROGRAM_POINT_SIZE)
        if self.sprites == "elsewhere":
            self.gpu.framebuffer([self.gpu.texture((4, 4), 4)]).use()
        self.sprites = ()
""")
    stage = flat(make_stage, untidy, samples=4, sprites="elsewhere")
    expected = flat(make_stage, WITHOUT, samples=4).pixels()
    for _ in range(2):
        assert np.array_equal(stage.pixels(), expected)


def test_a_driver_without_multisampling_is_enough(make_stage: MakeStage, monkeypatch: pytest.MonkeyPatch) -> None:
    """As in some virtual machines: the picture has one sample then, and the layer reads its depth."""
    framebuffer = Gpu.framebuffer

    def refuses(gpu: Gpu, color: Any = (), depth: Any = None, label: str = "") -> moderngl.Framebuffer:
        if any(texture.samples for texture in color):
            raise moderngl.Error("framebuffer is not complete (GL_FRAMEBUFFER_UNSUPPORTED)")
        return framebuffer(gpu, color, depth, label)

    monkeypatch.setattr(Gpu, "framebuffer", refuses)
    stage = flat(make_stage, samples=4, sprites=[RED, ((1.0, 1.0, 1.0, 1.0), 0.9)])
    assert_shows(stage.pixels(), on_screen(tone_mapped(blended((0.1, 0.2, 0.3), [RED]))))
    assert stage.picture.samples == 0


def test_the_layer_counts_in_the_picture_s_memory(make_stage: MakeStage, context: moderngl.Context) -> None:
    """What would fit without it is refused with it, before anything is made."""
    gpu = Gpu(context, flat(make_stage).entry.shaders)
    side = int((MOST_BYTES / (12 * 16 + 4 + 8))**0.5)
    with pytest.raises(GpuError, match=rf"a picture of {side}x{side} with 16 samples needs 4\.2 GiB"):
        Picture(gpu, (side, side), 16, sprites=True)
    assert not gpu._owned and not gpu.programs
