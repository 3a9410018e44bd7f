"""Faults as they are drawn into the plots of a stop."""

from __future__ import annotations

from collections.abc import Iterator

from uictest.report.page.stop.mark import Mark
from uictest.report.traces.trace import FaultSpan, PlotTrace


def fault_marks(trace: PlotTrace) -> Iterator[Mark]:
    """Yield the stretches in which faults were active."""
    for span in trace.faults:
        yield Mark("speed", "window", span.label, span.start, span.end)
        yield Mark("force", "window", "", span.start, span.end)


def fault_sentence(span: FaultSpan) -> str:
    """Return what was faulty and when."""
    return f"Fault {span.label} from {span.start:.4g} s to {span.end:.4g} s."
