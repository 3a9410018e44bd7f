"""What the stops say of the real train's, in sentences."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from uictest.core.units import PERCENT
from uictest.studies.field.assumptions import SHAPES
from uictest.studies.field.real_train import FieldStop, even_braking_delay
from uictest.studies.field.search import Trial, closest
from uictest.studies.field.single import Point, Varied


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
