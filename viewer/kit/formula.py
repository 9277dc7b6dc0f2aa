"""Formulas that a person types: f(x, y, z) with parameters, run in NumPy and in GLSL with the same meaning.

    ripple = parse("amplitude * cos(frequency * x)")
    ripple.evaluate(x=np.linspace(0, 1, 100), amplitude=0.05, frequency=10)
    ripple.glsl("height", ["x", "amplitude", "frequency"])
    str(ripple.gradient()["x"])                              # -amplitude*frequency*sin(frequency*x)

The language has numbers, names, ``+ - * / %``, ``^`` or ``**`` (a power: binds tighter than a sign and
groups to the right), comparisons (1 or 0, also in chains), ``and or not``, ``a if c else b``, parentheses
and the functions of ``formula_functions.FUNCTIONS``. Nothing that is typed is ever executed as Python.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from viewer.kit.formula_calculus import derivative
from viewer.kit.formula_complaints import shortened
from viewer.kit.formula_glsl import GlslWriter
from viewer.kit.formula_graph import Graph, Node, compute, prune
from viewer.kit.formula_syntax import Parser
from viewer.kit.formula_text import formula_text
from viewer.kit.formula_tokens import FormulaError

__all__ = ["Formula", "FormulaError", "glsl_vector", "parse"]

FloatArray = NDArray[np.floating[Any]]

BLOCK_SIZE = 1 << 15  # elements evaluated together, so that intermediate results stay in the cache


@dataclass(frozen=True)
class Formula:
    """An expression of named variables; made by ``parse`` and by ``gradient``.

    ``variables`` are all its free names, sorted.
    """

    variables: tuple[str, ...]
    nodes: tuple[Node, ...] = field(repr=False)
    source: str | None = None

    @property
    def text(self) -> str:
        """The formula as it was typed, or as it would be typed; long parts of a derivative are cut."""
        return formula_text(self.nodes) if self.source is None else self.source

    def __str__(self) -> str:
        return self.text

    def evaluate(self, /, **arrays: ArrayLike) -> FloatArray:
        """The value for given values of the variables, which broadcast; other names only lend their shape.

        The result has the common shape of everything given. It is float32 if every array used is float32,
        otherwise float64; a NumPy scalar if all are scalars. Where a function has no real value the result
        is NaN or infinite, without a warning; GLSL leaves it undefined there. Raises FormulaError for a
        variable that is missing or is no real number, and for shapes that do not fit.
        """
        shape = _common_shape(arrays)
        values = {name: _real(name, arrays[name]) for name in self._check_given(arrays)}
        dtype = _common_type(list(values.values()) or [np.asarray(array) for array in arrays.values()])
        values = {name: value.astype(dtype, copy=False) for name, value in values.items()}
        result = np.empty(shape, dtype)
        with np.errstate(all="ignore"):
            for block in _blocks(shape):
                parts = {name: _block_of(value, block, len(shape)) for name, value in values.items()}
                result[block] = _evaluate_nodes(self.nodes, parts, dtype)
        value: FloatArray = result[()] if shape == () else result
        return value

    def glsl(self, name: str, arguments: Sequence[str] | None = None) -> str:
        """Source of a GLSL 3.30 function ``float name(float ...)``.

        Its arguments are the variables in order, unless ``arguments`` names them in another order, perhaps
        with more. Formulas with noise start with a line ``#include "lib/noise.glsl"``. Raises ValueError
        if a variable is not among ``arguments`` or a name cannot be used.
        """
        return _glsl(name, [self], self.variables if arguments is None else arguments)

    def gradient(self) -> dict[str, Formula]:
        """The exact partial derivatives: by x, y and z, and by every other variable."""
        graph = Graph(self.nodes)
        names = ["x", "y", "z", *(name for name in self.variables if name not in ("x", "y", "z"))]
        root = len(self.nodes) - 1
        return {name: _from_node(graph, derivative(graph, root, name)) for name in names}

    def _check_given(self, arrays: Mapping[str, ArrayLike]) -> tuple[str, ...]:
        missing = [name for name in self.variables if name not in arrays]
        if missing:
            raise FormulaError(f"no value for {', '.join(missing)} in {shortened(self.text)}")
        return self.variables


def parse(text: str) -> Formula:
    """Read a formula. Raises FormulaError, which says what is wrong, where, and what would be right."""
    parser = Parser(text)
    root = parser.read()
    return Formula(tuple(sorted(parser.names)), prune(parser.graph.nodes, root), text)


def glsl_vector(name: str, formulas: Sequence[Formula], arguments: Sequence[str]) -> str:
    """Source of a GLSL function ``vecN name(float ...)`` of 2 to 4 formulas that share what they can.

    Raises ValueError for another number of formulas, and where ``Formula.glsl`` does.
    """
    if not 2 <= len(formulas) <= 4:
        raise ValueError(f"a GLSL vector has 2 to 4 components, not {len(formulas)}")
    return _glsl(name, formulas, arguments)


def _glsl(name: str, formulas: Sequence[Formula], arguments: Sequence[str]) -> str:
    graph = Graph()
    roots = [graph.include(formula.nodes)[-1] for formula in formulas]
    missing = {variable for formula in formulas for variable in formula.variables}.difference(arguments)
    if missing:
        raise ValueError(f"{', '.join(sorted(missing))} not among the arguments of {name}")
    if len(set(arguments)) != len(arguments):
        raise ValueError(f"an argument of {name} is named twice")
    return GlslWriter(name, graph, roots, arguments).source()


def _from_node(graph: Graph, root: int) -> Formula:
    nodes = prune(graph.nodes, root)
    return Formula(tuple(sorted(node.name for node in nodes if node.operation == "variable")), nodes)


def _real(name: str, value: ArrayLike) -> NDArray[Any]:
    """``value`` as an array of real numbers; Python numbers stay scalars without a type of their own."""
    array = np.asarray(value)
    if array.dtype.kind not in "fiub":
        raise FormulaError(f"{name} is {array.dtype.name}; real numbers are needed")
    return array


def _common_type(values: Sequence[NDArray[Any]]) -> np.dtype[Any]:
    """float32 if all arrays are float32, float64 otherwise; scalars go along with the arrays."""
    kinds = {value.dtype for value in values if value.ndim} or {value.dtype for value in values}
    return np.dtype(np.float32 if kinds == {np.dtype(np.float32)} else np.float64)


def _common_shape(arrays: Mapping[str, ArrayLike]) -> tuple[int, ...]:
    shapes = {name: np.shape(array) for name, array in arrays.items()}
    try:
        return np.broadcast_shapes(*shapes.values())
    except ValueError:
        listed = ", ".join(f"{name} {shape}" for name, shape in shapes.items() if shape)
        raise FormulaError(f"shapes do not fit together: {listed}") from None


def _blocks(shape: tuple[int, ...]) -> list[tuple[slice, ...]]:
    """Slices of the first axis that together cover an array of this shape."""
    if not shape or not shape[0]:
        return [()]
    rows = max(1, BLOCK_SIZE // max(1, int(np.prod(shape[1:]))))
    return [(slice(first, first + rows),) for first in range(0, shape[0], rows)]


def _block_of(value: FloatArray, block: tuple[slice, ...], dimensions: int) -> FloatArray:
    """The part of an operand that goes into a block of the result."""
    spread = value.ndim < dimensions or not block or value.shape[0] == 1
    return value if spread else value[block]


def _evaluate_nodes(
    nodes: Sequence[Node], variables: Mapping[str, FloatArray], dtype: np.dtype[Any]
) -> FloatArray:
    """The value of the last node; every other value is dropped after its last use."""
    last_use = {argument: index for index, node in enumerate(nodes) for argument in node.arguments}
    values: dict[int, FloatArray] = {}
    for index, node in enumerate(nodes):
        if node.operation == "number":
            values[index] = np.asarray(node.value, dtype)
        elif node.operation == "variable":
            values[index] = variables[node.name]
        else:
            values[index] = compute(node, [values[argument] for argument in node.arguments])
        for argument in set(node.arguments):
            if last_use[argument] == index:
                del values[argument]
    return values[len(nodes) - 1]
