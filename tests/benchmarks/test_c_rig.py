import numpy as np
import pytest

from uictest.rig.backends.scalar import compiled_stop
from uictest.rig.single_stop import run_to_end

FIVE_SECONDS = 500
"""Controller cycles of a stop that is cut short."""


def c_stop():
    from c_library import STRICT, CStop, NoCompilerError

    try:
        return CStop(STRICT)
    except NoCompilerError as reason:
        pytest.skip(str(reason))


def short_stop(name):
    from stops import shipped

    stop = shipped()[name]
    stop.parameters.cycles = FIVE_SECONDS
    return stop


def bits(outcome):
    records = (outcome.measures, outcome.wheelset_measures, outcome.car, outcome.wheelsets)
    return b"".join(np.asarray(record).tobytes() for record in records)


@pytest.mark.parametrize(
    "name", ["dry-120", "slide-80[compensation=none]", "slide-80-four-caliper", "low-adhesion-80"]
)
def test_c_rig_agrees_bit_for_bit(name):
    stop = short_stop(name)
    assert bits(run_to_end(c_stop(), stop)) == bits(run_to_end(compiled_stop(), stop))


def test_c_rig_refuses_the_modelled_air_that_it_lacks():
    """It would compute something else and say nothing."""
    stop = short_stop("dry-120")
    stop.parameters.uses_module_air = 1.0
    with pytest.raises(ValueError, match="thermal"):
        run_to_end(c_stop(), stop)


def test_c_rig_runs_wheelsets_that_differ():
    """With the same bits: its formulae read the same fields."""
    stop = short_stop("low-adhesion-80")
    stop.wheelset_parameters["brake_force"] = 0.9, 1.0, 1.1, 1.2
    stop.wheelset_parameters["configured_radius"] = 0.42, 0.43, 0.44, 0.45
    stop.wheelset_parameters["valve_delay_steps"] = 0.0, 5.0, 10.0, 15.0
    assert bits(run_to_end(c_stop(), stop)) == bits(run_to_end(compiled_stop(), stop))


def test_c_rig_refuses_the_pole_wheels_that_it_lacks():
    stop = short_stop("dry-120")
    stop.parameters.uses_pole_wheels = 1.0
    with pytest.raises(ValueError, match="whole-teeth"):
        run_to_end(c_stop(), stop)


@pytest.mark.parametrize(
    ("feature", "key"), [("cleans_rail", r"rail\.cleaning"), ("varies_friction", r"rail\.variation")]
)
def test_c_rig_refuses_a_rail_that_sliding_cleans_or_that_varies(feature, key):
    stop = short_stop("dry-120")
    stop.parameters[feature] = 1.0
    with pytest.raises(ValueError, match=key):
        run_to_end(c_stop(), stop)


@pytest.mark.parametrize("feature", ["varies_pad_friction", "models_disc_temperature"])
def test_c_rig_refuses_pads_and_discs_that_it_lacks(feature):
    """It would brake with constant pads and say nothing."""
    stop = short_stop("dry-120")
    stop.parameters[feature] = 1.0
    with pytest.raises(ValueError, match=r"the C rig has no (pads|discs)"):
        run_to_end(c_stop(), stop)


@pytest.mark.parametrize(
    ("feature", "key"),
    [
        ("command_times", r"brake\.command"),
        ("end_speed", "until"),
        ("drag_duration", "drag"),
        ("has_dynamic_brake", r"brake\.dynamic"),
    ],
)
def test_c_rig_refuses_what_else_happens_in_a_stop(feature, key):
    stop = short_stop("dry-120")
    stop.parameters[feature] = 1.0
    with pytest.raises(ValueError, match=key):
        run_to_end(c_stop(), stop)


def test_header_follows_the_records():
    from c_library import records_header

    from uictest.rig.model.parameters import PARAMETERS

    header = records_header()
    assert all(f" {name};" in header or f" {name}[" in header for name in PARAMETERS.names)
    assert "real pad_speeds[16];" in header
    assert "real speed_after_sliding[11];" in header


def test_lanes_agree_with_the_scalar_c_rig():
    """Lanes are built with -ffast-math, and the poles of the cylinder dynamics magnify what that rounds."""
    from c_library import CLanes

    from uictest.core.measures import STOP_MEASURES, WHEELSET_MEASURES

    stop = short_stop("dry-120")
    parameters, own, rail, *_ = stop
    parameters.uses_cylinder_dynamics = 0.0
    scalar = run_to_end(c_stop(), stop)
    stops = np.repeat(parameters.reshape(1), 11).view(parameters.dtype)
    measures, wheelset_measures = np.zeros(11, STOP_MEASURES), np.zeros(44, WHEELSET_MEASURES)
    CLanes()(stops, np.tile(own, (11, 1)), np.tile(rail[:, 0], (11, 1)), measures, wheelset_measures)
    np.testing.assert_allclose(measures["end_distance"], scalar.measures.end_distance, rtol=1e-9)
    np.testing.assert_allclose(
        wheelset_measures["maximum_clamping_force"][:4],
        scalar.wheelset_measures.maximum_clamping_force,
        rtol=1e-9,
    )


def test_strict_lanes_have_the_bits_of_ours():
    from c_library import CLanes

    from uictest.core.lanes import fuses, register_width
    from uictest.core.measures import STOP_MEASURES, WHEELSET_MEASURES
    from uictest.rig.backends.lanes import run_in_lanes

    if not fuses():
        pytest.skip("the C lanes fuse by an instruction that this processor lacks")
    stop = short_stop("low-adhesion-80")
    parameters, own, rail, *_ = stop
    stops = np.repeat(parameters.reshape(1), 11).view(parameters.dtype)
    stops["noise_key"] = np.arange(11)
    owns, rails = np.tile(own, (11, 1)), np.tile(rail[:, :1], (11, 1, 1))
    measures, wheelset_measures = np.zeros(11, STOP_MEASURES), np.zeros(44, WHEELSET_MEASURES)
    strict = CLanes(register_width(), strict=True)
    strict(stops, owns, np.ascontiguousarray(rails[:, :, 0]), measures, wheelset_measures)
    ours = run_in_lanes(stops, owns, rails)
    assert measures.tobytes() == ours.measures.tobytes()
    assert wheelset_measures.tobytes() == ours.wheelset_measures.tobytes()
