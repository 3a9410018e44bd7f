"""From pressure to clamping force: the caliper's module, the computed force, and nothing that jumps."""

import numpy as np
import pytest
from scipy.signal import lfilter

from uictest.rig.model.friction_brake import step_clamping

EXACT = {
    f"{sensor}_{error}": 0.0
    for sensor in ("pressure", "loadcell")
    for error in ("gain_error", "offset", "noise")
} | {
    # Converters so fine that they do not show.
    "pressure_resolution": 2.0**-30,
    "pressure_steps": 2.0**30,
    "loadcell_resolution": 2.0**-36,
    "loadcell_steps": 2.0**36,
}


def clamped(wheelset, p, gauge):
    """What a module makes of a history of gauge pressures, Pa, one per step."""
    names = ("clamping_force", "caliper_force", "computed_force", "compensated_pressure", "wsp_share")
    rows = []
    for pressure in gauge.tolist():
        wheelset.pressure = pressure + p.atmospheric_pressure
        step_clamping(wheelset, p)
        rows.append([getattr(wheelset, name) for name in names])
    return dict(zip(names, np.array(rows).T, strict=True))


def braking(full=3.8e5):
    """A rise to full pressure, a partial release, a second rise and a release."""
    return np.interp(np.arange(8000) * 5e-4, [0.0, 1.0, 2.0, 3.0, 4.0], [0.0, full, 0.4 * full, full, 0.0])


def test_module_with_a_caliper_gives_what_its_loadcells_read(rig, bench):
    p = rig.parameters(**{**EXACT, "loadcell_gain_error": 0.01, "loadcell_offset": 20.0})[0]
    braked = bench(p)
    seen = clamped(braked.wheelsets[0], braked.p, braking())
    read = np.clip(1.01 * seen["caliper_force"] + 20.0, 0.0, p.loadcell_range)
    np.testing.assert_allclose(seen["clamping_force"], read, rtol=1e-12)
    assert seen["clamping_force"].max() > 1e4


def test_module_without_a_caliper_gives_the_computed_force_and_one_with_it_needs_no_model(rig, bench):
    """The pressure of a caliper is that of the cylinder already."""
    braked = bench(rig.parameters(**EXACT)[0])
    caliper, tank = (clamped(wheelset, braked.p, braking()) for wheelset in braked.wheelsets[:2])
    np.testing.assert_allclose(caliper["compensated_pressure"], braking(), atol=1e-6)
    np.testing.assert_array_equal(tank["clamping_force"], tank["computed_force"])


def test_without_compensation_the_force_is_one_line_of_the_pressure(rig, bench):
    braked = bench(rig.parameters("rig.compensation=none", **EXACT)[0])
    gauge = braking()
    seen = clamped(braked.wheelsets[1], braked.p, gauge)
    line = np.maximum(braked.p.linear_slope * gauge + braked.p.linear_intercept, 0.0)
    np.testing.assert_allclose(seen["clamping_force"], line, rtol=1e-9)


@pytest.mark.parametrize(
    ("setting", "filters", "plays"),
    [("none", False, False), ("hysteresis", False, True), ("cylinder", True, False), ("full", True, True)],
)
def test_settings_of_the_compensation(rig, bench, setting, filters, plays):
    """The cylinder's model filters the pressure as scipy does; the hysteresis opens a loop."""
    braked = bench(rig.parameters(f"rig.compensation={setting}", **EXACT)[0])
    p, gauge = braked.p, braking()
    seen = clamped(braked.wheelsets[1], p, gauge)
    filtered = lfilter([p.b0, p.b1, p.b2, p.b3], [1.0, p.a1, p.a2, p.a3], gauge)
    np.testing.assert_allclose(
        seen["compensated_pressure"], filtered if filters else gauge, rtol=1e-6, atol=1.0
    )
    rising, falling = (seen["compensated_pressure"][part] for part in (slice(0, 2000), slice(6000, 8000)))
    up = np.interp(3e5, rising, seen["clamping_force"][:2000])
    down = np.interp(3e5, falling[::-1], seen["clamping_force"][6000:][::-1])
    assert (down - up > 500.0) == plays


@pytest.mark.parametrize("module", [0, 1], ids=["caliper", "tank"])
@pytest.mark.parametrize("setting", ["hysteresis", "full", "thermal"])
def test_only_the_setting_thermal_takes_the_ratio_to_the_modelled_pressure(rig, bench, setting, module):
    """Of absolute pressures, and only where there is no caliper."""
    without, braked = (bench(rig.parameters(f"rig.compensation={setting}", **EXACT)[0]) for _ in range(2))
    braked.wheelsets[module].pressure_ratio = 0.97
    gauge, atmosphere = braking(), braked.p.atmospheric_pressure
    seen = clamped(braked.wheelsets[module], braked.p, gauge)["compensated_pressure"]
    expected = clamped(without.wheelsets[module], without.p, gauge)["compensated_pressure"]
    if setting == "thermal" and module == 1:
        expected = 0.97 * (expected + atmosphere) - atmosphere
    np.testing.assert_allclose(seen, expected, atol=1e-6)


@pytest.mark.parametrize("turned", [0.0, 0.25, 1.0])
def test_force_does_not_jump_when_the_phase_changes(rig, bench, turned):
    """At one pressure the lines of the two phases lie apart; the force goes from one to the other in time."""
    settings = {**EXACT, "wsp_squeezing_slope": 0.036, "wsp_releasing_slope": 0.053}
    braked = bench(rig.parameters("rig.compensation=hysteresis", **settings)[0])
    wheelset, p = braked.wheelsets[1], braked.p
    gauge = 3e5 * (1.0 - 0.2 * turned)
    clamped(wheelset, p, np.interp(np.arange(2000), [0, 1000, 2000], [0.0, 3e5, gauge]))
    before = wheelset.computed_force
    wheelset.wsp_acting = 1.0
    forces = np.append(before, clamped(wheelset, p, np.full(1000, gauge))["computed_force"])
    apart = 0.0
    for side in ("squeezing", "releasing"):
        bc, wsp = ([getattr(p, f"{x}_{side}_{y}") for y in ("slope", "intercept")] for x in ("bc", "wsp"))
        apart += abs(wsp[0] - bc[0]) * gauge + abs(wsp[1] - bc[1])
    assert np.abs(np.diff(forces)).max() <= p.phase_change_per_step * apart
    assert wheelset.wsp_share == 1.0


def test_computed_force_is_never_negative(rig, bench):
    braked = bench(rig.parameters(**{**EXACT, "pressure_offset": -2e4})[0])
    for wheelset in braked.wheelsets:
        assert clamped(wheelset, braked.p, braking(1e5))["clamping_force"].min() == 0.0
