"""Write the result of a sweep into its folder: `sweep.json`, the CSV tables, JUnit XML."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from uictest.core import files
from uictest.judging import evaluation
from uictest.report.junit_properties import WITH_TEST_PROPERTIES
from uictest.report.sweep.junit import sweep_junit_xml
from uictest.report.sweep.k_dry_file import K_DRY_FILE, k_dry_yaml
from uictest.report.sweep.reading import SWEEP_RESULTS
from uictest.report.sweep.result import SweepResult, sweep_document
from uictest.report.sweep.tables import csv_tables

OF_ONE_RESULT: Final = (
    *("map-*.csv", "sensitivity.csv", "frontier.csv", "quantiles.csv", "k_dry.csv", K_DRY_FILE),
    *(WITH_TEST_PROPERTIES, "index.html", "report.xlsx", "summary.md"),
)
"""Files that not every result has, or that not every run writes."""


def write_sweep_result(folder: Path, result: SweepResult, file: str) -> str:
    """Write everything but the summary of cases, and return the text of `sweep.json`.

    What an earlier, other result of the sweep left in the folder is removed: beside the new one it would lie.
    `file` is the sweep file as shown to users. Raises OSError.
    """
    document = evaluation.to_json(sweep_document(result))
    texts = csv_tables(result) | {"junit.xml": sweep_junit_xml(result, file), SWEEP_RESULTS: document}
    if result.requirements or result.test_case:
        texts[WITH_TEST_PROPERTIES] = sweep_junit_xml(result, file, test_properties=True)
    if result.k_dry:
        texts[K_DRY_FILE] = k_dry_yaml(result)
    if (folder / SWEEP_RESULTS).is_file() and (folder / SWEEP_RESULTS).read_text("utf-8") != document:
        files.remove_listed(folder, *OF_ONE_RESULT)
    for name, text in texts.items():
        files.write(folder, name, text)
    return document
