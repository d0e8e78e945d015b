"""What people look at: the pages with their files, and the OpenAPI document behind the reference."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path

from service import VERSION
from service.routing import GetRoute, Reply

FOLDER = Path(__file__).parent.parent / "page"

_MEDIA_TYPES = {".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".txt": "text/plain"}
"""Of the files that are served; others of the folder are not."""

_PAGES = {
    "/": ("index.html", "get_start_page", "Page: a rotating body beside its energy ellipsoid"),
    "/scenes": ("scenes.html", "get_scenes_page", "Every scene of the catalogue in motion, and your own"),
    "/studies": ("studies.html", "get_studies_page", "Studies with their progress, maps, histograms and results"),
    "/docs": ("docs.html", "get_documentation", "The reference of the API, to read and to try"),
}


def pages(openapi: Callable[[], bytes]) -> tuple[GetRoute, ...]:
    """Return the routes of the pages and of their files."""
    document = GetRoute(
        "/openapi.json",
        "get_openapi",
        "The OpenAPI document",
        "pages",
        lambda: Reply(openapi()),
        fixed=True,
        example=lambda: {"openapi": "3.1.0", "info": {"title": "Polhode", "version": VERSION}, "paths": {}},
    )
    documents = [_file(path, FOLDER / name, operation, summary) for path, (name, operation, summary) in _PAGES.items()]
    files = sorted(file for file in FOLDER.rglob("*") if file.suffix in _MEDIA_TYPES and file.suffix != ".html")
    parts = [
        _file(f"/page/{file.relative_to(FOLDER).as_posix()}", file, "get_page_file", "A file of the pages", False)
        for file in files
    ]
    return (document, *documents, *parts)


def _file(path: str, file: Path, operation_id: str, summary: str, documented: bool = True) -> GetRoute:
    media_type = _MEDIA_TYPES[file.suffix]

    @cache
    def content() -> Reply:
        return Reply(file.read_bytes(), f"{media_type}; charset=utf-8".encode())

    return GetRoute(
        path, operation_id, summary, "pages", content, media_type=media_type, documented=documented, fixed=True
    )
