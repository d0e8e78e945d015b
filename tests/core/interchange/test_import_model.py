"""Documents told apart by their root, and the scenes that are written of what was read."""

from __future__ import annotations

import pytest

from core.errors import InvalidParameter
from core.interchange.draft import MOST_BODIES
from core.interchange.import_model import import_model
from tests.core.interchange.answers import imported

INERTIAL = '<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>'


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("<model/>", 'not "model"'),
        ('<xacro:macro xmlns:xacro="x"/>', "expanded to URDF"),
        ("<mujoco/>", "have a body that moves"),
    ],
)
def test_other_documents_are_refused(text: str, says: str) -> None:
    with pytest.raises(InvalidParameter) as fault:
        import_model(text)
    assert says in f"{fault.value.detail} {fault.value.remedy}"


def test_names_become_names_of_a_scene() -> None:
    """Of letters, digits, - and _, each once, also beside names of joints."""
    bodies = "".join(
        f'<body name="{name}"><joint name="{joint}"/>{INERTIAL}</body>'
        for name, joint in (("1 left", "a/b"), ("ground", "a b"), ("a-b", "j"))
    )
    scene = import_model(f"<mujoco><worldbody>{bodies}</worldbody></mujoco>").scene
    assert list(scene["bodies"]) == ["body-1-left", "ground-2", "a-b"]
    assert [one["name"] for one in scene["connections"]] == ["a-b-2", "a-b-3", "j"]


def test_joints_of_the_plane_elsewhere_are_refused() -> None:
    joints = '<joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 1 1"/><joint axis="0 -1 1"/>'
    with pytest.raises(InvalidParameter, match="line 2: these joints are joints of a model in a plane"):
        import_model(f"<mujoco><worldbody>\n<body>{joints}{INERTIAL}</body></worldbody></mujoco>")


def test_a_slide_on_the_ground_has_its_spring_and_damper() -> None:
    """m x'' = -k (x - x0) - b x' along a tilted axis, without gravity."""
    body = '<body pos="5 0 0"><joint type="slide" axis="0.6 0 0.8" stiffness="3" damping="2" springref="0.5"/>'
    text = f"""<mujoco><option gravity="0 0 0"/><worldbody>{body}{INERTIAL}</body></worldbody>
<keyframe><key qpos="0.1" qvel="0.2"/></keyframe></mujoco>"""
    _, found = imported(text)
    along = -3 * (0.1 - 0.5) - 2 * 0.2
    assert found["body-1"] == pytest.approx((0.6 * along, 0.0, 0.8 * along), abs=1e-13)


def test_what_is_welded_to_the_ground_is_the_ground() -> None:
    post = f'<body name="post" pos="0 0 1">{INERTIAL}<body name="arm"><joint axis="1 0 0"/>{INERTIAL}</body></body>'
    scene = import_model(f"<mujoco><worldbody>{post}</worldbody></mujoco>").scene
    assert list(scene["bodies"]) == ["arm"]
    assert scene["connections"][0]["b"] == [0.0, 0.0, 1.0]


def test_more_bodies_than_are_read_are_refused_with_the_line_of_the_first() -> None:
    mjcf = "<mujoco><worldbody>\n" + f"<body><freejoint/>{INERTIAL}</body>\n" * (MOST_BODIES + 1)
    urdf = "<robot>\n" + "".join(
        f'<link name="l{k}"><inertial><mass value="1"/></inertial></link>\n' for k in range(MOST_BODIES + 1)
    )
    for text in (f"{mjcf}</worldbody></mujoco>", f"{urdf}</robot>"):
        with pytest.raises(InvalidParameter, match=f"line {MOST_BODIES + 2}: it has more than {MOST_BODIES} links"):
            import_model(text)


ARMS = f"""<body name="a"><joint axis="1 0 0"/>{INERTIAL}<site name="s" pos="0 0 1"/></body>
<body name="b" pos="1 0 0"><joint axis="1 0 0"/>{INERTIAL}<site name="t"/></body>"""
TENDON = '<site site="s"/><site site="t"/></spatial></tendon>'


@pytest.mark.parametrize(
    ("bodies", "more", "line", "says"),
    [
        ("<body>\n<freejoint/></body>".replace("</", INERTIAL.replace('"1"', '"-1"') + "</"), "", 1, "mass must be"),
        (f"\n<body><freejoint/>{INERTIAL.replace('1 1 1', '1 2 4')}</body>", "", 2, "moments of matter"),
        (f'\n<body><joint damping="-1"/>{INERTIAL}</body>', "", 2, "negative damping or stiffness"),
        (f'\n<body><joint type="slide" stiffness="-1"/>{INERTIAL}</body>', "", 2, "negative damping or stiffness"),
        (ARMS, f'<tendon>\n<spatial range="3 -1">{TENDON}', 3, "must have a range that ends above its begin"),
        (ARMS, f'<tendon>\n<spatial range="-3 -1">{TENDON}', 3, "length must be greater than 0 m"),
        (ARMS, f'<tendon>\n<spatial stiffness="-1">{TENDON}', 3, "stiffness must be greater than 0"),
        (ARMS, f'<tendon>\n<spatial damping="-1">{TENDON}', 3, "coefficient must be greater than 0"),
        (ARMS, '<equality>\n<connect body1="a" body2="a"/></equality>', 3, "connect two different bodies"),
        (ARMS, '<equality>\n<connect body1="world" body2="world"/></equality>', 3, "connect a body"),
        ('\n<body><freejoint/><geom size="1" mass="-1"/></body>', "", 2, "must have geometries that weigh more"),
        (f"<body><freejoint/>{INERTIAL}</body>" * 101, "", 1, "bodies must have at most 100 entries"),
    ],
)
def test_documents_of_scenes_that_cannot_be_are_refused_with_the_line(
    bodies: str, more: str, line: int, says: str
) -> None:
    with pytest.raises(InvalidParameter, match=f"; line {line}: .*{says}") as fault:
        import_model(f"<mujoco><worldbody>{bodies}</worldbody>{more}</mujoco>")
    assert fault.value.path == ("document",)


def test_all_parts_that_cannot_be_are_told() -> None:
    more = f'<tendon>\n<spatial stiffness="-1">{TENDON}<equality>\n<connect body1="a" body2="a"/></equality>'
    with pytest.raises(InvalidParameter) as fault:
        import_model(f"<mujoco><worldbody>{ARMS}</worldbody>{more}</mujoco>")
    told = [(one.path, one.rule.partition("line ")[2][0]) for one in (fault.value, *fault.value.further)]
    assert sorted(told) == [(("document",), "3"), (("document",), "4")]
