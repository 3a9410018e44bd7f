"""What a run leaves: one writer per format, files that appear whole or not at all."""

from uictest.report.baseline import BaselineComparison, baseline_summary, case_word, not_compared_sentences
from uictest.report.content import RunContent
from uictest.report.difference import Difference
from uictest.report.escaping import printable
from uictest.report.formats import ReportFormat, write_formats
from uictest.report.github import annotation, case_annotations, missing_annotations, no_command
from uictest.report.junit import junit_xml
from uictest.report.latest import latest_run, point_latest
from uictest.report.lines import case_line, criterion_lines, definition_lines, missing_lines, part_lines
from uictest.report.manifest import manifest
from uictest.report.markdown import append_step_summary
from uictest.report.run_contents import read_run
from uictest.report.run_folder import RunFolder
from uictest.report.run_report import RESULTS, run_name, write_recording, write_reports
from uictest.report.subject import Subject
from uictest.report.sweep.content import SweepContent
from uictest.report.sweep.formats import write_sweep_formats
from uictest.report.sweep.github import sweep_annotations
from uictest.report.sweep.markdown import append_sweep_step_summary
from uictest.report.sweep.reading import SWEEP_RESULTS, read_sweep
from uictest.report.table import explanation_text, verdict_table
from uictest.report.wording import DIFFERS, counted, tally

__all__ = [
    "DIFFERS",
    "RESULTS",
    "SWEEP_RESULTS",
    "BaselineComparison",
    "Difference",
    "ReportFormat",
    "RunContent",
    "RunFolder",
    "Subject",
    "SweepContent",
    "annotation",
    "append_step_summary",
    "append_sweep_step_summary",
    "baseline_summary",
    "case_annotations",
    "case_line",
    "case_word",
    "counted",
    "criterion_lines",
    "definition_lines",
    "explanation_text",
    "junit_xml",
    "latest_run",
    "manifest",
    "missing_annotations",
    "missing_lines",
    "no_command",
    "not_compared_sentences",
    "part_lines",
    "point_latest",
    "printable",
    "read_run",
    "read_sweep",
    "run_name",
    "sweep_annotations",
    "tally",
    "verdict_table",
    "write_formats",
    "write_recording",
    "write_reports",
    "write_sweep_formats",
]
