from .baseline import (
    Baseline as Baseline,
    accepted_document as accepted_document,
    read_baseline as read_baseline,
)
from .comparison_document import (
    Comparison as Comparison,
    comparison_document as comparison_document,
    comparison_json as comparison_json,
    csv_table as csv_table,
    variants_json as variants_json,
    verdict_line as verdict_line,
)
from .overlay import Overlay as Overlay
from .page import OVERLAY_WORDS as OVERLAY_WORDS, comparison_html as comparison_html
from .recordings import (
    compare_recordings as compare_recordings,
    compare_run_folders as compare_run_folders,
    stops_laid_over as stops_laid_over,
    with_overlays as with_overlays,
)
from .runs import compare_variants as compare_variants
from .tolerance import Scope as Scope, Tolerance as Tolerance, Tolerances as Tolerances
