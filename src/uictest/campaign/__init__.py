"""Batches of cases: selecting them, running them, keeping their results in order."""

from uictest.campaign.examination import Examined, RecordingWish, examine
from uictest.campaign.execution import Campaign, run
from uictest.campaign.expression import ExpressionError
from uictest.campaign.parts import PartsOfCases, parts_of_cases, parts_of_recorded, with_parts
from uictest.campaign.replay import replay, shortest_cycle
from uictest.campaign.selection import by_expression, by_id, by_tag
from uictest.campaign.subjects import subject_of, subjects_of

__all__ = [
    "Campaign",
    "Examined",
    "ExpressionError",
    "PartsOfCases",
    "RecordingWish",
    "by_expression",
    "by_id",
    "by_tag",
    "examine",
    "parts_of_cases",
    "parts_of_recorded",
    "replay",
    "run",
    "shortest_cycle",
    "subject_of",
    "subjects_of",
    "with_parts",
]
