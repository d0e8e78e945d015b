"""The route table; each module contributes its routes."""

from __future__ import annotations

from service.routes.bodies import BODIES
from service.routes.certified.questions import with_digits
from service.routes.certified.rotation import PRECESSION_IN_DIGITS, STABILITY_IN_DIGITS, TRAJECTORY_IN_DIGITS
from service.routes.certified.scenes import scenes_in_digits
from service.routes.certified.surfaces import ELLIPSOID_IN_DIGITS
from service.routes.plan import planning
from service.routes.rotation.ensemble import ENSEMBLE
from service.routes.rotation.precession import PRECESSION
from service.routes.rotation.surfaces import SURFACES
from service.routes.rotation.trajectory import ROTATION
from service.routes.rotation.wobble import WOBBLE
from service.routes.scenes import questions as about_scenes
from service.routes.work_precision import WORK_PRECISION
from service.routing import PostRoute


def questions() -> tuple[PostRoute, ...]:
    """Return every question that can be asked, in the order of the documentation."""
    plain = (*BODIES, *ROTATION, *ENSEMBLE, *PRECESSION, *SURFACES, *WOBBLE, *WORK_PRECISION, *about_scenes())
    in_digits = {
        "/v1/rotation/trajectory": TRAJECTORY_IN_DIGITS,
        "/v1/rotation/precession": PRECESSION_IN_DIGITS,
        "/v1/rotation/stability": STABILITY_IN_DIGITS,
        "/v1/rotation/energy-ellipsoid": ELLIPSOID_IN_DIGITS,
        **scenes_in_digits(),
    }
    asked = [with_digits(route, in_digits[route.path]) if route.path in in_digits else route for route in plain]
    return (*asked, planning(asked))
