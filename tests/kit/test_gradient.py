"""Gradients: light mixed as light, and what is refused in which words."""

from __future__ import annotations

import numpy as np
import pytest

from viewer.kit.gradient import MOST_STOPS, Gradient
from viewer.kit.life_points import LifeError
from viewer.kit.srgb import code_of, color_of, encoded, linear_light


def light(level: int) -> float:
    """An eight-bit sRGB level as linear light, from the standard's own text."""
    share = level / 255
    return share / 12.92 if share <= 0.04045 else float(((share + 0.055) / 1.055) ** 2.4)


def test_light_is_interpolated_and_not_its_code() -> None:
    middle = Gradient.parse("0:#000000, 1:#ffffff").linear(0.5)
    assert np.allclose(middle, 0.5, atol=1e-15)
    assert code_of(encoded(middle)) == "#bcbcbc"    # half the light, far above half the code


def test_it_agrees_with_a_plain_loop_over_its_stops() -> None:
    random = np.random.default_rng(3)
    for _ in range(40):
        places = np.sort(random.choice(1001, random.integers(2, MOST_STOPS + 1), replace=False)) / 1000
        levels = random.integers(0, 256, (len(places), 3))
        stops = [(place, f"#{red:02x}{green:02x}{blue:02x}") for place, (red, green, blue)
                 in zip(places.tolist(), levels.tolist(), strict=True)]
        gradient = Gradient.parse(stops)
        for x in random.random(20):
            after = min(int(np.sum(places <= x)), len(places) - 1)
            before = max(0, after - 1)
            t = min(1.0, max(0.0, (x - places[before]) / max(1e-9, places[after] - places[before])))
            expected = [(1 - t) * light(low) + t * light(high) for low, high
                        in zip(levels[before].tolist(), levels[after].tolist(), strict=True)]
            assert np.allclose(gradient.linear(x), expected, atol=1e-14)


def test_shapes_tables_and_constants() -> None:
    gradient = Gradient.parse("0.2:#ff0000, 0.6:#0000ff")
    assert gradient.linear(np.zeros((4, 5))).shape == (4, 5, 3)
    table = gradient.table(6)
    assert (table.shape, table.dtype) == ((6, 3), np.float32)
    assert np.allclose(table, [(1, 0, 0), (1, 0, 0), (0.5, 0, 0.5), (0, 0, 1), (0, 0, 1), (0, 0, 1)], atol=1e-7)
    assert np.allclose(Gradient.parse("#ff8800").table(3), [[1.0, light(0x88), 0.0]] * 3, atol=1e-7)


def test_codes_and_light_are_each_others_inverse() -> None:
    levels = np.arange(256) / 255
    lights = np.array([linear_light(level) for level in levels])
    assert np.allclose(lights, [light(level) for level in range(256)], atol=1e-15)
    assert np.allclose(encoded(lights), levels, atol=1e-7)
    assert all(code_of(color_of(code)) == code for code in ("#000000", "#0a7f80", "#ffffff"))


@pytest.mark.parametrize("text", ["#ff8800", "0.4:#ff8800", "0:#ffffff, 0.4:#ff8800, 1:#300000"])
def test_the_text_reads_back(text: str) -> None:
    assert str(Gradient.parse(text)) == text
    assert Gradient.parse(str(Gradient.parse(text))) == Gradient.parse(text)


def test_every_spelling_means_the_same_hashable_gradient() -> None:
    one = Gradient.parse("0:#000000, 1:#ff0080")
    others = [" 0 : #000000 ,1:#FF0080", [(0, "#000000"), (1, (1, 0, 0.502))], [[0, [0, 0, 0]], [1, "#ff0080"]], one,
              Gradient(((0.0, (0.0, 0.0, 0.0)), (1.0, (1.0, 0.0, 128 / 255))))]
    assert {Gradient.parse(other) for other in others} == {one}


@pytest.mark.parametrize(("value", "why"), [
    ("", "is empty; allowed: 1 to 12 such as 0:#ffffff, 0.4:#ff8800, 1:#300000"),
    ("red", "has the colour red, which is not written like #ff8800"),
    ("0:#ff880", "has the colour #ff880, which is not written like #ff8800"),
    ("0:#ff 8 8", "has the colour #ff 8 8, which is not written like #ff8800"),
    ("0:#gg0000", "has the colour #gg0000, which is not written like #ff8800"),
    ("0:", "has the colour nothing, which is not written like #ff8800"),
    ("#ffffff, #000000", "has the position #ffffff, which is not a number; "
                         "write it like 0:#ffffff, 0.4:#ff8800, 1:#300000"),
    ([(0, (1.5, 0, 0))], "has the colour (1.5, 0, 0), which is not written like #ff8800"),
    ([(0, (float("nan"), 0, 0))], "has the colour (nan, 0, 0), which is not written like #ff8800"),
    ([(0, (0, 0))], "has the colour (0, 0), which is not written like #ff8800"),
    ([(0, 7)], "has the colour 7, which is not written like #ff8800"),
    ("1.2:#ffffff", "has the position 1.2, which is outside 0 to 1"),
    ("0.5:#ffffff, 0.5:#000000", "has the position 0.5 after 0.5; each lies at least 1e-06 beyond the one before"),
    ([(x / 12, "#ffffff") for x in range(13)], "has 13 entries; at most 12 are allowed"),
    (3, "is not a list such as 0:#ffffff, 0.4:#ff8800, 1:#300000"),
])
def test_what_is_no_gradient_is_refused_in_one_line(value: object, why: str) -> None:
    with pytest.raises(LifeError) as caught:
        Gradient.parse(value)
    assert caught.value.why == why
    assert str(caught.value).startswith("gradient ")
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 200
