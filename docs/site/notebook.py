"""The guide to the homework as a notebook, and its figures.

``python -m docs.site.notebook`` runs the guide with the service that runs at POLHODE_PORT, writes its figures to
docs/pictures/homework, and the notebook to examples/homework.ipynb.
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import re
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from docs.site.blocks import blocks
from docs.site.navigation import DOCS, ROOT
from examples.ask import service_url

GUIDE = DOCS / "homework.md"
NOTEBOOK = ROOT / "examples/homework.ipynb"
FIGURES = DOCS / "pictures/homework"

FIGURE = re.compile(r"!\[[^\]]*\]\(pictures/homework/([a-z-]+\.svg)\)")
LINK = re.compile(r"\]\((?!https?:)([^)]+)\)")


def notebook(text: str) -> dict[str, Any]:
    """Return the guide as a notebook (nbformat 4.5), with the output that the page shows and its figures."""
    cells = [*_cells(text)]
    for number, cell in enumerate(cells):
        cell["id"] = f"cell-{number}"
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    return {"cells": cells, "metadata": {"kernelspec": kernel}, "nbformat": 4, "nbformat_minor": 5}


def written(text: str) -> str:
    """Return the notebook of a guide as its file holds it."""
    return json.dumps(notebook(text), indent=1, ensure_ascii=False) + "\n"


def _cells(text: str) -> Iterator[dict[str, Any]]:
    found = [*blocks(text)]
    last: dict[str, Any] = {}
    imported = False
    for block in found:
        yield from _prose(block.prose)
        if block.language == "python":
            if not imported:
                yield _code("from IPython.display import SVG")
                imported = True
            last = _code(block.code)
            yield last
        elif block.language == "text":
            # The cell is a part of the list already: what it prints is written into it.
            last["outputs"].append({"name": "stdout", "output_type": "stream", "text": _lines(block.code)})
        else:
            yield _markdown(f"```{block.language}\n{block.code}```")
    yield from _prose(text[text.rindex("```") + 3 :])


def _prose(text: str) -> Iterator[dict[str, Any]]:
    """Yield a cell for the prose up to each figure, and one that shows the figure."""
    end = 0
    for match in FIGURE.finditer(text):
        yield from _prose_alone(text[end : match.start()])
        yield _figure(match[1])
        end = match.end()
    yield from _prose_alone(text[end:])


def _prose_alone(text: str) -> Iterator[dict[str, Any]]:
    if text.strip():
        yield _markdown(LINK.sub(lambda match: f"]({_from_examples(match[1])})", text.strip()))


def _from_examples(target: str) -> str:
    return target.removeprefix("../examples/") if target.startswith("../examples/") else f"../docs/{target}"


def _figure(name: str) -> dict[str, Any]:
    shown = _code(f'SVG("{name}")')
    image = (FIGURES / name).read_text(encoding="utf-8")
    data = {"image/svg+xml": _lines(image), "text/plain": ["<IPython.core.display.SVG object>"]}
    shown["outputs"].append({"data": data, "execution_count": None, "metadata": {}, "output_type": "execute_result"})
    return shown


def _code(source: str) -> dict[str, Any]:
    return {
        "cell_type": "code",
        "execution_count": None,
        "metadata": {},
        "outputs": [],
        "source": _lines(source.rstrip("\n")),
    }


def _markdown(source: str) -> dict[str, Any]:
    return {"cell_type": "markdown", "metadata": {}, "source": _lines(source)}


def _lines(text: str) -> list[str]:
    return text.splitlines(keepends=True)


def main() -> None:
    """Write figures and notebook."""
    text, names = GUIDE.read_text(encoding="utf-8"), {"__name__": "guide"}
    FIGURES.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        for block in blocks(text):
            if block.language == "python":
                with contextlib.redirect_stdout(io.StringIO()):
                    exec(block.code.replace("http://127.0.0.1:8000", service_url()), names)
        for name in os.listdir(folder):
            (FIGURES / name).write_bytes(Path(name).read_bytes())
    NOTEBOOK.write_text(written(text), encoding="utf-8")


if __name__ == "__main__":
    main()
