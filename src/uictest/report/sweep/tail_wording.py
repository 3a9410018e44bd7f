"""Quantiles and K_dry in words, the same in every format."""

from __future__ import annotations

import math

from uictest.report.sweep.tails import DrawCount, KDry, KDryLevel, MeasureQuantiles, Quantile
from uictest.report.sweep.wording import circumstances_words
from uictest.report.wording import counted, number, quantity

_K_DRY_DECIMALS = 3


def share_text(share: float) -> str:
    """Return a share in per cent, e.g. `0.1 %` or `99.9999999 %`."""
    return f"{100.0 * share:.10g} %"


def probability_text(level: KDryLevel) -> str:
    """Return the confidence level of an EBCL: the share of stops that decelerate at least as much."""
    return share_text(1.0 - level.shortfall)


def k_dry_text(k_dry: float) -> str:
    """Return K_dry with three decimals, rounded down: rounded up it would promise too much."""
    scale = 10**_K_DRY_DECIMALS
    # A product such as 1000 x 0.957 lies below the whole number that it is.
    return f"{math.floor(k_dry * scale + 1e-9) / scale:.{_K_DRY_DECIMALS}f}"


def bound_text(quantile: Quantile) -> str:
    """Return the bounds of a supported quantile, e.g. `at least 1.0732` or `1.1012 .. 1.1019`."""
    if quantile.side == "both":
        return f"{number(quantile.lower)} .. {number(quantile.upper)}"
    return (
        f"at least {number(quantile.lower)}"
        if quantile.side == "lower"
        else f"at most {number(quantile.upper)}"
    )


def refusal_text(draws_needed: int, sample: DrawCount) -> str:
    """Return why a sample supports no bound, e.g. `needs 299572 draws, has 20000`."""
    if sample.draws < draws_needed:
        return f"needs {draws_needed} draws, has {sample.draws}"
    return f"may lie among the {counted(sample.without_value, 'draw')} without a value"


def sample_words(sample: DrawCount) -> str:
    """Return the number of draws, and how many of them count as the worst."""
    if not sample.without_value:
        return counted(sample.draws, "draw")
    verb = "count" if sample.without_value > 1 else "counts"
    return f"{counted(sample.draws, 'draw')}; {sample.without_value} without a value {verb} as the worst"


def quantiles_title(table: MeasureQuantiles) -> str:
    """Return what a table of quantiles shows."""
    unit = "" if table.unit == "1" else f", {table.unit}"
    at = f" at {circumstances_words(table.circumstances)}" if table.circumstances else ""
    return f"quantiles of {table.measure}{unit}{at}"


def k_dry_title(table: KDry) -> str:
    """Return what a table of K_dry shows."""
    at = f" at {circumstances_words(table.circumstances)}" if table.circumstances else ""
    return f"K_dry of {table.measure}{at}"


def nominal_words(table: KDry) -> str:
    """Return the nominal deceleration and where it comes from."""
    if table.nominal is None:
        return "the nominal case has no deceleration"
    origin = "stated in the sweep file" if table.nominal_is_stated else "of the scenario with its own values"
    return f"nominal {quantity(table.nominal, 'm/s2')}, {origin}"


def sliding_words(table: KDry) -> str:
    """Return in how many draws a wheelset slides, for which K_dry is not defined; empty without any."""
    if not table.sliding:
        return ""
    draws = f"a wheelset slides in {table.sliding} of {counted(table.sample.draws, 'draw')}"
    return f"{draws}, so that this is no K_dry: on dry rail none slides"
