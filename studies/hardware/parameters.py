"""What the second module is made of, declared before anything was identified on it.

It is not the caliper of the library with other numbers: four parts lie outside what the compensations of the
rig can express, and each can be taken away alone. None of the numbers was changed after the first
identification. SI units; pressures of springs and leaks are gauge where they say so.
"""

from __future__ import annotations

from math import pi
from typing import Final, NamedTuple

BAR: Final = 1e5
ATMOSPHERE: Final = 1.013e5
"""Pa; standard atmosphere, ISO 2533:1975."""
AMBIENT: Final = 293.15
"""K: walls, brake line and atmosphere."""
GAS: Final = 287.05
"""Gas constant of air, J/(kg K), ISO 2533:1975."""
CV: Final = GAS / 0.4
CP: Final = 1.4 * CV
"""Heat capacities of a diatomic gas, J/(kg K)."""
REFERENCE_DENSITY: Final = 1.185
"""Of the reference atmosphere ANR of ISO 8778, kg/m3."""
VISCOSITY: Final = 1.81e-5
"""Of air at 20 degC, Pa s."""


class Hardware(NamedTuple):
    """The module with the caliper and the tank beside it; every value is chosen unless it says otherwise."""

    # WSP valve: as for a valve of the usual size, which fills 2 L in about half a second and vents in one.
    fill_conductance: float = 6.0e-8
    """Sonic conductance C, m3/(s Pa)."""
    vent_conductance: float = 3.2e-8
    """The same, with the silencer."""
    fill_ratio: float = 0.24
    """Critical ratio b: ports and elbows behind the seat lower it from the nozzle's 0.528 (valves of
    ISO 6358 data sheets: 0.2 to 0.5)."""
    vent_ratio: float = 0.18
    """With a silencer behind it lower still."""
    exponent: float = 0.57
    """Subsonic index m of ISO 6358-1:2013, 0.5 for an ideal ellipse; valves with hoses are given above it."""
    delay: float = 0.018
    """From the command to the first motion of the seat, s."""
    travel: float = 0.016
    """From shut to open, s."""

    # Tanks of the source, 2 L; balls make up hose, dead volume and clearance, as the source says they do.
    tank_volume: float = 2.0e-3
    ball_volume: float = 0.270e-3
    """472 whole balls of 1.03 cm: all modules have equal volumes to 0.4 % with the pads at the disc."""
    bare_heat: float = 2.2
    """Heat conductance of the wall of a bare tank, W/K: 0.088 m2 at 25 W/(m2 K)."""
    ball_heat: float = 9.4
    """Of the balls: 0.157 m2 at 60 W/(m2 K)."""

    # Hose from the tank behind the dump valve to the cylinder on the bogie.
    hose_bore: float = 0.010
    """m: DN 10, a usual size of hoses to a bogie's brake cylinders (10 to 13 mm); 0: no hose, one vessel."""
    hose_length: float = 2.0
    """m: across the play between body and bogie. 0.157 L, the dead volume that the source leaves for it."""
    hose_losses: float = 4.0
    """Loss coefficient of entry, exit and two fittings with an elbow each: 0.5 + 1 + 2 x 1.25."""
    hose_heat: float = 3.8
    """Of its wall, W/K: 0.063 m2 at 60 W/(m2 K); one half at either end."""

    # Cylinder of 7 in with a return spring.
    area: float = 0.25 * pi * 0.1778**2
    """m2."""
    dead_volume: float = 0.030e-3
    """Behind the released piston, m3: 1.2 mm of its stroke."""
    cylinder_heat: float = 1.75
    """W/K: 0.07 m2 at 25 W/(m2 K)."""
    preload: float = 900.0
    """Return spring, N: moves the piston back below 0.36 bar."""
    spring_rate: float = 2200.0
    """N/m."""
    clearance: float = 3.6e-3
    """m at the piston: 1 mm a side through the lever of 1.8."""
    mass: float = 8.0
    """Piston, lever and holders as felt at the piston, kg."""
    viscous: float = 400.0
    """Of the seal, N s/m."""

    # Caliper and pads: elastic after contact.
    lever_ratio: float = 1.8
    """Force of one pad over that of the piston; the piston moves 1.8 times what both pads do together."""
    stiffness: float = 3.2e6
    """At first contact, felt at the piston, N/m."""
    stiffening: float = 1.5e9
    """N/m2, of pads that stiffen: 1.8 mm of piston travel at 10.6 kN, 0.5 mm a side of lever and pad."""
    contact_damping: float = 8.0e3
    """Pins and pads under load, N s/m."""
    coulomb: float = 90.0
    """Friction of seal and guide, N."""
    load_friction: float = 0.06
    """Friction of pins and lever, share of the contact force: makes a loop of about half a bar."""
    presliding: float = 2.0e7
    """N/m: friction builds up over some hundredths of a millimetre (Dahl) and not at once."""
    stop_stiffness: float = 2.0e7
    """N/m: of the end stop of the released piston."""
    stop_damping: float = 5.0e3
    """N s/m."""

    # Leak past the piston's seal: laminar, through a gap.
    leak_rate: float = 0.2 * BAR / 60.0
    """Fall of 3.8 bar in the shut module, Pa/s, isothermal. Ten times what a coach may lose in service
    (0.1 kgf/cm2 in 5 minutes, single car test of the Indian ICF coaches): a seal that is due."""


HARDWARE: Final = Hardware()

WITHOUT: Final = {
    "orifice": {"fill_ratio": 0.35, "vent_ratio": 0.35, "exponent": 0.5},
    "hose": {"hose_bore": 0.0},
    "travel": {"stiffness": 1e8, "stiffening": 0.0},
    "leak": {"leak_rate": 0.0},
}
"""Each difference -> what takes it away. Without a hose its volume and wall stay, in one vessel with tank
and cylinder; without travel the pads are thirty times as stiff; without the orifice's own law it has that of
the library."""


def hose_area(h: Hardware) -> float:
    """Return the cross section of the hose, m2; of the declared one where there is none."""
    bore = h.hose_bore or HARDWARE.hose_bore
    return 0.25 * pi * bore * bore


def hose_volume(h: Hardware) -> float:
    """Return what the hose holds, m3."""
    return hose_area(h) * h.hose_length


def leak_conductance(h: Hardware) -> float:
    """Return K of the leak K (p2 - pa2), kg/(s Pa2), from its rate at 3.8 bar in the shut module."""
    pressure = 3.8 * BAR + ATMOSPHERE
    volume = h.tank_volume - h.ball_volume + hose_volume(h) + h.dead_volume + h.area * h.clearance
    return h.leak_rate * volume / (GAS * AMBIENT) / (pressure**2 - ATMOSPHERE**2)
