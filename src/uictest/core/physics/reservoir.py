"""Main reservoir and compressor: an isothermal vessel filled between two pressures."""

from uictest.core.physics.arithmetic import select


def compressor_running(pressure: float, running: float, cut_in: float, cut_out: float) -> float:
    """Return 1.0 while the compressor runs and 0.0 while it rests.

    It starts below ``cut_in``, stops above ``cut_out`` and keeps its state between them (all Pa, same
    reference).
    """
    return select(pressure < cut_in, 1.0, select(pressure > cut_out, 0.0, running))


def isothermal_pressure(mass: float, stiffness: float) -> float:
    """Absolute pressure in Pa of ``mass`` kg of air: p = m R T / V, with ``stiffness`` R T / V in Pa/kg.

    A vessel of hundreds of litres loses a few per cent of its air in a stop over many seconds: it stays
    at room temperature.
    """
    return mass * stiffness
