"""What every engine computes: one rigid body in the plane, and what is right to 40 digits.

All have gravity 9.81 m/s^2 downwards, along -y. A body touches with points, or with its rim: an engine gets balls on
the body, and planes shifted by their radius, so that the centres of the balls are what touches.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import mpmath
from mpmath import mpf

G = "9.81"
DIGITS = 40
HIGH = 1e-3
"""Height (m) above which a bouncing ball still bounces; engines have no last bounce."""
SLOW = 1e-2
"""Speed (m/s) above which a disc still slips; some engines have no rolling but a slow slip."""
BETWEEN = 2.2
"""A time (s) at which the bouncing ball is in the air."""


@dataclass(frozen=True)
class ContactCase:
    """One question.

    Attributes
    ----------
    start, rates : tuple of 3 floats
        Place of the centre of mass (m) and angle (rad), counter-clockwise; their rates.
    balls : tuple of (x, y, radius)
        On the body, in its axes (m).
    planes : tuple of (x, y, normal x, normal y)
        What the balls touch.
    scene : mapping
        The same, as `POST /v1/scenes` takes it, without times.
    find_references : callable
        Computes `references`.
    """

    name: str
    note: str
    stop: float
    mass: float
    inertia: float
    start: tuple[float, float, float]
    rates: tuple[float, float, float]
    balls: tuple[tuple[float, float, float], ...]
    planes: tuple[tuple[float, float, float, float], ...]
    scene: Mapping[str, Any]
    friction: float = 0.0
    restitution: float = 0.0
    find_references: Callable[[], Mapping[str, tuple[str, str]]] = dict

    @cached_property
    def references(self) -> Mapping[str, tuple[str, str]]:
        """By name of what is measured: its value at 40 digits, and its unit; empty where mechanics decides nothing."""
        return self.find_references()


def _text(value: Any) -> str:
    return str(mpmath.nstr(value, DIGITS))


def _ladder_references() -> dict[str, tuple[str, str]]:
    """Energy and quadrature: on the wall (1 + 1/3) l phi'^2 = 2 g (cos phi_0 - cos phi), off it x' is constant.

    The time on either side is an integral over the angle phi with the vertical; the length is 2 l.
    """
    with mpmath.workdps(DIGITS + 15):
        g, half, start = mpf(G), mpf("1.5"), mpf("0.5")
        leave = mpmath.acos(2 * mpmath.cos(start) / 3)
        # phi = phi_0 + u^2 takes the root away at the start.
        on_wall = mpmath.quad(
            lambda u: 2 / mpmath.sqrt(_gain(g, half, start, u)), mpmath.linspace(0, mpmath.sqrt(leave - start), 5)
        )
        rate = mpmath.sqrt(3 * g * (mpmath.cos(start) - mpmath.cos(leave)) / (2 * half))
        energy = half * (mpmath.sin(leave) ** 2 + mpf(1) / 3) * rate**2 / 2 + g * mpmath.cos(leave)

        def slowness(phi: Any) -> Any:
            return mpmath.sqrt(half * (mpmath.sin(phi) ** 2 + mpf(1) / 3) / (2 * (energy - g * mpmath.cos(phi))))

        left = mpf("0.8") - on_wall
        end = mpmath.findroot(
            lambda phi: mpmath.quad(slowness, mpmath.linspace(leave, phi, 3)) - left, leave + rate * left
        )
        return {"leaves the wall at": (_text(on_wall), "s"), "angle at 0.8 s": (_text(mpmath.pi / 2 - end), "rad")}


def _gain(g: Any, half: Any, start: Any, u: Any) -> Any:
    """Return phi'^2/u^2 at phi = start + u^2."""
    if not u:
        return 3 * g * mpmath.sin(start) / (2 * half)
    # cos a - cos b = 2 sin((a + b)/2) sin((b - a)/2)
    return 3 * g * mpmath.sin(start + u * u / 2) * mpmath.sin(u * u / 2) / (half * u * u)


def _slip_references() -> dict[str, tuple[str, str]]:
    """Friction slows the disc and turns it until v = omega R: at v_0/(3 mu g), with 2 v_0/3."""
    with mpmath.workdps(DIGITS + 5):
        late = 3 / (3 * mpf("0.2") * mpf(G))
        place = 3 * late - mpf("0.1") * mpf(G) * late**2 + 2 * (1 - late)
        return {
            "rolls from": (_text(late), "s"),
            "slips below 10 mm/s from": (_text(late - mpf("0.01") / (3 * mpf("0.2") * mpf(G))), "s"),
            "velocity at 1 s": ("2", "m/s"),
            "place at 1 s": (_text(place), "m"),
        }


def _bounce_references() -> dict[str, tuple[str, str]]:
    """Parabolas: the n-th arc begins with e^n times the first speed, and lasts 2 e^n times the first fall."""
    with mpmath.workdps(DIGITS + 10):
        g, e = mpf(G), mpf("0.8")
        fall = mpmath.sqrt(mpf("2.5") / g)
        begin, speed, place, last = fall, e * g * fall, None, None
        while last is None:
            late = BETWEEN - begin
            if 0 <= late < 2 * speed / g:
                place = late * (speed - g * late / 2)
            if (e * speed) ** 2 < 2 * g * mpf("0.001"):
                last = begin + (speed + mpmath.sqrt(speed**2 - 2 * g * mpf("0.001"))) / g
            begin, speed = begin + 2 * speed / g, e * speed
        return {
            "rests from": (_text(9 * fall), "s"),
            "last above 1 mm": (_text(last), "s"),
            "height at 2.2 s": (_text(place), "m"),
        }


def _scene(name: str, body: Mapping[str, Any], connections: list[Any], **more: Any) -> dict[str, Any]:
    return {"gravity": [0, -9.81], "bodies": {name: dict(body)}, "connections": connections, **more}


def _floor(place: str, **law: Any) -> dict[str, Any]:
    return {"kind": "contact", "name": "floor", "place": place, "on": {"at": [0, 0]}, **law}


_WALL = {"kind": "contact", "name": "wall", "place": "ladder.head", "on": {"at": [0, 0], "slope": {"degrees": 90}}}
_ENDS = {"foot": [-1.5, 0], "head": [1.5, 0]}
_S, _C = float(1.5 * mpmath.sin(0.5)), float(1.5 * mpmath.cos(0.5))

LADDER = ContactCase(
    "ladder",
    "a smooth ladder of 3 m, 0.5 rad from the wall, slides down and leaves the wall",
    stop=0.8,
    mass=4.0,
    inertia=3.0,
    start=(-_S, _C, float(mpmath.pi / 2) - 0.5),
    rates=(0.0, 0.0, 0.0),
    balls=((-1.5, 0.0, 0.01), (1.5, 0.0, 0.01)),
    planes=((0.0, -0.01, 0.0, 1.0), (0.01, 0.0, -1.0, 0.0)),
    scene=_scene(
        "ladder",
        {"mass": 4, "inertia": 3, "at": ["-s", "c"], "angle": "pi/2 - 0.5", "places": _ENDS},
        [_floor("ladder.foot"), _WALL],
        let={"s": "1.5*sin(0.5)", "c": "1.5*cos(0.5)"},
    ),
    find_references=_ladder_references,
)

SLIP = ContactCase(
    "slip to roll",
    "a disc of 0.1 m thrown at 3 m/s along a floor, friction 0.2, slips until it rolls",
    stop=1.0,
    mass=1.0,
    inertia=0.005,
    start=(0.0, 0.1, 0.0),
    rates=(3.0, 0.0, 0.0),
    balls=((0.0, 0.0, 0.1),),
    planes=((0.0, 0.0, 0.0, 1.0),),
    friction=0.2,
    scene=_scene(
        "disc",
        {"mass": 1, "inertia": 0.005, "radius": 0.1, "at": [0, 0.1], "velocity": [3, 0]},
        [_floor("disc", friction=0.2)],
    ),
    find_references=_slip_references,
)

BOUNCE = ContactCase(
    "bounce",
    "a ball dropped from 1.25 m, restitution 0.8, bounces to rest",
    stop=5.0,
    mass=1.0,
    inertia=0.004,
    start=(0.0, 1.25, 0.0),
    rates=(0.0, 0.0, 0.0),
    balls=((0.0, 0.0, 0.1),),
    planes=((0.0, -0.1, 0.0, 1.0),),
    restitution=0.8,
    scene=_scene("ball", {"mass": 1, "at": [0, 1.25]}, [_floor("ball", restitution=0.8)]),
    find_references=_bounce_references,
)


def _chalk(name: str, note: str, rates: tuple[float, float, float], velocity: list[Any], spin: int) -> ContactCase:
    root = float(mpmath.sqrt(3) / 2)
    return ContactCase(
        name,
        note,
        stop=0.1,
        mass=1.0,
        inertia=0.3333,
        start=(0.5, root, float(mpmath.pi / 3)),
        rates=rates,
        balls=((-1.0, 0.0, 0.001),),
        planes=((0.0, -0.001, 0.0, 1.0),),
        friction=2.0,
        scene=_scene(
            "chalk",
            {
                "mass": 1,
                "inertia": 0.3333,
                "at": [0.5, "sqrt(3)/2"],
                "angle": {"degrees": 60},
                "velocity": velocity,
                "angular_velocity": spin,
                "places": {"foot": [-1, 0]},
            },
            [_floor("chalk.foot", friction=2)],
        ),
    )


PUSHED = _chalk(
    "chalk, no motion",
    "a rod at 60 degrees pushed over a board at 3 m/s towards its lean, friction 2: nothing agrees with the equations",
    (-3.0, 0.0, 0.0),
    [-3, 0],
    0,
)
SPUN = _chalk(
    "chalk, several motions",
    "the same foot, but the rod spins at 5 rad/s: it may slide with a force, or without any",
    (-3.0 - 5.0 * float(mpmath.sqrt(3) / 2), 2.5, 5.0),
    ["-3 - 5*sqrt(3)/2", 2.5],
    5,
)

CASES = (LADDER, SLIP, BOUNCE, PUSHED, SPUN)
