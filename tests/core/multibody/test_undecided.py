"""What is undecided: every code is registered, constructed somewhere, and has its section in the documentation."""

from __future__ import annotations

import ast
import json
import re
from pathlib import Path
from typing import get_args

from core.multibody.undecided import DOCUMENT, UNDECIDED, Code
from docs.site.blocks import blocks

ROOT = Path(__file__).parents[3]
WITHOUT_CODE = {"rigid-redundancy", "references"}
"""Sections about statements of forces, and of sources."""


def constructed() -> set[str]:
    """Return the codes with which the solver ends a motion, by its source."""
    found = set()
    for file in (ROOT / "core" / "multibody").rglob("*.py"):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "Problem":
                (first, *_) = node.args
                assert isinstance(first, ast.Constant), f"{file.name}: the code of a problem is written out"
                found.add(first.value)
    return found


def sections() -> list[str]:
    """Return the anchors of the headings, as GitHub and MkDocs make them."""
    headings = re.findall(r"^## (.+)$", (ROOT / DOCUMENT).read_text(encoding="utf-8"), re.MULTILINE)
    return [re.sub(r"[^\w-]+", "", heading.strip().lower().replace(" ", "-")) for heading in headings]


def test_every_code_is_registered_and_used() -> None:
    assert list(UNDECIDED) == list(get_args(Code))
    assert constructed() == set(UNDECIDED)


def test_every_code_has_its_section() -> None:
    anchors = sections()
    assert len(set(anchors)) == len(anchors)
    assert set(anchors) == {kind.section.partition("#")[2] for kind in UNDECIDED.values()} | WITHOUT_CODE
    assert {kind.section.partition("#")[0] for kind in UNDECIDED.values()} == {DOCUMENT}


def test_every_code_has_a_request_that_is_answered_with_it() -> None:
    """The requests run against a service with all code blocks of the documentation."""
    text = (ROOT / DOCUMENT).read_text(encoding="utf-8")
    for part in re.split(r"^## ", text, flags=re.MULTILINE)[1:]:
        heading = part.partition("\n")[0].strip()
        if heading in UNDECIDED:
            request, answer = blocks(part)
            assert request.endpoint == "/v1/scenes"
            assert json.loads(answer.code) == {"problem": {"code": heading}}


def test_each_says_what_it_is() -> None:
    for kind in UNDECIDED.values():
        assert kind.title
        assert kind.meaning.endswith(".")
    assert len({kind.title for kind in UNDECIDED.values()}) == len(UNDECIDED)
