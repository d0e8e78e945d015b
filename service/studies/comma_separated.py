"""Results as comma-separated values (RFC 4180): a row per member."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterator

from service.studies.results import Results, values

MEDIA_TYPE = "text/csv"


def rows(results: Results) -> Iterator[bytes]:
    """Yield all results; pointers are the names of columns, absent figures are empty, words and lists are JSON."""
    sink = io.StringIO()
    writer = csv.writer(sink)
    varied, figures = results.request["vary"], results.study.plan["figures"]
    writer.writerow(["member", *(entry["pointer"] for entry in (*varied, *figures)), "failure", "warnings"])
    for chunk in results.chunks():
        inputs = [values(entry, chunk.inputs[:, k]) for k, entry in enumerate(varied)]
        labels = (chunk.failures, chunk.failure_names), (chunk.warnings, chunk.warning_names)
        columns = [
            range(chunk.start, chunk.stop),
            *([value if type(value) in (int, float) else json.dumps(value) for value in column] for column in inputs),
            *([None if x != x else x for x in column] for column in chunk.figures.T.tolist()),
            *([names[label - 1] if label else None for label in column.tolist()] for column, names in labels),
        ]
        writer.writerows(zip(*columns, strict=True))
        yield sink.getvalue().encode()
        sink.seek(0)
        sink.truncate()
