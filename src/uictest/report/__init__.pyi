from .case_conditions import (
    controller_text as controller_text,
    deviation_text as deviation_text,
    interval_text as interval_text,
    notices as notices,
)
from .case_lines import (
    case_line as case_line,
    close_lines as close_lines,
    criterion_lines as criterion_lines,
    definition_lines as definition_lines,
    domain_lines as domain_lines,
    expectation_lines as expectation_lines,
    explanation_lines as explanation_lines,
    firmness_lines as firmness_lines,
    missing_lines as missing_lines,
    part_lines as part_lines,
    series_line as series_line,
    series_lines as series_lines,
)
from .ci_server import (
    annotation as annotation,
    case_annotations as case_annotations,
    missing_annotations as missing_annotations,
    run_suites as run_suites,
    series_annotations as series_annotations,
)
from .content import (
    CASES_IN_PYTHON as CASES_IN_PYTHON,
    DRAWN as DRAWN,
    STOPS as STOPS,
    Campaign as Campaign,
    CampaignColumn as CampaignColumn,
    CampaignTable as CampaignTable,
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
    case_word as case_word,
    furthest_out as furthest_out,
    not_compared_sentences as not_compared_sentences,
    percent_text as percent_text,
    relative_percent as relative_percent,
    relative_text as relative_text,
    side_text as side_text,
    status_difference as status_difference,
    turn as turn,
    turn_tone as turn_tone,
    wheelset_quantity as wheelset_quantity,
    worst_of_wheelsets as worst_of_wheelsets,
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
from .formats.text import (
    aligned_rows as aligned_rows,
    coloured_text as coloured_text,
    document_lines as document_lines,
    table_lines as table_lines,
    titled_lines as titled_lines,
    wrapped_name as wrapped_name,
)
from .page.plot import overlay_svg as overlay_svg
from .page.rendering import may_replace as may_replace
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
    subjects_form as subjects_form,
    with_recorded_traces as with_recorded_traces,
    write_controller_log as write_controller_log,
    write_recording as write_recording,
)
from .run_publication import (
    cases_table as cases_table,
    explained_cases_table as explained_cases_table,
    publication_of_run as publication_of_run,
    run_tables as run_tables,
)
from .series_report import (
    comparison_table as comparison_table,
    missing_interval as missing_interval,
    series_lines_of_terminal as series_lines_of_terminal,
)
from .sweep import LARGEST_CSV as LARGEST_CSV, every_case as every_case
from .sweep.result import (
    MET as MET,
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
from .sweep.sweep_maps import map_lines as map_lines
from .sweep.sweep_sentences import (
    domain_notes as domain_notes,
    survey_notes as survey_notes,
    sweep_annotations as sweep_annotations,
    sweep_tally as sweep_tally,
)
from .sweep.sweep_tables import (
    numbers_of_sweep as numbers_of_sweep,
    publication_of_sweep as publication_of_sweep,
)
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
from .verdict_sentences import counts_text as counts_text, tally as tally
from .words import (
    CASE_WORDS as CASE_WORDS,
    DIFFERS as DIFFERS,
    EXPLAINED as EXPLAINED,
    argument as argument,
    counted as counted,
    counted_in as counted_in,
    csv_cell as csv_cell,
    line_word as line_word,
    listed as listed,
    measure_heading as measure_heading,
    no_command as no_command,
    number as number,
    printable as printable,
    result_word as result_word,
    tone as tone,
)
