"""Mistakes about the scenes: moments of inertia, geometry, potential energy, and what turns beside what slides."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from math import pi, sin, sqrt
from typing import Any

from core.assessment.figures import DESCRIBED
from core.assessment.mistakes import Figure, Mistake

SHAFTS, ROD, CHAIN = "scenes/unwinding-shafts", "scenes/rod-in-hole", "scenes/chain-on-wedge"
AT_HORIZONTAL = "angular_velocity_at_horizontal"
UNIFORM = 1.0 / 12.0
NO_SPIN = 1e12
"""Moment over mass times radius squared beyond which a shaft slides and does not turn."""


def with_fields(subject: str, **fields: Any) -> Callable[[Figure], Iterator[Any]]:
    """Return what asks a scene with other parameters."""

    def wrong(figure: Figure) -> Iterator[Any]:
        if figure.subject == subject and any(figure.request.get(name) != value for name, value in fields.items()):
            yield figure.answered({**figure.request, **fields})

    return wrong


def _hoop(figure: Figure) -> Iterator[Any]:
    if figure.subject == SHAFTS:
        factors = figure.request.get("inertia_factors", [0.5, 0.5])
        if factors in ([0.5, 0.5], [1.0, 1.0]):
            yield figure.answered({**figure.request, "inertia_factors": [1.5 - factors[0]] * 2})


def _rod(figure: Figure) -> Iterator[tuple[float, float, float, float]]:
    """Yield hole radius, length, depth of the centre and gravity of a uniform rod that is released at the rim."""
    request: Mapping[str, Any] = figure.request
    if figure.subject == ROD and figure.name == AT_HORIZONTAL and "angle" not in request:
        a, l, g = (float(request[name]) for name in ("hole_radius", "length", "gravity"))  # noqa: E741
        if request.get("inertia_factor", UNIFORM) == UNIFORM and not request.get("angular_velocity"):
            yield a, l, sqrt((2.0 * a - l) * (2.0 * a + l)) / 2.0, g


def _about_the_end(figure: Figure) -> Iterator[Any]:
    for a, l, k, g in _rod(figure):  # noqa: E741
        yield sqrt(2.0 * g * k * (1.0 - l / (2.0 * a)) / (l * l / 3.0 + k * k))


def _similar_triangles(figure: Figure) -> Iterator[Any]:
    for a, l, k, g in _rod(figure):  # noqa: E741
        energy = g * a * l / (k * k) - 2.0 * g * a * (1.0 - k)
        if energy > 0.0:
            yield sqrt(energy / (l * l / 3.0 + k * k))


def _energy_alone(figure: Figure) -> Iterator[Any]:
    for a, l, k, g in _rod(figure):  # noqa: E741
        energy = g * a * l / (k * k) - 2.0 * g * a * (1.0 - k)
        if energy > 0.0:
            yield sqrt(energy / (a * a - l * l / 6.0))


def _falling_point(figure: Figure) -> Iterator[Any]:
    for a, l, k, g in _rod(figure):  # noqa: E741
        yield sqrt(2.0 * g * (1.0 - l / (2.0 * a)) / k)


def _pairs_exchanged(figure: Figure) -> Iterator[Any]:
    masses = figure.request.get("masses") if isinstance(figure.request, dict) else None
    if figure.subject in (SHAFTS, CHAIN) and isinstance(masses, list) and masses[0] != masses[-1]:
        yield figure.answered({**figure.request, "masses": masses[::-1]})


def _cosines(figure: Figure) -> Iterator[Any]:
    if figure.subject in (SHAFTS, CHAIN):
        slopes = [pi / 2.0 - slope for slope in figure.request["slopes"]]
        yield figure.answered({**figure.request, "slopes": slopes})


def _calculator(figure: Figure) -> Iterator[Any]:
    """Yield a tension with the sines of the degrees' numbers: it is proportional to the sum of the sines."""
    if figure.subject == SHAFTS and figure.path == ("tension",) and not figure.request.get("friction"):
        slopes = figure.request["slopes"]
        right = sum(map(sin, slopes))
        if right > 0.0 and figure.right:
            yield figure.right * sum(sin(180.0 / pi * slope) for slope in slopes) / right


def _no_gravity(figure: Figure) -> Iterator[Any]:
    if figure.subject.startswith("scenes/") and figure.reference.form in ("number", "vector"):
        gravity = figure.request.get("gravity")
        if figure.reference.unit in ("N", "m s^-2") and type(gravity) in (int, float) and gravity:
            yield figure.right / gravity


def _inertia_left_out(figure: Figure) -> Iterator[Any]:
    """Yield the figure of a described scene of the plane whose bodies have mass, and no moment of inertia."""
    bodies = figure.request.get("bodies") if figure.subject == DESCRIBED else None
    if isinstance(bodies, dict):
        light = {name: {**body, "inertia": 0} if "inertia" in body else body for name, body in bodies.items()}
        if light != bodies:
            yield figure.answered({**figure.request, "bodies": light})


OF_SCENES = (
    Mistake(
        "inertia-left-out",
        "A pulley without inertia, or a wheel that slides: all moments of inertia left out.",
        _inertia_left_out,
    ),
    Mistake(
        "shafts-do-not-turn",
        "Point masses on an Atwood machine in place of shafts that turn.",
        with_fields(SHAFTS, inertia_factors=[NO_SPIN, NO_SPIN]),
    ),
    Mistake("hoop-for-solid-shaft", "The moment of a thin tube for a solid shaft, or the reverse.", _hoop, credit=0.5),
    Mistake(
        "rod-inertia-about-end",
        "M l^2/3, the moment of a rod about its end, for that about its centre.",
        _about_the_end,
        credit=0.5,
    ),
    Mistake(
        "rod-depth-and-inertia",
        "The depth of the centre at release by the wrong pair of sides, a potential with unequal dimensions, and the "
        "moment about the end.",
        _similar_triangles,
    ),
    Mistake(
        "rod-depth",
        "The depth of the centre at release by the wrong pair of sides, with the right moment.",
        _energy_alone,
        credit=0.25,
    ),
    Mistake("rod-without-own-rotation", "The rod's mass at its centre: no moment of its own.", _falling_point),
    Mistake("masses-exchanged", "The two masses exchanged.", _pairs_exchanged, credit=0.5),
    Mistake("sine-for-cosine", "The cosine of a slope for its sine, or an angle measured from the vertical.", _cosines),
    Mistake(
        "calculator-in-radians", "Sines of angles in degrees by a calculator set to radians.", _calculator, credit=0.5
    ),
    Mistake("without-gravity", "The acceleration of free fall left out.", _no_gravity),
)
