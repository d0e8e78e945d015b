"""What a client probably meant by an unknown name: a misspelling, or another word for the same thing."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from math import isfinite
from typing import Any

from core import near_names

ALIKE_PATHS = 0.6
"""The same of paths, which share most of their letters and of which whole parts are left out."""

SYNONYMS: Mapping[str, tuple[str, ...]] = {
    # Bodies.
    "ball": ("sphere", "solid-sphere"),
    "cuboid": ("box", "block", "brick", "cube", "rectangular-prism"),
    "disc": ("disk", "thin-disk", "plate"),
    "rod": ("bar", "stick", "needle", "thin-rod"),
    "spherical-shell": ("hollow-sphere", "hollow-ball", "shell"),
    "cylindrical-shell": ("hollow-cylinder", "tube", "pipe", "hoop"),
    "torus": ("ring", "donut", "doughnut"),
    "ellipsoid": ("spheroid",),
    "point-masses": ("points", "particles", "point-mass", "masses"),
    "principal-moments": ("moments", "principal", "diagonal"),
    "inertia-tensor": ("tensor", "inertia", "inertia-matrix"),
    "composite": ("compound", "assembly", "group", "union"),
    "mesh": ("triangles", "polyhedron", "stl", "surface"),
    # Methods.
    "closed-form": ("exact", "analytic", "analytical", "jacobi"),
    "explicit-euler": ("euler", "forward-euler", "euler-forward"),
    "runge-kutta-4": ("rk4", "runge-kutta", "rungekutta"),
    "implicit-midpoint": ("midpoint", "gauss-2"),
    "symmetric-splitting": ("splitting", "strang", "symplectic", "leapfrog", "verlet"),
    "discrete-moser-veselov": ("moser-veselov", "dmv", "variational"),
    "dormand-prince-853": ("dop853", "dopri", "dopri8", "dormand-prince", "rk45", "rk8", "ode45"),
    "lsoda": ("odeint", "adams", "bdf"),
    # Scenes and studies.
    "bodies": ("bodys", "body", "objects", "masses", "particles"),
    "connections": ("joints", "constraints", "links", "contacts"),
    "quantiles": ("median", "percentiles", "quartiles"),
    # Quantities.
    "angular_velocity": ("omega", "w", "omega0", "w0", "spin", "rate", "rates", "angular-rate", "angular-speed"),
    "angular_velocities": ("omegas", "spins", "rates"),
    "attitude": ("quaternion", "orientation", "q", "rotation"),
    "axes": ("attitude", "quaternion", "orientation"),
    "at": ("position",),
    "time": ("t", "times"),
    "times": ("t", "time", "duration"),
    "gravity": ("g",),
    "mass": ("m", "weight"),
    "masses": ("m", "mass"),
    "radius": ("r",),
    "radii": ("r", "radius"),
    "length": ("l",),
    "linear_density": ("rho", "density", "lambda"),
    "density": ("rho",),
    "slopes": ("angles", "slope", "inclinations"),
    "moments": ("i", "inertia", "principal-moments"),
    "tensor": ("i", "inertia", "inertia-tensor"),
    "position": ("x", "x0"),
    "positions": ("x",),
    "velocity": ("v", "v0", "speed"),
    "velocities": ("v",),
    "acceleration": ("a",),
    "accelerations": ("a", "acceleration"),
    "tension": ("t", "string-tension"),
    "apex_tension": ("tension", "t"),
    "hole_radius": ("radius", "r", "a"),
    "accuracy": ("tolerance", "tol", "rtol", "precision"),
    "tolerance": ("accuracy", "tol", "rtol"),
    "step": ("dt", "h", "time-step", "step-size"),
    "method": ("integrator", "solver", "algorithm"),
}
"""Other words for a name, exact after case and punctuation."""

STEPS = ("step", "dt", "timestep", "delta", "spacing", "interval", "increment")
"""Names that clients give the spacing of evenly spaced times, where the service takes their number."""

FORCES = (
    "torque", "torques", "externaltorque", "appliedtorque", "moment", "force", "forces", "gravity", "g", "friction",
    "damping", "drag", "control",
)  # fmt: skip
"""Names of forces and torques, which a free rotation does not have."""


def nearest(given: str, names: Iterable[str]) -> str | None:
    """Return the name that a client probably meant, by its letters or by another word; None if none is near."""
    return near_names.nearest(given, names, synonyms=SYNONYMS)


def nearest_path(given: str, paths: Iterable[str]) -> str | None:
    """Return the path that a client probably meant; None if none is near."""
    return near_names.nearest(given, paths, ALIKE_PATHS)


def count_in_place_of_step(span: Any, step: Any) -> str:
    """Return the remedy of evenly spaced times that are given by their distance, computed where it can be."""
    ends = [span.get("start", 0.0), span.get("stop")] if isinstance(span, dict) else [None, None]
    try:
        start, stop, width = (float(x) for x in (*ends, step))
        steps = (stop - start) / width
    except (TypeError, ValueError, OverflowError, ZeroDivisionError):
        steps = -1.0
    if not (isfinite(steps) and 0.0 <= steps <= 1e9):
        return "give count, the number of times with both ends: count = (stop - start)/step + 1"
    count = round(steps) + 1
    even = abs(steps - round(steps)) <= 1e-9 * max(1.0, steps)
    spacing = f", {(stop - start) / (count - 1):g} s apart" if not even and count > 1 else ""
    return f"give the number of times with both ends in its place: count = {count}{spacing}"
