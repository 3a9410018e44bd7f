from .baseline import (
    Baseline as Baseline,
    Scope as Scope,
    accepted_document as accepted_document,
    read_baseline as read_baseline,
)
from .difference import Comparison as Comparison
from .folders import compare_run_folders as compare_run_folders, with_overlays as with_overlays
from .page import comparison_html as comparison_html
from .parameters import ParameterChange as ParameterChange, ParameterOfRun as ParameterOfRun
from .recordings import compare_recordings as compare_recordings
from .runs import compare_runs as compare_runs
from .tolerance import Tolerance as Tolerance, Tolerances as Tolerances
from .wording import (
    comparison_json as comparison_json,
    comparison_lines as comparison_lines,
    verdict_line as verdict_line,
)
