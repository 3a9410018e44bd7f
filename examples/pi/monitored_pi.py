"""The PI controller with wheel rotation monitoring and a safety timer.

A wheelset that differs from the train's estimated speed v by more than A + B v for `report_after` is reported
for the rest of the stop. The rule that this follows, TB/T 3009-2019, 4.2.5 (second-hand), wants a report
within 10 s and allows A up to 50 km/h and B up to 0.3; the smaller values here are chosen, as are all others.

Bits of the diagnosis: 0 to 3 rotation of wheelsets 1 to 4, 8 to 11 their speed sensors, 16 to 19 their safety
timers.
"""

from dataclasses import replace

from pi_wsp import FILL, PiWsp

from uictest.controllers import Config, Inputs, Outputs

__version__ = "1.0"
ROTATION, SENSOR, TIMER = 0, 8, 16
"""Bit of the first wheelset for each kind of report."""

PARAMETERS = {  # of the PI controller as pi.yaml has them, then those of the monitoring
    "kp": {"default": 0.75, "unit": "s", "range": [0, 10]},
    "ki": {"default": 4.1, "unit": "1", "range": [0, 100]},
    "target": {"default": 0.032, "unit": "1", "range": [0, 1], "description": "slide that is kept"},
    "period": {"default": 0.15, "unit": "s", "range": [0.01, 1], "description": "of the pulses"},
    "release_time": {"default": 2.7, "unit": "s", "range": [0, 60]},
    "rolling_slide": {"default": 0.02, "unit": "1", "range": [0, 1]},
    "minimum_speed": {"default": 1.4, "unit": "m/s", "range": [0, 30]},
    "reference_deceleration": {"default": 2.0, "unit": "m/s2", "range": [0, 10]},
    "sliding_deceleration": {"default": 0.56, "unit": "m/s2", "range": [0, 10]},
    "probe_interval": {"default": 4.6, "unit": "s", "range": [0, 60]},
    "probe_time": {"default": 0.4, "unit": "s", "range": [0, 60]},
    "monitored_speed": {"default": 3.0, "unit": "m/s", "range": [0, 13.9], "description": "A"},
    "monitored_share": {"default": 0.1, "unit": "1", "range": [0, 0.3], "description": "B"},
    "report_after": {"default": 5.0, "unit": "s", "range": [0, 10]},
    "longest_release": {"default": 10.0, "unit": "s", "range": [0, 60], "description": "without filling"},
    "return_time": {"default": 0.5, "unit": "s", "range": [0, 60], "description": "brake given back for"},
}
MONITORING = "monitored_speed", "monitored_share", "report_after", "longest_release", "return_time"


class Monitor:
    """Watches one wheelset and latches what it reports."""

    def __init__(self, config: Config) -> None:
        self.cycle_time, p = config.cycle_time, config.parameters
        self.speed, self.share = p["monitored_speed"], p["monitored_share"]
        self.report_after, self.longest_release = p["report_after"], p["longest_release"]
        self.return_time, self.returning = p["return_time"], 0.0
        self.deviating = self.released = 0.0
        self.reports = 0

    def watch(self, speed: float, valid: bool, reference: float) -> None:
        """Report a wheelset that deviates for too long, or whose sensor reports a fault."""
        deviates = valid and abs(speed - reference) > self.speed + self.share * reference
        self.deviating = self.deviating + self.cycle_time if deviates else 0.0
        self.reports |= (self.deviating > self.report_after) << ROTATION | (not valid) << SENSOR

    def limited(self, magnets: tuple[int, int], slides: bool) -> tuple[int, int]:
        """Give the brake back for `return_time` to a wheelset that has not been filled for too long."""
        self.returning = max(self.returning - self.cycle_time, 0.0)
        self.released = self.released + self.cycle_time if slides and magnets != FILL else 0.0
        if self.released > self.longest_release:
            self.reports |= 1 << TIMER
            self.released, self.returning = 0.0, self.return_time
        return FILL if self.returning > 0.0 else magnets


class MonitoredPi(PiWsp):
    """The PI controller that believes no wheelset whose speed deviates, and reports it."""

    def __init__(self, config: Config) -> None:
        own = {key: value for key, value in config.parameters.items() if key not in MONITORING}
        super().__init__(replace(config, parameters=own))
        self.monitors_config = config

    def reset(self) -> None:
        """Return to the state after creation."""
        super().reset()
        self.monitors = [Monitor(self.monitors_config) for _ in self.config.wheel_radius]

    def step(self, inputs: Inputs) -> Outputs:
        """Decide on the coming cycle."""
        seen = list(zip(inputs.wheel_speed, inputs.speed_valid, strict=True))
        # One reading that is too high must not hold the estimate up: no faster than the second fastest.
        fastest = sorted(speed for speed, valid in seen if valid)
        train = min(self.reference, fastest[-2]) if self.is_captured(fastest) else self.reference
        for monitor, (speed, valid) in zip(self.monitors, seen, strict=True):
            monitor.watch(speed, valid, train)
        valid = [
            valid and not (monitor.deviating and speed > train) and not monitor.reports & (1 << ROTATION)
            for monitor, (speed, valid) in zip(self.monitors, seen, strict=True)
        ]
        if any(valid) and train < self.reference:
            self.reference = train
        outputs = super().step(replace(inputs, speed_valid=tuple(valid)))
        return self.reported(outputs, inputs)

    def is_captured(self, ascending: list[float]) -> bool:
        """Whether one wheelset alone reads far more than all others."""
        first = self.monitors[0]
        return (
            len(ascending) > 1 and ascending[-1] - ascending[-2] > first.speed + first.share * ascending[-2]
        )

    def reported(self, outputs: Outputs, inputs: Inputs) -> Outputs:
        """Return the commands that the safety timers allow, and the diagnosis."""
        limit = self.reference * (1.0 - self.parameters.target)
        magnets = [
            monitor.limited((int(hold), int(vent)), speed < limit)
            for monitor, hold, vent, speed in zip(
                self.monitors, outputs.hold, outputs.vent, inputs.wheel_speed, strict=True
            )
        ]
        hold, vent = zip(*magnets, strict=True)
        bits = sum(monitor.reports << place for place, monitor in enumerate(self.monitors))
        return Outputs(hold, vent, outputs.reference_speed, bits)
