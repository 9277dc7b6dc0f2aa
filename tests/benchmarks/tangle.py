"""The surface that everybody extracts, and our way to it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from viewer import FieldSamples, Gpu, Isosurface, Lattice, Wanted
from viewer.engine.catalog import Catalog
from viewer.kit.formula import glsl_vector, parse
from viewer.output.headless import shared_context

TANGLE = "x^4 - 5*x^2 + y^4 - 5*y^2 + z^4 - 5*z^2 + 11.8"
REACH = 3.0
FIELD = """
float field(vec3 p) { return tangle(p.x, p.y, p.z); }
vec3 field_gradient(vec3 p) { return tangle_gradient(p.x, p.y, p.z); }
"""


def by_hand(x: NDArray[np.float32], y: NDArray[np.float32], z: NDArray[np.float32]) -> NDArray[np.float32]:
    """The function written in NumPy."""
    xx, yy, zz = x * x, y * y, z * z
    values: NDArray[np.float32] = xx * (xx - 5) + yy * (yy - 5) + zz * (zz - 5) + np.float32(11.8)
    return values


def glsl() -> str:
    """The function and its gradient, as a scene makes them of what was typed."""
    formula = parse(TANGLE)
    slopes = [formula.gradient()[axis] for axis in "xyz"]
    return formula.glsl("tangle") + "\n" + glsl_vector("tangle_gradient", slopes, list("xyz")) + FIELD


def lattice(cells: int) -> Lattice:
    """So many cells along each axis."""
    return Lattice((cells + 1,) * 3, (-REACH,) * 3, (2.0 * REACH / cells,) * 3)


class Ours:
    """The field, its surface, and what they are made with; call it to make both anew."""

    def __init__(self, cells: int, method: str) -> None:
        self.gpu = Gpu(shared_context(), Catalog().find("marching_cubes").shaders)
        self.samples = FieldSamples(self.gpu, glsl)
        self.surface = Isosurface(self.gpu, self.samples, glsl)
        self.lattice, self.wanted = lattice(cells), Wanted(0.0, method, cut_jumps=True)

    def __call__(self) -> object:
        self.samples.evaluate(self.lattice, 0.0)
        self.surface.extract(self.wanted)
        return self.surface

    def release(self) -> None:
        """Free all of it."""
        self.gpu.release()
