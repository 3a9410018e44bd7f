from .baseline import (
    Baseline as Baseline,
    accepted_document as accepted_document,
    read_baseline as read_baseline,
)
from .difference import (
    Comparison as Comparison,
    comparison_document as comparison_document,
    comparison_json as comparison_json,
    verdict_line as verdict_line,
)
from .page import (
    comparison_html as comparison_html,
    differences_table as differences_table,
    variants_html as variants_html,
)
from .paired_document import variants_document as variants_document
from .paired_stops import (
    Draw as Draw,
    PairedDifference as PairedDifference,
    PairedGroup as PairedGroup,
    compare_variants as compare_variants,
    paired_group as paired_group,
    variants_json as variants_json,
)
from .parameters import ParameterChange as ParameterChange, ParameterOfRun as ParameterOfRun
from .recordings import (
    compare_recordings as compare_recordings,
    compare_run_folders as compare_run_folders,
    with_overlays as with_overlays,
)
from .runs import compare_runs as compare_runs
from .tolerance import Scope as Scope, Tolerance as Tolerance, Tolerances as Tolerances
