"""The built-in controller slip-band as a class; with the parameter fails_at it fails in that cycle."""

from uictest.controllers import Outputs


class SlipBand:
    def __init__(self, config):
        self.config = config
        given = config.parameters
        self.fall = given.get("reference_deceleration", 1.8) * config.cycle_time
        self.minimum = given.get("minimum_speed", 5.0 / 3.6)
        self.lower, self.upper = given.get("lower_slide", 0.08), given.get("upper_slide", 0.2)
        self.fails_at = given.get("fails_at", -1)

    def reset(self):
        self.reference = self.config.initial_speed

    def step(self, inputs):
        if inputs.cycle == self.fails_at:
            raise ValueError("told to")
        self.reference = max(self.reference - self.fall, *inputs.wheel_speed)
        slides = [(self.reference - each) / max(self.reference, self.minimum) for each in inputs.wheel_speed]
        protects = self.reference >= self.minimum
        hold = [protects and slide >= self.lower for slide in slides]
        vent = [protects and slide > self.upper for slide in slides]
        return Outputs(hold, vent, self.reference)


PARAMETERS = {
    "reference_deceleration": {"default": 1.8, "unit": "m/s2"},
    "minimum_speed": {"default": 1.3888888888888888, "unit": "m/s"},
    "lower_slide": {"default": 0.08, "unit": "1"},
    "upper_slide": {"default": 0.2, "unit": "1"},
    "fails_at": {"default": -1, "unit": "1"},
}
