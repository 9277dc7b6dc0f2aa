"""What is measured of a gait, on spines whose motion is known."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from viewer.kit.gait import STRIDE, gait
from viewer.kit.nearest import nearest_distances

S = np.linspace(0.0, 1.0, 41)
PHASES = 2.0 * np.pi * np.arange(32)[:, None] / 32


def spines(aside: NDArray[np.float64]) -> NDArray[np.float64]:
    """Spines (m, n, 3) that swing by ``aside`` (m, n), not caring for their length."""
    return np.stack([np.broadcast_to(0.5 - S, aside.shape), np.zeros_like(aside), aside], axis=2)


@pytest.mark.parametrize("wavelength", [0.5, 0.9, 1.3, 2.5])
def test_a_running_wave_is_found(wavelength: float) -> None:
    """Its length, and each place's swing, though it grows from head to tail."""
    found = gait(spines((0.02 + 0.1 * S**2) * np.sin(PHASES - 2.0 * np.pi * S / wavelength)))
    assert found.wavelength == pytest.approx(wavelength, rel=1e-3)
    assert found.amplitude == pytest.approx(0.02 + 0.1 * S**2, rel=0.01)
    assert found.strouhal == pytest.approx(2.0 * 0.12 / STRIDE, rel=0.01)


@pytest.mark.parametrize("aside", [0.0 * S * PHASES, 0.1 * np.sin(PHASES + 0.0 * S), 0.1 * S * np.sin(PHASES)])
def test_where_no_wave_runs_none_is_found(aside: NDArray[np.float64]) -> None:
    """A still spine, one that shifts and one that turns."""
    assert gait(spines(aside)).wavelength == np.inf


def test_a_steady_bend_is_no_swing() -> None:
    """A turning fish swings as far as one that swims ahead."""
    swing = 0.1 * S * np.sin(PHASES - 6.0 * S)
    assert gait(spines(swing + S**2)).amplitude == pytest.approx(gait(spines(swing)).amplitude, abs=1e-12)


def test_a_spine_that_stretches_is_told() -> None:
    """The moment that is farthest off counts."""
    bent = spines(0.0 * S * PHASES)
    bent[5, :, 0] *= 1.1
    bent[9, :, 0] *= 0.8
    assert gait(bent).body_length_ratio == pytest.approx(0.8)


def test_the_nearest_of_a_crowd() -> None:
    """Against every pair."""
    places = np.random.default_rng(3).normal(size=(60, 3))
    apart = np.linalg.norm(places[:, None] - places[None], axis=2) + 1e9 * np.eye(60)
    assert nearest_distances(places) == pytest.approx(apart.min(axis=1))
    assert nearest_distances(places[:1]) == np.inf
