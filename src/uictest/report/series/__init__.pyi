from .junit import series_suite as series_suite
from .rows import series_tables as series_tables
from .series_sentences import (
    series_explanation as series_explanation,
    series_tally as series_tally,
    series_word as series_word,
)
from .tables import series_sections as series_sections
