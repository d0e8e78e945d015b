"""A study that a service works on: its state, its results, and these as an xarray Dataset."""

from __future__ import annotations

import time
from collections.abc import Mapping
from importlib import import_module
from typing import Any, Protocol

import numpy as np

from polhode_client import documents

UNFINISHED = ("accepted", "running")


class Connection(Protocol):
    """What a study needs of a client."""

    def get_study(self, study: str) -> documents.StudyState:
        """Return the state of a study."""

    def dismiss_study(self, study: str) -> documents.StudyState:
        """Stop a study."""

    def get_study_results_npz(self, study: str) -> dict[str, Any]:
        """Return all results of a study."""


class StudyEnded(Exception):
    """A study has ended without results; the argument is its state."""


class Study:
    """A study by its id; made by `Client.study`, or for one that exists: ``Study(client, id)``.

    Examples
    --------
    >>> study = polhode.study(question=..., vary=[...], quantities=["/flip_interval"])  # doctest: +SKIP
    >>> study.wait(progress=True).to_xarray()  # doctest: +SKIP
    """

    def __init__(self, client: Connection, identity: str) -> None:
        self._client, self.id = client, identity

    def state(self) -> documents.StudyState:
        """Return its state now."""
        return self._client.get_study(self.id)

    def wait(self, *, progress: bool = False, every: float = 0.25, timeout: float | None = None) -> Study:
        """Return when it is successful.

        Parameters
        ----------
        progress : bool
            Whether to show a bar, with the status and how many members are done, from the first look on; needs tqdm.
        every : float
            Time between two looks (s).
        timeout : float, optional
            Longest time to wait (s).

        Raises
        ------
        StudyEnded
            If it fails or is dismissed.
        TimeoutError
        """
        until = None if timeout is None else time.monotonic() + timeout
        state = self.state()
        bar = _bar(state["count"]) if progress else None
        try:
            while True:
                if bar is not None:
                    # Drawn at every look: while processes start, nothing is done, and the bar would stand still.
                    bar.set_description_str(state["status"], refresh=False)
                    bar.n = state["done"]
                    bar.refresh()
                if state["status"] not in UNFINISHED:
                    break
                if until is not None and time.monotonic() > until:
                    raise TimeoutError(f"the study is {state['status']} at {state['progress']} %")
                time.sleep(every)
                state = self.state()
        finally:
            if bar is not None:
                bar.close()
        if state["status"] != "successful":
            raise StudyEnded(state)
        return self

    def dismiss(self) -> documents.StudyState:
        """Stop it, or remove it with its results if it has ended."""
        return self._client.dismiss_study(self.id)

    def results(self) -> Mapping[str, Any]:
        """Return all results.

        ``inputs`` and ``figures`` are arrays with a row per member, ``failures`` and ``warnings`` labels from 1 into
        ``failure_names`` and ``warning_names``, 0 for none; ``axes`` and ``columns`` say what the columns are.
        """
        return self._client.get_study_results_npz(self.id)

    def to_xarray(self) -> Any:
        """Return all results as an `xarray.Dataset`; needs xarray, which is imported only here.

        A product has a dimension per varied input, named by the last steps of its pointer, with its levels as
        coordinate. Other designs have the dimension ``member``, with the inputs as coordinates of it. Units are
        attributes. ``failure`` holds the codes of problems.
        """
        xarray = import_module("xarray")
        found = self.results()
        shape, grid = tuple(found["shape"]), found["request"].get("design", "product") == "product"
        names = _names([axis["pointer"] for axis in found["axes"]])
        dimensions = tuple(names) if grid else ("member",)
        coordinates: dict[str, Any] = {}
        for k, (name, axis) in enumerate(zip(names, found["axes"], strict=True)):
            column = found["inputs"][:, k].reshape(shape)
            if grid:
                column = np.moveaxis(column, k, 0).reshape(shape[k], -1)[:, 0]
            listed = axis["values"]
            values = column if listed is None else [_coordinate(listed[int(place)]) for place in column]
            about = {"pointer": axis["pointer"]} | ({"units": axis["unit"]} if axis["unit"] else {})
            coordinates[name] = ((name,) if grid else ("member",), values, about)
        data: dict[str, Any] = {}
        for k, (name, column) in enumerate(
            zip(_names([column["pointer"] for column in found["columns"]]), found["columns"], strict=True)
        ):
            about = {"pointer": column["pointer"]} | ({"units": column["unit"]} if column["unit"] else {})
            data[name] = (dimensions, found["figures"][:, k].reshape(shape), about)
        labels = np.array(["", *found["failure_names"]], dtype=np.str_)
        data["failure"] = (dimensions, labels[np.asarray(found["failures"])].reshape(shape))
        return xarray.Dataset(data, coordinates, {"study": self.id, "path": found["request"]["question"]["path"]})


def _bar(count: int) -> Any:
    # An optional package, which has no types of its own.
    return import_module("tqdm.auto").tqdm(total=count, unit="member")


def _names(pointers: list[str]) -> list[str]:
    """Return short names: the last steps of pointers, as many as are needed to tell them apart."""
    steps = [pointer.strip("/").split("/") for pointer in pointers]
    # Numbers alone say nothing.
    leasts = [next((k for k, step in enumerate(entry[::-1], 1) if not step.isdigit()), 1) for entry in steps]
    for length in range(1, max(map(len, steps)) + 1):
        names = ["_".join(entry[-max(length, least) :]) for entry, least in zip(steps, leasts, strict=True)]
        if len(set(names)) == len(names):
            return names
    return ["_".join(entry) for entry in steps]


def _coordinate(value: Any) -> Any:
    return value if isinstance(value, (int, float, str, bool)) else str(value)
