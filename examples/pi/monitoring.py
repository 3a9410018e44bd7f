"""Print which faults a controller reports, after how long, and what it reports wrongly.

python monitoring.py [monitoring.yaml]

The rule is TB/T 3009-2019, 4.2.5 (second-hand), with the largest A and B that it allows: a wheelset whose
speed, as its sensor shows it, differs from that of the train v by more than A + B v is to be reported within
10 s. Whether it does is decided by the true speed of the train, not by what the controller believes.
"""

import sys
from dataclasses import dataclass, field
from pathlib import Path

from monitored_pi import PARAMETERS, MonitoredPi

import uictest
from uictest.controllers import Config
from uictest.plans.scenario import Case, load

A, B, WITHIN = 50.0 / 3.6, 0.3, 10.0
"""m/s, 1 and s."""
RADIUS = (0.43,) * 4
"""m; the controller does not use it."""
FAULTY = 1
"""Place of the wheelset with the fault."""
BEGINS = 3.0
"""When the fault begins, s."""
PLACES = tuple(sum(1 << (first + place) for first in (0, 8, 16)) for place in range(4))
"""Bits of the diagnosis that concern each wheelset."""


@dataclass
class Watched:
    """Instants of one stop, s since the brake command."""

    fault: str
    ended: float = 0.0
    deviates: float | None = None  # beginning of the first deviation that lasts, or of the one at the end
    reports: dict[int, float] = field(default_factory=dict)  # first report of each wheelset

    def observe(self, time: float, wheel_speed: float, train_speed: float, diagnosis: int) -> None:
        """Observe one controller cycle (s, m/s, m/s)."""
        self.ended = time
        due = self.deviates is not None and time - self.deviates >= WITHIN
        if abs(wheel_speed - train_speed) <= A + B * train_speed:
            self.deviates = self.deviates if due else None
        elif self.deviates is None:
            self.deviates = time
        for place, bits in enumerate(PLACES):
            if diagnosis & bits:
                self.reports.setdefault(place, time)

    @property
    def verdict(self) -> str:
        """What the rule says of the stop; without a deviation that lasts it asks for nothing."""
        wrong = [place for place in self.reports if place != FAULTY or self.fault == "none"]
        if wrong:
            return "wrongly reported: " + ", ".join(f"wheelset {place + 1}" for place in wrong)
        reported = self.reports.get(FAULTY)
        if self.deviates is None or self.ended - self.deviates < WITHIN:
            return "not required" if reported is None else "reported, not required"
        if reported is None:
            return "not reported"
        return "reported" if reported - self.deviates <= WITHIN else "reported too late"


def watched(scenario: Path, case: str, fault: str) -> Watched:
    """Run one stop with the controller and note what it reports."""
    rig = uictest.Rig(scenario, case=case)
    inputs = rig.reset()
    parameters = {name: entry["default"] for name, entry in PARAMETERS.items()}
    controller = MonitoredPi(Config(4, rig.cycle_time, rig.state.train_speed, RADIUS, parameters))
    controller.reset()
    stop = Watched(fault)
    while not rig.stopped:
        outputs = controller.step(inputs)
        stop.observe(inputs.time, inputs.wheel_speed[FAULTY], rig.state.train_speed, outputs.diagnosis)
        inputs = rig.step(outputs)
    return stop


def fault_of(case: Case) -> str:
    """Return part, kind and value of the fault of a case; `none` without one."""
    for fault in case.scenario.faults:
        value = "" if fault.value is None else f" {fault.value:.3g}"
        return f"{fault.part} {fault.kind}{value}"
    return "none"


def main(scenario: Path) -> None:
    print("| fault | reported, s after it began | by the rule |")
    print("|---|---|---|")
    for case in load([scenario]):
        stop = watched(scenario, case.id, fault_of(case))
        reported = stop.reports.get(FAULTY)
        after = "-" if reported is None else f"{reported - BEGINS:.1f}"
        print(f"| {stop.fault} | {after} | {stop.verdict} |")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).with_name("monitoring.yaml"))
