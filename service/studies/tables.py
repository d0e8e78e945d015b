"""Results as Parquet: a row per member, a row group per stretch of members that was computed at once."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

import numpy as np

from service.responses.npz import Sink
from service.studies.results import Results, values

MEDIA_TYPE = "application/vnd.apache.parquet"


def table(results: Results) -> Iterator[bytes]:
    """Yield all results as a Parquet file; pointers are the names of columns, units are in their metadata.

    Raises
    ------
    ImportError
        Without pyarrow, an optional dependency.
    """
    import pyarrow as pa
    from pyarrow.parquet import ParquetWriter

    about = results.metadata()
    fields = [pa.field("member", pa.int64())]
    for column in (*about["axes"], *about["columns"]):
        plain = column.get("values") is None or _all_numbers(column["values"])
        unit = {} if column["unit"] is None else {"unit": column["unit"]}
        fields.append(pa.field(column["pointer"], pa.float64() if plain else pa.string(), metadata=unit))
    fields += [pa.field("failure", pa.string()), pa.field("warnings", pa.string())]
    schema = pa.schema(fields, metadata={"study": results.study.id, "request": json.dumps(results.request)})
    sink = Sink()
    with pa.PythonFile(sink, mode="w") as file, ParquetWriter(file, schema) as writer:
        for chunk in results.chunks():
            columns: list[Any] = [np.arange(chunk.start, chunk.stop)]
            for k, entry in enumerate(results.request["vary"]):
                listed = values(entry, chunk.inputs[:, k])
                texts = pa.types.is_string(schema.field(1 + k).type)
                columns.append([json.dumps(value) for value in listed] if texts else np.array(listed, dtype=np.float64))
            # Absent figures are null, as in JSON.
            columns += [pa.array(column, from_pandas=True) for column in chunk.figures.T]
            for labels, names in ((chunk.failures, chunk.failure_names), (chunk.warnings, chunk.warning_names)):
                columns.append([names[label - 1] if label else None for label in labels.tolist()])
            arrays = [pa.array(column, type=field.type) for column, field in zip(columns, schema, strict=True)]
            writer.write_table(pa.Table.from_arrays(arrays, schema=schema))
            yield sink.drained()
    yield sink.drained()


def _all_numbers(listed: Any) -> bool:
    return all(type(value) in (int, float) for value in listed)
