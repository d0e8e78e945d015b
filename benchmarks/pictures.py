"""Make docs/pictures/t-handle.svg from the answer to the README's question: omega(t) and its polhode.

python -m benchmarks.pictures
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

from core.bodies.measured import PointMasses
from core.rotation.torque_free import TorqueFree
from core.systems.solve import solve

ROOT = Path(__file__).parents[1]
COLOURS = ("#1f4e8c", "#c1440e", "#7a1fa2")
NAMES = ("ω₁", "ω₂", "ω₃")


def polyline(x: np.ndarray, y: np.ndarray, colour: str, width: float = 1.4) -> str:
    """Return points, in pixels, as one line."""
    points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x, y, strict=True))
    return f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="{width}" stroke-linejoin="round"/>'


def curves(times: np.ndarray, states: np.ndarray) -> list[str]:
    """Return the panel of the three components against time."""
    left, width, middle, height = 40.0, 560.0, 150.0, 11.0
    x = left + width * times / times[-1]
    parts = [f'<line x1="{left}" y1="{middle}" x2="{left + width}" y2="{middle}" stroke="#bbb"/>']
    for k, (colour, name) in enumerate(zip(COLOURS, NAMES, strict=True)):
        parts.append(polyline(x, middle - height * states[:, k], colour))
        parts.append(f'<text x="{left + 10 + 40 * k}" y="18" fill="{colour}">{name}</text>')
    for t in range(0, int(times[-1]) + 1, 5):
        parts.append(
            f'<text x="{left + width * t / times[-1]:.0f}" y="288" text-anchor="middle" fill="#555">{t} s</text>'
        )
    for rate in (-10, 0, 10):
        parts.append(
            f'<text x="{left - 6}" y="{middle - height * rate + 4:.0f}" text-anchor="end" fill="#555">{rate}</text>'
        )
    return parts


def polhode(states: np.ndarray, moments: np.ndarray) -> list[str]:
    """Return the panel of the polhode on the energy ellipsoid, seen along (1, 1, 1)/sqrt 3 roughly."""
    view = np.array([[0.82, -0.0, -0.57], [-0.25, 0.9, -0.36]])
    centre = np.array([760.0, 150.0])
    scale = 11.0

    def seen(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        flat = points @ view.T * scale
        return centre[0] + flat[:, 0], centre[1] - flat[:, 1]

    energy = 0.5 * float((moments * states[0] ** 2).sum())
    axes = np.sqrt(2 * energy / moments)
    turn = np.linspace(0, 2 * np.pi, 121)
    parts = []
    for k in range(3):
        for height in np.linspace(-0.75, 0.75, 5):
            ring = np.zeros((turn.size, 3))
            ring[:, k] = height
            ring[:, (k + 1) % 3] = np.sqrt(1 - height**2) * np.cos(turn)
            ring[:, (k + 2) % 3] = np.sqrt(1 - height**2) * np.sin(turn)
            parts.append(polyline(*seen(ring * axes), "#ddd", 0.7))
    parts.append(polyline(*seen(states), "#7a1fa2", 1.8))
    return parts


def main() -> None:
    """Answer the question and draw it."""
    question = json.loads((ROOT / "examples" / "t-handle.json").read_text())
    body = PointMasses(**{k: v for k, v in question["body"].items() if k != "kind"}).mass_properties()
    grid = question["times"]
    times = np.linspace(grid["start"], grid["stop"], grid["count"])
    states = solve(TorqueFree(body, np.array(question["angular_velocity"])), times).state
    moments = np.diag(body.inertia)
    thin = slice(None, None, 20)
    parts = [*curves(times[thin], states[thin]), *polhode(states[: times.size // 4 : 5], moments)]
    svg = (
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 920 300" font-family="sans-serif" font-size="13">'
        '<rect width="920" height="300" fill="white"/>' + "".join(parts) + "</svg>\n"
    )
    target = ROOT / "docs" / "pictures"
    target.mkdir(exist_ok=True)
    (target / "t-handle.svg").write_text(svg)


if __name__ == "__main__":
    main()
