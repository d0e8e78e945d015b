"""Contacts of MJCF: what MuJoCo's rules let touch, how it rubs, and what is said to be left out."""

from __future__ import annotations

from typing import Any

import pytest

from core.errors import InvalidParameter
from core.interchange.import_model import ImportedModel, import_model
from core.interchange.mjcf_contacts import MOST_CONTACTS
from tests.core.interchange.answers import imported


def test_a_ball_above_a_plane_touches_it_and_others_are_left_out() -> None:
    """It rests; a contact between two bodies is said to be left out."""
    text = """<mujoco><worldbody><geom type="plane" size="1 1 1" friction="0.4"/>
<body name="a" pos="0 0 0.1"><freejoint/><geom size="0.1" friction="0.7"/></body>
<body name="b" pos="3 0 0.1"><freejoint/><geom size="0.1"/></body>
</worldbody><actuator><motor joint="x"/></actuator></mujoco>"""
    found, rates = imported(text)
    assert rates["a"] == pytest.approx((0.0, 0.0, 0.0), abs=1e-15)
    contacts = {one["place"]: one["friction"] for one in found.scene["connections"]}
    assert contacts == {"a": 0.7, "b": 1.0}
    assert [(one.line, one.what) for one in found.left_out] == [(3, "geom"), (4, "motor")]


def text(plane: str, ball: str, more: str = "") -> str:
    return f"""<mujoco><worldbody><geom name="floor" type="plane" size="1 1 1" {plane}/>
<body name="a" pos="0 0 0.1"><freejoint/><geom name="ball" size="0.1" {ball}/></body></worldbody>{more}</mujoco>"""


def model(plane: str, ball: str, more: str = "") -> ImportedModel:
    return import_model(text(plane, ball, more))


RULES = (
    *(("", ""), ("", 'contype="0"'), ("", 'contype="0" conaffinity="2"'), ('condim="1"', 'condim="1"')),
    *(('contype="2" conaffinity="4"', 'contype="4" conaffinity="0"'), ('condim="1" priority="1"', 'friction="0.7"')),
    *(('contype="2" conaffinity="0"', 'contype="2" conaffinity="0"'), ('condim="1"', 'friction="0.7"')),
)
PAIRS = ('friction="0.4 0.4"', 'condim="1"', "")


@pytest.mark.parametrize(
    ("plane", "ball", "more"),
    [
        *((*rule, "") for rule in RULES),
        *((*RULES[0], f'<contact><pair geom1="ball" geom2="floor" {said}/></contact>') for said in PAIRS),
        *((*RULES[4], f'<contact><pair geom1="ball" geom2="floor" {said}/></contact>') for said in PAIRS),
        (*RULES[0], '<contact><exclude body1="world" body2="a"/></contact>'),
    ],
)
def test_what_touches_and_how_it_rubs_is_that_of_mujoco(plane: str, ball: str, more: str) -> None:
    """MuJoCo finds a contact of what lies 1e-4 m deep."""
    mujoco = pytest.importorskip("mujoco")
    read = mujoco.MjModel.from_xml_string(text(plane, ball, more).replace('pos="0 0 0.1"', 'pos="0 0 0.0999"'))
    data = mujoco.MjData(read)
    mujoco.mj_forward(read, data)
    theirs = [0.0 if one.dim == 1 else float(one.friction[0]) for one in data.contact]
    assert [one["friction"] for one in contacts(model(plane, ball, more))] == theirs


def contacts(found: ImportedModel) -> list[dict[str, Any]]:
    return list(found.scene.get("connections", []))


@pytest.mark.parametrize(
    ("plane", "ball", "touch"),
    [
        ("", "", True),
        ("", 'contype="0"', True),
        ("", 'contype="0" conaffinity="2"', False),
        ('contype="2" conaffinity="2"', 'contype="1" conaffinity="1"', False),
        ('contype="2" conaffinity="4"', 'contype="4" conaffinity="0"', True),
        ('contype="2" conaffinity="0"', 'contype="0" conaffinity="2"', True),
        ('contype="2" conaffinity="0"', 'contype="2" conaffinity="0"', False),
    ],
)
def test_geometries_touch_where_a_type_of_one_is_an_affinity_of_the_other(plane: str, ball: str, touch: bool) -> None:
    """(contype1 & conaffinity2) || (contype2 & conaffinity1): documentation of MuJoCo, Computation, Collision."""
    assert bool(contacts(model(plane, ball))) is touch


@pytest.mark.parametrize(
    ("plane", "ball", "friction"),
    [
        ("", "", 1.0),
        ('friction="0.3"', 'friction="0.2 1 1"', 0.3),
        ('condim="1"', 'condim="1"', 0.0),
        ('condim="1"', "", 1.0),
        ('condim="1" priority="1"', 'friction="0.7"', 0.0),
        ('friction="0.3" priority="1"', 'friction="0.7"', 0.3),
    ],
)
def test_geometries_rub_by_the_one_of_higher_priority_or_the_rougher(plane: str, ball: str, friction: float) -> None:
    [one] = contacts(model(plane, ball))
    assert one["friction"] == friction


@pytest.mark.parametrize(
    ("said", "friction"),
    [('friction="0.4 0.4"', 0.4), ('condim="1"', 0.0), ('condim="1" friction="0.4 0.4"', 0.0), ("", 1.0)],
)
def test_a_pair_touches_whatever_the_bits_and_once(said: str, friction: float) -> None:
    pair = f'<contact><pair geom1="ball" geom2="floor" {said}/></contact>'
    for bits in ('contype="0" conaffinity="0"', ""):
        [one] = contacts(model('friction="0.6"', f'friction="0.5" {bits}', pair))
        assert one["friction"] == friction


def test_a_pair_that_rubs_otherwise_along_its_second_axis_says_so() -> None:
    """One number leaves 1 for the second."""
    for said, told in (('friction="0.4"', True), ('friction="0.4 0.3"', True), ('friction="0.4 0.4 7"', False)):
        found = model("", "", f'<contact><pair geom1="ball" geom2="floor" {said}/></contact>')
        assert [one.why.startswith("of its coefficients") for one in found.left_out] == [True] * told


def test_bodies_that_are_excluded_do_not_touch() -> None:
    for bodies in ('body1="a" body2="world"', 'body1="world" body2="a"'):
        found = model("", "", f"<contact><exclude {bodies}/></contact>")
        assert (contacts(found), found.left_out) == ([], [])


def test_two_geometries_of_one_body_that_may_touch_are_left_out_and_one_whose_bits_do_not_is_none() -> None:
    for bits, count in (("", 0), ('contype="0" conaffinity="0"', 1)):
        found = import_model(f"""<mujoco><worldbody><geom type="plane" size="1 1 1"/>
<body name="a" pos="0 0 0.1"><freejoint/>\n<geom size="0.1"/>\n<geom size="0.05" pos="0 0 0.3" {bits}/></body>
</worldbody></mujoco>""")
        assert len(contacts(found)) == count
        assert [one.line for one in found.left_out] == ([] if count else [3, 4])


def test_softness_and_friction_against_turning_are_left_out_where_something_touches() -> None:
    found = model("", 'margin="0.01" solref="0.1 1" condim="6"')
    assert [(one.line, one.why.rpartition(" without ")[2]) for one in found.left_out] == [
        (2, "friction against turning and rolling is not described"),
        (2, "solref, margin"),
    ]
    assert model('contype="0" conaffinity="0"', 'margin="0.01" contype="0" conaffinity="0"').left_out == []


def test_a_body_and_what_it_carries_do_not_touch() -> None:
    """MuJoCo leaves out parents and children; grandchildren touch, and this is said."""
    inertial = '<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>'
    inner = f'<body>\n<joint/>{inertial}<geom size="0.1"/></body>'
    for last, lines in (("", []), (inner, [4])):
        middle = f'<body>\n<joint/>{inertial}<geom size="0.1"/>{last}</body>'
        text = f'<mujoco><worldbody><body>\n<joint/>{inertial}<geom size="0.1"/>{middle}</body></worldbody></mujoco>'
        assert [one.line for one in import_model(text).left_out] == lines


@pytest.mark.parametrize(
    ("plane", "ball", "more", "says"),
    [
        ('contype="0.5"', "", "", "line 1: <geom> "),
        ("", 'friction=""', "", "must have numbers in friction"),
        ("", "", '<contact><pair geom1="ball" geom2="door"/></contact>', "must name a geom, unlike"),
    ],
)
def test_what_is_no_contact_is_refused(plane: str, ball: str, more: str, says: str) -> None:
    with pytest.raises(InvalidParameter) as fault:
        model(plane, ball, more)
    assert says in fault.value.detail


def test_contacts_are_counted() -> None:
    balls = '<body><freejoint/><geom size="1"/></body>' * 40
    planes = '<geom type="plane" size="1 1 1"/>' * 26
    with pytest.raises(InvalidParameter, match=f"at most {MOST_CONTACTS} contacts"):
        import_model(f"<mujoco><worldbody>{planes}{balls}</worldbody></mujoco>")
