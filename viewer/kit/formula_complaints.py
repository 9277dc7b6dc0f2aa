"""What to tell a person whose formula cannot be read: what is wrong, where, and what would be right."""

from __future__ import annotations

import difflib

from viewer.kit.formula_functions import CONSTANTS, FUNCTIONS
from viewer.kit.formula_tokens import OPERATOR_WORDS, FormulaError, Token

LONGEST_QUOTE = 40


def shortened(text: str) -> str:
    """``text``, or its two ends where it is long."""
    half = LONGEST_QUOTE // 2 - 2
    return text if len(text) <= LONGEST_QUOTE else f"{text[:half]}...{text[-half:]}"


def misplaced(token: Token, before: Token | None) -> FormulaError:
    """A token where an operand should be."""
    after = f" after {before}" if before is not None else ""
    place = token.position
    return FormulaError(f"expected a number, a name or ( at {place}{after}, found {token}", place)


def bare_function(name: Token, following: Token) -> FormulaError:
    """A function without parentheses."""
    argument = following.text if following.kind in ("name", "number") else "x"
    example = f"{name}({argument})" if FUNCTIONS[name.text].least == 1 else f"{name}(...)"
    place = name.position
    return FormulaError(f"{name} at {place} needs its arguments in parentheses: {example}", place)


def unknown_function(name: Token) -> FormulaError:
    """A call of something that is no function."""
    place = name.position
    if name.text in CONSTANTS:
        hint = f"did you mean {name}*(...)?"
        return FormulaError(f"{name} at {place} is a number, not a function; {hint}", place)
    close = difflib.get_close_matches(name.text.lower(), FUNCTIONS, n=1)
    hint = close[0] if close and len(name.text) > 1 else f"{name}*(...)"
    return FormulaError(f"unknown function {name} at {place}; did you mean {hint}?", place)


def wrong_count(name: Token, count: int) -> FormulaError | None:
    """A call with too few or too many arguments; None if their number is right."""
    signature = FUNCTIONS[name.text]
    if count >= signature.least and (signature.most is None or count <= signature.most):
        return None
    relatives = [other for other in FUNCTIONS if other.rstrip("2") == name.text.rstrip("2")]
    fits = [other for other in relatives if other != name.text and FUNCTIONS[other].least == count]
    hint = f"; did you mean {fits[0]}?" if fits else ""
    place = name.position
    return FormulaError(f"{name} takes {signature}, not {count} at {place}{hint}", place)


def missing_operator(token: Token, before: Token) -> FormulaError | None:
    """An operand directly after an operand, as in 2x; None if ``token`` starts no operand."""
    is_operand = token.kind == "number" or (token.kind == "name" and token.text not in OPERATOR_WORDS)
    if not is_operand and token.text not in ("(", "not"):
        return None
    place = token.position
    if before.text == ")" or token.text == "not":
        return FormulaError(f"missing operator at {place} before {token}; to multiply write *", place)
    right = f"{token}(...)" if token.text in FUNCTIONS else "(...)" if token.text == "(" else token.text
    return FormulaError(f"missing operator at {place}; did you mean {before}*{right}?", place)


def leftover(token: Token, before: Token) -> FormulaError:
    """A token that cannot follow a complete expression."""
    place = token.position
    if (missing := missing_operator(token, before)) is not None:
        return missing
    if token.text == ")":
        return FormulaError(f") at {place} closes nothing; no ( is open there", place)
    if token.text == ",":
        hint = "a decimal number has a point as in 0.5"
        return FormulaError(f"comma at {place} is outside a call; {hint}", place)
    return FormulaError(f"{token} at {place} has no if; write a if condition else b", place)


def unclosed(opening: Token, end: Token) -> FormulaError:
    """A parenthesis without its partner."""
    return FormulaError(f"( at {opening.position} is never closed; add ) at {end.position}", opening.position)


def impossible_constant(
    shown: str, place: int, operation: str, values: list[float], result: float
) -> FormulaError:
    """A constant subexpression whose value is no finite number."""
    by_zero = values[0] == 0.0 if operation == "power" else values[-1] == 0.0
    if by_zero and operation in ("divide", "mod", "power"):
        fault = "divides by zero"
    elif result != result:
        fault = "is not a real number"
    else:
        fault = "is infinite" if operation in ("log", "log2") else "is too large for a number"
    return FormulaError(f"{shortened(shown)} at {place} {fault}", place)
