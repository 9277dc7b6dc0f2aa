"""Building expressions that stay readable: the light simplification used on derivatives.

Only rewriting that holds for every value is done, with one exception that differentiation needs: a number
that is exactly 0 removes its product, whatever the other factor is.
"""

from __future__ import annotations

from collections.abc import Iterable

from viewer.kit.formula_graph import Graph, is_representable

LONGEST_SORTED_PRODUCT = 8


class Algebra:
    """Arithmetic on the nodes of a graph. Arguments and results are indices of nodes."""

    def __init__(self, graph: Graph) -> None:
        self.graph = graph
        self.zero = graph.number(0.0)
        self.one = graph.number(1.0)

    def number(self, value: float) -> int:
        return self.graph.number(value)

    def call(self, operation: str, *arguments: int) -> int:
        return self.graph.apply(operation, *arguments)

    def negate(self, a: int) -> int:
        operation, arguments = self._parts(a)
        if operation == "negate":
            return arguments[0]
        if operation == "subtract":
            return self.subtract(arguments[1], arguments[0])
        return self.graph.apply("negate", a)

    def add(self, a: int, b: int) -> int:
        if self.zero in (a, b):
            return b if a == self.zero else a
        if self._parts(b)[0] == "negate":
            return self.subtract(a, self._parts(b)[1][0])
        if self._parts(a)[0] == "negate":
            return self.subtract(b, self._parts(a)[1][0])
        (first, a_rest), (second, b_rest) = self._coefficient(a), self._coefficient(b)
        if a_rest == b_rest != self.one:
            return self.multiply(self.number(first + second), a_rest)
        return self.graph.apply("add", a, b)

    def subtract(self, a: int, b: int) -> int:
        if self.zero in (a, b):
            return self.negate(b) if a == self.zero else a
        if self._parts(b)[0] == "negate":
            return self.add(a, self._parts(b)[1][0])
        if self._parts(a)[0] == "negate":
            return self.negate(self.add(self._parts(a)[1][0], b))
        (first, a_rest), (second, b_rest) = self._coefficient(a), self._coefficient(b)
        if a_rest == b_rest != self.one:
            return self.multiply(self.number(first - second), a_rest)
        return self.graph.apply("subtract", a, b)

    def multiply(self, a: int, b: int) -> int:
        if self.zero in (a, b):
            return self.zero
        if self.one in (a, b):
            return b if a == self.one else a
        (first, a_is_negative), (second, b_is_negative) = self._magnitude(a), self._magnitude(b)
        if a_is_negative or b_is_negative:
            product = self.multiply(first, second)
            return product if a_is_negative and b_is_negative else self.negate(product)
        if self._parts(a)[0] == "divide":
            numerator, denominator = self._parts(a)[1]
            return self.divide(self.multiply(numerator, b), denominator)
        if self._parts(b)[0] == "divide":
            numerator, denominator = self._parts(b)[1]
            return self.divide(self.multiply(a, numerator), denominator)
        return self._sorted_product(a, b)

    def divide(self, a: int, b: int) -> int:
        if a == self.zero or b == self.one:
            return a
        if self._parts(a)[0] == "negate":
            return self.negate(self.divide(self._parts(a)[1][0], b))
        if self._parts(b)[0] == "negate":
            return self.negate(self.divide(a, self._parts(b)[1][0]))
        if self._parts(a)[0] == "divide":
            numerator, denominator = self._parts(a)[1]
            return self.divide(numerator, self.multiply(denominator, b))
        (above, a_rest), (below, b_rest) = self._coefficient(a), self._coefficient(b)
        if below != 1.0 and is_representable(above / below):
            return self.divide(self.multiply(self.number(above / below), a_rest), b_rest)
        return self.graph.apply("divide", a, b)

    def power(self, base: int, exponent: int) -> int:
        return self.graph.apply("power", base, exponent)

    def choose(self, condition: int, chosen: int, otherwise: int) -> int:
        """``chosen`` where the condition is not 0, ``otherwise`` elsewhere; never a sum of products,
        in which what was not chosen could still put its infinities."""
        if chosen == otherwise or self.graph.value(condition) == 0.0:
            return otherwise
        if self.graph.value(condition) is not None:
            return chosen
        return self.graph.apply("choose", condition, chosen, otherwise)

    def zero_where_zero(self, guard: int, expression: int) -> int:
        """``expression``, or 0 where ``guard`` is 0."""
        return self.choose(self.call("equal", guard, self.zero), self.zero, expression)

    def _parts(self, index: int) -> tuple[str, tuple[int, ...]]:
        node = self.graph[index]
        return node.operation, node.arguments

    def _magnitude(self, index: int) -> tuple[int, bool]:
        """An expression without its sign, and whether it had one."""
        operation, arguments = self._parts(index)
        if operation == "negate":
            return arguments[0], True
        value = self.graph.value(index)
        return (self.number(-value), True) if value is not None and value < 0 else (index, False)

    def _coefficient(self, index: int) -> tuple[float, int]:
        """The number that a product starts with, if it is not zero, and the product of the rest."""
        if (value := self.graph.value(index)) is not None:
            return (value, self.one) if value else (1.0, index)
        operation, arguments = self._parts(index)
        first = self.graph.value(arguments[0]) if operation == "multiply" else None
        return (first, arguments[1]) if first else (1.0, index)

    def _factors(self, index: int) -> list[int]:
        """The factors of a product without its coefficient; a long product counts as one factor."""
        factors: list[int] = []
        rest = index
        while self._parts(rest)[0] == "multiply" and len(factors) < LONGEST_SORTED_PRODUCT:
            rest, last = self._parts(rest)[1]
            factors.insert(0, last)
        return [rest, *factors]

    def _sorted_product(self, a: int, b: int) -> int:
        """The product with its number first, then names, then the rest, each in the order found."""
        (first, a_rest), (second, b_rest) = self._coefficient(a), self._coefficient(b)
        factors = self._factors(a_rest) + self._factors(b_rest)
        if len(factors) > LONGEST_SORTED_PRODUCT or not is_representable(first * second):
            return self.graph.apply("multiply", a, b)
        factors = self._collected(factor for factor in factors if factor != self.one)
        factors.sort(key=lambda factor: self.graph[factor].operation != "variable")
        product = factors[0] if factors else self.one
        for factor in factors[1:]:
            product = self.graph.apply("multiply", product, factor)
        coefficient = first * second
        if coefficient == 1.0 or product == self.one:
            return product if coefficient == 1.0 else self.number(coefficient)
        return self.graph.apply("multiply", self.number(coefficient), product)

    def _collected(self, factors: Iterable[int]) -> list[int]:
        """The factors with equal ones gathered into powers, where the exponents are natural numbers."""
        exponents: dict[int, float] = {}
        for factor in factors:
            operation, arguments = self._parts(factor)
            exponent = self.graph.value(arguments[1]) if operation == "power" else None
            natural = exponent is not None and exponent > 0 and exponent == int(exponent)
            base, count = (arguments[0], exponent or 0.0) if natural else (factor, 1.0)
            exponents[base] = exponents.get(base, 0.0) + count
        return [self.power(base, self.number(count)) for base, count in exponents.items()]
