"""A validation as a page: bias and limits of agreement of every figure of a stop, then stops and domain."""

from __future__ import annotations

import math

from uictest.analysis.validation.document import Validation
from uictest.analysis.validation.report import tally, validation_document
from uictest.analysis.validation.stops import Agreement
from uictest.core.measures import STOP_COLUMNS
from uictest.report.page import Effect, forest, render


def validation_html(validation: Validation) -> str:
    """Return one page of recorded stops against their simulation; it loads nothing."""
    effects = {each.figure: _effect(each) for each in validation.figures if each.figure in STOP_COLUMNS}
    return render(
        "validation.html.j2",
        with_plots=False,
        running_head=validation.name,
        validation=validation,
        document=validation_document(validation),
        tally=tally(validation),
        drawn=forest(
            (effect for effect in effects.values() if effect is not None),
            "Bias of each figure with its interval and the limits of agreement; the table has the numbers",
            "simulated - recorded, % of recorded; band: limits of agreement; filled: not 0 by the interval",
        ),
        not_drawn=[figure for figure, effect in effects.items() if effect is None],
    )


def _effect(agreement: Agreement) -> Effect | None:
    """Return the differences in per cent of the recorded figure; None where they have no such share."""
    own = agreement.relative
    if own is None:
        return None
    bias, low, high, *outer = (
        100.0 * end for end in (own.bias, own.bias_low, own.bias_high, own.limits_low, own.limits_high)
    )
    if not math.isfinite(bias + low + high + sum(outer)):
        return None
    return Effect(agreement.figure, bias, low, high, (outer[0], outer[1]))
