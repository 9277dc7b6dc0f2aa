"""What a kind of fish is made of, as data: the tables that ``fish_clownfish`` and its like fill in.

All is measured in metres on a fish one metre long: nose at x = 0.5, tail tip at x = -0.5, up +y, its left side -z.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import TypeAlias

Point: TypeAlias = tuple[float, float]
Vector: TypeAlias = tuple[float, float, float]
NOSE = 0.5      # x


class Part(IntEnum):
    """What a vertex of a fish belongs to."""

    BODY = 0
    TAIL = 1
    DORSAL = 2
    ANAL = 3
    PECTORAL = 4
    PELVIC = 5
    EYE = 6


@dataclass(frozen=True)
class Section:
    """One row of the table from which a body is drawn: a cross section.

    ``along`` runs from 0 at the nose to 1 at the end of the tail's stalk; ``back`` and ``belly`` are heights y.
    ``shoulders`` > 0 moves the widest place up, < 0 down; ``fullness`` > 0 makes the section squarer, < 0 a lens.
    """

    along: float
    back: float
    belly: float
    half_width: float
    shoulders: float = 0.0
    fullness: float = 0.0


@dataclass(frozen=True)
class Eye:
    """A ball on the skin: where it is seen from the side, its radius, and how much of the radius stands out."""

    x: float
    y: float
    radius: float
    bulge: float = 0.35


@dataclass(frozen=True)
class Mouth:
    """A groove with lips, back from below the nose at ``tip`` to ``corner``; ``gape`` is half the groove's width."""

    tip: Point
    corner: Point
    gape: float
    depth: float
    lips: float

    @property
    def slope(self) -> float:
        """By how much the line of the mouth rises for each metre towards the nose."""
        return (self.tip[1] - self.corner[1]) / (self.tip[0] - self.corner[0])


@dataclass(frozen=True)
class Gill:
    """The gill cover's edge: farthest back at (``x``, ``y``), forward by ``curl`` times the squared height from there.

    It stands out by ``depth`` and fades at ``reach`` above and below.
    """

    x: float
    y: float
    curl: float
    depth: float
    reach: float


@dataclass(frozen=True)
class Barbel:
    """A feeler where the head is seen at (``x``, ``y``) from the side, out along ``way`` (the right one's, z > 0).

    It sinks from there by ``droop`` of its length.
    """

    x: float
    y: float
    way: Vector
    length: float
    radius: float
    droop: float


@dataclass(frozen=True)
class Keel:
    """A ridge along the stalk: a bell over x and a narrow one over y."""

    x: float
    y: float
    length: float
    thickness: float
    height: float


@dataclass(frozen=True)
class MedianFin:
    """A fin in the middle plane, by curves through points evenly over its breadth, from the front or the top.

    ``root`` gives (x, share of the body's half height: 1 the back, -1 the belly), ``tip`` the (x, y) where the rays
    end. A ray runs straight, or bent by ``bend``: how far its middle is pushed aside.
    """

    part: Part
    root: tuple[Point, ...]
    tip: tuple[Point, ...]
    rays: int
    bend: tuple[Point, ...] = ((0.0, 0.0),)
    thickness: float = 0.006
    flesh: float = 0.0              # how much thicker it is at its root, as a part of that
    notch: float = 0.0              # how deep the skin between spines is notched, as a part of their length,
    spiny: float = 1.0              # and over which part of its breadth there are spines
    tail: Point | None = None       # over which part of its breadth a ribbon is the tail
    size: float = 1.0               # how many times as many strips as others it needs
    coarsest: int = 0               # the lowest detail that shows it


@dataclass(frozen=True)
class PairedFin:
    """A fin on each flank. The numbers are the right one's, z > 0; the left one is its mirror image.

    Its ``root`` on the skin is given by two points (x, share of the half height), the leading one first; ``out`` points
    along it to its tip, ``across`` to its leading edge. In that frame, whose origin is the root's middle, ``tip`` gives
    (out, across, lift) and ``bend`` is a push.
    """

    part: Part
    root: tuple[Point, Point]
    out: Vector
    across: Vector
    tip: tuple[Vector, ...]
    rays: int
    bend: tuple[Vector, ...] = ((0.0, 0.0, 0.0),)
    thickness: float = 0.005
    flesh: float = 1.0
    size: float = 1.0
    coarsest: int = 0


@dataclass(frozen=True)
class Species:
    """A kind of fish. ``stalk_end`` is the x where the body ends, within the tail fin."""

    name: str
    title: str
    stalk_end: float
    sections: tuple[Section, ...]
    eye: Eye
    mouth: Mouth
    gill: Gill
    median_fins: tuple[MedianFin, ...]
    paired_fins: tuple[PairedFin, ...]
    keels: tuple[Keel, ...] = ()
    barbels: tuple[Barbel, ...] = ()
