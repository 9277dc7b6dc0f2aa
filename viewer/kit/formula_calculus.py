"""Exact derivatives of formulas, as formulas.

Forward accumulation (Griewank & Walther, "Evaluating Derivatives", SIAM 2008, chapter 3) carried out on
nodes in place of numbers: one pass over the graph gives each node its derivative by one variable.

Where a derivative does not exist, a value is agreed on: 0 for sqrt, cbrt, length, abs and powers at 0,
one of the two sides for min, max and clamp, 0 at the jumps of floor, sign, comparisons and the like.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from viewer.kit.formula_algebra import Algebra
from viewer.kit.formula_functions import CONDITIONS
from viewer.kit.formula_graph import NOISES, Graph, Node

FLAT = CONDITIONS | {"sign", "floor", "ceil", "round", "step"}

Slope = int | None  # a derivative by one variable; None where the node does not depend on it


def derivative(graph: Graph, root: int, variable: str) -> int:
    """The node, added to ``graph``, of the derivative of the node ``root`` by a variable."""
    algebra = Algebra(graph)
    slopes: list[Slope] = []
    for index in range(root + 1):
        node = graph[index]
        slope: Slope = None
        if node.operation == "variable":
            slope = algebra.one if node.name == variable else None
        elif node.operation not in FLAT and any(slopes[argument] is not None for argument in node.arguments):
            slope = _slope(algebra, index, [slopes[argument] for argument in node.arguments])
        slopes.append(None if slope == algebra.zero else slope)
    slope = slopes[root]
    return algebra.zero if slope is None else slope


def _slope(algebra: Algebra, index: int, slopes: Sequence[Slope]) -> Slope:
    """The derivative of one node from those of its arguments."""
    node = algebra.graph[index]
    if node.operation in WHOLE_RULES:
        known = [algebra.zero if slope is None else slope for slope in slopes]
        return WHOLE_RULES[node.operation](algebra, index, node.arguments, known)
    total = algebra.zero
    for position, slope in enumerate(slopes):
        if slope is not None:
            partial = _partial(algebra, index, position)
            total = algebra.add(total, algebra.multiply(partial, slope))
    return total


def _partial(algebra: Algebra, index: int, position: int) -> int:
    """The derivative of a node by one of its arguments."""
    node = algebra.graph[index]
    if node.operation in NOISES:
        return _noise_partial(algebra, node, position)
    rule = PARTIALS[node.operation]
    chosen = rule[position] if isinstance(rule, tuple) else rule
    return chosen(algebra, index, *node.arguments)


def _noise_partial(a: Algebra, node: Node, position: int) -> int:
    order = list(node.order)
    order[position] += 1
    return a.graph.apply(node.operation, *node.arguments, order=(order[0], order[1], order[2]))


def _choose(a: Algebra, index: int, arguments: Sequence[int], slopes: Sequence[int]) -> int:
    return a.choose(arguments[0], slopes[1], slopes[2])


def _min(a: Algebra, index: int, arguments: Sequence[int], slopes: Sequence[int]) -> int:
    return a.choose(a.call("less", arguments[1], arguments[0]), slopes[1], slopes[0])


def _max(a: Algebra, index: int, arguments: Sequence[int], slopes: Sequence[int]) -> int:
    return a.choose(a.call("less", arguments[0], arguments[1]), slopes[1], slopes[0])


def _length(a: Algebra, index: int, arguments: Sequence[int], slopes: Sequence[int]) -> int:
    dot = a.zero
    for argument, slope in zip(arguments, slopes, strict=True):
        dot = a.add(dot, a.multiply(argument, slope))
    return a.zero_where_zero(index, a.divide(dot, index))


def _sqrt(a: Algebra, index: int, arguments: Sequence[int], slopes: Sequence[int]) -> int:
    return a.zero_where_zero(index, a.divide(slopes[0], a.multiply(a.number(2.0), index)))


def _cbrt(a: Algebra, index: int, arguments: Sequence[int], slopes: Sequence[int]) -> int:
    square = a.power(index, a.number(2.0))
    return a.zero_where_zero(index, a.divide(slopes[0], a.multiply(a.number(3.0), square)))


def _multiply(a: Algebra, index: int, arguments: Sequence[int], slopes: Sequence[int]) -> int:
    first = a.multiply(slopes[0], arguments[1])
    return a.add(first, a.multiply(arguments[0], slopes[1]))


def _divide(a: Algebra, index: int, arguments: Sequence[int], slopes: Sequence[int]) -> int:
    """(u / v)' = (u' - (u / v) v') / v"""
    numerator = a.subtract(slopes[0], a.multiply(index, slopes[1])) if slopes[1] != a.zero else slopes[0]
    return a.divide(numerator, arguments[1])


def _smoothstep(a: Algebra, index: int, arguments: Sequence[int], slopes: Sequence[int]) -> int:
    """6 t (1 - t) t', where t is the clamped share; its factor t (1 - t) is 0 where the clamp holds."""
    low, high, value = arguments
    width = a.subtract(high, low)
    share = a.divide(a.subtract(value, low), width)
    clamped = a.call("min", a.call("max", share, a.zero), a.one)
    bell = a.multiply(a.multiply(a.number(6.0), clamped), a.subtract(a.one, clamped))
    rise = a.subtract(slopes[2], slopes[0])
    stretch = a.multiply(share, a.subtract(slopes[1], slopes[0]))
    return a.multiply(bell, a.divide(a.subtract(rise, stretch), width))


def _power(a: Algebra, index: int, arguments: Sequence[int], slopes: Sequence[int]) -> int:
    base, exponent = arguments
    total = a.zero
    if slopes[0] != a.zero:
        total = a.multiply(_power_by_base(a, base, exponent), slopes[0])
    if slopes[1] != a.zero:
        growth = a.multiply(a.call("log", base), index)
        if a.graph.value(base) is None or a.graph.value(base) == 0.0:
            growth = a.zero_where_zero(base, growth)
        total = a.add(total, a.multiply(growth, slopes[1]))
    return total


def _power_by_base(a: Algebra, base: int, exponent: int) -> int:
    """n x^(n - 1), but 0 at x = 0 where that would be infinite although x^n is not."""
    slope = a.multiply(exponent, a.power(base, a.subtract(exponent, a.one)))
    value = a.graph.value(exponent)
    if value is not None:
        return a.zero_where_zero(base, slope) if 0.0 < value < 1.0 else slope
    steep = a.call("and", a.call("equal", base, a.zero), a.call("less", exponent, a.one))
    return a.choose(steep, a.zero, slope)


WHOLE_RULES: dict[str, Callable[[Algebra, int, Sequence[int], Sequence[int]], int]] = {
    "choose": _choose,
    "min": _min,
    "max": _max,
    "length": _length,
    "sqrt": _sqrt,
    "cbrt": _cbrt,
    "multiply": _multiply,
    "divide": _divide,
    "smoothstep": _smoothstep,
    "power": _power,
}

# The derivative by each argument; f is the node itself, u, v, t its arguments.
Rule = Callable[..., int]
PARTIALS: dict[str, Rule | tuple[Rule, ...]] = {
    "negate": lambda a, f, u: a.number(-1.0),
    "add": (lambda a, f, u, v: a.one, lambda a, f, u, v: a.one),
    "subtract": (lambda a, f, u, v: a.one, lambda a, f, u, v: a.number(-1.0)),
    "mod": (
        lambda a, f, u, v: a.one,
        lambda a, f, u, v: a.negate(a.call("floor", a.divide(u, v))),
    ),
    "mix": (
        lambda a, f, u, v, t: a.subtract(a.one, t),
        lambda a, f, u, v, t: t,
        lambda a, f, u, v, t: a.subtract(v, u),
    ),
    "atan2": (
        lambda a, f, u, v: a.divide(v, _sum_of_squares(a, u, v)),
        lambda a, f, u, v: a.negate(a.divide(u, _sum_of_squares(a, u, v))),
    ),
    "sin": lambda a, f, u: a.call("cos", u),
    "cos": lambda a, f, u: a.negate(a.call("sin", u)),
    "tan": lambda a, f, u: a.add(a.one, a.power(f, a.number(2.0))),
    "asin": lambda a, f, u: a.divide(a.one, a.call("sqrt", _one_minus_square(a, u))),
    "acos": lambda a, f, u: a.divide(a.number(-1.0), a.call("sqrt", _one_minus_square(a, u))),
    "atan": lambda a, f, u: a.divide(a.one, a.add(a.one, a.power(u, a.number(2.0)))),
    "sinh": lambda a, f, u: a.call("cosh", u),
    "cosh": lambda a, f, u: a.call("sinh", u),
    "tanh": lambda a, f, u: _one_minus_square(a, f),
    "exp": lambda a, f, u: f,
    "log": lambda a, f, u: a.divide(a.one, u),
    "log2": lambda a, f, u: a.divide(a.number(1.0 / math.log(2.0)), u),
    "abs": lambda a, f, u: a.call("sign", u),
    "fract": lambda a, f, u: a.one,
}


def _sum_of_squares(a: Algebra, u: int, v: int) -> int:
    return a.add(a.power(u, a.number(2.0)), a.power(v, a.number(2.0)))


def _one_minus_square(a: Algebra, u: int) -> int:
    return a.subtract(a.one, a.power(u, a.number(2.0)))
