"""CSV: exact numbers, empty cells for missing ones, no formulas, whatever the texts."""

import csv
import io

import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import given, strategies as st

from uictest.core.document import table_of
from uictest.report.formats.csv import ParquetRows, csv_text
from uictest.report.words import csv_cell

from .made_up import ANY_TEXT, TABLE, TEXTS, table_of_texts


def read(table):
    return list(csv.DictReader(io.StringIO(csv_text(table))))


def test_a_cell_is_exact_and_empty_where_there_is_nothing():
    assert csv_text(TABLE) == (
        "id,braking_distance_m,share,vents,met,why,never\n"
        "slide-80[friction=0.10],465.254,0.30000000000000004,7,true,,\n"
        "wet-80,,0.30000000000000004,0,false,wheelset 2 stands,\n"
        "dry-120,,0.30000000000000004,12,true,,\n"
    )


CELLS = st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | ANY_TEXT


@given(st.lists(st.dictionaries(st.sampled_from(["a", "=b", "c d"]), CELLS), max_size=5))
def test_what_is_read_back_is_what_programs_see(rows):
    table = table_of("t", rows, ["a"])
    columns = {csv_cell(column.key): column.key for column in table.for_programs}
    back = read(table)
    assert len(back) == len(rows)
    for found, record in zip(back, table.records, strict=True):
        for heading, key in columns.items():
            text, value = found[heading], record[key]
            if isinstance(value, bool) or value is None:
                assert text == {True: "true", False: "false", None: ""}[value]
            else:
                assert text == csv_cell(value) if isinstance(value, str) else type(value)(text) == value


@pytest.mark.parametrize("text", TEXTS)
def test_no_text_is_a_formula_or_leaves_its_cell(text):
    (row,) = read(table_of_texts([text]))
    assert row["text"] == row["name"] == csv_cell(text)
    assert row["text"].isprintable()


@pytest.mark.parametrize("count", [0, 3, 2500])
def test_rows_of_a_parquet_file_are_counted_read_in_order_and_written_alike(tmp_path, count):
    path = tmp_path / "summary.parquet"
    rows = [
        {"id": f"=case-{k}", "index": k, "met": k > 1, "margin": None if k % 2 else 0.1 * k}
        for k in range(count)
    ]
    schema = pa.schema({"id": pa.string(), "index": pa.int64(), "met": pa.bool_(), "margin": pa.float64()})
    pq.write_table(pa.Table.from_pylist(rows, schema), path)
    table = ParquetRows(path).table("summary")
    assert (len(table.rows), table.file, table.more) == (count, "summary.csv", "summary.parquet")
    assert list(table.records) == rows
    back = read(table)
    assert [row["id"] for row in back] == [f"'=case-{k}" for k in range(count)]
    assert [row["margin"] and float(row["margin"]) for row in back] == [
        "" if row["margin"] is None else row["margin"] for row in rows
    ]


def test_a_damaged_file_has_no_rows(tmp_path):
    (tmp_path / "summary.parquet").write_bytes(b"PAR1 of a kind")
    with pytest.raises(ValueError, match="Parquet"):
        ParquetRows(tmp_path / "summary.parquet").table("summary")
