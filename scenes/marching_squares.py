"""The lecture's marching squares: from a picture of ten by ten values to the curve on which they are zero."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from viewer import (
    Click,
    ColorScale,
    Curve,
    Geometry,
    Gpu,
    Label,
    Measurements,
    Orbit,
    Parameters,
    Scene,
    Studio,
    Table,
    choice,
    formula,
    formula_include,
    integer,
    slider,
    text,
    toggle,
)
from viewer.kit import marching_squares_board as board
from viewer.kit import marching_squares_writing as writing
from viewer.kit.marching_squares import SADDLES
from viewer.kit.sampled_square import RUNGS, FormulaAt, SampledSquare, errors_by_resolution, sample
from viewer.kit.square_cell_card import MARGIN, Card, card, room_for_card

FINEST = 512
OVAL = "length(x-0.22, y-0.28) * length(x-0.68, y-0.82) - 0.128"       # a Cassini oval
STEPS = {
    "values": "The samples, as the pixels of a picture", "signs": "Below the level or not, at each corner",
    "cases": "The case of each cell that the curve crosses", "crossings": "Where it crosses the cells' edges",
    "segments": "The crossings joined"}
INK, CHALK, ORANGE = (0.03, 0.035, 0.045), (0.95, 0.95, 0.94), (0.835, 0.369, 0.0)


class MarchingSquares(Scene):
    """Marching squares, step by step: samples, signs, sixteen cases, crossings, segments."""

    class Params(Parameters):
        formula = formula(OVAL, "The function, over x and y from 0 to 1", variables=("x", "y", "t"))
        level: float = slider(0.0, -2.0, 2.0, "The value that the curve has")
        resolution: int = integer(10, 2, FINEST, "Cells along each axis", logarithmic=True)
        refine: bool = toggle(False, "Twice as many cells every second and a half, as time goes on")
        saddle: str = choice("decider", {
            "connect": "Join the inside corners through the cell's middle", "separate": "Cut them off from each other",
            "decider": "Ask the bilinear function's value at its saddle"}, "Where only opposite corners agree")
        jumps: str = choice("cut", {
            "cut": "No curve where the function jumps through the level", "keep": "Take a jump for a crossing"},
            "Poles and steps of the function")
        view: str = choice("board", {
            "board": "The unit square", "cases": "The sixteen cases: click on one to see its cells"},
            "What stands in the studio", group="Picture")
        show: str = choice("segments", STEPS, "How far the lecture has come", group="Picture", when="view=board")
        true_curve: bool = toggle(True, "The curve itself, asked of the formula at every pixel", group="Picture",
                                  when="view=board")
        colouring: str = choice("diverging", {
            "diverging": "Blue below the level, orange above", "viridis": "One scale from the lowest to the highest"},
            "The colours of values", group="Picture", when="view=board")
        case: str = choice("all", {"all": "Cells of every case"} | {
            str(case): f"Only cells of case {case} = {case:04b}" for case in range(16)},
            "Which cells take part", group="Picture")
        cell: str = text("", "The cell to look at closely, as 3,4; or click on it",
                         pattern=r"\d{1,6} *, *\d{1,6}", example="3,4", group="Cell microscope", when="view=board")
        walk: bool = toggle(False, "Go from cell to cell as time goes on", group="Cell microscope", when="view=board")
        cells_per_second: float = slider(4.0, 0.5, 500.0, "How fast the walk goes", unit="cells/s", logarithmic=True,
                                         group="Cell microscope", when="walk, view=board")

    camera = Orbit(yaw=0, pitch=4, distance=6.7, target=(0.0, -0.04, 0.0), field_of_view=24)
    studio = Studio(radius=1.7, ground=-board.REACH)

    def __init__(self, gpu: Gpu, params: Params) -> None:
        self.gpu = gpu
        self.params = params
        self.square = self.sampled()
        self.sent: object = None            # what the GPU has
        include = {"generated/formula.glsl": lambda: formula_include(params, "formula")}
        self.samples = gpu.texture((FINEST + 1, FINEST + 1), 2, dtype="f4", label="samples")
        self.cells = gpu.texture((FINEST, FINEST), 1, dtype="u1", label="cells")
        self.samples.filter = self.cells.filter = moderngl.NEAREST, moderngl.NEAREST
        self.programs = {name: gpu.program(f"marching_squares/{stage}.vert", f"marching_squares/{name}.frag",
                                           generated=include if name in ("curve", "card") else None)
                         for name, stage in (("board", "board"), ("curve", "board"), ("segment", "segment"),
                                             ("crossing", "crossing"), ("card", "card"))}
        box = board.box()
        self.board = self.faces("board", box)
        self.curve = self.faces("curve", box[board.FRONT])
        self.drawn = gpu.buffer(reserve=16, label="segments")
        self.segments = self.lines("segment", self.drawn)
        self.crossings = self.lines("crossing", self.drawn, moderngl.TRIANGLES)
        self.sheets = [self.lines("segment", gpu.buffer(board.sheet_segments(answer))) for answer in SADDLES[:2]]
        self.paper = gpu.vertex_array(self.programs["card"], mode=moderngl.TRIANGLE_STRIP)

    def faces(self, program: str, corners: NDArray[np.float32]) -> Any:
        """Sides of the board, drawn by ``program``."""
        return self.gpu.vertex_array(self.programs[program], [
            (self.gpu.buffer(corners, label=program), "3f 3f", "in_position", "in_normal")], closed=True)

    def lines(self, program: str, buffer: moderngl.Buffer, mode: int = moderngl.TRIANGLE_STRIP) -> Any:
        """One instance for each segment in ``buffer``."""
        return self.gpu.vertex_array(self.programs[program], [(buffer, "2f 2f/i", "in_from", "in_to")], mode=mode)

    # What is computed

    def prepare(self) -> None:
        params = self.params
        self.square = self.sampled()
        n = self.square.resolution
        done = board.walked(n, self.time, params.cells_per_second) if params.walk else n * n
        self.cell = self.current_cell(done)
        self.card = self.worked_out() if params.view == "board" else None
        shown = (self.question, n, params.case, params.colouring, done)
        if shown != self.sent:
            self.send(self.square, board.taking_part(self.square.cases, params.case, done))
            self.sent = shown

    def sampled(self) -> SampledSquare:
        """The formula as it now is, on the grid as it now is."""
        params, formula = self.params, self.params.formula
        time = self.time if "t" in formula.variables else 0.0
        function = FormulaAt(formula, time, tuple(params.numbers(formula).items()))
        self.question = (function, params.level, params.saddle, params.jumps)
        n = board.refined(params.resolution, self.time, FINEST) if params.refine else params.resolution
        return sample(function, n, *self.question[1:])

    def current_cell(self, done: int) -> tuple[int, int] | None:
        """The cell that was chosen, if the grid has it, or else the one that comes after the ``done`` first."""
        n, name = self.square.resolution, self.params.cell
        if not name.strip():
            return (done % n, done // n) if done < n * n else None
        i, j = (int(part) for part in name.split(","))
        return (i, j) if max(i, j) < n else None

    def worked_out(self) -> Card | None:
        """The card for the cell under the microscope."""
        if self.cell is None:
            return None
        no_curve = writing.why_barren(self.square, *self.cell)
        title = "Cell {}, {}".format(*self.cell)
        return card(self.square.cell(*self.cell), title, self.params.saddle, no_curve, self.aspect)

    def send(self, square: SampledSquare, taking_part: NDArray[np.bool_]) -> None:
        """Give the GPU the samples, what is known of the cells, and the segments in cells that take part."""
        n, segments = square.resolution, square.tracing.segments[taking_part[tuple(square.tracing.cells.T)]]
        self.samples.write(board.tones(square.values, square.level, self.params.colouring), (0, 0, n + 1, n + 1))
        self.cells.write(board.cell_bits(square, ~taking_part), (0, 0, n, n))
        self.drawn.orphan(max(16, segments.nbytes))
        self.drawn.write(segments)
        self.count = len(segments)

    # What is drawn

    def draw(self) -> None:
        self.set_uniforms()
        self.board.render()
        if self.gpu.casting_shadows:
            return
        context, params = self.gpu.context, self.params
        context.enable(moderngl.BLEND)
        context.fbo.depth_mask = False
        if params.view == "cases":
            self.draw_sheet()
        else:
            self.draw_curve()
        context.fbo.depth_mask = True
        context.disable(moderngl.BLEND)
        if self.card:
            self.draw_card(self.card)

    def set_uniforms(self) -> None:
        """What the board's shaders need besides the parameters."""
        self.samples.use(0)
        self.cells.use(1)
        square, params = self.square, self.params
        for name in ("board", "card", "crossing"):
            self.programs[name]["u_cell_count"] = square.resolution
            self.programs[name]["u_cells"] = 1
        program = self.programs["board"]
        program["u_chosen"] = self.cell or (-1, -1)
        program["u_present"] = int(np.bitwise_or.reduce(1 << square.cases.astype(int), axis=None))
        program["u_chosen_case"] = -1 if params.case == "all" else int(params.case)

    def draw_curve(self) -> None:
        """The segments, the true curve inside them, and the crossings on top."""
        step = list(STEPS).index(self.params.show)
        if step >= 4 and self.count:
            self.draw_lines(self.segments, self.count, 5.5, INK if self.params.colouring == "diverging" else CHALK)
        if self.params.true_curve:
            self.gpu.context.polygon_offset = -1.0, -1.0
            self.curve.render()
            self.gpu.context.polygon_offset = 0.0, 0.0
        if step >= 3 and self.count:
            self.crossings.render(vertices=12, instances=self.count)

    def draw_sheet(self) -> None:
        """The segments of all sixteen cases; in orange the other answer, where the decider may give either."""
        saddle, count = self.params.saddle, len(board.sheet_segments("connect"))
        if saddle == "decider":
            self.draw_lines(self.sheets[1], count, 4.0, ORANGE)
        self.draw_lines(self.sheets[saddle == "separate"], count, 4.0, INK)

    def draw_lines(self, lines: Any, count: int, width: float, color: tuple[float, float, float]) -> None:
        """Draw ``count`` segments, ``width`` pixels wide in a picture of 720."""
        self.programs["segment"]["u_width"] = width
        self.programs["segment"]["u_line_color"] = color
        lines.render(vertices=4, instances=count)

    def draw_card(self, sheet: Card) -> None:
        """The microscope: the card, then the cell on it, once or with both answers."""
        program = self.programs["card"]
        program["u_cell"], program["u_depth"], program["u_rectangle"] = (-1, -1), -0.999, sheet.rectangle
        self.paper.render(vertices=4)
        program["u_cell"], program["u_depth"], program["u_margin"] = self.cell or (0, 0), -0.9995, MARGIN
        for drawing in sheet.drawings:
            program["u_rectangle"], program["u_emphasis"] = drawing.rectangle, drawing.emphasis
            program["u_segment_count"] = len(drawing.segments)
            program["u_first_segment"], program["u_second_segment"] = drawing.two_segments
            self.paper.render(vertices=4)

    def middle(self) -> tuple[float, float]:
        return room_for_card(self.aspect) if self.card else (0.0, 0.0)

    def labels(self) -> Sequence[Label]:
        if self.params.view == "cases":
            written = list(writing.on_sheet(self.square.cases, self.aspect))
        else:
            caption = "" if self.middle()[1] else self.params.formula.text
            written = list(writing.on_board(caption, self.square, self.params.refine, self.aspect))
        return [Label(line.text, line.place, line.size, line.color, line.align, bold=line.bold)
                for line in (*written, *(self.card.lines if self.card else ()))]

    def color_scale(self) -> ColorScale | None:
        if self.params.colouring != "viridis" or self.params.view == "cases" :
            return None
        return ColorScale("value", *board.value_range(self.square.values))

    def remarks(self) -> Sequence[str]:
        return list(writing.remarks(self.square, self.params.jumps == "keep", self.params.cell, self.cell))

    def click(self, click: Click) -> Mapping[str, object]:
        """A cell of the board goes under the microscope; a case of the sheet is shown on the board."""
        if self.card and self.card.covers(click.place):
            return {}
        place = board.place_seen(click.origin, click.direction)
        if self.params.view == "cases":
            return {"case": "all" if place is None else str(board.case_at(place)), "view": "board"}
        if place is None:
            return {"cell": "", "case": "all"}
        i, j = (int(along * self.square.resolution) for along in place)
        return {"cell": f"{i},{j}"}

    # What it tells

    def geometry(self) -> Geometry:
        return {"segments": self.square.tracing.segments.astype(np.float32)}

    def measure(self) -> Measurements:
        tables = {}
        if self.cell:
            place = (*self.cell, self.square.resolution)
            cell = self.square.cell(*self.cell)
            tables = {"cell": Table(("corner", "x", "y", "value", "sign"), cell.corner_rows(*place)),
                      "crossings": Table(("edge", "A", "B", "t", "x", "y"), cell.crossing_rows(*place))}
        return {**self.square.numbers(), **tables, "error_vs_resolution": self.error_vs_resolution()}

    def error_vs_resolution(self) -> Curve:
        """The largest distance to the true curve on finer and finer grids: a fourth for each halving."""
        errors = errors_by_resolution(*self.question)
        return Curve("resolution", RUNGS, {"max_distance": errors}, x_label="cells along an axis",
                     y_label="max distance", log_x=True, log_y=True, now=self.square.resolution)
