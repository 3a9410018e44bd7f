from .examination import all_checks as all_checks, examine as examine
from .findings import (
    Examination as Examination,
    Finding as Finding,
    Status as Status,
    finding_document as finding_document,
    findings_json as findings_json,
    findings_suite as findings_suite,
)
from .known_stops import (
    REFERENCE as REFERENCE,
    Answer as Answer,
    Check as Check,
    KnownStops as KnownStops,
    NotCheckedError as NotCheckedError,
    computed_reference as computed_reference,
)
