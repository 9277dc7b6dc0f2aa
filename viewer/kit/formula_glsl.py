"""Writing a graph as a GLSL 3.30 function.

A value that is used more than once gets a name; anything else is written in place, up to a readable length.
What GLSL leaves undefined, or lacks, comes as a small function of its own before the main one.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence

import numpy as np

from viewer.kit.formula_functions import CONDITIONS, small_integer
from viewer.kit.formula_glsl_functions import BY_ZERO, HELPERS, power_helper
from viewer.kit.formula_graph import NOISES, Graph, Node, needed
from viewer.kit.formula_text import (
    AND,
    CHOICE,
    COMPARING,
    EQUALITY,
    OR,
    POWER,
    PRODUCT,
    SIGN,
    SUM,
    WHOLE,
    Written,
    arithmetic,
)

LONGEST_INLINE = 72
NOISE_INCLUDE = '#include "lib/noise.glsl"\n'
FUNCTION_NAME = re.compile(r"(?!gl_)(?!.*__)[A-Za-z](?:[A-Za-z0-9_]*[A-Za-z0-9])?")
BUILT_IN = {"round": "roundEven"}
PRODUCT_WRITTEN_OUT = 4


def literal(value: float) -> str:
    """The shortest GLSL float literal that reads back as the float32 nearest to ``value``."""
    return str(np.float32(value))


def argument_name(name: str) -> str:
    """A GLSL identifier for a variable: never a keyword, a built-in or reserved, and never the same twice.

    GLSL reserves double underscores, so a name that would have one gets a digit after each underscore,
    and another first letter to keep it apart from the names that are written so.
    """
    plain = f"a_{name}"
    return plain if "__" not in plain else "b_0" + name.replace("_", "_0")


class GlslWriter:
    """Writes one function; ``roots`` are the nodes that it returns, a float or a vector of 2 to 4."""

    def __init__(self, name: str, graph: Graph, roots: Sequence[int], arguments: Sequence[str]) -> None:
        if not FUNCTION_NAME.fullmatch(name):
            raise ValueError(f"{name!r} is not a name for a GLSL function")
        self.name = name
        self.graph = graph
        self.roots = roots
        self.arguments = arguments
        self.order = needed(graph.nodes, roots)
        self.written: dict[int, Written] = {}
        self.lines: list[str] = []
        self.helpers: dict[str, str] = {}
        self._uses = self._count_uses()
        self._noise_orders = self._collect_noise_orders()
        self._noise_names: dict[tuple[str, tuple[int, ...], int], str] = {}

    def source(self) -> str:
        """The text of the function, with what it needs before it."""
        for index in self.order:
            self._write(index)
        results = [self._number(root).text for root in self.roots]
        kind = "float" if len(results) == 1 else f"vec{len(results)}"
        value = results[0] if len(results) == 1 else f"{kind}({', '.join(results)})"
        parameters = ", ".join(f"float {argument_name(argument)}" for argument in self.arguments)
        body = "".join(f"    {line}\n" for line in [*self.lines, f"return {value};"])
        noisy = any(self.graph[index].operation in NOISES for index in self.order)
        helpers = "".join(f"{helper}\n" for helper in self.helpers.values())
        return (NOISE_INCLUDE if noisy else "") + helpers + f"{kind} {self.name}({parameters}) {{\n{body}}}\n"

    def _count_uses(self) -> Counter[int]:
        uses = Counter(self.roots)
        for index in self.order:
            node = self.graph[index]
            uses.update(node.arguments)
            if node.operation == "power" and self._whole_exponent(node) is not None:
                uses[node.arguments[0]] += 1  # a product writes its base more than once
        return uses

    def _collect_noise_orders(self) -> dict[tuple[str, tuple[int, ...]], set[int]]:
        """Which total orders of differentiation each noise is needed in."""
        orders: dict[tuple[str, tuple[int, ...]], set[int]] = {}
        for index in self.order:
            node = self.graph[index]
            if node.operation in NOISES:
                orders.setdefault((node.operation, node.arguments), set()).add(sum(node.order))
        return orders

    def _write(self, index: int) -> None:
        """Write one node, in place or as a line of its own."""
        node = self.graph[index]
        expression = self._expression(node)
        trivial = expression.text.replace(".", "").replace("_", "").isalnum() or node.operation == "number"
        if not trivial and (self._uses[index] > 1 or len(expression.text) > LONGEST_INLINE):
            kind = "bool" if node.operation in CONDITIONS else "float"
            expression = Written(self._declare(kind, "t", expression.text), WHOLE)
        self.written[index] = expression

    def _declare(self, kind: str, letter: str, value: str) -> str:
        name = f"{letter}{len(self.lines) + 1}"
        self.lines.append(f"{kind} {name} = {value};")
        return name

    def _number(self, index: int) -> Written:
        """The node as a float expression."""
        written = self.written[index]
        if self.graph[index].operation in CONDITIONS:
            return Written(f"float({written.text})", WHOLE)
        return written

    def _condition(self, index: int) -> Written:
        """The node as a bool expression."""
        if self.graph[index].operation in CONDITIONS:
            return self.written[index]
        return Written(f"{self.written[index].at_least(SUM)} != 0.0", EQUALITY)

    def _expression(self, node: Node) -> Written:
        if node.operation == "number":
            return Written(literal(node.value), SIGN if node.value < 0 else WHOLE)
        if node.operation == "variable":
            return Written(argument_name(node.name), WHOLE)
        if node.operation in NOISES:
            return self._noise(node)
        if node.operation == "choose":
            return self._choice(node)
        if node.operation in CONDITIONS:
            return self._comparison(node)
        operands = [self._number(argument) for argument in node.arguments]
        if node.operation in BY_ZERO and self.graph.value(node.arguments[1]) == 0.0:
            name = self._helper(f"{node.operation}_by_zero", BY_ZERO[node.operation])
            return Written(f"{name}({operands[0].text})", WHOLE)
        if (common := arithmetic(node, operands, space=" ")) is not None:
            return common
        if node.operation == "power":
            return self._power(node, operands)
        if node.operation == "length":
            return Written(f"length(vec{len(operands)}({_listed(operands)}))", WHOLE)
        return self._call(node, operands)

    def _call(self, node: Node, operands: Sequence[Written]) -> Written:
        name = BUILT_IN.get(node.operation, node.operation)
        ordered = node.operation == "smoothstep" and self._edges_ascend(node)
        if node.operation in HELPERS and not ordered:
            name = self._helper(node.operation, HELPERS[node.operation])
        return Written(f"{name}({_listed(operands)})", WHOLE)

    def _helper(self, name: str, source: str) -> str:
        """The name of a small function that goes before this one; it carries this one's name, so that
        several formulas can stand in one shader."""
        full = f"{self.name}_{name}"
        self.helpers[name] = source.replace("NAME", full)
        return full

    def _edges_ascend(self, node: Node) -> bool:
        low, high = (self.graph.value(edge) for edge in node.arguments[:2])
        return low is not None and high is not None and bool(np.float32(low) < np.float32(high))

    def _choice(self, node: Node) -> Written:
        condition = self._condition(node.arguments[0]).at_least(WHOLE)
        chosen, otherwise = (self._number(argument).at_least(OR) for argument in node.arguments[1:])
        return Written(f"{condition} ? {chosen} : {otherwise}", CHOICE)

    def _comparison(self, node: Node) -> Written:
        if node.operation in COMPARING:
            sign, binding = COMPARING[node.operation]
            left, right = (self._number(argument).at_least(SUM) for argument in node.arguments)
            return Written(f"{left} {sign} {right}", binding)
        operands = [self._condition(argument) for argument in node.arguments]
        if node.operation == "not":
            return Written(f"!{operands[0].at_least(WHOLE)}", SIGN)
        sign, binding = ("&&", AND) if node.operation == "and" else ("||", OR)
        return Written(f"{operands[0].at_least(binding)} {sign} {operands[1].at_least(binding + 5)}", binding)

    def _whole_exponent(self, node: Node) -> int | None:
        exponent = self.graph.value(node.arguments[1])
        return None if exponent is None else small_integer(exponent)

    def _power(self, node: Node, operands: Sequence[Written]) -> Written:
        whole = self._whole_exponent(node)
        if whole is None:
            base = self.graph.value(node.arguments[0])
            positive = base is not None and np.float32(base) > 0
            name = "pow" if positive else self._helper("power", HELPERS["power"])
            return Written(f"{name}({_listed(operands)})", WHOLE)
        size = abs(whole)
        if size <= PRODUCT_WRITTEN_OUT:
            base_text = operands[0].at_least(POWER)
            product = Written(" * ".join([base_text] * size), PRODUCT if size > 1 else WHOLE)
        else:
            name = self._helper(f"power_{size}", power_helper(size))
            product = Written(f"{name}({operands[0].text})", WHOLE)
        return product if whole > 0 else Written(f"1.0 / {product.at_least(POWER)}", PRODUCT, True)

    def _noise(self, node: Node) -> Written:
        """A call for the value alone; if derivatives are needed too, one call gives all of an order."""
        point = "vec3(" + _listed([self._number(argument) for argument in node.arguments]) + ")"
        function = f"perlin_{node.operation}"
        depth = sum(node.order)
        if depth > 2:
            order = ", ".join(map(str, node.order))
            return Written(f"{function}_derivative({point}, ivec3({order}))", WHOLE)
        if depth == 2:
            row, column = (axis for axis, count in enumerate(node.order) for _ in range(count))
            hessian = self._noise_name(node, 2, "mat3", f"{function}_hessian({point})")
            return Written(f"{hessian}[{row}][{column}]", WHOLE)
        if 1 not in self._noise_orders[node.operation, node.arguments]:
            return Written(f"{function}({point})", WHOLE)
        gradient = self._noise_name(node, 1, "vec4", f"{function}_gradient({point})")
        return Written(f"{gradient}.{'xyz'[node.order.index(1)] if depth else 'w'}", WHOLE)

    def _noise_name(self, node: Node, depth: int, kind: str, call: str) -> str:
        key = (node.operation, node.arguments, depth)
        if key not in self._noise_names:
            self._noise_names[key] = self._declare(kind, "n", call)
        return self._noise_names[key]


def _listed(operands: Sequence[Written]) -> str:
    return ", ".join(operand.text for operand in operands)
