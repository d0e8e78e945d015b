"""Examples of questions, by operation: shown in the documentation, answered while the service warms up."""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import cache
from importlib import resources

from service.routes.scene_catalogue import scene_catalogue
from service.routing import Example

SCENES_SHOWN = ("massive-pulley", "yo-yo", "double-pendulum", "bead-on-hoop", "lagrange-top")
"""The scenes of the catalogue that are shown and answered while the service warms up."""


@cache
def examples() -> Mapping[str, Mapping[str, Example]]:
    """Return the examples of every operation, by a short name."""
    table = json.loads(resources.files("service.routes").joinpath("examples.json").read_text(encoding="utf-8"))
    found = {
        operation: {name: Example(**example) for name, example in listed.items()} for operation, listed in table.items()
    }
    scenes = scene_catalogue()
    return found | {
        "described_scene": {name: Example(scenes[name].summary, scenes[name].question) for name in SCENES_SHOWN}
    }
