from .case_conditions import (
    controller_of as controller_of,
    controller_text as controller_text,
    interval_text as interval_text,
    notices as notices,
)
from .case_lines import expectation_lines as expectation_lines
from .ci_server import annotation as annotation, run_annotations as run_annotations
from .conditions import shared_conditions as shared_conditions
from .content import (
    CASES_IN_PYTHON as CASES_IN_PYTHON,
    DRAWN as DRAWN,
    STOPS as STOPS,
    Campaign as Campaign,
    CampaignColumn as CampaignColumn,
    CampaignTable as CampaignTable,
    CampaignTest as CampaignTest,
    CaseDescription as CaseDescription,
    RunContent as RunContent,
    RunManifest as RunManifest,
    drawn_cases as drawn_cases,
    named_parts as named_parts,
    read_manifest as read_manifest,
    run_manifest as run_manifest,
    without_machine as without_machine,
)
from .difference import (
    BaselineComparison as BaselineComparison,
    Difference as Difference,
    StatusChange as StatusChange,
    Value as Value,
    baseline_summary as baseline_summary,
    differences_table as differences_table,
    furthest_out as furthest_out,
    not_compared_sentences as not_compared_sentences,
    percent_text as percent_text,
    relative_cell as relative_cell,
    relative_percent as relative_percent,
    relative_text as relative_text,
    status_difference as status_difference,
    wheelset_quantity as wheelset_quantity,
)
from .formats import (
    DRAWING as DRAWING,
    FORMATS as FORMATS,
    IN_EVERY_RUN as IN_EVERY_RUN,
    Publication as Publication,
    append_step_summary as append_step_summary,
    publish as publish,
)
from .formats.csv import csv_text as csv_text
from .formats.html import html_table as html_table
from .formats.junit import junit_text as junit_text
from .formats.markdown import document_markdown as document_markdown
from .formats.text import (
    aligned_rows as aligned_rows,
    document_lines as document_lines,
    spaced_lines as spaced_lines,
    table_lines as table_lines,
    wrapped_sentence as wrapped_sentence,
)
from .page.plot import overlay_svg as overlay_svg
from .page.rendering import may_replace as may_replace
from .programme import MetRange as MetRange, programme_campaign as programme_campaign
from .robustness import rule_text as rule_text
from .run_folder import (
    RECORDINGS as RECORDINGS,
    RESULTS as RESULTS,
    differences_form as differences_form,
    read_run as read_run,
    recording_path as recording_path,
    run_content as run_content,
    run_name as run_name,
    run_texts as run_texts,
    with_recorded_traces as with_recorded_traces,
    write_controller_log as write_controller_log,
    write_recording as write_recording,
)
from .run_publication import (
    explained_cases_table as explained_cases_table,
    publication_of_run as publication_of_run,
    run_tables as run_tables,
)
from .run_text import last_lines as last_lines, run_lines as run_lines
from .series_report import comparison_table as comparison_table, missing_interval as missing_interval
from .sweep import LARGEST_CSV as LARGEST_CSV
from .sweep.result import (
    MET as MET,
    VALID as VALID,
    Flip as Flip,
    Frontier as Frontier,
    FrontierScan as FrontierScan,
    MapAxis as MapAxis,
    MeasureRange as MeasureRange,
    MissedCase as MissedCase,
    OutcomeCount as OutcomeCount,
    OutsideCount as OutsideCount,
    SobolIndex as SobolIndex,
    SobolSensitivity as SobolSensitivity,
    SurveyBias as SurveyBias,
    SurveyStep as SurveyStep,
    SweepContent as SweepContent,
    SweepDomain as SweepDomain,
    SweepMap as SweepMap,
    SweepResult as SweepResult,
    SweptController as SweptController,
    Trend as Trend,
    read_sweep as read_sweep,
    write_sweep_result as write_sweep_result,
)
from .sweep.sweep_sentences import (
    domain_notes as domain_notes,
    survey_notes as survey_notes,
    sweep_annotations as sweep_annotations,
    sweep_tally as sweep_tally,
)
from .sweep.sweep_tables import publication_of_sweep as publication_of_sweep, sweep_lines as sweep_lines
from .sweep.values import (
    DrawnInterval as DrawnInterval,
    SweptValue as SweptValue,
    WrittenValue as WrittenValue,
    interval_indices as interval_indices,
)
from .traces.quantities import (
    Panel as Panel,
    PlotLine as PlotLine,
    channel_title as channel_title,
    shown_unit as shown_unit,
)
from .traces.trace import (
    BAND_STOPS as BAND_STOPS,
    Curve as Curve,
    PlotTrace as PlotTrace,
    StopExtremes as StopExtremes,
    stop_extremes as stop_extremes,
    thinned as thinned,
    trace_of as trace_of,
    trace_of_stop as trace_of_stop,
    with_band as with_band,
)
from .verdict_sentences import counts_text as counts_text, missed_sentence as missed_sentence, tally as tally
from .words import (
    CASE_WORDS as CASE_WORDS,
    NAMED as NAMED,
    argument as argument,
    counted as counted,
    counted_in as counted_in,
    listed as listed,
    measure_heading as measure_heading,
    no_command as no_command,
    number as number,
    percent as percent,
    printable as printable,
    result_word as result_word,
    tone as tone,
)
