"""Cost against error, from forward Euler to a thousand digits: the T-handle, 1000 samples over 20 s.

    python -m benchmarks.dial

writes benchmarks/results/dial.json and docs/pictures/dial.svg. Errors of doubles are measured against ball arithmetic
at 40 digits; those of ball arithmetic are what it proves. Times are medians, everything in one process and one run,
and include the set-up. Steps are halved until a run takes two seconds.
"""

from __future__ import annotations

import json
import math
import time
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.machine import RESULTS, described, medians
from core.bodies.mass_properties import PrincipalInertia, diagonal
from core.certified.free_rotation import CertifiedRotation
from core.errors import MechanicsError
from core.rotation.free_rotation import FreeRotation
from core.rotation.torque_free import TorqueFree
from core.systems.methods import DormandPrince853, ExplicitEuler, ImplicitMidpoint, RungeKutta4, SymmetricSplitting
from core.systems.methods.method import AbstractMethod

PICTURE = Path(__file__).parents[1] / "docs" / "pictures" / "dial.svg"
MOMENTS = (795.792181070, 713.509259259, 395.782921811)
START = (1.0, 10.0, 1.0)
TIMES = np.linspace(0.0, 20.0, 1000)
LONGEST = 2.0
REPEATS = 5

STEPS = [2.0**-k for k in range(6, 23)]
SETTINGS: dict[str, list[AbstractMethod]] = {
    "explicit Euler": [ExplicitEuler(step) for step in STEPS],
    "implicit midpoint": [ImplicitMidpoint(step) for step in STEPS],
    "symmetric splitting": [SymmetricSplitting(step) for step in STEPS],
    "Runge-Kutta 4": [RungeKutta4(step) for step in STEPS],
    "Dormand-Prince 853": [DormandPrince853(10.0**-k) for k in range(2, 15)],
}
DIGITS = (16, 20, 30, 50, 70, 100, 150, 200, 300, 500, 700, 1000)


def reference() -> np.ndarray:
    """Return the motion as pairs of doubles, value and tail, shape (n, 3, 2): right to 1e-32."""
    rows = CertifiedRotation.of_moments(MOMENTS, START).angular_velocity([float(t) for t in TIMES], 40)
    pairs = []
    for row in rows:
        exact = [Fraction(x) for x in row]
        pairs.append([(float(x), float(x - Fraction(float(x)))) for x in exact])
    return np.array(pairs)


def error(states: np.ndarray, true: np.ndarray) -> float:
    """Return the largest error of any sample, relative to the largest norm."""
    wrong = (states - true[..., 0]) - true[..., 1]
    return float(np.max(np.linalg.norm(wrong, axis=1)) / np.max(np.linalg.norm(true[..., 0], axis=1)))


def timed(run: Callable[[], object]) -> float:
    """Return the median time of a run; a long one is taken once."""
    run()
    start = time.perf_counter()
    run()
    once = time.perf_counter() - start
    return once if once > 0.2 else medians({"": run}, REPEATS)[""]


def integrators(true: np.ndarray) -> list[dict[str, Any]]:
    """Measure every integrator with every setting until it takes too long."""
    system = TorqueFree(diagonal(MOMENTS), np.array(START))
    points = []
    for name, methods in SETTINGS.items():
        for method in methods:
            try:
                states = method.integrate(system, TIMES).states
            except MechanicsError:
                continue
            wrong = error(states, true)
            spent = timed(lambda m=method: m.integrate(system, TIMES))  # type: ignore[misc]
            if wrong < 2.0:
                points.append({"method": name, "setting": repr(method), "error": wrong, "milliseconds": 1e3 * spent})
            if spent > LONGEST:
                break
    return points


def closed_forms(true: np.ndarray) -> list[dict[str, Any]]:
    """Measure the closed form in doubles and in ball arithmetic."""

    def doubles() -> np.ndarray:
        return FreeRotation(PrincipalInertia.of(np.diag(np.array(MOMENTS))), np.array(START)).sample(TIMES)

    points = [
        {
            "method": "closed form, doubles",
            "setting": "",
            "error": error(doubles(), true),
            "milliseconds": 1e3 * timed(doubles),
        }
    ]
    instants = [float(t) for t in TIMES]
    for digits in DIGITS:

        def balls(digits: int = digits) -> object:
            return CertifiedRotation.of_moments(MOMENTS, START).angular_velocity(instants, digits)

        points.append(
            {
                "method": "closed form, ball arithmetic",
                "setting": f"digits={digits}",
                # As an exponent of ten, because no double holds 1e-1000.
                "log10 error": math.log10(5.1) - digits,
                "milliseconds": 1e3 * timed(balls),
            }
        )
    return points


def correct_digits(point: dict[str, Any]) -> float:
    """Return -log10 of the error."""
    return -point["log10 error"] if "log10 error" in point else -math.log10(point["error"])


COLOURS = {
    "explicit Euler": "#c1440e",
    "implicit midpoint": "#d9a400",
    "symmetric splitting": "#7a8b2a",
    "Runge-Kutta 4": "#2a6f4e",
    "Dormand-Prince 853": "#1f4e8c",
    "closed form, doubles": "#000000",
    "closed form, ball arithmetic": "#7a1fa2",
}


def picture(points: list[dict[str, Any]]) -> str:
    """Return the drawing: correct digits across, milliseconds up, both logarithmic, and the cheapest way along."""
    left, top, width, height = 70.0, 20.0, 640.0, 380.0
    fewest, most = 0.3, 1200.0
    least, largest = 0.01, 3000.0

    def x(digits: float) -> float:
        return left + width * math.log(max(digits, fewest) / fewest) / math.log(most / fewest)

    def y(milliseconds: float) -> float:
        return top + height * (1 - math.log(milliseconds / least) / math.log(largest / least))

    parts = []
    for digits in (0.5, 1, 2, 5, 10, 16, 30, 100, 300, 1000):
        at = x(digits)
        parts.append(f'<line x1="{at:.1f}" y1="{top}" x2="{at:.1f}" y2="{top + height}" stroke="#e5e5e5"/>')
        parts.append(f'<text x="{at:.1f}" y="{top + height + 18}" text-anchor="middle" fill="#555">{digits:g}</text>')
    for k in range(-2, 4):
        at = y(10.0**k)
        parts.append(f'<line x1="{left}" y1="{at:.1f}" x2="{left + width}" y2="{at:.1f}" stroke="#e5e5e5"/>')
        parts.append(f'<text x="{left - 8}" y="{at + 4:.1f}" text-anchor="end" fill="#555">{10.0**k:g}</text>')
    middle = left + width / 2
    parts.append(
        f'<text x="{middle}" y="{top + height + 40}" text-anchor="middle">'
        "correct digits of the worst of 1000 samples</text>"
    )
    parts.append(
        f'<text x="18" y="{top + height / 2}" transform="rotate(-90 18 {top + height / 2})" '
        'text-anchor="middle">milliseconds</text>'
    )
    drawn = [point for point in points if correct_digits(point) > fewest]
    front, best = [], math.inf
    for point in sorted(drawn, key=correct_digits, reverse=True):
        if point["milliseconds"] < best:
            best = point["milliseconds"]
            front.append(point)
    line = " ".join(f"{x(correct_digits(p)):.1f},{y(p['milliseconds']):.1f}" for p in front)
    parts.append(f'<polyline points="{line}" fill="none" stroke="#bbb" stroke-width="7" stroke-linejoin="round"/>')
    for k, (method, colour) in enumerate(COLOURS.items()):
        own = [p for p in drawn if p["method"] == method]
        path = " ".join(f"{x(correct_digits(p)):.1f},{y(p['milliseconds']):.1f}" for p in own)
        parts.append(f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="1"/>')
        radius = 5 if method == "closed form, doubles" else 3
        parts += [
            f'<circle cx="{x(correct_digits(p)):.1f}" cy="{y(p["milliseconds"]):.1f}" r="{radius}" fill="{colour}"/>'
            for p in own
        ]
        parts.append(f'<text x="{left + width + 14}" y="{top + 20 + 22 * k}" fill="{colour}">{method}</text>')
    return (
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 930 450" font-family="sans-serif" font-size="13">'
        '<rect width="930" height="450" fill="white"/>' + "".join(parts) + "</svg>\n"
    )


def main() -> None:
    """Measure, write, draw."""
    true = reference()
    points = integrators(true) + closed_forms(true)
    result = {
        "machine": described("numpy", "numba", "python-flint"),
        "question": {"moments": MOMENTS, "angular_velocity": START, "stop": 20.0, "samples": TIMES.size},
        "points": points,
    }
    (RESULTS / "dial.json").write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    PICTURE.parent.mkdir(parents=True, exist_ok=True)
    PICTURE.write_text(picture(points), encoding="utf-8")
    for point in points:
        print(f"{point['method']:30} {correct_digits(point):8.2f} digits {point['milliseconds']:10.3f} ms")


if __name__ == "__main__":
    main()
