"""The lecture's marching cubes and tetrahedra: a surface through samples, live, and every cell of it explained."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import replace

import moderngl
import numpy as np

from viewer import (
    CellInspector,
    Click,
    ColorScale,
    FieldSamples,
    Geometry,
    Gpu,
    Isosurface,
    Label,
    Lattice,
    Measurements,
    Orbit,
    Parameters,
    Scene,
    Studio,
    Table,
    Wanted,
    choice,
    color,
    file,
    formula,
    formula_include,
    integer,
    room_for_samples,
    slider,
    text,
    toggle,
)
from viewer.kit import cell_cards, cell_model, surface_words
from viewer.kit.field_function import FieldFunction
from viewer.kit.grid_box import GridBox
from viewer.kit.mesh_measure import mesh_numbers
from viewer.kit.trilinear import trilinear_surface
from viewer.kit.volume_file import SUFFIXES, read_volume

TANGLE = "16*(x^4 + y^4 + z^4) - 20*(x^2 + y^2 + z^2) + 11.8"
PLACES, NORMALS, VALUES = 0, 1, 2               # texture units
APART = 0.92                                    # from the middle to either surface of a comparison
FAR_OFF = 2.2                                   # from the middle: beside every grid, also when two are compared
CLIP_DISTANCE = 0x3000                          # GL_CLIP_DISTANCE0
VOLUME_FIELD = '#include "isosurface/volume_field.glsl"\n'
FORMULA_FIELD = ("float field(vec3 place) { return formula(place); }\n"
                 "vec3 field_gradient(vec3 place) { return formula_gradient(place); }\n")


class MarchingCubes(Scene):
    """Marching cubes and tetrahedra on a function you type, with every cell open to inspection."""

    class Params(Parameters):
        source: str = choice("formula", {
            "formula": "A function of x, y and z that you type", "volume": "Samples from a file"},
            "What the surface goes through", rebuild=True)
        formula = formula(TANGLE, "The function; inside is where it is below the level", when="source=formula")
        volume = file(None, "Samples on a grid: NumPy or NRRD", suffixes=SUFFIXES, when="source=volume")
        level: float = slider(0.0, -1e30, 1e30, "The value that the surface has", handy=(-3.0, 3.0))
        resolution: int = integer(64, 8, 256, "Cells along each axis", logarithmic=True, when="source=formula")
        extent: float = slider(1.5, 0.1, 100.0, "The function is sampled from minus this to plus this",
                               logarithmic=True, when="source=formula")
        method: str = choice("cubes", {
            "cubes": "256 cases, from a table", "tetrahedra": "Six tetrahedra in each cell, nothing ambiguous"},
            "How cells become triangles")
        topology: str = choice("table", {
            "table": "Inside corners across an ambiguous face are always parted",
            "trilinear": "As the trilinear function between the samples has it"},
            "How ambiguous cells of cubes are decided")
        view: str = choice("surface", {
            "surface": "The surface", "compare": "Cubes and tetrahedra side by side",
            "cases": "All 256 cases on a sheet"}, "What is shown")
        colouring: str = choice("surface", {
            "surface": "A lit surface", "normal": "The normal's x, y, z as red, green, blue",
            "curvature": "How the surface bends: its mean curvature", "case": "Which of the 15 kinds each cell is",
            "difference": "How far the other method's surface is away"},
            "What the colours show", group="Look", when="view!=cases")
        color: tuple[float, float, float] = color("#e07b39", "Colour of the outside", group="Look")
        curvature_scale: float = slider(3.0, 0.001, 1000.0, "The curvature at the ends of the colours", unit="1/length",
                                        logarithmic=True, group="Look", when="colouring=curvature")
        difference_scale: float = slider(0.03, 0.001, 1.0, "The distance at the bright end of the colours",
                                         unit="cells", logarithmic=True, group="Look", when="colouring=difference")
        wireframe: bool = toggle(False, "The sides of the triangles", group="Look", when="view!=cases")
        slice: str = choice("none", {"none": "The whole surface", "x": "Cut at right angles to x", "y": "to y",
                                     "z": "to z"}, "A plane that shows the samples", group="Look", when="view!=cases")
        slice_at: float = slider(0.0, -1.0, 1.0, "Where the plane cuts, in halves of the grid", group="Look",
                                 when="slice!=none")
        slice_range: float = slider(4.0, 1e-3, 1e5, "The distance from the level at the ends of the colours",
                                    logarithmic=True, group="Look", when="slice!=none", handy=(0.01, 100.0))
        jumps: str = choice("cut", {"cut": "No surface where the function jumps over the level, as at a pole",
                                    "keep": "A wall there, as the samples alone suggest"},
                            "What to make of jumps", group="Look", when="source=formula")
        marks: bool = toggle(True, "Purple dots in cells that yield nothing, for want of a value or at a jump",
                             group="Look", when="view=surface, slice=none")
        cell: str = text("", "The cell under the microscope; a click chooses one",
                         pattern=r"\d{1,6}( *, *\d{1,6}){2}", example="3,0,7",
                         group="Cell microscope", when="view=surface, !walk")
        walk: bool = toggle(False, "Visit the surface's cells one by one, as time goes on", group="Cell microscope",
                            when="view=surface")
        cells_per_second: float = slider(3.0, 0.1, 10000.0, "How fast the walk goes", logarithmic=True,
                                         group="Cell microscope", when="walk, view=surface")
        case: int = integer(-1, -1, 255, "Show cells of this case alone; -1 for all", group="Cell microscope")

    camera = Orbit(yaw=32, pitch=20, distance=4.9)
    studio = Studio(radius=1.8, ground=-1.06)

    def __init__(self, gpu: Gpu, params: Params) -> None:
        self.gpu, self.params = gpu, params
        has_volume = params.source == "volume" and params.volume
        self.volume = read_volume(params.volume, room_for_samples()) if has_volume else None
        looks = {"generated/case_classes.glsl": case_classes_glsl, "generated/look.glsl": self.look_glsl}
        include = (lambda: VOLUME_FIELD) if params.source == "volume" else self.formula_field
        self.samples = FieldSamples(gpu, None if params.source == "volume" else include)
        self.surface, self.other = (Isosurface(gpu, self.samples, include) for _ in range(2))
        smooth = gpu.program("marching_cubes/surface.vert", "marching_cubes/surface.frag", generated=looks)
        wired = gpu.program("marching_cubes/wire.vert", "marching_cubes/surface.frag", generated=looks)
        self.slice_plane = gpu.program("marching_cubes/slice.vert", "marching_cubes/slice.frag")
        self.programs = [smooth, wired, self.slice_plane]
        self.smooth = {mesh: gpu.vertex_array(smooth, index=mesh.indices) for mesh in (self.surface, self.other)}
        self.wired = {mesh: gpu.vertex_array(wired, [(mesh.indices, "1i", "in_index")])
                      for mesh in (self.surface, self.other)}
        self.slice_square = gpu.vertex_array(self.slice_plane, mode=moderngl.TRIANGLE_STRIP)
        self.inspector = CellInspector(gpu, self.surface)
        self.function: FieldFunction | None = None
        self.made: Hashable = None
        self.set_up_volume()

    def set_up_volume(self) -> None:
        """Turn the volume to the order of the GPU's samples, z y x, and offer the level's slider its range."""
        if self.volume:
            self.volume = replace(self.volume, values=np.ascontiguousarray(self.volume.values.T))
            self.params.offer("level", self.volume.lowest, self.volume.highest)
            self.params.offer("slice_range", 0.001, max(0.01, self.volume.highest - self.volume.lowest))

    def formula_field(self) -> str:
        """The formula as the field that is sampled."""
        return formula_include(self.params, "formula") + FORMULA_FIELD

    def look_glsl(self) -> str:
        """What the surface's shader has to do, as constants: software GL would do the rest as well."""
        p = self.params
        colouring = p.field("colouring").uniform(p.colouring)
        return (f"const int COLOURING = {colouring};\nconst bool WIREFRAME = {str(p.wireframe).lower()};\n"
                f"const bool ONE_CASE = {str(p.case >= 0).lower()};\n")

    @property
    def has_field(self) -> bool:
        """Whether there is anything to sample: a formula, or a volume that was chosen."""
        return self.params.source == "formula" or self.volume is not None

    @property
    def level(self) -> float:
        """The level as the GPU has it, in single precision."""
        return float(np.float32(self.params.level))

    # Making the surface

    def prepare(self) -> None:
        wanted = self.wanted()
        if wanted != self.made:
            self.made = None
            self.make()
            self.made = wanted
        self.describe()
        self.set_up_card()

    def wanted(self) -> Hashable:
        """Everything that the surface depends on."""
        p = self.params
        moment = self.time if p.source == "formula" and "t" in p.formula.variables else 0.0
        numbers = tuple(p.numbers(p.formula).items())
        return (p.formula.text, numbers, moment, p.level, p.resolution, p.extent, p.method, p.topology, p.jumps,
                p.view == "compare", p.colouring == "curvature", p.walk,
                self.samples.generation, self.surface.generation, self.other.generation)

    def make(self) -> None:
        """Sample the field, and make the surface or, for a comparison, two."""
        p, level = self.params, self.level
        if p.source == "formula":
            n, reach = p.resolution, p.extent
            lattice = Lattice((n + 1,) * 3, (-reach,) * 3, (2.0 * reach / n,) * 3)
            self.function = self.quick_function(lattice)
            if self.function:
                self.samples.compute(self.function, lattice, level)
            else:
                self.samples.evaluate(lattice, level)
        elif self.volume:
            nz, ny, nx = self.volume.values.shape
            lattice = Lattice((nx, ny, nz), (0.0, 0.0, 0.0), self.volume.spacing)
            self.samples.fill(self.volume.values, lattice, level)
        else:
            return
        self.extract(self.surface, p.method)
        if p.view == "compare":
            self.extract(self.other, self.other_method)
        self.inspector.mark_gaps(self.box)

    @property
    def other_method(self) -> str:
        """The method that is not chosen."""
        return "tetrahedra" if self.params.method == "cubes" else "cubes"

    def shown(self) -> list[tuple[str, Isosurface, float]]:
        """The surfaces that are drawn: their method, mesh, and how far aside they stand."""
        if self.params.view != "compare":
            return [(self.params.method, self.surface, 0.0)]
        meshes, apart = {self.params.method: self.surface, self.other_method: self.other}, APART * self.squeeze
        return [("cubes", meshes["cubes"], -apart), ("tetrahedra", meshes["tetrahedra"], apart)]

    def quick_function(self, lattice: Lattice) -> FieldFunction | None:
        """The formula for NumPy, where it is at its place sooner than a shader is compiled; None for the GPU's part."""
        p = self.params
        function = FieldFunction(p.formula, tuple(p.numbers(p.formula).items()))
        stands = "t" not in p.formula.variables and p.colouring != "curvature"
        return function if stands and function.is_quick(lattice.count) else None

    def extract(self, mesh: Isosurface, method: str) -> None:
        """Make one surface of the samples."""
        p = self.params
        wanted = Wanted(self.level, method, cut_jumps=p.source == "formula" and p.jumps == "cut",
                        curvature=p.colouring == "curvature", in_order=p.walk, function=self.function)
        if method == "cubes" and p.topology == "trilinear":
            mesh.take(lambda: trilinear_surface(self.samples.host_values.T, wanted.level), wanted)
        else:
            mesh.extract(wanted)

    @property
    def box(self) -> GridBox:
        """Where the grid stands in the world."""
        lattice = self.samples.lattice
        return GridBox(lattice.samples, lattice.corner, lattice.step,
                       0.68 * self.squeeze if self.params.view == "compare" else 1.0)

    @property
    def squeeze(self) -> float:
        """How much smaller two surfaces are beside each other where the picture is narrow."""
        return min(1.0, max(1.0, self.aspect) / 1.22)

    def describe(self) -> None:
        """Tell the shaders where everything is."""
        box = self.box
        for program in self.programs:
            self.samples.describe_to(program)
            program["u_slice_reach"] = tuple(box.reach)
            program["u_world_middle"], program["u_world_scale"] = tuple(box.middle), box.scale
            program["u_world_offset"] = (0.0, 0.0, 0.0)
            program["u_surface_level"] = self.level
            program["u_places"], program["u_normals"], program["u_values"] = PLACES, NORMALS, VALUES
            program["u_painted_side"] = self.params.source == "formula"

    # Drawing

    def draw(self) -> None:
        if self.params.view == "cases":
            return
        self.samples.values.use(VALUES)
        for method, mesh, aside in self.shown():
            self.draw_surface(method, mesh, aside)
        if self.params.slice != "none" and self.has_field:
            self.slice_square.render(vertices=4)

    def turns_with_camera(self) -> bool:
        return bool(self.params.view == "compare")

    def only_outside_seen(self) -> bool:
        """Whether a closed surface hides its inner side: the eye is beside the grid, and nothing is cut away."""
        return bool(np.linalg.norm(self.eye) > FAR_OFF and self.params.slice == "none" and not self.params.walk)

    def draw_surface(self, method: str, mesh: Isosurface, aside: float) -> None:
        """Draw one surface; in a walk, as far as that has come."""
        count = mesh.count
        if self.params.walk and self.params.view == "surface" and mesh.found.cells.size:
            count = 3 * int(np.searchsorted(mesh.found.owners, self.walked_to() + 1))
        if not count:
            return
        mesh.bind(PLACES, NORMALS)
        array = (self.wired if self.params.wireframe else self.smooth)[mesh]
        array.closed = mesh.closed and self.only_outside_seen()
        array.program["u_world_offset"] = tuple(aside * self.view[:3, 0])        # as the camera sees it
        array.program["u_method_drawn"] = int(method == "tetrahedra")
        self.gpu.context.enable_direct(CLIP_DISTANCE)
        array.render(vertices=count)
        self.gpu.context.disable_direct(CLIP_DISTANCE)

    def draw_over(self) -> None:
        self.inspector.draw(marks=self.params.marks and self.params.is_active("marks"))

    def color_scale(self) -> ColorScale | None:
        p = self.params
        if p.view == "cases":
            return None
        if p.slice != "none":
            return ColorScale("value, less the level", -p.slice_range, p.slice_range)
        if p.colouring == "curvature":
            return ColorScale("mean curvature", -p.curvature_scale, p.curvature_scale)
        if p.colouring == "difference":
            return ColorScale("to the other method", 0.0, p.difference_scale, " cells")
        return None

    # Cells: the microscope, the walk, the sheet

    def walked_to(self) -> int:
        """The place, among the cells that the surface runs through, that the walk has come to."""
        return min(int(self.time * self.params.cells_per_second + 1e-6), len(self.surface.found.cells) - 1)

    def chosen_cell(self) -> tuple[int, int, int] | None:
        """The cell under the microscope, by the sample at its lowest corner; None where there is none."""
        if self.params.view != "surface" or not self.has_field:
            return None
        if self.params.walk and len(self.surface.found.cells):
            number = self.surface.found.cells[[self.walked_to()]]
            x, y, z = self.samples.lattice.grid.coordinates(number)[0].tolist()
            return x, y, z
        if not self.params.cell.strip():
            return None
        x, y, z = (int(part) for part in self.params.cell.split(","))
        return (x, y, z) if self.box.holds_cell((x, y, z)) else None

    def set_up_card(self) -> None:
        """Lay out the microscope or the sheet, where one is wanted."""
        p, chosen = self.params, self.chosen_cell()
        look = cell_cards.Look(self.view, self.aspect, p.color, p.method == "tetrahedra")
        if p.view == "cases":
            self.inspector.sheet(p.case, look, self.made)
        elif chosen:
            name = "Cell {}, {}, {}".format(*chosen)
            if p.walk and len(self.surface.found.cells):
                name += f"   ({self.walked_to() + 1} of {len(self.surface.found.cells)})"
            self.inspector.microscope(chosen, name, self.level, look, self.box, self.made,
                                      trilinear=p.topology == "trilinear" and not look.tetrahedra)
        else:
            self.inspector.clear()

    def middle(self) -> tuple[float, float]:
        return cell_cards.room_for_card(self.aspect) if self.chosen_cell() else (0.0, 0.0)

    def labels(self) -> Sequence[Label]:
        if self.params.view != "compare":
            return self.inspector.labels()
        return [self.caption(method, mesh.count // 3, aside) for method, mesh, aside in self.shown()]

    def caption(self, method: str, triangles: int, aside: float) -> Label:
        """What stands under one of two surfaces."""
        x, y, z = (float(along) for along in aside * self.view[:3, 0] - (0.0, 1.0, 0.0))
        words = f"{method}\n{triangles:,} triangles".replace(",", "\u2009")
        return Label(words, (x, y, z), 1.1 * min(1.0, self.aspect), plate="#f4f2edd8", bold=True)

    def click(self, click: Click) -> Mapping[str, object]:
        card, p = self.inspector.card, self.params
        if p.view == "cases" and card:
            case = cell_cards.case_at(card, click.place, click.aspect)
            return {"case": -1 if case is None or case == p.case else case}
        if p.view != "surface" or p.walk or (card and card.covers(click.place)):
            return {}
        cut = None if p.slice == "none" else ("xyz".index(p.slice), p.slice_at)
        found = self.inspector.cell_under(*self.box.ray(click.origin, click.direction), cut)
        return {"cell": "" if found is None else "{},{},{}".format(*found)}

    # What it tells

    def geometry(self) -> Geometry:
        vertices, triangles, normals = self.surface.mesh()
        return {"vertices": vertices, "triangles": triangles, "normals": normals}

    def measure(self) -> Measurements:
        vertices, triangles, _ = self.surface.mesh()
        numbers = mesh_numbers(vertices, triangles)._asdict()
        if self.params.source == "volume":
            numbers["volume"] = abs(numbers["volume"])      # in a volume, what is solid is often what is above
        return {
            **numbers, "active_cells": len(self.surface.cases()), "ambiguous_faces": self.surface.ambiguous_faces(),
            "jumps": self.surface.jumps, "evaluate_ms": self.samples.evaluate_ms,
            "extract_ms": self.surface.extract_ms, **self.comparison(), **self.inspector.tables()}

    def comparison(self) -> Mapping[str, Table]:
        """Both methods beside each other."""
        if self.params.view != "compare":
            return {}
        return {"comparison": Table(("method", "triangles", "vertices", "ms"), [
            (method, mesh.count // 3, mesh.vertex_count, round(mesh.extract_ms, 2))
            for method, mesh, _ in self.shown()])}

    def remarks(self) -> Sequence[str]:
        p, found = self.params, []
        if not self.has_field:
            return ["Choose a volume: a file of samples, NumPy or NRRD."]
        if not self.surface.count:
            what = "The function" if p.source == "formula" else "The volume"
            found.append(surface_words.about_emptiness(self.samples.host_values, p.level, what))
        found += surface_words.about_gaps(self.surface.jumps, self.samples.without_value, self.samples.lattice.count)
        if p.cell.strip() and p.view == "surface" and not p.walk and not self.chosen_cell():
            last = ",".join(str(count - 2) for count in self.samples.lattice.samples)
            found.append(f"Cell {p.cell} is outside the grid: 0,0,0 to {last}.")
        return found


def case_classes_glsl() -> str:
    """Which of the 15 kinds each of the 256 cases is."""
    return f"const int case_classes[256] = int[]({', '.join(map(str, cell_model.case_classes()))});\n"
