"""Surfaces made on the GPU against the pure kit, against closed forms, and at the limits of what fits."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from types import SimpleNamespace

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from viewer import FieldSamples, Gpu, Isosurface, Lattice, Parameters, Wanted, formula, formula_include
from viewer.engine.catalog import Catalog
from viewer.engine.frame import FrameBlock
from viewer.engine.gpu import GpuError
from viewer.kit.marching import marching_cubes

Numbers = NDArray[np.float64]
VOLUME_FIELD = '#include "isosurface/volume_field.glsl"\n'
FORMULA_FIELD = ("float field(vec3 place) { return f(place); }\n"
                 "vec3 field_gradient(vec3 place) { return f_gradient(place); }\n")
TANGLE = "16*(x^4 + y^4 + z^4) - 20*(x^2 + y^2 + z^2) + 11.8"
BALL = "x^2 + y^2 + z^2 - 0.9"
TIME = 0.7


class Params(Parameters):
    f = formula("x", "The field")


class Bench:
    """A formula, its samples and its surface, in an arena of their own; without a formula, a volume."""

    def __init__(self, context: moderngl.Context, text: str | None, **numbers: float) -> None:
        self.gpu = Gpu(context, Catalog().find("marching_cubes").shaders)
        self.params = Params()
        self.retype(text or "x", **numbers)
        self.samples = FieldSamples(self.gpu, self.include if text else None)
        self.surface = Isosurface(self.gpu, self.samples, self.include if text else lambda: VOLUME_FIELD)

    def include(self) -> str:
        return formula_include(self.params, "f") + FORMULA_FIELD

    def retype(self, text: str, **numbers: float) -> None:
        self.params.update({"f": text, **numbers})
        self.gpu.share(self.params)
        assert self.gpu.refresh() is None

    def extract(self, lattice: Lattice, level: float = 0.0, **wanted: object) -> Bench:
        self.samples.evaluate(lattice, level)
        self.surface.extract(Wanted(level, **wanted))  # type: ignore[arg-type]
        return self

    def fill(self, values: NDArray[np.float32], step: tuple[float, float, float], level: float = 0.0) -> Bench:
        """Extract from values (nx, ny, nz)."""
        turned = np.ascontiguousarray(values.T)
        self.samples.fill(turned, Lattice(values.shape, (0.0, 0.0, 0.0), step), level)  # type: ignore[arg-type]
        self.surface.extract(Wanted(level))
        return self

    def values(self) -> NDArray[np.float32]:
        """The samples, (nx, ny, nz)."""
        return self.samples.read_all().transpose()

    def bend(self) -> NDArray[np.float32]:
        """The fourth component of the normals: the mean curvature."""
        texels = np.frombuffer(self.surface.vertices.normals.read(), np.float32)
        return texels.reshape(-1, 4)[:self.surface.vertex_count, 3]

    def evaluated(self, places: Numbers, derivative: str | None = None) -> Numbers:
        """The formula or one of its slopes at ``places`` (n, 3), in double precision, by NumPy."""
        typed = self.params.f
        numbers = self.params.numbers(typed)
        wanted = typed.gradient()[derivative] if derivative else typed
        x, y, z = places.T
        return np.broadcast_to(np.asarray(wanted.evaluate(x=x, y=y, z=z, t=TIME, **numbers), np.float64), len(places))


MakeBench = Callable[..., Bench]


@pytest.fixture
def bench(context: moderngl.Context) -> Iterator[MakeBench]:
    """Makes benches at a time that is not zero, and frees them."""
    made: list[Bench] = []
    frame = FrameBlock(context)
    frame.write({"time": TIME})
    frame.bind()

    def make(text: str | None = None, **numbers: float) -> Bench:
        made.append(Bench(context, text, **numbers))
        return made[-1]

    yield make
    for one in made:
        one.gpu.release()
    made.clear()
    frame.release()


def lattice(shape: tuple[int, int, int], reach: float = 1.3) -> Lattice:
    """``shape`` samples from minus to plus ``reach`` along x, and not quite so far along y and z."""
    sides = np.array([1.0, 0.9, 0.8]) * 2 * reach
    x, y, z = (sides / (np.array(shape) - 1)).tolist()
    return Lattice(shape, tuple((-0.5 * sides).tolist()), (x, y, z))  # type: ignore[arg-type]


def places(grid: Lattice) -> Numbers:
    """Where the samples are, (nx, ny, nz, 3)."""
    axes = [corner + step * np.arange(count) for corner, step, count in
            zip(grid.corner, grid.step, grid.samples, strict=True)]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)


def by_the_kit(one: Bench, level: float = 0.0, method: str = "cubes") -> tuple[Numbers, NDArray[np.int32]]:
    """What the pure kit makes of the same samples, in the field's own space."""
    grid = one.samples.lattice
    vertices, triangles = marching_cubes(one.values(), level, grid.step, method)
    return vertices + np.array(grid.corner), triangles


def assert_as_by_the_kit(one: Bench, level: float = 0.0, method: str = "cubes") -> None:
    vertices, triangles, normals = one.surface.mesh()
    expected_vertices, expected_triangles = by_the_kit(one, level, method)
    assert len(triangles) and np.array_equal(triangles, expected_triangles)
    assert vertices.dtype == np.float32 and np.abs(vertices - expected_vertices).max() < 1e-5
    assert normals.shape == vertices.shape


SHAPES = [(9, 12, 7), (16, 16, 16), (3, 33, 10), (13, 5, 64)]
FORMULAS = {
    TANGLE: {}, "sin(k*x)*cos(k*y) + sin(k*y)*cos(k*z) + sin(k*z)*cos(k*x) - shift": {"k": 2.5, "shift": 0.2},
    "noise(2*x + 0.1, 2*y, 2*z + 0.3) - 0.05*z": {}, "length(x - 0.4*t, y, z) - 0.8": {}}


@pytest.mark.parametrize("method", ["cubes", "tetrahedra"])
@pytest.mark.parametrize("text", FORMULAS)
def test_the_mesh_is_the_kit_s(bench: MakeBench, text: str, method: str) -> None:
    """The same triangles of the same vertices from the same samples, which are the formula's values."""
    one = bench(text, **FORMULAS[text])
    for shape in SHAPES:
        grid = lattice(shape)
        one.extract(grid, 0.125, method=method, cut_jumps=True)
        exact = one.evaluated(places(grid).reshape(-1, 3)).reshape(shape)
        assert np.allclose(one.values(), exact, atol=2e-5, rtol=1e-5)
        assert one.surface.jumps == 0
        assert_as_by_the_kit(one, 0.125, method)


@pytest.mark.parametrize("text", FORMULAS)
def test_normals_are_the_exact_gradient(bench: MakeBench, text: str) -> None:
    """Of length one, towards larger values."""
    vertices, _, normals = bench(text, **FORMULAS[text]).extract(lattice((17, 20, 18))).surface.mesh()
    one = bench(text, **FORMULAS[text])
    slope = np.stack([one.evaluated(vertices.astype(np.float64), axis) for axis in "xyz"], axis=1)
    expected = slope / np.linalg.norm(slope, axis=1, keepdims=True)
    assert len(vertices) > 200
    assert np.abs(normals - expected).max() < 1e-3


@pytest.mark.parametrize("radius", [0.4, 0.75, 1.0])
@pytest.mark.parametrize(("text", "sign"), [("length(x, y, z) - r", 1), ("r - length(x, y, z)", -1),
                                            ("x^2 + y^2 + z^2 - r^2", 1)])
def test_a_sphere_bends_by_one_over_its_radius(bench: MakeBench, radius: float, text: str, sign: int) -> None:
    """Positive where the inside bulges out, whatever the field is like off the surface."""
    one = bench(text, r=radius).extract(lattice((24, 24, 24)), curvature=True)
    vertices, _, _ = one.surface.mesh()
    assert np.allclose(one.bend(), sign / np.linalg.norm(vertices, axis=1), rtol=0.01)
    assert np.all(one.extract(lattice((24, 24, 24))).bend() == 0.0)        # not asked for


def test_a_torus_bends_as_its_closed_form_says(bench: MakeBench) -> None:
    """Half the sum of the two curvatures, that of the tube and that around the axis, which changes its sign."""
    one = bench("length(length(x, y) - 0.8, z) - 0.5").extract(lattice((33, 33, 25), 1.4), curvature=True)
    x, y, z = one.surface.mesh()[0].astype(np.float64).T
    around, tube = np.hypot(x, y), np.hypot(np.hypot(x, y) - 0.8, z)
    expected = 0.5 * (1 / tube + (around - 0.8) / tube / around)
    assert expected.min() < 0.0 < 1.0 < expected.max()
    assert np.allclose(one.bend(), expected, atol=0.02)


# Where a field jumps: a formula, a level, and the x at which it does.
JUMPS = [
    ("1/(x - 0.013)", 0.0, [0.013]), ("tan(3*x)", 0.1, [-np.pi / 6, np.pi / 6]), ("floor(3*x)", 0.5, [1 / 3]),
    ("floor(2*x) + 0.5", 0.0, [0.0]), ("sign(x - 0.01)", 0.0, [0.01]), ("1 if x > 0.21 else -3", 0.0, [0.21]),
    ("1e-6/(x - 0.4)", 0.0, [0.4]), ("1e6*sign(x + 0.7) + y", 0.0, [-0.7]),
    ("fract(x + 0.29) - 0.5", 0.0, [-1.29, -0.29, 0.71]),
]


def edges_across(grid: Lattice, method: str) -> int:
    """How many edges of the grid go through a plane of constant x between samples, from the grid's shape alone."""
    _, ny, nz = grid.samples
    return ny * nz if method == "cubes" else ny * nz + (ny - 1) * nz + ny * (nz - 1) + (ny - 1) * (nz - 1)


@pytest.mark.parametrize("method", ["cubes", "tetrahedra"])
@pytest.mark.parametrize(("text", "level", "planes"), JUMPS)
def test_jumps_are_cut_and_counted(bench: MakeBench, text: str, level: float, planes: list[float],
                                   method: str) -> None:
    """Every edge across a pole or a step, and no triangle in the cells there; all the others stay."""
    grid = lattice((20, 7, 6))
    one = bench(text).extract(grid, level, method=method, cut_jumps=True)
    assert one.surface.jumps == len(planes) * edges_across(grid, method)
    vertices, triangles, _ = one.surface.mesh()
    kept, whole = by_the_kit(one, level, method)
    column = np.floor((kept[whole].mean(axis=1)[:, 0] - grid.corner[0]) / grid.step[0])
    torn = [np.ceil((plane - grid.corner[0]) / grid.step[0]) - 1 for plane in planes]
    expected = kept[whole[~np.isin(column, torn)]]
    assert vertices[triangles].shape == expected.shape
    assert np.allclose(vertices[triangles], expected, atol=1e-5)
    assert len(expected) < len(whole)
    one.surface.extract(Wanted(level, method))                              # nothing cut
    assert one.surface.jumps == 0
    assert_as_by_the_kit(one, level, method)


@pytest.mark.parametrize("text", [
    "tanh(200*x)", "tanh(200*(x - 0.013))", "cbrt(x)", "cbrt(x - 0.013)", "atan(1e4*x)", "atan(1e4*(x - 0.013))",
    "sqrt(abs(x - 0.1))*sign(x - 0.1)", "1e6*x", "1e-9*(x - 0.2)", "(x - 0.3)^5", "max(x - 0.3, 40*(x - 0.3))",
    "atan2(x - 0.013, y + 9)", "exp(30*x) - 1"])
@pytest.mark.parametrize("shape", [(9, 5, 5), (64, 5, 5)])
def test_what_is_steep_but_continuous_is_not_cut(bench: MakeBench, text: str, shape: tuple[int, int, int]) -> None:
    """However fast it goes through the level."""
    one = bench(text).extract(lattice(shape), cut_jumps=True)
    assert one.surface.jumps == 0 and len(one.surface.found.crossings) == 25
    assert_as_by_the_kit(one)


def test_zeros_next_to_a_pole_stay(bench: MakeBench) -> None:
    """The zero of a product is kept, its other factor's pole is cut, in the same grid."""
    grid = lattice((10, 13, 7))
    one = bench("(x - 0.05)*(1/(y - 0.3))").extract(grid, cut_jumps=True)
    assert one.surface.jumps == 10 * 7
    vertices, triangles, _ = one.surface.mesh()
    assert len(triangles) == 2 * (13 - 2) * 6                               # a wall but for the cells at the pole
    at_pole = np.floor((0.3 - grid.corner[1]) / grid.step[1])
    assert not np.any(np.floor((vertices[triangles].mean(axis=1)[:, 1] - grid.corner[1]) / grid.step[1]) == at_pole)
    assert np.allclose(vertices[:, 0], 0.05, atol=1e-4)


def test_gaps_are_the_torn_cells(bench: MakeBench) -> None:
    """One beside the other along the pole, once each."""
    grid = lattice((20, 7, 6))
    one = bench("1/(x - 0.013)").extract(grid, cut_jumps=True)
    cells = grid.grid.coordinates(one.surface.gaps())
    column = int((0.013 - grid.corner[0]) / grid.step[0])
    assert sorted(map(tuple, cells.tolist())) == [(column, j, k) for j in range(6) for k in range(5)]
    assert not len(bench(BALL).extract(grid, cut_jumps=True).surface.gaps())


def test_a_jump_tears_all_cells_around_it(bench: MakeBench) -> None:
    """Where a pole is a disc, the four cells around each of its edges go, and no others."""
    grid = lattice((14, 15, 13))
    one = bench("1/(x - 0.013) if length(y, z) < 0.5 else x - 0.013").extract(grid, cut_jumps=True)
    column = int((0.013 - grid.corner[0]) / grid.step[0])
    jumping = np.linalg.norm(places(grid)[column, :, :, 1:], axis=-1) < 0.5
    torn = jumping[:-1, :-1] | jumping[1:, :-1] | jumping[:-1, 1:] | jumping[1:, 1:]
    assert one.surface.jumps == jumping.sum() and 10 < torn.sum() < torn.size
    cells = grid.grid.coordinates(one.surface.gaps())
    assert sorted(map(tuple, cells.tolist())) == [(column, j, k) for j, k in np.argwhere(torn).tolist()]
    assert one.surface.count // 3 == 2 * (~torn).sum()


@pytest.mark.parametrize("method", ["cubes", "tetrahedra"])
@pytest.mark.parametrize("text", [
    "log(x + 0.4) + 0.2*y", "sqrt(0.5 - y) - 0.6 + 0.1*x", "1/x", "log(abs(x)) + y + 1", "x/(x - x + (y > 0.2))",
    "exp(200*x) - 3"])
def test_samples_without_a_value(bench: MakeBench, text: str, method: str) -> None:
    """NaN and infinite ones count as such, and leave what they leave in the kit."""
    one = bench(text).extract(lattice((11, 12, 9)), method=method, cut_jumps=True)
    lacking = ~np.isfinite(one.values())
    assert 0 < lacking.sum() == one.samples.without_value < lacking.size
    assert np.array_equal(one.samples.sides == 2, lacking.T)
    vertices, triangles, normals = one.surface.mesh()
    expected, expected_triangles = by_the_kit(one, 0.0, method)
    assert np.array_equal(triangles, expected_triangles) and np.allclose(vertices, expected, atol=1e-5)
    assert np.isfinite(vertices).all() and np.isfinite(normals).all()
    assert one.surface.jumps == 0                                           # having no value is no jump


def test_a_volume_without_a_value_here_and_there(bench: MakeBench) -> None:
    """The same of a filled field, and nothing at all where no sample is finite."""
    chance = np.random.default_rng(4)
    values = chance.normal(size=(9, 10, 8)).astype(np.float32)
    values[chance.random(values.shape) < 0.03] = np.nan
    values[2, 3, 4], values[5, 5, 5] = np.inf, -np.inf
    one = bench().fill(values, (1.0, 0.5, 2.0))
    assert np.array_equal(one.values(), values, equal_nan=True)
    assert one.samples.without_value == (~np.isfinite(values)).sum()
    assert_as_by_the_kit(one)
    assert not bench().fill(np.full((4, 4, 4), np.nan, np.float32), (1.0, 1.0, 1.0)).surface.count


@pytest.mark.parametrize("method", ["cubes", "tetrahedra"])
def test_triangles_cell_after_cell(bench: MakeBench, method: str) -> None:
    """In order their owners ascend and hold them; the triangles are the same."""
    grid = lattice((12, 14, 9))
    one = bench(TANGLE)
    plain = one.extract(grid, method=method).surface.mesh()[1]
    one.extract(grid, method=method, in_order=True)
    vertices, triangles, _ = one.surface.mesh()
    owners, cells = one.surface.found.owners, grid.grid.coordinates(one.surface.found.cells)
    assert np.all(np.diff(owners) >= 0) and owners[-1] == len(cells) - 1
    assert np.all(np.diff(cells[:, ::-1] @ [14 * 12, 12, 1]) > 0)           # x fastest
    middles = (vertices[triangles].mean(axis=1) - np.array(grid.corner)) / np.array(grid.step)
    assert np.array_equal(np.floor(middles), cells[owners])
    assert sorted(map(tuple, triangles.tolist())) == sorted(map(tuple, plain.tolist()))


def test_the_cases_and_faces_are_counted_right(bench: MakeBench) -> None:
    """Each cell's case and the ambiguous faces, one by one from the samples."""
    one = bench("sin(5*x)*sin(5*y)*sin(5*z) - 0.05").extract(lattice((10, 11, 9)))
    inside = one.values() < 0
    corners = np.stack([inside[i:, j:, k:][:9, :10, :8] for k in (0, 1) for j in (0, 1) for i in (0, 1)])
    cases = (corners * 2 ** np.arange(8)[:, None, None, None]).sum(axis=0).transpose().ravel()
    assert np.array_equal(one.surface.cases(), cases[(cases > 0) & (cases < 255)])
    ambiguous = 0
    for axis in range(3):
        face = np.moveaxis(inside, axis, 0)
        a, b, c, d = face[:, :-1, :-1], face[:, 1:, :-1], face[:, 1:, 1:], face[:, :-1, 1:]
        ambiguous += int(((a == c) & (b == d) & (a != b)).sum())
    assert one.surface.ambiguous_faces() == ambiguous > 0


def test_a_volume_s_normals_are_central_differences(bench: MakeBench) -> None:
    """Between the samples in proportion; at the border, one-sided: as np.gradient has them."""
    shape, step = (8, 9, 7), (0.5, 1.0, 2.0)
    values = np.random.default_rng(8).normal(size=shape).astype(np.float32)
    vertices, _, normals = bench().fill(values, step).surface.mesh()
    slopes = np.stack(np.gradient(values.astype(np.float64), *step), axis=-1)
    s = vertices / np.array(step)
    low = np.minimum(np.floor(s + 1e-6).astype(int), np.array(shape) - 1)
    high = np.minimum(np.ceil(s - 1e-6).astype(int), np.array(shape) - 1)
    assert np.array_equal(np.abs(high - low).sum(axis=1), np.ones(len(s)))  # each on an edge
    t = np.abs(s - low).max(axis=1, keepdims=True)
    slope = (1 - t) * slopes[tuple(low.T)] + t * slopes[tuple(high.T)]
    size = np.linalg.norm(slope, axis=1, keepdims=True)
    expected, clear = slope / size, size[:, 0] > 0.05
    assert clear.sum() > 500 and np.abs(normals - expected)[clear].max() < 5e-3


def test_a_surface_made_elsewhere_is_taken_over(bench: MakeBench) -> None:
    """Its triangles as they are or cell after cell, its vertices where they were, with the field's normals."""
    grid = lattice((12, 10, 14))
    one = bench(BALL).extract(grid)
    made = marching_cubes(one.values(), topology="trilinear")
    triples = made[0].astype(np.float64), made[1]
    one.surface.take(lambda: triples, Wanted(0.0, curvature=True))
    vertices, triangles, normals = one.surface.mesh()
    assert np.array_equal(triangles, made[1])
    assert np.allclose(vertices, made[0] * np.array(grid.step) + np.array(grid.corner), atol=1e-5)
    assert np.allclose(normals, vertices / np.linalg.norm(vertices, axis=1, keepdims=True), atol=1e-4)
    assert np.allclose(one.bend(), 1 / np.linalg.norm(vertices, axis=1), rtol=0.01)
    one.surface.take(lambda: triples, Wanted(0.0, in_order=True))
    found, triangles = one.surface.found, one.surface.mesh()[1]
    middles = (vertices[triangles].mean(axis=1) - np.array(grid.corner)) / np.array(grid.step)
    assert np.all(np.diff(found.owners) >= 0)
    assert np.array_equal(np.floor(middles), grid.grid.coordinates(found.cells)[found.owners])


def test_growing_and_shrinking_leaves_nothing_behind(bench: MakeBench) -> None:
    """Larger and smaller grids in turn: as many objects as at first, and the surfaces that fresh ones give."""
    one = bench(TANGLE)
    owned = set()
    for n in (5, 40, 9, 64, 6, 72, 40, 72):
        grid = lattice((n, n + 3, n - 2))
        one.extract(grid, method="tetrahedra" if n == 64 else "cubes")
        owned.add(len(one.gpu._owned))
        if n < 64:
            fresh = bench(TANGLE).extract(grid)
            for mine, theirs in zip(one.surface.mesh(), fresh.surface.mesh(), strict=True):
                assert np.array_equal(mine, theirs)
    assert len(owned) == 1
    assert_as_by_the_kit(one)


@pytest.mark.parametrize(("shape", "available", "message"), [
    ((1024, 1024, 1024), 2**60, r"^1024 x 1024 x 1024 samples need 16\.00 GiB; 2\.00 GiB are to be had$"),
    ((513, 512, 600), 2**60, r"^513 x 512 x 600 samples need 2\.35 GiB; 2\.00 GiB are to be had$"),
    ((200, 201, 202), 2**24, r"^200 x 201 x 202 samples need 0\.12 GiB; 0\.02 GiB are to be had$")])
def test_too_many_samples_are_refused_beforehand(bench: MakeBench, monkeypatch: pytest.MonkeyPatch,
                                                 shape: tuple[int, int, int], available: int, message: str) -> None:
    """By name and number, before anything is made or given up; the surface that was there stays."""
    grid = lattice((12, 13, 11))
    one = bench(BALL).extract(grid)
    before = one.surface.mesh()
    values = one.values()

    def made(*_: object, **__: object) -> None:
        raise AssertionError("something was made")

    with monkeypatch.context() as patched:
        for name in ("texture", "framebuffer", "buffer", "discard"):
            patched.setattr(one.gpu, name, made)
        patched.setattr("psutil.virtual_memory", lambda: SimpleNamespace(available=available))
        with pytest.raises(GpuError, match=message):
            one.samples.evaluate(Lattice(shape, (0.0, 0.0, 0.0), (1.0, 1.0, 1.0)), 0.0)
    assert one.samples.lattice == grid and np.array_equal(one.values(), values)
    assert all(np.array_equal(mine, theirs) for mine, theirs in zip(one.surface.mesh(), before, strict=True))
    assert_as_by_the_kit(one.extract(grid))


def test_a_grid_beyond_the_texture_limit_is_refused(bench: MakeBench, monkeypatch: pytest.MonkeyPatch) -> None:
    """Naming the grid, the texture and the limit; what fits goes on."""
    grid = lattice((12, 13, 11))
    one = bench(BALL).extract(grid)
    monkeypatch.setattr(one.gpu, "_largest_texture", 64)
    message = r"^a grid of 17 x 18 x 19 samples, in a texture of 68x86 is outside 1x1 to 64x64, what this GPU takes$"
    with pytest.raises(GpuError, match=message):
        one.samples.evaluate(lattice((17, 18, 19)), 0.0)
    assert one.samples.lattice == grid
    assert_as_by_the_kit(one.extract(grid))


def test_a_surface_beyond_the_texture_limit_is_refused(bench: MakeBench, monkeypatch: pytest.MonkeyPatch) -> None:
    """However often it is tried; a smaller one is made as ever, and so is a large one once it fits."""
    grid, crumbs = lattice((15, 16, 14)), "sin(900*x + 11)*sin(700*y + 1)*sin(800*z + 2)"
    one = bench(BALL)
    for _ in range(2):
        assert_as_by_the_kit(one.extract(grid))
        one.retype(crumbs)
        one.samples.evaluate(grid, 0.0)
        with monkeypatch.context() as patched:
            patched.setattr(one.gpu, "_largest_texture", 8)
            for _ in range(2):
                with pytest.raises(GpuError, match=r"^the surface has [\d,]+ vertices, .* at most 5,529 fit"):
                    one.surface.extract(Wanted(0.0, "tetrahedra"))
        one.retype(BALL)
    one.retype(crumbs)
    assert_as_by_the_kit(one.extract(grid, method="tetrahedra"), method="tetrahedra")


def test_discarded_objects_are_gone_and_others_stay(context: moderngl.Context, bench: MakeBench) -> None:
    """Freed at once, once; whoever made them forgets them; the framebuffer that was bound may be one."""
    gpu = bench(BALL).gpu
    kept, texture = gpu.texture((4, 4), 4, label="kept"), gpu.texture((4, 4), 4, label="gone")
    target = gpu.framebuffer([texture], label="target")
    target.use()
    before = len(gpu._owned)
    gpu.discard(target, texture)
    assert len(gpu._owned) == before - 2
    assert isinstance(texture.mglo, moderngl.InvalidObject) and isinstance(target.mglo, moderngl.InvalidObject)
    kept.write(np.full(64, 7, np.uint8))
    assert set(kept.read()) == {7}
    assert context.error == "GL_NO_ERROR"
    with pytest.raises(ValueError):
        gpu.discard(texture)
