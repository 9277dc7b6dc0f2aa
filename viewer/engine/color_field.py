"""Parameters that are colours."""

from __future__ import annotations

from viewer.engine.fields import Field, Uniform


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
            if len(text) != 7:
                raise ValueError
            return [channel / 255.0 for channel in bytes.fromhex(text[1:])]
        return [float(channel) for channel in text.split(",")]

    def text(self, value: tuple[float, float, float]) -> str:
        return "#" + "".join(f"{round(channel * 255):02x}" for channel in value)

    def stored(self, value: tuple[float, float, float]) -> str:
        return self.text(value)

    def uniform(self, value: tuple[float, float, float]) -> Uniform:
        return tuple(linear_light(channel) for channel in value)


def linear_light(encoded: float) -> float:
    """One sRGB channel in 0 to 1 as linear light (IEC 61966-2-1)."""
    return encoded / 12.92 if encoded <= 0.04045 else ((encoded + 0.055) / 1.055) ** 2.4
