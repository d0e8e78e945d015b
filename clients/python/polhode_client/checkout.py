"""In a checkout the typed modules are written when the package is first imported; an installed package has them."""

from __future__ import annotations

import runpy
from importlib.util import find_spec
from pathlib import Path

_PROGRAM = Path(__file__).parents[1] / "generate.py"

if find_spec("polhode_client.documents") is None and _PROGRAM.exists():
    runpy.run_path(str(_PROGRAM), run_name="__main__")
