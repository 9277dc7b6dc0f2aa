"""How particles look: what an artist sets, and what a class may ask the picture to tell instead."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from viewer.engine.annotations import Label
from viewer.engine.declarations import choice, curve, file, gradient, integer, slider, toggle
from viewer.engine.params import Parameters
from viewer.engine.particles.cascade import FAMILIES, moments
from viewer.engine.scene import ColorScale
from viewer.kit.gradient import Gradient
from viewer.kit.life_curve import LifeCurve

LOOK, TEACHING = "Look", "Teaching"
BILLBOARDS = {
    "camera": "A square that faces the camera", "velocity": "Stretched along the way that it moves",
    "tumble": "It turns freely in space, as a leaf does, as fast as its spin says"}
SPRITES = {
    "spot": "A fuzzy spot", "ball": "A little ball", "puff": "A puff of cloud, each a different one",
    "flake": "A snow crystal of six arms, each a different one", "leaf": "A leaf",
    "star": "A star with the rays that a lens draws", "ring": "A bubble", "texture": "A picture from a file"}
BLENDINGS = {
    "additive": "Light adds up, as of fire and spray: nothing is hidden",
    "alpha": "It hides what lies behind, as smoke does: drawn from back to front"}
COLOURINGS = {
    "look": "Its own colour", "age": "How much of its life is over",
    "generation": "Whether it is a child, a grandchild ...", "speed": "How fast it moves",
    "mass": "Its mass", "size": "Its diameter"}
SUFFIXES = (".png", ".jpg", ".jpeg", ".webp")
GENERATIONS = (         # as they are called, and their colours: those of shaders/lib/color.glsl, okabe_ito 1 to 4
    ("from the emitter", "#e69f00"), ("child", "#56b4e9"), ("grandchild", "#009e73"),
    ("great-grandchild", "#f0e442"))
PLATE = "#10141ad0"
GRADIENTS = ("color", *(f"{family}_color" for family in FAMILIES))


class LookParameters(Parameters):
    """Shape, colour and light of the sprites. The defaults are those of luminous water in the dark."""

    billboard: str = choice("velocity", BILLBOARDS, "How the polygon of a sprite lies in space", group=LOOK)
    stretch: float = slider(0.03, 0.0, 1.0, "It is as long as its way in so many seconds", unit="s", group=LOOK,
                            handy=(0.0, 0.2), when="billboard=velocity")
    sprite: str = choice("spot", SPRITES, "What is drawn on the polygon", group=LOOK)
    texture = file(None, "A picture for each polygon, without what its alpha leaves out: name it, then choose "
                   "sprite = texture", suffixes=SUFFIXES, rebuild=False, group=LOOK)
    blending: str = choice("additive", BLENDINGS, "How sprites and what lies behind come together", group=LOOK)
    color: Gradient = gradient("0:#f4fbff, 0.35:#bfe4ff, 0.75:#7fbcf5, 1:#4d86d6",
                               "Colour over the life of those from the emitter", group=LOOK)
    size_over_life: LifeCurve = curve("0:0.7, 0.15:1, 1:1.15", 0.0, 4.0, "Size over life, times the diameter",
                                      group=LOOK)
    opacity_over_life: LifeCurve = curve("0:0.8, 0.08:1, 0.7:0.85, 1:0", 0.0, 1.0, "Opacity over life", group=LOOK)
    opacity: float = slider(0.3, 0.0, 1.0, "Opacity, of all alike", group=LOOK)
    glow: float = slider(1.0, 0.01, 100.0, "How many times as bright", logarithmic=True, group=LOOK)
    lighting: float = slider(0.0, 0.0, 1.0, "From its own light, 0, to that of the studio with its shadows, 1",
                             group=LOOK)
    softness: float = slider(0.05, 0.0, 10.0, "Sprites fade over this length towards what is solid, at most over "
                             "their diameter, and towards the eye", unit="m", group=LOOK, handy=(0.0, 1.0))
    shadows: bool = toggle(True, "Particles shade the ground and each other", group=LOOK)
    colouring: str = choice("look", COLOURINGS, "What the colour tells", group=TEACHING)
    colouring_scale: float = slider(8.0, 0.001, 1000.0, "Speed at the bright end of the scale", unit="m/s",
                                    logarithmic=True, group=TEACHING, when="colouring=speed")
    outlines: bool = toggle(False, "Show the edges of the polygons", group=TEACHING)
    overdraw: bool = toggle(False, "Show how many sprites are drawn over each pixel", group=TEACHING)
    overdraw_most: int = integer(16, 1, 2048, "Sprites on a pixel at the bright end of the scale", logarithmic=True,
                                 group=TEACHING, when="overdraw")


def is_sorted(params: Any) -> bool:
    """Whether who is in front hides who is behind; colours that mean a number must not add up."""
    return bool((params.blending == "alpha" or params.colouring != "look") and not params.overdraw)


def turns(params: Any) -> bool:
    """Whether the picture on a sprite is turned about its middle."""
    return params.sprite in ("puff", "flake", "leaf") or any(params.spin)


def colouring_range(params: Any) -> tuple[float, float]:
    """What the dark and the bright end of the colour map stand for."""
    if params.colouring == "speed":
        return 0.0, params.colouring_scale
    if params.colouring == "mass":
        low, high = params.mass
    elif params.colouring == "size":
        families = zip(FAMILIES, moments(params), strict=True)
        born = [params.size, *(params.get(f"{family}_size") for family, when in families if when != "never")]
        low, high = min(size[0] for size in born), max(size[1] for size in born)
    else:
        return 0.0, 1.0
    return (low, high) if low < high else (0.0, 2.0 * high)


def color_scale(params: Any) -> ColorScale | None:
    """What the colours of the picture now stand for, if for a number."""
    if params.overdraw:
        return ColorScale("Sprites on a pixel", 0.0, float(params.overdraw_most))
    if params.colouring in ("look", "generation"):
        return None
    title, unit = {"age": ("Age in lifetimes", ""), "speed": ("Speed", "m/s"), "mass": ("Mass", "kg"),
                   "size": ("Diameter", "m")}[params.colouring]
    return ColorScale(title, *colouring_range(params), unit)


def generation_key(params: Any) -> tuple[Label, ...]:
    """Which colour means which generation, in the corner where a colour scale would be; nothing else has one."""
    if params.colouring != "generation" or params.overdraw:
        return ()
    there = GENERATIONS[:1 + sum(when != "never" for when in moments(params))]

    def written(lines: list[str], color: str, plate: str = "") -> Label:
        return Label("\n".join(lines), (-0.96, -0.94), size=0.85, color=color, align=(0.0, 0.0), plate=plate)

    squares = [written(["■" if other == name else "" for other, _ in there], color) for name, color in there]
    return written([f"      {name}" for name, _ in there], "#f2f4f7", PLATE), *squares


def look_constants(params: Any) -> str:
    """The include ``generated/look.glsl``: what is not asked for is not even compiled."""
    plain = params.colouring == "look"
    numbers = {"BILLBOARD": list(BILLBOARDS).index(params.billboard), "SPRITE": list(SPRITES).index(params.sprite),
               "COLOURING": list(COLOURINGS).index(params.colouring)}
    flags = {"HIDES": is_sorted(params), "SOFT": params.softness > 0.0, "LIT": plain and params.lighting > 0.0,
             "TURNS": turns(params), "SPINS": any(params.spin), "OUTLINED": params.outlines,
             "COUNTED": params.overdraw}
    return constants(numbers) + constants(flags)


def constants(values: Mapping[str, int | bool]) -> str:
    """GLSL that names them."""
    kinds = {name: "bool" if isinstance(value, bool) else "int" for name, value in values.items()}
    return "".join(f"const {kinds[name]} {name} = {str(value).lower()};\n" for name, value in values.items())
