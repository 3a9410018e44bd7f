"""Maps from the channels of a file to ours: read, refused at their place, proposed."""

import numpy as np
import pytest
from scipy.io import savemat

from uictest.core.recording.formats import Dialect
from uictest.core.recording.formats.isolation import read_here
from uictest.core.recording.recording import Contents, Group
from uictest.plans.scenario import ScenarioErrors
from uictest.recorded.field_data import MapError, fitting_preset, load_map, presets, proposed_map
from uictest.recorded.field_data.channel_map import CHANNEL_UNITS
from uictest.recorded.field_data.proposal import channel_rows
from uictest.recorded.field_data.raw_channels import select_channels

HEAD = "schema: uictest/channel-map/1\nname: mine\n"
TIME = np.array([0.0, 1.0, 2.0])


def _map(folder, text, name="mine.yaml"):
    path = folder / name
    path.write_text(HEAD + text)
    return str(path)


def _contents(**channels):
    arrays = {name: np.array(samples) for name, (samples, _) in channels.items()}
    return Contents((Group("", arrays, {name: unit for name, (_, unit) in channels.items() if unit}),))


def test_scale_offset_sign_and_unit(tmp_path):
    text = """channels:
  time: {source: t, unit: ms}
  speed: {source: [nothing, v], unit: km/h}
  tank_pressure_1: {source: p, unit: bar, scale: 2, offset: -1}
  clamping_force_1: {source: F, sign: -1}
"""
    contents = _contents(
        t=([0.0, 1.0, 2.0], "s"),
        v=([36.0, 18.0, 0.0], ""),
        p=([1.0, 2.0, 3.0], "V"),
        F=([-1.0, 0.0, 1.0], "kN"),
    )
    channels = select_channels(contents, load_map(_map(tmp_path, text))[0])
    np.testing.assert_allclose(channels["speed"].time, [0.0, 1e-3, 2e-3])
    np.testing.assert_allclose(channels["speed"].samples, [10.0, 5.0, 0.0])
    np.testing.assert_allclose(channels["tank_pressure_1"].samples, [1e5, 3e5, 5e5])
    np.testing.assert_allclose(channels["clamping_force_1"].samples, [1000.0, 0.0, -1000.0])


def test_wheelsets_are_spelled_out_and_a_child_changes_its_parent(tmp_path):
    _map(tmp_path, 'channels:\n  "wheel_speed_{n}": "axle{n}"\n', "base.yaml")
    text = "extends: base.yaml\nchannels:\n  wheel_speed_3: {source: other, unit: km/h}\n"
    sources = load_map(_map(tmp_path, text))[0].sources
    assert sources["wheel_speed_2"].source == ("axle2",)
    assert sources["wheel_speed_3"].source == ("other",)


def test_states_by_name(tmp_path):
    text = "channels: {time: t, speed: v, valve_command_1: {source: MV, states: {Lüften: 2, Halten: 1}}}\n"
    channel_map = load_map(_map(tmp_path, text))[0]
    states = ["fill", "Lüften", "Halten", "1"]
    contents = _contents(t=([0, 1, 2, 3], "s"), v=([1.0] * 4, "m/s"), MV=(states, ""))
    command = select_channels(contents, channel_map)["valve_command_1"].samples
    np.testing.assert_array_equal(command, [0, 2, 1, 1])
    contents = _contents(t=([0, 1], "s"), v=([1.0] * 2, "m/s"), MV=(["fill", "auf"], ""))
    with pytest.raises(MapError, match="'auf', which is no state: name it in `states`"):
        select_channels(contents, channel_map)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("channels: {sped: v}\n", "did you mean 'speed'"),
        ("channels: {speed: {source: v, unit: bar}}\n", "'bar' is not a unit of speed"),
        ("channels: {speed: {source: v, factor: 2}}\n", "unknown key 'factor'"),
        ("channels: {speed: {source: v, sign: 2}}\n", "sign"),
        ("channels: {speed: {source: v, scale: .inf}}\n", "scale"),
        ("channels: {speed: v}\npreparation: {raster: 10}\n", "has no unit"),
        ("extends: mine.yaml\nchannels: {speed: v}\n", "circular"),
        ("extends: nothing\nchannels: {speed: v}\n", "no channel map 'nothing'"),
        ("channels: {speed: !!python/name:os.system v}\n", "tag"),
        ("channels: &a {speed: *a}\n", ""),
        ("channels: {speed: v}\ncsv: {encoding: cp12521}\n", "unknown encoding 'cp12521'"),
        ("channels: {speed: v}\ncsv: {encoding: base64}\n", "unknown encoding 'base64'"),
        ('channels: {speed: v}\ncsv: {decimal: ",", thousands: ","}\n', "',' is already the decimal sign"),
    ],
)
def test_a_wrong_map_is_refused_at_its_place(tmp_path, text, message):
    with pytest.raises(ScenarioErrors) as caught:
        load_map(_map(tmp_path, text))
    assert message in str(caught.value)
    assert f"mine.yaml:{4 if 'csv' in text else ''}" in str(caught.value)


def test_presets_load_and_every_channel_is_canonical():
    assert presets() == ("common-names", "uictest")
    for name in presets():
        loaded, inputs = load_map(name)
        assert loaded.sources.keys() <= CHANNEL_UNITS.keys()
        assert next(iter(inputs)) == f"library:channel_maps/{name}.yaml"
    assert load_map("uictest")[0].sources.keys() == CHANNEL_UNITS.keys()
    with pytest.raises(KeyError):
        load_map("nothing")


@pytest.mark.parametrize(
    ("channels", "message"),
    [
        ({"time": (TIME, "s"), "sped": (TIME, "m/s")}, r"no channel for 'speed'.*'sped'"),
        ({"time": (TIME, "s"), "speed": (TIME, "")}, "does not state the unit of 'speed'"),
        ({"time": (TIME, "s"), "speed": (TIME, "furlong")}, "has the unit 'furlong'; accepted"),
        ({"speed": (TIME, "m/s")}, "has no time axis"),
    ],
)
def test_what_does_not_fit_the_file_is_told(channels, message):
    with pytest.raises(MapError, match=message):
        select_channels(_contents(**channels), load_map("uictest")[0])


def test_one_name_in_two_groups_must_be_told_apart(tmp_path):
    groups = tuple(Group(g, {"speed": TIME}, {"speed": "m/s"}, TIME) for g in ("fast", "slow"))
    with pytest.raises(MapError, match="in several groups"):
        select_channels(Contents(groups), load_map("uictest")[0])
    chosen = load_map(_map(tmp_path, "channels: {speed: slow/speed}\n"))[0]
    assert select_channels(Contents(groups), chosen)["speed"].source == "speed"


def test_a_proposed_map_is_a_map_and_fits(tmp_path):
    contents = _contents(
        Zeit=([0.0, 1.0], "s"),
        vZug=([10.0, 9.0], "km/h"),
        way=([0.0, 3.0], "m"),
        pR=([8.0, 7.9], ""),
        **{'odd "name"\x1b': ([1.0, 2.0], "V")},
    )
    path = tmp_path / "proposed.yaml"
    path.write_text(proposed_map(contents))
    channels = select_channels(contents, load_map(str(path))[0])
    assert {"speed", "distance", "reservoir_pressure"} == channels.keys()
    assert "check it" in proposed_map(contents)
    assert list(channel_rows(contents))[1] == ("vZug", "km/h", "2", "9 .. 10")


def test_a_map_is_proposed_by_names_and_by_units_that_one_channel_has_and_a_preset_that_fits_named():
    a, b, zeit = (TIME, "s"), (TIME, "km/h"), {"Zeit": (TIME, "s")}
    assert 'speed: "b"' in proposed_map(_contents(a=a, b=b))
    assert "speed:" not in proposed_map(_contents(a=a, b=b, c=b))
    assert 'time: "Zeit"' in proposed_map(_contents(T=(TIME, "°C"), v=b, **zeit))
    own = _contents(time=a, speed=(TIME, "m/s"), slide_1=(TIME, ""))
    assert fitting_preset(own) == "uictest"
    assert fitting_preset(_contents(vZug=b, **zeit)) == "common-names"
    without_unit, by_unit_alone = _contents(vZug=(TIME, ""), **zeit), _contents(a=a, b=b)
    for contents in (without_unit, by_unit_alone, _contents(x=(TIME, "V"))):
        assert fitting_preset(contents) is None


def test_columns_of_a_structure_with_time_are_selected_by_their_number_over_its_time(tmp_path):
    time = np.arange(50) * 0.2
    values = np.stack([80.0 - 3.6 * time, 79.0 - 3.6 * time], axis=1)
    path = tmp_path / "stop.mat"
    savemat(path, {"simout": {"time": time[:, None], "signals": {"values": values, "label": "v"}}})
    channels = '{speed: {source: "v[1]", unit: km/h}, "wheel_speed_{n}": {source: "v[2]", unit: km/h}}'
    contents = read_here("mat", path, Dialect())
    assert [row[0] for row in channel_rows(contents)] == ["v[1]", "v[2]"]
    channels = select_channels(contents, load_map(_map(tmp_path, f"channels: {channels}\n"))[0])
    np.testing.assert_array_equal(channels["speed"].time, time)
    np.testing.assert_allclose(channels["speed"].samples, values[:, 0] / 3.6)
    np.testing.assert_allclose(channels["wheel_speed_3"].samples, values[:, 1] / 3.6)
