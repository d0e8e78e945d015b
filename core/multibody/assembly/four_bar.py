"""Four links in a loop of four joints: whether they close, which of them turns fully, and how they are assembled.

References
----------
F. Grashof, "Theoretische Maschinenlehre" 2 (1883). J. J. Uicker, G. R. Pennock, J. E. Shigley, "Theory of Machines and
Mechanisms", section 1.9: a link turns fully relative to its neighbours where the sum of the shortest and the longest
link does not exceed that of the others, and that link is the shortest or its neighbour.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import dist

from core.multibody.algebra.polynomials import Ball
from core.multibody.language.joints import Pin, Rod
from core.multibody.language.scene import Scene
from core.multibody.language.written import GROUND
from core.multibody.model_answer import FourBarLinkage
from core.multibody.table.frames import Frame
from core.multibody.table.measures import Measures

Joint = tuple[str, tuple[float, ...]]
"""A place of a link: the link, and the place in its axes."""

NEXT_TO_ZERO = 2.0**-45
"""Share of the lengths to which doubles tell a sum of four of them from zero."""


@dataclass(frozen=True)
class FourBar:
    """A planar four-bar linkage.

    Attributes
    ----------
    links : tuple of str
        In the order of the loop, from the ground on if that is a link.
    lengths : tuple of float
        Distances of their joints (m).
    joints : tuple of Joint
        Between each link and the one before it.
    """

    links: tuple[str, ...]
    lengths: tuple[float, ...]
    joints: tuple[Joint, ...]

    @property
    def excess(self) -> float:
        """By how much the longest link is longer than the others together (m); negative where they close."""
        return 2.0 * max(self.lengths) - sum(self.lengths)

    @property
    def margin(self) -> float:
        """By how much shortest and longest link are shorter than the others together (m): Grashof's condition."""
        return sum(self.lengths) - 2.0 * (min(self.lengths) + max(self.lengths))

    @property
    def kind(self) -> str:
        """What it is called by the link that turns fully."""
        if abs(self.margin) <= NEXT_TO_ZERO * sum(self.lengths):
            return "change-point"
        if self.margin < 0.0:
            return "triple-rocker"
        shortest = self.lengths.index(min(self.lengths))
        return ("double-crank", "crank-rocker", "double-rocker", "crank-rocker")[shortest]

    def told(self) -> str:
        """Return in words whether it closes, and by which condition."""
        if self.excess > 0.0:
            longest = self.links[self.lengths.index(max(self.lengths))]
            return (
                f'"{longest}" is {max(self.lengths):.6g} m long, {self.excess:.6g} m more than the other three links '
                "together: they do not close"
            )
        condition = (
            f"Grashof's condition holds by {self.margin:.6g} m: the shortest link turns fully"
            if self.margin > 0.0
            else f"Grashof's condition fails by {-self.margin:.6g} m: no link turns fully"
        )
        return f"a {self.kind} linkage; {condition}"

    def answer(self, places: Sequence[tuple[float, ...]]) -> FourBarLinkage:
        """Return what is answered about it, with its joints at places of the plane."""
        error = 2.0**-50 * sum(self.lengths)
        return FourBarLinkage(
            self.links, self.lengths, self.kind, self.margin, _branch(places), {"lengths": error, "margin": error}
        )


def _branch(joints: Sequence[tuple[float, ...]]) -> str:
    """Return whether the quadrilateral of the joints crosses itself."""

    def side(a: tuple[float, ...], b: tuple[float, ...], c: tuple[float, ...]) -> float:
        return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])

    a, b, c, d = joints
    crossed = any(
        side(p, q, r) * side(p, q, s) < 0.0 and side(r, s, p) * side(r, s, q) < 0.0
        for p, q, r, s in ((a, b, c, d), (b, c, d, a))
    )
    return "crossed" if crossed else "open"


def four_bar_of(scene: Scene, measures: Measures) -> FourBar | None:
    """Return the four-bar linkage that a scene of the plane is, None where it is none.

    Links are the bodies, the rods and the ground; joints are pins, and the ends of rods.
    """
    if measures.dimension != 2 or measures.table.timed:
        return None
    same: dict[Joint, Joint] = {}
    joints: dict[str, list[Joint]] = {}

    def first(joint: Joint) -> Joint:
        while same.setdefault(joint, joint) != joint:
            joint = same[joint]
        return joint

    lengths: dict[str, float] = {}
    for name, connection in zip(scene.names(), scene.connections, strict=True):
        if not isinstance(connection, (Pin, Rod)):
            continue
        ends = [_joint(place, measures) for place in (connection.a, connection.b)]
        if isinstance(connection, Pin):
            same[first(ends[0])] = first(ends[1])
        else:
            joints[name] = ends
            lengths[name] = _length_of_rod(connection, measures)
        for link, place in ends:
            if measures.coordinates.frames.get(link, _GROUND).orients:
                joints.setdefault(link, []).append((link, place))
    loop: dict[str, tuple[Joint, Joint]] = {}
    for link, places in joints.items():
        distinct = list(dict.fromkeys(first(joint) for joint in places))
        if len(distinct) > 2:
            return None
        if len(distinct) == 2:
            loop[link] = (distinct[0], distinct[1])
            own = list(dict.fromkeys(places))
            lengths.setdefault(link, dist(own[0][1], own[1][1]))
    if len(loop) != 4:
        return None
    order = sorted(loop, key=lambda link: link != GROUND)[:1]
    joint = loop[order[0]][1]
    met = [loop[order[0]][0]]
    while len(order) < 4:
        met.append(joint)
        following = [link for link, ends in loop.items() if link not in order and joint in ends]
        if len(following) != 1:
            return None
        order.append(following[0])
        a, b = loop[following[0]]
        joint = b if a == joint else a
    if joint != met[0]:
        return None
    return FourBar(tuple(order), tuple(lengths[link] for link in order), tuple(met))


_GROUND = Frame(GROUND, [], orients=True)


def _joint(place: object, measures: Measures) -> Joint:
    if isinstance(place, str):
        body, _, spot = place.partition(".")
        frame = measures.coordinates.frames[body]
        return body, tuple(map(float, frame.places[spot])) if spot in frame.places else (0.0, 0.0)
    return GROUND, tuple(map(float, measures.numerals.vector(place, (), 2)))


def _length_of_rod(rod: Rod, measures: Measures) -> float:
    if rod.length is not None:
        return float(measures.numerals.number(rod.length, ()))
    a, b = (place_of(_joint(place, measures), measures, measures.table.q) for place in (rod.a, rod.b))
    return dist(a, b)


def place_of(joint: Joint, measures: Measures, q: Sequence[Ball]) -> tuple[float, ...]:
    """Return where a joint is (m)."""
    link, place = joint
    if link == GROUND:
        return place
    frame = measures.coordinates.frames[link]
    centre = [float(q[i]) for i in frame.position]
    if frame.direction is None:
        return tuple(centre)
    c, s = (float(q[i]) for i in frame.direction)
    return centre[0] + c * place[0] - s * place[1], centre[1] + s * place[0] + c * place[1]
