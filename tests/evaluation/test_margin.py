"""The narrowest margin of a case, on a scale that all criteria share."""

from __future__ import annotations

from typing import Any

import pytest

from uictest.evaluation import (
    CaseResult,
    Sensitivity,
    Verdict,
    VerdictInterval,
    narrowest_margin,
    relative_margin,
)

FLIPPING = Sensitivity(
    "cut-off", "km/h", 20.0, 40.0, (VerdictInterval(20, 30, "pass"), VerdictInterval(30, 40, "fail"))
)


def verdict(**changes: Any) -> Verdict:
    content: dict[str, Any] = {
        "id": "distance",
        "layer": "requirement",
        "value": 450.0,
        "unit": "m",
        "lower": None,
        "upper": 500.0,
        "margin": 50.0,
        "status": "pass",
        "reason": "",
        "definition": {},
    }
    return Verdict(**(content | changes))


def result(*criteria: Verdict) -> CaseResult:
    return CaseResult("stop", "stop.yaml", {}, "pass", "pass", criteria=criteria)


def test_a_margin_counts_over_its_bound() -> None:
    assert relative_margin(verdict()) == pytest.approx(0.1)
    assert relative_margin(verdict(margin=-25.0, status="fail")) == pytest.approx(-0.05)


def test_a_verdict_that_hangs_on_a_definition_has_no_margin() -> None:
    assert relative_margin(verdict(sensitivity=(FLIPPING,))) == 0.0


def test_what_only_says_yes_or_no_has_none() -> None:
    standstill = verdict(id="standstill", unit="1", value=1.0, lower=1.0, upper=None, margin=0.0)
    assert relative_margin(standstill) is None
    assert relative_margin(verdict(margin=None, status="not_applicable")) is None
    missed = verdict(id="standstill", unit="1", value=0.0, lower=1.0, upper=None, margin=-1.0, status="fail")
    assert relative_margin(missed) == -1.0


def test_the_narrowest_of_several_is_named() -> None:
    close = verdict(id="slide", unit="%", value=34.0, upper=35.0, margin=1.0)
    assert narrowest_margin(result(verdict(), close)) == (pytest.approx(1.0 / 35.0), "slide")
    assert narrowest_margin(result()) == (None, "")
