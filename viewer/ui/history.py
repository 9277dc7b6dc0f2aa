"""Undo and redo of parameter changes; a drag, or a word typed, is one entry."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

Values: TypeAlias = Mapping[str, Any]
LONGEST = 500


@dataclass
class Change:
    """All values before and after, as presets store them, and what was changed."""

    subject: str
    before: Values
    after: Values


class History:
    """Changes in order, and how many of them are in force.

    Consecutive changes of one subject melt into one until ``settle`` is called.
    """

    def __init__(self) -> None:
        self._changes: list[Change] = []
        self._in_force = 0
        self._open = False

    @property
    def can_undo(self) -> bool:
        """Whether there is something to take back."""
        return self._in_force > 0

    @property
    def can_redo(self) -> bool:
        """Whether something was taken back."""
        return self._in_force < len(self._changes)

    def record(self, subject: str, before: Values, after: Values) -> None:
        """Remember a change that has just been made."""
        del self._changes[self._in_force:]
        last = self._changes[-1] if self._changes else None
        if last and self._open and last.subject == subject:
            last.after = after
        else:
            last = Change(subject, before, after)
            self._changes.append(last)
        self._open = last.after != last.before
        if not self._open:
            self._changes.pop()     # back where it began; what the hand does next melts into nothing earlier
        del self._changes[:-LONGEST]
        self._in_force = len(self._changes)

    def settle(self) -> None:
        """The hand has left the widget: the next change is an entry of its own."""
        self._open = False

    def undo(self) -> Values | None:
        """The values to go back to, or None."""
        self.settle()
        if not self.can_undo:
            return None
        self._in_force -= 1
        return self._changes[self._in_force].before

    def redo(self) -> Values | None:
        """The values to go forward to, or None."""
        self.settle()
        if not self.can_redo:
            return None
        self._in_force += 1
        return self._changes[self._in_force - 1].after
