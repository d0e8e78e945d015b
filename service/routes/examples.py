"""Examples of questions, by operation: shown in the documentation, answered while the service warms up."""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import cache
from importlib import resources

from service.routing import Example


@cache
def examples() -> Mapping[str, Mapping[str, Example]]:
    """Return the examples of every operation, by a short name."""
    table = json.loads(resources.files("service.routes").joinpath("examples.json").read_text(encoding="utf-8"))
    return {
        operation: {name: Example(**example) for name, example in found.items()} for operation, found in table.items()
    }
