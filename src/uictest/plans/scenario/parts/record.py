"""The record of a real stop: how far it may depart from the scenario that judges it."""

from uictest.plans.scenario.yaml import Model, Quantity
from uictest.plans.scenario.yaml.quantity_field import field, quantity


class RecordTolerances(Model):
    """Beyond which a record contradicts its scenario. Every default is chosen."""

    initial_speed: Quantity = quantity(
        "Difference between the initial speeds.", "speed", "0 km/h .. 100 km/h", default="3 km/h"
    )
    deceleration: Quantity = quantity(
        "Mean deceleration over what the brake can give.", "number", "1 .. 100", default="1.2"
    )
    vacuum: Quantity = quantity(
        "Pressure below that of the surroundings.", "pressure", "0 bar .. 100 bar", default="1.013 bar"
    )
    pressure_fall: Quantity = quantity(
        "Fall of a pressure while the brake is applied.", "pressure", "0 bar .. 100 bar", default="0.1 bar"
    )
    demanded_pressure: Quantity = quantity(
        "Difference of the demanded pressure from the command.", "share", "0 % .. 1000 %", default="15 %"
    )
    duration: Quantity = quantity(
        "Time to lose 10 or 90 % of the speed over what the brake needs.", "number", "1 .. 1000", default="10"
    )


class Record(Model):
    """What is checked of a recorded stop."""

    tolerances: RecordTolerances = field("Tolerances of the checks.", default=RecordTolerances())


def check_id(name: str) -> str:
    """Return what the verdict of the check with a tolerance is called."""
    return f"record-{name.replace('_', '-')}"
