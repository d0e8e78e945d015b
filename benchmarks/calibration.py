"""Make service/execution/calibration.json, by which questions are priced, and compare prices with measurements.

    python -m benchmarks.calibration                measure the prices, then check them
    python -m benchmarks.calibration OPERATION...   measure some of them, then check all
    python -m benchmarks.calibration --check        check the prices as they are

Costs per count are fitted to questions of growing size, by least squares of relative errors with no cost below zero.
They are then tried on the questions of examples/, none of which they were fitted to.
"""

from __future__ import annotations

import json
import math
import statistics
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import orjson
from scipy.optimize import nnls

from benchmarks.machine import T_HANDLE, described
from core.bodies import measured as measured_bodies
from core.bodies.measured import PrincipalMoments
from core.errors import MechanicsError
from core.rotation.torque_free import TorqueFree
from core.systems.budget import Budget
from core.systems.error_statements import measured
from core.systems.methods import (
    DiscreteMoserVeselov,
    DormandPrince853,
    ExplicitEuler,
    ImplicitMidpoint,
    Lsoda,
    Radau,
    RungeKutta4,
    SymmetricSplitting,
)
from service.execution import cost_model as pricing
from service.execution.request_handler import RequestHandler
from service.requests.request_reader import Limits
from service.responses.json_rows import written
from service.routes import questions
from service.routes.scene_catalogue import scene_catalogue
from service.routing import PostRoute

ROOT = Path(__file__).parents[1]
TARGET = ROOT / "service" / "execution" / "calibration.json"
PLAN = "/v1/plan"
BODIES: list[dict[str, Any]] = [
    T_HANDLE,
    {"kind": "principal-moments", "moments": [1.0, 2.0, 2.5]},
    {"kind": "inertia-tensor", "tensor": [[2.0, 0.1, 0.2], [0.1, 2.5, 0.3], [0.2, 0.3, 1.8]]},
]
SOLIDS: list[dict[str, Any]] = [
    {"kind": "cuboid", "edges": [1.0, 0.7, 0.3], "mass": 2.0},
    {"kind": "cylinder", "radius": 0.3, "height": 1.0, "density": 7850.0},
    {"kind": "ball", "radius": 0.3, "mass": 1.0},
]
STARTS = [[1.0, 10.0, 1.0], [0.3, 1.0, 0.2], [0.5, 0.1, 2.0]]
STEPS = (0.02, 0.005, 0.001)
TOLERANCES = (1e-4, 1e-7, 1e-10, 1e-13)
SIZES = (1, 30, 1000, 30_000)
FIXED = ("explicit-euler", "runge-kutta-4", "implicit-midpoint", "symmetric-splitting", "discrete-moser-veselov")
CHOOSING = ("dormand-prince-853", "lsoda", "radau")
KINDS = {
    "explicit-euler": ExplicitEuler,
    "runge-kutta-4": RungeKutta4,
    "implicit-midpoint": ImplicitMidpoint,
    "symmetric-splitting": SymmetricSplitting,
    "discrete-moser-veselov": DiscreteMoserVeselov,
    "dormand-prince-853": DormandPrince853,
    "lsoda": Lsoda,
    "radau": Radau,
}


def points(count: int) -> dict[str, Any]:
    """Return a body of point masses."""
    places = np.random.default_rng(0).normal(size=(count, 3)).tolist()
    return {"kind": "point-masses", "masses": [1.0] * count, "positions": places}


def span(count: int, stop: float = 20.0) -> dict[str, float]:
    """Return evenly spaced times."""
    return {"start": 0.0, "stop": stop, "count": count}


def methods() -> list[dict[str, Any]]:
    """Return every integrator with its settings."""
    fixed = [{"kind": kind, "step": step} for kind in FIXED for step in STEPS]
    return fixed + [{"kind": kind, "tolerance": tolerance} for kind in CHOOSING for tolerance in TOLERANCES]


def chain(count: int, angle: float = 0.3) -> dict[str, Any]:
    """Return a chain of points that is let go at an angle; each moves all others."""
    bodies = {f"p{i}": {"mass": 1, "at": [f"{i + 1}*sin({angle})", f"-{i + 1}*cos({angle})"]} for i in range(count)}
    before: list[Any] = [[0, 0], *bodies]
    rods = [{"kind": "rod", "a": name, "b": end} for name, end in zip(bodies, before, strict=False)]
    return {"gravity": [0, -9.81], "bodies": bodies, "connections": rods}


def on_springs(count: int, *, damped: bool = False) -> dict[str, Any]:
    """Return points in a row, each on a spring between it and the one before; a damper may hold the first."""
    bodies = {f"p{i}": {"mass": 1, "at": [i + 1 + 0.1 * (i == 0), 0]} for i in range(count)}
    before: list[Any] = [[0, 0], *bodies]
    found: list[dict[str, Any]] = [
        {"kind": "spring", "a": name, "b": end, "stiffness": 1, "rest_length": 1}
        for name, end in zip(bodies, before, strict=False)
    ]
    damper = {"kind": "damper", "a": "p0", "b": [0, 0], "coefficient": 0.1}
    return {"bodies": bodies, "connections": [*found, damper] if damped else found}


def apart(count: int) -> dict[str, Any]:
    """Return points that fall freely."""
    return {"gravity": [0, -9.81], "bodies": {f"p{i}": {"mass": 1, "at": [i, 0]} for i in range(count)}}


def described_scenes() -> list[dict[str, Any]]:
    """Return described scenes with more and more bodies, followed for longer and sampled more often."""
    found: list[dict[str, Any]] = []
    for count in (1, 2, 4, 8, 16, 32):
        for scene in (chain(count), apart(count)):
            found += [scene, *(scene | {"times": span(n, 1.0)} for n in (1, 30, 1000))]
    found += [chain(count) | {"times": span(30, stop), "accuracy": 0.9} for count in (2, 3, 4) for stop in (3.0, 10.0)]
    found += [
        chain(count) | {"times": span(2, 1.0), "method": method, "accuracy": 0.9}
        for count in (1, 4, 16)
        for method in ({"kind": "runge-kutta-4", "step": 1e-3}, {"kind": "lsoda", "tolerance": 1e-6})
    ]
    for count in (64, 100):
        found += [chain(count), chain(count) | {"times": span(30, 1.0), "accuracy": 0.9}]
    found += [chain(count) | {"times": span(30, 10.0), "accuracy": 0.9} for count in (8, 16)]
    found += [on_springs(count) | {"times": span(30, 1.0)} for count in (4, 32, 100)]
    found += [on_springs(count, damped=True) | {"times": span(30, 1.0)} for count in (4, 32, 64)]
    found += [chain(count) | {"outputs": ["equilibria"]} for count in (1, 2, 3)]
    # Let go from higher they amplify rounding.
    found += [
        chain(count, 1.5) | {"times": span(30, stop), "accuracy": 0.1}
        for count in (2, 3, 5)
        for stop in (3.0, 10.0, 30.0, 40.0)
    ]
    found += [chain(count, 1.5) | {"times": span(30, stop)} for count in (2, 3, 5) for stop in (3.0, 10.0)]
    return found + [dict(one.question) for one in scene_catalogue().values()][::2]


def variants() -> dict[str, list[dict[str, Any]]]:
    """Return questions of growing size, by operation."""
    free = {"body": T_HANDLE, "angular_velocity": STARTS[0]}
    pairs = [{"body": body, "angular_velocity": start} for body, start in zip(BODIES, STARTS, strict=True)]
    bodies = [{"body": body} for body in [*BODIES, points(10), points(1000), points(20_000)]]
    bodies += [{"body": body} for body in SOLIDS]
    trajectory = [
        pair | {"times": span(count)} | more
        for pair in pairs
        for count in SIZES
        for more in ({}, {"attitude": [1.0, 0.0, 0.0, 0.0]}, {"round": 4})
    ]
    trajectory += [free | {"times": span(count, 10.0), "method": method} for method in methods() for count in (3, 3000)]
    trajectory += [{"body": points(20_000), "angular_velocity": STARTS[1], "times": span(3)}]
    many = {"body": BODIES[1]}
    ensemble = [
        many | {"angular_velocities": [STARTS[1]] * m, "times": span(n)} for m, n in ((1, 1), (30, 30), (30, 3000))
    ]
    ensemble += [
        many | {"sample": {"energy": 1.0, "count": m, "seed": 0}, "times": span(n)} for m, n in ((100, 10), (9, 9))
    ]
    ensemble += [
        many | {"angular_velocities": [STARTS[1]] * 9, "times": span(n), "method": method}
        for method in methods()
        for n in (30, 1000)
    ]
    surface = [
        many | {"energy": 1.0, "resolution": n, "layout": layout}
        for n in (2, 16, 100)
        for layout in ("triangles", "grid")
    ]
    surface += [
        many | {"energy": 1.0, "resolution": 2, "polhodes": {"count": n, "seed": 1}, "points": k, "separatrix": True}
        for n in (1, 30)
        for k in (16, 1000)
    ]
    compared = [
        free | {"times": span(n, 5.0), "methods": [method, {"kind": "closed-form"}]}
        for method in methods()
        for n in (3, 300)
    ]
    compared += [pair | {"times": span(n, 10.0)} for pair in pairs[:2] for n in (3, 300)]
    found = {
        "mass_properties": bodies,
        "rotation_trajectory": trajectory,
        "rotation_ensemble": ensemble,
        "precession": pairs
        + [{"body": body, "angular_velocity": STARTS[0]} for body in SOLIDS]
        # Measured for longer than a period, so that the return is found.
        + [
            pair | {"measure": {"method": method, "duration": 30.0, "samples": count, "tolerance": 0.035}}
            for pair in pairs[1:2]
            for method in methods()
            for count in (300, 10_000)
        ],
        "stability": [{"body": body} for body in [*BODIES, *SOLIDS]],
        "energy_ellipsoid": surface,
        "initial_states": [many | {"energy": 1.0, "count": n} for n in SIZES],
        "work_precision": compared,
        "described_scene": described_scenes(),
    }
    for route in questions():
        if own_price(route) is None:
            continue
        own = [dict(e.question) for e in route.examples.values()]
        if route.operation_id.startswith("scene_"):
            grown = [
                entry | {"times": span(n, entry["times"]["stop"])} for entry in own if "times" in entry for n in SIZES
            ]
            own += grown + [entry | {"round": 5} for entry in grown]
        found.setdefault(route.operation_id, []).extend(own)
    return found


def own_price(route: PostRoute) -> pricing.CalibratedCost | None:
    """Return the price by counts of a route; certified routes have another."""
    return route.price if isinstance(route.price, pricing.CalibratedCost) else None


def measured_cost(answering: RequestHandler, route: PostRoute, question: dict[str, Any]) -> tuple[float, int, float]:
    """Return the time of an answer (s), its length, and the time of writing it (s).

    Times are those that the processor gave this thread, and the least of several: what other processes take from a
    loaded machine is no part of a price. What is kept of a body that is asked about again is forgotten each time.
    """
    body = orjson.dumps(question)
    answer = answering.answer(route, answering.read(route, body))
    spent, writing, text = [], [], written(answer)
    begun = time.thread_time()
    while len(spent) < 5 or (len(spent) < 50 and time.thread_time() - begun < 0.05):
        measured_bodies._of_moments.cache_clear()
        start = time.thread_time()
        answer = answering.answer(route, answering.read(route, body))
        middle = time.thread_time()
        text = written(answer)
        spent.append(middle - start)
        writing.append(time.thread_time() - middle)
    return min(spent), len(text), min(writing)


def fitted(rows: list[dict[str, float]], values: list[float]) -> dict[str, float]:
    """Return costs per count by relative least squares, none below zero."""
    names = sorted({name for row in rows for name in row})
    if names == ["question"]:
        # Least squares of relative errors would follow the cheapest of them.
        return {"question": float(f"{statistics.median(values):.4g}")}
    matrix = np.array([[row.get(name, 0.0) for name in names] for row in rows]) / np.array(values)[:, None]
    size = np.maximum(np.abs(matrix).max(axis=0), 1e-300)
    costs = nnls(matrix / size, np.ones(len(values)))[0] / size
    return {name: float(f"{cost:.4g}") for name, cost in zip(names, costs, strict=True)}


def method_table() -> dict[str, dict[str, float]]:
    """Return evaluations and errors of every integrator on free rotations, as straight lines between logarithms."""
    table = {}
    times = np.linspace(0.0, 20.0, 200)
    for kind, method in KINDS.items():
        settings = STEPS if kind in FIXED else TOLERANCES
        work, errors = [], []
        for body, start in zip(BODIES[:2], STARTS[:2], strict=True):
            system = TorqueFree(PrincipalMoments(tuple(body["moments"])).mass_properties(), np.array(start))
            motion, speed = system.closed_form(), math.hypot(*start)
            exact = motion.sample(times)
            for setting in settings:
                try:
                    run = method(setting).integrate(system, times)
                except MechanicsError:
                    continue
                turned = speed * 20.0 + 1.0
                small = setting * speed if kind in FIXED else setting
                per = pricing.steps(times.tolist(), setting) if kind in FIXED else turned
                work.append((math.log(setting), math.log(run.work.evaluations / per)))
                error = measured(run.states, exact, times, motion.largest_norm).largest
                if 1e-13 < error < 0.3:
                    errors.append((math.log(small), math.log(error / turned)))
        slope, start_at = np.polyfit(*np.array(errors).T, 1)
        entry = {"error": float(start_at), "error_exponent": float(slope)}
        if kind in FIXED:
            entry["evaluations"] = math.exp(statistics.mean(value for _, value in work))
        else:
            slope, start_at = np.polyfit(*np.array(work).T, 1)
            entry |= {"evaluations": float(start_at), "exponent": float(slope)}
        table[kind] = {name: round(value, 4) for name, value in entry.items()}
    return table


def main(*operations: str) -> None:
    """Measure, fit and write; all operations unless some are named."""
    routes = {route.operation_id: route for route in questions()}
    answering, budget = RequestHandler(routes.values(), Budget(), Limits()), Budget()
    # What is not measured yet keeps its old costs meanwhile.
    table: dict[str, Any] = json.loads(TARGET.read_text(encoding="utf-8"))
    table["machine"] = described("numpy", "numba")
    if not operations:
        table["methods"] = method_table()
    TARGET.write_text(json.dumps(table, indent=1) + "\n", encoding="utf-8")
    pricing.calibration.cache_clear()
    lengths, writings = [], []
    for operation, asked in variants().items():
        if operations and operation not in operations:
            continue
        rows, times = [], []
        route = routes[operation]
        for question in asked:
            price = own_price(route)
            if price is None:
                continue
            try:
                seconds, length, writing = measured_cost(answering, route, question)
            except MechanicsError:
                continue
            rows.append(dict(price.counts(answering.read(route, orjson.dumps(question)), budget)))
            times.append(seconds)
            if length > 20_000:
                lengths.append(length)
                writings.append(writing)
        if rows:
            table["seconds"][operation] = fitted(rows, times)
            print(operation, len(rows), table["seconds"][operation], flush=True)
    # Reading a body costs the same whatever is asked about it.
    kinds = {body["kind"] for body in [*BODIES, *SOLIDS, points(1)]}
    for costs in table["seconds"].values():
        for kind in (
            kinds & set(table["seconds"]["mass_properties"])
            if {"points", "question"} & set(costs) and len(costs) > 1
            else ()
        ):
            costs.setdefault(kind, table["seconds"]["mass_properties"][kind])
    if writings:
        table["writing"] = float(f"{statistics.median(w / n for w, n in zip(writings, lengths, strict=True)):.3g}")
    TARGET.write_text(json.dumps(table, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
