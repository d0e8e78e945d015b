"""Results as a Zarr store in a zip file: an array per figure in the shape of the grid, its levels as coordinates."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from service.studies.folder import make_private
from service.studies.results import Results, values

MEDIA_TYPE = "application/vnd.zarr+zip"

PIECE = 262_144
"""Bytes that are read at a time."""


def grid(results: Results, folder: Path) -> Iterator[bytes]:
    """Yield all results as a Zarr store, which xarray opens; it is made in a file of a folder first.

    Raises
    ------
    ImportError
        Without zarr, an optional dependency.
    """
    import zarr
    from zarr.storage import ZipStore

    about, shape = results.metadata(), tuple(results.study.plan["shape"])
    product = about["request"].get("design", "product") == "product"
    axes, columns = (
        names([axis["pointer"] for axis in about["axes"]]),
        names([column["pointer"] for column in about["columns"]]),
    )
    dimensions = axes if product else ["member"]
    make_private(folder)
    with tempfile.TemporaryDirectory(dir=folder) as place:
        file = Path(place) / "study.zarr.zip"
        with ZipStore(file, mode="w") as store:
            group = zarr.open_group(store, mode="w", attributes={"study": results.study.id, "request": results.request})
            for k, (name, axis) in enumerate(zip(axes, about["axes"], strict=True)):
                column = np.concatenate([chunk.inputs[:, k] for chunk in results.chunks()]).reshape(shape)
                if product:
                    column = np.moveaxis(column, k, 0).reshape(shape[k], -1)[:, 0]
                listed = np.array(values(results.request["vary"][k], column))
                if listed.dtype.kind in "fiub":
                    _write(group, name, listed, [name] if product else ["member"], axis)
            for k, (name, entry) in enumerate(zip(columns, about["columns"], strict=True)):
                figure = np.concatenate([chunk.figures[:, k] for chunk in results.chunks()])
                _write(group, name, figure.reshape(shape), dimensions, entry)
        with file.open("rb") as data:
            while piece := data.read(PIECE):
                yield piece


def names(pointers: Sequence[str]) -> list[str]:
    """Return short names: the last steps of pointers, as many as are needed to tell them apart."""
    steps = [pointer.strip("/").split("/") for pointer in pointers]
    # Numbers alone say nothing.
    leasts = [next((k for k, step in enumerate(entry[::-1], 1) if not step.isdigit()), 1) for entry in steps]
    for length in range(1, max(map(len, steps)) + 1):
        found = ["_".join(entry[-max(length, least) :]) for entry, least in zip(steps, leasts, strict=True)]
        if len(set(found)) == len(found):
            return found
    return ["_".join(entry) for entry in steps]


def _write(group: Any, name: str, array: np.ndarray[Any, Any], dimensions: Sequence[str], about: Any) -> None:
    attributes = {"pointer": about["pointer"]} | ({} if about["unit"] is None else {"units": about["unit"]})
    made = group.create_array(
        name, shape=array.shape, dtype=array.dtype, dimension_names=dimensions, attributes=attributes
    )
    made[...] = array
