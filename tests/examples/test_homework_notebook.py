"""The notebook of the homework executes, its cells as plain Python, and shows what it computes."""

from __future__ import annotations

import contextlib
import io
import json
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from docs.site.notebook import FIGURES, GUIDE, NOTEBOOK, written


@pytest.fixture
def shown(monkeypatch: pytest.MonkeyPatch) -> list[bytes]:
    """Return what cells show with IPython, in whose place a recorder stands."""
    found: list[bytes] = []
    display: Any = ModuleType("IPython.display")
    display.SVG = lambda name: found.append(Path(name).read_bytes())
    monkeypatch.setitem(sys.modules, "IPython", ModuleType("IPython"))
    monkeypatch.setitem(sys.modules, "IPython.display", display)
    return found


def test_it_is_the_guide() -> None:
    assert NOTEBOOK.read_text() == written(GUIDE.read_text()), "run python -m docs.site.notebook"


def test_it_executes_and_prints_and_draws_what_it_shows(
    service: str, shown: list[bytes], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {"__name__": "notebook"}
    drawn = []
    for cell in json.loads(NOTEBOOK.read_text())["cells"]:
        if cell["cell_type"] != "code":
            continue
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(compile("".join(cell["source"]).replace("http://127.0.0.1:8000", service), cell["id"], "exec"), names)
        texts = [output["text"] for output in cell["outputs"] if output["output_type"] == "stream"]
        assert printed.getvalue() == "".join(line for text in texts for line in text)
        drawn += [output["data"]["image/svg+xml"] for output in cell["outputs"] if "data" in output]
    assert [image.decode() for image in shown] == ["".join(lines) for lines in drawn]
    assert len(drawn) == len([*FIGURES.glob("*.svg")]) >= 4
