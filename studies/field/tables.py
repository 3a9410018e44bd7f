"""The tables of the study, and what its stops say in sentences."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import nan

from studies.field.assumptions import REAL_TRAIN, SHAPES, Assumptions, FieldStop, even_braking_delay
from studies.field.search import Point, Trial, Varied, closest
from studies.study import Table, samples
from uictest import Recording
from uictest.units import PERCENT

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
    speeds = (f"wheel_speed_{n}_kmh" for n in _WHEELSETS)
    return samples(recording, "time_s", "distance_m", "speed_kmh", *speeds)


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


def simplest(best: Sequence[Trial]) -> Trial:
    """Return the closest stop of the first family that agrees, else that of the closest family."""
    return next((trial for trial in best if trial.stop.agrees), closest(best))


def notes(
    trials: Sequence[Trial], best: Sequence[Trial], base: Point, singles: Sequence[Varied]
) -> Iterator[str]:
    """Yield what agrees, what does not, and which single assumption makes the plainest stop agree."""
    shown = simplest(best)
    yield f"The simplest stop: {shown.assumptions}; {_figures(shown.stop)}."
    yield (
        f"Its four figures are selected, from {len(trials)} stops that were tried: they agree because they "
        "were searched for."
    )
    yield from _agreement_notes([trial for trial in trials if trial.stop.agrees])
    for trial in best:
        if not trial.stop.agrees:
            stop = f"{trial.assumptions}; {_figures(trial.stop)}"
            yield f"{trial.family.title}: no stop agrees. The closest: {stop}."
    yield from _single_notes(base, singles)
    yield (
        f"After a delay of {even_braking_delay():.2f} s an even deceleration would take the paper's time and"
        " distance: less than a brake takes to build up, so the real train braked harder first than last."
    )
    yield (
        "Four figures do not determine a stop: rail, cleaning and strength of the brake stand in for each"
        " other. The filter behind the paper's decelerations is not public."
    )


def _figures(stop: FieldStop) -> str:
    time, distance, least, greatest = stop.figures.values()
    return (
        f"{time:.1f} s, {distance:.0f} m, {least:.2f}-{greatest:.2f} m/s2, misfit {stop.misfit:.2f};"
        f" largest slide {stop.largest_slide / PERCENT:.0f} %"
    )


def _agreement_notes(agreeing: Sequence[Trial]) -> Iterator[str]:
    if not agreeing:
        return
    shapes = [trial.assumptions.shape for trial in agreeing]
    counts = ", ".join(f"{shape} {shapes.count(shape)}" for shape in SHAPES)
    yield f"Stops that agree, by friction along the track: {counts}."
    filling = [trial.assumptions.fill_time for trial in agreeing if not trial.assumptions.lead]
    if filling:
        yield f"The slowest build-up among them, the clock started by the command: {max(filling):.1f} s."
    leads = [trial.assumptions.lead for trial in agreeing if trial.assumptions.lead]
    if leads:
        yield f"The least lead of a distributor's command over the clock among them: {min(leads):.1f} s."
    actuations = [count for trial in agreeing for count in trial.stop.actuations]
    slides = [trial.stop.largest_slide / PERCENT for trial in agreeing]
    yield (
        f"In the stops that agree a WSP valve acts {min(actuations)} to {max(actuations)} times; the largest"
        f" slide is {min(slides):.0f} to {max(slides):.0f} %. A finer search may widen these ranges."
    )


def _single_notes(base: Point, singles: Sequence[Varied]) -> Iterator[str]:
    yield (
        f"The plainest stop: {base.assumptions}; {_figures(base.stop)}. One assumption is added to it, and"
        " the friction chosen anew:"
    )
    for single in singles:
        variation = single.variation
        if single.agreeing:
            ends = (single.agreeing[0].value, single.agreeing[-1].value)
            values = " to ".join(dict.fromkeys(map(variation.text, ends)))
            yield f"- {variation.name}: agrees at {values}."
        else:
            misfit, value = single.closest.stop.misfit, variation.text(single.closest.value)
            yield f"- {variation.name}: never agrees; least misfit {misfit:.2f}, at {value}."
