"""A first WSP controller: a band of slide around the speed of the fastest wheelset.

It fills the brake cylinder of a wheelset below a lower slide, vents it above an upper one, and holds its
pressure between them. Every number is a parameter; none of them is tuned.
"""

from uictest.controllers import Config, Inputs, Outputs

__version__ = "0.1.0"
PARAMETERS = {  # read without running this file: a scenario may give these and no others
    "lower_slide": {"default": 0.05, "unit": "1", "range": [0, 1]},  # below it the brake is filled
    "upper_slide": {"default": 0.15, "unit": "1", "range": [0, 1]},  # above it the brake is vented
    "reference_deceleration": {"default": 1.8, "unit": "m/s2", "range": [0, 10]},  # fastest fall of its speed
    "blind_deceleration": {"default": 0.8, "unit": "m/s2", "range": [0, 10]},  # while every wheelset slides
    "minimum_speed": {"default": 1.4, "unit": "m/s", "range": [0.1, 30]},  # below it there is no protection
    "longest_vent": {"default": 5.0, "unit": "s", "range": [0, 60]},
    "pause": {"default": 0.5, "unit": "s", "range": [0, 60]},  # of filling after the longest vent
}


class MyWsp:
    """Created for every stop, then reset. SI units; wheelset 0 is the leading one."""

    def __init__(self, config: Config) -> None:
        """Take over what stays the same during a stop."""
        parameters = config.parameters
        self.wheelsets = range(config.wheelsets)
        self.cycle_time = config.cycle_time
        self.initial_speed = config.initial_speed
        self.lower_slide = float(parameters["lower_slide"])
        self.upper_slide = float(parameters["upper_slide"])
        self.reference_deceleration = float(parameters["reference_deceleration"])
        self.blind_deceleration = float(parameters["blind_deceleration"])
        self.minimum_speed = float(parameters["minimum_speed"])
        self.longest_vent = float(parameters["longest_vent"])
        self.pause = float(parameters["pause"])

    def reset(self) -> None:
        """Forget the stop before."""
        self.reference_speed = self.initial_speed
        self.vented_for = [0.0 for _ in self.wheelsets]

    def step(self, inputs: Inputs) -> Outputs:
        """Answer one controller cycle."""
        self.estimate_speed(inputs)
        states = [self.magnets(wheelset, inputs) for wheelset in self.wheelsets]
        return Outputs(
            hold=[hold for hold, _ in states],
            vent=[vent for _, vent in states],
            reference_speed=self.reference_speed,
        )

    def estimate_speed(self, inputs: Inputs) -> None:
        """Follow the fastest wheelset; fall no faster than a train can, and slower while all slide."""
        fastest = 0.0
        for speed, valid in zip(inputs.wheel_speed, inputs.speed_valid, strict=True):
            if valid and speed > fastest:
                fastest = speed
        one_rolls = fastest > self.reference_speed * (1.0 - self.lower_slide)
        fall = self.reference_deceleration if one_rolls else self.blind_deceleration
        self.reference_speed = max(fastest, self.reference_speed - fall * self.cycle_time)

    def magnets(self, wheelset: int, inputs: Inputs) -> tuple[bool, bool]:
        """Return hold and vent of one wheelset."""
        lost_speed = self.reference_speed - inputs.wheel_speed[wheelset]
        slide = lost_speed / max(self.reference_speed, self.minimum_speed)
        protected = inputs.speed_valid[wheelset] and self.reference_speed > self.minimum_speed
        if not protected or slide < self.lower_slide:
            self.vented_for[wheelset] = 0.0
            return False, False  # fill
        if slide < self.upper_slide:
            return True, False  # hold
        return self.vent_with_watchdog(wheelset)

    def vent_with_watchdog(self, wheelset: int) -> tuple[bool, bool]:
        """Vent; after a long vent fill for a while, so that no wheelset loses its brake for ever."""
        self.vented_for[wheelset] += self.cycle_time
        if self.vented_for[wheelset] > self.longest_vent + self.pause:
            self.vented_for[wheelset] = 0.0
        filling = self.vented_for[wheelset] > self.longest_vent
        return not filling, not filling
