"""Small grids are evaluated in NumPy, large ones on the GPU; nobody can tell by the surface."""

from __future__ import annotations

import numpy as np
import pytest

import viewer
from viewer.kit import field_function
from viewer.kit.field_function import FieldFunction
from viewer.kit.formula import parse

pytestmark = pytest.mark.usefixtures("context")
FIELDS = {
    "16*(x^4 + y^4 + z^4) - 20*(x^2 + y^2 + z^2) + 11.8": 0,
    "x^2 + y^2 + z^2 - 1 + 0.2/(x - 0.3)": 676,     # a pole in the plane x = 0.3, crossed by 26 x 26 edges
    "1/x": 676,
    "sqrt(1 - x^2 - y^2 - z^2) - 0.5": 0,           # no value outside of the unit ball, but no jump
    "floor(3*x) + 0.5 + 0*y": 676,
    "sin(5*x)*sin(5*y)*sin(5*z) + 0.1*sin(3*x + y)": 0,
    "a*x + b*y + 0.1": 0,
    "x/0 + y": 0,                                   # infinite or nothing, and so no surface
    "mod(x, 0)": 0,
}


@pytest.mark.parametrize("method", ["cubes", "tetrahedra"])
@pytest.mark.parametrize("formula", FIELDS)
def test_both_ways_give_the_same_surface(monkeypatch: pytest.MonkeyPatch, formula: str, method: str) -> None:
    """Places, triangles, normals, and what the function jumps over."""
    made = []
    for most in (field_function.QUICK_SAMPLES, 0):
        monkeypatch.setattr(field_function, "QUICK_SAMPLES", most)
        params = {"formula": formula, "resolution": 25, "method": method}
        with viewer.headless("marching_cubes", size=(32, 32), params=params) as stage:
            made.append((stage.geometry(), stage.measure()))
            assert (stage.scene.function is not None) == bool(most)  # type: ignore[attr-defined]
    (here, numbers_here), (there, numbers_there) = made
    assert np.array_equal(here["triangles"], there["triangles"])
    assert np.allclose(here["vertices"], there["vertices"], atol=3e-6)
    assert np.allclose(here["normals"], there["normals"], atol=1e-4)
    assert numbers_here["jumps"] == numbers_there["jumps"]
    if method == "cubes":
        assert numbers_here["jumps"] == FIELDS[formula]


@pytest.mark.parametrize(("formula", "samples", "quick"), [
    ("x + y", 65**3, True), ("x + y", 129**3, False), ("x + noise(x, y, z)", 65**3, True),
    ("noise(x, y, z)*noise(y, z, x)", 65**3, False),
    ("turbulence(x, y, z)", 1000, False), (" + ".join(f"sin({n}*x)" for n in range(2, 60)), 1000, False)])
def test_what_is_left_to_the_gpu(formula: str, samples: int, quick: bool) -> None:
    """Large grids, much noise, long formulas: that depends on the parameters alone, so that pictures do."""
    assert FieldFunction(parse(formula)).is_quick(samples) is quick


def test_a_steep_function_is_no_jump() -> None:
    """However steep it is, its values come together around the crossing; a step's do not."""
    starts = np.array([[-0.03, 0.0, 0.0]], np.float32)
    ends = starts + np.float32([0.05, 0.0, 0.0])
    for formula, jumps in (("tanh(200*x)", False), ("atan(1e4*x)", False), ("cbrt(x)", False),
                           ("sign(x)", True), ("1/x", True), ("tan(x + pi/2)", True)):
        function = FieldFunction(parse(formula))
        A, B = function.at(starts), function.at(ends)
        assert function.jumps(starts, ends, A, B, 0.0).tolist() == [jumps], formula


def test_values_on_a_grid_stand_where_the_gpu_has_them() -> None:
    """Indexed z, y, x."""
    function = FieldFunction(parse("x + 10*y + 100*z + a"), (("a", 0.5),))
    values = function.on_grid((3, 4, 5), (1.0, 2.0, 3.0), (0.1, 0.2, 0.3))
    assert values.shape == (5, 4, 3) and values.dtype == np.float32
    assert values[4, 3, 2] == pytest.approx(1.2 + 26.0 + 420.0 + 0.5, rel=1e-6)


@pytest.mark.parametrize("most", [field_function.QUICK_SAMPLES, 0])
def test_a_trilinear_surface_of_nothing_but_jumps_is_empty(monkeypatch: pytest.MonkeyPatch, most: int) -> None:
    """As the table's is: no cell is left."""
    monkeypatch.setattr(field_function, "QUICK_SAMPLES", most)
    params = {"formula": "1/(x - 0.01)", "resolution": 16, "topology": "trilinear", "walk": True}
    with viewer.headless("marching_cubes", size=(32, 32), params=params) as stage:
        stage.render()
        numbers = stage.measure()
        assert (numbers["triangles"], numbers["vertices"], numbers["jumps"]) == (0, 0, 289)
