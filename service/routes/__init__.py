"""The route table; each module contributes its routes."""

from __future__ import annotations

from service.routes.bodies import BODIES
from service.routes.ensemble import ENSEMBLE
from service.routes.precession import PRECESSION
from service.routes.rotation import ROTATION
from service.routes.scenes import questions as about_scenes
from service.routes.surfaces import SURFACES
from service.routes.wobble import WOBBLE
from service.routes.work_precision import WORK_PRECISION
from service.routing import Question


def questions() -> tuple[Question, ...]:
    """Return every question that can be asked, in the order of the documentation."""
    return (*BODIES, *ROTATION, *ENSEMBLE, *PRECESSION, *SURFACES, *WOBBLE, *WORK_PRECISION, *about_scenes())
