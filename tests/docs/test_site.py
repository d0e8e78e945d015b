"""The pages of the site: each has a place, every link leads somewhere, and the reference lists everything."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from core.multibody.undecided import UNDECIDED
from docs.site import thumbnails
from docs.site.__main__ import write
from docs.site.figures import FIGURES, FOLDER, polhodes
from docs.site.links import linked_files, moved
from docs.site.navigation import DOCS, GENERATED, ROOT, navigation, pages
from docs.site.reference import reference
from docs.site.thumbnails import answer_of, thumbnail
from service.problem_types import REGISTRY
from service.settings import Settings

NUMBER = re.compile(r"-?\d+\.\d+")


def paths_in(entry: Any) -> Iterator[str]:
    """Yield the paths of a navigation."""
    if isinstance(entry, str):
        yield entry
    else:
        for inner in entry.values() if isinstance(entry, dict) else entry:
            yield from paths_in(inner)


def test_every_page_has_one_place_in_the_navigation() -> None:
    assert sorted(paths_in(navigation())) == sorted([*pages(), *GENERATED])


@pytest.mark.parametrize("place", pages())
def test_every_linked_file_exists(place: str) -> None:
    page = pages()[place]
    assert [file for file in linked_files(page.read_text(), page) if not file.exists()] == []


def test_links_follow_the_pages() -> None:
    sources = {"index.md": ROOT / "README.md", "physics/wobble.md": DOCS / "physics/wobble.md"}
    text = (
        "[a](docs/physics/wobble.md#the-earth) [b](examples/t-handle.json) [c](examples) [d](http://x) [e](#e)\nx\n- y"
    )
    assert moved(text, ROOT / "README.md", "index.md", sources) == (
        "[a](physics/wobble.md#the-earth) [b](files/examples/t-handle.json) c [d](http://x) [e](#e)\nx\n\n- y\n"
    )
    back = moved(
        "[README](../../README.md)\n```sh\n- [x](y)\n```", DOCS / "physics/wobble.md", "physics/wobble.md", sources
    )
    assert back == "[README](../index.md)\n```sh\n- [x](y)\n```\n"


def test_the_reference_lists_all_endpoints_objects_problems_and_settings() -> None:
    texts = [reference()[place] for place in GENERATED]
    document = json.loads((DOCS / "openapi.json").read_text())
    listed = set(re.findall(r"^### (\w+ \S+)$", texts[0], re.MULTILINE))
    assert listed == {f"{method.upper()} {path}" for path, methods in document["paths"].items() for method in methods}
    assert set(re.findall(r"^## (\w+)$", texts[1], re.MULTILINE)) == set(document["components"]["schemas"])
    assert set(re.findall(r"^\| `([a-z-]+)`", texts[2], re.MULTILINE)) == set(REGISTRY)
    sections = re.findall(r"^\| \[`[a-z-]+`\]\((\S+)#([a-z-]+)\)", texts[2], re.MULTILINE)
    assert sections == [("../physics/undecided.md", code) for code in UNDECIDED]
    variables = {f"POLHODE_{name.upper()}" for name in Settings.model_fields}
    assert set(re.findall(r"^\| `(\w+)`", texts[3], re.MULTILINE)) == variables
    # A link in a table leads to an object.
    assert set(re.findall(r"objects\.md#(\w+)", "".join(texts))) <= {
        name.lower() for name in document["components"]["schemas"]
    }


def test_what_is_written_is_what_mkdocs_reads(tmp_path: Path) -> None:
    write(tmp_path)
    for place in paths_in(navigation()):
        text = (tmp_path / "pages" / place).read_text()
        assert text.startswith("# "), place
        for image in re.findall(r"!\[[^\]]*\]\(([^)]+)\)", text):
            assert ((tmp_path / "pages" / place).parent / image).exists()
    configuration = (tmp_path / "mkdocs.yml").read_text()
    assert "nav: [" in configuration
    for line in re.findall(r"^extra_(?:css|javascript): \[(.*)\]$", configuration, re.MULTILINE):
        assert [name for name in line.split(", ") if not (tmp_path / "pages" / name).exists()] == []


@pytest.mark.parametrize("name", FIGURES)
def test_figures_are_those_of_the_script(name: str) -> None:
    assert (FOLDER / f"{name}.svg").read_text() == FIGURES[name]().document(), "run python -m docs.site.figures"


def test_the_polhodes_are_those_that_the_service_draws() -> None:
    drawn, kept = polhodes(), (FOLDER / "polhodes.svg").read_text()
    assert NUMBER.sub("", drawn) == NUMBER.sub("", kept)
    ours, theirs = ([float(x) for x in NUMBER.findall(text)] for text in (drawn, kept))
    # Pixels are rounded to tenths.
    assert ours == pytest.approx(theirs, abs=0.11)


def test_a_thumbnail_is_the_path_of_its_scene() -> None:
    # Pixels are whole numbers; a yo-yo falls along a line.
    assert thumbnail(answer_of("yo-yo")) == (thumbnails.FOLDER / "yo-yo.svg").read_text()
