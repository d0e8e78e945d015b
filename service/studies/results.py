"""Results of a study in the forms in which they are sent."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from typing import Any
from zipfile import ZIP_STORED, ZipFile, ZipInfo

import numpy as np
from numpy.lib import format as npy

from service.responses.npz import METADATA, Sink
from service.studies.chunk_files import Chunk, ChunkFiles, CorruptedChunk
from service.studies.store import Store
from service.studies.study import Study
from service.studies.unfinished_study import gaps


class Results:
    """The stored results of a study whose members are all done.

    Parameters
    ----------
    study : Study
    store : Store
    files : ChunkFiles

    Raises
    ------
    CorruptedChunk
        If the record of some results is missing; they are computed again.
    """

    def __init__(self, study: Study, store: Store, files: ChunkFiles) -> None:
        self.study, self._store, self._files = study, store, files
        self._stretches = store.chunks(study.id)
        for missing, _ in gaps(self._stretches, study.count):
            store.drop_chunk(study.id, missing)
            raise CorruptedChunk("some results are not recorded")
        self.request: Any = None if study.whole else json.loads(store.request(study.id))

    def chunks(self, start: int = 0, stop: int | None = None) -> Iterator[Chunk]:
        """Yield the results of some members, in member order.

        Raises
        ------
        CorruptedChunk
            If a file cannot be read; the stretch is noted as missing, and computed again.
        """
        stop = self.study.count if stop is None else stop
        for low, high in self._stretches:
            if low < stop and high > start:
                try:
                    chunk = self._files.read(self.study.id, low, high)
                except CorruptedChunk:
                    self._store.drop_chunk(self.study.id, low)
                    raise
                yield _part(chunk, max(low, start), min(high, stop))

    def answer(self) -> Iterator[bytes]:
        """Yield the whole answer of a study of one member."""
        for chunk in self.chunks():
            yield chunk.answer

    def page(self, start: int, stop: int) -> dict[str, Any]:
        """Return the columns of some members."""
        chunks = [*self.chunks(start, stop)]
        figures = np.concatenate([chunk.figures for chunk in chunks])
        inputs = np.concatenate([chunk.inputs for chunk in chunks])
        return {
            "inputs": {entry["pointer"]: values(entry, inputs[:, k]) for k, entry in enumerate(self.request["vary"])},
            "figures": {
                entry["pointer"]: [None if np.isnan(x) else x for x in figures[:, k].tolist()]
                for k, entry in enumerate(self.study.plan["figures"])
            },
            "failures": [
                {"member": chunk.start + int(k), "code": chunk.failure_names[chunk.failures[k] - 1]}
                for chunk in chunks
                for k in np.flatnonzero(chunk.failures)
            ],
        }

    def archive(self) -> Iterator[bytes]:
        """Yield all results as a numpy archive, one stretch of members in memory at a time.

        Its arrays are ``inputs``, ``figures``, ``failures`` and ``warnings``; metadata.json has what their columns
        (``axes``, ``columns``) and labels (``failure_names``, ``warning_names``, from 1) mean.
        """
        names: dict[str, list[str]] = {"failures": [], "warnings": []}
        count = self.study.count
        widths = {"inputs": len(self.request["vary"]), "figures": len(self.study.plan["figures"])}
        sink = Sink()
        with ZipFile(sink, "w", ZIP_STORED) as file:
            for name, width in widths.items():
                header = {"descr": "<f8", "fortran_order": False, "shape": (count, width)}
                with file.open(ZipInfo(f"{name}.npy"), "w", force_zip64=True) as member:
                    npy.write_array_header_1_0(member, header)
                    for chunk in self.chunks():
                        member.write(np.ascontiguousarray(getattr(chunk, name)).tobytes())
                        yield sink.drained()
            for name, known in names.items():
                header = {"descr": "<u2", "fortran_order": False, "shape": (count,)}
                with file.open(ZipInfo(f"{name}.npy"), "w", force_zip64=True) as member:
                    npy.write_array_header_1_0(member, header)
                    for chunk in self.chunks():
                        own = chunk.failure_names if name == "failures" else chunk.warning_names
                        member.write(_labels(getattr(chunk, name), own, known).tobytes())
                        yield sink.drained()
            with file.open(ZipInfo(METADATA), "w") as member:
                rest = self.metadata() | {"failure_names": names["failures"], "warning_names": names["warnings"]}
                references = {name: {"array": name} for name in (*widths, *names)}
                member.write(json.dumps(rest | references).encode())
        yield sink.drained()

    def metadata(self) -> dict[str, Any]:
        """Return what the columns of inputs and figures mean."""
        varied = zip(self.study.plan["inputs"], self.request["vary"], strict=True)
        return {
            "jobID": self.study.id,
            "request": self.request,
            "shape": self.study.plan["shape"],
            "axes": [{**axis, "values": entry.get("values")} for axis, entry in varied],
            "columns": self.study.plan["figures"],
            "statistics": self._store.statistics(self.study.id),
        }


def values(entry: Any, numbers: np.ndarray[Any, Any]) -> list[Any]:
    """Return the values that the numbers of a varied input stand for."""
    listed = entry.get("values")
    return numbers.tolist() if listed is None else [listed[int(k)] for k in numbers]


def _part(chunk: Chunk, start: int, stop: int) -> Chunk:
    within = slice(start - chunk.start, stop - chunk.start)
    return chunk._replace(
        start=start,
        inputs=chunk.inputs[within],
        figures=chunk.figures[within],
        failures=chunk.failures[within],
        warnings=chunk.warnings[within],
    )


def _labels(labels: np.ndarray[Any, Any], own: Sequence[str], known: list[str]) -> np.ndarray[Any, Any]:
    """Return labels that stand for the same names in a list for all chunks, which grows."""
    known += [name for name in own if name not in known]
    found: np.ndarray[Any, Any] = np.array([0, *(known.index(name) + 1 for name in own)], dtype="<u2")[labels]
    return found
