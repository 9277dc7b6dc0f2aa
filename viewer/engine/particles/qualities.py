"""How many particles there are, and the ranges that each one's qualities are drawn from.

Reeves (1983) writes a quality as its mean plus a variance times a random number from -1 to 1; here a range
says the same: from mean minus variance to mean plus variance, evenly.
"""

from __future__ import annotations

from viewer.engine.declarations import integer, interval, slider
from viewer.engine.params import Parameters
from viewer.engine.particles.emitter import EmitterParameters

MOST_PARTICLES = 4_194_304


class EmissionParameters(EmitterParameters):
    """How many particles are born, and when."""

    count: int = integer(100_000, 1, MOST_PARTICLES, "Room for so many particles at a time", logarithmic=True,
                         rebuild=True, group="Emission")
    rate: float = slider(7000.0, 0.0, 5e6, "Particles born each second", unit="/s", group="Emission",
                         handy=(0.0, 50_000.0))
    burst: int = integer(0, 0, MOST_PARTICLES, "Particles born all at once, at the start", group="Emission")
    burst_every: float = slider(0.0, 0.0, 60.0, "Seconds from one burst to the next; 0: there is only one", unit="s",
                                group="Emission")
    emit_until: float = slider(0.0, 0.0, 600.0, "When the emitter runs dry; 0: never", unit="s", group="Emission",
                               handy=(0.0, 20.0))
    warm_up: float = slider(0.0, 0.0, 60.0, "Seconds that have passed before frame 0", unit="s", rebuild=True,
                            group="Emission")
    wave_speed: float = slider(0.0, 0.0, 100.0, "A sphere emits only where a wave from its top has just come; "
                               "0: everywhere", unit="m/s", group="Emission", handy=(0.0, 5.0), when="emitter=sphere")
    wave_width: float = slider(0.5, 0.001, 100.0, "How wide the wave is", unit="m", group="Emission",
                               handy=(0.01, 2.0), when="emitter=sphere")

    @property
    def rides_wave(self) -> bool:
        """Whether only a ring that runs over a sphere emits."""
        return bool(self.wave_speed > 0.0 and self.emitter == "sphere")


class QualityParameters(Parameters):
    """What each particle is like."""

    lifetime: tuple[float, float] = interval((2.4, 3.2), 0.02, 600.0, "How long a particle lives", unit="s",
                                             group="Particles", handy=(0.02, 10.0))
    speed: tuple[float, float] = interval((5.8, 7.6), 0.0, 200.0, "How fast it is emitted", unit="m/s",
                                          group="Particles", handy=(0.0, 20.0))
    spread: float = slider(11.0, 0.0, 180.0, "Largest angle between the normal and the way it goes", unit="degrees",
                           group="Particles")
    size: tuple[float, float] = interval((0.01, 0.028), 1e-4, 20.0, "Its diameter", unit="m", logarithmic=True,
                                         group="Particles")
    mass: tuple[float, float] = interval((1.0, 1.0), 1e-3, 1e3, "Its mass: the heavier, the less air moves it",
                                         unit="kg", logarithmic=True, group="Particles", handy=(0.01, 10.0))
    drag: tuple[float, float] = interval((0.0, 0.0), 0.0, 1e3, "Air drag: force for each m/s against the air",
                                         unit="kg/s", group="Particles", handy=(0.0, 5.0))
    spin: tuple[float, float] = interval((0.0, 0.0), -3600.0, 3600.0, "How fast its picture turns",
                                         unit="degrees/s", group="Particles", handy=(-360.0, 360.0))
    hue: tuple[float, float] = interval((0.0, 0.0), -180.0, 180.0, "How far its colour is turned round the wheel",
                                        unit="degrees", group="Particles")
    brightness: tuple[float, float] = interval((1.0, 1.0), 0.0, 10.0, "How bright it is", group="Particles",
                                               handy=(0.0, 2.0))
