"""When the faults of a simulated stop were active, from its recording."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from uictest.core import recording


@dataclass(frozen=True, slots=True)
class FaultSpan:
    """A stretch of a stop in which one fault was active: its label, first and last time in s."""

    label: str
    start: float
    end: float


def fault_spans(record: recording.Recording) -> tuple[FaultSpan, ...]:
    """Return when each fault was active, as far as the samples tell; none where no faults were recorded."""
    labels = record.metadata.get("faults", "")
    if not labels or "active_faults" not in record.channels:
        return ()
    return tuple(
        span for place, label in enumerate(labels.split(", ")) for span in _spans(record, label, 1 << place)
    )


def _spans(record: recording.Recording, label: str, bit: int) -> Iterator[FaultSpan]:
    time, active = record["time"], record["active_faults"].astype(np.int64) & bit != 0
    ends = np.flatnonzero(np.diff(active, prepend=False, append=False))
    for first, after in ends.reshape(-1, 2).tolist():
        yield FaultSpan(label, float(time[first]), float(time[min(after, len(time) - 1)]))
