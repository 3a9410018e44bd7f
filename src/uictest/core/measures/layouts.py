"""Layouts in memory of the records of measures, for compiled code and for files of measures."""

from uictest.core.measures.records import StopMeasures, WheelsetMeasures
from uictest.core.record import layout_of

STOP_MEASURES = layout_of(StopMeasures)
"""Layout of :class:`~uictest.core.measures.StopMeasures`."""
WHEELSET_MEASURES = layout_of(WheelsetMeasures)
"""Layout of :class:`~uictest.core.measures.WheelsetMeasures`."""
