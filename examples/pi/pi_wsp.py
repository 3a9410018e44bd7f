"""Wheel slide protection by a PI controller of slide, one per wheelset.

The valve integrates: the share of time that it vents is a rate at which pressure falls. A PI controller of
pressure is therefore share = kp d(slide)/dt + ki (slide - target), positive to vent and negative to fill.
Pulses of the magnets make it: in each period the valve vents or fills first, and holds for the rest.
"""

from dataclasses import dataclass

from uictest.controllers import Config, Inputs, Outputs

__version__ = "1.0"
FILL, HOLD, VENT = (0, 0), (1, 0), (1, 1)  # magnets: hold, vent


PARAMETERS = {  # what a scenario may set; the values in pi.yaml are the tuned ones
    "kp": {"default": 1.0, "unit": "s", "range": [0, 10]},
    "ki": {"default": 4.0, "unit": "1", "range": [0, 100]},
    "target": {"default": 0.12, "unit": "1", "range": [0, 1], "description": "slide that is kept"},
    "period": {"default": 0.1, "unit": "s", "range": [0.01, 1], "description": "of the pulses"},
    "release_time": {"default": 0.5, "unit": "s", "range": [0, 60]},
    "rolling_slide": {"default": 0.02, "unit": "1", "range": [0, 1]},
    "minimum_speed": {"default": 1.4, "unit": "m/s", "range": [0, 30]},
    "reference_deceleration": {"default": 2.0, "unit": "m/s2", "range": [0, 10]},
    "sliding_deceleration": {"default": 0.8, "unit": "m/s2", "range": [0, 10]},
    "probe_interval": {"default": 2.0, "unit": "s", "range": [0, 60]},
    "probe_time": {"default": 0.4, "unit": "s", "range": [0, 60]},
}


@dataclass(frozen=True)
class Parameters:
    """What a stop is given: all of PARAMETERS."""

    kp: float
    ki: float
    target: float
    period: float
    release_time: float  # a wheelset that has rolled for so long gets its full brake back
    rolling_slide: float  # slide below which a wheelset rolls
    minimum_speed: float  # of the train, below which the brake is left alone
    reference_deceleration: float  # fastest fall of the estimated speed of the train
    sliding_deceleration: float  # its fall while all wheelsets slide, until one has been let roll
    probe_interval: float  # from one wheelset that is let roll to the next
    probe_time: float  # after which a vented wheelset accelerates unless it rolls


class Wheelset:
    """The PI controller of one wheelset; it acts from the first slide until the wheelset rolls again."""

    def __init__(self, parameters: Parameters, cycle_time: float) -> None:
        self.parameters, self.cycle_time = parameters, cycle_time
        self.acts, self.rolled, self.since = False, 0.0, 0
        self.share = self.slide = 0.0

    def magnets(self, speed: float, reference: float) -> tuple[int, int]:
        """Return hold and vent for the coming cycle."""
        p, slide = self.parameters, 1.0 - speed / max(reference, 0.1)
        self.rolled = self.rolled + self.cycle_time if slide < p.rolling_slide else 0.0
        if reference < p.minimum_speed or self.rolled > p.release_time:
            self.acts = False
        elif not self.acts and slide > p.target:
            self.acts, self.since, self.slide = True, 0, 0.0
        if self.acts and self.since == 0:
            share = p.kp * (slide - self.slide) / p.period + p.ki * (slide - p.target)
            self.share, self.slide = min(max(share, -1.0), 1.0), slide
        pulse = self.since * self.cycle_time < abs(self.share) * p.period
        self.since = (self.since + 1) % max(round(p.period / self.cycle_time), 1)
        return FILL if not self.acts else HOLD if not pulse else VENT if self.share > 0.0 else FILL


class PiWsp:
    """Four wheelsets, and the speed of the train, which one of them must show now and then."""

    def __init__(self, config: Config) -> None:
        self.config, self.parameters = config, Parameters(**config.parameters)

    def reset(self) -> None:
        """Return to the state after creation."""
        self.reference, self.fall = self.config.initial_speed, self.parameters.reference_deceleration
        self.wheelsets = [Wheelset(self.parameters, self.config.cycle_time) for _ in self.config.wheel_radius]
        self.probed, self.shown_at, self.shown = 0, 0.0, self.reference
        self.peak_at = self.peak = 0.0

    def step(self, inputs: Inputs) -> Outputs:
        """Decide on the coming cycle."""
        fallen = max(self.reference - self.fall * self.config.cycle_time, 0.0)
        seen = zip(inputs.wheel_speed, inputs.speed_valid, strict=True)
        speeds = [speed if valid else fallen for speed, valid in seen]  # no speed: taken to roll
        self.reference = max(fallen, *speeds)
        pairs = zip(self.wheelsets, speeds, strict=True)
        magnets = [wheelset.magnets(speed, self.reference) for wheelset, speed in pairs]
        acting = [wheelset.acts for wheelset in self.wheelsets]
        if not any(acting):
            self.fall = self.parameters.reference_deceleration
        elif self.fall == self.parameters.reference_deceleration:
            self.fall = self.parameters.sliding_deceleration
        if not all(acting):
            self.shown_at, self.shown = inputs.time, self.reference
        elif inputs.time - self.shown_at > self.parameters.probe_interval:
            magnets[self.probed] = VENT
            self.probe(inputs.time, speeds[self.probed])
        hold, vent = zip(*magnets, strict=True)
        return Outputs(hold, vent, self.reference)

    def probe(self, time: float, speed: float) -> None:
        """End the venting of a wheelset that no longer accelerates: it shows the speed of the train."""
        p = self.parameters
        if speed > self.peak or time - self.shown_at < p.probe_interval + p.probe_time:
            self.peak_at, self.peak = time, speed
        elif time - self.peak_at > p.period:
            fall = (self.shown - self.peak) / (self.peak_at - self.shown_at)
            self.fall = min(max(fall, 0.1), p.reference_deceleration)
            self.reference, self.shown_at, self.shown = speed, time, self.peak
            self.probed = (self.probed + 1) % len(self.wheelsets)
