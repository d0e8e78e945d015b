"""Attributes of MJCF: which are read of an element, which say nothing of the motion; others are left out by name."""

from __future__ import annotations

from collections.abc import Mapping

from core.interchange.draft import Draft
from core.interchange.xml_reading import Element

SHOWN = ("name", "class", "group", "rgba", "material", "user")
"""What elements are called, and how they look."""

POSE = ("pos", "quat", "axisangle", "xyaxes", "zaxis", "euler")

SOFT = ("solref", "solimp", "solreflimit", "solimplimit", "solreffriction", "solimpfriction", "torquescale")
"""How softly MuJoCo holds what a scene holds rigidly, and limits that are left out as a whole."""

OF_CONTACTS = ("solref", "solimp", "solmix", "solreffriction", "margin", "gap")
"""What of a geometry is left out only where it touches."""

FILES = ("strippath", "meshdir", "texturedir", "assetdir", "convexhull", "usethread", "discardvisual", "fusestatic")
"""What of a compiler says where files are, and how it saves time."""

READ: Mapping[str, frozenset[str]] = {
    name: frozenset(SHOWN + own)
    for name, own in {
        "compiler": ("angle", "eulerseq", "coordinate", "inertiafromgeom", "autolimits", "fitaabb", *FILES),
        "body": (*POSE, "childclass", "mocap"),
        "freejoint": (),
        "joint": (
            *("type", "pos", "axis", "ref", "springref", "stiffness", "damping", "armature", "frictionloss", "range"),
            *(*SOFT, "limited", "margin", "actuatorfrcrange", "actuatorfrclimited"),
        ),
        "geom": (
            *(*POSE, *OF_CONTACTS, "type", "size", "fromto", "mass", "density", "contype", "conaffinity", "condim"),
            *("friction", "priority"),
        ),
        "site": (*POSE, "type", "size", "fromto"),
        "inertial": (*POSE, "mass", "diaginertia", "fullinertia"),
        "pair": (*OF_CONTACTS, "geom1", "geom2", "friction", "condim"),
        "spatial": (
            *("stiffness", "damping", "springlength", "range", "limited", "frictionloss", "width", "margin"),
            *(*SOFT, "actuatorfrcrange", "actuatorfrclimited"),
        ),
        "connect": (*SOFT, "active", "body1", "body2", "anchor"),
        "weld": (*SOFT, "active", "body1", "body2", "anchor"),
        "key": ("qpos", "qvel", "time", "act", "ctrl"),
    }.items()
}
"""By element; drives are left out with their states."""


def leave_out_unread(draft: Draft, element: Element) -> None:
    """Leave out the attributes of an element that nothing reads, unless they are zero or "false"."""
    unread = [name for name in element.attributes if name not in READ[element.name] and states(element, name)]
    if unread:
        draft.leave_out(element, f"not read of it: {', '.join(unread)[:100]}")


def states(element: Element, name: str) -> bool:
    """Return whether an attribute is there and says something other than zero, "false", "auto" or "none"."""
    return any(not _says_nothing(word) for word in element.get(name).split())


def _says_nothing(word: str) -> bool:
    try:
        return float(word) == 0.0
    except ValueError:
        return word in ("false", "auto", "none")
