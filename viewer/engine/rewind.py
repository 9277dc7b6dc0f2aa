"""Moments of a simulation that are kept, so that going back in time need not begin at the beginning."""

from __future__ import annotations

from collections.abc import Hashable
from typing import Protocol

MOST_BYTES = 512 * 2**20
SHORTEST_STRIDE = 16
BYTES_PER_FRAME = 2**20     # a snapshot of so many MiB is taken no oftener than every so many frames


class Snapshot(Protocol):
    """Whatever a scene needs to stand again where it stood; it tells its size in bytes."""

    @property
    def nbytes(self) -> int:
        """How much memory it takes."""


class Rewind:
    """Snapshots by frame, ever farther apart as they fill ``most_bytes``.

    They are of frames that were played from the beginning with what steers the simulation, the ``key``, staying
    the same: once it changes, nothing is kept until the next beginning, or until a moment from before is found again.
    """

    def __init__(self, most_bytes: int = MOST_BYTES) -> None:
        self.most_bytes = most_bytes
        self.forget()

    def forget(self) -> None:
        """Keep nothing of what was."""
        self._kept: dict[int, Snapshot] = {}
        self._key: Hashable = None
        self._unbroken = False      # whether the frame now played follows from those that are kept
        self._stride = SHORTEST_STRIDE

    def begin(self, key: Hashable) -> None:
        """Frame 0 is about to be left, steered by ``key``."""
        if key != self._key:
            self.forget()
            self._key = key
        self._unbroken = True

    def is_due(self, frame: int, key: Hashable) -> bool:
        """Whether a snapshot of ``frame``, which has just been played, would be kept."""
        self._unbroken = self._unbroken and key == self._key
        return self._unbroken and frame % self._stride == 0 and frame not in self._kept

    def keep(self, frame: int, snapshot: Snapshot) -> None:
        """Keep a snapshot; where there are too many, every other goes."""
        while snapshot.nbytes > BYTES_PER_FRAME * self._stride:
            self._widen()
        self._kept[frame] = snapshot
        while self.nbytes > self.most_bytes and len(self._kept) > 1:
            self._widen()

    def before(self, frame: int, key: Hashable) -> tuple[int, Snapshot] | None:
        """The last frame not after ``frame`` that is kept, and its snapshot: to go on from there."""
        frames = [kept for kept in self._kept if kept <= frame] if key == self._key else []
        self._unbroken = self._unbroken or bool(frames)
        return (max(frames), self._kept[max(frames)]) if frames else None

    @property
    def nbytes(self) -> int:
        """How much memory all of it takes."""
        return sum(snapshot.nbytes for snapshot in self._kept.values())

    def _widen(self) -> None:
        self._stride *= 2
        self._kept = {frame: kept for frame, kept in self._kept.items() if frame % self._stride == 0}
