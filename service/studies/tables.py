"""Results as Parquet: a row per member, a row group per stretch of members that was computed at once."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

from service.studies.parquet import Column, Kind, ParquetFile
from service.studies.results import Results, values

MEDIA_TYPE = "application/vnd.apache.parquet"


def table(results: Results) -> Iterator[bytes]:
    """Yield all results as a Parquet file; pointers are the names of columns, units are in its metadata."""
    about = results.metadata()
    described = (*about["axes"], *about["columns"])
    inputs = [Column(axis["pointer"], _kind(axis["values"])) for axis in about["axes"]]
    figures = [Column(column["pointer"], Kind.DOUBLE, optional=True) for column in about["columns"]]
    labels = [Column(name, Kind.TEXT, optional=True) for name in ("failure", "warnings")]
    metadata = {
        "study": results.study.id,
        "request": json.dumps(results.request),
        "units": json.dumps({column["pointer"]: column["unit"] for column in described if column["unit"] is not None}),
    }
    file = ParquetFile([Column("member", Kind.INTEGER), *inputs, *figures, *labels], metadata)
    yield file.head
    for chunk in results.chunks():
        columns: list[Any] = [range(chunk.start, chunk.stop)]
        for k, (entry, column) in enumerate(zip(results.request["vary"], inputs, strict=True)):
            listed = values(entry, chunk.inputs[:, k])
            columns.append([json.dumps(value) for value in listed] if column.kind is Kind.TEXT else listed)
        # Absent figures are null, as in JSON.
        columns += list(chunk.figures.T)
        for numbers, names in ((chunk.failures, chunk.failure_names), (chunk.warnings, chunk.warning_names)):
            columns.append([names[number - 1] if number else None for number in numbers.tolist()])
        yield file.group(chunk.stop - chunk.start, columns)
    yield file.foot()


def _kind(listed: Any) -> Kind:
    """Return the type of a varied input's column: texts where some of its values are no numbers."""
    numbers = listed is None or all(type(value) in (int, float) for value in listed)
    return Kind.DOUBLE if numbers else Kind.TEXT
