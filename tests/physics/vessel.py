"""A vessel of air that is stepped by the equations of `core.physics.air`, and accounts for its energy."""

from dataclasses import dataclass

from uictest.core.physics.air import air_changes, enthalpy

K = 1.4
R = 287.05
CV = R / (K - 1.0)
CP = K * CV
WALL = 293.15
VOLUME = 2e-3
BARE = 2.6
"""Heat conductance of a bare tank of two litres, W/K."""


@dataclass
class Vessel:
    """Air in a vessel; what it gained since it was filled is summed up beside it."""

    mass: float
    temperature: float = WALL
    volume: float = VOLUME
    heat: float = 0.0
    work: float = 0.0
    carried: float = 0.0

    def __post_init__(self):
        self.pressure = self.mass * R * self.temperature / self.volume

    @property
    def energy(self):
        return self.mass * CV * self.temperature

    def step(self, gained=0.0, source=WALL, *, growth=0.0, exchange=0.0):
        """Gain air (kg) from a source (K), or lose it, and change volume (m3)."""
        carried = enthalpy(gained, source, self.temperature, CP)
        self.mass += gained
        self.volume += growth
        self.work += self.pressure * growth
        now = self.pressure, self.temperature, self.mass
        warming, rise = air_changes(*now, gained, carried, self.volume, growth, WALL, exchange, R, CV)
        self.temperature += warming
        self.pressure += rise
        self.carried += carried
        self.heat += exchange * (WALL - self.temperature)


def filled(pressure, temperature=WALL, volume=VOLUME):
    return Vessel(pressure * volume / (R * temperature), temperature, volume)
