from .archive import dossier_files as dossier_files, packed as packed
from .manual import (
    known_errors as known_errors,
    pages as pages,
    requirements as requirements,
)
from .studies import RESULTS as RESULTS
