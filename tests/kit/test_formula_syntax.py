"""What the formula language accepts and what it means, what it refuses and with which words."""

from __future__ import annotations

import time

import numpy as np
import pytest

from viewer.errors import DemoscopeError
from viewer.kit.formula import FormulaError, parse

VALUES = {"x": 0.7, "y": -1.3, "z": 2.2}


@pytest.mark.parametrize(
    ("text", "python"),
    [
        ("-x^2", "-(x**2)"),
        ("2^-x", "2**(-x)"),
        ("2^-x*3", "2**(-x)*3"),
        ("2^3^2", "2**9"),
        ("x**2**0.5", "x**(2**0.5)"),
        ("-2^2", "-4"),
        ("x - y - z", "(x-y)-z"),
        ("x / z / y", "(x/z)/y"),
        ("x - (y - z)", "x-(y-z)"),
        ("7 % 3 * 2", "2"),
        ("-7 % 3", "2"),
        ("7 % -3", "-2"),
        ("x + y * z", "x+(y*z)"),
        ("--x", "x"),
        ("+x", "x"),
        (".5 + 2e-3 + 1. + 1E2", "0.5+0.002+1+100"),
        ("x < 1", "1"),
        ("0 < x < 1", "1"),
        ("0 < x < 0.5", "0"),
        ("3 > x > 0 > y", "1"),
        ("not x < 1", "0"),
        ("not 0 + 1", "0"),
        ("x > 1 or y < 0 and z > 0", "1"),
        ("1 if x > 1 else 2 if y > 0 else 3", "3"),
        ("1 if (0 if x else 1) else 2", "2"),
        ("x + 1 if x > 0 else y", "x+1"),
        ("min(3, x, 2, y)", "y"),
        ("length(3, 4)", "5"),
        ("length(y)", "-y"),
        ("length(1, 1, 1, 1, 1, 1, 1, 1, 1)", "3"),
        ("pi + tau - 3*pi", "0"),
        ("log(e)", "1"),
        ("\t x\n +\r\n y ", "x+y"),
    ],
)
def test_operators_bind_as_in_mathematics(text: str, python: str) -> None:
    expected = eval(python, {}, VALUES)  # our own text, in a test
    assert parse(text).evaluate(**VALUES) == pytest.approx(expected, abs=1e-12)


def test_variables_are_all_free_names_sorted() -> None:
    assert parse("amplitude * cos(frequency * x) + 0*unused^0 + pi").variables == (
        "amplitude",
        "frequency",
        "unused",
        "x",
    )
    assert parse("2").variables == ()


def test_formula_is_a_value() -> None:
    formula = parse("x + 1")
    assert formula == parse("x + 1")
    assert hash(formula) == hash(parse("x + 1"))
    assert str(formula) == formula.text == "x + 1"
    with pytest.raises(AttributeError):
        formula.source = "x"  # type: ignore[misc]


MESSAGES = [
    ("2*sine(x)", "unknown function sine at 3; did you mean sin?", 3),
    ("sin(x", "( at 4 is never closed; add ) at 6", 4),
    ("((x)", "( at 1 is never closed; add ) at 5", 1),
    ("x+1)", ") at 4 closes nothing; no ( is open there", 4),
    (")", "expected a number, a name or ( at 1, found )", 1),
    ("", "empty formula at 1; write an expression such as sin(x)", 1),
    (" \n ", "empty formula at 1; write an expression such as sin(x)", 1),
    (None, "a formula is text, not NoneType", 1),
    (3, "a formula is text, not int", 1),
    (b"x", "a formula is text, not bytes", 1),
    ("2x", "missing operator at 2; did you mean 2*x?", 2),
    ("x y", "missing operator at 3; did you mean x*y?", 3),
    ("2(x+1)", "missing operator at 2; did you mean 2*(...)?", 2),
    ("2 sin(x)", "missing operator at 3; did you mean 2*sin(...)?", 3),
    ("(x)(y)", "missing operator at 4 before (; to multiply write *", 4),
    ("(x 2)", "missing operator at 4; did you mean x*2?", 4),
    ("sin(x y)", "missing operator at 7; did you mean x*y?", 7),
    ("x not y", "missing operator at 3 before not; to multiply write *", 3),
    ("y = x", "= at 3 assigns, which a formula cannot; write == to compare, or only the right side", 3),
    ("1 + atan(y, x)", "atan takes 1 argument, not 2 at 5; did you mean atan2?", 5),
    ("atan2(y)", "atan2 takes 2 arguments, not 1 at 1; did you mean atan?", 1),
    ("min(x)", "min takes 2 or more arguments, not 1 at 1", 1),
    ("noise()", "noise takes 1 to 3 arguments, not 0 at 1", 1),
    ("noise(x,x,x,x)", "noise takes 1 to 3 arguments, not 4 at 1", 1),
    ("clamp(x, 0)", "clamp takes 3 arguments, not 2 at 1", 1),
    ("sin x", "sin at 1 needs its arguments in parentheses: sin(x)", 1),
    ("sin + 1", "sin at 1 needs its arguments in parentheses: sin(x)", 1),
    ("atan2", "atan2 at 1 needs its arguments in parentheses: atan2(...)", 1),
    ("x(2)", "unknown function x at 1; did you mean x*(...)?", 1),
    ("speed(2)", "unknown function speed at 1; did you mean speed*(...)?", 1),
    ("Sin(x)", "unknown function Sin at 1; did you mean sin?", 1),
    ("pi(2)", "pi at 1 is a number, not a function; did you mean pi*(...)?", 1),
    ("lambda x", "lambda at 1 is a reserved word; choose another name", 1),
    ("True", "True at 1 is a reserved word; write 1", 1),
    ("x is y", "is at 3 is a reserved word; write == to compare", 3),
    ("x.real", "unknown character . at 2; a name has no attributes, and a decimal number is written like 0.5", 2),
    ("a[0]", "unknown character [ at 2; a formula has no indexing; parentheses are ( )", 2),
    ("'a'", "unknown character ' at 1; a formula has no text in quotes", 1),
    ("{x}", "unknown character { at 1; parentheses are ( )", 1),
    ("x; y", "unknown character ; at 2; a formula is a single expression", 2),
    ("x && y", "unknown character & at 3; type and", 3),
    ("x || y", "unknown character | at 3; type abs(...) for a value without its sign, or or between conditions", 3),
    ("!x", "unknown character ! at 1; type not, or != to compare", 1),
    ("x ? 1 : 2", "unknown character ? at 3; a choice is written a if c else b", 3),
    ("x @ y", "unknown character @ at 3; operators are + - * / % ^", 3),
    ("x \u2212 1", "unknown character \u2212 at 3; type the ASCII minus -", 3),
    ("x\u00d72", "unknown character \u00d7 at 2; type * to multiply", 2),
    ("x\u00f72", "unknown character \u00f7 at 2; type / to divide", 2),
    ("x\u00b2", "unknown character \u00b2 at 2; type ^2 for a power", 2),
    ("2*\u03c0", "unknown character \u03c0 at 3; type pi", 3),
    ("\uff53in(x)", "unknown character \uff53 at 1; type the ASCII s", 1),
    ("x\uff0b1", "unknown character \uff0b at 2; type the ASCII +", 2),
    ("\u0455in(x)", "unknown character \u0455 at 1; names have ASCII letters, digits and underscores only", 1),
    ("x\u00a0+ 1", "unknown character U+00A0 at 2; type an ordinary space", 2),
    ("x\x00", "unknown character U+0000 at 2", 2),
    ("x \u2264 1", "unknown character \u2264 at 3; type <=", 3),
    ("x +", "expected a number, a name or ( at 4 after +, found the end", 4),
    ("*x", "expected a number, a name or ( at 1, found *", 1),
    ("x // 2", "expected a number, a name or ( at 4 after /, found /", 4),
    ("sin(x,)", "expected a number, a name or ( at 7 after a comma, found )", 7),
    ("x and", "expected a number, a name or ( at 6 after and, found the end", 6),
    ("1,5", "comma at 2 is outside a call; a decimal number has a point as in 0.5", 2),
    ("(1,5)", "comma at 3 is outside a call; a decimal number has a point as in 0.5", 3),
    ("1.2.3", "1.2.3 at 1 is not a number; use one point as in 0.5", 1),
    ("x if y", "if at 3 has no else; write a if condition else b", 3),
    ("x if y z", "missing operator at 8; did you mean y*z?", 8),
    ("x else 3", "else at 3 has no if; write a if condition else b", 3),
    ("9**9**9**9", "9**9**9 at 4 is too large for a number", 4),
    ("x + 9^9^9", "9^9^9 at 5 is too large for a number", 5),
    ("1e999", "1e999 at 1 is too large for a number", 1),
    ("1e39", "1e39 at 1 is too large for a number", 1),
    ("1e30*1e30", "1e30*1e30 at 1 is too large for a number", 1),
    ("x + 1/0", "1/0 at 5 divides by zero", 5),
    ("5 % (1 - 1)", "5 % (1 - 1) at 1 divides by zero", 1),
    ("0^-1", "0^-1 at 1 divides by zero", 1),
    ("log(-1)", "log(-1) at 1 is not a real number", 1),
    ("log(0)", "log(0) at 1 is infinite", 1),
    ("x*sqrt(-2)", "sqrt(-2) at 3 is not a real number", 3),
    ("(-8)^(1/3)", "(-8)^(1/3) at 1 is not a real number", 1),
    ("a" * 33, "name aaaaaaaaaaaa... at 1 has 33 characters; at most 32 are allowed", 1),
    ("x" + "+x" * 1000, "formula of 2,001 characters is too long at 2001; at most 2,000 are allowed", 2001),
    ("(" * 65 + "x" + ")" * 65, "nested more than 64 deep at 65; use fewer parentheses", 65),
    ("-" * 65 + "x", "nested more than 64 deep at 65; use fewer parentheses", 65),
    ("2^" * 65 + "x", "nested more than 64 deep at 130; use fewer parentheses", 130),
    ("+-" * 20 + "x" + "+-x" * 600, "more than 1,000 operations at 1485; use a shorter formula", 1485),
]


@pytest.mark.parametrize(("text", "message", "position"), MESSAGES)
def test_mistake_is_named_with_its_place_and_its_remedy(text: str, message: str, position: int) -> None:
    with pytest.raises(FormulaError) as caught:
        parse(text)
    assert str(caught.value) == message
    assert caught.value.position == position
    assert isinstance(caught.value, DemoscopeError)


HOSTILE = [
    "(" * 10_000 + "x" + ")" * 10_000,
    "+x" * 500_000,
    "9**9**9**9",
    "9^" * 900 + "9",
    "-" * 1_999 + "x",
    "not " * 400 + "x",
    "sin(" * 400 + "x",
    "1 or 1 and 1<1+1*1^(" * 60 + "x",
    "x if x else " * 150 + "x",
    "(" * 2_000,
    ")" * 2_000,
    "x" * 2_000,
    "1" * 2_000,
    "." * 2_000,
    "1e" + "9" * 1_500,
    "".join(f"v{n}+" for n in range(300)),
    "f(" * 600,
    "min(" + "," * 1_000 + ")",
    "\U0001d431" * 100,
    "__import__('os').system('true')",
    "().__class__.__bases__",
]


@pytest.mark.parametrize("text", HOSTILE, ids=range(len(HOSTILE)))
def test_hostile_text_is_refused_at_once(text: str) -> None:
    begin = time.perf_counter()
    with pytest.raises(FormulaError) as caught:
        parse(text)
    assert time.perf_counter() - begin < 0.05
    assert len(str(caught.value)) < 160
    assert caught.value.position is not None


def test_nesting_of_sixty_four_is_allowed() -> None:
    assert parse("(" * 64 + "x" + ")" * 64).evaluate(x=2.0) == 2.0
    assert np.isfinite(parse("sin(" * 64 + "x" + ")" * 64).evaluate(x=2.0))


@pytest.mark.parametrize("join", ["+", "-", "*", "/"])
def test_thousand_terms_are_read_differentiated_and_written(join: str) -> None:
    formula = parse(join.join("x" * 1000))
    slope = formula.gradient()["x"]
    assert len(slope.glsl("slope", ["x"])) < 100_000
    assert len(str(slope)) < 100_000
    assert np.isfinite(slope.gradient()["x"].evaluate(x=1.0))


def test_random_bytes_are_read_or_refused_but_never_break_the_parser() -> None:
    random = np.random.default_rng(5)
    letters = [*"xyz0123456789.()+-*/%^<>=!,eE_ \t", "sin(", "noise(", " if ", " else ", "and ", "not ", "é"]
    for _ in range(3000):
        text = "".join(random.choice(letters, random.integers(1, 25)))
        try:
            formula = parse(text)
        except FormulaError as error:
            assert error.position is not None and 1 <= error.position <= len(text) + 1, text
        else:
            formula.gradient()["x"].glsl("f", [*formula.variables, *{"x"}.difference(formula.variables)])
