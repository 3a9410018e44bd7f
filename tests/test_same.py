"""`scripts/same_outputs.py` and `same_results.py`: what varies is replaced, and what moved is named."""

import hashlib
import importlib
import math
import os
import zipfile
from pathlib import Path

import pandas as pd
import pytest
import yaml

REPOSITORY = Path(__file__).parents[1]


@pytest.fixture(autouse=True)
def scripts_on_path(monkeypatch):
    monkeypatch.syspath_prepend(REPOSITORY / "scripts")


@pytest.fixture
def contents():
    return importlib.import_module("output_contents")


@pytest.fixture
def outputs():
    return importlib.import_module("same_outputs")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("reports/20261123T171251Z-8bbe9c46/index.html", "reports/<time>-8bbe9c46/index.html"),
        ("2026-11-23 17:12:51 UTC, 1 case", "<time>, 1 case"),
        ("uictest: 1 case: 1 pass in 0.4 s; reports", "uictest: 1 case: 1 pass in <duration>; reports"),
        ('name="dry-120" time="0.076" />', 'name="dry-120" time="<duration>" />'),
        ("   0.119 s  dry-120", "<duration>  dry-120"),
        ("uictest: 12 of 64 cases after 30 s\nnext\n", "next\n"),
        ("in-time     pass     0.429   100   % of", "in-time     pass     <duration>  100   % of"),
        ('"version": "uictest 0.2.0"', '"version": "uictest <version>"'),
        ('"version": "uictest 0.3.0.dev0"', '"version": "uictest <version>"'),
        ('"program": "0123456789abcdef"', '"program": "<digest>"'),
        (f"{REPOSITORY}/src/uictest", "<path>/src/uictest"),
    ],
)
def test_replaces_what_cannot_be_the_same_twice(contents, text, expected):
    assert contents.steady(text) == expected


@pytest.mark.parametrize(
    "text",
    [
        "braking_distance_m=472.21 braking_time_s=27.851",
        "standstill in 27 s; 0.119 s of it sliding; trigger: at 0 s",
        '"library:rails/dry.yaml": "0a341ce09f1b47b609d76d5786b7b629f446e0ba5f8b2204f34133ac8d40a2fa"',
        '"vehicle/8907a746c820": "intercity-180", "numpy": "2.4.6"',
        "lost-sensor  pass  0.429  10  s",
        "schema: uictest/result/1, date 2026-05-31",
        'fill="#d55e00" width="20261123"',
    ],
)
def test_replaces_nothing_else(contents, text):
    assert contents.steady(text) == text


def test_a_digest_in_a_list_counts_as_right_or_wrong(contents, tmp_path):
    (tmp_path / "a.csv").write_text("1\n")
    digest = hashlib.sha256(b"1\n").hexdigest()
    (tmp_path / "SHA256SUMS").write_text(f"# Files\n{digest}  a.csv\n{digest[::-1]}  a.csv\n")
    assert contents.content(tmp_path / "SHA256SUMS") == "# Files\nright  a.csv\nwrong  a.csv"


def test_an_archive_is_compared_by_its_members(outputs, tmp_path):
    def archive(name, text, day):
        with zipfile.ZipFile(tmp_path / name, "w") as file:
            file.writestr(zipfile.ZipInfo("a.txt", (2026, 1, day, 0, 0, 0)), text)
        return tmp_path / name

    first = archive("1.zip", "same", 1)
    assert outputs.difference(first, archive("2.zip", "same", 2)) == []
    assert outputs.difference(first, archive("3.zip", "other", 1)) == [" member a.txt", "-same", "+other"]


def test_a_difference_far_down_a_long_line_is_shown(outputs, tmp_path):
    one, other = tmp_path / "one.html", tmp_path / "other.html"
    one.write_text("x" * 3_000_000 + "<p>colour</p>")
    other.write_text("x" * 3_000_000 + "<p>color</p>")
    assert [line for line in outputs.difference(one, other) if "color" in line]


def test_counts_what_differs_and_what_is_missing(outputs, tmp_path, capsys):
    for side, text in (("one", "12"), ("other", "13")):
        (tmp_path / side / "texts").mkdir(parents=True)
        (tmp_path / side / "texts/01").write_text(f"$ uictest\n{text}\n")
        (tmp_path / side / f"{side}.csv").write_text("")
    assert outputs.compared("group", tmp_path / "one", tmp_path / "other", {}) == (1, 1, 3)
    assert "group/texts/01 $ uictest\n $ uictest\n-12\n+13\n" in capsys.readouterr().out


def test_every_group_of_commands_can_be_run(outputs):
    groups = yaml.safe_load(outputs.COMMANDS.read_text("utf-8"))
    for name, group in groups.items():
        assert group.keys() <= {"files", "commands", "compilers", "on_request"}, name
        assert group["commands"].splitlines(), name
        assert all(os.sep not in file for file in group.get("files", {})), name


DISTANCE = 843.2029680025092


@pytest.fixture
def results():
    return importlib.import_module("same_results")


def record(distance, status="pass"):
    return f"status={status} distance={distance.hex()}"


def test_what_moved_is_named_and_so_is_what_is_gone_or_new(results):
    moved = math.nextafter(DISTANCE, math.inf)
    [line] = results.difference("run slip-120", record(DISTANCE), record(moved))
    assert line == f"run slip-120: distance 843.2029680025092 -> {moved!r}"
    turned, gone = results.difference("fit slip-120", record(DISTANCE), "status=fail")
    assert turned == "fit slip-120: status pass -> fail"
    assert gone == "fit slip-120: distance 843.2029680025092 -> missing"
    assert results.difference("run a train", "", None) == ["run a train: missing"]
    assert results.difference("run a train", None, "") == ["run a train: new"]


def test_numbers_of_a_solver_are_compared_to_a_millionth_but_no_counts(results):
    assert results.difference("fit slip-120", record(DISTANCE), record(DISTANCE * (1 + 9e-7))) == []
    assert results.difference("fit slip-120", record(DISTANCE), record(DISTANCE * (1 + 2e-6)))
    assert results.difference("bench random", record(DISTANCE), record(DISTANCE * (1 + 9e-7)))
    assert results.difference("fit slip-120", "windows=1000000", "windows=1000001")


def test_sentences_and_versions_of_a_sweep_do_not_count_and_numbers_and_outcomes_do(results):
    columns = {"outcome": ["pass"], "braking_distance_m": [DISTANCE], "reason": ["too long"], "met": [True]}
    kept = dict(results.column_records("s", pd.DataFrame({**columns, "controller_version": ["1.0"]})))
    assert kept.keys() == {"s column outcome", "s column braking_distance_m", "s column met"}
    columns["outcome"] = ["fail"]
    assert dict(results.column_records("s", pd.DataFrame(columns))) != kept


@pytest.fixture
def one_number(results, monkeypatch, tmp_path):
    """Two groups of one number each, kept as 1.0; set what they are found to be now."""
    now = {"a": 1.0, "b": 1.0}
    groups = {name: lambda name=name: iter([("stop", {"distance": now[name]})]) for name in now}
    monkeypatch.setattr(results, "GROUPS", groups)
    monkeypatch.setattr(results, "KEPT", tmp_path / "kept.txt")
    assert results.main(["--accept"]) == 0
    return now


def test_what_moved_is_printed_and_accepting_one_group_leaves_the_others(results, one_number, capsys):
    assert results.main([]) == 0
    one_number["b"] = 2.0
    capsys.readouterr()
    assert results.main([]) == 1
    assert capsys.readouterr().out.splitlines() == [
        "b stop: distance 1.0 -> 2.0",
        "2 records, differences: 1",
    ]
    one_number |= {"a": 3.0, "b": 3.0}
    assert results.main(["-k", "a", "--accept"]) == 0
    assert results.KEPT.read_text() == f"a stop: distance={(3.0).hex()}\nb stop: distance={(1.0).hex()}\n"


def test_every_group_has_kept_records_and_no_other(results):
    kept = {line.partition(" ")[0] for line in results.KEPT.read_text("utf-8").splitlines()}
    assert kept == results.GROUPS.keys()


@pytest.mark.slow
def test_the_results_over_the_shipped_files_are_those_kept(results, capsys):
    code = results.main([])
    assert code == 0, capsys.readouterr().out
