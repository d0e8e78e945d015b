"""A study as the client sees it: waiting with a bar, ends without results, and the Dataset with names and units."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, cast

import numpy as np
import pytest
from polhode_client import documents
from polhode_client.study import Study, StudyEnded

PRODUCT: dict[str, Any] = {
    "shape": [2, 3],
    "request": {"question": {"path": "/v1/toy", "request": {}}},
    "axes": [
        {"pointer": "/body/moments/0", "unit": "kg m^2", "levels": 2, "values": None},
        {"pointer": "/method", "unit": None, "levels": 3, "values": ["a", {"kind": "b"}, "c"]},
    ],
    "columns": [{"pointer": "/flip_interval", "unit": "s"}, {"pointer": "/accuracy/error", "unit": "1"}],
    "inputs": np.array([[1.0, 0.0], [1.0, 1.0], [1.0, 2.0], [2.0, 0.0], [2.0, 1.0], [2.0, 2.0]]),
    "figures": np.arange(12.0).reshape(6, 2),
    "failures": np.array([0, 0, 1, 0, 0, 0], dtype=np.uint16),
    "warnings": np.zeros(6, dtype=np.uint16),
    "failure_names": ["invalid-parameter"],
    "warning_names": [],
}


class Service:
    """What answers in place of a service: states one after the other, and results."""

    def __init__(self, *states: tuple[str, int], results: dict[str, Any] = PRODUCT) -> None:
        self._states: Iterator[tuple[str, int]] = iter(states)
        self._results = results

    def get_study(self, study: str) -> documents.StudyState:
        status, done = next(self._states)
        state = {"jobID": study, "status": status, "done": done, "count": 6, "progress": 100 * done // 6}
        return cast(documents.StudyState, state)

    def dismiss_study(self, study: str) -> documents.StudyState:
        return cast(documents.StudyState, {"status": "dismissed"})

    def get_study_results_npz(self, study: str) -> dict[str, Any]:
        return self._results


def test_waiting_shows_a_bar_and_ends_with_the_study(capsys: pytest.CaptureFixture[str]) -> None:
    service = Service(("accepted", 0), ("running", 3), ("successful", 6))
    assert Study(service, "x").wait(progress=True, every=0.0).id == "x"
    assert "6/6" in capsys.readouterr().err


def test_the_bar_shows_at_once_and_is_drawn_at_every_look(capsys: pytest.CaptureFixture[str]) -> None:
    drawn: list[str] = []

    class Watched(Service):
        def get_study(self, study: str) -> documents.StudyState:
            drawn.append(capsys.readouterr().err)
            return super().get_study(study)

    states = [("accepted", 0), ("accepted", 0), ("running", 0), ("running", 0), ("running", 1), ("successful", 6)]
    Study(Watched(*states), "x").wait(progress=True, every=0.0)
    shown = [text.rpartition("\r")[2] for text in drawn[1:]]
    # What the client sees while it waits for the next look.
    expected = [("accepted", "0/6"), ("accepted", "0/6"), ("running", "0/6"), ("running", "0/6"), ("running", "1/6")]
    for text, (status, done) in zip(shown, expected, strict=True):
        assert text.startswith(f"{status}:")
        assert done in text


@pytest.mark.parametrize("status", ["failed", "dismissed"])
def test_an_end_without_results_is_an_exception(status: str) -> None:
    with pytest.raises(StudyEnded) as ended:
        Study(Service(("running", 1), (status, 2)), "x").wait(every=0.0)
    assert ended.value.args[0]["done"] == 2


def test_waiting_has_a_limit() -> None:
    with pytest.raises(TimeoutError, match="running at 16 %"):
        Study(Service(*[("running", 1)] * 50), "x").wait(every=0.0, timeout=-1.0)


def test_a_grid_has_the_levels_as_coordinates_with_their_units() -> None:
    found = Study(Service(), "x").to_xarray()
    assert found["flip_interval"].dims == ("moments_0", "method")
    assert found["flip_interval"].to_numpy().tolist() == [[0.0, 2.0, 4.0], [6.0, 8.0, 10.0]]
    assert found["moments_0"].to_numpy().tolist() == [1.0, 2.0]
    assert found["method"].to_numpy().tolist() == ["a", "{'kind': 'b'}", "c"]
    assert found["moments_0"].attrs == {"pointer": "/body/moments/0", "units": "kg m^2"}
    assert found["flip_interval"].attrs["units"] == "s"
    assert found["failure"].to_numpy().tolist() == [["", "", "invalid-parameter"], ["", "", ""]]
    assert found.attrs == {"study": "x", "path": "/v1/toy"}


def test_other_designs_have_members() -> None:
    drawn = {**PRODUCT, "shape": [6], "request": {**PRODUCT["request"], "design": "random"}}
    found = Study(Service(results=drawn), "x").to_xarray()
    assert found["error"].dims == ("member",)
    assert found["moments_0"].dims == ("member",)
    assert found["error"].to_numpy().tolist() == [1.0, 3.0, 5.0, 7.0, 9.0, 11.0]
