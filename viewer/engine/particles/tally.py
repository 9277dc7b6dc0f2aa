"""What is counted of particles."""

from __future__ import annotations

from dataclasses import dataclass, field, replace


@dataclass
class Tally:
    """What has happened since the start. ``live`` holds the number of the living, frame by frame."""

    emitted: int = 0
    died: int = 0
    collisions: int = 0
    children: int = 0
    refused: int = 0
    stillborn: int = 0
    live: list[int] = field(default_factory=lambda: [0])

    def copy(self) -> Tally:
        """The same numbers, apart."""
        return replace(self, live=list(self.live))
