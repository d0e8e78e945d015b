"""SDF as scenes: accelerations by hand, and what is left out or refused, with its line."""

from __future__ import annotations

import math

import pytest

from core.errors import InvalidParameter
from core.interchange.import_model import import_model
from tests.core.interchange.answers import imported

LINK = """<link name="arm"><pose>0 0 1 0.3 0 0</pose><inertial><pose>0 0 -0.5 0 0 0</pose><mass>2</mass>
<inertia><ixx>0.2</ixx><iyy>0.2</iyy><izz>0.01</izz></inertia></inertial></link>"""


def model(joint: str, link: str = LINK) -> str:
    return f'<sdf version="1.9"><model name="m">\n{link}\n{joint}</model></sdf>'


HINGE = """<joint name="j" type="revolute"><parent>world</parent><child>arm</child>
<axis><xyz>1 0 0</xyz></axis></joint>"""


def test_a_hinge_is_a_compound_pendulum_under_the_gravity_of_sdf() -> None:
    """theta'' = -m g l sin theta/(I + m l^2) about x; a document without a world has 9.8 m/s^2."""
    found, accelerations = imported(model(HINGE))
    rate = -2 * 9.8 * 0.5 * math.sin(0.3) / (0.2 + 2 * 0.25)
    expected = (0.0, 0.5 * rate * math.cos(0.3), 0.5 * rate * math.sin(0.3))
    assert accelerations["arm"] == pytest.approx(expected, abs=1e-14)
    assert (found.format, found.left_out) == ("sdf", [])


def test_a_hinge_has_its_spring() -> None:
    """I' theta'' = -m g l sin theta - k (angle since the start - reference)."""
    spring = "<dynamics><spring_stiffness>4</spring_stiffness><spring_reference>0.1</spring_reference></dynamics>"
    found, accelerations = imported(model(HINGE.replace("</axis>", f"{spring}</axis>")))
    rate = (-2 * 9.8 * 0.5 * math.sin(0.3) + 4 * 0.1) / (0.2 + 2 * 0.25)
    assert found.left_out == []
    assert accelerations["arm"][1:] == pytest.approx(
        (0.5 * rate * math.cos(0.3), 0.5 * rate * math.sin(0.3)), abs=1e-14
    )


def test_axes_may_be_expressed_in_the_model() -> None:
    text = model(HINGE.replace("<xyz>1 0 0", '<xyz expressed_in="__model__">0 1 0'))
    [pin] = import_model(text).scene["connections"]
    assert pin["axis"] == [0.0, 1.0, 0.0]


def test_models_of_a_world_are_told_apart_and_static_ones_are_the_ground() -> None:
    stone = LINK.replace("arm", "stone")
    text = f"""<sdf version="1.9"><world name="w"><gravity>0 0 -3</gravity><model name="a">{LINK}{HINGE}</model>
<model name="b">{stone}</model><model name="c"><static>true</static>{LINK}{HINGE}</model></world></sdf>"""
    found, accelerations = imported(text)
    assert sorted(found.scene["bodies"]) == ["a-arm", "b-stone"]
    assert accelerations["b-stone"] == pytest.approx((0.0, 0.0, -3.0), abs=1e-15)


def test_links_of_models_whose_names_join_alike_are_two_bodies() -> None:
    first, second = LINK.replace("arm", "b-c"), LINK.replace("arm", "c")
    text = f"""<sdf version="1.9"><world name="w"><model name="a">{first}</model><model name="a-b">{second}</model>
</world></sdf>"""
    assert list(import_model(text).scene["bodies"]) == ["a-b-c", "a-b-c-2"]


def test_what_is_left_out_is_said_line_by_line() -> None:
    joint = HINGE.replace("</axis>", "\n<limit><lower>-1</lower></limit></axis>")
    said = import_model(model(f"{joint}\n<plugin/>")).left_out
    assert [(one.line, one.what) for one in said] == [(6, "limit"), (7, "plugin")]


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (model(HINGE.replace("revolute", "screw")), 'line 4: <joint> "j" must be one of'),
        (model(HINGE.replace("<child>arm", "<child>leg")), "a link of the model as its child"),
        (model(HINGE.replace("<xyz>1 0 0", "<xyz>0 0 0")), "axes other than zero"),
        (model(HINGE.replace("<xyz>1 0 0", "<xyz>1 0")), "3 numbers in xyz"),
        (model(HINGE + HINGE), '<joint> "j" must have a name of its own'),
        (model(HINGE + HINGE.replace('"j"', '"k"')), 'line 5: <joint> "k" must be the only joint'),
        (model(HINGE, LINK.replace("<pose>0 0 1", '<pose relative_to="leg">0 0 1')), "relative to the model"),
        ('<sdf version="1.9"/>', "must have a <model>"),
        (model(HINGE, f"{LINK}\n{LINK}"), 'line 4: <link> "arm" must have a name of its own: <link> of line 2 has it'),
        (model(HINGE, LINK.replace("arm", "world")), "a name that SDF does not keep"),
        (
            f"""<sdf version="1.9"><world name="w"><model name="m">{LINK}</model>
<model name="m">{LINK}</model></world></sdf>""",
            'line 3: <model> "m" must have a name of its own',
        ),
    ],
)
def test_what_is_no_model_is_refused_at_its_line(text: str, says: str) -> None:
    with pytest.raises(InvalidParameter) as fault:
        import_model(text)
    assert says in fault.value.detail


@pytest.mark.parametrize("kind", ["fixed", "ball"])
@pytest.mark.parametrize("ends", [("ab", "ba"), ("ab", "bc", "ca"), ("aa",)])
def test_links_that_carry_one_another_are_refused_at_the_last_joint(kind: str, ends: tuple[str, ...]) -> None:
    links = "".join(LINK.replace("arm", name) for name in "abc").replace("\n", "")
    joints = "".join(
        f'\n<joint name="{p}-{c}" type="{kind}"><parent>{p}</parent><child>{c}</child></joint>' for p, c in ends
    )
    with pytest.raises(InvalidParameter, match=f"line {2 + len(ends) + 1}: .* carry one another"):
        import_model(model(joints, links))


def test_a_long_chain_of_fixed_links_is_one_body() -> None:
    """Of links without mass but the first, in the order of the file and in the other."""
    count = 390
    links = LINK.replace("arm", "l0") + "".join(
        f'<link name="l{k}"><inertial><mass>0</mass><inertia><ixx>0</ixx><iyy>0</iyy><izz>0</izz></inertia>'
        "</inertial></link>"
        for k in range(1, count)
    )
    joints = [
        f'<joint name="j{k}" type="fixed"><parent>l{k - 1}</parent><child>l{k}</child></joint>' for k in range(1, count)
    ]
    for order in (1, -1):
        assert list(import_model(model("".join(joints[::order]), links)).scene["bodies"]) == ["l0"]
