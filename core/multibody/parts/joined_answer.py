"""The answer to a question about a scene of independent parts, from the answers about each."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import TypeVar

from core.multibody.answer import Energy, EnergyErrors, Equilibrium, SceneSolution
from core.multibody.equations_answer import SceneEquations
from core.multibody.language.independent_parts import independent_parts
from core.multibody.language.scene import Scene
from core.multibody.parts.common_span import answers_in_common
from core.multibody.parts.joined_model import joined_model, period_of
from core.multibody.parts.joined_phases import joined_phases
from core.multibody.parts.joined_trajectory import joined_trajectory
from core.multibody.parts.searched_parts import ELSEWHERE, joined_searches, outputs_of, part_of
from core.multibody.trajectory.scene_request import SceneRequest
from core.systems.rounding import shortened

Figure = TypeVar("Figure")


def answered_by_parts(
    scene: Scene, request: SceneRequest, answered: Callable[[Scene, SceneRequest], SceneSolution]
) -> SceneSolution:
    """Answer a question about a scene: about each of its independent parts, where it has several.

    A method integrates the equations of the whole scene, and quantities of the whole scene are searched along its whole
    motion: such questions are not divided.

    Parameters
    ----------
    scene : Scene
    request : SceneRequest
    answered : callable
        Answers a question about a scene as one part.

    Raises
    ------
    MechanicsError
        As `answered`, of the first part that is refused; faults of the description of all parts.
    """
    parts = independent_parts(scene)
    whole = [output for output in request.outputs if not isinstance(output, str)]
    if len(parts) == 1 or request.method is not None or any(part_of(one.quantity, parts) is None for one in whole):
        return answered(scene, request)
    requests = [replace(request, outputs=outputs_of(k, request.outputs, parts), digits=None) for k in range(len(parts))]
    found, span = answers_in_common(parts, requests, answered)
    solutions = [one.solution for one in found]
    events = sorted(
        (event for solution in solutions for event in solution.events if span.begin <= event.time <= span.end),
        key=lambda event: event.time,
    )
    ending = [solution for solution in solutions if solution.ended is not None and solution.ended.time <= span.end]
    ended = ending[0].ended if ending else None
    trajectory = joined_trajectory(found, request.times, events, ended)
    if trajectory is not None and request.digits is not None:
        trajectory = shortened(trajectory, request.digits)
    return SceneSolution(
        joined_model([solution.model for solution in solutions]),
        _together([solution.accelerations for solution in solutions]),
        _together([solution.forces for solution in solutions]),
        _energy([solution.energy for solution in solutions]),
        trajectory,
        *period_of(solutions),
        _equilibria(scene, request, answered),
        tuple(events),
        ended,
        *joined_searches(solutions, request.outputs, parts),
        phases=joined_phases(solutions, span.end),
        problem=ending[0].problem if ending else None,
        equations=_equations(scene, request, answered),
    )


def _equilibria(
    scene: Scene, request: SceneRequest, answered: Callable[[Scene, SceneRequest], SceneSolution]
) -> tuple[Equilibrium, ...] | None:
    """Return the places where all parts rest, which are places of the whole scene; None if they are not requested."""
    found = _of_whole("equilibria", scene, request, answered)
    return None if found is None else found.equilibria


def _equations(
    scene: Scene, request: SceneRequest, answered: Callable[[Scene, SceneRequest], SceneSolution]
) -> SceneEquations | None:
    """Return the equations of all parts together; None if they are not requested."""
    found = _of_whole("equations", scene, request, answered)
    return None if found is None else found.equations


def _of_whole(
    name: str, scene: Scene, request: SceneRequest, answered: Callable[[Scene, SceneRequest], SceneSolution]
) -> SceneSolution | None:
    """Return the answer of the scene as one part to one output, without times; None if that is not requested."""
    if name not in request.outputs:
        return None
    only = [output if output == name else ELSEWHERE for output in request.outputs]
    return answered(scene, replace(request, times=request.times[:0], outputs=only))


def _together(parts: Sequence[Mapping[str, Figure] | None]) -> Mapping[str, Figure] | None:
    """Return the figures of all parts in one mapping; None where they are not requested."""
    if any(figures is None for figures in parts):
        return None
    return {name: figure for figures in parts if figures is not None for name, figure in figures.items()}


def _energy(parts: Sequence[Energy | None]) -> Energy | None:
    own = [energy for energy in parts if energy is not None]
    if not own:
        return None
    kinetic, potential, total = (
        math.fsum(getattr(energy, name) for energy in own) for name in ("kinetic", "potential", "total")
    )
    errors = [energy.errors for energy in own if energy.errors is not None]
    return Energy(
        kinetic,
        potential,
        total,
        all(energy.conserved for energy in own),
        EnergyErrors(
            _error_of_sum(kinetic, [one.kinetic for one in errors]),
            _error_of_sum(potential, [one.potential for one in errors]),
            _error_of_sum(total, [one.total for one in errors]),
        ),
    )


def _error_of_sum(total: float, errors: Sequence[float | None]) -> float | None:
    """Return the error of a sum that is rounded once, None where that of a term is not known."""
    known = [error for error in errors if error is not None]
    if len(known) < len(errors):
        return None
    return math.nextafter(math.fsum([*known, 0.5 * math.ulp(total)]), math.inf) if any(known) or total else 0.0
