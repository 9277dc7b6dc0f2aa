"""Other ways from a function to a mesh with normals, each as a function to call again and again.

Each computes the values anew, at every sample, from coordinates that are given.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tests.benchmarks.tangle import REACH, TANGLE, by_hand

Axes = tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.float32]]


def coordinates(cells: int, *, along_lines: bool = False) -> Axes:
    """z, y and x of the samples; ``along_lines`` as arrays that broadcast."""
    axis = np.linspace(-REACH, REACH, cells + 1, dtype=np.float32)
    z, y, x = np.meshgrid(axis, axis, axis, indexing="ij", sparse=along_lines)
    return z, y, x


def flying_edges(cells: int) -> Callable[[], Any]:
    """numexpr, and VTK's flying edges."""
    import numexpr
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonDataModel import vtkImageData
    from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D

    z, y, x = coordinates(cells)
    step = 2.0 * REACH / cells
    expression = TANGLE.replace("^", "**")

    def run() -> Any:
        values = numexpr.evaluate(expression, local_dict={"x": x, "y": y, "z": z})
        image = vtkImageData(dimensions=(cells + 1,) * 3, spacing=(step,) * 3, origin=(-REACH,) * 3)
        image.GetPointData().SetScalars(numpy_to_vtk(values.reshape(-1)))
        surface = vtkFlyingEdges3D(compute_normals=True, compute_gradients=False, compute_scalars=False)
        surface.SetValue(0, 0.0)
        surface.SetInputData(image)
        surface.Update()
        return surface.GetOutput()

    return run


def scikit_image(cells: int, *, along_lines: bool = False) -> Callable[[], Any]:
    """NumPy, and scikit-image. This function happens to be a sum of three, of one coordinate each: NumPy can compute
    them ``along_lines``, which is no way for any function."""
    from skimage.measure import marching_cubes

    z, y, x = coordinates(cells, along_lines=along_lines)
    step = 2.0 * REACH / cells
    return lambda: marching_cubes(by_hand(x, y, z), 0.0, spacing=(step,) * 3)


def pymcubes(cells: int) -> Callable[[], Any]:
    """NumPy, and PyMCubes, which makes no normals."""
    import mcubes

    z, y, x = coordinates(cells)
    return lambda: mcubes.marching_cubes(by_hand(x, y, z), 0.0)
