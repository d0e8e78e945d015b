"""Many double pendulums of two rods, released at rest from random angles, for 10 s: by this project and by its peers.

Run: python -m benchmarks.scene_members [members]. The starts are the same for all, drawn with a fixed seed. Integrators
get the equations in the angles, derived by hand, and MuJoCo links and hinges. The error of a member is the larger
difference of its two angles after 10 s (rad) from the motion by heyoka's Taylor series in 113 bits, of the first
members. Rates are members per second of processor time of one core, the best of three runs; equations, models and
set-ups that members share are made before.
"""

from __future__ import annotations

import json
import os
import sys
import time
from collections.abc import Callable
from importlib.util import find_spec
from typing import Any

import numpy as np

from benchmarks.described_scenes.double_pendulum import END, HALF, INERTIA, ROD, G
from benchmarks.machine import RESULTS, described
from core.arrays import Floats
from core.multibody.language.reading import scene_from
from core.multibody.language.scene import Scene
from core.multibody.members.many import ManyScenes
from core.multibody.members.recorded_balls import Varied
from core.multibody.solve import solve_scene

MEMBERS, JUDGED, ALONE = 1024, 64, 16
PLACES = (("let", "a"), ("let", "b"))
ROUNDED = 2.0**-40
"""Starts are multiples of it, so that their decimals are their doubles."""

Angles = Floats
"""Shape (members, 2)."""


def starts(count: int) -> Angles:
    """Return the angles of both rods, from the horizontal, at the start."""
    drawn = np.random.default_rng(34).uniform(-np.pi, np.pi, (count, 2))
    return np.round(drawn / ROUNDED) * ROUNDED


def scene_of(angles: Any) -> Scene:
    """Return the scene of a member."""
    a, b = angles
    rod = {"mass": 1, "inertia": INERTIA, "places": {"top": [-HALF, 0], "end": [HALF, 0]}}
    bodies = {
        "one": rod | {"at": ["cos(a)/2", "sin(a)/2"], "angle": "a"},
        "two": rod | {"at": ["cos(a) + cos(b)/2", "sin(a) + sin(b)/2"], "angle": "b"},
    }
    pins = [{"kind": "pin", "a": "one.top", "b": [0, 0]}, {"kind": "pin", "a": "two.top", "b": "one.end"}]
    description = {"gravity": [0, -G], "let": {"a": a, "b": b}, "bodies": bodies, "connections": pins}
    return scene_from(description | {"numbers": "doubles"})


def together(accuracy: float) -> Callable[[Angles], tuple[Angles, Floats]]:
    """Return what answers members together: columns, error statement and audit."""
    many = ManyScenes(scene_of([Varied(), Varied()]), PLACES, scene_of)

    def run(angles: Angles) -> tuple[Angles, Floats]:
        found, stated = np.full(angles.shape, np.nan), np.full(len(angles), np.nan)
        for some in many.answered(angles, np.array([END]), accuracy):
            columns, rows = some.motion.columns, some.rows
            for k, name in enumerate(("one.angle", "two.angle")):
                found[some.members, k] = columns[name].values[rows, 0]
            stated[some.members] = np.maximum(*(columns[f"{name}.angle"].error[rows] for name in ("one", "two")))
        return found, stated

    return run


def alone(accuracy: float) -> Callable[[Angles], tuple[Angles, Floats]]:
    """Return what answers members one after another."""

    def run(angles: Angles) -> tuple[Angles, Floats]:
        found, stated = np.empty(angles.shape), np.empty(len(angles))
        for k, own in enumerate(angles.tolist()):
            motion = solve_scene(scene_of(own), [END], ("trajectory",), accuracy).trajectory
            assert motion is not None
            columns = [motion.columns[name] for name in ("one.angle", "two.angle")]
            found[k], stated[k] = [column.values[0] for column in columns], max(column.error for column in columns)
        return found, stated

    return run


def _equations() -> list[Any]:
    import heyoka as hy

    p, q, u, v = hy.make_vars("p", "q", "u", "v")
    c, s = HALF * hy.cos(p - q), HALF * hy.sin(p - q)
    a, b = INERTIA + 1.25, INERTIA + 0.25
    x, y = -s * v * v - 1.5 * G * hy.cos(p), s * u * u - HALF * G * hy.cos(q)
    det = a * b - c * c
    return [(p, u), (q, v), (u, (b * x - c * y) / det), (v, (a * y - c * x) / det)]


def heyoka_batch(tolerance: float) -> Callable[[Angles], Angles]:
    """Return heyoka's batch mode: as many members at a time as registers hold."""
    import heyoka as hy

    width = hy.recommended_simd_size()
    integrator = hy.taylor_adaptive_batch(_equations(), np.zeros((4, width)), tol=tolerance)

    def run(angles: Angles) -> Angles:
        found = np.empty(angles.shape)
        for k in range(0, len(angles), width):
            some = angles[k : k + width]
            integrator.set_time(0.0)
            integrator.state[:] = 0.0
            integrator.state[:2, : len(some)] = some.T
            integrator.propagate_until(END)
            found[k : k + width] = integrator.state[:2, : len(some)].T
        return found

    return run


def heyoka_alone(tolerance: float) -> Callable[[Angles], Angles]:
    """Return heyoka's integrator, one member after another."""
    import heyoka as hy

    integrator = hy.taylor_adaptive(_equations(), [0.0] * 4, tol=tolerance)

    def run(angles: Angles) -> Angles:
        found = np.empty(angles.shape)
        for k, own in enumerate(angles):
            integrator.time = 0.0
            integrator.state[:] = [*own, 0.0, 0.0]
            integrator.propagate_until(END)
            found[k] = integrator.state[:2]
        return found

    return run


def mujoco_rollout(step: float) -> Callable[[Angles], Angles]:
    """Return MuJoCo's rollout, Runge and Kutta's method of order 4."""
    import mujoco
    from mujoco import rollout

    model = mujoco.MjModel.from_xml_string(
        f'<mujoco><compiler angle="radian"/><option gravity="0 0 -{G}" integrator="RK4" timestep="{step}">'
        '<flag contact="disable" constraint="disable"/></option><worldbody>'
        f'<body><joint name="p" axis="0 -1 0"/>{ROD}'
        f'<body pos="1 0 0"><joint name="q" axis="0 -1 0"/>{ROD}</body></body></worldbody></mujoco>'
    )
    data, count = mujoco.MjData(model), round(END / step)
    size = mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_FULLPHYSICS)

    def run(angles: Angles) -> Angles:
        found = np.empty(angles.shape)
        # The states of all steps are returned: members in groups, so that they are megabytes.
        for k in range(0, len(angles), 16):
            some = angles[k : k + 16]
            initial = np.zeros((len(some), size))
            initial[:, 1], initial[:, 2] = some[:, 0], some[:, 1] - some[:, 0]
            states, _ = rollout.rollout(model, data, initial, nstep=count)
            found[k : k + 16, 0] = states[:, -1, 1]
            found[k : k + 16, 1] = states[:, -1, 1] + states[:, -1, 2]
        return found

    return run


def reference(angles: Angles) -> Angles:
    """Return the angles after 10 s by heyoka in 113 bits."""
    import heyoka as hy

    zero = hy.real128(0) if hasattr(hy, "real128") else np.longdouble(0)
    kind = type(zero)
    integrator = hy.taylor_adaptive(_equations(), [zero] * 4, fp_type=kind, tol=kind(1e-25))
    found = np.empty(angles.shape)
    for k, own in enumerate(angles.tolist()):
        integrator.time = kind(0)
        for i, x in enumerate((*own, 0.0, 0.0)):
            integrator.state[i] = kind(x)
        integrator.propagate_until(kind(END))
        found[k] = [float(x) for x in integrator.state[:2]]
    return found


ENTRANTS: dict[str, tuple[str, Callable[[float], Callable[[Angles], Any]], tuple[float, ...], int | None]] = {
    "Polhode, members together": ("numpy", together, (1e-6, 1e-9), None),
    "Polhode, each alone": ("numpy", alone, (1e-6, 1e-9), ALONE),
    "heyoka, batch mode": ("heyoka", heyoka_batch, (1e-9, 1e-15), None),
    "heyoka, one after another": ("heyoka", heyoka_alone, (1e-9, 1e-15), None),
    "MuJoCo rollout, RK4": ("mujoco", mujoco_rollout, (1e-2, 1e-3), 128),
}


def measured(run: Callable[[Angles], Any], angles: Angles) -> tuple[Any, float]:
    """Return the result of a run, and its least processor time of three (s)."""
    result, least = run(angles), np.inf
    for _ in range(3):
        begun = time.process_time()
        result = run(angles)
        least = min(least, time.process_time() - begun)
    return result, float(least)


def main(members: int = MEMBERS) -> None:
    """Measure and write the result."""
    before, angles = os.getloadavg(), starts(members)
    exact = reference(angles[:JUDGED])
    rows: list[dict[str, Any]] = []
    for name, (package, prepare, settings, most) in ENTRANTS.items():
        if find_spec(package) is None:
            continue
        for setting in settings:
            own = angles[: most or members]
            result, seconds = measured(prepare(setting), own)
            found, stated = result if isinstance(result, tuple) else (result, None)
            judged = min(len(own), JUDGED)
            errors = np.abs(found[:judged] - exact[:judged]).max(axis=1)
            known = np.isfinite(errors)
            row: dict[str, Any] = {
                "name": name,
                "setting": setting,
                "members per second": len(own) / seconds,
                "answered": int(np.isfinite(found).all(axis=1).sum()),
                "members": len(own),
                "median error": float(np.median(errors[known])),
                "largest error": float(errors[known].max()),
            }
            if stated is not None:
                row["median stated error"] = float(np.nanmedian(stated))
                row["statements below the error"] = int((errors[known] > stated[:judged][known]).sum())
            rows.append(row)
            print(json.dumps(row), flush=True)
    packages = [name for name in ("numpy", "numba", "heyoka", "mujoco") if find_spec(name)]
    document = {"machine": described(*packages), "load_average": {"before": before, "after": os.getloadavg()}}
    text = json.dumps(document | {"seconds": END, "entrants": rows}, indent=2) + "\n"
    (RESULTS / "scene_members.json").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:2]))
