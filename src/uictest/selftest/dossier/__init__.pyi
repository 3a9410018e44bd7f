from .archive import dossier_files as dossier_files, packed as packed
from .manual import (
    known_errors as known_errors,
    pages as pages,
    requirements as requirements,
)
from .run_of_tests import (
    TestRun as TestRun,
    read_test_run as read_test_run,
    tested_program as tested_program,
)
from .studies import RESULTS as RESULTS
