"""What stops have measured, to the bit, where one has a controller from outside and one the same built in."""

REPORTS = (
    *("deviation", "deviation_reported", "longest_deviation", "unfilled", "longest_unfilled"),
    *("falsely_reported", "report_delay", "fault_reported", "required_delay", "required_reported"),
)


def stop_bits(measures, wheelset_measures):
    """The bytes of both records without what is kept of reports: only a controller from outside makes any."""
    measures, wheelset_measures = measures.copy(), wheelset_measures.copy()
    measures["has_diagnosis"] = 0.0
    for name in REPORTS:
        wheelset_measures[name] = 0.0
    return bytes(measures.tobytes() + wheelset_measures.tobytes())


def bits(stop):
    """All bytes that a stop has measured."""
    return bytes(stop.measures.tobytes() + stop.wheelset_measures.tobytes())
