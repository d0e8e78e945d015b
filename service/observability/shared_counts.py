"""The sum of the counts of several server processes, given by each of them.

Each process writes its counts to a file of its own in one directory, once a second and by replacing the file, and reads
the others' files for GET /metrics. Nothing is mapped into memory: on a full disk the previous file stays, and the
others' counts are as old as that.
"""

from __future__ import annotations

import contextlib
import os
import pickle
import tempfile
from collections.abc import Iterable, Iterator
from pathlib import Path
from shutil import rmtree

from prometheus_client import CollectorRegistry
from prometheus_client.metrics_core import Metric
from prometheus_client.registry import Collector
from prometheus_client.samples import Sample

from service.observability.logs import LOG

DIRECTORY = "POLHODE_COUNTS"
"""Environment variable by which server processes find the directory."""


@contextlib.contextmanager
def sharing() -> Iterator[None]:
    """Let the server processes that are started meanwhile share their counts, if a directory can be made for them."""
    try:
        directory = tempfile.mkdtemp(prefix="polhode-counts-")
    except OSError as fault:
        LOG.warning("the server processes count each for itself: no directory can be made", extra={"fault": str(fault)})
        yield
        return
    os.environ[DIRECTORY] = directory
    try:
        yield
    finally:
        del os.environ[DIRECTORY]
        rmtree(directory, ignore_errors=True)


class SharedCounts(Collector):
    """The sums of this process's metrics, in the registry `own`, and of all others'."""

    def __init__(self, own: CollectorRegistry, directory: Path) -> None:
        self._own, self._file = own, directory / str(os.getpid())

    def publish(self) -> None:
        """Write the counts of this process, unless the disk is full."""
        whole = self._file.with_suffix(".new")
        try:
            whole.write_bytes(pickle.dumps(list(self._own.collect())))
            whole.replace(self._file)
        except OSError:
            with contextlib.suppress(OSError):
                whole.unlink()

    def collect(self) -> Iterable[Metric]:
        """Yield the sums, as the library asks for them; gauges only of processes that live."""
        summed: dict[str, Metric] = {}
        values: dict[tuple[str, str, tuple[tuple[str, str], ...]], float] = {}
        for metrics, alive in ((list(self._own.collect()), True), *self._others()):
            for metric in metrics:
                summed.setdefault(metric.name, Metric(metric.name, metric.documentation, metric.type))
                for sample in metric.samples:
                    # When a process began to count is no sum.
                    if sample.name.endswith("_created") or (metric.type == "gauge" and not alive):
                        continue
                    key = metric.name, sample.name, tuple(sample.labels.items())
                    values[key] = values.get(key, 0.0) + sample.value
        for (name, sample_name, labels), value in values.items():
            summed[name].samples.append(Sample(sample_name, dict(labels), value))
        return summed.values()

    def _others(self) -> Iterator[tuple[list[Metric], bool]]:
        for file in self._file.parent.glob("*"):
            if file.name.isdigit() and file != self._file:
                with contextlib.suppress(OSError, EOFError, pickle.UnpicklingError):
                    yield pickle.loads(file.read_bytes()), _alive(int(file.name))


def _alive(process: int) -> bool:
    with contextlib.suppress(ProcessLookupError):
        os.kill(process, 0)
        return True
    return False
