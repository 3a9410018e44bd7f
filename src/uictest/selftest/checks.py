"""Every check of an installation, in the order in which they are asked."""

from uictest.selftest.air import AIR_CHECKS
from uictest.selftest.bits import controller_checks, stop_checks
from uictest.selftest.check import Check
from uictest.selftest.contact import CONTACT_CHECKS
from uictest.selftest.dry_stop import DRY_STOP_CHECKS
from uictest.selftest.environment import environment_checks
from uictest.selftest.friction import FRICTION_CHECKS
from uictest.selftest.judging import judging_checks
from uictest.selftest.known_stops import KnownStops
from uictest.selftest.package_data import data_checks


def all_checks(stops: KnownStops) -> tuple[Check, ...]:
    """Return all checks; those of stored stops are asked of `stops`."""
    return (
        *stop_checks(stops),
        *DRY_STOP_CHECKS,
        *AIR_CHECKS,
        *CONTACT_CHECKS,
        *FRICTION_CHECKS,
        *judging_checks(),
        *controller_checks(),
        *data_checks(),
        *environment_checks(),
    )
