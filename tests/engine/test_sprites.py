"""How particles look: their light against closed forms, their order, their colours, and what hides or softens them."""

from __future__ import annotations

import struct
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import ArrayLike, NDArray
from PIL import Image

from tests.conftest import MakeStage
from viewer.engine.camera import Orbit
from viewer.engine.fields import ParameterError
from viewer.engine.particles.cascade import CascadeParameters
from viewer.engine.particles.look import SPRITES, LookParameters, generation_key
from viewer.engine.particles.sprite_image import image_texels, puff_noise
from viewer.engine.particles.sprites import Sprites
from viewer.engine.stage import Stage
from viewer.kit.gradient import Gradient
from viewer.kit.life_curve import LifeCurve

Floats = NDArray[np.float64]
SIZE = (160, 96)
FILES = {"shaders/wall/wall.vert": """#version 330 core
#include "lib/frame.glsl"
uniform float u_distance;
void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 300.0 : -100.0, gl_VertexID == 2 ? 300.0 : -100.0);
    gl_Position = u_frame.projection * vec4(corner, -u_distance, 1.0);
}
""", "shaders/wall/wall.frag": """#version 330 core
out vec4 out_color;
void main() { out_color = vec4(0.0, 0.0, 0.0, 1.0); }
"""}
SCENE = '''
from viewer.engine.camera import Orbit
from viewer.engine.particles.look import LookParameters
from viewer.engine.particles.sprite_image import puff_noise
from viewer.engine.particles.sprites import Sprites
from viewer.engine.particles.system import ParticleParameters, ParticleSystem
from viewer.engine.scene import Scene, Studio

class Motes(Scene):
    """Particles where a test puts them, before a wall or none."""

    class Params(ParticleParameters, LookParameters):
        pass

    studio = Studio(radius=2.0, ground=None, backdrop=("#000000", "#000000"))
    camera = Orbit(yaw=20, pitch=10, distance=5)
    wall = None

    def __init__(self, gpu, params):
        self.system = ParticleSystem(gpu, params, Sprites.bytes_per_particle)
        self.system.begin()
        self.sprites = Sprites(gpu, self.system, params)
        self.program = gpu.program("wall/wall.vert", "wall/wall.frag")
        self.array = gpu.vertex_array(self.program)

    def prepare(self):
        self.sprites.prepare()

    def draw(self):
        if self.gpu.casting_shadows:
            self.sprites.cast_shadows()
        elif self.wall:
            self.program["u_distance"] = self.wall
            self.array.render(vertices=3)

    def draw_sprites(self, scene_depth):
        self.sprites.draw(scene_depth)

    def color_scale(self):
        return self.sprites.color_scale()
'''
PLAIN = {"rate": 0, "burst": 0, "color": "#ffffff", "size_over_life": "1", "opacity_over_life": "1", "opacity": 1.0,
         "softness": 0.0, "shadows": False, "billboard": "camera", "glow": 1.0, "blending": "additive", "ground": False}


class Motes:
    """A stage whose particles are put where a test wants them; what they look like is read from the sprites' layer."""

    def __init__(self, make_stage: MakeStage, count: int = 16, source: str = SCENE, **params: object) -> None:
        values = {**PLAIN, "count": count, **params}
        self.stage: Stage = make_stage(source, name="motes", files=FILES, size=SIZE, params=values)
        self.sprites: Sprites = vars(self.stage.scene)["sprites"]

    @property
    def scale(self) -> float:
        """Pixels that a metre has at a distance of one."""
        return float(0.5 * SIZE[1] * self.stage.camera.projection(SIZE[0] / SIZE[1])[1, 1])

    def at(self, pixel: tuple[float, float], away: float) -> Floats:
        """The place in the world that is seen at a pixel, so far along the camera's axis."""
        across, up = (2.0 * np.asarray(pixel) / SIZE - 1.0) * SIZE / (2.0 * self.scale)
        view = np.array([across * away, up * away, -away, 1.0])
        return np.asarray((view @ np.linalg.inv(self.stage.camera.view()))[:3])

    def put(self, places: ArrayLike, size: ArrayLike, velocity: ArrayLike = (0.0, 0.0, 0.0), age: ArrayLike = 0.0,
            life: float = 10.0, generation: ArrayLike = 0, mass: ArrayLike = 1.0, stuck: bool = False) -> None:
        """Particles (n, 3) of these qualities, and no others; those older than their life are dead."""
        places = np.atleast_2d(places)
        pool, number = self.sprites.system.pool, len(places)
        texels = {name: np.zeros((pool.width * pool.height, 4), np.float32) for name in pool.textures}
        texels["motion"][:number, :3], texels["motion"][:number, 3] = places, life - np.asarray(age)
        texels["velocity"][:number, :3], texels["velocity"][:number, 3] = velocity, 1 + np.arange(number) * 7919
        texels["velocity"][:number, 3] *= -1 if stuck else 1
        for column, quality in enumerate((life, size, mass)):
            texels["nature"][:number, column] = quality
        texels["launch"][:number, 3] = generation
        pool.used = number
        self.stage.painter._shadow_shows = None     # nobody else moves particles behind its back
        for name, texture in pool.textures.items():
            texture.write(texels[name])

    def light(self) -> Floats:
        """What the sprites add, and what they let through: (height, width, 4), lowest row first."""
        self.stage.render()
        layer = self.stage.picture.sprites
        assert layer is not None
        texels = np.frombuffer(layer.texture.read(), np.float16).reshape(*SIZE[::-1], 4).astype(float)
        assert np.isfinite(texels).all() and (texels >= 0.0).all()
        return texels

    def total(self) -> Floats:
        """All the light that the sprites add, by colour."""
        return np.asarray(self.light()[..., :3].sum(axis=(0, 1)))


@pytest.mark.parametrize(("pixels", "within"), [
    (0.05, 0.01), (0.4, 0.01), (1.0, 0.01), (1.9, 0.01), (2.2, 0.03), (2.5, 0.04), (2.8, 0.05), (3.0, 0.04),
    (4.0, 0.02), (7.3, 0.01), (40.0, 0.003)])
def test_a_spot_has_all_its_light_however_small(make_stage: MakeStage, pixels: float, within: float) -> None:
    """(1 - r^2)^2 over a disc of radius R is pi R^2 / 3, wherever between the pixels its middle lies."""
    motes = Motes(make_stage, glow=100.0 if pixels < 3.0 else 1.0)
    glow = 100.0 if pixels < 3.0 else 1.0
    for across, up in np.random.default_rng(3).random((12, 2)):
        motes.put(motes.at((80 + across, 48 + up), 4.0), 4.0 * pixels / motes.scale)
        assert motes.total() == pytest.approx(glow * np.pi * (pixels / 2) ** 2 / 3, rel=within)


@pytest.mark.parametrize("pixels", [0.3, 2.4, 11.0])
@pytest.mark.parametrize("sprite", [name for name in SPRITES if name != "texture"])
def test_points_and_polygons_show_the_same(make_stage: MakeStage, monkeypatch: pytest.MonkeyPatch, sprite: str,
                                           pixels: float) -> None:
    """All three ways to draw a sprite, at places over the border of the picture too."""
    motes = Motes(make_stage, sprite=sprite, blending="alpha", lighting=0.5, spin=(-50, 50), softness=0.3)
    places = np.random.default_rng(5).uniform((-2.0, -2.0), np.add(SIZE, 2.0), (16, 2))
    motes.put([motes.at(tuple(place), 4.0) for place in places], 4.0 * pixels / motes.scale, age=1.0)
    seen = {}
    for shape in ("point", "triangle", "square"):
        monkeypatch.setattr(Sprites, "shape", shape)
        seen[shape] = motes.light()
    assert seen["point"][..., :3].max() > 0.001
    for shape in ("triangle", "square"):
        off = np.abs(seen[shape] - seen["point"]).max(axis=-1)
        assert (off > 0.01).mean() < 0.001 and off.mean() < 1e-4


def test_large_sprites_become_polygons(make_stage: MakeStage) -> None:
    """Beyond what the driver draws as a point; the light goes on growing."""
    motes = Motes(make_stage)
    assert motes.sprites.appearance.largest_point >= 64.0
    motes.sprites.appearance.largest_point = largest = 60.0
    for pixels, shape in ((0.9 * largest, "point"), (1.1 * largest, "square")):
        motes.put(motes.at((80, 48), 4.0), 4.0 * pixels / motes.scale)
        assert motes.light()[48, 80, 0] == pytest.approx(1.0, abs=0.01)
        assert motes.sprites.shape == shape


@pytest.mark.parametrize("sprite", ["spot", "ball"])
def test_the_nearer_hides_the_farther(make_stage: MakeStage, sprite: str) -> None:
    """In whichever slots they are; adding light, neither does."""
    motes = Motes(make_stage, sprite=sprite, blending="alpha", color="0:#ff0000, 1:#0000ff", lighting=0.0)
    for distances, ages in (((3.0, 5.0), (0.0, 10.0)), ((5.0, 3.0), (10.0, 0.0))):
        motes.put([motes.at((80.5, 48.5), away) for away in distances], 1.0, age=np.multiply(ages, 0.9999))
        red, green, blue, through = motes.light()[48, 80]
        assert red > 0.98 and blue < 0.02 and green == 0.0 and through < 0.02
    motes.stage.set(blending="additive")
    red, _, blue, through = motes.light()[48, 80]
    assert red > 0.98 and blue > 0.98 and through == 1.0


def test_hundreds_are_blended_in_the_right_order(make_stage: MakeStage) -> None:
    """As NumPy blends them, from back to front."""
    motes = Motes(make_stage, count=300, blending="alpha", opacity=0.5, color="0:#ff4000, 1:#0080ff")
    rng = np.random.default_rng(8)
    distances, over = rng.uniform(3.0, 7.0, 300), rng.random(300) * 0.999
    motes.put([motes.at((80.5, 48.5), away) for away in distances], distances * 30.0 / motes.scale, age=10.0 * over)
    light = np.zeros(3)
    for number in np.argsort(-distances):
        light = 0.5 * light + 0.5 * Gradient.parse("0:#ff4000, 1:#0080ff").linear(over[number])
    assert motes.light()[48, 80, :3] == pytest.approx(light, abs=0.01)


def test_colour_size_and_opacity_over_life(make_stage: MakeStage) -> None:
    """What the kit says of the gradient and the curves, at each age; children have a gradient of their own."""
    color, children, size, opacity = ("0:#ffffff, 0.4:#ff8800, 1:#300000", "0:#00ff80, 1:#2040c0",
                                      "0:0.2, 0.3:2, 1:0.5", "0:0.1, 0.5:1, 1:0.3")
    motes = Motes(make_stage, color=color, children_color=children, size_over_life=size, opacity_over_life=opacity,
                  opacity=0.6, glow=1.5)
    for over in (0.0, 0.07, 0.3, 0.42, 0.77, 0.99):
        for generation, gradient in enumerate((color, children)):
            motes.put(motes.at((80, 48), 4.0), 4.0 * 20.0 / motes.scale, age=10.0 * over, generation=generation)
            radius = 10.0 * LifeCurve.parse(size)(over)
            light = 0.6 * 1.5 * LifeCurve.parse(opacity)(over) * np.pi * radius**2 / 3
            expected = light * Gradient.parse(gradient).linear(over)
            assert motes.total() == pytest.approx(expected, rel=0.02, abs=0.02)


def test_chance_varies_hue_and_brightness(make_stage: MakeStage) -> None:
    """Brightness within its range; a turned hue keeps the sum of the channels."""
    motes = Motes(make_stage, brightness=(0.5, 1.5), color="#808080")
    levels = []
    for place in range(16):
        motes.put(np.repeat(motes.at((80, 48), 4.0)[None], 16, axis=0), np.where(np.arange(16) == place, 1.0, 0.0))
        levels.append(motes.light()[48, 80, 0])
    assert 0.5 * 0.2158 < min(levels) < 0.75 * 0.2158 and 1.2 * 0.2158 < max(levels) < 1.5 * 0.2158
    motes.stage.set(brightness=(1.0, 1.0), hue=(120.0, 120.0), color="#ff0000")
    assert motes.light()[48, 80, :3] == pytest.approx([0.0, 1.0, 0.0], abs=0.02)


@pytest.mark.parametrize("billboard", ["camera", "velocity"])
def test_sprites_fade_towards_what_is_solid(make_stage: MakeStage, billboard: str) -> None:
    """Linearly over the softness, at most over their diameter; behind it nothing is seen."""
    motes = Motes(make_stage, softness=0.4, billboard=billboard)
    vars(motes.stage.scene)["wall"] = 4.0
    for diameter, before, expected in ((1.0, 0.5, 1.0), (1.0, 0.3, 0.75), (1.0, 0.1, 0.25), (1.0, 0.0, 0.0),
                                       (1.0, -0.1, 0.0), (0.2, 0.15, 0.75), (0.2, 0.3, 1.0)):
        motes.put(motes.at((80.5, 48.5), 4.0 - before), diameter)
        assert motes.light()[48, 80, 0] == pytest.approx(expected, abs=0.01)
    motes.stage.set(softness=0.0)
    for before, seen in ((0.001, True), (-0.001, False)):
        motes.put(motes.at((80.5, 48.5), 4.0 - before), 1.0)
        assert (motes.total()[0] > 1.0) == seen


@pytest.mark.parametrize("pixels", [0.5, 4.0])
def test_small_sprites_fade_as_one(make_stage: MakeStage, pixels: float) -> None:
    """By as much; what is far behind is left to the depth test, pixel by pixel."""
    motes = Motes(make_stage, softness=0.4, glow=50.0)
    size = 4.0 * pixels / motes.scale
    totals = []
    for before in (2.0, 0.5, 0.25, 0.0, -0.5, -2.0):
        motes.put(motes.at((80.5, 48.5), 4.0 - before * size), size)
        vars(motes.stage.scene)["wall"] = None
        whole = motes.total()[0]
        vars(motes.stage.scene)["wall"] = 4.0
        totals.append(motes.total()[0] / whole)
    assert totals == pytest.approx([1.0, 0.5, 0.25, 0.0, 0.0, 0.0], abs=0.02)


def test_nobody_explodes_at_the_eye_or_behind_it(make_stage: MakeStage) -> None:
    """Through the near plane, behind the eye, of any size: numbers stay finite; what surrounds the eye is not seen."""
    motes = Motes(make_stage, softness=0.1, lighting=1.0)
    eye = motes.stage.camera.eye
    ahead = -eye / np.linalg.norm(eye)
    for billboard in ("camera", "velocity", "tumble"):
        motes.stage.set(billboard=billboard)
        for along in (-3.0, -1e-3, 0.0, 1e-6, 0.02, 0.1, 1.0):
            for size in (1e-4, 0.1, 20.0):
                motes.put(eye + along * ahead, size, velocity=30.0 * ahead, age=1.0)
                total = motes.total()
                assert (total > 0.0).all() or along < 1.0 or size > along
                assert along > 0.5 * size or (total == 0.0).all()


@pytest.mark.parametrize("velocity", [(6.0, 0.0, 0.0), (0.0, 5.0, 0.0), (3.0, -4.0, 2.0), (0.0, 0.0, 0.0)])
def test_stretched_along_the_way(make_stage: MakeStage, velocity: tuple[float, float, float]) -> None:
    """From where it was to where it is, seen in the picture: the light's second moments tell."""
    motes = Motes(make_stage, billboard="velocity", stretch=0.05)
    place = motes.at((80.0, 48.0), 4.0)
    motes.put(place, 0.1, velocity=velocity, age=1.0)
    light = motes.light()[..., 0]
    up, across = np.mgrid[0:SIZE[1], 0:SIZE[0]] + 0.5
    middle = np.array([(across * light).sum(), (up * light).sum()]) / light.sum()
    both = motes.stage.camera.view() @ motes.stage.camera.projection(SIZE[0] / SIZE[1])
    ends = np.array([[*place, 1.0], [*(place - 0.05 * np.array(velocity)), 1.0]]) @ both
    pixels = (0.5 * ends[:, :2] / ends[:, 3:] + 0.5) * SIZE
    assert middle == pytest.approx(pixels.mean(axis=0), abs=0.1)
    offsets = np.stack([across - middle[0], up - middle[1]])
    spread, ways = np.linalg.eigh(np.einsum("ihw,jhw,hw->ij", offsets, offsets, light) / light.sum())
    half_way = 0.5 * np.linalg.norm(pixels[0] - pixels[1])
    radius = 0.05 * motes.scale / 4.0
    assert np.sqrt(spread[1] / spread[0]) == pytest.approx((half_way + radius) / radius, rel=0.08)
    if half_way:
        along = (pixels[0] - pixels[1]) / (2.0 * half_way)
        assert abs(along @ ways[:, 1]) > 0.995


def test_the_newborn_has_come_no_way_yet(make_stage: MakeStage) -> None:
    """Its streak does not begin before it was born."""
    motes = Motes(make_stage, billboard="velocity", stretch=0.5)
    totals = []
    for age in (0.0, 0.05, 0.1):
        motes.put(motes.at((80, 48), 4.0), 0.1, velocity=(3.0, 0.0, 0.0), age=age)
        totals.append(motes.total()[0])
    assert totals[0] == pytest.approx(np.pi * (0.05 * motes.scale / 4) ** 2 / 3, rel=0.06)
    assert totals[0] < 0.6 * totals[1] < 0.6 * totals[2]


def test_what_tumbles_lies_any_way(make_stage: MakeStage) -> None:
    """A disc whose normal points anywhere shows half its area on the mean (Archimedes: its height is uniform)."""
    motes = Motes(make_stage, count=400, billboard="tumble", spin=(90.0, 90.0))
    places = np.random.default_rng(1).uniform((10.0, 10.0), np.subtract(SIZE, 10.0), (400, 2))
    around = [motes.at(tuple(place), 4.0) for place in places]
    whole = 400 * np.pi * 7.0**2 / 3
    pictures = []
    for age in (0.0, 1.0, 4.0):
        motes.put(around, 4.0 * 14.0 / motes.scale, age=age)
        pictures.append(motes.light())
        assert pictures[-1][..., 0].sum() / whole == pytest.approx(0.5, abs=0.05)
    assert np.abs(pictures[1] - pictures[0]).max() > 0.3
    assert np.abs(pictures[2] - pictures[0]).max() < 0.02      # once round


def test_what_is_stuck_lies_flat_and_still(make_stage: MakeStage) -> None:
    """Seen from above in full, from aside hardly."""
    motes = Motes(make_stage, billboard="tumble", spin=(90.0, 90.0))
    for pitch, low, high in ((89.0, 0.97, 1.08), (0.0, 0.0, 0.2)):
        motes.stage.camera.stand(Orbit(0, pitch, 4))
        shares = []
        for age in (0.0, 1.0):
            motes.put(motes.at((80.0, 48.0), 4.0), 4.0 * 30.0 / motes.scale, age=age, stuck=True)
            shares.append(motes.total()[0] / (np.pi * 15.0**2 / 3))
        assert low <= shares[0] <= high and shares[0] == pytest.approx(shares[1])


def test_the_dead_draw_nothing(make_stage: MakeStage) -> None:
    """Nor does a pool in which nobody has ever lived."""
    motes = Motes(make_stage)
    assert motes.total().max() == 0.0
    places = [motes.at((20.0 + 8.0 * number, 48.0), 4.0) for number in range(16)]
    motes.put(places, 0.1, age=np.where(np.arange(16) % 3, 10.0, 1.0))
    lit = motes.light()[48, 20:160:8, 0][:16] > 0.1
    assert lit.tolist() == [number % 3 == 0 for number in range(16)]
    assert motes.sprites.appearance.slots.tolist() == [0, 3, 6, 9, 12, 15]


def test_overdraw_counts_the_sprites_on_each_pixel(make_stage: MakeStage) -> None:
    """All pixels whose middles lie in the squares, less what is hidden; and the colours say so."""
    motes = Motes(make_stage, overdraw=True, overdraw_most=4)
    places = np.array([[40.2, 30.3], [47.1, 33.6], [52.4, 30.2], [100.0, 60.0], [120.5, 40.5]])
    sides = np.array([20.0, 11.0, 6.0, 1.0, 30.0])
    distances = np.array([4.0, 3.9, 4.1, 4.0, 4.6])
    motes.put([motes.at(tuple(place), away) for place, away in zip(places, distances, strict=True)],
              sides * distances / motes.scale)
    vars(motes.stage.scene)["wall"] = 4.5
    light = motes.light()
    up, across = np.mgrid[0:SIZE[1], 0:SIZE[0]] + 0.5
    expected = np.zeros(SIZE[::-1], int)
    for (x, y), side in zip(places[:4], np.maximum(sides[:4], 2.0), strict=True):
        expected += (abs(across - x) < side / 2) & (abs(up - y) < side / 2)
    for outlines in (False, True):
        motes.stage.set(outlines=outlines)
        light = motes.light()
        assert np.array_equal(motes.sprites.overdraw.counts(), expected)
    assert np.array_equal(light[..., 3] == 0.0, expected > 0) and expected.max() == 3
    scale = motes.stage.color_scale()
    assert scale is not None and (scale.low, scale.high) == (0.0, 4.0)


def test_colours_tell_of_qualities(make_stage: MakeStage) -> None:
    """The nearest in its own colour, dark for little and bright for much; what they add up to would mean nothing."""
    motes = Motes(make_stage, glow=5.0, lighting=1.0, mass=(1.0, 3.0), size=(0.5, 1.0), colouring_scale=10.0,
                  children_when="never")
    dark, bright = (np.asarray(Gradient.parse(code).linear(0.0)) for code in ("#440154", "#fde725"))
    for colouring, little, much in (("age", {"age": 0.0}, {"age": 9.999}), ("mass", {"mass": 1.0}, {"mass": 3.0}),
                                    ("speed", {"velocity": (0, 0, 0)}, {"velocity": (0, 10, 0)}),
                                    ("size", {"size": 0.5}, {"size": 1.0})):
        motes.stage.set(colouring=colouring)
        for quality, expected in ((little, dark), (much, bright)):
            values: dict[str, Any] = {"size": 1.0, **quality}
            motes.put([motes.at((80.5, 48.5), 4.0)] * 2, **values)
            assert motes.light()[48, 80, :3] == pytest.approx(expected, abs=0.02)
        scale = motes.stage.color_scale()
        assert scale is not None and scale.high > scale.low
    motes.stage.set(colouring="generation")
    motes.put(motes.at((80.5, 48.5), 4.0), 1.0, generation=1)
    assert motes.light()[48, 80, :3] == pytest.approx(np.asarray(Gradient.parse("#56b4e9").linear(0.0)), abs=0.02)
    assert motes.stage.color_scale() is None


@pytest.mark.parametrize("colouring", ["mass", "size"])
def test_one_value_for_all_has_the_middle_of_the_scale(make_stage: MakeStage, colouring: str) -> None:
    motes = Motes(make_stage, mass=(2.0, 2.0), size=(2.0, 2.0), colouring=colouring, children_when="never")
    scale = motes.stage.color_scale()
    assert scale is not None and (scale.low, scale.high) == (0.0, 4.0)


def test_the_key_of_generations_names_those_that_there_are() -> None:
    """In the colours of the picture, and only where these tell generations."""
    class Both(CascadeParameters, LookParameters):
        pass

    params = Both({"colouring": "generation", "children_when": "life", "grandchildren_when": "death",
                   "great_grandchildren_when": "never"})
    words, *squares = generation_key(params)
    assert words.text.split() == ["from", "the", "emitter", "child", "grandchild"]
    assert [square.color for square in squares] == ["#e69f00", "#56b4e9", "#009e73"]
    assert [square.text.split("\n").index("■") for square in squares] == [0, 1, 2]
    params.update({"great_grandchildren_when": "death"})
    assert "great-grandchild" in generation_key(params)[0].text
    params.update({"children_when": "never"})
    assert generation_key(params)[0].text.strip() == "from the emitter"
    for change in ({"overdraw": True}, {"overdraw": False, "colouring": "age"}):
        params.update(change)
        assert generation_key(params) == ()


def test_a_picture_can_be_named_before_it_is_chosen(make_stage: MakeStage, tmp_path: Path) -> None:
    """A window greys what has no effect; a picture needs its file before it can have one."""
    motes = Motes(make_stage)
    assert motes.stage.params.is_active("texture")
    motes.stage.set(texture=picture(tmp_path))
    motes.stage.set(sprite="texture")


def test_outlines_show_the_polygons(make_stage: MakeStage) -> None:
    """A frame one pixel wide around a square, whose corners the spot leaves dark."""
    motes = Motes(make_stage)
    motes.put(motes.at((80.0, 48.0), 4.0), 4.0 * 20.0 / motes.scale)
    assert motes.light()[38, 70, :3].max() == 0.0
    motes.stage.set(outlines=True)
    light = motes.light()
    assert (light[38, 70:90, 2] > 0.3).all() and (light[38:58, 89, 2] > 0.3).all()
    assert light[36, :, :3].max() == 0.0 and light[40, 72, :3].max() < 0.01


def test_particles_shade_the_ground(make_stage: MakeStage) -> None:
    """As much as they are opaque, and not where shadows are off."""
    source = SCENE.replace("ground=None", "ground=-1.0").replace('"#000000", "#000000"', '"#c9ced6", "#7f8b9c"')
    motes = Motes(make_stage, source=source, shadows=True, opacity=1.0)
    motes.stage.camera.stand(Orbit(0, 60, 6))
    pictures = {}
    for opacity, shadows in ((1.0, True), (0.3, True), (1.0, False), (0.3, False)):
        motes.stage.set(opacity=opacity, shadows=shadows)
        motes.put((0.0, 0.0, 0.0), 1.0)
        pictures[opacity, shadows] = motes.stage.pixels()[..., 1].astype(float)
    strong, weak = ((pictures[opacity, False] - pictures[opacity, True]).max() for opacity in (1.0, 0.3))
    assert strong > 30.0 and 5.0 < weak < 0.75 * strong


@pytest.mark.parametrize("sprite", ["spot", "ball", "puff"])
def test_what_is_lit_lies_in_the_shadow_of_others(make_stage: MakeStage, sprite: str) -> None:
    """A lit particle is darker behind another, as the key light sees it; one with its own light is not."""
    motes = Motes(make_stage, sprite=sprite, shadows=True, lighting=1.0, blending="alpha")
    key = np.array([-0.45, 0.80, 0.40]) / np.linalg.norm([-0.45, 0.80, 0.40])
    seen = []
    for offset in (np.array([3.0, 0.0, 0.0]), key):
        motes.put([np.zeros(3), *(offset + 1e-3 * np.arange(8)[:, None])], [0.5, *[0.8] * 8])
        seen.append(motes.light()[48, 80, :3].max())
    assert seen[1] < 0.75 * seen[0]


def test_clouds_have_no_seam() -> None:
    """From one edge of the noise to the other it steps no more than elsewhere."""
    billows = puff_noise()
    for axis in (0, 1):
        inside = np.abs(np.diff(billows, axis=axis)).max(axis=(0, 1))
        across = np.abs(np.take(billows, 0, axis) - np.take(billows, -1, axis)).max(axis=0)
        assert (across <= inside).all()
    assert billows.min(axis=(0, 1))[[0, 3]].min() >= 0.0 and billows.max(axis=(0, 1))[[0, 3]].max() <= 1.0


def picture(folder: Path, size: tuple[int, int] = (6, 6), name: str = "picture.png") -> Path:
    """A file that is red in its upper and green, half transparent, in its lower half."""
    pixels = np.zeros((size[1], size[0], 4), np.uint8)
    pixels[:size[1] // 2], pixels[size[1] // 2:] = (255, 0, 0, 255), (0, 255, 0, 128)
    Image.fromarray(pixels).save(folder / name)
    return folder / name


def test_a_picture_from_a_file(make_stage: MakeStage, tmp_path: Path) -> None:
    """Upright, its alpha straight; small ones have all their light too."""
    motes = Motes(make_stage, sprite="texture", texture=picture(tmp_path), blending="alpha")
    motes.put(motes.at((80.0, 48.0), 4.0), 4.0 * 40.0 / motes.scale)
    light = motes.light()
    assert light[58, 80] == pytest.approx([1.0, 0.0, 0.0, 0.0], abs=0.01)
    assert light[38, 80] == pytest.approx([0.0, 0.5, 0.0, 0.5], abs=0.01)
    motes.stage.set(blending="additive", glow=10.0)
    for pixels in (0.5, 1.5, 40.0):
        motes.put(motes.at((80.0, 48.0), 4.0), 4.0 * pixels / motes.scale)
        assert motes.total() == pytest.approx(10.0 * pixels**2 * np.array([0.5, 0.25, 0.0]), rel=0.05, abs=0.01)


def test_a_wide_picture_keeps_its_shape(make_stage: MakeStage, tmp_path: Path) -> None:
    """In the middle of the square, nothing above and below."""
    motes = Motes(make_stage, sprite="texture", texture=picture(tmp_path, (400, 100)), blending="alpha")
    motes.put(motes.at((80.0, 48.0), 4.0), 4.0 * 40.0 / motes.scale)
    through = motes.light()[..., 3]
    assert through[50, 80] == pytest.approx(0.0, abs=0.02) and through[60, 80] == through[36, 80] == 1.0
    assert (through[48, 61:99] < 0.6).all()


def test_pictures_that_are_none_are_refused(make_stage: MakeStage, tmp_path: Path) -> None:
    """In one line each, and the last good picture stays."""
    motes = Motes(make_stage)
    motes.put(motes.at((80.0, 48.0), 4.0), 1.0)
    with pytest.raises(ParameterError, match=r"^sprite = texture needs a picture: set texture$"):
        motes.stage.set(sprite="texture")
    motes.stage.set(sprite="texture", texture=picture(tmp_path))
    before = motes.light()
    (tmp_path / "broken.png").write_bytes(picture(tmp_path).read_bytes()[:60])
    (tmp_path / "words.jpg").write_text("not a picture")
    Image.new("L", (5000, 2)).save(tmp_path / "huge.png")
    for name, why in (("missing.png", "is not a file that exists"), ("broken.png", "is not a picture"),
                      ("words.jpg", "is not a picture"), ("huge.png", "5000 x 2 pixels, which is more than 4096")):
        with pytest.raises(ParameterError, match=rf"texture = .*{name} {'.*' if 'huge' in name else ''}{why}") as error:
            motes.stage.set(texture=tmp_path / name)
        assert "\n" not in str(error.value)
        assert np.array_equal(motes.light(), before)


def test_nothing_is_made_for_each_frame(make_stage: MakeStage) -> None:
    """However often it is drawn, and whichever way the particles go."""
    motes = Motes(make_stage, blending="alpha")
    rng = np.random.default_rng(2)
    owned = None
    for _ in range(4):
        motes.put([motes.at(tuple(place), 4.0) for place in rng.uniform((0, 0), SIZE, (16, 2))], 0.2)
        motes.light()
        now = len(motes.stage.scene.gpu._owned), len(motes.stage.scene.gpu.programs)
        assert owned in (None, now)
        owned = now


@pytest.mark.parametrize(("size", "why"), [((10000, 10000), "is 10000 x 10000 pixels, which is more than 4096 along"),
                                           ((20000, 10000), "has more than 4096 pixels along a side")])
def test_a_picture_of_very_many_pixels_is_refused_without_reading_them(
        tmp_path: Path, size: tuple[int, int], why: str, recwarn: pytest.WarningsRecorder) -> None:
    """Its header says enough; Pillow's own warning would be a second line."""
    def chunk(kind: bytes, body: bytes) -> bytes:
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    header = struct.pack(">IIBBBBB", *size, 8, 2, 0, 0, 0)
    body = chunk(b"IHDR", header) + chunk(b"IDAT", b"")
    (tmp_path / "vast.png").write_bytes(b"\x89PNG\r\n\x1a\n" + body + chunk(b"IEND", b""))
    with pytest.raises(ParameterError, match=rf"^texture = .*vast\.png {why}[^\n]*$"):
        image_texels(tmp_path / "vast.png")
    assert not recwarn.list


def test_an_edited_picture_is_read_again(make_stage: MakeStage, tmp_path: Path) -> None:
    motes = Motes(make_stage, sprite="texture", texture=picture(tmp_path), blending="alpha")
    motes.put(motes.at((80.0, 48.0), 4.0), 4.0 * 40.0 / motes.scale)
    assert motes.light()[58, 80, 0] == pytest.approx(1.0, abs=0.01)
    Image.new("RGB", (9, 9), (0, 0, 255)).save(tmp_path / "picture.png")
    assert motes.light()[58, 80] == pytest.approx([0.0, 0.0, 1.0, 0.0], abs=0.01)
