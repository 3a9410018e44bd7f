"""The tables of the study: every stop that was tried, families, single assumptions, one stop over time."""

from __future__ import annotations

from collections.abc import Sequence
from math import nan

from uictest.core.recording import Recording
from uictest.core.units import KILOMETRE_PER_HOUR, PERCENT
from uictest.studies.field.assumptions import Assumptions
from uictest.studies.field.real_train import REAL_TRAIN, FieldStop
from uictest.studies.field.search import Trial
from uictest.studies.field.single import Point, Varied
from uictest.studies.study import Table, column

_UNITS = {"braking_time": "s", "braking_distance": "m"}
_WHEELSETS = (1, 2, 3, 4)


def trials_table(trials: Sequence[Trial]) -> Table:
    """Return assumptions, figures and misfits of every stop that was tried."""
    return {
        "family": [trial.family.name for trial in trials],
        "round": [trial.round for trial in trials],
        **_assumption_columns([trial.assumptions for trial in trials]),
        **_stop_columns([trial.stop for trial in trials]),
    }


def families_table(trials: Sequence[Trial], best: Sequence[Trial], agreements: Sequence[int]) -> Table:
    """Return the closest stop of every family, and how many of its repeats agree."""
    own = [[trial.stop for trial in trials if trial.family is each.family] for each in best]
    return {
        "family": [trial.family.name for trial in best],
        "tried": [len(stops) for stops in own],
        "agreeing": [sum(stop.agrees for stop in stops) for stops in own],
        "agreeing_in_run": [sum(stop.agrees_in_run for stop in stops) for stops in own],
        "closest_agrees_under_seeds": list(agreements),
        **_assumption_columns([trial.assumptions for trial in best]),
        **_stop_columns([trial.stop for trial in best]),
    }


def singles_table(base: Point, singles: Sequence[Varied]) -> Table:
    """Return the closest stop of every value of every single assumption, the plainest one first."""
    rows = [
        ("none", "", base),
        *((each.variation.name, each.variation.text(p.value), p) for each in singles for p in each.points),
    ]
    return {
        "added": [name for name, _, _ in rows],
        "value": [value for _, value, _ in rows],
        **_assumption_columns([point.assumptions for _, _, point in rows]),
        **_stop_columns([point.stop for _, _, point in rows]),
    }


def stop_table(recording: Recording) -> Table:
    """Return speeds of train and wheelsets over time."""
    return {
        "time_s": column(recording["time"], 1.0, 3),
        "distance_m": column(recording["distance"], 1.0, 3),
        "speed_kmh": column(recording["speed"], KILOMETRE_PER_HOUR, 3),
        **{
            f"wheel_speed_{n}_kmh": column(recording[f"wheel_speed_{n}"], KILOMETRE_PER_HOUR, 3)
            for n in _WHEELSETS
        },
    }


def _assumption_columns(assumed: Sequence[Assumptions]) -> Table:
    return {
        "friction_along_track": [each.shape for each in assumed],
        "friction": [round(each.friction, 4) for each in assumed],
        "place_m": [nan if each.shape == "constant" else round(each.place, 1) for each in assumed],
        "cleaning_energy_kjpm": [
            nan if each.cleaning_energy is None else round(each.cleaning_energy / 1e3, 2) for each in assumed
        ],
        "carry_over": [nan if each.cleaning_energy is None else each.carry_over for each in assumed],
        "brake": [each.brake for each in assumed],
        "fill_time_s": [round(each.fill_time, 3) for each in assumed],
        "pad_factor": [round(each.pad_factor, 3) for each in assumed],
        "lead_s": [round(each.lead, 3) for each in assumed],
    }


def _stop_columns(stops: Sequence[FieldStop]) -> Table:
    figures = {
        f"{name}_{_UNITS.get(name, 'mps2')}": [round(stop.figures[name], 3) for stop in stops]
        for name in REAL_TRAIN
    }
    misfits = {f"misfit_{name}": [round(stop.misfits[name], 3) for stop in stops] for name in REAL_TRAIN}
    actuations = {f"actuations_{n}": [stop.actuations[n - 1] for stop in stops] for n in _WHEELSETS}
    return {
        **figures,
        **misfits,
        "misfit": [round(stop.misfit, 3) for stop in stops],
        "agrees": [stop.agrees for stop in stops],
        **actuations,
        "largest_slide_percent": [round(stop.largest_slide / PERCENT, 1) for stop in stops],
    }
