"""The model of a scene, and its phases, from those of its independent parts."""

from __future__ import annotations

from collections.abc import Sequence

from core.multibody.answer import SceneSolution
from core.multibody.model_answer import SceneModel
from core.multibody.start import name_of_parts


def joined_model(models: Sequence[SceneModel]) -> SceneModel:
    """Return the model of a scene from those of its parts."""
    name, why = name_of_parts(models)
    return SceneModel(
        name,
        why,
        sum(model.degrees_of_freedom for model in models),
        sum(model.mobility for model in models),
        sum(model.coordinates for model in models),
        sum(model.rows for model in models),
        (sum(model.described[0] for model in models), sum(model.described[1] for model in models)),
        tuple(part for model in models for part in model.apart),
        tuple(dict.fromkeys(sentence for model in models for sentence in model.noticed)),
        {name: others for model in models for name, others in model.redundant.items()},
    )


def period_of(solutions: Sequence[SceneSolution]) -> tuple[float | None, float | None]:
    """Return the period of a scene of which one part moves, and its error; None where several do."""
    moving = [solution for solution in solutions if _moves(solution)]
    return (moving[0].period, moving[0].period_error) if len(moving) == 1 else (None, None)


def _moves(solution: SceneSolution) -> bool:
    if solution.phases is None:
        return bool(solution.model.moving)
    return any(phase.model != "rest" for phase in solution.phases)
