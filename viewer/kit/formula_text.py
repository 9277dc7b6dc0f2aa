"""Writing a graph as infix text: the part that the formula language and GLSL have in common."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from viewer.kit.formula_functions import CONDITIONS
from viewer.kit.formula_graph import Node

LONGEST_EXPRESSION = 2000

# How tightly a written expression holds together, by its outermost operator.
CHOICE, OR, AND, NOT, EQUALITY, RELATION, SUM, SIGN, PRODUCT, POWER, WHOLE = range(0, 110, 10)


class Written(NamedTuple):
    """Text of an expression, and how tightly it holds together."""

    text: str
    binding: int
    divides: bool = False  # a product with a quotient in it, which has to stay together

    def at_least(self, binding: int) -> str:
        """The text, in parentheses if it holds together less tightly than ``binding``."""
        return self.text if self.binding >= binding else f"({self.text})"


COMPARING = {
    "less": ("<", RELATION),
    "less_equal": ("<=", RELATION),
    "greater": (">", RELATION),
    "greater_equal": (">=", RELATION),
    "equal": ("==", EQUALITY),
    "not_equal": ("!=", EQUALITY),
}


def arithmetic(node: Node, operands: Sequence[Written], space: str) -> Written | None:
    """+ - * / and the sign, which both languages write alike; None for any other operation.

    Products of products lose their parentheses; sums of sums keep them, since those round differently.
    """
    if node.operation == "negate":
        return Written("-" + operands[0].at_least(PRODUCT), SIGN)
    if node.operation in ("add", "subtract"):
        sign = " + " if node.operation == "add" else " - "
        return Written(operands[0].at_least(SUM) + sign + operands[1].at_least(PRODUCT), SUM)
    if node.operation in ("multiply", "divide"):
        sign = "*" if node.operation == "multiply" else "/"
        product_of_products = node.operation == "multiply" and not operands[1].divides
        right = operands[1].at_least(PRODUCT if product_of_products else POWER)
        text = operands[0].at_least(SIGN) + space + sign + space + right
        divides = node.operation == "divide" or operands[0].divides
        return Written(text, SIGN if text.startswith("-") else PRODUCT, divides)
    return None


def formula_text(nodes: Sequence[Node]) -> str:
    """The last of ``nodes`` in the formula language; parts too long to read are written as three points.

    Derivatives of noise, which the language has no name for, are written as noise_x, noise_xy ...
    """
    written: list[Written] = []
    for node in nodes:
        expression = _write(node, [written[argument] for argument in node.arguments])
        if len(expression.text) > LONGEST_EXPRESSION:
            expression = Written("...", WHOLE)
        written.append(expression)
    return written[-1].text


def _write(node: Node, operands: Sequence[Written]) -> Written:
    if (common := arithmetic(node, operands, space="")) is not None:
        return common
    if node.operation == "number":
        return Written(f"{node.value:.9g}", SIGN if node.value < 0 else WHOLE)
    if node.operation == "variable":
        return Written(node.name, WHOLE)
    if node.operation == "mod":
        return Written(f"{operands[0].at_least(POWER)} % {operands[1].at_least(POWER)}", SUM)
    if node.operation == "power":
        return Written(f"{operands[0].at_least(WHOLE)}^{operands[1].at_least(POWER)}", POWER)
    if node.operation == "choose":
        condition, chosen, otherwise = (operand.at_least(OR) for operand in operands)
        return Written(f"{chosen} if {condition} else {otherwise}", CHOICE)
    if node.operation in CONDITIONS:
        return _write_condition(node, operands)
    suffix = "".join(axis * count for axis, count in zip("xyz", node.order, strict=True))
    name = node.operation + (f"_{suffix}" if suffix else "")
    return Written(f"{name}({', '.join(operand.text for operand in operands)})", WHOLE)


def _write_condition(node: Node, operands: Sequence[Written]) -> Written:
    if node.operation == "not":
        return Written(f"not {operands[0].at_least(NOT)}", NOT)
    if node.operation in COMPARING:
        sign, _ = COMPARING[node.operation]
        return Written(f"{operands[0].at_least(SUM)} {sign} {operands[1].at_least(SUM)}", RELATION)
    binding = AND if node.operation == "and" else OR
    left, right = operands[0].at_least(binding), operands[1].at_least(binding + 1)
    return Written(f"{left} {node.operation} {right}", binding)
