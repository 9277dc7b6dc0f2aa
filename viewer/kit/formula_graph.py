"""A formula as a directed acyclic graph in which equal subexpressions are one node.

Nodes stand in creation order, so the arguments of a node always precede it: whatever walks a formula
(evaluation, differentiation, emission) is a plain loop and has no depth to run out of.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from viewer.kit import noise
from viewer.kit.formula_functions import OPERATIONS, FloatArray

LARGEST_NUMBER = float(np.finfo(np.float32).max)
COMMUTATIVE = frozenset({"add", "multiply", "equal", "not_equal", "and", "or"})
NOISES = {"noise": noise.noise_derivative, "turbulence": noise.turbulence_derivative}


class Node(NamedTuple):
    """One operation and the indices of its arguments.

    A "number" has its ``value``, a "variable" its ``name``; a "noise" or "turbulence" has the ``order`` of
    differentiation in its three arguments.
    """

    operation: str
    arguments: tuple[int, ...] = ()
    value: float = 0.0
    name: str = ""
    order: noise.Order = (0, 0, 0)


class Graph:
    """Nodes under construction. Every method returns the index of a node, old or new."""

    def __init__(self, nodes: Iterable[Node] = ()) -> None:
        self.nodes: list[Node] = list(nodes)
        self._index = {_identity(node): index for index, node in enumerate(self.nodes)}

    def __getitem__(self, index: int) -> Node:
        return self.nodes[index]

    def number(self, value: float) -> int:
        """The node of a finite number."""
        return self._insert(Node("number", value=float(value)))

    def variable(self, name: str) -> int:
        """The node of a free name."""
        return self._insert(Node("variable", name=name))

    def value(self, index: int) -> float | None:
        """The number that a node is, or None if it is anything else."""
        node = self.nodes[index]
        return node.value if node.operation == "number" else None

    def apply(self, operation: str, *arguments: int, order: noise.Order = (0, 0, 0)) -> int:
        """The node of an operation; a number, where all arguments are and the result fits a float32."""
        node = Node(operation, arguments, order=order)
        values = [self.value(argument) for argument in arguments]
        numbers = [value for value in values if value is not None]
        if len(numbers) == len(values):
            result = constant_result(node, numbers)
            return self.number(result) if is_representable(result) else self._insert(node)
        if operation == "power" and values[1] in (0.0, 1.0):
            return arguments[0] if values[1] else self.number(1.0)
        if operation == "power" and values[0] == math.e:
            return self.apply("exp", arguments[1])
        return self._insert(node)

    def include(self, nodes: Sequence[Node]) -> list[int]:
        """Take in the nodes of another graph; their indices here."""
        renamed: list[int] = []
        for node in nodes:
            arguments = tuple(renamed[argument] for argument in node.arguments)
            renamed.append(self._insert(node._replace(arguments=arguments)))
        return renamed

    def _insert(self, node: Node) -> int:
        identity = _identity(node)
        index = self._index.setdefault(identity, len(self.nodes))
        if index == len(self.nodes):
            self.nodes.append(node)
        return index


def _identity(node: Node) -> Node:
    """What two nodes have in common if they always have the same value."""
    if node.operation in COMMUTATIVE:
        return node._replace(arguments=tuple(sorted(node.arguments)))
    return node


def needed(nodes: Sequence[Node], roots: Iterable[int]) -> list[int]:
    """The indices, in order, of the nodes that the roots are computed from, roots included."""
    marked = set(roots)
    for index in range(max(marked), -1, -1):
        if index in marked:
            marked.update(nodes[index].arguments)
    return sorted(marked)


def prune(nodes: Sequence[Node], root: int) -> tuple[Node, ...]:
    """The nodes that ``root`` is computed from, renumbered, ``root`` last."""
    kept = needed(nodes, [root])
    place = {index: position for position, index in enumerate(kept)}
    return tuple(
        nodes[index]._replace(arguments=tuple(place[argument] for argument in nodes[index].arguments))
        for index in kept
    )


def compute(node: Node, values: Sequence[FloatArray]) -> FloatArray:
    """The value of an operation for the values of its arguments."""
    if node.operation in NOISES:
        return NOISES[node.operation](values[0], values[1], values[2], node.order)
    result: FloatArray = OPERATIONS[node.operation](*values)
    return result


def constant_result(node: Node, values: Sequence[float]) -> float:
    """The value of an operation for numbers, possibly infinite or not a number."""
    with np.errstate(all="ignore"):
        return float(compute(node, [np.float64(value) for value in values]))  # type: ignore[misc]


def is_representable(value: float) -> bool:
    """Whether a float32 can hold the value."""
    return math.isfinite(value) and abs(value) <= LARGEST_NUMBER
