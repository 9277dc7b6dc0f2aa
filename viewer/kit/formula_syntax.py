"""Reading a formula: from words to a graph, by operator precedence.

The parser is Vaughan Pratt's ("Top down operator precedence", POPL 1973): every operator has a binding
power, and an operand goes to the neighbour that binds it more tightly.
"""

from __future__ import annotations

import difflib
from typing import NamedTuple, NoReturn

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
            self._refuse_leftover()
        return operand.node

    @property
    def _next(self) -> Token:
        return self.tokens[self._at]

    def _take(self) -> Token:
        token = self.tokens[self._at]
        self._at += token.kind != "end"
        return token

    def _expression(self, binding: int) -> Operand:
        """An operand and every operator after it that binds more tightly than ``binding``."""
        self._recursion += 1
        if self._recursion > DEEPEST_RECURSION:
            self._refuse_nesting(self._next)
        left = self._operand()
        while BINDING.get(self._next.text, 0) > binding:
            left = self._extend(left, self._take())
        self._recursion -= 1
        return left

    def _nested(self, opening: Token, binding: int) -> Operand:
        """An expression one level deeper."""
        self._nesting += 1
        if self._nesting > DEEPEST_NESTING:
            self._refuse_nesting(opening)
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
            self._refuse_missing_operator()
            raise FormulaError(
                f"if at {word.position} has no else; write a if condition else b", word.position
            )
        otherwise = self._nested(self._take(), CHOICE - 1)
        node = self._combine("choose", [condition, chosen, otherwise], chosen.start, otherwise.end)
        return Operand(node, chosen.start, otherwise.end)

    def _operand(self) -> Operand:
        """A number, a name, a call, a parenthesis, or a sign and its operand."""
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
        before = self.tokens[self.tokens.index(token) - 1] if token.start or token.kind == "end" else None
        after = f" after {before}" if before is not None and before is not token else ""
        raise FormulaError(
            f"expected a number, a name or ( at {token.position}{after}, found {token}", token.position
        )

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
            raise FormulaError(
                f"{_shortened(token.text)} at {token.position} is too large for a number", token.position
            )
        return Operand(self.graph.number(value), token.start, token.end)

    def _name(self, token: Token) -> Operand:
        if token.text in CONSTANTS:
            return Operand(self.graph.number(CONSTANTS[token.text]), token.start, token.end)
        if token.text in FUNCTIONS:
            following = self._next.text if self._next.kind in ("name", "number") else "x"
            example = f"{token.text}({following})" if FUNCTIONS[token.text].least == 1 else f"{token.text}(...)"
            raise FormulaError(
                f"{token.text} at {token.position} needs its arguments in parentheses: {example}", token.position
            )
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
            self._refuse_function(name)
        arguments: list[Operand] = []
        if self._next.text != ")":
            arguments.append(self._nested(opening, 0))
            while self._next.text == ",":
                self._take()
                arguments.append(self._nested(opening, 0))
        closing = self._close(opening)
        self._check_count(name, len(arguments))
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
            shown, place = _shortened(self.text[start:end].strip()), start + 1
            raise FormulaError(f"{shown} at {place} {_fault(operation, numbers, result)}", place)
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
            raise FormulaError(
                f"( at {opening.position} is never closed; add ) at {self._next.position}", opening.position
            )
        self._refuse_leftover()

    def _refuse_leftover(self) -> NoReturn:
        """Whatever cannot follow a complete expression."""
        token = self._next
        self._refuse_missing_operator()
        if token.text == ")":
            raise FormulaError(f") at {token.position} closes nothing; no ( is open there", token.position)
        if token.text == ",":
            raise FormulaError(
                f"comma at {token.position} is outside a call; a decimal number has a point as in 0.5",
                token.position,
            )
        raise FormulaError(f"{token} at {token.position} has no if; write a if condition else b", token.position)

    def _refuse_missing_operator(self) -> None:
        """Complain if an operand follows an operand, as in 2x."""
        token, before = self._next, self.tokens[self._at - 1]
        starts_operand = token.kind in ("number", "name") and token.text not in {"else", "if", "and", "or"}
        if not starts_operand and token.text != "(":
            return
        place = token.position
        if before.text == ")" or token.text == "not":
            raise FormulaError(f"missing operator at {place} before {token}; to multiply write *", place)
        right = f"{token}(...)" if token.text in FUNCTIONS else "(...)" if token.text == "(" else token.text
        raise FormulaError(f"missing operator at {place}; did you mean {before}*{right}?", place)

    def _refuse_function(self, name: Token) -> NoReturn:
        place = name.position
        if name.text in CONSTANTS:
            raise FormulaError(f"{name} at {place} is a number, not a function; did you mean {name}*(...)?", place)
        close = difflib.get_close_matches(name.text.lower(), FUNCTIONS, n=1)
        hint = close[0] if close and len(name.text) > 1 else f"{name}*(...)"
        raise FormulaError(f"unknown function {name} at {place}; did you mean {hint}?", place)

    def _refuse_nesting(self, token: Token) -> NoReturn:
        raise FormulaError(
            f"nested more than {DEEPEST_NESTING} deep at {token.position}; use fewer parentheses",
            token.position,
        )

    def _check_count(self, name: Token, count: int) -> None:
        signature = FUNCTIONS[name.text]
        if count >= signature.least and (signature.most is None or count <= signature.most):
            return
        relatives = [other for other in FUNCTIONS if other.rstrip("2") == name.text.rstrip("2")]
        fits = [other for other in relatives if other != name.text and FUNCTIONS[other].least == count]
        hint = f"; did you mean {fits[0]}?" if fits else ""
        place = name.position
        raise FormulaError(f"{name} takes {signature}, not {count} at {place}{hint}", place)


def _fault(operation: str, values: list[float], result: float) -> str:
    """Why a constant is refused."""
    negative_power = operation == "power" and values[0] == 0.0
    if negative_power or (operation in ("divide", "mod") and values[1] == 0.0):
        return "divides by zero"
    if result != result:
        return "is not a real number"
    return "is infinite" if operation in ("log", "log2") else "is too large for a number"


def _shortened(text: str) -> str:
    """``text``, or its two ends where it is long."""
    return text if len(text) <= 40 else f"{text[:18]}...{text[-18:]}"
