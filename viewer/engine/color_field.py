"""Parameters that are colours."""

from __future__ import annotations

from viewer.engine.fields import Field, Uniform
from viewer.kit.srgb import code_of, color_of, linear_light

__all__ = ["Color", "linear_light"]


class Color(Field[tuple[float, float, float]]):
    """An sRGB colour, written ``#ff8800`` or ``1,0.53,0``; shaders get it in linear light."""

    kind = "color"
    ALLOWED = "is not a colour such as #ff8800 or 1,0.53,0"

    def parse(self, value: object) -> tuple[float, float, float]:
        try:
            channels = self._channels(value)
        except (TypeError, ValueError, OverflowError):
            raise self.refuse(value, self.ALLOWED) from None
        if len(channels) != 3 or not all(0.0 <= channel <= 1.0 for channel in channels):
            raise self.refuse(value, self.ALLOWED)
        return channels[0], channels[1], channels[2]

    @staticmethod
    def _channels(value: object) -> list[float]:
        if not isinstance(value, str):
            return [float(channel) for channel in value]  # type: ignore[attr-defined]
        text = value.strip()
        if text.startswith("#"):
            return list(color_of(text))
        return [float(channel) for channel in text.split(",")]

    def text(self, value: tuple[float, float, float]) -> str:
        return code_of(value)

    def stored(self, value: tuple[float, float, float]) -> str:
        return self.text(value)

    def uniform(self, value: tuple[float, float, float]) -> Uniform:
        return tuple(linear_light(channel) for channel in value)
