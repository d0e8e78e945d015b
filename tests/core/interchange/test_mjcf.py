"""MJCF as scenes: configurations, velocities and inertias as MuJoCo has them, where it is installed, or by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from core.errors import InvalidParameter
from core.interchange.import_model import import_model
from tests.core.interchange.answers import accelerations, imported

CHAIN = """<mujoco>
<compiler angle="degree" eulerseq="zyx"/>
<default><geom density="500" contype="0" conaffinity="0"/><default class="arm"><geom type="capsule" size="0.03"/>
</default></default>
<worldbody>
<body name="one" pos="0 0.1 1" euler="10 20 30" childclass="arm">
<joint name="h" axis="1 2 0" damping="0.3"/>
<geom fromto="0 0 0 0.2 0 -0.8"/>
<geom class="main" type="box" size="0.1 0.05 0.2" pos="0 0.1 0" axisangle="0 1 0 40"/>
<body name="two" pos="0.2 0 -0.8" quat="1 0.2 0 0.1"><joint type="ball"/>
<geom type="ellipsoid" size="0.1 0.2 0.3" mass="2"/>
<body name="three" pos="0 0 -0.4" xyaxes="1 1 0 -1 1 0"><joint type="slide" axis="0 1 1"/>
<geom type="cylinder" size="0.1 0.2"/>
</body></body></body>
<body name="free" pos="2 0 0"><freejoint/>
<inertial pos="0.1 0 0" mass="3" fullinertia="0.3 0.4 0.5 0.01 0.02 0.03"/></body>
</worldbody>
<keyframe><key qpos="0.2 0.9 0.1 0.2 0 0.05 2 1 0 0.9 0 0.3 0" qvel="1 0.5 -0.4 0.3 0.7 0.1 0.2 0.3 1 2 3"/></keyframe>
</mujoco>"""


def test_a_chain_with_a_keyframe_is_that_of_mujoco() -> None:
    """Masses, centres, velocities and accelerations by MuJoCo itself."""
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_string(CHAIN)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    mujoco.mj_rnePostConstraint(model, data)
    found, rates = imported(CHAIN)
    for name in ("one", "two", "three", "free"):
        i = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, name)
        body, read = found.scene["bodies"][name], np.zeros(6)
        assert body["mass"] == pytest.approx(model.body_mass[i], rel=1e-12)
        assert body["at"] == pytest.approx(data.xipos[i], abs=1e-12)
        mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_BODY, i, read, 0)
        assert body["velocity"] == pytest.approx(read[3:], abs=1e-12)
        mujoco.mj_objectAcceleration(model, data, mujoco.mjtObj.mjOBJ_BODY, i, read, 0)
        # MuJoCo's accelerations are those that an accelerometer shows.
        assert rates[name] == pytest.approx(read[3:] + model.opt.gravity, abs=1e-9)


def test_inertia_of_geometries_is_that_of_their_solids() -> None:
    """A capsule between the ends of `fromto`: cylinder and two half balls, about its middle."""
    model = import_model(
        '<mujoco><worldbody><body name="b"><freejoint/>'
        '<geom type="capsule" size="0.1" fromto="0 0 0 0 0 2" contype="0" conaffinity="0"/></body></worldbody></mujoco>'
    )
    body = model.scene["bodies"]["b"]
    r, h = 0.1, 2.0
    cylinder, balls = 1000 * math.pi * r * r * h, 1000 * 4 / 3 * math.pi * r**3
    along = cylinder * r * r / 2 + balls * 2 / 5 * r * r
    across = cylinder * (r * r / 4 + h * h / 12) + balls * (2 / 5 * r * r + h * h / 4 + 3 / 8 * h * r)
    assert body["mass"] == pytest.approx(cylinder + balls, rel=1e-14)
    assert body["at"] == pytest.approx([0, 0, 1], abs=1e-14)
    assert body["moments"] == pytest.approx([across, across, along], rel=1e-13)


def test_slides_and_a_hinge_in_one_plane_are_a_scene_of_the_plane() -> None:
    """A body that moves in the plane x, z on a spring: a tendon of stiffness 10, half as long without force."""
    text = """<mujoco><worldbody><site name="s" pos="0 2 0"/><body name="b" pos="0 2 -1">
<joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/><joint type="hinge" axis="0 1 0"/>
<inertial pos="0 0 0" mass="2" diaginertia="1 1 1"/><site name="t"/></body></worldbody>
<tendon><spatial stiffness="10" springlength="0.5"><site site="s"/><site site="t"/></spatial></tendon></mujoco>"""
    found, rates = imported(text)
    assert len(found.scene["gravity"]) == 2
    assert rates["b"][:2] == pytest.approx((0.0, -9.81 + 10 * 0.5 / 2), abs=1e-15)


def test_two_hinges_through_one_point_are_a_universal_joint_and_a_slide_with_a_hinge_is_cylindrical() -> None:
    def kinds(joints: str) -> list[str]:
        inertial = '<inertial pos="0 0 -1" mass="1" diaginertia="1 1 1"/>'
        text = f'<mujoco><worldbody><body name="b">{joints}{inertial}</body></worldbody></mujoco>'
        return [one["kind"] for one in import_model(text).scene["connections"]]

    assert kinds('<joint axis="1 0 0"/><joint axis="0 1 0"/>') == ["universal"]
    assert kinds('<joint type="slide" axis="0 0 1"/><joint axis="0 0 1"/>') == ["cylindrical"]
    assert kinds('<joint type="slide" axis="0 0 1"/><joint type="ball"/>') == ["track"]
    assert kinds('<joint type="slide"/><joint type="slide" axis="0 1 0"/><joint type="ball"/>') == ["track"]


def test_hinges_a_little_apart_are_two() -> None:
    """A distance of 1e-7 m is not a point, at the origin as 50 m from it."""
    for far in (0, 50):
        joints = f'<joint axis="1 0 0" pos="{far} 0 0"/><joint axis="0 1 0" pos="{far} 1e-7 1e-7"/>'
        body = f'<body name="b">{joints}<inertial pos="0 0 -1" mass="1" diaginertia="1 1 1"/></body>'
        with pytest.raises(InvalidParameter, match=r"line 1: <body> .* unlike hinge hinge"):
            import_model(f"<mujoco><worldbody>{body}</worldbody></mujoco>")


SLIDES = "".join(f'<joint type="slide" axis="{axis}"/>' for axis in ("1 0 0", "0 1 0", "0 0 1"))


def test_a_body_of_slides_is_a_particle_unless_something_is_off_its_centre() -> None:
    """Ends of a tendon at its centre leave it a particle; one beside the centre makes it a body that may turn."""
    for place, particle in (("0 0 0", True), ("0.1 0 0", False)):
        text = f"""<mujoco><worldbody><site name="s" pos="0 0 2"/>
<body name="b">{SLIDES}<inertial pos="0 0 0" mass="2" diaginertia="1 1 1"/><site name="t" pos="{place}"/></body>
</worldbody><tendon><spatial stiffness="10"><site site="s"/><site site="t"/></spatial></tendon></mujoco>"""
        found = import_model(text)
        assert ("moments" not in found.scene["bodies"]["b"]) is particle
        assert [(one.line, one.why) for one in found.left_out] == (
            [] if particle else [(2, "nothing holds its direction here: it may turn")]
        )


def test_a_body_of_slides_that_touches_keeps_its_shape() -> None:
    text = f"""<mujoco><worldbody><geom type="plane" size="1 1 1"/>
<body name="b" pos="0 0 0.3">{SLIDES}<geom size="0.3"/></body></worldbody></mujoco>"""
    found, rates = imported(text)
    assert found.scene["bodies"]["b"]["shape"] == {"kind": "ball", "radius": 0.3}
    assert [one.line for one in found.left_out] == [2]
    assert rates["b"] == pytest.approx((0.0, 0.0, 0.0), abs=1e-15)


INERTIAL = '<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>'


@pytest.mark.parametrize(
    ("inner", "line", "unread"),
    [
        (f'<worldbody>\n<body gravcomp="1"><joint/>{INERTIAL}</body></worldbody>', 2, "gravcomp"),
        (f'<worldbody><body>\n<joint springdamper="0.1 1"/>{INERTIAL}</body></worldbody>', 2, "springdamper"),
        (
            f"""<default><joint springdamper="0.1 1"/></default>
<worldbody><body>\n<joint/>{INERTIAL}</body></worldbody>""",
            3,
            "springdamper",
        ),
        (f'<compiler settotalmass="5"/><worldbody><body><joint/>{INERTIAL}</body></worldbody>', 1, "settotalmass"),
        (
            """<worldbody><body><joint/>\n<geom size="1" shellinertia="true" contype="0" conaffinity="0"/></body>
</worldbody>""",
            2,
            "shellinertia",
        ),
        (f'<worldbody><body gravcomp="0" user="1"><joint springdamper="0 0"/>{INERTIAL}</body></worldbody>', 0, ""),
    ],
)
def test_attributes_that_nothing_reads_are_left_out_unless_they_say_nothing(inner: str, line: int, unread: str) -> None:
    left_out = import_model(f"<mujoco>{inner}</mujoco>").left_out
    assert [(one.line, one.why) for one in left_out] == ([(line, f"not read of it: {unread}")] if unread else [])


@pytest.mark.parametrize(("setting", "mass"), [("auto", 1.0), ("false", 1.0), ("true", 4000 / 3 * math.pi)])
def test_inertia_is_of_geometries_as_the_compiler_says(setting: str, mass: float) -> None:
    """A ball of water with a radius of 1 m."""
    text = f"""<mujoco><compiler inertiafromgeom="{setting}"/><worldbody><body name="b"><joint/>{INERTIAL}
<geom size="1" contype="0" conaffinity="0"/></body></worldbody></mujoco>"""
    assert import_model(text).scene["bodies"]["b"]["mass"] == pytest.approx(mass, rel=1e-14)


@pytest.mark.parametrize(
    ("inner", "says"),
    [
        ('<body><joint type="twist"/></body>', "line 2: <joint> must be one of"),
        ('<body><joint/><joint pos="1 0 0"/><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/></body>', "joints"),
        ('<body><joint axis="0 0 0"/></body>', "axes other than zero"),
        ('<body quat="0 0 0 0"><joint/></body>', "quaternion other than zero"),
        ('<body><joint/><geom type="mesh"/></body>', "give the body an <inertial>"),
        ('<body><joint/><geom class="c"/></body>', "must name a class"),
        ('<body><joint/><geom type="box" size="1 -1 1"/></body>', "positive sizes"),
        ('<body><joint/><geom type="capsule" fromto="0 0 0 0 0 1" size=" "/></body>', "1 positive sizes"),
        ('<body><joint/><geom type="capsule" fromto="0 0 0 0 0 1" size="-1"/></body>', "1 positive sizes"),
        ('<body name="b"><joint/></body>', "moves and has no mass"),
        ('<include file="/etc/passwd"/>', "must be written out"),
    ],
)
def test_what_is_no_model_is_refused_at_its_line(inner: str, says: str) -> None:
    with pytest.raises(InvalidParameter) as fault:
        import_model(f"<mujoco><worldbody>\n{inner}</worldbody></mujoco>")
    assert "line 2" in fault.value.detail
    assert says in f"{fault.value.detail} {fault.value.remedy}"


def test_a_keyframe_has_the_numbers_of_all_joints() -> None:
    body = '<body><joint/><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/></body>'
    for numbers in ("0 0", ""):
        text = f'<mujoco><worldbody>{body}</worldbody><keyframe>\n<key qpos="{numbers}"/></keyframe></mujoco>'
        with pytest.raises(InvalidParameter, match="line 2: <key> must have qpos"):
            import_model(text)


def test_velocities_of_a_keyframe_begin_the_motion() -> None:
    """Euler's equations about the point of a ball joint: J w' = -w x J w, and a = w' x r + w x (w x r)."""
    text = """<mujoco><worldbody><body name="b"><joint type="ball"/>
<inertial pos="0.6 0 -0.8" mass="1" diaginertia="0.1 0.1 0.1"/></body></worldbody>
<option gravity="0 0 0"/><keyframe><key qvel="0 0 3"/></keyframe></mujoco>"""
    scene = import_model(text).scene
    r, w = np.array([0.6, 0.0, -0.8]), np.array([0.0, 0.0, 3.0])
    inertia = 1.1 * np.eye(3) - np.outer(r, r)
    turn = np.linalg.solve(inertia, -np.cross(w, inertia @ w))
    assert scene["bodies"]["b"]["velocity"] == pytest.approx([0, 1.8, 0], abs=1e-15)
    assert accelerations(scene)["b"] == pytest.approx(np.cross(turn, r) + np.cross(w, np.cross(w, r)), abs=1e-13)


@pytest.mark.parametrize(
    ("sites", "length", "says"),
    [(0, "1", "two sites or more"), (1, "1", "two sites or more"), (2, "", "must have numbers in springlength")],
)
def test_tendons_have_two_sites_and_numbers(sites: int, length: str, says: str) -> None:
    through = '<site site="s"/><site site="t"/>'[: sites * len('<site site="s"/>')]
    text = f"""<mujoco><worldbody><site name="s"/><body pos="1 0 0"><freejoint/>{INERTIAL}<site name="t"/></body>
</worldbody><tendon>\n<spatial stiffness="1" springlength="{length}">{through}</spatial></tendon></mujoco>"""
    with pytest.raises(InvalidParameter, match=rf"line 3: <spatial> .*{says}"):
        import_model(text)
