import pytest

from uictest.core.units import SIZES
from uictest.report.traces.quantities import PLOT_QUANTITIES, channel_names, channel_title, shown_unit

SI = {"km/h": "m/s", "bar": "Pa", "kN": "N", "N m": "N m", "degC": "K", "%": "1", "m": "m", "1": "1"} | {
    "g/m": "kg/m"
}


@pytest.mark.parametrize("key", [key for key in PLOT_QUANTITIES if key != "deceleration"])
def test_every_quantity_of_the_page_has_its_unit_everywhere(key):
    quantity = PLOT_QUANTITIES[key]
    for name in channel_names(key):
        assert shown_unit(name, SI[quantity.unit]) == quantity.unit
    if quantity.scale != 1.0:
        assert quantity.scale == SIZES[quantity.unit]


@pytest.mark.parametrize(
    ("channel", "recorded", "shown"),
    [
        ("caliper_force_2", "N", "kN"),
        ("demanded_pressure", "Pa", "bar"),
        ("measured_speed_3", "m/s", "km/h"),
        ("air_temperature", "K", "degC"),
        ("pad_friction_1", "1", "1"),
        ("lateral_acceleration", "m/s2", "m/s2"),
        ("brake_torque_1", "N m", "N m"),
        ("speed", "knot", "knot"),
    ],
)
def test_other_channels_are_shown_in_the_units_of_the_page(channel, recorded, shown):
    assert shown_unit(channel, recorded) == shown


@pytest.mark.parametrize(
    ("channel", "title"),
    [
        ("speed", "Speed"),
        ("tank_pressure_1", "Tank pressure of wheelset 1"),
        ("disc_surface_temperature_4", "Disc surface temperature of wheelset 4"),
        ("channel_20", "channel_20"),
        ("MVB: v/ist", "MVB: v/ist"),
    ],
)
def test_a_channel_has_a_title(channel, title):
    assert channel_title(channel) == title
