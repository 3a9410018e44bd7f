"""The result of a sweep: read back, as tables, and in its summary."""

import json

import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from markdown_it import MarkdownIt

from uictest.core.document import Lines, Table
from uictest.report import publication_of_sweep, publish, write_recording
from uictest.report.sweep.result import read_sweep, sweep_document
from uictest.report.sweep.sweep_tables import (
    frontier_table,
    map_table,
    numbers_of_sweep,
    rates_table,
    sensitivity_table,
    sweep_summary,
    sweep_tables,
    trends_table,
)

from ..builders import HOSTILE, assert_as_csv, make_recording, make_result


@pytest.fixture
def folder(make_sweep):
    """The folder of a finished sweep with one case worth looking at."""
    content = make_sweep((make_result(),))
    document = sweep_document(content.result)
    (content.folder / "results.json").write_text(json.dumps(document))
    (content.folder / "manifest.json").write_text(json.dumps(content.manifest))
    return content.folder


def test_a_sweep_is_read_back_with_its_recordings_where_they_are_to_be_drawn(folder, make_sweep):
    content = read_sweep(folder)
    assert sweep_document(content.result) == sweep_document(make_sweep((make_result(),)).result)
    assert (content.folder, content.manifest) == (folder, make_sweep().manifest)
    assert content.traces == {}
    write_recording(folder, "dry-120[command=90]", make_recording(400))
    assert list(read_sweep(folder, traces=True).traces) == ["dry-120[command=90]"]


@pytest.mark.parametrize("text", ["", "[]", "{", '{"schema": "uictest/result/1"}'])
def test_what_is_no_sweep_is_rejected(folder, text):
    (folder / "results.json").write_text(text)
    with pytest.raises(ValueError, match=r"results\.json"):
        read_sweep(folder)


def test_a_worst_case_that_is_none_or_whose_id_is_a_path_is_refused(folder):
    document = json.loads((folder / "results.json").read_text())
    escaped = {**document["worst"][0], "id": "../escaped"}
    wrong = "not the result of a sweep"
    reasons = [([{}], wrong), ([1], wrong), (1, wrong), ([escaped], ".*is not the name of a file")]
    for worst, reason in reasons:
        (folder / "results.json").write_text(json.dumps(document | {"worst": worst}))
        with pytest.raises(ValueError, match=rf"results\.json: {reason}"):
            read_sweep(folder)


def shown(table):
    return [[column.title, *texts] for column, texts in table.for_people]


def test_rates_have_the_share_met_at_each_value(make_sweep):
    table = rates_table(make_sweep().result)
    first, second = table.records
    assert (first["parameter"], first["value"], first["cases"], first["met"], first["share_met"]) == (
        *("brake.90 %", "80 %", 2, 2, 1.0),
    )
    counts = [{"value": "0.1", "cases": 4, "met": 3, "outcomes": {"pass": 3, "fail": 1}}]
    counts.append({"value": "0.2", "cases": 0, "met": 0, "outcomes": {}})
    whole, none = rates_table(make_sweep(rates={"rail.friction": counts}).result).records
    assert (whole["share_met"], whole["pass"], none["share_met"], none["pass"]) == (0.75, 3, None, None)
    assert second["share_met"] == 0.5
    assert shown(table)[-1] == [" ", "██████████", "█████░░░░░"]
    assert shown(table)[:6] == [
        *(["parameter", "brake.90 %", ""], ["value", "80 %", "90 %"], ["cases", "2", "2"]),
        *(["met", "2", "1"], ["met\n%", "100", "50"], ["fail", "-", "1"]),
    ]


def test_maps_trends_sensitivities_and_the_frontier_are_tables(make_sweep):
    result = make_sweep().result
    assert list(map_table(result.maps[1]).records) == [
        {"brake.90 % \\ rail.friction": "80 %", "0.10": 1.5, "0.12": 2.5},
        {"brake.90 % \\ rail.friction": "90 %", "0.10": None, "0.12": 3.5},
    ]
    first, _ = trends_table(result).records
    assert list(first.values()) == ["brake.90 %", "80 %", "90 %", "90 %", 2, 1.0, 2.0, 3.0]
    (index,) = sensitivity_table(result).records
    assert (index["90 %"], index["first"], index["total_high"]) == ("90 %", 0.5, 0.6)
    assert shown(sensitivity_table(result))[-2:] == [["with the others", "0.500"], ["95 %", "0.400 .. 0.600"]]
    (flip,) = frontier_table(result.frontier).records
    ends = {"90 %": "90 %", "from": "90 %", "to": "0.11"}
    assert flip == ends | {"met_at_from": False, "flips": 1, "note": "90 %"}
    assert ["verdict", "not met up to 90 %, met from 0.11"] in shown(frontier_table(result.frontier))
    names = ["rates", "map-met", "map-braking_distance_m", "trends", "sensitivity", "frontier"]
    assert [table.name for table in sweep_tables(result)] == names


def test_the_summary_has_every_finding_what_decides_first(make_sweep):
    worst = (make_result(id="b[x]", outcome="fail", criteria=(), reason="locked"), make_result())
    document = sweep_summary(make_sweep(worst).result, {"file": "study.sweep.yaml"})
    where, missed, *_ = document.sections
    assert where.sentences == ["3 of 4 cases as expected, by brake.90 %: all at 80 %; in part at 90 %"]
    [block] = missed.blocks
    assert (block.heading, block.lines) == (
        "1 case misses requirements: brake.90 % 90 %",
        ["worst b[x]: locked"],
    )
    assert block.command == "uictest sweep study.sweep.yaml -k 'b[x]' -o 'alone/b[x]'"
    assert document.title == "uictest sweep: 4 cases: 3 pass, 1 fail; 1 not as expected"
    sections = {section.title: section for section in document.sections if section.title}
    assert list(sections) == [
        *("90 %", "Share of cases met, %"),
        *("Cases met by value of each parameter", "Share of the variance that each parameter explains"),
        *("Frontier along 90 %", "Measures", "Notes"),
    ]
    assert shown(sections["90 %"]) == [["parameter", "brake.90 %"], ["values", "80 %, 90 %"]]
    assert shown(sections["Share of cases met, %"]) == [
        *(["brake.90 % ↓ rail.friction →", "80 %", "90 %"], ["0.10", "100", "0"], ["0.12", "100", "100"])
    ]
    numbers = [column.is_number for column in sections["Share of cases met, %"].columns]
    assert numbers == [False, True, True]


def test_what_a_sweep_does_not_have_is_no_section_and_many_values_are_referred_to(make_sweep):
    counts = [{"value": str(k), "cases": 1, "met": 1, "outcomes": {}} for k in range(31)]
    nothing = {"maps": [], "missed": [], "sensitivities": [], "measures": [], "notes": []}
    content = make_sweep(frontier=None, **nothing, rates={"rail.friction": counts})
    tables = [section for section in sweep_summary(content.result, {}).sections if isinstance(section, Table)]
    assert [table.title for table in tables if table.rows] == ["90 %"]
    lines = [section for section in sweep_summary(content.result, {}).sections if isinstance(section, Lines)]
    assert lines[1].sentences == ["rail.friction: 31 values, see tables/rates.csv"]


def test_of_a_long_frontier_flips_are_shown_first_and_the_rest_is_counted(make_sweep):
    flip = {"low": "1", "high": "2", "met_at_low": True}
    scans = [
        {"circumstances": {"a": str(k)}, "flips": [flip] if k > 35 else [], "note": "all met"}
        for k in range(40)
    ]
    result = make_sweep(frontier={"parameter": "b", "stretches": scans}).result
    *_, table, more = numbers_of_sweep(result)
    assert (len(table.rows), sum(row.flip is not None for row in table.rows[:4])) == (30, 4)
    assert more.sentences == ["10 more in tables/frontier.csv"]


def test_a_large_map_is_shown_small(make_sweep):
    values, ones = [str(k) for k in range(1000)], [[1] * 1000] * 1000
    axes = {axis: {"parameter": axis, "values": values} for axis in ("rows", "columns")}
    found = {"measure": "met", **axes, "means": ones, "met": [[0] * 1000, *ones[1:]], "cases": ones}
    [table] = [
        each
        for each in sweep_summary(make_sweep(maps=[found]).result, {}).sections
        if "Share of cases met" in each.title
    ]
    assert table.basis == "Neighbouring values are shown together; tables/map-met.csv has each of them."
    (_, *labels), (heading, *shares), *_ = shown(table)
    assert (labels[0], heading, shares[0], shares[1]) == ("0 … 41", "0 … 41", "98", "100")


def cases(text, count=3):
    own = {"parameters.rail.friction": "0.1", "reason": text, "braking_distance_m": 465.25}
    rows = [{"id": f"case-{k}", "index": k, "met": k > 1, "outcome": "pass"} | own for k in range(3)]
    return pa.Table.from_pylist(rows).slice(0, count)


@pytest.mark.parametrize("text", ["slip", f"=1+1{HOSTILE}"])
def test_a_sweep_is_published_with_the_rows_of_its_folder_alike_in_every_format(make_sweep, text, tmp_path):
    content = make_sweep((), text)
    pq.write_table(cases(text), content.folder / "summary.parquet")
    (out := tmp_path / "out").mkdir()
    paths = publish(publication_of_sweep(content), ["csv", "html", "md", "xlsx"], out)
    names = [path.relative_to(out).as_posix() for path in paths]
    assert {"summary.csv", "tables/rates.csv", "tables/trends.csv", "index.html", "summary.md"} <= set(names)
    assert_as_csv(out)
    tokens = MarkdownIt("commonmark", {"html": True}).enable("table").parse((out / "summary.md").read_text())
    kinds = {child.type for token in tokens for child in (token.children or [])}
    assert kinds <= {"text", "code_inline", "strong_open", "strong_close", "softbreak"}


def test_a_sweep_without_cases_or_rows_is_published_or_refused_whole(make_sweep, tmp_path, monkeypatch):
    content = make_sweep()
    pq.write_table(cases("x", 0), content.folder / "summary.parquet")
    (tmp_path / "out").mkdir()
    assert publish(publication_of_sweep(content), ["csv", "xlsx"], tmp_path / "out")
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    (content.folder / "summary.parquet").write_bytes(b"PAR1 of a kind")
    with pytest.raises(ValueError, match="Parquet"):
        publication_of_sweep(content)
    (content.folder / "summary.parquet").unlink()
    with pytest.raises(FileNotFoundError):
        publication_of_sweep(content)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["out", "sweep"]
