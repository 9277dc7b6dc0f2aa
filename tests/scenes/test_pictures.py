"""Every scene looks as it did when its picture was recorded, and says what it is.

    pytest tests/scenes/test_pictures.py --record

records the pictures anew, into ``tests/references/``; look at them before they are committed. A picture that
differs is written to ``tests/failures/`` with the reference and their difference beside it.
"""

from __future__ import annotations

from pathlib import Path

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

import viewer
from viewer.engine.catalog import Catalog, SceneEntry, builtin_pack

REFERENCES = Path(__file__).parents[1] / "references"
FAILURES = Path(__file__).parents[1] / "failures"
SIZE = (320, 180)
FRAME = 60
SCENES = [entry.name for entry in Catalog().entries() if entry.pack == builtin_pack()]
Pixels = NDArray[np.uint8]


def difference(one: Pixels, other: Pixels) -> NDArray[np.int_]:
    """The largest difference of any channel at each pixel."""
    return np.abs(one[..., :3].astype(int) - other[..., :3]).max(axis=2)


def same_to_the_pixel(one: Pixels, other: Pixels) -> bool:
    """For one software renderer: a channel may be off by one, and one pixel in 2000 by more."""
    return float((difference(one, other) > 1).mean()) <= 0.0005


def same_to_the_eye(one: Pixels, other: Pixels) -> bool:
    """For any renderer: alike once what an eye at some distance cannot tell apart has been averaged."""
    def seen(picture: Pixels) -> NDArray[np.float64]:
        rows, columns = (extent // 6 * 6 for extent in picture.shape[:2])
        blocks = picture[:rows, :columns, :3].reshape(rows // 6, 6, columns // 6, 6, 3)
        return np.asarray(blocks.mean(axis=(1, 3)))

    off = np.abs(seen(one) - seen(other)).max(axis=2)
    return bool(off.mean() < 1.0 and np.quantile(off, 0.99) < 6.0)


def save(name: str, pixels: Pixels) -> Path:
    FAILURES.mkdir(exist_ok=True)
    path = FAILURES / f"{name}.png"
    Image.fromarray(pixels).save(path)
    return path


@pytest.mark.parametrize("scene", SCENES)
def test_a_scene_looks_as_recorded(context: moderngl.Context, scene: str, request: pytest.FixtureRequest) -> None:
    """To the pixel on the renderer that recorded it, to the eye on others."""
    pixels = viewer.render(scene, FRAME, size=SIZE)
    reference = REFERENCES / f"{scene}.png"
    if request.config.getoption("--record"):
        REFERENCES.mkdir(exist_ok=True)
        Image.fromarray(pixels[..., :3]).save(reference)
        pytest.skip(f"recorded {reference}")
    expected = np.asarray(Image.open(reference).convert("RGBA"))
    assert expected.shape == pixels.shape
    software = "llvmpipe" in context.info["GL_RENDERER"]
    if not (same_to_the_pixel if software else same_to_the_eye)(pixels, expected):
        off = difference(pixels, expected)
        save(f"{scene}-reference", expected)
        save(f"{scene}-difference", np.clip(off * 8, 0, 255).astype(np.uint8))
        pytest.fail(f"{scene} differs at {(off > 1).mean():.2%} of the pixels, by up to {off.max()}: "
                    f"see {save(scene, pixels)} and its neighbours")


@pytest.mark.parametrize("scene", SCENES)
def test_a_scene_says_what_it_is(scene: str) -> None:
    """A picture, a sentence for the menu, and one for each parameter's tooltip."""
    entry: SceneEntry = Catalog().find(scene)
    assert (REFERENCES / f"{scene}.png").is_file(), "record its picture: pytest tests/scenes/test_pictures.py --record"
    about = entry.describe()
    assert 10 < len(about["description"]) < 100 and about["description"].endswith(".")
    assert (entry.load().__doc__ or "").startswith(about["description"])
    for parameter in about["parameters"]:
        assert len(parameter["help"]) > 3, parameter["name"]
        for option, note in parameter.get("option_help", {}).items():
            assert len(note) > 3, f"{parameter['name']} = {option}"


@pytest.mark.parametrize("scene", SCENES)
def test_a_scene_is_a_picture_by_default(context: moderngl.Context, scene: str) -> None:
    """Not empty, not blown out, with something in the middle that stands out from the edge."""
    grey = viewer.render(scene, FRAME, size=(160, 90), samples=0)[..., :3].mean(axis=2)
    assert 40 < grey.mean() < 215
    assert np.ptp(grey) > 60
    assert (grey > 250).mean() < 0.05
    assert grey[25:65, 50:110].std() > 4


def test_pictures_that_differ_are_told_apart() -> None:
    """A wrong normal, a shift by a pixel and a tint are seen; a driver's rounding is not."""
    chance = np.random.default_rng(1)
    x, y = np.meshgrid(np.arange(320), np.arange(180))
    channels = [128 + 100 * np.sin(0.05 * x), 128 + 100 * np.cos(0.07 * y), 0 * x + 90]
    picture = np.stack(channels, axis=2).astype(np.uint8)
    rounded = (picture + chance.integers(-1, 2, picture.shape)).astype(np.uint8)
    rounded[0, 0] = 0
    assert same_to_the_pixel(picture, rounded) and same_to_the_eye(picture, rounded)
    for other in (np.roll(picture, 12, axis=1), picture[::-1], (picture * 0.9).astype(np.uint8)):
        assert not same_to_the_pixel(picture, other)
        assert not same_to_the_eye(picture, other)
    spot = picture.copy()
    spot[80:88, 100:110] = 255
    assert not same_to_the_pixel(picture, spot)
