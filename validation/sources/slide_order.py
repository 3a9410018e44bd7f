"""Which wheelsets slide where not all of them do."""

from __future__ import annotations

from studies.stop_runner import StopRunner
from validation.source import Comparison, Findings, Source

FRICTIONS = tuple(f"{0.160 + 0.002 * step:.3f}" for step in range(26))
"""Initial friction of the rail, from where all wheelsets slide to where none does."""
SEEDS = range(3)
SLIDING = 0.05
"""Largest slide above which a wheelset counts as sliding; chosen."""
BOGIES = ((1, 2), (3, 4))
"""Leading and trailing wheelset of each bogie."""
TRAILING = {trailing for _, trailing in BOGIES}


def run(stop_runner: StopRunner) -> Findings:
    """Count the stops in which some wheelsets slide, and which of them do."""
    cases = stop_runner.cases("slide-80", {"rail.friction": list(FRICTIONS)})
    sliding = [
        {n for n, wheelset in enumerate(stop.wheelsets, 1) if wheelset["maximum_slide"] > SLIDING}
        for each in stop_runner.repeated(cases, SEEDS)
        for stop in each.stops
    ]
    some = [each for each in sliding if 0 < len(each) < 4]
    ordered = [each for each in some if all(b in each for a, b in BOGIES if a in each)]
    alone = [each for each in some if each <= TRAILING]
    return Findings(
        [
            Comparison(
                f"stops with slides of some wheelsets in which {what}",
                "%",
                100.0,
                100.0 * len(stops) / len(some),
            )
            for what, stops in (
                ("no leading one slides without its trailing one", ordered),
                ("only 2 and 4 slide", alone),
            )
        ],
        notes=(
            (
                f"Slide test from 80 km/h at frictions {FRICTIONS[0]} to {FRICTIONS[-1]}, {len(SEEDS)} "
                f"seeds each: all four slide in {sum(len(each) == 4 for each in sliding)} stops, none in "
                f"{sum(not each for each in sliding)}, some in {len(some)}. A wheelset slides if its "
                f"largest slide exceeds {100.0 * SLIDING:.0f} % (chosen)."
            ),
        ),
    )


SOURCE = Source(
    name="slide-order",
    title="Wheelsets that slide first",
    place=(
        "Lee and Kang, PLoS ONE 10(8) e0135459, 2015, text on Fig 8: in one stop, slides of wheelsets 2 "
        "and 4 alone; read in a copy of the text"
    ),
    kind="second-hand",
    fitted="Nothing. The height of the traction link was set so that all four slide in `slide-80`",
    shows="That braking takes load from the trailing wheelset of each bogie, which therefore slides first.",
    does_not_show="How much load: neither friction nor vehicle of that test is known here.",
    run=run,
)
