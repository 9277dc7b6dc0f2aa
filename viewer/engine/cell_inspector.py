"""Looks into the cells of a sampled field: the microscope's card, the sheet of all cases, marks in empty cells."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from viewer.engine.annotations import Label, Table
from viewer.engine.gpu import Gpu
from viewer.engine.insets import Insets
from viewer.engine.isosurface import Isosurface
from viewer.kit import bits, cell_cards, cell_words
from viewer.kit.cell_model import NO_VALUE
from viewer.kit.grid_box import GridBox, Vector
from viewer.kit.marching_cell import Cell, examine
from viewer.kit.models import Model, rgb
from viewer.kit.trilinear import trilinear_surface

MOST_MARKS = 20_000
OUTLINE = "#16181c"


class CellInspector:
    """Explains cells of ``surface``. ``card`` is what lies in the picture now, if anything."""

    def __init__(self, gpu: Gpu, surface: Isosurface) -> None:
        self.surface = surface
        self.card: cell_cards.CellCard | None = None
        self.cell: Cell | None = None
        self._inset, self._marks = Insets(gpu), Insets(gpu)
        self._shown: Hashable = None

    def microscope(self, cell: Sequence[int], name: str, level: float, look: cell_cards.Look, box: GridBox,
                   state: Hashable, *, trilinear: bool) -> None:
        """Put a cell under the microscope; nothing is done while ``state`` and all else stay the same."""
        shown = ("microscope", *cell, name, look.key, trilinear, state)
        if shown == self._shown:
            return
        self.cell = self.examined(cell, level, look.method, trilinear=trilinear)
        card = cell_cards.microscope_card(self.cell, name, look)
        low, high = box.in_world(np.array([cell, np.add(cell, 1)]))
        card.model.box(low, high, max(0.0022, min(0.006, 0.07 * box.cell_size)), rgb(OUTLINE))
        self._lay(card, shown)

    def sheet(self, chosen: int, look: cell_cards.Look, state: Hashable) -> None:
        """Lay out all 256 cases, those of the surface in colour, with the ``chosen`` one apart."""
        shown = ("sheet", chosen, look.key, state)
        if shown != self._shown:
            counts = np.bincount(self.surface.cases(), minlength=256)
            self._lay(cell_cards.sheet_card(look, dict(enumerate(counts.tolist())), chosen), shown)

    def clear(self) -> None:
        """Take the card away."""
        if self.card:
            self._lay(None, None)

    def mark_gaps(self, box: GridBox) -> None:
        """Put a dot into each cell that yields nothing though the surface might have run through it."""
        model, cells = Model(), self.surface.gaps()
        if len(cells):
            cells = cells[::1 + len(cells) // MOST_MARKS]
            places = self.surface.samples.lattice.grid.coordinates(cells) + 0.5
            model.balls(box.in_world(places), 0.18 * box.cell_size, rgb(NO_VALUE))
        self._marks.show(model)

    def examined(self, cell: Sequence[int], level: float, method: str, *, trilinear: bool) -> Cell:
        """A cell, its samples read back from the GPU, and what the surface makes of it."""
        samples, grid = self.surface.samples, self.surface.samples.lattice.grid
        number = sum(at * grid.offset(1 << axis) for axis, at in enumerate(cell))
        values = samples.read(np.array([number + grid.offset(corner) for corner in range(8)]))
        found = examine(values.astype(np.float64) - level, method)
        if not found.has_values:
            return found
        torn = self.surface.left_out is not None and bits.at(self.surface.left_out, number)
        if not trilinear:
            return replace(found, torn=torn)
        vertices, triangles = trilinear_surface(found.values.reshape(2, 2, 2).T, 0.0)
        return replace(found, torn=torn, decided=vertices[triangles])

    def cell_under(self, origin: Vector, direction: Vector,
                   cut: tuple[int, float] | None) -> tuple[int, int, int] | None:
        """The cell that one sees where a ray, in samples, goes: with a part of the surface, or in the slice.

        ``cut`` is the slice's axis and where it cuts, -1 to 1; what lies beyond it is cut away.
        """
        if cut is None:
            return self.surface.cell_under(origin, direction)
        height, to_slice, in_slice = self._slice_hit(origin, direction, *cut)
        if height < 0.0:        # seen from where the surface is cut away
            return in_slice or self.surface.cell_under(origin, direction, (to_slice, np.inf))
        return self.surface.cell_under(origin, direction, (0.0, to_slice)) or in_slice

    def _slice_hit(self, origin: Vector, direction: Vector, axis: int,
                   at: float) -> tuple[float, float, tuple[int, int, int] | None]:
        """How far the slice is along its axis and along the ray, and the cell where the ray goes through it."""
        last = np.array(self.surface.samples.lattice.samples) - 1
        height = float(0.5 * (1.0 + at) * last[axis] - origin[axis])
        to_slice = height / float(direction[axis]) if height * direction[axis] > 0.0 else np.inf
        if not np.isfinite(to_slice):
            return height, np.inf, None
        place = origin + to_slice * direction
        place[axis] = origin[axis] + height
        if (place < 0.0).any() or (place > last).any():
            return height, to_slice, None
        cell = np.floor(place)
        cell[axis] = np.ceil(place[axis]) - 1.0     # between two cells, the one that is not cut away
        x, y, z = np.clip(cell, 0, last - 1).astype(int).tolist()
        return height, to_slice, (x, y, z)

    def draw(self, *, marks: bool) -> None:
        """Draw the card and, with ``marks``, the dots; in ``Scene.draw_over``."""
        if marks:
            self._marks.draw()
        if self.card:
            self._inset.draw()

    def labels(self) -> Sequence[Label]:
        """What is written on the card."""
        return [Label(line.text, line.place, line.size, line.color, line.align, line.plate, line.bold)
                for line in (self.card.lines if self.card else ())]

    def tables(self) -> Mapping[str, Table]:
        """The cell under the microscope in numbers."""
        if not self.cell:
            return {}
        tables = {"corners": Table(cell_words.CORNER_COLUMNS, cell_words.corner_rows(self.cell)),
                  "crossings": Table(cell_words.CROSSING_COLUMNS, cell_words.crossing_rows(self.cell)),
                  "ambiguous": Table(cell_words.FACE_COLUMNS, cell_words.face_rows(self.cell))}
        return {f"cell_{name}": table for name, table in tables.items() if table.rows}

    def _lay(self, card: cell_cards.CellCard | None, shown: Hashable) -> None:
        if card is None or card.frames:
            self.cell = None
        self.card, self._shown = card, shown
        self._inset.card = card.rectangle if card else None
        self._inset.show(card.model if card else Model())
