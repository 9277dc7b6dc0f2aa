"""Changes of parameters, each of which can be taken back."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from viewer.engine.presets import Preset
from viewer.engine.stage import Stage
from viewer.errors import DemoscopeError
from viewer.ui.history import History


class Editor:
    """Changes the parameters of the stage that is on, as steps of a history."""

    def __init__(self) -> None:
        self.history = History()

    @property
    def stage(self) -> Stage | None:
        """The stage that is on, if any."""
        raise NotImplementedError

    def tell(self, error: Exception) -> None:
        """Show an error to the user."""
        raise NotImplementedError

    def change(self, subject: str, values: Mapping[str, object]) -> DemoscopeError | None:
        """Set parameters as one step of the history; returns the error instead of raising it."""
        assert self.stage
        stage = self.stage
        return self._remembered(subject, lambda: stage.update_params(values))

    def reset(self, name: str | None = None) -> DemoscopeError | None:
        """Set one parameter, or all, to the default."""
        if not self.stage:
            return None
        stage = self.stage
        return self._remembered(f"reset {name}", lambda: stage.reset_params(name))

    def apply_preset(self, preset: Preset) -> None:
        """Take over a preset's values and camera."""
        if not self.stage:
            return
        stage = self.stage
        error = self._remembered(f"preset {preset.name}", lambda: stage.apply_preset(preset))
        if error:
            self.tell(error)

    def undo(self) -> None:
        """Take the last change back."""
        self._restore(self.history.undo())

    def redo(self) -> None:
        """Make the change that was taken back again."""
        self._restore(self.history.redo())

    def _remembered(self, subject: str, work: Callable[[], object]) -> DemoscopeError | None:
        assert self.stage
        before = self.stage.params.stored()
        try:
            work()
        except DemoscopeError as error:
            return error
        after = self.stage.params.stored()
        if after != before:
            self.history.record(subject, before, after)
        return None

    def _restore(self, values: Mapping[str, object] | None) -> None:
        if values is None or not self.stage:
            return
        try:
            self.stage.update_params(values)
        except DemoscopeError as error:
            self.tell(error)
