"""What people look at: the start page, the documentation, and the OpenAPI document behind it."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path

from service import VERSION
from service.routing import GetRoute, Reply

FOLDER = Path(__file__).parent.parent / "page"

_FILES = {
    "/": ("index.html", "text/html", "get_start_page", "The energy ellipsoid and the polhode of a body, drawn"),
    "/docs": ("docs.html", "text/html", "get_documentation", "This documentation, to read and to try"),
    "/page/polhode.js": ("polhode.js", "text/javascript", "get_page_script", "Script of the start page"),
    "/page/docs.js": ("docs.js", "text/javascript", "get_documentation_script", "Script of the documentation"),
    "/page/style.css": ("style.css", "text/css", "get_page_style", "Style of the pages"),
}


def pages(openapi: Callable[[], bytes]) -> tuple[GetRoute, ...]:
    """Return the routes of the pages."""
    document = GetRoute(
        "/openapi.json",
        "get_openapi",
        "The OpenAPI document",
        "pages",
        lambda: Reply(openapi()),
        example=lambda: {"openapi": "3.1.0", "info": {"title": "Polhode", "version": VERSION}, "paths": {}},
    )
    return (document, *(_page(path, *entry) for path, entry in _FILES.items()))


def _page(path: str, name: str, media_type: str, operation_id: str, summary: str) -> GetRoute:
    @cache
    def content() -> Reply:
        return Reply((FOLDER / name).read_bytes(), f"{media_type}; charset=utf-8".encode())

    return GetRoute(path, operation_id, summary, "pages", content, media_type=media_type)
