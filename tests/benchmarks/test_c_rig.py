from typing import Any

import numpy as np
import pytest

from uictest.rig.backends.native import compiled_stop
from uictest.rig.backends.run_stop import SteppedStop, run

FIVE_SECONDS = 500
"""Controller cycles of a stop that is cut short."""


def c_stop() -> Any:
    from c_library import STRICT, CStop, NoCompilerError

    try:
        return CStop(STRICT)
    except NoCompilerError as reason:
        pytest.skip(str(reason))


def short_stop(name: str) -> tuple[Any, Any]:
    from stops import shipped

    parameters, rail = shipped()[name]
    parameters.cycles = FIVE_SECONDS
    return parameters, rail


def bits(outcome: SteppedStop) -> bytes:
    records = (outcome.measures, outcome.wheelset_measures, outcome.car, outcome.wheelsets)
    return b"".join(np.asarray(record).tobytes() for record in records)


@pytest.mark.parametrize(
    "name", ["dry-120", "slide-80[compensation=none]", "slide-80-four-caliper", "low-adhesion-80"]
)
def test_c_rig_agrees_bit_for_bit(name: str) -> None:
    stop = short_stop(name)
    assert bits(run(c_stop(), *stop, 0)) == bits(run(compiled_stop(), *stop, 0))


def test_header_follows_the_records() -> None:
    from c_library import records_header

    from uictest.rig.model.records import PARAMETERS

    header = records_header()
    assert all(f" {name};" in header for name in PARAMETERS.names)
    assert "real speed_after_sliding[11];" in header


def test_lanes_agree_with_the_scalar_c_rig() -> None:
    """Lanes are built with -ffast-math, and the poles of the cylinder dynamics magnify what that rounds."""
    from c_library import CLanes

    from uictest.measures import STOP_MEASURES, WHEELSET_MEASURES

    parameters, rail = short_stop("dry-120")
    parameters.uses_cylinder_dynamics = 0.0
    scalar = run(c_stop(), parameters, rail, 0)
    stops = np.repeat(parameters.reshape(1), 11).view(parameters.dtype)
    measures, wheelset_measures = np.zeros(11, STOP_MEASURES), np.zeros(44, WHEELSET_MEASURES)
    CLanes()(stops, np.tile(rail[:, 0], (11, 1)), measures, wheelset_measures)
    np.testing.assert_allclose(measures["end_distance"], scalar.measures.end_distance, rtol=1e-9)
    np.testing.assert_allclose(
        wheelset_measures["maximum_clamping_force"][:4],
        scalar.wheelset_measures.maximum_clamping_force,
        rtol=1e-9,
    )
