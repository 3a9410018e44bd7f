"""Two runs or two recordings side by side, and what between them is out of tolerance."""

from uictest.comparison.baseline import Baseline, Scope, accepted_document, read_baseline
from uictest.comparison.difference import Comparison
from uictest.comparison.folders import compare_run_folders, with_overlays
from uictest.comparison.overlay import Overlay
from uictest.comparison.page import comparison_html
from uictest.comparison.parameters import ParameterChange
from uictest.comparison.recordings import compare_recordings
from uictest.comparison.runs import compare_runs
from uictest.comparison.tolerance import Tolerance, Tolerances
from uictest.comparison.wording import comparison_json, comparison_lines, verdict_line

__all__ = [
    "Baseline",
    "Comparison",
    "Overlay",
    "ParameterChange",
    "Scope",
    "Tolerance",
    "Tolerances",
    "accepted_document",
    "compare_recordings",
    "compare_run_folders",
    "compare_runs",
    "comparison_html",
    "comparison_json",
    "comparison_lines",
    "read_baseline",
    "verdict_line",
    "with_overlays",
]
