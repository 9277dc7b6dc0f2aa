"""Reading a formula: from words to a graph, by operator precedence.

The parser is Vaughan Pratt's ("Top down operator precedence", POPL 1973): every operator has a binding
power, and an operand goes to the neighbour that binds it more tightly.
"""

from __future__ import annotations

from typing import NamedTuple

from viewer.kit import formula_complaints as complaints
from viewer.kit.formula_functions import CONSTANTS, FUNCTIONS
from viewer.kit.formula_graph import Graph, constant_result, is_representable
from viewer.kit.formula_tokens import OPERATOR_WORDS, FormulaError, Token, tokenize

DEEPEST_NESTING = 64
DEEPEST_RECURSION = 160  # operators of rising precedence also recurse, a few levels in each parenthesis
MOST_OPERATIONS = 1000
MOST_NAMES = 64

CHOICE, OR, AND, NOT, COMPARISON, SUM, PRODUCT, SIGN, POWER = range(10, 100, 10)
COMPARING = {
    "<": "less",
    "<=": "less_equal",
    ">": "greater",
    ">=": "greater_equal",
    "==": "equal",
    "!=": "not_equal",
}
BINARY = {
    "or": (OR, "or"),
    "and": (AND, "and"),
    "+": (SUM, "add"),
    "-": (SUM, "subtract"),
    "*": (PRODUCT, "multiply"),
    "/": (PRODUCT, "divide"),
    "%": (PRODUCT, "mod"),
}
BINDING = {
    "if": CHOICE,
    **{text: power for text, (power, _) in BINARY.items()},
    **dict.fromkeys(COMPARING, COMPARISON),
    **dict.fromkeys(["^", "**"], POWER),
}


class Operand(NamedTuple):
    """A subexpression: its node and its 0-based extent in the text."""

    node: int
    start: int
    end: int


class Parser:
    """Reads one formula. After ``read``, ``graph`` holds its nodes and ``names`` its variables."""

    def __init__(self, text: str) -> None:
        self.tokens = tokenize(text)
        self.text = text
        self.graph = Graph()
        self.names: set[str] = set()
        self._at = 0
        self._operations = 0
        self._nesting = 0
        self._recursion = 0

    def read(self) -> int:
        """The node of the whole formula."""
        operand = self._expression(0)
        if self._next.kind != "end":
            raise complaints.leftover(self._next, self._before)
        return operand.node

    @property
    def _next(self) -> Token:
        return self.tokens[self._at]

    @property
    def _before(self) -> Token:
        return self.tokens[self._at - 1]

    def _take(self) -> Token:
        token = self.tokens[self._at]
        self._at += token.kind != "end"
        return token

    def _expression(self, binding: int) -> Operand:
        """An operand and every operator after it that binds more tightly than ``binding``."""
        self._recursion += 1
        if self._recursion > DEEPEST_RECURSION:
            raise _too_nested(self._next)
        left = self._operand()
        while BINDING.get(self._next.text, 0) > binding:
            left = self._extend(left, self._take())
        self._recursion -= 1
        return left

    def _nested(self, opening: Token, binding: int) -> Operand:
        """An expression one level deeper."""
        self._nesting += 1
        if self._nesting > DEEPEST_NESTING:
            raise _too_nested(opening)
        operand = self._expression(binding)
        self._nesting -= 1
        return operand

    def _extend(self, left: Operand, operator: Token) -> Operand:
        """``left`` joined by an operator to what follows."""
        if operator.text in COMPARING:
            return self._comparison(left, operator)
        if operator.text == "if":
            return self._choice(left, operator)
        if operator.text in ("^", "**"):
            right = self._nested(operator, POWER - 1)
            return self._apply("power", left, right)
        power, operation = BINARY[operator.text]
        return self._apply(operation, left, self._expression(power))

    def _comparison(self, left: Operand, operator: Token) -> Operand:
        """A chain such as 0 < x < 1, which means 0 < x and x < 1."""
        right = self._expression(COMPARISON)
        result = self._apply(COMPARING[operator.text], left, right)
        while self._next.text in COMPARING:
            operator, middle = self._take(), right
            right = self._expression(COMPARISON)
            link = self._apply(COMPARING[operator.text], middle, right)
            result = self._apply("and", result, link)
        return result

    def _choice(self, chosen: Operand, word: Token) -> Operand:
        condition = self._nested(word, CHOICE)
        if self._next.text != "else":
            missing = complaints.missing_operator(self._next, self._before)
            place = word.position
            raise missing or FormulaError(f"if at {place} has no else; write a if condition else b", place)
        otherwise = self._nested(self._take(), CHOICE - 1)
        node = self._combine("choose", [condition, chosen, otherwise], chosen.start, otherwise.end)
        return Operand(node, chosen.start, otherwise.end)

    def _operand(self) -> Operand:
        """A number, a name, a call, a parenthesis, or a sign and its operand."""
        before = self._before if self._at else None
        token = self._take()
        if token.kind == "number":
            return self._number(token)
        if token.text in ("-", "+", "not"):
            operand = self._nested(token, NOT if token.text == "not" else SIGN)
            return self._signed(token, operand)
        if token.text == "(":
            inside = self._nested(token, 0)
            closing = self._close(token)
            return Operand(inside.node, token.start, closing.end)
        if token.kind == "name" and token.text not in OPERATOR_WORDS:
            return self._call(token) if self._next.text == "(" else self._name(token)
        raise complaints.misplaced(token, before)

    def _signed(self, sign: Token, operand: Operand) -> Operand:
        if sign.text == "+":
            self._count(sign)
            return operand._replace(start=sign.start)
        operation = "not" if sign.text == "not" else "negate"
        node = self._combine(operation, [operand], sign.start, operand.end)
        return Operand(node, sign.start, operand.end)

    def _number(self, token: Token) -> Operand:
        value = float(token.text)
        if not is_representable(value):
            shown, place = complaints.shortened(token.text), token.position
            raise FormulaError(f"{shown} at {place} is too large for a number", place)
        return Operand(self.graph.number(value), token.start, token.end)

    def _name(self, token: Token) -> Operand:
        if token.text in CONSTANTS:
            return Operand(self.graph.number(CONSTANTS[token.text]), token.start, token.end)
        if token.text in FUNCTIONS:
            raise complaints.bare_function(token, self._next)
        self.names.add(token.text)
        if len(self.names) > MOST_NAMES:
            raise FormulaError(
                f"{token.text} at {token.position} is one name too many; at most {MOST_NAMES} are allowed",
                token.position,
            )
        return Operand(self.graph.variable(token.text), token.start, token.end)

    def _call(self, name: Token) -> Operand:
        opening = self._take()
        if name.text not in FUNCTIONS:
            raise complaints.unknown_function(name)
        arguments: list[Operand] = []
        if self._next.text != ")":
            arguments.append(self._nested(opening, 0))
            while self._next.text == ",":
                self._take()
                arguments.append(self._nested(opening, 0))
        closing = self._close(opening)
        if (wrong := complaints.wrong_count(name, len(arguments))) is not None:
            raise wrong
        node = self._build_call(name.text, arguments, name.start, closing.end)
        return Operand(node, name.start, closing.end)

    def _build_call(self, name: str, arguments: list[Operand], start: int, end: int) -> int:
        """The node of a call; functions that are made of others are taken apart here."""
        if name in ("noise", "turbulence"):
            zero = Operand(self.graph.number(0.0), end, end)
            return self._combine(name, [*arguments, zero, zero][:3], start, end)
        if name == "clamp":
            raised = self._combine("max", arguments[:2], start, end)
            return self._combine("min", [Operand(raised, start, end), arguments[2]], start, end)
        if name == "length" and len(arguments) == 1:
            return self._combine("abs", arguments, start, end)
        size = {"min": 2, "max": 2, "length": 4}.get(name, len(arguments))
        while len(arguments) > size:
            first = self._combine(name, arguments[:size], start, end)
            arguments = [Operand(first, start, end), *arguments[size:]]
        return self._combine("power" if name == "pow" else name, arguments, start, end)

    def _apply(self, operation: str, left: Operand, right: Operand) -> Operand:
        node = self._combine(operation, [left, right], left.start, right.end)
        return Operand(node, left.start, right.end)

    def _combine(self, operation: str, operands: list[Operand], start: int, end: int) -> int:
        """The node of an operation on operands, refused if it is a constant that is no finite number."""
        self._count(self.tokens[self._at])
        node = self.graph.apply(operation, *(operand.node for operand in operands))
        values = [self.graph.value(operand.node) for operand in operands]
        numbers = [value for value in values if value is not None]
        if len(numbers) == len(values) and self.graph.value(node) is None:
            result = constant_result(self.graph[node], numbers)
            shown = self.text[start:end]
            raise complaints.impossible_constant(shown, start + 1, operation, numbers, result)
        return node

    def _count(self, token: Token) -> None:
        self._operations += 1
        if self._operations > MOST_OPERATIONS:
            raise FormulaError(
                f"more than {MOST_OPERATIONS:,} operations at {token.position}; use a shorter formula",
                token.position,
            )

    def _close(self, opening: Token) -> Token:
        """The parenthesis that closes ``opening``."""
        if self._next.text == ")":
            return self._take()
        if self._next.kind == "end":
            raise complaints.unclosed(opening, self._next)
        raise complaints.leftover(self._next, self._before)


def _too_nested(token: Token) -> FormulaError:
    place = token.position
    return FormulaError(f"nested more than {DEEPEST_NESTING} deep at {place}; use fewer parentheses", place)
