"""Where things go in a window of any size, in units of the text's size."""

from __future__ import annotations

from dataclasses import dataclass, field

SCALES = (1.0, 1.25, 1.5, 1.75, 2.0, 2.5, 3.0)
ONE_COLUMN_BELOW = 54.0     # widths and heights in ems: a window narrower than this shows one column
ONE_ROW_BELOW = 34.0
NARROWEST = 10.0


@dataclass
class View:
    """What the user chose to see."""

    scale: float = 1.0
    panels: bool = True
    left: bool = True
    right: bool = True
    bottom: bool = True
    help: bool = False
    left_ems: float | None = None      # widths that the user dragged the columns to
    right_ems: float | None = None

    def rescale(self, steps: int) -> None:
        """Go up or down among the usual scales; 0 goes back to 100 %."""
        nearest = min(range(len(SCALES)), key=lambda index: abs(SCALES[index] - self.scale))
        self.scale = SCALES[max(0, min(len(SCALES) - 1, nearest + steps))] if steps else 1.0


@dataclass(frozen=True)
class Box:
    """A rectangle in the window's units, from its top left corner."""

    x: float = 0.0
    y: float = 0.0
    width: float = 0.0
    height: float = 0.0

    @property
    def shown(self) -> bool:
        """Whether there is any room in it."""
        return self.width >= 1.0 and self.height >= 1.0


@dataclass(frozen=True)
class Layout:
    """A box for each part; boxes without room are not drawn."""

    picture: Box
    left: Box = field(default_factory=Box)
    right: Box = field(default_factory=Box)
    bottom: Box = field(default_factory=Box)
    menu_height: float = 0.0
    one_column: bool = False
    one_row: bool = False


def arrange(size: tuple[int, int], em: float, menu_height: float, view: View) -> Layout:
    """Divide a window of ``size`` for text of height ``em``."""
    width, height = float(size[0]), float(size[1])
    if not view.panels:
        return Layout(Box(0.0, 0.0, width, height))
    one_column, one_row = width < ONE_COLUMN_BELOW * em, height < ONE_ROW_BELOW * em
    top = min(menu_height, height)
    below = min((2.75 if one_row else 4.6) * em, 0.3 * height) if view.bottom else 0.0
    left, right = _columns(width, em, one_column, view)
    left, right = float(round(left * view.left)), float(round(right * view.right))
    middle = max(0.0, float(round(height - top - below)))
    return Layout(
        Box(left, top, max(0.0, width - left - right), middle),
        Box(0.0, top, left, middle), Box(width - right, top, right, middle),
        Box(0.0, top + middle, width, height - top - middle), top, one_column, one_row)


def _columns(width: float, em: float, one_column: bool, view: View) -> tuple[float, float]:
    if one_column:
        own = max(15.5 * em, 0.3 * width) if view.left_ems is None else view.left_ems * em
        return min(own, 0.52 * width), 0.0
    left = _between(0.22 * width, 17.0 * em, 22.0 * em) if view.left_ems is None else view.left_ems * em
    right = _between(0.25 * width, 16.5 * em, 30.0 * em) if view.right_ems is None else view.right_ems * em
    left = _between(left, NARROWEST * em, 0.4 * width)
    return left, _between(right, NARROWEST * em, width - left - NARROWEST * em)


def _between(value: float, low: float, high: float) -> float:
    return max(low, min(high, value))
