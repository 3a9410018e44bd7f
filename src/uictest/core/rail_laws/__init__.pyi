from .law import (
    DEFAULT as DEFAULT,
    LAWS as LAWS,
    MOST_NUMBERS as MOST_NUMBERS,
    LawNumber as LawNumber,
    RailLaw as RailLaw,
    clean_part as clean_part,
    own_share as own_share,
)
