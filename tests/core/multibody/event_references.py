"""Times of the events of worked scenes with contacts: by hand and in mpmath at 40 digits, with their conditioning.

python -m tests.core.multibody.event_references   (prints the table)

Every reference is a function of the numbers of its scene, written as decimals. Its conditioning is the sum of the
relative changes of the time by relative changes of each number.

References
----------
D. Morin, Introduction to Classical Mechanics (2008), chapters 4 (pendulum), 5 (impacts), 8 (rolling). The stone on a
slope: its hodograph, see tests/examples/test_scenes_of_contacts.py.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import mpmath
from mpmath import mpf

from core.multibody.language.reading import scene_from
from core.multibody.solve import solve_scene
from core.systems.trajectory import MotionEvent

SCENES = Path(__file__).parents[3] / "examples" / "scenes"
DIGITS = 40
UNIT = 2.0**-53
G = "9.81"

Times = Callable[..., list[Any]]


@dataclass(frozen=True)
class Reference:
    """The times of all events of a scene.

    Attributes
    ----------
    times : callable
        From the numbers, by name, to the times in their order.
    numbers : mapping of str to str
        The decimals of the scene.
    """

    scene: str
    times: Times
    numbers: Mapping[str, str]


def smooth(square: Callable[[Any], Any], end: Any) -> Any:
    """Return the time from rest at 0 to `end` where theta'^2 = square(theta): theta = u^2 takes the root away."""
    tiny = mpf(10) ** (-2 * DIGITS)

    def slowness(u: Any) -> Any:
        # At rest the square vanishes like theta.
        theta = max(u * u, tiny)
        return 2 / mpmath.sqrt(square(theta) / theta)

    return mpmath.quad(slowness, mpmath.linspace(0, mpmath.sqrt(end), 4))


def cosines(start: Any, theta: Any) -> Any:
    """Return cos(start) - cos(start + theta) without cancellation."""
    return 2 * mpmath.sin(start + theta / 2) * mpmath.sin(theta / 2)


def ladder(g: Any, half: Any, start: Any, mass: Any, inertia: Any) -> list[Any]:
    """(m l^2 + I) phi'^2 = 2 m g l (cos phi_0 - cos phi), up to cos phi = 2/3 cos phi_0."""
    end = mpmath.acos(2 * mpmath.cos(start) / 3) - start
    factor = 2 * mass * g * half / (mass * half**2 + inertia)
    return [smooth(lambda theta: factor * cosines(start, theta), end)]


def rolls(g: Any, friction: Any, v: Any, spin: Any, radius: Any, mass: Any, inertia: Any) -> list[Any]:
    """The slip v + R omega is taken away at mu g (1 + m R^2/I)."""
    return [(v + radius * spin) / (friction * g * (1 + mass * radius**2 / inertia))]


def bounces(g: Any, height: Any, e: Any, listed: int = 12) -> list[Any]:
    """A geometric series; its first impacts, and its limit."""
    fall = mpmath.sqrt(2 * height / g)
    return [fall * (1 + 2 * e * (1 - e**k) / (1 - e)) for k in range(listed)] + [fall * (1 + e) / (1 - e)]


def falls(times: int) -> Times:
    """All events at the end of a free fall."""
    return lambda g, height: [mpmath.sqrt(2 * height / g)] * times


def slackens(g: Any, length: Any, v: Any) -> list[Any]:
    """theta'^2 = v^2/l^2 - 2 g (1 - cos theta)/l, up to cos theta = (2 g l - v^2)/(3 g l)."""
    end = mpmath.acos((2 * g * length - v**2) / (3 * g * length))
    rate = lambda theta: mpmath.sqrt((v / length) ** 2 - 2 * g * (1 - mpmath.cos(theta)) / length)  # noqa: E731
    return [mpmath.quad(lambda theta: 1 / rate(theta), mpmath.linspace(0, end, 5))]


def slides_up(g: Any, v: Any, degrees: Any, friction: Any) -> list[Any]:
    slope = degrees * mpmath.pi / 180
    return [v / (g * (mpmath.sin(slope) + friction * mpmath.cos(slope)))]


def taken_along(g: Any, v: Any, friction: Any, block: Any, plank: Any) -> list[Any]:
    return [v / (friction * g * (1 + block / plank))]


def half_swings(mass: Any, stiffness: Any) -> list[Any]:
    """Half a period of the spring for every way of the block."""
    return [k * mpmath.pi * mpmath.sqrt(mass / stiffness) for k in range(1, 6)]


def leaves_cylinder(g: Any, radius: Any, start: Any) -> list[Any]:
    """theta'^2 = 2 g (cos theta_0 - cos theta)/R, up to cos theta = 2/3 cos theta_0."""
    end = mpmath.acos(2 * mpmath.cos(start) / 3) - start
    return [smooth(lambda theta: 2 * g * cosines(start, theta) / radius, end)]


def lands(g: Any, a: Any, b: Any, inertia: Any, radius: Any, drop: Any) -> list[Any]:
    """The heavier one falls and rests; the lighter one goes on with the wheel, and returns."""
    wheel = inertia / radius**2
    pull, back = (b - a) * g / (a + b + wheel), a * g / (a + wheel)
    landing = mpmath.sqrt(2 * drop / pull)
    taut = landing + 2 * pull * landing / back
    return [landing, landing, taut, taut, taut]


def blocks(light: Any, heavy: Any, x: Any, y: Any, v: Any, radius: Any) -> list[Any]:
    """A light block between a wall and a heavy one: elastic impacts, one by one."""
    place, other, rate, speed, now, found = x - radius, y - 3 * radius, mpf(0), v, mpf(0), []
    while len(found) < 31:
        meets = (other - place) / (rate - speed) if rate > speed else mpmath.inf
        walls = -place / rate if rate < 0 else mpmath.inf
        step = min(meets, walls)
        now, place, other = now + step, place + rate * step, other + speed * step
        found.append(now)
        if meets < walls:
            total = light + heavy
            rate, speed = (
                ((light - heavy) * rate + 2 * heavy * speed) / total,
                ((heavy - light) * speed + 2 * light * rate) / total,
            )
        else:
            rate = -rate
    return found


def quarters(g: Any, length: Any, amplitude: Any) -> list[Any]:
    """A pendulum meets the other one at the bottom: after one and after three quarters of a period."""
    quarter = mpmath.ellipk(mpmath.sin(amplitude / 2) ** 2) * mpmath.sqrt(length / g)
    return [quarter, 3 * quarter]


def flies(x: Any, radius: Any, v: Any) -> list[Any]:
    return [(x - radius) / v]


def tilted(g: Any, height: Any, half: Any, angle: Any) -> list[Any]:
    return [mpmath.sqrt(2 * (height - half * mpmath.sin(angle)) / g)]


def turned(g: Any, height: Any, half: Any, axis: Any) -> list[Any]:
    return [mpmath.sqrt(2 * (height - half * axis) / g)]


def slips_off(g: Any, a: Any, friction: Any) -> list[Any]:
    """tan(theta) = mu I/(I + 3 m a^2); (I + m a^2) theta'^2 = 2 m g a sin theta, for m = 1 and I = 1/12."""
    inertia = mpf(1) / 12
    end = mpmath.atan(friction * inertia / (inertia + 3 * a**2))
    return [smooth(lambda theta: 2 * g * a * mpmath.sin(theta) / (inertia + a**2), end)]


def falls_to_stop(g: Any, mass: Any, inertia: Any, a: Any, end: Any) -> list[Any]:
    return [smooth(lambda theta: 2 * mass * g * a * mpmath.sin(theta) / (inertia + mass * a**2), end)]


def ball_rolls(g: Any, friction: Any, v: Any, x: Any, y: Any, radius: Any) -> list[Any]:
    """The slip (v - R omega_y, R omega_x) of a uniform ball is taken away at 7/2 mu g."""
    return [2 * mpmath.hypot(v - radius * y, radius * x) / (7 * friction * g)]


def stops_on_slope(g: Any, angle: Any, v: Any, friction: Any) -> list[Any]:
    rub, pull = friction * g * mpmath.cos(angle), g * mpmath.sin(angle)
    return [v * rub / (rub**2 - pull**2)]


BOUNCE, PLANK = (
    {"g": G, "height": "1.25", "e": "0.8"},
    {"g": G, "v": "2", "friction": "0.3", "block": "1", "plank": "4"},
)
DISC = {"g": G, "friction": "0.2", "radius": "0.1", "mass": "1", "inertia": "0.005"}
STONE = {"g": G, "length": "0.5", "v": "4"}

REFERENCES = (
    Reference("ladder-leaves-wall", ladder, {"g": G, "half": "1.5", "start": "0.5", "mass": "4", "inertia": "3"}),
    Reference("slip-to-roll", rolls, DISC | {"v": "3", "spin": "0"}),
    Reference("backspin-returns", rolls, DISC | {"v": "1", "spin": "50"}),
    Reference("bounce-to-rest", bounces, BOUNCE),
    Reference("ball-bounces-with-spin", bounces, BOUNCE | {"height": "1", "e": "0.6"}),
    Reference("spinning-disc-bounces", falls(1), {"g": G, "height": "1"}),
    Reference("ball-on-ball-dropped", falls(3), {"g": G, "height": "1"}),
    Reference("dumbbell-dropped", tilted, {"g": G, "height": "2", "half": "1", "angle": "0.3"}),
    Reference("dumbbell-dropped-in-space", turned, {"g": G, "height": "1", "half": "0.5", "axis": "0.6"}),
    Reference("loop-with-slack-string", slackens, STONE),
    Reference("stone-leaves-hollow-sphere", slackens, STONE),
    Reference("block-up-rough-incline", slides_up, {"g": G, "v": "4", "degrees": "30", "friction": "0.3"}),
    Reference("block-on-plank", taken_along, PLANK),
    Reference("block-on-plank-in-space", taken_along, PLANK),
    Reference("block-on-spring-with-friction", half_swings, {"mass": "1", "stiffness": "25"}),
    Reference("disc-leaves-cylinder", leaves_cylinder, {"g": G, "radius": "1.2", "start": "0.2"}),
    Reference("weight-lands", lands, {"g": G, "a": "1", "b": "2", "inertia": "0.0025", "radius": "0.1", "drop": "0.5"}),
    Reference(
        "blocks-count-pi",
        blocks,
        {"light": "1", "heavy": "100", "x": "1", "y": "2", "v": "-1", "radius": "0.1"},
    ),
    Reference("cradle-of-two", quarters, {"g": G, "length": "1", "amplitude": "0.5"}),
    Reference("ball-and-stick", flies, {"x": "1", "radius": "0.1", "v": "2"}),
    Reference("rod-on-edge", slips_off, {"g": G, "a": "0.1", "friction": "0.5"}),
    Reference("rod-against-stop", falls_to_stop, {"g": G, "mass": "2", "inertia": "0.5", "a": "0.5", "end": "1"}),
    Reference(
        "billiard-ball", ball_rolls, {"g": G, "friction": "0.2", "v": "2", "x": "40", "y": "-30", "radius": "0.03"}
    ),
    Reference("stone-across-slope", stops_on_slope, {"g": G, "angle": "0.3", "v": "2", "friction": "0.5"}),
)


@dataclass(frozen=True)
class Compared:
    """An event beside its reference.

    Attributes
    ----------
    off : float
        How far its time is from the reference (s).
    conditioning : float
        Relative change of the time by relative changes of all numbers, summed up.
    allowed : float
        8 times the conditioning in units of rounding, and 2e-15 of the time (s).
    """

    event: MotionEvent
    off: float
    conditioning: float
    allowed: float


def events_of(scene: str) -> tuple[MotionEvent, ...]:
    """Return the events of a worked scene up to its horizon."""
    document = json.loads((SCENES / f"{scene}.json").read_text(encoding="utf-8"), parse_float=str)
    times = document.pop("times")
    end = times["stop"] if isinstance(times, dict) else times[-1]
    return solve_scene(scene_from(document), [float(end)], ("trajectory",)).events


def compared(reference: Reference) -> Iterator[Compared]:
    """Yield all events of a scene beside their references."""
    events = events_of(reference.scene)
    with mpmath.workdps(DIGITS + 10):
        numbers = {name: mpf(text) for name, text in reference.numbers.items()}
        right = reference.times(**numbers)
        step = mpf(10) ** -15
        moved = [reference.times(**numbers | {name: value * (1 + step)}) for name, value in numbers.items()]
        for i, (event, time) in enumerate(zip(events, right, strict=True)):
            conditioning = float(sum(abs(other[i] / time - 1) for other in moved) / step)
            allowed = (8 * conditioning * UNIT + 2e-15) * float(time)
            yield Compared(event, float(abs(mpf(event.time) - time)), conditioning, allowed)


def main() -> None:
    """Print the table."""
    for reference in REFERENCES:
        for i, one in enumerate(compared(reference)):
            sys.stdout.write(
                f"{reference.scene:30} {i + 1:2} {one.event.kind:9} {one.event.time:.17g} s, off {one.off:.1e}, "
                f"stated {one.event.error:.1e}, conditioning {one.conditioning:.2f}, allowed {one.allowed:.1e}\n"
            )


if __name__ == "__main__":
    main()
