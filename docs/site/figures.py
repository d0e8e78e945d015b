"""Figures of the physics pages: ``python -m docs.site.figures`` writes them to docs/pictures/physics."""

from __future__ import annotations

import json
from collections.abc import Callable
from math import acos, atan, atan2, cos, pi, sin, sqrt

from core.systems.budget import Budget
from docs.site.drawing import Drawing, Point, polar
from docs.site.navigation import DOCS
from service.requests.request_reader import Limits, Reader
from service.responses.svg import SVG
from service.routes import questions

FOLDER = DOCS / "pictures/physics"

STRING, BODY, FORCE, GREY = "#1f4e8c", "#f4f1ea", "#c1440e", "#999"
ALPHA, BETA = 0.5, 0.9
"""Slopes of the wedges that are drawn (rad)."""


def _wedge(drawing: Drawing, apex: Point, ground: float) -> None:
    height = apex[1] - ground
    left = (apex[0] - height * cos(ALPHA) / sin(ALPHA), ground)
    right = (apex[0] + height * cos(BETA) / sin(BETA), ground)
    drawing.line(left, apex, right, left, fill="#eee", colour="#777")
    drawing.arc(left, 52, 0, ALPHA, colour=GREY)
    drawing.text(polar(left, 68, ALPHA / 2), "α")
    drawing.arc(right, 42, pi - BETA, pi, colour=GREY)
    drawing.text(polar(right, 56, pi - BETA / 2), "β")


def unwinding_shafts() -> Drawing:
    """Two shafts on a wedge, the string under both and over the apex."""
    drawing, apex = Drawing(800, 330), (490.0, 285.0)
    _wedge(drawing, apex, 40.0)
    for number, (down, radius, along, side) in enumerate(((200.0, 34.0, pi + ALPHA, 1), (150.0, 44.0, -BETA, -1)), 1):
        contact = polar(apex, down, along)
        normal = along - side * pi / 2
        center = polar(contact, radius, normal)
        drawing.line(apex, contact, colour=STRING, width=3)
        drawing.circle(center, radius, fill=BODY)
        drawing.arc(center, radius, normal - pi, normal - pi - side * 1.6 * pi, colour=STRING, width=3)
        drawing.circle(center, 2.5, fill="#333")
        drawing.text(polar(center, 18, normal + side * 0.9), f"M{'₁₂'[number - 1]}")
        drawing.arrow(center, polar(center, 95, along), colour="#2a6f4e")
        drawing.text(polar(center, 112, along), f"x{'₁₂'[number - 1]}")
        drawing.arrow(contact, polar(contact, 75, along + pi))
        drawing.text(polar(polar(contact, 62, along + pi), 20, normal), "T", colour=FORCE)
        # The string leaves at the face, so that a shaft which unwinds turns as if it rolled down.
        turn = [polar(center, radius + 12, normal + side * (0.1 * i - 0.6)) for i in range(13)]
        drawing.line(*turn, colour="#7a1fa2", width=1.5)
        drawing.arrow(turn[-2], turn[-1], colour="#7a1fa2", width=1.5)
        drawing.text(polar(center, radius + 28, normal), f"θ{'₁₂'[number - 1]}", colour="#7a1fa2")
    drawing.circle(apex, 4, fill=STRING, colour=STRING)
    return drawing


def chain_on_wedge() -> Drawing:
    """A chain over the apex of a wedge, a mass at each end."""
    drawing, apex = Drawing(800, 330), (490.0, 285.0)
    _wedge(drawing, apex, 40.0)
    ends = polar(apex, 230, pi + ALPHA), polar(apex, 130, -BETA)
    for end, along, side, name in ((ends[0], pi + ALPHA, 1, "M₁"), (ends[1], -BETA, -1, "M₂")):
        up = along - side * pi / 2
        drawing.line(apex, end, colour=STRING, width=6, dash="8 3")
        corner = [polar(polar(end, 20 * s, along), 32 * t, up) for s, t in ((-1, 0), (1, 0), (1, 1), (-1, 1), (-1, 0))]
        drawing.line(*corner, fill=BODY)
        drawing.text(polar(end, 16, up), name)
    below = -16.0
    start, end = (polar(point, below, ALPHA + pi / 2) for point in (apex, ends[0]))
    drawing.arrow(start, end, "#2a6f4e", 1.2)
    drawing.text(polar(polar(start, 120, pi + ALPHA), below, ALPHA + pi / 2), "x")
    drawing.text(polar(apex, 90, -BETA + 0.3), "L − x", anchor="start")
    drawing.text((apex[0], apex[1] + 22), "T at the apex", colour=FORCE)
    return drawing


def rod_in_hole() -> Drawing:
    """A rod whose ends are on a half-cylinder, at an angle from its lowest place."""
    drawing, o, a, angle = Drawing(560, 330), (280.0, 285.0), 230.0, -0.45
    half = a / 2
    k = sqrt(a * a - half * half)
    drawing.arc(o, a, pi, 2 * pi, colour="#777", width=3)
    drawing.line((o[0] - a - 20, o[1]), (o[0] - a, o[1]), colour="#777", width=3)
    drawing.line((o[0] + a, o[1]), (o[0] + a + 20, o[1]), colour="#777", width=3)
    drawing.line(o, (o[0], o[1] - a), colour=GREY, dash="5 4")
    c = polar(o, k, -pi / 2 + angle)
    ends = polar(c, half, angle + pi), polar(c, half, angle)
    drawing.line(*ends, width=9, colour="#b9a37a")
    drawing.line(o, c, colour=STRING)
    for end, name in zip(ends, "AB", strict=True):
        drawing.line(o, end, colour=GREY, width=1, dash="3 3")
        drawing.arrow(end, polar(end, 62, atan2(o[1] - end[1], o[0] - end[0])))
        drawing.text(polar(end, 22, atan2(end[1] - o[1], end[0] - o[0])), name)
        drawing.text(polar(end, 66, atan2(o[1] - end[1], o[0] - end[0]) - 0.35), f"N{name}", colour=FORCE)
    drawing.arrow(c, (c[0], c[1] - 62))
    drawing.text((c[0] + 24, c[1] - 52), "Mg", colour=FORCE)
    drawing.circle(c, 4, fill="#333")
    drawing.text((c[0] + 16, c[1] + 16), "C")
    drawing.circle(o, 3, fill="#333")
    drawing.text((o[0] + 16, o[1] + 12), "O")
    drawing.text(polar(polar(o, 0.7 * k, -pi / 2 + angle), 14, angle + pi), "k", colour=STRING)
    drawing.arc(o, 70, -pi / 2 + angle, -pi / 2, colour=GREY)
    drawing.text(polar(o, 88, -pi / 2 + angle / 2), "ψ")
    drawing.text(polar(o, a / 2, pi + acos(0.5) + angle + 0.12), "a", colour=GREY)
    return drawing


def cones() -> Drawing:
    """Space cone and body cone of an oblate and of a prolate body, with the directions of a symmetric body."""
    drawing = Drawing(820, 380)
    # Moments across and along the axis; parts of the angular velocity across and along it.
    bodies = (("oblate (coin)", 1.0, 2.0, 1.0, 1.0, 190.0), ("prolate (football)", 2.0, 1.0, 0.7, 1.0, 590.0))
    for name, across, along, w_across, w_along, x in bodies:
        o, up = (x, 60.0), pi / 2
        momentum, spin = atan(across * w_across / (along * w_along)), atan(w_across / w_along)
        axis = up + momentum
        rate = axis - spin
        drawing.cone(o, axis, spin, 140, "#1f4e8c")
        drawing.cone(o, up, abs(rate - up), 190, "#2a6f4e")
        for direction, length, label, colour in (
            (up, 265, "L", "#2a6f4e"),
            (axis, 225, "e₃", "#1f4e8c"),
            (rate, 235, "ω", "#c1440e"),
        ):
            drawing.arrow(o, polar(o, length, direction), colour=colour)
            drawing.text(polar(o, length + 16, direction), label, colour=colour)
        drawing.text((x, 22), name)
    drawing.text((390, 350), "body cone about e₃", colour="#1f4e8c", size=13)
    drawing.text((390, 330), "space cone about L", colour="#2a6f4e", size=13)
    return drawing


def polhodes() -> str:
    """Return the energy ellipsoid of a body with three moments, with polhodes of both kinds and the separatrix."""
    route = next(route for route in questions() if route.path == "/v1/rotation/energy-ellipsoid")
    body = {"kind": "principal-moments", "moments": [3.0, 2.0, 1.0]}
    question = {"body": body, "energy": 3.0, "polhodes": {"count": 14, "seed": 4}, "separatrix": True, "points": 128}
    read = Reader(route.question, Limits()).read(json.dumps(question).encode())
    return route.representations[SVG](route.handle(read, Budget())).decode()


FIGURES: dict[str, Callable[[], Drawing]] = {
    "unwinding-shafts": unwinding_shafts,
    "chain-on-wedge": chain_on_wedge,
    "rod-in-hole": rod_in_hole,
    "cones": cones,
}


def main() -> None:
    """Write every figure."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    for name, figure in FIGURES.items():
        (FOLDER / f"{name}.svg").write_text(figure().document(), encoding="utf-8")
    (FOLDER / "polhodes.svg").write_text(polhodes(), encoding="utf-8")


if __name__ == "__main__":
    main()
