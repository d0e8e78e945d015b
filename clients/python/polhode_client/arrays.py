"""Arrays in questions and answers: as numpy arrays here, as lists in JSON, as members of a numpy archive."""

from __future__ import annotations

import io
import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, is_dataclass
from typing import Any
from zipfile import ZipFile

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Numbers = Sequence[float] | Sequence[Sequence[float]] | Floats | Integers
"""What is taken for an array of a question."""

ARCHIVE = "application/x-npz"
METADATA = "metadata.json"

LARGE = 1000
"""Numbers of an array from which on a question is sent as an archive."""


MOST_ARRAYS = 500
"""Of an archive; the service limits its members."""

REQUEST = "request"
"""Field that holds the question to another endpoint, which the service reads as JSON."""


def body_of(question: Mapping[str, Any]) -> tuple[bytes, str]:
    """Return a question as it is sent, and its media type: a numpy archive if large arrays are in it, or else JSON.

    Raises
    ------
    ValueError
        For numbers that JSON does not have: NaN and infinities.
    """
    arrays: dict[str, NDArray[Any]] = {}
    document = json.dumps(_plain(question, arrays), allow_nan=False).encode()
    if not arrays:
        return document, "application/json"
    sink = io.BytesIO()
    with ZipFile(sink, "w") as archive:
        archive.writestr(METADATA, document)
        for name, array in arrays.items():
            with archive.open(f"{name}.npy", "w") as member:
                np.lib.format.write_array(member, array, version=(1, 0), allow_pickle=False)
    return sink.getvalue(), ARCHIVE


def _plain(value: Any, arrays: dict[str, NDArray[Any]] | None) -> Any:
    """Return a value as JSON has it; large arrays are put under a name and referred to, as far as there may be any."""
    if is_dataclass(value) and not isinstance(value, type):
        return _plain(asdict(value), arrays)
    if isinstance(value, Mapping):
        return {key: _plain(entry, None if key == REQUEST else arrays) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(entry, arrays) for entry in value]
    if isinstance(value, np.ndarray):
        if (
            arrays is not None
            and len(arrays) < MOST_ARRAYS
            and value.size >= LARGE
            and value.ndim in (1, 2)
            and value.dtype.kind in "iuf"
        ):
            if not np.isfinite(value).all():
                raise ValueError("arrays of a question are of finite numbers")
            name = f"array{len(arrays)}"
            arrays[name] = value
            return {"array": name}
        return value.tolist()
    return value.item() if isinstance(value, np.generic) else value


def read_answer(content: bytes, media: str) -> Any:
    """Return an answer: documents and archives with arrays of numbers as numpy arrays (an empty one stays a list)."""
    if media == "application/json":
        return _with_arrays(json.loads(content), {})
    if media != ARCHIVE:
        return content.decode() if media.startswith(("text/", "image/svg")) else content
    with ZipFile(io.BytesIO(content)) as archive:
        document = json.loads(archive.read(METADATA))
        arrays = {
            name.removesuffix(".npy"): np.lib.format.read_array(io.BytesIO(archive.read(name)), allow_pickle=False)
            for name in archive.namelist()
            if name != METADATA
        }
    return _with_arrays(document, arrays)


def _with_arrays(value: Any, arrays: Mapping[str, NDArray[Any]]) -> Any:
    if isinstance(value, dict):
        if value.keys() == {"array"} and value["array"] in arrays:
            return arrays[value["array"]]
        return {key: _with_arrays(entry, arrays) for key, entry in value.items()}
    if isinstance(value, list):
        entries = [_with_arrays(entry, arrays) for entry in value]
        kinds = {*map(type, entries)}
        if kinds and kinds <= {int, float}:
            return np.array(entries)
        if kinds == {np.ndarray} and len({entry.shape for entry in entries}) == 1:
            return np.array(entries)
        return entries
    return value
