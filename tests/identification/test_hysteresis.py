"""Lines that made a record are found in it again."""

import numpy as np
import pytest
from hypothesis import given, strategies as st

from uictest.rig.identification import UnsuitableRecordError, identify_hysteresis
from uictest.rig.identification.lines import (
    on_lines,
    robust_line,
    runs,
    wsp_acting_from_commands,
    wsp_acting_in_intervals,
)

from .conftest import LINES, STEP

PHASES = ("bc_squeezing", "bc_releasing", "wsp_squeezing", "wsp_releasing")


def noisy(samples, share, seed):
    rng = np.random.default_rng(seed)
    return samples + share * samples.max() * rng.standard_normal(len(samples))


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_known_lines_are_recovered_under_half_a_per_cent_of_noise(pressures, force, seed):
    time, pressure, acting = pressures
    result = identify_hysteresis(
        time, noisy(pressure, 0.005, seed), noisy(force, 0.005, seed + 10), acting, transition_time=0.0
    )
    for phase in PHASES:
        assert result.lines[phase].slope == pytest.approx(LINES[phase].slope, rel=0.02)
        assert result.lines[phase].intercept == pytest.approx(LINES[phase].intercept, abs=0.02 * force.max())
    for kind in ("bc", "wsp"):
        width = LINES[f"{kind}_squeezing"].pressure(result.high_force) - LINES[f"{kind}_releasing"].pressure(
            result.high_force
        )
        assert result.loop_widths[kind] == pytest.approx(width, abs=0.03e5)


def test_without_noise_the_computed_force_is_the_measured_one(pressures, force):
    time, pressure, acting = pressures
    result = identify_hysteresis(time, pressure, force, acting, transition_time=0.0)
    assert result.largest_error < 0.005
    assert result.rms_error <= result.largest_error
    squeezing, releasing = result.lines["bc_squeezing"], result.lines["bc_releasing"]
    assert result.linear.slope == pytest.approx(0.5 * (squeezing.slope + releasing.slope))


def test_points_inside_the_loop_do_not_bias_the_lines(pressures, force):
    """Small cycles that never reach a line are most of this record, and count for nothing."""
    time, pressure, acting = pressures
    extra = np.arange(1, 40_001) * 0.0005
    ripple = pressure[-1] - 0.1e5 * (1.0 - np.cos(2.0 * np.pi * extra))
    stuck = np.full(len(extra), force[-1])
    result = identify_hysteresis(
        np.concatenate([time, time[-1] + extra]),
        np.concatenate([pressure, ripple]),
        np.concatenate([force, stuck]),
        np.concatenate([acting, np.ones(len(extra), bool)]),
        transition_time=0.0,
    )
    for phase in PHASES:
        assert result.lines[phase].slope == pytest.approx(LINES[phase].slope, rel=0.02)


def test_a_record_without_wsp_gives_the_bc_lines_alone(pressures, force):
    time, pressure, _ = pressures
    n = 44_000
    result = identify_hysteresis(time[:n], pressure[:n], force[:n], np.zeros(n, bool))
    assert set(result.lines) == {"bc_squeezing", "bc_releasing"}
    assert set(result.loop_widths) == {"bc"}


@pytest.mark.parametrize(
    ("spoil", "reason"),
    [
        (lambda t, p, f: (t[:1000], p[:1000], f[:1000]), "too short"),
        (lambda t, p, f: (t, p, np.where(t > 3.0, np.nan, f)), "not numbers"),
        (lambda t, p, f: (t, p, 0.0 * f), "no clamping force"),
        (lambda t, p, f: (np.where(t > 3.0, t + 0.1, t), p, f), "uneven sampling"),
        (lambda t, p, f: (t[:8000], p[:8000], f[:8000]), "bc_releasing"),
    ],
)
def test_a_record_that_cannot_support_the_fit_is_refused_with_the_reason(pressures, force, spoil, reason):
    time, pressure, force = spoil(*pressures[:2], force)
    with pytest.raises(UnsuitableRecordError, match=reason):
        identify_hysteresis(time, pressure, force, np.zeros(len(time), bool))


PRESSURE = np.linspace(1e5, 4e5, 400)


@given(st.floats(1e-3, 0.2), st.floats(-5e3, 5e3))
def test_a_line_without_noise_is_found_exactly(slope, intercept):
    line = robust_line(PRESSURE, slope * PRESSURE + intercept)
    assert line.slope == pytest.approx(slope, rel=1e-6)
    assert line.intercept == pytest.approx(intercept, abs=1e-6 * slope * 4e5 + 1e-6)
    with pytest.raises(ValueError, match="3 points"):
        robust_line(PRESSURE[:3], PRESSURE[:3])


def test_points_on_one_side_move_it_less_than_least_squares():
    rng = np.random.default_rng(1)
    force = 0.045 * PRESSURE - 1700.0 + 20.0 * rng.standard_normal(len(PRESSURE))
    force[:60] += 1500.0
    line = robust_line(PRESSURE, force)
    assert abs(line.slope - 0.045) < 0.2 * abs(np.polyfit(PRESSURE, force, 1)[0] - 0.045)


def test_the_confidence_covers_the_truth_about_nineteen_times_in_twenty():
    covered = 0
    for seed in range(60):
        noise = 50.0 * np.random.default_rng(seed).standard_normal(len(PRESSURE))
        line = robust_line(PRESSURE, 0.045 * PRESSURE - 1700.0 + noise)
        covered += abs(line.slope - 0.045) <= line.slope_confidence
    assert 48 <= covered <= 60


@pytest.mark.parametrize(
    ("pressure", "threshold", "expected"),
    {
        "extremes": ([0.0, 1.0, 2.0, 3.0, 2.0, 1.0, 2.0, 3.0, 4.0], 0.5, [(0, 3, 1), (3, 5, -1), (5, 8, 1)]),
        "small ripple": ([0.0, 1.0, 0.8, 2.0, 1.9, 3.0], 0.5, [(0, 5, 1)]),
        "constant": ([1.0] * 5, 0.1, []),
    }.values(),
)
def test_runs_end_where_the_pressure_turns_by_more_than_the_threshold(pressure, threshold, expected):
    assert runs(np.array(pressure), threshold) == expected


def test_every_point_that_counts_lies_on_its_line(pressures, force):
    _, pressure, acting = pressures
    squeezing, releasing = on_lines(pressure, force, STEP)
    assert np.count_nonzero(squeezing) > 1000
    assert np.count_nonzero(releasing) > 1000
    for mask, name in ((squeezing, "squeezing"), (releasing, "releasing")):
        for kind, phase in (("bc", ~acting), ("wsp", acting)):
            points = mask & phase
            line = LINES[f"{kind}_{name}"].force(pressure[points])
            far = np.abs(force[points] - line) > 0.002 * force.max()
            assert np.mean(far) < 0.02


def test_the_wsp_acts_for_a_while_after_its_last_command_or_in_given_intervals():
    commands = np.array([0.0, 0.0, 2.0, 1.0, 0.0, 0.0, 0.0])
    acting = wsp_acting_from_commands(np.arange(7.0), commands, 2.0)
    assert acting.tolist() == [False, False, True, True, True, False, False]
    acting = wsp_acting_in_intervals(np.arange(6.0), [(1.0, 2.0), (4.0, 9.0)])
    assert acting.tolist() == [False, True, True, False, True, True]
