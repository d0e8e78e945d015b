"""The statistics of a study, from all of its results in member order."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from core.studies.statistics import ColumnStatistics, column_statistics, failure_counts
from service.studies.chunk_files import Chunk
from service.studies.store import Study


def summary(study: Study, chunks: Sequence[Chunk]) -> dict[str, Any]:
    """Return the statistics that a study's request names, as they are written."""
    request = json.loads(study.request)
    settings = {name: request[name] for name in ("probabilities", "bins") if name in request}
    wanted = request.get("statistics")
    figures = {}
    for k, figure in enumerate(study.plan["figures"]):
        column = np.concatenate([chunk.figures[:, k] for chunk in chunks])
        found = column_statistics(column, **({} if wanted is None else {"wanted": wanted}), **settings)
        figures[figure["pointer"]] = {"unit": figure["unit"], **_written(found)}
    answer: dict[str, Any] = {"figures": figures}
    if wanted is None or "failures" in wanted:
        answer["failures"] = _counted((chunk.failures, chunk.failure_names) for chunk in chunks)
        answer["warnings"] = _counted((chunk.warnings, chunk.warning_names) for chunk in chunks)
    return answer


def _counted(labels: Any) -> Mapping[str, int]:
    total = Counter[str]()
    for codes, names in labels:
        for joined, count in failure_counts(codes, names).items():
            # An answer may have several warnings.
            for name in joined.split(","):
                total[name] += count
    return dict(sorted(total.items()))


def _written(found: ColumnStatistics) -> dict[str, Any]:
    entries = found._asdict()
    if found.quantiles is not None:
        entries["quantiles"] = [entry._asdict() for entry in found.quantiles]
    for name in ("min", "max"):
        extreme = getattr(found, name)
        entries[name] = None if extreme is None else extreme._asdict()
    if found.histogram is not None:
        histogram = found.histogram
        entries["histogram"] = {"edges": histogram.edges.tolist(), "counts": histogram.counts.tolist()}
    return entries
