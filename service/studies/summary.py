"""The statistics of a study, from all of its results in member order."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np

from core.studies.statistics import ColumnStatistics, column_statistics, failure_counts
from service.studies.chunk_files import Chunk
from service.studies.study import Study

LARGEST_COLUMNS = 2**25
"""Numbers that are held at once, of as many figures; for the others the results are read again."""


def summary(study: Study, sent: bytes, chunks: Callable[[], Iterator[Chunk]]) -> dict[str, Any]:
    """Return the statistics that a study's request names, as they are written.

    Parameters
    ----------
    study : Study
    sent : bytes
        Its request.
    chunks : callable
        Yields the results in member order, each time that it is called.
    """
    if study.whole:
        return {"figures": {}}
    request = json.loads(sent)
    settings = {name: request[name] for name in ("probabilities", "bins") if name in request}
    wanted = request.get("statistics")
    if wanted is not None:
        settings["wanted"] = wanted
    named, found = study.plan["figures"], {}
    failures, warnings = Counter[str](), Counter[str]()
    together = max(1, LARGEST_COLUMNS // study.count)
    for first in range(0, len(named), together):
        columns = np.full((len(named[first : first + together]), study.count), np.nan)
        for chunk in chunks():
            columns[:, chunk.start : chunk.stop] = chunk.figures[:, first : first + together].T
            if first == 0:
                failures.update(_counted(chunk.failures, chunk.failure_names))
                warnings.update(_counted(chunk.warnings, chunk.warning_names))
        for figure, column in zip(named[first : first + together], columns, strict=True):
            found[figure["pointer"]] = {"unit": figure["unit"], **_written(column_statistics(column, **settings))}
    answer: dict[str, Any] = {"figures": found}
    if wanted is None or "failures" in wanted:
        answer["failures"], answer["warnings"] = dict(sorted(failures.items())), dict(sorted(warnings.items()))
    return answer


def _counted(codes: np.ndarray[Any, Any], names: tuple[str, ...]) -> Mapping[str, int]:
    counted = Counter[str]()
    for joined, count in failure_counts(codes, names).items():
        # An answer may have several warnings.
        for name in joined.split(","):
            counted[name] += count
    return counted


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
