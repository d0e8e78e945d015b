"""URDF as scenes: accelerations by hand, and what is left out or refused, with its line."""

from __future__ import annotations

import math

import pytest

from core.errors import InvalidParameter
from core.interchange.import_model import import_model
from tests.core.interchange.answers import imported

INERTIAL = """<inertial><origin xyz="0 0 -0.5"/><mass value="2"/>
<inertia ixx="0.2" iyy="0.2" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>"""


def robot(inner: str, joint: str = 'type="continuous"', more: str = "") -> str:
    return f"""<robot name="r">
<link name="world"/>
<link name="arm">{inner}</link>
<joint name="j" {joint}>
<parent link="world"/><child link="arm"/>
<origin xyz="0 0 1" rpy="0.3 0 0"/><axis xyz="1 0 0"/>
</joint>{more}</robot>"""


def test_a_hinge_is_a_compound_pendulum() -> None:
    """theta'' = -m g l sin theta/(I + m l^2), about x, with the centre of mass half a metre down the tilted arm."""
    model, found = imported(robot(INERTIAL))
    rate = -2 * 9.81 * 0.5 * math.sin(0.3) / (0.2 + 2 * 0.25)
    expected = (0.0, 0.5 * rate * math.cos(0.3), 0.5 * rate * math.sin(0.3))
    assert found["arm"] == pytest.approx(expected, abs=1e-14)
    assert (model.format, model.left_out) == ("urdf", [])


def test_a_prismatic_joint_slides_along_its_axis() -> None:
    """The part of gravity along an axis that is tilted about x, with a damper that does nothing at rest."""
    text = robot(INERTIAL, 'type="prismatic"').replace('<axis xyz="1 0 0"/>', '<axis xyz="0 0 1"/>')
    _, found = imported(text.replace("</joint>", '<dynamics damping="3"/></joint>'))
    along = (0.0, -math.sin(0.3), math.cos(0.3))
    assert found["arm"] == pytest.approx([-9.81 * math.cos(0.3) * x for x in along], abs=1e-14)


def test_a_damped_hinge_slows_down() -> None:
    model, _ = imported(robot(INERTIAL).replace("</joint>", '<dynamics damping="0.7"/></joint>'))
    [damper] = [one for one in model.scene["connections"] if one["kind"] == "damper"]
    assert damper == {"kind": "damper", "a": "arm", "b": "ground", "measure": "turn", "coefficient": 0.7}


def test_massless_links_that_are_fixed_are_places_of_what_carries_them() -> None:
    more = f"""<link name="tip"/><joint name="f" type="fixed"><parent link="arm"/><child link="tip"/>
<origin xyz="0 0 -1"/></joint><link name="fore">{INERTIAL}</link>
<joint name="k" type="continuous"><parent link="tip"/><child link="fore"/><axis xyz="1 0 0"/></joint>"""
    model = import_model(robot(INERTIAL, more=more))
    assert sorted(model.scene["bodies"]) == ["arm", "fore"]
    assert model.scene["bodies"]["arm"]["places"]["k"] == [0.0, 0.0, -0.5]


def test_a_first_link_with_mass_is_free() -> None:
    _, found = imported(f'<robot name="r"><link name="stone">{INERTIAL}</link></robot>')
    assert found["stone"] == pytest.approx((0.0, 0.0, -9.81), abs=1e-14)


def test_what_is_left_out_is_said_line_by_line() -> None:
    inner = f"{INERTIAL}\n<visual/>\n<collision/>"
    own = '<limit lower="-1" upper="1" effort="1" velocity="1"/>\n<dynamics friction="1"/>\n<mimic joint="q"/>'
    text = robot(inner, 'type="revolute"').replace("</joint>", f"{own}</joint>\n<transmission/>")
    said = [(one.line, one.what, one.changes_motion) for one in import_model(text).left_out]
    assert said == [
        (5, "visual", False),
        (6, "collision", True),
        (10, "limit", True),
        (11, "dynamics", True),
        (12, "mimic", True),
        (13, "transmission", False),
    ]


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (robot(INERTIAL, 'type="planar"'), 'line 5: <joint> "j" must be one of'),
        (robot(INERTIAL).replace('child link="arm"', 'child link="leg"'), "line 6: <child> must name a link"),
        (robot(INERTIAL).replace('axis xyz="1 0 0"', 'axis xyz="0 0 0"'), "line 5"),
        (robot("<inertial><mass/></inertial>"), "line 3: <mass> must have the attribute value"),
        (robot(""), 'line 3: "arm" moves and has no mass'),
        (robot(INERTIAL, more='\n<link name="arm"/>'), '<link> "arm" must have a name of its own'),
        ("<robot/>", "have a body that moves"),
        (
            f"""<robot><link name="a">{INERTIAL}</link><link name="b">{INERTIAL}</link><link name="c">{INERTIAL}</link>
<joint name="1" type="fixed"><parent link="a"/><child link="c"/></joint>
<joint name="2" type="continuous"><parent link="b"/><child link="c"/></joint></robot>""",
            'line 6: <joint> "2" must be the only joint of which "c" is the child',
        ),
        (
            f"""<robot><link name="a">{INERTIAL}</link><link name="b">{INERTIAL}</link>
<joint name="1" type="fixed"><parent link="a"/><child link="b"/></joint>
<joint name="2" type="fixed"><parent link="b"/><child link="a"/></joint></robot>""",
            "must not be carried by itself",
        ),
    ],
)
def test_what_is_no_model_is_refused_at_its_line(text: str, says: str) -> None:
    with pytest.raises(InvalidParameter) as fault:
        import_model(text)
    assert fault.value.path == ("document",)
    assert says in fault.value.detail
