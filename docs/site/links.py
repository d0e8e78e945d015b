"""Pages as the site has them: links follow the pages to their places, and Markdown is what MkDocs reads."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from os.path import relpath
from pathlib import Path, PurePosixPath

from docs.site.navigation import DOCS, ROOT

LINK = re.compile(r"(!?)\[([^\]]*)\]\(([^)#\s]*)(#[^)\s]*)?\)")
FENCE = re.compile(r"^\s*```")
ITEM = re.compile(r"^(?:[-*]|\d+\.) ")

FILES = PurePosixPath("files")
"""Folder of the site for files of the repository that pages link to."""


def linked_files(text: str, source: Path) -> Iterator[Path]:
    """Yield the files of the repository that a page links to, pages and folders included."""
    for _, line in _prose(text):
        for match in LINK.finditer(line):
            if match[3] and "://" not in match[3]:
                yield (source.parent / match[3]).resolve()


def moved(text: str, source: Path, target: str, pages: Mapping[str, Path]) -> str:
    """Return a page for its place on the site.

    Parameters
    ----------
    text : str
    source : Path
        Of the page in the repository.
    target : str
        Of the page on the site.
    pages : mapping
        Sources of all pages by their places on the site.
    """
    places = {page.resolve(): place for place, page in pages.items()}

    def link(match: re.Match[str]) -> str:
        image, shown, address, anchor = match[1], match[2], match[3], match[4] or ""
        if not address or "://" in address:
            return match[0]
        file = (source.parent / address).resolve()
        if file.is_dir():
            return shown
        if file not in places:
            places[file] = str(place_of(file))
        return f"{image}[{shown}]({relpath(places[file], PurePosixPath(target).parent)}{anchor})"

    lines, before = [], ""
    for prose, line in _prose(text):
        # On GitHub a list may follow a paragraph at once; for Python-Markdown it is then part of the paragraph.
        if prose and ITEM.match(line) and before.strip() and not ITEM.match(before) and not before.startswith(" "):
            lines.append("")
        lines.append(LINK.sub(link, line) if prose else line)
        before = line
    return "\n".join(lines) + "\n"


def place_of(file: Path) -> PurePosixPath:
    """Return where the site has a file of the repository that is no page."""
    return PurePosixPath(file.relative_to(DOCS)) if file.is_relative_to(DOCS) else FILES / file.relative_to(ROOT)


def _prose(text: str) -> Iterator[tuple[bool, str]]:
    """Yield the lines of a page, and whether each is outside of fenced code."""
    inside = False
    for line in text.splitlines():
        fence = FENCE.match(line) is not None
        yield not inside and not fence, line
        inside ^= fence
