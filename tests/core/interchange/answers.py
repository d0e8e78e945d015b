"""Accelerations of the scenes that documents describe."""

from __future__ import annotations

from typing import Any

import numpy as np

from core.arrays import Floats
from core.interchange.import_model import ImportedModel, import_model
from core.multibody.language.reading import scene_from
from core.multibody.solve import solve_scene


def accelerations(scene: Any) -> dict[str, Floats]:
    """Return the accelerations of the centres of a description at its start, in space (m/s^2)."""
    found = solve_scene(scene_from(scene), outputs=("accelerations",)).accelerations
    assert found is not None
    return {name: np.array([*map(float, one.linear), 0.0][:3]) for name, one in found.items()}


def imported(text: str) -> tuple[ImportedModel, dict[str, Floats]]:
    """Return a document's scene and its accelerations."""
    model = import_model(text)
    return model, accelerations(model.scene)
