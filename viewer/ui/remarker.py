"""Asks a scene for its remarks, so that the picture can carry them."""

from __future__ import annotations

from viewer.engine.scene import Scene
from viewer.engine.stage import Stage
from viewer.ui.guard import one_line
from viewer.ui.sparing_question import SparingQuestion


class Remarker:
    """Holds the latest remarks of one stage, or why there are none to be had."""

    def __init__(self, stage: Stage, *, patient: bool = True) -> None:
        self.stage = stage
        self.remarks: tuple[str, ...] = ()
        self._asking = SparingQuestion(stage, patient=patient)

    def run(self, *, dragging: bool) -> None:
        """Ask if something changed and it is time; a scene that never remarks anything is left alone."""
        if type(self.stage.scene).remarks is Scene.remarks:
            self.remarks = ()
        else:
            self._asking.run(self._ask, dragging=dragging)

    def _ask(self) -> None:
        try:
            remarks = [" ".join(remark.split()) for remark in self.stage.remarks()]
            self.remarks = tuple(dict.fromkeys(filter(None, remarks)))
        except Exception as error:
            self.remarks = (one_line(error),)
