"""Error against time of the peers, one panel per case, as SVG: readable on a light page and on a dark one."""

from __future__ import annotations

from collections.abc import Mapping
from html import escape
from typing import Any

from service.responses.svg import Scale

OURS = "Polhode"
SHOWN = {
    "Polhode": ("#d0021b", "star"),
    "SciPy ellipj, textbook form": ("#8e44ad", "diamond"),
    "Orekit TorqueFree": ("#af7ac5", "diamond"),
    "Dormand-Prince 853, Numba": ("#0b5345", "square"),
    "numbalsoda DOP853": ("#1e8449", "square"),
    "CyRK DOP853": ("#58d68d", "square"),
    "heyoka Taylor": ("#1f4e8c", "square"),
    "diffrax Dopri5": ("#5dade2", "square"),
    "SciPy odeint": ("#e67e22", "circle"),
    "SciPy solve_ivp DOP853": ("#b9770e", "circle"),
    "SciPy solve_ivp Radau": ("#f5b041", "circle"),
    "MuJoCo RK4": ("#424949", "triangle"),
    "MuJoCo implicitfast": ("#909497", "triangle"),
    "Drake RK5, fixed step": ("#6e2c00", "triangle"),
    "Drake RK3": ("#ba4a00", "triangle"),
    "PyBullet": ("#d98880", "triangle"),
}
"""Colour and mark."""
HEADINGS = {
    "star": "this project",
    "diamond": "closed forms",
    "square": "compiled integrators",
    "circle": "SciPy",
    "triangle": "physics engines",
}
LARGEST = 10.0
"""Errors beyond this are off the picture, and named in it."""
NONE_NEAR = 1e-2

PANEL_WIDTH, PANEL_HEIGHT, GAP, LEFT, TOP, LEGEND = 330.0, 330.0, 66.0, 70.0, 46.0, 244.0
ROW_GAP = 84.0


def picture(cases: Mapping[str, Mapping[str, Any]], columns: int = 2) -> str:
    """Return the panels of the cases, side by side, on the same scales, with one legend."""
    shown = {name: drawn(case) for name, case in cases.items()}
    points = [point for curves in shown.values() for curve in curves.values() for point in curve]
    errors = [min(error, LARGEST) for _, error in points]
    rows = -(-len(shown) // columns)
    width = LEFT + columns * PANEL_WIDTH + (columns - 1) * GAP + LEGEND
    height = TOP + rows * PANEL_HEIGHT + (rows - 1) * ROW_GAP + 58.0
    parts = [f'<rect width="{width:g}" height="{height:g}" rx="6" fill="white"/>']
    for k, (name, curves) in enumerate(shown.items()):
        left = LEFT + (k % columns) * (PANEL_WIDTH + GAP)
        top = TOP + (k // columns) * (PANEL_HEIGHT + ROW_GAP)
        x = Scale.over([px for px, _ in points], left, PANEL_WIDTH)
        y = Scale.over([0.2 * min(errors), *errors], top + PANEL_HEIGHT, -PANEL_HEIGHT)
        parts += _panel(name, x, y, left, top)
        for peer, curve in curves.items():
            parts += _curve([point for point in curve if point[1] <= LARGEST], x, y, peer)
        parts += _remarks(curves, x, y)
    parts += _legend(width - LEGEND + 22.0, {peer for curves in shown.values() for peer in curves})
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:g} {height:g}" font-family="sans-serif" '
        'font-size="13">' + "".join(parts) + "</svg>\n"
    )


def drawn(case: Mapping[str, Any]) -> dict[str, list[tuple[float, float]]]:
    """Return the curves of a case, milliseconds and error, in the order of their settings."""
    return {
        peer: [(point["milliseconds"], point["error"]) for point in case["peers"][peer]["points"] if "error" in point]
        for peer in SHOWN
        if peer in case["peers"]
    }


def _panel(name: str, x: Scale, y: Scale, left: float, top: float) -> list[str]:
    bottom, right, angle = top + PANEL_HEIGHT, left + PANEL_WIDTH, "(rad)" if "attitude" in name else "(relative)"
    parts = [f'<text x="{left:g}" y="{top - 14:g}" font-weight="bold">{escape(name)}</text>']
    for exponent in range(x.low, x.high + 1):
        at = f"{x(10.0**exponent):.1f}"
        label = f"{10.0**exponent:g}" if exponent < 4 else f'10<tspan dy="-5" font-size="9">{exponent}</tspan>'
        parts.append(f'<line x1="{at}" y1="{top:g}" x2="{at}" y2="{bottom:g}" stroke="#e8e8e8"/>')
        parts.append(f'<text x="{at}" y="{bottom + 17:g}" text-anchor="middle" fill="#555">{label}</text>')
    for exponent in range(y.low + y.low % 2, y.high + 1, 2):
        at = f"{y(10.0**exponent):.1f}"
        power = f'10<tspan dy="-5" font-size="9">{exponent}</tspan>'
        parts.append(f'<line x1="{left:g}" y1="{at}" x2="{right:g}" y2="{at}" stroke="#e8e8e8"/>')
        parts.append(f'<text x="{left - 7:g}" y="{at}" dy="4" text-anchor="end" fill="#555">{power}</text>')
    parts.append(
        f'<rect x="{left:g}" y="{top:g}" width="{PANEL_WIDTH:g}" height="{PANEL_HEIGHT:g}" fill="none" stroke="#999"/>'
    )
    across, middle, beside = left + PANEL_WIDTH / 2, top + PANEL_HEIGHT / 2, left - 48
    parts.append(f'<text x="{across:g}" y="{bottom + 38:g}" text-anchor="middle">milliseconds for 10000 samples</text>')
    parts.append(
        f'<text x="{beside:g}" y="{middle:g}" transform="rotate(-90 {beside:g} {middle:g})" text-anchor="middle">'
        f"largest error {angle}</text>"
    )
    return parts


def _curve(curve: list[tuple[float, float]], x: Scale, y: Scale, peer: str) -> list[str]:
    colour, mark = SHOWN[peer]
    places = [(x(px), y(py)) for px, py in curve]
    line = " ".join(f"{px:.1f},{py:.1f}" for px, py in places)
    parts = [f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="1.1" stroke-opacity="0.7"/>']
    parts += [_mark(mark, px, py, colour) for px, py in places]
    if peer == OURS and places:
        px, py = places[0]
        bold = f'text-anchor="middle" font-weight="bold" fill="{colour}"'
        parts.append(f'<text x="{px:.1f}" y="{py - 14:.1f}" {bold}>Polhode</text>')
    return parts


def _mark(mark: str, x: float, y: float, colour: str) -> str:
    shapes = {
        "circle": [],
        "square": [(-3.0, -3.0), (3.0, -3.0), (3.0, 3.0), (-3.0, 3.0)],
        "diamond": [(0.0, -5.0), (5.0, 0.0), (0.0, 5.0), (-5.0, 0.0)],
        "triangle": [(0.0, -4.0), (4.0, 3.2), (-4.0, 3.2)],
        "star": [
            (0.0, -10.0), (2.4, -3.2), (9.5, -3.1), (3.8, 1.2), (5.9, 8.1),
            (0.0, 4.0), (-5.9, 8.1), (-3.8, 1.2), (-9.5, -3.1), (-2.4, -3.2),
        ],
    }  # fmt: skip
    if mark == "circle":
        return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3.4" fill="{colour}"/>'
    corners = " ".join(f"{x + dx:.1f},{y + dy:.1f}" for dx, dy in shapes[mark])
    return f'<polygon points="{corners}" fill="{colour}"/>'


def _remarks(curves: Mapping[str, list[tuple[float, float]]], x: Scale, y: Scale) -> list[str]:
    """Return who is off the picture, and that nobody comes near where that is so."""
    parts = []
    right = x.start + x.length - 8.0
    remarks = [
        f"off the picture: {peer}, {max(error for _, error in curve):.0e}"
        for peer, curve in curves.items()
        if any(error > LARGEST for _, error in curve)
    ]
    silent = dict.fromkeys(peer.split()[0] for peer, curve in curves.items() if not curve)
    remarks += [f"no answer: {', '.join(silent)}"] if silent else []
    for k, remark in enumerate(reversed(remarks)):
        parts.append(
            f'<text x="{right:g}" y="{y.start - 8 - 15 * k:.1f}" text-anchor="end" fill="#444" font-size="12">'
            f"{escape(remark)}</text>"
        )
    others = [error for peer, curve in curves.items() if peer != OURS for _, error in curve]
    if others and min(others) > NONE_NEAR:
        parts.append(
            f'<text x="{right:g}" y="{y(NONE_NEAR) + 24:.1f}" text-anchor="end" fill="#444" font-style="italic">'
            "wrong at every setting, whatever it costs</text>"
        )
    return parts


def _legend(left: float, present: set[str]) -> list[str]:
    parts, at, last = [], TOP - 24.0, ""
    for peer in (peer for peer in SHOWN if peer in present):
        colour, mark = SHOWN[peer]
        if mark != last:
            at += 14.0
            parts.append(f'<text x="{left - 6:g}" y="{at:g}" fill="#777" font-size="12">{HEADINGS[mark]}</text>')
            at += 16.0
            last = mark
        weight = ' font-weight="bold"' if peer == OURS else ""
        parts.append(_mark(mark, left + 4.0, at, colour))
        parts.append(f'<text x="{left + 18:g}" y="{at + 4.5:g}" fill="#222"{weight}>{escape(peer)}</text>')
        at += 16.0
    return parts
