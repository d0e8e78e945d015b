"""MJCF read: the tree of bodies with its joints, the first keyframe, equalities, tendons, pairs of contacts."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from core.arrays import Floats
from core.interchange.draft import Draft, DraftBody, DraftConnection, Ended
from core.interchange.frames import at, vector
from core.interchange.mjcf_attributes import leave_out_unread
from core.interchange.mjcf_contacts import ContactReading, PlacedGeom
from core.interchange.mjcf_elements import MAIN, Compiler, flag, limited
from core.interchange.mjcf_geometry import add_inertia
from core.interchange.mjcf_joints import Moving, joined, moved
from core.interchange.xml_reading import Element, fault, numbers_in, shortened

GRAVITY = (0.0, 0.0, -9.81)
"""Gravity of a document that states none (m/s^2)."""

WITHOUT_MOTION = ("asset", "compiler", "custom", "default", "sensor", "size", "statistic", "visual")
"""Sections that say nothing of the motion, or are read elsewhere."""

MEDIUM = ("density", "viscosity", "wind", "magnetic")
"""Options that are forces of what is around the bodies."""


def read_mjcf(root: Element) -> Draft:
    """Return the model of an MJCF document, in the configuration and with the velocities of its first keyframe."""
    return _Reading(root).draft


class _Reading:
    """The model as it grows while the tree of bodies is followed."""

    def __init__(self, root: Element) -> None:
        self.root, self.compiler = root, Compiler.of(root)
        options = [option for option in root.all("option")]
        gravity = next((one for one in options if "gravity" in one.attributes), None)
        self.draft = Draft(vector(GRAVITY if gravity is None else gravity.numbers("gravity", 3)))
        for compiler in root.all("compiler"):
            leave_out_unread(self.draft, compiler)
        for option in options:
            given = [name for name in MEDIUM if set(option.get(name).split()) - {"0", "0.0"}]
            if given or option.first("flag") is not None:
                self.draft.leave_out(option, f"of it gravity alone is taken, not {', '.join(given) or 'flags'}")
        key = next((key for section in root.all("keyframe") for key in section.all("key")), None)
        self.places, self.rates = (
            (None if key is None or name not in key.attributes else list(numbers_in(key, key.get(name), name, None)))
            for name in ("qpos", "qvel")
        )
        self.key = key
        if key is not None:
            leave_out_unread(self.draft, key)
        self.draft.moves = bool(self.rates and any(self.rates))
        self.sites: dict[str, Ended] = {}
        self.touching: list[PlacedGeom] = []
        ground = Moving(at((0.0, 0.0, 0.0)), np.zeros(3), np.zeros(3))
        for world in root.all("worldbody"):
            self.body(world, None, ground, MAIN)
        if (self.places or self.rates) and self.key is not None:
            self._require_all_used()
        self.others()
        ContactReading(root, self.draft, self.compiler, self.touching)

    def _require_all_used(self) -> None:
        for name, numbers in (("qpos", self.places), ("qvel", self.rates)):
            if numbers and self.key is not None:
                raise fault(self.key, f"must have {name} of the joints alone: {len(numbers)} numbers are left over")

    def take(self, numbers: list[float] | None, count: int) -> Floats | None:
        """Return the next numbers of the keyframe, None without one."""
        if numbers is None:
            return None
        if len(numbers) < count:
            assert self.key is not None, "the numbers are its"
            raise fault(self.key, "must have qpos and qvel of all joints")
        taken = vector(numbers[:count])
        del numbers[:count]
        return taken

    def body(self, element: Element, name: str | None, motion: Moving, inherited: str) -> None:
        """Read what is on a body, and the bodies that it carries."""
        inherited = element.get("childclass", inherited)
        geoms: list[Element] = []
        for child in element.children:
            if child.name == "body":
                self.carried(child, name, motion, inherited)
            elif child.name == "geom":
                geoms.append(self.compiler.complete(child, inherited))
                self.touching.append(PlacedGeom(geoms[-1], name, motion.frame))
                leave_out_unread(self.draft, geoms[-1])
            elif child.name == "site":
                site = self.compiler.complete(child, inherited)
                leave_out_unread(self.draft, site)
                if "name" in site.attributes:
                    self.sites[site.get("name")] = (name, motion.frame.point(self.compiler.geom_frame(site).origin))
            elif child.name in ("frame", "replicate", "composite", "flexcomp", "include", "attach"):
                raise fault(child, "must be written out", remedy="let MuJoCo save the compiled model as MJCF")
            elif child.name not in ("joint", "freejoint", "inertial", "camera", "light"):
                self.draft.leave_out(child, "it is no part of a body here")
        if name is not None:
            add_inertia(self.draft.bodies[name], element, geoms, self.compiler)

    def carried(self, element: Element, parent: str | None, motion: Moving, inherited: str) -> None:
        """Read a body that another carries."""
        name = element.get("name") or f"body-{len(self.draft.bodies) + 1}"
        if name in self.draft.bodies:
            raise fault(element, "must have a name of its own")
        if flag(element, "mocap"):
            self.draft.leave_out(element, "what moves it is not in the file: it stays where it is")
        own = element.get("childclass", inherited)
        joints = [self.compiler.complete(one, own) for one in element.all("joint", "freejoint")]
        for one in (element, *element.all("inertial"), *joints):
            leave_out_unread(self.draft, one)
        moving, found = moved(motion, self.compiler.frame(element), joints, self.compiler, self.take, self)
        centre, tensor = np.zeros(3), np.zeros((3, 3))
        self.draft.add(
            DraftBody(name, moving.frame, 0.0, centre, tensor, element.line, moving.velocity, moving.turning)
        )
        joined(self.draft, element, name, parent, found, moving.frame)
        self.body(element, name, moving, inherited)

    def others(self) -> None:
        """Read equalities and tendons, and say what else is left out."""
        fixed: set[str] = set()
        for section in self.root.all("equality"):
            for one in section.children:
                if one.get("active") == "false":
                    continue
                if one.name in ("connect", "weld") and "body1" in one.attributes:
                    leave_out_unread(self.draft, one)
                    self.equal_places(one)
                elif one.name == "tendon" and "tendon2" not in one.attributes:
                    fixed.add(one.required("tendon1"))
                else:
                    self.draft.leave_out(one, "it ties coordinates, which a scene does not name")
        for section in self.root.all("tendon"):
            for one in section.children:
                self.tendon(self.compiler.complete(one, MAIN), one.get("name") in fixed)
        for section in self.root.children:
            if section.name in ("actuator", "deformable", "extension", "plugin"):
                for one in section.children:
                    self.draft.leave_out(one, "it is a drive that something else commands")
            elif section.name == "include":
                raise fault(section, "must be written out", remedy="let MuJoCo save the compiled model as MJCF")
            elif section.name not in (
                *WITHOUT_MOTION,
                *("worldbody", "option", "keyframe", "equality", "tendon", "contact"),
            ):
                self.draft.leave_out(section, "it is no section that is read")

    def known(self, element: Element, attribute: str) -> str | None:
        """Return the body that an attribute names, None for the ground."""
        name = element.get(attribute, "world")
        if name != "world" and name not in self.draft.bodies:
            raise fault(element, f"must name a body, unlike {shortened(name)}")
        return None if name == "world" else name

    def equal_places(self, element: Element) -> None:
        first, second = self.known(element, "body1"), self.known(element, "body2")
        frame = at((0.0, 0.0, 0.0)) if first is None else self.draft.bodies[first].frame
        place = frame.point(vector(element.numbers("anchor", 3, (0.0, 0.0, 0.0))))
        ends: dict[str, Ended | list[Ended]] = {"a": (first, place), "b": (second, place)}
        kind = "pin" if element.name == "connect" else "weld"
        name = element.get("name") or element.name
        self.draft.connections.append(DraftConnection(name, ends, {"kind": kind}, element.line))

    def tendon(self, tendon: Element, fixed: bool) -> None:
        if tendon.name != "spatial" or any(child.name != "site" for child in tendon.children):
            self.draft.leave_out(tendon, "only straight tendons through sites are taken")
            return
        leave_out_unread(self.draft, tendon)
        places: list[Ended] = []
        for child in tendon.children:
            if child.required("site") not in self.sites:
                raise fault(child, f"must name a site, unlike {shortened(child.get('site'))}")
            places.append(self.sites[child.get("site")])
        if len(places) < 2:
            raise fault(tendon, "must go through two sites or more")
        name = tendon.get("name") or "tendon"
        ends: dict[str, Ended | list[Ended]] = {"a": places[0], "b": places[-1]}
        length = float(sum(np.linalg.norm(q[1] - p[1]) for p, q in pairwise(places)))
        stiffness, damping = tendon.number("stiffness", 0.0), tendon.number("damping", 0.0)
        if len(places) > 2 and (fixed or stiffness or damping):
            self.draft.leave_out(tendon, "springs, dampers and rods are between two places")
        else:
            if fixed:
                self.draft.connections.append(DraftConnection(name, ends, {"kind": "rod"}, tendon.line))
            if stiffness:
                rest = numbers_in(tendon, tendon.get("springlength", f"{length!r}"), "springlength", None)
                if not rest:
                    raise fault(tendon, "must have numbers in springlength")
                if len(set(rest)) > 1:
                    self.draft.leave_out(tendon, "its spring has a range of lengths without force")
                own = {"kind": "spring", "stiffness": stiffness, "rest_length": rest[0] if rest[0] >= 0.0 else length}
                self.draft.connections.append(DraftConnection(name, ends, own, tendon.line))
            if damping:
                own = {"kind": "damper", "coefficient": damping}
                self.draft.connections.append(DraftConnection(f"{name}-damper", ends, own, tendon.line))
        if limited(tendon):
            least, most = tendon.numbers("range", 2)
            if least >= most:
                raise fault(tendon, "must have a range that ends above its begin")
            if least > 0.0:
                self.draft.leave_out(tendon, "its length may become shorter than its range here")
            own = {"kind": "string", "length": most}
            self.draft.connections.append(DraftConnection(f"{name}-string", {"through": places}, own, tendon.line))
        if tendon.number("frictionloss", 0.0):
            self.draft.leave_out(tendon, "its friction is a constant force, which is not described")
