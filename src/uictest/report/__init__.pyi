from .campaign import (
    STOPS as STOPS,
    Campaign as Campaign,
    CampaignColumn as CampaignColumn,
    CampaignTable as CampaignTable,
)
from .case_table import measure_columns as measure_columns
from .case_words import (
    CASE_WORDS as CASE_WORDS,
    DIFFERS as DIFFERS,
    EXPLAINED as EXPLAINED,
    line_word as line_word,
    result_word as result_word,
    tone as tone,
)
from .close_calls import close_lines as close_lines
from .content import (
    DRAWN as DRAWN,
    MOST_DRAWN as MOST_DRAWN,
    CaseDescription as CaseDescription,
    RunContent as RunContent,
    drawn_cases as drawn_cases,
)
from .counts import counted as counted, counted_in as counted_in
from .difference import (
    BaselineComparison as BaselineComparison,
    Difference as Difference,
    Value as Value,
    baseline_summary as baseline_summary,
    case_word as case_word,
    furthest_out as furthest_out,
    is_verdict as is_verdict,
    not_compared_sentences as not_compared_sentences,
    percent_text as percent_text,
    relative_percent as relative_percent,
    relative_text as relative_text,
    side_text as side_text,
    turn as turn,
    turn_tone as turn_tone,
    wheelset_quantity as wheelset_quantity,
    worst_of_wheelsets as worst_of_wheelsets,
)
from .escaping import (
    argument as argument,
    csv_cell as csv_cell,
    no_command as no_command,
    printable as printable,
    xml_text as xml_text,
)
from .firmness_sentences import firmness_lines as firmness_lines
from .formats import (
    IN_EVERY_RUN as IN_EVERY_RUN,
    draws_stops as draws_stops,
    format_names as format_names,
    write_formats as write_formats,
)
from .formats.csv import run_tables as run_tables
from .formats.junit import run_suites as run_suites, suites_of_run as suites_of_run
from .formats.md import append_step_summary as append_step_summary
from .github import (
    annotation as annotation,
    case_annotations as case_annotations,
    missing_annotations as missing_annotations,
)
from .junit import junit_text as junit_text
from .manifest import (
    CASES_IN_PYTHON as CASES_IN_PYTHON,
    RunManifest as RunManifest,
    named_parts as named_parts,
    read_manifest as read_manifest,
    run_manifest as run_manifest,
    without_machine as without_machine,
)
from .measure_heading import measure_heading as measure_heading
from .page.links import may_replace as may_replace
from .part_wording import (
    controller_text as controller_text,
    deviation_text as deviation_text,
    domain_lines as domain_lines,
    interval_text as interval_text,
    notices as notices,
)
from .repeat_wording import repeat_sentences as repeat_sentences, rule_text as rule_text
from .run_folder import (
    RECORDINGS as RECORDINGS,
    RESULTS as RESULTS,
    differences_form as differences_form,
    read_run as read_run,
    recording_path as recording_path,
    run_content as run_content,
    run_name as run_name,
    subjects_form as subjects_form,
    with_recorded_traces as with_recorded_traces,
    write_controller_log as write_controller_log,
    write_recording as write_recording,
    write_reports as write_reports,
)
from .series.series_sentences import (
    missing_interval as missing_interval,
    series_annotations as series_annotations,
    series_line as series_line,
    series_lines as series_lines,
    series_tally as series_tally,
    series_word as series_word,
)
from .series.tables import series_table as series_table
from .suggested_expectations import expectation_lines as expectation_lines
from .sweep import LARGEST_CSV as LARGEST_CSV, every_case as every_case
from .sweep.folder import (
    SWEEP_RESULTS as SWEEP_RESULTS,
    SweepContent as SweepContent,
    read_sweep as read_sweep,
    write_sweep_result as write_sweep_result,
)
from .sweep.formats import (
    append_sweep_step_summary as append_sweep_step_summary,
    load_sweep_formats as load_sweep_formats,
    sweep_format_names as sweep_format_names,
    write_sweep_formats as write_sweep_formats,
)
from .sweep.limits import (
    OutsideCount as OutsideCount,
    SurveyBias as SurveyBias,
    SurveyStep as SurveyStep,
    SweepDomain as SweepDomain,
    domain_notes as domain_notes,
    survey_notes as survey_notes,
)
from .sweep.map_text import map_lines as map_lines
from .sweep.result import (
    MET as MET,
    Flip as Flip,
    Frontier as Frontier,
    FrontierScan as FrontierScan,
    MapAxis as MapAxis,
    MeasureRange as MeasureRange,
    MissedCase as MissedCase,
    OutcomeCount as OutcomeCount,
    SobolIndex as SobolIndex,
    SobolSensitivity as SobolSensitivity,
    SweepMap as SweepMap,
    SweepResult as SweepResult,
    SweptController as SweptController,
    Trend as Trend,
)
from .sweep.summary_tables import numbers_of_sweep as numbers_of_sweep
from .sweep.sweep_sentences import (
    circumstances_words as circumstances_words,
    flip_words as flip_words,
    sweep_annotations as sweep_annotations,
    sweep_suite as sweep_suite,
    sweep_tally as sweep_tally,
)
from .sweep.values import (
    DrawnInterval as DrawnInterval,
    SweptValue as SweptValue,
    WrittenValue as WrittenValue,
)
from .terminal.table_lines import (
    aligned_rows as aligned_rows,
    document_lines as document_lines,
    table_lines as table_lines,
    titled_lines as titled_lines,
    wrapped_name as wrapped_name,
)
from .terminal.verdict_table import (
    case_line as case_line,
    criterion_lines as criterion_lines,
    definition_lines as definition_lines,
    explanation_text as explanation_text,
    missing_lines as missing_lines,
    part_lines as part_lines,
    verdict_table as verdict_table,
)
from .text_tables import (
    csv_text as csv_text,
    document_markdown as document_markdown,
    html_table as html_table,
    prose as prose,
)
from .traces.band import (
    BAND_STOPS as BAND_STOPS,
    StopExtremes as StopExtremes,
    stop_extremes as stop_extremes,
    with_band as with_band,
)
from .traces.overlay_svg import overlay_svg as overlay_svg
from .traces.quantities import (
    Panel as Panel,
    PlotLine as PlotLine,
    channel_title as channel_title,
    shown_unit as shown_unit,
)
from .traces.trace import (
    Curve as Curve,
    PlotTrace as PlotTrace,
    thinned as thinned,
    trace_of as trace_of,
    trace_of_stop as trace_of_stop,
)
from .verdict_sentences import (
    counts_text as counts_text,
    listed as listed,
    number as number,
    tally as tally,
)
