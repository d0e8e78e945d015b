"""Relations between the answers to two requests, by name."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np

from core.errors import MechanicsError
from core.multibody.answer import SceneSolution
from core.multibody.language.scene import Scene
from core.multibody.proven.proven_answer import proven_answer
from core.multibody.solve import solve_scene
from core.multibody.trajectory.occurrences import ExtremesOf, When
from tests.core.multibody.relations import additions, geometry, writing
from tests.core.multibody.relations.comparison import Difference, differences
from tests.core.multibody.relations.geometry import Transformed, dimension
from tests.core.multibody.relations.numbers import Json
from tests.core.multibody.relations.sources import by_its_motion, without_law, without_search
from tests.core.multibody.relations.views import Figure, Refusal, View, viewed
from tests.core.multibody.worked_examples import read

CHANGE = 1e-12
"""Relative change of a number by which answers may move by as much times their condition."""
SECOND_ORDER = 100.0 * CHANGE**2
"""What that statement, which is of first order, leaves out: second derivatives by numbers about one are below 200."""
OF_OUTPUTS = ("gravity", "let", "bodies", "connections", "numbers")

Relation = Callable[[Json], Transformed | None]


def _scene(request: Json) -> Scene:
    return read(json.loads(json.dumps({key: request[key] for key in OF_OUTPUTS if key in request})))


def answered(request: Json, input_uncertainty: float | None = None) -> SceneSolution:
    """Return the answer to a request, which is not changed by being read."""
    scene = _scene(request)
    outputs: list[Any] = list(request.get("outputs", ["trajectory"]))
    if "searched" in request and max(request.get("times", [0.0])) > 0.0:
        body, speed = request["searched"]
        outputs += [When(f"{body}.velocity.length", speed), ExtremesOf(f"{body}.velocity.length")]
    return solve_scene(
        scene, request.get("times", ()), outputs, request.get("accuracy", 1e-9), input_uncertainty=input_uncertainty
    )


def _moved(request: Json) -> Transformed | None:
    return geometry.moved(request, ["3", "-7/3", "1/8"][: dimension(request)])


def _moved_far(request: Json) -> Transformed | None:
    """Return a request moved so far that squares of coordinates tell nothing of a metre in doubles.

    There the run of a pendulum knows places worse than its closed form does, which is then the model.
    """
    found = geometry.moved(request, ["1000000", "-2000000/3", "125000"][: dimension(request)])
    if found is None:
        return None
    image = found.image
    return replace(found, image=lambda view: _in_one_form(image(view)), restored=lambda view, _: _in_one_form(view))


def _in_one_form(view: View) -> View:
    """Return a view with one name for both models of a pendulum."""
    models = [("one period" if name == "pendulum" else name, *rest) for name, *rest in view.models]
    return replace(view, models=sorted(models, key=lambda part: (part[0], part[1], part[2] or 0.0)))


RELATIONS: dict[str, Relation] = {
    "beside a pendulum": lambda request: additions.beside(request, "pendulum"),
    "beside a bouncing ball": lambda request: additions.beside(request, "ball"),
    "beside a driven wheel": lambda request: additions.beside(request, "wheel"),
    "beside a force in time": lambda request: additions.beside(request, "formula"),
    "turned": geometry.turned,
    "turned by acos 5/13": lambda request: geometry.turned(request, sides=(5, 12, 13)),
    "turned by acos 8/17": lambda request: geometry.turned(request, sides=(8, 15, 17)),
    "turned about x": lambda request: geometry.turned(request, about=0) if dimension(request) == 3 else None,
    "moved": _moved,
    "moved far": _moved_far,
    "mirrored": geometry.mirrored,
    "reversed in time": geometry.reversed_in_time,
    "in units of powers of two": lambda request: writing.in_units(request, 4, 2, 2),
    "in units of three": lambda request: writing.in_units(request, 3, 3, 3),
    "in units of powers of ten": lambda request: writing.in_units(request, 1000, 10, 100),
    "reordered": writing.reordered,
    "renamed": writing.renamed,
    "written as formulas": writing.as_formulas,
    "a connection repeated": additions.repeated,
    "a rod as a track": additions.rod_as_track,
    "at other times": writing.asked_at_other_times,
    "fewer outputs": writing.asked_for_less,
    "a finer accuracy": writing.more_accurate,
    "a contact out of reach": additions.with_floor_far_below,
}
"""Relations that hold within the stated errors of both answers."""
OF_COMPONENTS = ("turned", "moved", "mirrored", "reversed in time", "in units")
"""Beginnings of relations that change what components, places and units mean, and so formulas of the motion."""


def _but_by_motion(relation: Relation) -> Relation:
    return lambda request: None if by_its_motion(request) else relation(request)


RELATIONS |= {name: _but_by_motion(RELATIONS[name]) for name in RELATIONS if name.startswith(OF_COMPONENTS)}
MOVED_A_LITTLE = "a number moved by 1e-12"
NAMES = (*RELATIONS, MOVED_A_LITTLE)
PROVEN_DIGITS = 22
PROVEN_TIME = Fraction(5, 16)
"""One time (s), to which most motions can be proven in a second."""


def checked(request: Json, name: str, seed: int = 0, original: View | Refusal | None = None) -> list[Difference] | None:
    """Return how the answers to a request and to what a relation makes of it differ; None where it says nothing."""
    if name.startswith(OF_COMPONENTS) and (without := without_law(request)) != request:
        request, original = without, None
    if name == MOVED_A_LITTLE:
        return _checked_by_condition(request, np.random.default_rng(seed))
    made = RELATIONS[name](copy.deepcopy(request))
    if made is None:
        return None
    own = viewed(lambda: answered(request)) if original is None else original
    found = viewed(lambda: answered(made.request))
    rounded = name in ("a finer accuracy", "moved far")
    if isinstance(own, Refusal) or isinstance(found, Refusal):
        if rounded and isinstance(found, Refusal) and found.kind == "AccuracyUnreachable":
            return []
        return differences(own, found)
    different = differences(made.image(own), made.restored(found, own))
    # How near a collision an answer ends, before which it cannot be told from a near miss, depends on rounding.
    return [one for one in different if not (rounded and one.where == "lost-event / lost-event")]


def _checked_by_condition(request: Json, random: np.random.Generator) -> list[Difference] | None:
    """Compare the answers for a number and one that is larger by `CHANGE`, by what that is stated to do."""
    other = additions.moved_a_little(request, random)
    if other is None:
        return None
    stated: dict[str, float] = {}

    def ask() -> SceneSolution:
        answer = answered(request, CHANGE)
        motion = answer.trajectory
        if motion is not None:
            stated.update(
                (f"column:{key}", one.inherited) for key, one in motion.columns.items() if one.inherited is not None
            )
        return answer

    own, found = viewed(ask), viewed(lambda: answered(other))
    if isinstance(own, Refusal) or isinstance(found, Refusal):
        # A number on which the scene hangs, such as the place of a joint, cannot be moved.
        return [one for one in differences(own, found) if one.kind == "crash"]

    moments = [[body.get("moments") for body in one["bodies"].values()] + [one.get("let")] for one in (request, other)]
    moments_moved = moments[0] != moments[1]

    def kept(key: str, figure: Figure) -> bool:
        # Whether an axis tells the attitude of a body, and which, depends on what moments are equal exactly.
        same = key in own.figures and key in found.figures and not moments_moved
        return key in stated and (same or figure.what != "axis")

    def wide(view: View) -> View:
        figures = {key: figure for key, figure in view.figures.items() if kept(key, figure)}
        return View(
            figures={
                key: Figure(one.values, one.unit, one.error + 2.0 * stated[key] + SECOND_ORDER, one.what, one.owner)
                for key, one in figures.items()
            },
            times=view.times,
            events=[],
            ended=None,
            problem=None,
            models=view.models,
            states=[],
        )

    # Which model suffices hangs on numbers that are exact.
    exempt = ("model", "parts", "degrees of freedom", "period in one form")
    return [one for one in differences(wide(own), wide(found)) if one.kind not in exempt]


def checked_by_digits(request: Json) -> list[Difference] | None:
    """Compare the samples with their proven digits; None where none are proven."""
    scene = _scene(request)
    try:
        proven = proven_answer(scene, PROVEN_DIGITS, [PROVEN_TIME])
    except MechanicsError:
        # Contacts, redundant connections and starts that hold to rounding have no proven digits.
        return None
    assert proven.columns is not None
    found = viewed(lambda: answered({**without_search(request), "times": [float(PROVEN_TIME)]}))
    if isinstance(found, Refusal):
        return [Difference("refused in one form", found.detail[:100], np.inf)]
    figures: dict[str, Figure] = {}
    for name, column in proven.columns.items():
        owner, _, what = name.rpartition(".")
        values = np.array(column.values, dtype=float)
        figures[f"column:{name}"] = Figure(values, column.unit, 0.0, what, owner)
    for body, one in (proven.accelerations or {}).items():
        values = np.array([[float(x) for x in one.linear]])
        figures[f"start:{body}.acceleration"] = Figure(values, "m/s^2", 0.0, "acceleration", body)
    if (proven.rows == []) != (found.ended is not None):
        return [Difference("how it ends", f"{proven.ended} / {found.ended}", np.inf)]
    return differences(replace(found, figures=figures), found)
