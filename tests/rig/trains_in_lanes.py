"""Trains of all kinds, in lanes and one by one."""

import numpy as np

from uictest.rig.lanes import run_trains_in_lanes
from uictest.rig.simulation import run_coupled
from uictest.rig.train_assembly import Coupling, assemble_train

COUPLED = Coupling(distance=26.4)
PIPED = Coupling(distance=26.4, stiffness=2.0e6, damping=0.2e6, pipe_speed=250.0)
LOOSE = Coupling(distance=26.4, stiffness=0.0, damping=0.0)
WET = ("rail.condition=wet", "rail.friction=0.09")
CLEANED = ("rail.condition=wet-cleaning", "rail.friction=0.05")
FADING = "rail.friction_over_time={points: [{time: 0 s, factor: 1}, {time: 2 s, factor: 0.5}]}"
VARIED = "rail.variation={spread: 30 %, correlation_length: 5 m, left_right_correlation: 0}"
MOTORS = "brake.dynamic={force: 60 kN, power: 1.6 MW, wheelsets: [1, 4]}"
COURSE = "brake.command=[{at: 0 s, value: 60 %}, {at: 0.4 s, value: 0 %}, {at: 1 s, value: 100 %}]"
AGAIN = "brake.command=[{at: 0 s, value: 100 %}, {at: 5 s, value: 80 %}]"
HOT = "brake.disc_temperature=modelled"
HOT_PAD = ("brake.pad=disc-pad", "brake.initial_disc_temperature=240 degC", HOT)
LEAKS = (
    "faults=[{at: 0.5 s, until: 2 s, wheelset: 2, part: tank, kind: leak, value: 1e-8 m3/(s Pa)},"
    " {at: 1 s, until: 2 s, part: controller, kind: silent, value: 500 ms},"
    " {at: 1 s, wheelset: 3, part: vent-valve, kind: blocked, value: 60 %}]"
)
FAILING = "faults=[{at: 1 s, part: dynamic-brake, kind: failed}]"
MAGNETS = "brake.track={attraction: 60 kN, when: always, delay: 0.3 s, cleaning: 10 %}"
SANDER = "sanders=[{wheelset: 3, density: 7.5 g/m, when: always, off_below: 3 km/h, delay: 0.1 s}]"
OTHER = "sanders=[{wheelset: 1, rate: 2 kg/min, delay: 0 s, off_below: 0 km/h}]"
TRAINS = (
    (COUPLED, WET, [()]),
    (COUPLED, CLEANED, [(), ("brake.command=60 %",)]),
    (PIPED, CLEANED, [(), ("brake.command=60 %",), ("rig.wsp=bypassed",), ("brake.command=80 %",)]),
    (LOOSE, CLEANED, [("brake.command=70 %",), ()]),
    (PIPED, WET, [(COURSE,), (COURSE,)]),
    (COUPLED, (*WET, VARIED), [(MOTORS, FAILING), (), (), (MOTORS, "controller=slip-band")]),
    (LOOSE, WET, [(AGAIN,), (AGAIN, "brake.position=G"), HOT_PAD, (*HOT_PAD, "brake.command=50 %")]),
    (COUPLED, WET, [(LEAKS,), ("rig.compensation=thermal",)]),
    (COUPLED, (*WET, FADING), [("rig.sensors=pole-wheel",), ("rig.topology=four-caliper",), (), (MOTORS,)]),
    (COUPLED, (*WET, "simulation.time_step=0.25 ms"), [(), ("brake.command=50 %",)]),
    (COUPLED, (*WET, "drag={speed: 8 km/h, duration: 0.7 s}"), [(), ()]),
    (COUPLED, (*WET, "until=6 km/h"), [("brake.command=50 %",), ()]),
    (COUPLED, WET, [(SANDER,), (), ("brake.command=60 %",), (OTHER,)]),
    (PIPED, CLEANED, [(), (SANDER,)]),
    (COUPLED, CLEANED, [()]),
    (PIPED, CLEANED, [(MAGNETS,), (MAGNETS, "brake.command=60 %")]),
)
ALL = range(2 * len(TRAINS))


class Trains:
    """Trains of all kinds from two speeds, and what each of them gives alone."""

    def __init__(self, rig):
        self.cases = [
            (coupling, [rig.case(*shared, *own, f"initial_speed={speed} km/h", f"seed={n}") for own in cars])
            for n, (coupling, shared, cars) in enumerate(TRAINS)
            for speed in (9, 20 + n)
        ]
        self.inputs = [assemble_train(cases, coupling) for coupling, cases in self.cases]
        self.alone = [run_coupled(cases, coupling) for coupling, cases in self.cases]

    def in_lanes(self, numbers, width=None):
        return run_trains_in_lanes([self.inputs[number] for number in numbers], width)

    def are_as_alone(self, numbers, width=None):
        return all(
            bits(stop) == bits_alone(self.alone[number])
            for number, stop in zip(numbers, self.in_lanes(numbers, width), strict=True)
        )


def bits(stop):
    return b"".join(each.tobytes() for each in (stop.measures, stop.wheelset_measures, stop.couplers))


def bits_alone(stop):
    measures = [np.array([car.measures for car in stop.cars])]
    measures += [car.wheelset_measures for car in stop.cars]
    return b"".join(each.tobytes() for each in (*measures, stop.couplers))
