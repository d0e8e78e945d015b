"""Answers as numpy archives: every array a member of its own, everything else as JSON beside them.

A member is named by the place of its array in the JSON answer, steps joined by slashes: ``angular_velocity``,
``mesh/vertices``, ``polhodes/0/points``. The member ``metadata.json`` is the rest of the answer, in which
``{"array": name}`` stands for each array. ``numpy.load`` reads all of it.
"""

from __future__ import annotations

import io
from collections.abc import Iterator
from typing import Any, cast
from zipfile import ZIP_STORED, ZipFile, ZipInfo

import numpy as np
from numpy.lib import format as npy

from service.responses.json_rows import parts

MEDIA_TYPE = "application/x-npz"

METADATA = "metadata.json"

CHUNK = 262_144
"""Bytes per chunk."""

_ZIP64_FROM = 2**31


def archive(answer: Any) -> Iterator[bytes]:
    """Yield a finite answer as a numpy archive, not compressed, in chunks; equal answers give equal bytes."""
    arrays: dict[str, np.ndarray[Any, Any]] = {}
    metadata = _without_arrays(answer, "", arrays)
    sink = Sink()
    with ZipFile(sink, "w", ZIP_STORED) as file:
        for name, array in arrays.items():
            with file.open(ZipInfo(f"{name}.npy"), "w", force_zip64=array.nbytes > _ZIP64_FROM) as member:
                contiguous = np.ascontiguousarray(array)
                npy.write_array_header_1_0(member, npy.header_data_from_array_1_0(contiguous))
                data = contiguous.reshape(-1).view(np.uint8).data
                for start in range(0, len(data), CHUNK):
                    member.write(data[start : start + CHUNK])
                    yield sink.drained()
        with file.open(ZipInfo(METADATA), "w") as member:
            for text in parts(metadata):
                # No array is left in it.
                member.write(cast(bytes, text))
                yield sink.drained()
    yield sink.drained()


def _without_arrays(value: Any, name: str, arrays: dict[str, np.ndarray[Any, Any]]) -> Any:
    """Return a value in which a reference stands for each array; the arrays are put under their names."""
    if isinstance(value, np.ndarray):
        arrays[name] = value
        return {"array": name}
    within = f"{name}/" if name else ""
    if type(value) is dict:
        return {key: _without_arrays(entry, within + key, arrays) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [_without_arrays(entry, f"{within}{i}", arrays) for i, entry in enumerate(value)]
    return value


class Sink(io.RawIOBase):
    """What the archive is written to: it holds only what has not been sent, and cannot go back."""

    def __init__(self) -> None:
        super().__init__()
        self._parts: list[bytes] = []
        self._written = 0

    def writable(self) -> bool:
        """Return that it can be written to."""
        return True

    def write(self, data: Any) -> int:
        """Take some bytes."""
        self._parts.append(bytes(data))
        self._written += len(self._parts[-1])
        return len(self._parts[-1])

    def tell(self) -> int:
        """Return how many bytes it has taken."""
        return self._written

    def drained(self) -> bytes:
        """Return what was written since the last time."""
        whole = b"".join(self._parts)
        self._parts.clear()
        return whole
