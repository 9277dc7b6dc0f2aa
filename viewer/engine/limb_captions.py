"""Captions under limbs: plates with the cross section before and after, and the numbers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from viewer.engine.annotations import Label
from viewer.engine.gpu import Gpu
from viewer.engine.limb_skin import LimbSkin
from viewer.engine.sketch import Sketch, strokes
from viewer.kit.cross_section import CrossSection, flattened, limb_section
from viewer.kit.limb import Limb
from viewer.kit.limb_caption import Caption, Outline, caption
from viewer.kit.limb_measure import LimbNumbers
from viewer.kit.quaternion import Numbers
from viewer.kit.srgb import color_of

LINEAR, EXTRA, DUAL = ("Linear blending", "#d55e00"), ("{} extra bone{}", "#0072b2"), ("Dual quaternions", "#009e73")


class LimbCaptions:
    """Stands under the limbs that are shown, one caption each."""

    def __init__(self, gpu: Gpu) -> None:
        self._sketch = Sketch(gpu)
        self.numbers: list[LimbNumbers] = []        # of the limbs that are captioned
        self._captions: list[Caption] = []
        self._cut: tuple[Limb, float, CrossSection, Numbers] | None = None

    def show(self, skins: Sequence[LimbSkin], aspect: float, apart: float, place: float | None,
             em: float) -> None:
        """Caption these from now on, ``apart`` half heights of the picture from one to the next.

        ``place`` is where they are cut, 0 to 1, or None not to show that; ``em`` a standard letter height, in half
        heights too.
        """
        room = min(apart, 2.0 * aspect / len(skins)) if len(skins) > 1 else 2.0 * aspect
        self._captions, self.numbers = [], []
        for column, skin in enumerate(skins):
            if skin.shared.limb:
                title, color = titled(skin)
                numbers = skin.numbers()
                if numbers and skin.is_bent:
                    numbers = replace(numbers, min_radius_ratio=math.nan, thinnest=math.nan)    # there is no one axis
                self.numbers += [numbers] if numbers else []
                outlines = None if place is None else self._outlined(skin, skin.shared.limb, place)
                self._captions.append(caption(
                    apart / aspect * (column - 0.5 * (len(skins) - 1)), room, title, color, numbers, outlines,
                    aspect, em))
        drawn = [strokes(segments, width, color_of(color)) for each in self._captions
                 for segments, width, color in each.drawings]
        self._sketch.show([each.rectangle for each in self._captions], drawn)

    @property
    def top(self) -> float:
        """How high in the picture they reach, -1 where there are none."""
        return max((each.rectangle[3] for each in self._captions), default=-1.0)

    def draw(self) -> None:
        """Draw plates and cross sections: in ``Scene.draw_over``."""
        self._sketch.draw()

    def labels(self) -> Sequence[Label]:
        """What is written on them."""
        return [Label(line.text, line.place, line.size, line.color, line.align, line.plate, line.bold)
                for each in self._captions for line in each.lines]

    def _outlined(self, skin: LimbSkin, limb: Limb, place: float) -> tuple[Outline, Outline] | None:
        """A limb's cross section as it was bound and as it is, each with the same point of the skin, or None."""
        if self._cut is None or self._cut[0] is not limb or self._cut[1] != place:
            section = limb_section(limb, place)
            bound = section.points(limb.mesh.positions)
            self._cut = limb, place, section, flattened(limb, bound, place)
        _, _, section, before = self._cut
        if not len(section.ends):
            return None
        after = flattened(limb, section.points(skin.posed()[0]), place, skin.upper)
        mark = int(before[:, 0, 0].argmax())
        return Outline(before, before[mark, 0]), Outline(after, after[mark, 0])


def titled(skin: LimbSkin) -> tuple[str, str]:
    """What a way of skinning is called, and its colour."""
    extra = skin.twist_bones
    bones = EXTRA[0].format(extra, "s" if extra > 1 else "")
    if skin.method == "dual_quaternion":
        return (f"{DUAL[0]}, {bones}" if extra else DUAL[0]), DUAL[1]
    return (bones, EXTRA[1]) if extra else LINEAR
