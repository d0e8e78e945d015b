"""Parquet files, read by pyarrow and by DuckDB, whose reader is another."""

from __future__ import annotations

import io
from collections.abc import Sequence
from math import inf, isnan, nan, pi
from pathlib import Path
from typing import Any

import duckdb
import numpy as np
import pyarrow as pa
import pytest
from pyarrow import parquet

from service.studies.parquet import Column, Kind, ParquetFile


def written(columns: list[Column], *groups: Sequence[Sequence[Any]], about: dict[str, str] | None = None) -> io.BytesIO:
    file = ParquetFile(columns, about or {})
    pieces = [file.head, *(file.group(len(group[0]), group) for group in groups), file.foot()]
    return io.BytesIO(b"".join(pieces))


MIXED = [
    Column("member", Kind.INTEGER),
    Column("/a~1b", Kind.DOUBLE),
    Column("figure", Kind.DOUBLE, optional=True),
    Column("wörds", Kind.TEXT),
    Column("failure", Kind.TEXT, optional=True),
]


def test_values_of_every_kind_are_read_back() -> None:
    first: list[list[Any]] = [
        [0, 1, 2**40],
        [-0.0, 5e-324, 1.7976931348623157e308],
        [nan, pi, -inf],
        ['"x"', "", "½ µ"],
        [None, "why", None],
    ]
    second: list[list[Any]] = [[-1], [0.1], [0.5], ["[1, 2]"], [""]]
    about = {"request": "{}", "empty": ""}
    found = parquet.read_table(written(MIXED, first, second, about=about))
    assert [(field.name, field.type, field.nullable) for field in found.schema] == [
        ("member", pa.int64(), False),
        ("/a~1b", pa.float64(), False),
        ("figure", pa.float64(), True),
        ("wörds", pa.string(), False),
        ("failure", pa.string(), True),
    ]
    expected = [a + b for a, b in zip(first, second, strict=True)]
    expected[2][0] = None
    assert [column.to_pylist() for column in found.columns] == expected
    assert np.signbit(found["/a~1b"][0].as_py())
    assert {key.decode(): value.decode() for key, value in found.schema.metadata.items()} == about


@pytest.mark.parametrize("rows", [0, 1, 7, 8, 9, 1000])
@pytest.mark.parametrize("wide", [1, 14, 15, 200])
def test_absent_values_of_any_number_of_rows_and_columns(rows: int, wide: int) -> None:
    chance = np.random.default_rng(rows + wide)
    numbers = np.where(chance.random((wide, rows)) < 0.3, nan, chance.normal(size=(wide, rows)))
    columns = [Column(f"c{k}", Kind.DOUBLE, optional=True) for k in range(wide)]
    found = parquet.read_table(written(columns, list(numbers)))
    assert [column.null_count for column in found.columns] == np.isnan(numbers).sum(axis=1).tolist()
    read = np.array([column.to_numpy() for column in found.columns]).reshape(wide, rows)
    assert np.array_equal(read, numbers, equal_nan=True)


def test_sizes_and_places_are_those_of_the_pages() -> None:
    """Readers that fetch single columns go by these."""
    file = written(MIXED, *[[[k], [0.5 * k], [nan], ["x"], [None]] for k in range(20)])
    about = parquet.ParquetFile(file).metadata
    assert (about.num_rows, about.num_row_groups) == (20, 20)
    place = 4
    for group in map(about.row_group, range(20)):
        for column in map(group.column, range(5)):
            assert column.data_page_offset == place
            place += column.total_compressed_size
        assert group.total_byte_size == sum(group.column(k).total_uncompressed_size for k in range(5))
    alone = parquet.ParquetFile(file).read_row_group(17, columns=["/a~1b"])
    assert alone.to_pydict() == {"/a~1b": [8.5]}


def test_infinite_and_absent_numbers_differ() -> None:
    column = [Column("x", Kind.DOUBLE)]
    (value,) = parquet.read_table(written(column, [[nan]]))["x"].to_pylist()
    assert isnan(value)


def test_another_reader_finds_the_same(tmp_path: Path) -> None:
    numbers = np.random.default_rng(3).normal(size=3000)
    numbers[::7] = nan
    texts = [None if k % 5 else f"text {k}" for k in range(3000)]
    columns = [
        Column("member", Kind.INTEGER),
        Column("x", Kind.DOUBLE, optional=True),
        Column("why", Kind.TEXT, optional=True),
    ]
    file = tmp_path / "rows.parquet"
    groups = [[range(k, k + 1000), numbers[k : k + 1000], texts[k : k + 1000]] for k in (0, 1000, 2000)]
    file.write_bytes(written(columns, *groups, about={"units": "{}"}).getvalue())
    with duckdb.connect() as connection:
        rows = connection.execute(f"select * from '{file}' order by member").fetchall()
        about = connection.execute(f"select key, value from parquet_kv_metadata('{file}')").fetchall()
    expected = [None if isnan(x) else x for x in numbers.tolist()]
    assert rows == list(zip(range(3000), expected, texts, strict=True))
    assert about == [(b"units", b"{}")]
