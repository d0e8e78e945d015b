"""Every figure that POST /v1/scenes computes has an error beside it, over all worked scenes and all outputs.

A figure is a number of the answer that is not what the question gave, a count, or an error itself. Its error is `error`
in the object in which it stands, or under its name in `errors` of that object or of one around it; places have theirs
by body in `place_errors`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest

from service.routes.scene_catalogue import scene_catalogue
from tests.service.conftest import client_of, inline_service

SERVICE = inline_service()
OUTPUTS = (
    "accelerations", "forces", "energy", "trajectory", "forces-in-time", "energy-in-time", "momenta-in-time",
    "work-in-time", "paths-in-time",
)  # fmt: skip
pytestmark = pytest.mark.anyio
GIVEN = {"equals", "nth", "requested", "rows", "described", "degrees_of_freedom", "mobility", "coordinates"}
"""Of the question, and counts."""
OWN = {"time", "least", "largest"}
"""What `error` is of where there are `errors` as well."""
TIMES = "/trajectory/time/*"
"""Those of the question as well."""
ABOUT_ERRORS = {"inherited", "residual"}
"""What says itself how right something is."""


def bare(value: Any, path: str = "", known: bool = False, above: tuple[Any, ...] = ()) -> Iterator[str]:
    """Yield the paths of the numbers that have no error.

    Parameters
    ----------
    known : bool
        Whether an error stands for all that is inside.
    above : tuple
        What stands in `errors` of the objects around by the names that lead here, innermost last.
    """
    if isinstance(value, dict):
        own = value.get("errors")
        if "place_errors" in value:
            own = (own or {}) | {key: value["place_errors"] for key in ("least_places", "largest_places")}
        for name, inner in value.items():
            if name in ("error", "errors", "place_errors") or name in GIVEN | ABOUT_ERRORS:
                continue
            # An error that is null stands for a number that is null.
            covered = known or (value.get("error") is not None and (own is None or name in OWN))
            leads = [each[name] for each in (*above, own) if isinstance(each, dict) and each.get(name) is not None]
            covered = covered or any(isinstance(each, float | int) for each in leads)
            yield from bare(inner, f"{path}/{name}", covered, tuple(leads))
    elif isinstance(value, list):
        for inner in value:
            yield from bare(inner, f"{path}/*", known, above)
    elif isinstance(value, float | int) and not isinstance(value, bool) and not known and path != TIMES:
        yield path


async def asked(question: dict[str, Any]) -> dict[str, Any]:
    async with client_of(SERVICE) as client:
        sent = await client.post("/v1/scenes", json=question)
    found: dict[str, Any] = sent.json()
    return found


@pytest.mark.parametrize("name", scene_catalogue())
async def test_every_figure_of_a_worked_scene_has_an_error(name: str) -> None:
    question = dict(scene_catalogue()[name].question)
    body = next(iter(question["bodies"]))
    searches = [
        {"when": {"quantity": f"{body}.position.x", "equals": 0.25}},
        {"extremes": f"{body}.velocity.length"},
    ]
    found: dict[str, Any] = {}
    # Some do not have all of them.
    for outputs in ([*OUTPUTS, "equilibria", *searches], [*OUTPUTS, *searches], [*OUTPUTS], ["trajectory"]):
        if "model" not in found:
            found = await asked(question | {"outputs": outputs})
    assert "model" in found, found
    assert sorted(set(bare(found))) == []


@pytest.mark.parametrize(
    ("spoil", "where"),
    [
        (lambda one: one["events"][0].pop("error"), {"/events/*/time"}),
        (lambda one: one["events"][0]["errors"].pop("energy_loss"), {"/events/*/energy_loss"}),
        (lambda one: one["energy"]["errors"].pop("kinetic"), {"/energy/kinetic"}),
        (lambda one: one["forces"]["floor.normal"].pop("error"), {"/forces/floor.normal/value"}),
    ],
)
async def test_a_figure_without_one_is_seen(spoil: Callable[[Any], None], where: set[str]) -> None:
    ball = {"kind": "contact", "name": "floor", "place": "p", "on": {"at": [0, 0]}, "restitution": 0.5}
    scene = {"gravity": [0, -10], "bodies": {"p": {"mass": 1, "at": [0, 1]}}, "connections": [ball]}
    found = await asked(scene | {"times": [0.5], "outputs": ["energy", "forces", "trajectory"]})
    assert set(bare(found)) == set()
    spoil(found)
    assert set(bare(found)) == where
