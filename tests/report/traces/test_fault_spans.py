"""When faults were active, from the bits that a recording has of them."""

import numpy as np

from uictest.core.recording import Recording
from uictest.report.page.stop.marks import fault_marks
from uictest.report.traces.quantities import PANELS, STRIPS
from uictest.report.traces.trace import FaultSpan, fault_spans, trace_of

TIME = np.arange(0.0, 10.0, 0.1)


def record(bits, faults):
    channels = {"time": TIME, "speed": 30.0 - TIME, "active_faults": bits}
    return Recording(channels, {"time": "s", "speed": "m/s", "active_faults": "1"}, {"faults": faults})


def test_each_fault_has_its_own_stretches_and_a_stop_without_faults_none():
    lost, leak = "speed-sensor-lost-2", "brake-line-leak"
    bits = 1.0 * ((TIME >= 1.95) & (TIME < 3.95)) + 2.0 * (TIME >= 2.95) + 1.0 * (TIME >= 7.95)
    spans = fault_spans(record(bits, f"{lost}, {leak}"))
    rounded = [FaultSpan(each.label, round(each.start, 3), round(each.end, 3)) for each in spans]
    assert fault_spans(record(0.0 * TIME, leak)) == ()
    assert fault_spans(Recording({"time": TIME, "speed": 30.0 - TIME}, {"time": "s", "speed": "m/s"})) == ()
    assert rounded == [
        FaultSpan("speed sensor of wheelset 2: lost", 2.0, 4.0),
        FaultSpan("speed sensor of wheelset 2: lost", 8.0, 9.9),
        FaultSpan("brake line: leak", 3.0, 9.9),
    ]


def test_the_page_shades_the_time():
    trace = trace_of(record(1.0 * (TIME >= 2.95), "brake-line-leak"))
    marks = list(fault_marks(trace))
    assert {mark.plot for mark in marks} == {plot.key for plot in (*PANELS, *STRIPS)}
    assert {(mark.kind, round(mark.x0 or 0.0, 3)) for mark in marks} == {("fault", 3.0)}
    assert [mark.label for mark in marks if mark.label] == ["fault: brake line: leak"]
