"""The stops that a criterion applies to: what it asks for, and the conditions of a stop."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final, Literal, NamedTuple

from uictest.core.units import in_unit, value_text
from uictest.plans import scenario
from uictest.plans.scenario.yaml import Model, Quantity, optional, quantity


class NominalSpeed(Model):
    """An initial speed with the tolerance within which a stop is judged; distances are corrected to it."""

    value: Quantity = quantity("Nominal initial speed.", "speed", "> 0 km/h .. 600 km/h")
    tolerance: Quantity = quantity("Largest deviation either way.", "speed", "0 km/h .. 600 km/h")


class NominalShare(Model):
    """A brake command with its tolerance."""

    value: Quantity = quantity("Nominal command.", "share", "> 0 % .. 100 %")
    tolerance: Quantity = quantity("Largest deviation either way.", "share", "0 % .. 100 %")


class NominalGradient(Model):
    """A gradient with its tolerance."""

    value: Quantity = quantity(
        "Nominal gradient, positive uphill.", "gradient", "-60 permille .. 60 permille"
    )
    tolerance: Quantity = quantity("Largest deviation either way.", "gradient", "0 permille .. 120 permille")


Nominal = NominalSpeed | NominalShare | NominalGradient


class Applicability(Model):
    """Conditions of a stop under which a criterion applies; a condition that is not named is not checked."""

    rail_condition: tuple[str, ...] | None = optional("Names of rail conditions, e.g. wet.")
    rail_condition_other_than: tuple[str, ...] | None = optional(
        "Names of rail conditions that the criterion is not for, e.g. dry."
    )
    rail_cleaned: bool | None = optional(
        "Whether sliding cleans the rail; a recorded rail answers as it does and meets either.", strict=True
    )
    wsp: tuple[Literal["active", "bypassed"], ...] | None = optional("States of the WSP.")
    brake_position: tuple[str, ...] | None = optional("Brake positions, e.g. R.")
    topology: tuple[Literal["one-caliper", "four-caliper"], ...] | None = optional("Topologies of the rig.")
    initial_speed: NominalSpeed | None = optional("Initial speed; distances are corrected to it.")
    command: NominalShare | None = optional("Share of the full service command.")
    gradient: NominalGradient | None = optional("Gradient of the track.")


class TestConditions(NamedTuple):
    """Conditions of a stop that a criterion can require.

    `command` is a share of full service, the first of so many `commands`; `gradient` a share, positive
    uphill. `drag` tells whether traction holds a speed, `has_faults` whether the scenario injects any,
    `rail_cleaned` whether sliding cleans its rail; None where that is not known.
    """

    rail_condition: str
    wsp: str
    position: str
    command: float
    gradient: float
    topology: str
    has_faults: bool = False
    rail_cleaned: bool | None = None
    commands: int = 1
    drag: bool = False


def test_conditions_of(resolved: scenario.Scenario) -> TestConditions:
    """Return the conditions that a resolved scenario states."""
    return TestConditions(
        rail_condition=resolved.rail.condition.name,
        wsp=resolved.rig.wsp,
        position=resolved.brake.position,
        command=resolved.brake.first_command,
        commands=len(resolved.brake.commands),
        drag=resolved.drag is not None,
        gradient=resolved.rail.gradient,
        topology=resolved.rig.topology,
        has_faults=bool(resolved.faults),
        rail_cleaned=resolved.rail.cleaning_in_force is not None,
    )


def corrections(
    resolved: scenario.Scenario, criterion: scenario.Criterion | None = None
) -> dict[str, scenario.Quantity]:
    """Return the nominal speed and gradient that distances and adhesions are corrected to.

    The nominal speed is the one that the criterion is for. Without one it is that of the first criterion of
    the scenario that is for stops from its initial speed, else this speed itself.
    """
    own = criterion.applies.initial_speed if criterion else None
    every = (each.applies.initial_speed for profile in resolved.criteria for each in profile.criteria)
    fitting = (each.value for each in every if each is not None and _is_within(resolved.initial_speed, each))
    nominal = own.value if own else next(fitting, resolved.initial_speed)
    return {"nominal_speed": nominal, "gradient": resolved.rail.gradient}


def observed_quantities(
    criterion: scenario.Criterion, profile: scenario.Criteria, resolved: scenario.Scenario
) -> Iterator[tuple[str, scenario.Quantity, str]]:
    """Yield the quantities that the measure of a criterion depends on: name, value, mark of the source.

    These are the definitions of the observation, and the conditions that the measure is corrected to.
    """
    observation = resolved.measures
    for name in criterion.observed_by:
        quantity = getattr(observation, name)
        yield name, quantity, scenario.mark_of(quantity, observation.sources)
    of_others = {key: each for other in resolved.criteria for key, each in other.sources.items()}
    sources = {**of_others, **profile.sources}
    conditions = corrections(resolved, criterion) if criterion.corrected else {}
    for name in criterion.corrected:
        yield name, conditions[name], scenario.mark_of(conditions[name], sources)


_OF_TESTS: Final = {
    "initial speed": "from",
    "brake command": "at a brake command of",
    "gradient": "on a gradient of",
    "brake position": "in brake position",
}
"""Conditions that tell tests of one kind apart, on the same kind of rail, and how they are named."""


class UnmetCondition(NamedTuple):
    """A condition of a criterion that a stop does not meet: names, or a nominal value in `unit`."""

    what: str
    value: str | float
    accepted: Sequence[str] | scenario.Nominal
    unit: str = ""

    @property
    def tells_tests_apart(self) -> bool:
        """Whether it is of the test, not of the kind of rail or of the rig."""
        return self.what in _OF_TESTS

    @property
    def no_such_test(self) -> str:
        """Why the stop is not such a test: `no stop from 120 km/h (it is 124 km/h, tolerance 3 km/h)`."""
        which = f"no stop {_OF_TESTS[self.what]}"
        if not isinstance(self.accepted, scenario.Nominal):
            return f"{which} {' or '.join(self.accepted)} (it is {self.value})"
        nominal, tolerance = (
            self._number_in_words(self.accepted.value),
            self._number_in_words(self.accepted.tolerance),
        )
        return f"{which} {nominal} (it is {self._number_in_words(self.value)}, tolerance {tolerance})"

    def __str__(self) -> str:
        """Return the value of the stop and the values that the criterion accepts, in words."""
        if not isinstance(self.accepted, scenario.Nominal):
            return f"{self.what} is {self.value}, the criterion is for {' or '.join(self.accepted)}"
        tolerance = self._number_in_words(self.accepted.tolerance)
        nominal = f"{in_unit(self.accepted.value, self.unit):.4g} +- {tolerance}"
        return f"{self.what} is {self._number_in_words(self.value)}, the criterion is for {nominal}"

    def _number_in_words(self, number: str | float) -> str:
        return value_text(in_unit(float(number), self.unit), self.unit)


def unmet_conditions(
    applies: scenario.Applicability, conditions: TestConditions, initial_speed: float | None
) -> list[UnmetCondition]:
    """Return the conditions that a stop from `initial_speed` (m/s) does not meet: none where it applies.

    An initial speed that is not known (None) meets every condition.
    """
    names = (
        ("rail", conditions.rail_condition, applies.rail_condition),
        ("WSP", conditions.wsp, applies.wsp),
        ("brake position", conditions.position, applies.brake_position),
        ("topology", conditions.topology, applies.topology),
    )
    numbers = (
        ("initial speed", initial_speed, applies.initial_speed, "km/h"),
        ("brake command", conditions.command if conditions.commands == 1 else None, applies.command, "%"),
        ("gradient", conditions.gradient, applies.gradient, "permille"),
    )
    unmet = [
        *(
            UnmetCondition(what, name, accepted)
            for what, name, accepted in names
            if accepted is not None and name not in accepted
        ),
        *(
            UnmetCondition(what, number, accepted, unit)
            for what, number, accepted, unit in numbers
            if number is not None and accepted is not None and not _is_within(number, accepted)
        ),
    ]
    if conditions.rail_condition in (applies.rail_condition_other_than or ()):
        unmet.append(UnmetCondition("rail", conditions.rail_condition, ("any other",)))
    if conditions.commands > 1 and applies.command is not None:
        unmet.append(UnmetCondition("brake command", "a course of several", ("one application",)))
    cleaned = conditions.rail_cleaned
    if cleaned is not None and applies.rail_cleaned not in (None, cleaned):
        was, wanted = ("cleaned by sliding", "not cleaned by sliding")[:: 1 if cleaned else -1]
        unmet.append(UnmetCondition("rail", was, (wanted,)))
    return unmet


def applies_to(criterion: scenario.Criterion, resolved: scenario.Scenario) -> bool:
    """Return whether a criterion applies to the stop that a resolved scenario states."""
    conditions = test_conditions_of(resolved)
    return not unmet_conditions(criterion.applies, conditions, float(resolved.initial_speed))


def _is_within(value: float, accepted: scenario.Nominal) -> bool:
    # Written so that NaN is not within; the last digits belong to unit conversion, not to the stop.
    return abs(value - accepted.value) <= accepted.tolerance * (1.0 + 1e-9)
