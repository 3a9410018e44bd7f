"""What valves, calipers and discs do."""

import math

import numpy as np
import pytest

from uictest.core.measures import MEASURES, WHEELSET_MEASURES, wheelset_column_values

HIGHEST = MEASURES["maximum_disc_temperature"]


def wheelsets(*temperatures):
    records = np.zeros(4, WHEELSET_MEASURES).view(np.recarray)
    records.maximum_disc_temperature = temperatures
    return records


def test_disc_temperatures_are_reported_in_degrees_and_bounded_in_kelvin():
    hot = wheelsets(373.15, 383.15, 373.15, 373.15)
    assert HIGHEST.read(None, hot, {}).values == (373.15, 383.15, 373.15, 373.15)
    assert wheelset_column_values(hot[1])["maximum_disc_temperature_degc"] == pytest.approx(110.0)


def test_without_a_model_of_the_discs_the_measure_says_which_key_asks_for_it():
    cold = wheelsets(*[math.nan] * 4)
    value = HIGHEST.read(None, cold, {})
    assert value.values == ()
    assert "brake.disc_temperature" in value.unavailable_reason
    assert math.isnan(wheelset_column_values(cold[0])["maximum_disc_temperature_degc"])
