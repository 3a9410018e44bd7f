"""Judging a stop: figures in the engineer's units, criteria, verdicts, outcome, the result document."""

from uictest.evaluation.case import JUDGED_KEYS, error_result, evaluate
from uictest.evaluation.coverage import Coverage, MissingData
from uictest.evaluation.document import (
    SCHEMA,
    parts_document,
    parts_of,
    result_document,
    results_of,
    to_json,
)
from uictest.evaluation.judgement import judge
from uictest.evaluation.margin import narrowest_margin, relative_margin
from uictest.evaluation.parameters import EffectivePart, Parameter, parts_table
from uictest.evaluation.result import (
    CaseResult,
    Expectation,
    Figures,
    Outcome,
    WheelsetFigures,
    unit_of,
)
from uictest.evaluation.simulated import evaluate_simulated
from uictest.evaluation.verdict import AppliedDefinition, Judgement, Layer, Sensitivity, Stretch, Verdict

__all__ = [
    "JUDGED_KEYS",
    "SCHEMA",
    "AppliedDefinition",
    "CaseResult",
    "Coverage",
    "EffectivePart",
    "Expectation",
    "Figures",
    "Judgement",
    "Layer",
    "MissingData",
    "Outcome",
    "Parameter",
    "Sensitivity",
    "Stretch",
    "Verdict",
    "WheelsetFigures",
    "error_result",
    "evaluate",
    "evaluate_simulated",
    "judge",
    "narrowest_margin",
    "parts_document",
    "parts_of",
    "parts_table",
    "relative_margin",
    "result_document",
    "results_of",
    "to_json",
    "unit_of",
]
