"""The words of the formula language, and the error that says where a formula went wrong."""

from __future__ import annotations

import keyword
import re
import unicodedata
from typing import NamedTuple

from viewer.errors import DemoscopeError

LONGEST_TEXT = 2000
LONGEST_NAME = 32


class FormulaError(DemoscopeError):
    """A formula that cannot be read or evaluated.

    ``position`` is the 1-based position of the offending character, or None where the mistake is not in
    the text (a missing variable, arrays whose shapes do not fit).
    """

    def __init__(self, message: str, position: int | None = None) -> None:
        super().__init__(message)
        self.position = position


class Token(NamedTuple):
    """One word of a formula; ``start`` and ``end`` are 0-based offsets into the text."""

    kind: str  # "number", "name", "operator" or "end"
    text: str
    start: int
    end: int

    @property
    def position(self) -> int:
        """1-based position of the first character."""
        return self.start + 1

    def __str__(self) -> str:
        return {"": "the end", ",": "a comma"}.get(self.text, self.text)


OPERATOR_WORDS = frozenset({"and", "or", "not", "if", "else"})
REFUSED_WORDS = frozenset(keyword.kwlist) - OPERATOR_WORDS
WORD_HINTS = {
    "True": "write 1",
    "False": "write 0",
    "is": "write == to compare",
    "in": "write a < x < b for a range",
    "None": "write a number",
}

WORD = re.compile(
    r"(?P<space>[ \t\r\n]+)"
    r"|(?P<number>(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)"
    r"|(?P<name>[A-Za-z_][A-Za-z0-9_]*)"
    r"|(?P<operator>\*\*|<=|>=|==|!=|[-+*/%^<>(),])"
)

NUMBER_LIKE = re.compile(r"[0-9.]+")

CHARACTER_HINTS = {
    **dict.fromkeys("\u2212\u2010\u2011\u2012\u2013\u2014\u00ad", "type the ASCII minus -"),
    **dict.fromkeys("\u00d7\u00b7\u22c5\u2217\u2715\u2219", "type * to multiply"),
    **dict.fromkeys("\u00f7\u2215\u2044", "type / to divide"),
    **dict.fromkeys("\u00a0\u2007\u2009\u202f\u200b\u3000", "type an ordinary space"),
    "\u2264": "type <=",
    "\u2265": "type >=",
    "\u2260": "type !=",
    "\u03c0": "type pi",
    "\u03c4": "type tau",
    "\u221a": "type sqrt(...)",
    "&": "type and",
    "|": "type abs(...) for a value without its sign, or or between conditions",
    "!": "type not, or != to compare",
    "[": "a formula has no indexing; parentheses are ( )",
    "]": "a formula has no indexing; parentheses are ( )",
    "{": "parentheses are ( )",
    "}": "parentheses are ( )",
    ".": "a name has no attributes, and a decimal number is written like 0.5",
    ":": "a choice is written a if c else b",
    "?": "a choice is written a if c else b",
    ";": "a formula is a single expression",
    **dict.fromkeys("\"'`\u2018\u2019\u201c\u201d", "a formula has no text in quotes"),
}


def tokenize(text: str) -> list[Token]:
    """The words of ``text``, the last of kind "end".

    Raises FormulaError for text that is not a string, is empty or too long, or has a character, a
    number or a name that the language does not know.
    """
    if not isinstance(text, str):
        raise FormulaError(f"a formula is text, not {type(text).__name__}", 1)
    if len(text) > LONGEST_TEXT:
        raise FormulaError(
            f"formula of {len(text):,} characters is too long at {LONGEST_TEXT + 1}; "
            f"at most {LONGEST_TEXT:,} are allowed",
            LONGEST_TEXT + 1,
        )
    if not text.strip():
        raise FormulaError("empty formula at 1; write an expression such as sin(x)", 1)
    tokens: list[Token] = []
    offset = 0
    while offset < len(text):
        match = WORD.match(text, offset)
        if match is None:
            raise _unknown_character(text, offset)
        offset = match.end()
        if match.lastgroup != "space":
            tokens.append(_checked(Token(str(match.lastgroup), match.group(), match.start(), offset), text))
    tokens.append(Token("end", "", len(text), len(text)))
    return tokens


def _checked(token: Token, text: str) -> Token:
    """``token`` itself, if it is a word that may stand in a formula."""
    place = token.position
    digits = NUMBER_LIKE.match(text, token.start)
    if token.kind == "number" and digits and digits.group().count(".") > 1:
        shown = digits.group()
        raise FormulaError(f"{shown} at {place} is not a number; use one point as in 0.5", place)
    if token.kind == "name" and len(token.text) > LONGEST_NAME:
        raise FormulaError(
            f"name {token.text[:12]}... at {place} has {len(token.text)} characters; "
            f"at most {LONGEST_NAME} are allowed",
            place,
        )
    if token.kind == "name" and token.text in REFUSED_WORDS:
        hint = WORD_HINTS.get(token.text, "choose another name")
        raise FormulaError(f"{token.text} at {place} is a reserved word; {hint}", place)
    return token


def _unknown_character(text: str, offset: int) -> FormulaError:
    """The error for a character that starts no word, with what to type instead."""
    character = text[offset]
    place = offset + 1
    if character == "=":
        return FormulaError(
            f"= at {place} assigns, which a formula cannot; write == to compare, or only the right side",
            place,
        )
    shown = character if character.isprintable() else f"U+{ord(character):04X}"
    hint = CHARACTER_HINTS.get(character) or _plain_equivalent(character)
    return FormulaError(f"unknown character {shown} at {place}" + (f"; {hint}" if hint else ""), place)


def _plain_equivalent(character: str) -> str:
    """A hint that names the ASCII text which looks like ``character``, or nothing."""
    if character.isascii() and character.isprintable():
        return "operators are + - * / % ^"
    plain = unicodedata.normalize("NFKC", character)
    if unicodedata.category(character) == "No" and plain.isdigit() and plain.isascii():
        return f"type ^{plain} for a power"
    if plain.isascii() and plain.isprintable() and plain.strip():
        return f"type the ASCII {plain}"
    return "names have ASCII letters, digits and underscores only" if character.isalnum() else ""
