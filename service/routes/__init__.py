"""The route table; each module contributes its routes."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

from core.scenes.named_scene import NamedScene
from service.routes.assessments import assessing
from service.routes.bodies import BODIES
from service.routes.certified.answers import naming_certified
from service.routes.certified.described import CERTIFIED_DESCRIBED
from service.routes.certified.rotation import CERTIFIED_ROTATION
from service.routes.certified.scenes import certified_scenes
from service.routes.certified.surfaces import CERTIFIED_ELLIPSOID
from service.routes.described_scenes import DESCRIBED_SCENES
from service.routes.examples import examples
from service.routes.find import finding
from service.routes.fits import fitting
from service.routes.interchange import INTERCHANGE
from service.routes.plan import planning
from service.routes.rotation.ensemble import ENSEMBLE
from service.routes.rotation.precession import PRECESSION
from service.routes.rotation.surfaces import SURFACES
from service.routes.rotation.trajectory import ROTATION
from service.routes.rotation.wobble import WOBBLE
from service.routes.scenes import members, scene_routes
from service.routes.sensitivities import with_sensitivities
from service.routes.studies import studying
from service.routes.variants import varying
from service.routes.work_precision import WORK_PRECISION
from service.routing import PostRoute


@cache
def questions(scenes: tuple[type[NamedScene], ...] | None = None) -> tuple[PostRoute, ...]:
    """Return every route that takes a question, in the order of the documentation.

    Their models take a tenth of a second to make, and are the same for every service of a process.

    Parameters
    ----------
    scenes : tuple of type, optional
        The named scenes; those of core's catalogue if omitted.
    """
    scenes = members() if scenes is None else scenes
    certified = (*CERTIFIED_ROTATION, CERTIFIED_ELLIPSOID, *certified_scenes(scenes), CERTIFIED_DESCRIBED)
    paths = [route.path for route in certified]
    rotations = (*BODIES, *ROTATION, *ENSEMBLE, *PRECESSION, *SURFACES, *WOBBLE, *WORK_PRECISION)
    ordinary = (*rotations, *scene_routes(scenes), *DESCRIBED_SCENES)
    in_doubles = tuple(with_sensitivities(naming_certified(route, paths)) for route in ordinary)
    answering = (*in_doubles, *certified)
    find = finding(in_doubles, certified)
    fits = fitting(in_doubles)
    # A question asked backwards is a question that may be planned, graded and varied itself.
    studies = studying((*answering, find, fits))
    about_others = (
        planning((*answering, *INTERCHANGE, find, fits, studies)),
        find,
        fits,
        assessing((*in_doubles, find), certified),
        varying((*in_doubles, find), certified),
        studies,
    )
    shown = examples()
    return tuple(
        replace(route, examples=route.examples or shown[route.operation_id])
        for route in (*answering, *INTERCHANGE, *about_others)
    )
