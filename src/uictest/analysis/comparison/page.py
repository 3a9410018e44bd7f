"""The page of a comparison: the answer, a forest of conditions, and panels of both sides."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, Final

from uictest.analysis.comparison.answer import Answer, short_names, shortened, signed, with_unit
from uictest.analysis.comparison.comparison_document import (
    STANDING_TONES,
    Comparison,
    conditions_table,
    differing_table,
    group_text,
    judged_table,
    paired_table,
    parameters_table,
    verdict_line,
)
from uictest.analysis.comparison.overlay import (
    BINS,
    ChannelDifference,
    Overlay,
    WorstInstant,
    curve_name,
    holds,
)
from uictest.core.recording import state_kind
from uictest.judging.evaluation import Status
from uictest.report import (
    Panel,
    PlotLine,
    channel_title,
    listed,
    number,
    printable,
    relative_cell,
    relative_percent,
    relative_text,
)
from uictest.report.page import (
    STEPS,
    Drawing,
    Effect,
    Mark,
    Plot,
    case_anchor,
    forest,
    fragment,
    packed,
    panel_form,
    panels_over_time,
    render,
    script_json,
)

_DIFFERENCE_HEIGHT: Final = 0.75
"""Of a panel of a difference, against one of both sides; chosen."""


def overlay_drawings(overlay: Overlay) -> list[Drawing]:
    """Return a drawing of each channel and its difference: a page of paper holds some, not all."""
    return [panels_over_time(overlay.trace, _channel_panels(channel)) for channel in overlay.channels]


def overlay_json(overlay: Overlay) -> str:
    """Return the data from which the script draws an overlay, over time and over distance."""
    trace = overlay.trace
    marks = [mark for channel in overlay.channels for mark in _channel_marks(channel)]
    return script_json(
        {
            "id": printable(overlay.title),
            "sampling": sampling_text(overlay),
            "start": trace.start,
            "end": trace.end,
            "over_time": packed(trace.curves, trace.interval),
            "over_distance": packed(overlay.over_distance.curves),
            "marks": [mark._asdict() for mark in marks],
            "marks_over_distance": [mark._asdict() for mark in _marks_over_distance(overlay)],
            "panels": [
                panel_form(*panel) for channel in overlay.channels for panel in _channel_panels(channel)
            ],
        }
    )


def sampling_text(overlay: Overlay) -> str:
    """Return the sentence on how the points of the lines were taken from the samples."""
    every = [f"{1e3 * interval:.4g} ms" for interval in overlay.intervals]
    sampled = (
        f"every {every[0]}" if every[0] == every[1] else f"every {every[0]} in A and every {every[1]} in B"
    )
    return (
        f"Sampled {sampled}. A line shows the smallest and the largest sample of each of {BINS} parts,"
        f" rounded to 1/{STEPS} of its range."
    )


def _channel_panels(difference: ChannelDifference) -> list[tuple[Panel, Sequence[PlotLine]]]:
    name, unit = difference.channel, _axis_unit(difference)
    title = printable(channel_title(name))
    sides = (
        PlotLine(curve_name("first", name), "A", "side-a"),
        PlotLine(curve_name("second", name), "B", "side-b"),
    )
    band = [] if difference.allowed is None else [-difference.allowed, difference.allowed]
    return [
        (Panel(printable(f"sides-of-{name}"), title, unit, (name,), include=()), sides),
        (
            Panel(_difference_key(name), f"B - A: {title}", unit, (name,), _DIFFERENCE_HEIGHT, (0.0, *band)),
            [PlotLine(curve_name("difference", name), "B - A", "difference")],
        ),
    ]


def _channel_marks(difference: ChannelDifference) -> Iterator[Mark]:
    """Yield the band of the tolerance and the worst instant."""
    key = _difference_key(difference.channel)
    if difference.allowed is not None:
        yield Mark(
            key,
            "tolerance",
            printable(f"allowed ±{with_unit(number(difference.allowed), difference.unit)}"),
            y=difference.allowed,
        )
    if difference.worst is not None:
        judged: Status = "pass" if difference.within else "fail"
        yield from _worst_mark(
            difference, difference.worst, "s", "not_applicable" if difference.within is None else judged
        )


def _marks_over_distance(overlay: Overlay) -> Iterator[Mark]:
    """Yield the worst places; no tolerance, which is for samples of the same time."""
    for each in overlay.channels:
        if (worst := overlay.over_distance.worst.get(each.channel)) is not None:
            yield from _worst_mark(each, worst, "m", "not_applicable")


def _worst_mark(
    difference: ChannelDifference, worst: WorstInstant, unit: str, status: Status
) -> Iterator[Mark]:
    apart = worst.second - worst.first
    if not apart:
        return
    label = printable(f"largest {signed(apart, difference.unit)} at {number(worst.at)} {unit}")
    if (
        not holds(difference.channel)
        and relative_percent(worst.first, worst.second, difference.unit) is not None
    ):
        label += f", {relative_text(worst.first, worst.second, difference.unit)} % of A"
    yield Mark(_difference_key(difference.channel), "point", label, worst.at, worst.at, apart, status=status)


def _axis_unit(difference: ChannelDifference) -> str:
    if holds(difference.channel):
        return "number of the state"
    return "dimensionless" if difference.unit == "1" else printable(difference.unit)


def _difference_key(channel: str) -> str:
    return printable(f"difference-of-{channel}")


def conditions_plot(answer: Answer) -> Plot | None:
    """Return the conditions with their intervals, the largest difference first; None where none has one."""
    effects = []
    for condition in answer.conditions:
        lead, percent = condition.lead, condition.percent
        if lead is None or percent is None:
            continue
        low, high = (
            relative_percent(lead.first, lead.first + end, lead.unit)
            for end in (lead.mean.low, lead.mean.high)
        )
        limits = (percent, percent) if low is None or high is None else (low, high)
        name = f"{shortened(condition.name)}: {signed(lead.mean.value, lead.unit)}"
        tone = STANDING_TONES.get(condition.standing)
        effects.append(Effect(name, percent, *limits, kind=f"effect {tone}" if tone else "effect"))
    leads = list(dict.fromkeys(each.lead.title for each in answer.conditions if each.lead))
    first, second = short_names(answer.subjects)
    title = (
        f"{listed(leads)}: {second} against {first}, %; green: better, red: worse, blue: different,"
        " open: no difference shown"
    )
    return forest(effects, f"{title}; the table has the numbers", title)


def comparison_html(*compared: Comparison, run: str = "") -> str:
    """Return one page with the answers, the tables below them and plots of both sides; it loads nothing.

    `run` is the name of the run whose variants are compared.
    """
    title = run or " and ".join(compared[0].subjects)
    overlays = [overlay for each in compared for overlay in each.overlays]
    stated = {remark for overlay in overlays for remark in overlay.remarks}
    return render(
        "comparison.html.j2",
        compared=compared,
        comparison=compared[0],
        run=run,
        stated=stated,
        overlays=overlays,
        fragments={overlay.title: fragment(case_anchor(overlay.title)) for overlay in overlays},
        verdict_line=verdict_line,
        conditions_plot=conditions_plot,
        conditions_table=conditions_table,
        judged_table=judged_table,
        differing_table=differing_table,
        parameters_table=parameters_table,
        paired_table=paired_table,
        group_text=group_text,
        **OVERLAY_WORDS,
        with_plots=bool(overlays),
        title=title,
        running_head=title,
    )


OVERLAY_WORDS: Final[dict[str, Any]] = {
    function.__name__: function
    for function in (
        *(overlay_drawings, overlay_json, sampling_text, relative_cell),
        *(case_anchor, channel_title, state_kind),
    )
}
"""What the template of stops laid over each other shows them by."""
