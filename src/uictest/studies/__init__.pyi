from .comparison import claims as claims, lines as lines, misses as misses, tally as tally
from .page import write_pages as write_pages
from .quantity import (
    OwnBand as OwnBand,
    SourceBand as SourceBand,
    StudyQuantity as StudyQuantity,
    StudyValue as StudyValue,
)
from .stop_runner import StopRunner as StopRunner
from .study import (
    STUDIES as STUDIES,
    Study as Study,
    StudyFindings as StudyFindings,
    StudyResult as StudyResult,
    run_study as run_study,
)
from .table import document as document, study_table as study_table
from .writing import (
    write_comparison as write_comparison,
    write_figures as write_figures,
    write_tables as write_tables,
)
