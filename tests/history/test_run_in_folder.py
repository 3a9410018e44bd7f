import json
import os
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path

import pytest

from uictest.runs.history import ENTRY, ListedRun, Unlisted, read_folder
from uictest.runs.history.run_in_folder import started_in

from .conftest import Publish, case

SWEEP = {"schema": "uictest/result/2", "kind": "sweep", "name": "study", "cases": 3, "met": 2}


def sweep(folder: Path, **changes: object) -> Path:
    folder.mkdir(parents=True)
    manifest: dict[str, object] = {"schema": "uictest/manifest/2", "kind": "sweep", "sweep": "study"}
    manifest |= {"file": "study.sweep.yaml", "cases": 3}
    (folder / "manifest.json").write_text(json.dumps(manifest))
    document = SWEEP | {"outcomes": {"pass": 2, "fail": 1}} | changes
    (folder / "sweep.json").write_text(json.dumps(document))
    return folder


def run_of(found: ListedRun | Unlisted) -> ListedRun:
    assert isinstance(found, ListedRun), found
    return found


def reason_of(found: ListedRun | Unlisted) -> str:
    assert isinstance(found, Unlisted), found
    return found.reason


def test_a_run_is_read_with_its_manifest_and_its_counts(publish: Publish) -> None:
    run = run_of(read_folder(publish(case("a"), case("b", "fail"), command=("run", "a b.yaml"))))
    assert (run.kind, run.command[1:], run.counts, run.not_met) == (
        "run",
        ("run", "a b.yaml"),
        {"pass": 1, "fail": 1},
        1,
    )
    assert run.page == f"{run.name}/index.html"
    assert [each.id for each in run.cases] == ["a", "b"]


def test_a_renamed_run_keeps_its_start(publish: Publish, reports: Path) -> None:
    folder = publish()
    started = run_of(read_folder(folder)).started
    os.utime(folder / "results.json", (0, 0))
    renamed = folder.rename(reports / "accepted")
    assert run_of(read_folder(renamed)).started == started == started_in(folder.name)


def test_a_run_of_recordings_is_told_apart(publish: Publish) -> None:
    assert run_of(read_folder(publish(command=("evaluate", "stop.csv")))).kind == "evaluate"


def test_a_run_of_an_earlier_version_is_read_from_its_results(publish: Publish) -> None:
    folder = publish(case("a"), case("b", "fail"))
    with_entry = run_of(read_folder(folder))
    (folder / ENTRY).unlink()
    without = run_of(read_folder(folder))
    assert (without.counts, without.cases) == (with_entry.counts, with_entry.cases)
    assert abs((without.started - with_entry.started).total_seconds()) <= 1.0


def test_without_a_page_there_is_nothing_to_open(publish: Publish) -> None:
    assert run_of(read_folder(publish(formats=()))).page == ""


def test_a_sweep_is_read_with_its_counts(tmp_path: Path) -> None:
    run = run_of(read_folder(sweep(tmp_path / "study")))
    assert (run.kind, run.counts, run.not_met) == ("sweep", {"pass": 2, "fail": 1}, 1)


def test_a_sweep_without_a_result_is_not_finished(tmp_path: Path) -> None:
    folder = sweep(tmp_path / "study")
    (folder / "sweep.json").unlink()
    assert "not finished" in reason_of(read_folder(folder))


def test_the_result_of_an_earlier_sweep_of_the_folder_does_not_count(tmp_path: Path) -> None:
    assert "earlier run" in reason_of(read_folder(sweep(tmp_path / "study", cases=4)))


@pytest.mark.parametrize("changes", [{"outcomes": 3}, {"met": "all"}, {"schema": "x"}, {"cases": True}])
def test_a_damaged_sweep_is_said_to_be_damaged(tmp_path: Path, changes: dict[str, object]) -> None:
    assert "sweep.json is damaged" in reason_of(read_folder(sweep(tmp_path / "study", **changes)))


@pytest.mark.parametrize(
    ("file", "schema", "kind"),
    [
        ("fit.json", "uictest/fit/1", "fit"),
        ("validation.json", "uictest/validation-result/1", "validation"),
        ("studies.json", "uictest/studies/1", "studies"),
    ],
)
def test_what_other_commands_write_is_listed(tmp_path: Path, file: str, schema: str, kind: str) -> None:
    (tmp_path / file).write_text(json.dumps({"schema": schema}))
    run = run_of(read_folder(tmp_path))
    assert (run.kind, run.page) == (kind, f"{tmp_path.name}/{file}")


OTHERS_MANIFEST = '{"name": "my web app", "icons": []}'
DAMAGED_MANIFEST = '{"schema": "uictest/manifest/1", "command": 3}'


def _make_a_pipe(file: Path) -> None:
    file.unlink()
    os.mkfifo(file)


def _make_a_folder(file: Path) -> None:
    file.unlink()
    file.mkdir()


def _let_it_lead_nowhere(file: Path) -> None:
    file.unlink()
    file.symlink_to("gone")


@pytest.mark.parametrize(
    ("file", "damage", "reason"),
    [
        ("results.json", Path.unlink, "there is no results.json"),
        ("results.json", "{", "results.json is not what the run wrote: 1 bytes, expected"),
        ("manifest.json", _make_a_pipe, "manifest.json is no file"),
        ("manifest.json", _make_a_folder, "manifest.json is no file"),
        ("manifest.json", _let_it_lead_nowhere, "manifest.json is no file"),
        ("manifest.json", "[" * 100_000, "manifest.json is damaged"),
        ("manifest.json", "[]", "manifest.json is damaged: expected an object"),
        ("manifest.json", OTHERS_MANIFEST, "not of uictest: manifest.json has no schema"),
        ("manifest.json", DAMAGED_MANIFEST, "manifest.json is damaged"),
        (ENTRY, "{}", "index-entry.json is damaged"),
        ("manifest.json", lambda file: os.truncate(file, 1 << 40), "manifest.json of 1048576 MB is not read"),
    ],
)
def test_a_damaged_folder_is_no_run_and_the_reason_is_given(
    publish: Publish, file: str, damage: str | Callable[[Path], None], reason: str
) -> None:
    folder = publish()
    if isinstance(damage, str):
        (folder / file).write_text(damage)
    else:
        damage(folder / file)
    assert reason in reason_of(read_folder(folder))


def test_damaged_results_of_an_earlier_version_are_damaged(publish: Publish) -> None:
    folder = publish()
    (folder / ENTRY).unlink()
    (folder / "results.json").write_text("{")
    assert reason_of(read_folder(folder)).startswith("damaged: ")
    _make_a_pipe(folder / "results.json")
    assert "results.json is no file" in reason_of(read_folder(folder))


def test_an_empty_folder_is_not_of_uictest(tmp_path: Path) -> None:
    assert reason_of(read_folder(tmp_path)) == "not of uictest: there is no manifest.json"


def test_a_link_is_no_run_of_its_own(publish: Publish, reports: Path) -> None:
    run = publish()
    (reports / "accepted").symlink_to(run.name)
    assert reason_of(read_folder(reports / "accepted")) == f"a link to {run.name}"


@pytest.mark.parametrize(
    ("name", "started"),
    [
        ("20261122T154928Z-b5ea0345", datetime(2026, 11, 22, 15, 49, 28, tzinfo=UTC)),
        ("validation-20261122T154928Z-b5ea0345-2", datetime(2026, 11, 22, 15, 49, 28, tzinfo=UTC)),
        ("20269922T154928Z-b5ea0345", None),
        ("study", None),
    ],
)
def test_the_name_of_a_run_states_its_start(name: str, started: datetime | None) -> None:
    assert started_in(name) == started
