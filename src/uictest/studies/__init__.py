"""The source's experiments, and ours about its rig: each runs, and says what the source has beside ours."""

from uictest.studies.catalogue import STUDIES
from uictest.studies.comparison import lines
from uictest.studies.document import document
from uictest.studies.laboratory import Laboratory
from uictest.studies.quantity import Comparison, Quantity, Reading
from uictest.studies.study import Conducted, Findings, Study, conduct
from uictest.studies.table import study_table
from uictest.studies.writing import write_comparison, write_figures, write_tables

__all__ = [
    "STUDIES",
    "Comparison",
    "Conducted",
    "Findings",
    "Laboratory",
    "Quantity",
    "Reading",
    "Study",
    "conduct",
    "document",
    "lines",
    "study_table",
    "write_comparison",
    "write_figures",
    "write_tables",
]
