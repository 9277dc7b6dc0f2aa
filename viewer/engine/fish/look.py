"""How fish look: what an artist sets of their skin, what the colours may tell instead, and what shaders get to know."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from viewer.engine.color_field import Color, linear_light
from viewer.engine.declarations import choice, color, integer, slider, toggle
from viewer.engine.params import Parameters
from viewer.kit.fish import SPECIES, fish, fish_pieces
from viewer.kit.fish_body import body_surface
from viewer.kit.fish_pieces import Piece
from viewer.kit.fish_species import Part, Species

SKIN, TEACHING = "Skin", "Teaching"
COLOURINGS = {
    "skin": "Its own skin", "normals": "The normal's x, y, z as red, green, blue",
    "parts": "Body, fins and eyes, each in a colour", "weights": "Which joints a fin follows, and how much",
    "swing": "How far each vertex swings in a beat"}
DETAILS = {
    "by_size": "As fine as its size in the picture is worth", "far": "About 100 vertices", "small": "About 800",
    "middling": "About 5,000", "fine": "About 20,000", "finest": "About 60,000"}
SMALLEST_GIRTH = 0.3    # of the largest: towards nose and tail scales become no smaller than that


class FishLookParameters(Parameters):
    """Which fish it is, its skin, and what its colours tell."""

    species: str = choice("clownfish", {
        "clownfish": "Orange with white bars", "tuna": "A silver sprinter with yellow finlets",
        "koi": "White with clouds of red and black", "eel": "A moray in a net of pale lines"},
        "Which fish; in a mixed school there are all", rebuild=True, group=SKIN)
    detail: str = choice("by_size", DETAILS, "How finely the fish is cut into triangles; many are never finer than a "
                         "picture can bear", group=SKIN)
    mixed: bool = toggle(False, "A school of all four species; alone, a fish is of one", rebuild=True, group=SKIN)
    pattern_seed: int = integer(0, 0, 999, "Another fish of the same kind", group=SKIN)
    scale_size: float = slider(1.0, 0.4, 3.0, "How large scales are, times the species' own", group=SKIN)
    iridescence: float = slider(0.6, 0.0, 1.0, "How much thin layers in the skin colour what it mirrors", group=SKIN)
    recolour: bool = toggle(False, "Colours of your own instead of the species'", group=SKIN)
    ground_color: tuple[float, float, float] = color("#3f8fd0", "What the pattern lies on", group=SKIN, when="recolour")
    pattern_color: tuple[float, float, float] = color("#f4efe0", "Bars, clouds, patches or finlets", group=SKIN,
                                                      when="recolour")
    colouring: str = choice("skin", COLOURINGS, "What the colours show", group=TEACHING)
    show_midline: bool = toggle(False, "The middle line now and earlier, and how far it swings, drawn over the fish",
                                group=TEACHING)
    show_normals: bool = toggle(False, "Needles along the normals: green exact, orange as if the body only turned",
                                group=TEACHING)
    needles: int = integer(900, 50, 20000, "How many needles", logarithmic=True, rebuild=True, group=TEACHING,
                           when="show_normals")
    needle_length: float = slider(0.06, 0.01, 0.3, "Length of the needles", unit="body lengths", group=TEACHING,
                                  when="show_normals")


# The species' own colours, ground and pattern, and how many scales go around their bodies.
COATS: Mapping[str, tuple[str, str, int]] = {
    "clownfish": ("#ff7d12", "#f4f4ef", 58), "tuna": ("#0f2746", "#f2d03a", 120),
    "koi": ("#f7f2e8", "#e0481f", 44), "eel": ("#d9c58a", "#3a2c1c", 60)}


def skin_uniforms(params: Any, species: str) -> dict[str, Any]:
    """The uniforms that follow from the parameters and the species."""
    ground, pattern, around = COATS[species]
    colors = ((params.ground_color, params.pattern_color) if params.recolour
              else (Color(ground, "").default, Color(pattern, "").default))
    return {"u_ground_color": tuple(map(linear_light, colors[0])),
            "u_pattern_color": tuple(map(linear_light, colors[1])),
            "u_columns": max(4, round(around / params.scale_size)), "u_girth": float(girths(species)[1].max())}


def species_glsl(species: str) -> str:
    """The include ``generated/fish.glsl``: where on this species the face is, then its pattern."""
    kind = SPECIES[species]
    gill, mouth = kind.gill, kind.mouth
    return (f"const vec4 GILL = {_vector(gill.x, gill.y, gill.curl, gill.reach)};\n"
            f"const vec2 MOUTH_TIP = {_vector(*mouth.tip)}, MOUTH_CORNER = {_vector(*mouth.corner)};\n"
            f"const float MOUTH_GAPE = {float(mouth.gape)}, EYE_RADIUS = {float(kind.eye.radius)};\n"
            f"const vec2 EYE_PLACE = {_vector(kind.eye.x, kind.eye.y)};\n"
            f'#include "fish/{species}.glsl"\n')


def drawn_glsl(params: Any, fine: bool) -> str:
    """The include ``generated/drawn.glsl``: what is not asked for, and what is too far away, is not even compiled."""
    names = {part.name: part.value for part in Part} | {name.upper(): number for number, name in enumerate(COLOURINGS)}
    numbers = "".join(f"const int {name} = {number};\n" for name, number in names.items())
    return (f"{numbers}const int COLOURING = {params.colouring.upper()};\n"
            f"const bool FINE = {str(fine).lower()};\n")


def lattice(species: str, detail: int) -> NDArray[np.float32]:
    """For each vertex of ``fish(species, detail)``, (n, 2): girths from the nose, and its fin's rays or 0.

    Counted in girths, the length around the body, as many scales follow each other along as lie around.
    """
    mesh = fish(species, detail)
    x, girth = girths(species)
    girth = np.maximum(girth, SMALLEST_GIRTH * girth.max())
    between = 0.5 * (1.0 / girth[1:] + 1.0 / girth[:-1]) * -np.diff(x)
    passed = np.interp(-mesh.positions[:, 0], -x, np.concatenate([[0.0], np.cumsum(between)]))
    return np.stack([passed, rays(species, detail)], axis=1).astype(np.float32)


@lru_cache
def girths(species: str) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Places x from nose to tail (k,), and the length around the body there (k,), both in body lengths."""
    x = np.linspace(0.5, -0.5, 1001)
    height, width, _ = body_surface(SPECIES[species], relief=0.0).section(x)
    return x, np.asarray(np.pi * (height + width))


def rays(species: str, detail: int) -> NDArray[np.float32]:
    """How many rays the fin of each vertex has, (n,); 0 for body, barbels and eyes."""
    pieces = fish_pieces(species, detail)
    counts = [_rays_of(SPECIES[species], name, piece) for name, piece in pieces.items()]
    return np.repeat(np.array(counts, np.float32), [len(piece.positions) for piece in pieces.values()])


def _rays_of(kind: Species, name: str, piece: Piece) -> int:
    part, number = piece.parts[0], name.split()[-1]
    if part in (Part.BODY, Part.EYE):
        return 0
    return (kind.median_fins[int(number)] if number.isdigit()
            else next(fin for fin in kind.paired_fins if fin.part == part)).rays


def _vector(*numbers: float) -> str:
    return f"vec{len(numbers)}({', '.join(str(float(number)) for number in numbers)})"
