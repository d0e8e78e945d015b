"""The route table; each module contributes its routes."""

from __future__ import annotations

from service.routing import Question


def questions() -> tuple[Question, ...]:
    """Return every question that can be asked, in the order of the documentation."""
    return ()
