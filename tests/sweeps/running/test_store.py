"""The folder of a sweep: its manifest and its chunks."""

import ast
from pathlib import Path

import pyarrow as pa
import pytest

import uictest
from uictest.plans.sweeps import load_sweep
from uictest.running.chunked import (
    CaseSelection,
    ChangedInputsError,
    ChunkStore,
    MissingChunksError,
    sweep_manifest,
)
from uictest.running.chunked.chunk import parquet_bytes
from uictest.running.chunked.store import SOURCES, manifest_differences

PACKAGE = Path(uictest.__file__).parent
WITHOUT_INFLUENCE = {"report"}
"""Rooms that write what was found."""


def manifest(plan):
    return sweep_manifest(CaseSelection(plan), expression=None, overrides=(), seed=None)


def test_a_sweep_has_one_manifest_from_every_working_folder(load, monkeypatch):
    here = manifest(load())
    Path("below").mkdir()
    for folder, file in (("below", "../study.sweep.yaml"), ("/", str(Path("study.sweep.yaml").absolute()))):
        monkeypatch.chdir(folder)
        there = manifest(load_sweep(Path(file)))
        assert list(manifest_differences(here, there)) == []
        assert {**there, "file": here["file"]} == here
        monkeypatch.chdir(Path(file).absolute().parent)


def test_a_comment_in_the_sweep_file_changes_no_case(load):
    def of(text):
        Path("again.sweep.yaml").write_text(f"{Path('study.sweep.yaml').read_text()}{text}")
        return manifest(load_sweep(Path("again.sweep.yaml")))

    load("sample: {size: 8, parameters: {rail.friction: {uniform: [0.1, 0.2]}}}\n")
    plain, explained = of(""), of("# drawn alike\n")
    assert plain["inputs"] != explained["inputs"]
    assert list(manifest_differences(plain, explained)) == []
    Path("study.sweep.yaml").write_text(Path("study.sweep.yaml").read_text().replace("0.2]", "0.21]"))
    assert list(manifest_differences(plain, of(""))) == ["the cases that the sweep file asks for"]


LEFT_RIGHT = {"left/a.csv": "1", "right/a.csv": "2"}
EXCHANGED = {"left/a.csv": "2", "right/a.csv": "1"}


@pytest.mark.parametrize(
    ("name", "one", "other", "message"),
    [
        ("cases", 10, 16, "cases: 10 before, 16 now"),
        ("cases_in_a_part", 16, 32, "cases per chunk: 16 before, 32 now"),
        ("seed", None, 7, "seed: none before, 7 now"),
        ("selected", "wet and cold", None, "selection: wet and cold before, none now"),
        ("set", [], ["a=1", "b=2"], "set: none before, a=1 and b=2 now"),
        ("parameters", ["a", "b", "c"], ["d"], "parameters: a, b and c before, d now"),
        ("versions", {"numpy": "1", "scipy": "1"}, {"numpy": "2", "scipy": "1"}, "versions: numpy"),
        ("program", "1", "2", "the program itself"),
        ("inputs", LEFT_RIGHT, EXCHANGED, "inputs: left/a.csv, right/a.csv"),
    ],
)
def test_differences_are_named_as_users_know_them(name, one, other, message):
    assert list(manifest_differences({name: one}, {name: other})) == [message]


def imported_rooms(path):
    """Return the rooms and modules of the top level that a module imports."""
    rooms = set()
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module == "uictest":
            rooms |= {alias.name for alias in node.names if alias.name != "__version__"}
        elif isinstance(node, ast.ImportFrom) and (node.module or "").startswith("uictest."):
            rooms.add(str(node.module).split(".")[1])
    return rooms


def test_the_digest_of_the_program_covers_what_its_sources_import():
    modules = [path for name in SOURCES for path in (PACKAGE / name).rglob("*.py")]
    imported = set().union(*map(imported_rooms, modules))
    assert imported <= {*SOURCES} | WITHOUT_INFLUENCE


MANIFEST = {"schema": "x", "cases": 3, "inputs": {"a.yaml": "1", "b.yaml": "2"}, "program": "p"}


@pytest.fixture
def store(tmp_path):
    """A store with two chunks."""
    store = ChunkStore(tmp_path / "study")
    store.open(MANIFEST, restart=False)
    for number in (0, 2):
        store.write(number, parquet_bytes(pa.table({"index": [number]})))
    return store


def chunk(store, number):
    return next((store.folder / "chunks").glob(f"{number:06d}-*"))


def test_what_is_finished_is_found_again_and_a_missing_chunk_is_reported(store):
    again = ChunkStore(store.folder)
    again.open(MANIFEST, restart=False)
    assert again.finished() == ({0, 2}, [])
    assert [table.column("index").to_pylist() for table in again.tables([2, 0])] == [[2], [0]]
    with pytest.raises(MissingChunksError, match="1 chunks are missing: 1"):
        list(store.tables([0, 1]))


@pytest.mark.parametrize("damage", [lambda b: b[:-1], lambda b: b"", lambda b: bytes([b[0] ^ 1]) + b[1:]])
def test_a_damaged_chunk_is_found_and_removed(store, damage):
    path = chunk(store, 2)
    path.write_bytes(damage(path.read_bytes()))
    assert store.finished() == ({0}, [path])
    assert not path.exists()


def test_changed_inputs_are_rejected_by_name(store):
    changed = {**MANIFEST, "inputs": {"a.yaml": "1", "b.yaml": "3"}, "program": "q"}
    with pytest.raises(ChangedInputsError, match=r"^inputs: b\.yaml; the program itself$"):
        store.open(changed, restart=False)
    assert store.finished()[0] == {0, 2}
    store.open(changed, restart=True)
    assert store.finished()[0] == set()
    assert store.manifest() == changed


def test_chunks_of_another_schema_are_rejected_by_it(store):
    new = {**MANIFEST, "schema": "uictest/manifest/2", "kind": "sweep"}
    store.open({**MANIFEST, "schema": "uictest/sweep-manifest/1"}, restart=True)
    store.write(0, b"chunk")
    said = "schema 'uictest/sweep-manifest/1', written by uictest 0.2 or older: run it again"
    with pytest.raises(ChangedInputsError, match=f"^{said}$"):
        store.open(new, restart=False)


def test_a_comment_in_the_sweep_file_changes_the_manifest_and_keeps_the_chunks(tmp_path):
    study = ChunkStore(tmp_path / "study")
    before = {"file": "a/b.sweep.yaml", "cases_sha256": "c", "inputs": {"b.sweep.yaml": "1", "x.yaml": "2"}}
    study.open(before, restart=False)
    study.write(0, b"chunk")
    after = {**before, "inputs": {"b.sweep.yaml": "9", "x.yaml": "2"}}
    study.open(after, restart=False)
    assert (study.has_chunks(), study.manifest()) == (True, after)
    with pytest.raises(ChangedInputsError, match=r"^inputs: x\.yaml$"):
        study.open({**before, "inputs": {"b.sweep.yaml": "1", "x.yaml": "3"}}, restart=False)


def test_inputs_may_change_before_the_first_chunk(tmp_path):
    store = ChunkStore(tmp_path / "study")
    store.open(MANIFEST, restart=False)
    store.open({**MANIFEST, "seed": 7}, restart=False)
    assert store.manifest() == {**MANIFEST, "seed": 7}


def test_shards_are_merged_and_damaged_chunks_skipped(store, tmp_path):
    whole = ChunkStore(tmp_path / "whole")
    whole.open(MANIFEST, restart=False)
    damaged = chunk(store, 0)
    damaged.write_bytes(b"")
    assert whole.merge(store) == (1, [damaged])
    assert whole.finished() == ({2}, [])
    other = ChunkStore(tmp_path / "other")
    other.open({**MANIFEST, "cases": 4}, restart=False)
    with pytest.raises(ChangedInputsError, match="cases: 3 in this sweep, 4 in the shard"):
        whole.merge(other)


def test_the_name_of_the_sweep_file_is_no_difference(store, tmp_path):
    elsewhere = ChunkStore(tmp_path / "elsewhere")
    elsewhere.open({**MANIFEST, "file": "../study.sweep.yaml"}, restart=False)
    assert elsewhere.merge(store) == (2, [])
    store.open({**MANIFEST, "file": "study.sweep.yaml"}, restart=False)
    assert store.finished()[0] == {0, 2}


def test_manifests_that_are_none_are_not_trusted_and_partial_files_removed(store):
    (store.folder / "chunks" / ".uictest-0123456789abcdef.partial").touch()
    store.remove_partial_files()
    assert len(list((store.folder / "chunks").iterdir())) == 2
    (store.folder / "manifest.json").write_text("{")
    store.open(MANIFEST, restart=False)
    assert store.finished()[0] == set()
    (store.folder / "manifest.json").write_text("[" * 100_000)
    assert store.manifest() is None
