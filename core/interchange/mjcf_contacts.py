"""Contacts of MJCF: which geometries may touch by their bits and by pairs, and how they rub."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from core.interchange.draft import Draft, DraftContact
from core.interchange.frames import Frame
from core.interchange.mjcf_attributes import OF_CONTACTS, leave_out_unread, states
from core.interchange.mjcf_elements import MAIN, Compiler
from core.interchange.mjcf_geometry import SOLIDS, add_shape
from core.interchange.xml_reading import Element, fault, numbers_in, shortened

FRICTION = 1.0
"""Coefficient of sliding of geometries and pairs that state none, and of a pair along its second axis likewise."""

DIRECTIONS = 3
"""Dimensions of a contact (`condim`) where none are stated: 1 is without friction, 4 and 6 also resist turns."""

MOST_CONTACTS = 1000
"""Contacts with fixed planes: ten for each body that a scene may have."""

ONE = "contacts are of one geometry of a body with a plane of the ground"


@dataclass(frozen=True)
class PlacedGeom:
    """A geometry with its defaults, the body that it is on (None is the ground), and the frame of that at the start."""

    element: Element
    body: str | None
    frame: Frame

    @cached_property
    def bits(self) -> tuple[int, int]:
        """Return `contype` and `conaffinity`."""
        own, others = (_whole(self.element, name, 1) for name in ("contype", "conaffinity"))
        return own, others

    @property
    def shape(self) -> str:
        """The type."""
        return self.element.get("type", "sphere")


@dataclass(frozen=True)
class _Touching:
    """What may touch what, and where that is said."""

    said: Element
    fixed: PlacedGeom
    other: PlacedGeom


def collide(first: PlacedGeom, second: PlacedGeom) -> bool:
    """Return whether the bits of two geometries let them touch, by MuJoCo's rule."""
    (own, others), (their_own, their_others) = first.bits, second.bits
    return bool(own & their_others or their_own & others)


class ContactReading:
    """Enters the contacts of a model in its draft.

    Parameters
    ----------
    root : Element
    draft : Draft
        With its bodies and joints.
    compiler : Compiler
    geoms : sequence of PlacedGeom
    """

    def __init__(self, root: Element, draft: Draft, compiler: Compiler, geoms: Sequence[PlacedGeom]) -> None:
        self.draft, self.compiler, self.geoms = draft, compiler, geoms
        self.carriers = {name: draft.carrier(name) for name in [None, *draft.bodies]}
        self.excluded: set[frozenset[str]] = set()
        found = list(self._pairs(root))
        paired = {frozenset((id(one.fixed), id(one.other))) for one in found}
        for one in self._by_bits():
            if frozenset((id(one.fixed), id(one.other))) not in paired:
                found.append(one)
            if len(found) > MOST_CONTACTS:
                raise fault(root, f"must have at most {MOST_CONTACTS} contacts with what is fixed")
        touching: dict[str | None, set[int]] = {}
        for one in found:
            touching.setdefault(one.other.body, set()).add(id(one.other))
        for one in found:
            if len(touching[one.other.body]) > 1 or not self._enter(one):
                draft.leave_out(one.said, ONE)

    def _pairs(self, root: Element) -> Iterator[_Touching]:
        names = {geom.element.get("name"): geom for geom in self.geoms if geom.element.get("name")}
        for section in root.all("contact"):
            for said in section.children:
                if said.name == "exclude":
                    self.excluded.add(frozenset((said.required("body1"), said.required("body2"))))
                    continue
                if said.name != "pair":
                    self.draft.leave_out(said, "it is no pair")
                    continue
                pair = self.compiler.complete(said, MAIN)
                leave_out_unread(self.draft, pair)
                two = []
                for which in ("geom1", "geom2"):
                    if pair.required(which) not in names:
                        raise fault(pair, f"must name a geom, unlike {shortened(pair.get(which))}")
                    two.append(names[pair.get(which)])
                fixed, other = sorted(two, key=lambda one: self.carriers[one.body] is not None)
                if self.carriers[fixed.body] is None and self.carriers[other.body] is not None:
                    yield _Touching(pair, fixed, other)
                else:
                    self.draft.leave_out(pair, ONE)

    def _by_bits(self) -> Iterator[_Touching]:
        """Return what may touch what is fixed, and leave out geometries that may touch other bodies."""
        parents = {
            frozenset((self.carriers[one.child], self.carriers[one.parent]))
            for one in self.draft.joints
            if self.carriers[one.parent] is not None
        }
        bits = np.array([geom.bits for geom in self.geoms], np.int64).reshape(-1, 2)
        for i, geom in enumerate(self.geoms):
            carrier, told = self.carriers[geom.body], False
            if carrier is None:
                continue
            for k in np.flatnonzero((bits[:, 0] & bits[i, 1]) | (bits[:, 1] & bits[i, 0])):
                other = self.geoms[int(k)]
                if frozenset((geom.body or "world", other.body or "world")) in self.excluded:
                    continue
                theirs = self.carriers[other.body]
                if theirs is None:
                    yield _Touching(geom.element, other, geom)
                elif k < i and not told and theirs != carrier and frozenset((carrier, theirs)) not in parents:
                    self.draft.leave_out(geom.element, "contacts between bodies are described one by one")
                    told = True

    def _enter(self, one: _Touching) -> bool:
        """Enter a contact; return whether it can be described."""
        name, fixed, other = one.other.body, one.fixed, one.other
        if name is None or self.carriers[name] != name or fixed.shape != "plane" or other.shape not in SOLIDS:
            return False
        if self.draft.bodies[name].shape is None:
            add_shape(self.draft.bodies[name], other.element, self.compiler)
        own = fixed.frame @ self.compiler.frame(fixed.element)
        self.draft.contacts.append(
            DraftContact(name, own.origin, own.rotation[:, 2], self._friction(one), one.said.line)
        )
        stated = [one.said] if one.said.name == "pair" else [fixed.element, other.element]
        soft = [word for word in OF_CONTACTS if any(states(element, word) for element in stated)]
        if soft:
            self.draft.leave_out(one.said, f"contacts are rigid and begin where shapes meet, without {', '.join(soft)}")
        return True

    def _friction(self, one: _Touching) -> float:
        """Return the coefficient of sliding: of the pair, of the geometry of higher priority, or the larger one."""
        stated, said = [one.fixed.element, one.other.element], one.said
        ranks = [_whole(geom, "priority", 0) for geom in stated]
        if said.name == "pair":
            # MuJoCo asks the geometries of a pair for nothing.
            stated = [said]
        elif ranks[0] != ranks[1]:
            stated = [stated[int(np.argmax(ranks))]]
        directions = max(_whole(element, "condim", DIRECTIONS) for element in stated)
        if directions == 1:
            return 0.0
        if directions > DIRECTIONS:
            self.draft.leave_out(said, "friction against turning and rolling is not described")
        along = [numbers_in(element, element.get("friction", repr(FRICTION)), "friction", None) for element in stated]
        if not all(along):
            raise fault(said, "must have numbers in friction")
        if said.name == "pair" and [*along[0], FRICTION][:2] != [along[0][0]] * 2:
            self.draft.leave_out(said, "of its coefficients along two axes the first is taken in all directions")
        return max(numbers[0] for numbers in along)


def _whole(element: Element, name: str, default: int) -> int:
    number = element.number(name, float(default))
    if not number.is_integer() or abs(number) >= 2**31:
        raise fault(element, f"must have a whole number of 32 bits in {name}")
    return int(number)
