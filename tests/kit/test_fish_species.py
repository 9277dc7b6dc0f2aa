"""Each species has the proportions that biologists measure on it, and looks alike from far and near."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from viewer.kit.fish import BODY, DORSAL, PECTORAL, PELVIC, SPECIES, TAIL, FishMesh, fish
from viewer.kit.fish_body import body_surface

PIXELS = 800        # a metre


def side_view(mesh: FishMesh) -> NDArray[np.bool_]:
    """The silhouette from the side, 1000 by 600 pixels."""
    picture = Image.new("1", (1000, 600))
    draw = ImageDraw.Draw(picture)
    for corners in (mesh.positions[mesh.triangles][:, :, :2] * PIXELS + [500, 300]).reshape(-1, 6).tolist():
        draw.polygon(corners, fill=1)
    return np.asarray(picture)


def extent(mesh: FishMesh, part: int) -> NDArray[np.float32]:
    """Length, height and width of a part."""
    return np.asarray(np.ptp(mesh.positions[mesh.parts == part], axis=0))


@pytest.mark.parametrize("species", SPECIES)
def test_details_agree_in_silhouette(species: str) -> None:
    """The area seen from the side is the same within 5 % from detail 1 to 4, and the farthest is not far off."""
    area = [side_view(fish(species, detail)).sum() for detail in range(5)]
    assert np.ptp(area[1:]) < 0.05 * area[4]
    assert area[0] == pytest.approx(area[4], rel=0.15)


def test_species_differ_in_silhouette() -> None:
    """Any two, laid upon each other, have less in common than nine tenths."""
    views = {species: side_view(fish(species, 2)) for species in SPECIES}
    for one in SPECIES:
        for other in SPECIES:
            common = (views[one] & views[other]).sum() / (views[one] | views[other]).sum()
            assert common == 1 if one == other else common < 0.8, (one, other)


def test_a_clownfish_is_deep_and_round() -> None:
    """Its height is 0.42 to 0.5 of its length to where the tail fin begins, and it is narrow for that."""
    mesh = fish("clownfish", 4)
    length, height, width = extent(mesh, BODY)
    assert 0.42 < height / length < 0.5
    assert 0.4 < width / height < 0.6
    tail = mesh.positions[mesh.parts == TAIL]
    assert abs(tail[tail[:, 0].argmin(), 1]) < 0.01      # a round tail reaches back in its middle


def test_a_tuna_is_a_spindle_with_a_lunate_tail() -> None:
    """Fineness 3.5 to 4.5, thickest before its middle, thin stalk with keels, a tail of high aspect ratio, finlets."""
    mesh = fish("tuna", 4)
    _, height, width = extent(mesh, BODY)
    assert 3.5 < 1.0 / height < 4.5 and 3.5 < 2.0 / (height + width) < 5.5
    body = body_surface(SPECIES["tuna"])
    x = np.linspace(-0.35, 0.45, 200)
    half_height, _, _ = body.section(x)
    assert 0.35 < 0.5 - x[half_height.argmax()] < 0.5
    assert body.section(-0.375)[0] < 0.15 * half_height.max()
    keel = mesh.positions[(mesh.parts == BODY) & (np.abs(mesh.positions[:, 0] + 0.375) < 0.005)]
    assert np.ptp(keel[:, 2]) > 1.3 * np.ptp(keel[:, 1])
    span = extent(mesh, TAIL)[1]
    assert span**2 / area_of(mesh, TAIL) > 5
    assert sum(fin.coarsest == 2 for fin in SPECIES["tuna"].median_fins) == 17


def test_a_koi_is_a_torpedo_with_soft_fins_and_barbels() -> None:
    """Four to five times as long as high, almost as wide as high, a long back fin and four feelers below its mouth."""
    mesh = fish("koi", 4)
    length, height, width = extent(mesh, BODY)
    assert 3.2 < length / height < 5 and 0.7 < width / height < 0.9
    assert extent(mesh, DORSAL)[0] > 0.3
    assert len(SPECIES["koi"].barbels) == 2
    tail = mesh.positions[mesh.parts == TAIL]
    assert abs(tail[tail[:, 0].argmin(), 1]) > 0.1       # forked


def test_an_eel_is_twelve_to_sixteen_times_as_long_as_high() -> None:
    """With its fins; and it has no pelvic ones."""
    mesh = fish("eel", 4)
    assert 12 < 1.0 / np.ptp(mesh.positions[:, 1]) < 16
    assert not (mesh.parts == PELVIC).any() and extent(mesh, PECTORAL)[0] < 0.06


@pytest.mark.parametrize("species", SPECIES)
def test_outlines_flow(species: str) -> None:
    """Back, belly and flank rise once and fall once, and bend the other way at most twice: there is no dent."""
    body = body_surface(SPECIES[species])
    x = np.linspace(SPECIES[species].stalk_end + 0.02, 0.498, 1200)
    half_height, half_width, middle = body.section(x)
    for outline in (middle + half_height, half_height - middle, half_width):
        slope = np.diff(outline)
        assert (np.diff(np.sign(slope)) != 0).sum() == 1
        assert (np.diff(np.sign(np.diff(slope))) != 0).sum() <= 2


def area_of(mesh: FishMesh, part: int) -> float:
    """Of one side of a part in the middle plane."""
    chosen = mesh.triangles[(mesh.parts[mesh.triangles] == part).all(axis=1)]
    a, b, c = np.moveaxis(mesh.positions[chosen].astype(float), 1, 0)
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 4)
