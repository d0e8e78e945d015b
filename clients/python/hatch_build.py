"""The build of the package: its generated modules are written before it is packed."""

from __future__ import annotations

import runpy
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class Generated(BuildHookInterface):  # type: ignore[misc, type-arg]
    """Writes the modules that are made from the OpenAPI document."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Write the modules."""
        runpy.run_path(str(Path(self.root) / "generate.py"), run_name="__main__")
