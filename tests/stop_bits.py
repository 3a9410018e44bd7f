"""What stops have measured, to the bit, where one has a controller from outside and one the same built in."""

from uictest.core.measures.monitoring import begin_monitoring


def stop_bits(measures, wheelset_measures):
    """The bytes of both records without what is kept of reports: only a controller from outside makes any."""
    measures, wheelset_measures = measures.copy(), wheelset_measures.copy()
    measures["has_diagnosis"] = 0.0
    for wheelset in wheelset_measures:
        begin_monitoring(wheelset)
    return bytes(measures.tobytes() + wheelset_measures.tobytes())
