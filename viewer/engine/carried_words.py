"""Words that speak of a model's own parts, when another model takes its place."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, TypeVar

from viewer.engine.params import Parameters
from viewer.errors import DemoscopeError

Meaning = TypeVar("Meaning")


class CarriedWords:
    """Parameters that name parts of a model: right for one, they may mean nothing in the next.

    What was set before the model was exchanged and means nothing in the new one is passed over, and told in
    ``remarks``; what is set for the model at hand has to mean something. ``source`` tells one model from another.
    """

    def __init__(self, params: Parameters, names: Sequence[str], source: object) -> None:
        self._params, self._source = params, source
        former, carried = vars(params).get("_carried_words", (source, {}))
        self._carried: dict[str, Any] = carried if former == source else {name: params.get(name) for name in names}
        self._passed_over: dict[str, str] = {}

    def settle(self) -> None:
        """The new scene stands: from now on its model is the one that words are for."""
        vars(self._params)["_carried_words"] = self._source, self._carried

    def meant(self, name: str, meaning: Callable[[], Meaning], otherwise: Meaning) -> Meaning:
        """What ``meaning`` finds for a parameter, or ``otherwise`` where it fails over a word from another model."""
        self._passed_over.pop(name, None)
        try:
            return meaning()
        except DemoscopeError as error:
            if name not in self._carried or self._carried[name] != self._params.get(name):
                raise
            self._passed_over[name] = str(error)
            return otherwise

    def remarks(self) -> list[str]:
        """What was passed over, and why."""
        return [f"Not used: {why}" for why in self._passed_over.values()]
