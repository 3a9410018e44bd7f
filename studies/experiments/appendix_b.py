"""The limits of UIC 541-05 Appendix B: a dry stop and a slip-brake test from 120 km/h."""

from __future__ import annotations

from functools import partial

from studies.figures.appendix_b import draw
from studies.quantity import NOT_ASKED, OwnBand, SourceBand, StudyQuantity, StudyValue, spread
from studies.stop_runner import StopRunner, verdict_value
from studies.study import Study, StudyFindings, Table, column
from uictest import Recording
from uictest.units import KILOMETRE_PER_HOUR

SEEDS = range(5)

DISTANCES = (440.0, 490.0)
SLIDE = 35.0

QUANTITIES = (
    StudyQuantity(
        "braking_distance",
        "braking distance, position R, dry",
        "m",
        "440-490 m",
        status="calibrated",
        band=SourceBand(lower=DISTANCES[0], upper=DISTANCES[1]),
    ),
    StudyQuantity(
        "off_the_middle",
        "its distance from the middle of the band",
        "m",
        NOT_ASKED,
        status="calibrated",
        band=OwnBand(upper=15.0, reason="ours: near the middle"),
    ),
    StudyQuantity(
        "initial_adhesion",
        "deceleration in the first phase of the slip-brake test",
        "g",
        "below 0.08 g",
        status="calibrated",
        band=SourceBand(upper=0.08, below=True),
        digits=4,
    ),
    StudyQuantity(
        "minimum_slide",
        "minimum slide: time down to 60 km/h in which half of the wheelsets slide",
        "%",
        "above 35 %",
        status="predicted",
        band=SourceBand(lower=SLIDE),
    ),
)


def run(stop_runner: StopRunner) -> StudyFindings:
    """Judge both stops with the shipped profile of Appendix B."""
    (dry,) = stop_runner.cases("dry-120")
    (slip,) = stop_runner.cases("slip-120")
    (dry_repeats,), (slip_repeats,) = (
        stop_runner.repeated([dry], [0]),
        stop_runner.repeated([slip], SEEDS),
    )
    distance = verdict_value(dry_repeats.stops[0], "braking-distance")
    adhesion, slide = (
        spread([verdict_value(stop, criterion) for stop in slip_repeats.stops])
        for criterion in ("initial-adhesion", "minimum-slide")
    )
    dry_stop, slip_stop = stop_runner.recordings([dry, slip])
    return StudyFindings(
        {
            "braking_distance": StudyValue(distance),
            "off_the_middle": StudyValue(abs(distance - sum(DISTANCES) / 2.0)),
            "initial_adhesion": adhesion,
            "minimum_slide": slide,
        },
        tables={"dry-stop": _table(dry_stop), "slip-brake-test": _table(slip_stop)},
        drawings={"appendix-b": partial(draw, dry_stop, slip_stop, DISTANCES)},
        notes=(
            (
                "The leaflet itself was not available: what the first phase is, and that the minimum slide "
                "is a share of time (inferred from TB/T 3009-2019), are readings of the profile "
                "uic-541-05-appendix-b."
            ),
            "The calibration asked for the depth of the slides of this stop, not for their share of time.",
            f"Slip-brake test: {len(SEEDS)} stops that differ in the noise of the sensors, median and range.",
        ),
    )


def _table(recording: Recording) -> Table:
    columns: dict[str, list[float]] = {
        "time_s": column(recording["time"], 1.0, 3),
        "distance_m": column(recording["distance"], 1.0, 3),
        "speed_kmh": column(recording["speed"], KILOMETRE_PER_HOUR, 3),
    }
    for n in (1, 2, 3, 4):
        columns[f"wheel_speed_{n}_kmh"] = column(recording[f"wheel_speed_{n}"], KILOMETRE_PER_HOUR, 3)
        columns[f"slide_{n}"] = column(recording[f"slide_{n}"], 1.0, 4)
    return columns


STUDY = Study(
    "appendix-b",
    "UIC 541-05 Appendix B: dry stop and slip-brake test from 120 km/h",
    "below 0.08 g in the first phase, minimum slide above 35 % on at least half of the wheelsets, 440-490 m",
    QUANTITIES,
    run,
    position=90,
)
