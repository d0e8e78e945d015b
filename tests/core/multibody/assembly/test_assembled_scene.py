"""Sketches against the nearest places in closed form, by least squares in angles, and by the scenes that they mean."""

from __future__ import annotations

import json
import math
import re
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mpmath import mp, mpf
from scipy.optimize import least_squares, minimize_scalar

from core.errors import InvalidParameter, NotApplicable
from core.multibody.assembly.assembled_scene import assembled
from core.multibody.model_answer import Assembly
from core.multibody.proven.proven_answer import proven_answer
from core.multibody.solve import solve_scene
from core.multibody.statics.thresholds import RestOf
from tests.core.multibody.worked_examples import column, read

EXAMPLES = Path(__file__).parents[4] / "examples" / "scenes"

BOB = {"mass": 2, "at": [0.9, -0.5]}
ROD = {"kind": "rod", "a": "bob", "b": [0, 0], "length": 1.25}


def sketch(bodies: Any, connections: Any, assemble: Any = "nearest", **other: Any) -> Any:
    return read({"gravity": [0, -9.81], "bodies": bodies, "connections": connections, "assemble": assemble} | other)


def assembly_of(scene: Any) -> Assembly:
    found = assembled(scene).assembly
    assert found is not None
    return found


def test_a_point_goes_straight_to_its_circle() -> None:
    found = assembly_of(sketch({"bob": BOB}, [ROD])).bodies["bob"]
    size = math.hypot(0.9, 0.5)
    assert found.at == pytest.approx((0.9 * 1.25 / size, -0.5 * 1.25 / size), rel=1e-15)
    assert found.moved == pytest.approx(1.25 - size, rel=1e-15)
    assert found.errors["moved"] is not None
    assert found.errors["moved"] < 1e-16


def test_the_place_has_all_digits_of_a_proven_answer() -> None:
    found = proven_answer(sketch({"bob": BOB}, [ROD]), 40, [Fraction(0)], ["trajectory"])
    assert found.columns is not None
    with mp.workdps(60):
        size = mp.sqrt(mpf("0.9") ** 2 + mpf("0.5") ** 2)
        x, y = (mpf(text) for text in found.columns["bob.position"].values[0])
        assert abs(x - mpf("0.9") * mpf("1.25") / size) < mpf(10) ** -39
        assert abs(y + mpf("0.5") * mpf("1.25") / size) < mpf(10) ** -39


def test_a_body_about_a_pin_goes_to_the_angle_of_the_least_mean_square() -> None:
    """|l u - x|^2 + 2 k^2 (1 - cos(a - b)) is least where a = atan2(l y + k^2 sin b, l x + k^2 cos b)."""
    bar = {"mass": 2, "inertia": 0.5, "at": [0.5, 0.3], "angle": 1.1, "places": {"end": [-0.6, 0]}}
    found = assembly_of(sketch({"bar": bar}, [{"kind": "pin", "a": "bar.end", "b": [0, 0]}]))
    k = 0.25
    angle = math.atan2(0.6 * 0.3 + k * math.sin(1.1), 0.6 * 0.5 + k * math.cos(1.1))
    assert found.bodies["bar"].angle == pytest.approx(angle, rel=1e-15)
    assert found.bodies["bar"].turned == pytest.approx(angle - 1.1, rel=1e-15)
    away = math.hypot(0.6 * math.cos(angle) - 0.5, 0.6 * math.sin(angle) - 0.3)
    assert found.distance == pytest.approx(math.sqrt(away**2 + 2 * k * (1 - math.cos(angle - 1.1))), rel=1e-14)


def test_in_space_a_body_turns_about_its_axis_alone() -> None:
    """As in the plane, with the second moment about the axis; the axis is tilted by what turns the other way."""
    bar = {"mass": 2, "moments": [0.3, 0.4, 0.5], "at": [0.5, 0.3, 0.1], "places": {"end": [-0.6, 0, 0]},
           "axes": [["cos(1.1)", "sin(1.1)", 0], ["-sin(1.1)", "cos(1.1)", 0], [0, 0, 1]]}  # fmt: skip
    pin = {"kind": "pin", "a": "bar.end", "b": [0, 0, 0], "axis": [0, 0, 1]}
    found = assembly_of(sketch({"bar": bar}, [pin], gravity=[0, 0, -9.81])).bodies["bar"]
    angle = math.atan2(0.6 * 0.3 + 0.25 * math.sin(1.1), 0.6 * 0.5 + 0.25 * math.cos(1.1))
    assert found.axes is not None
    assert found.axes[0] == pytest.approx((math.cos(angle), math.sin(angle), 0.0), abs=1e-15)
    assert abs(found.turned) == pytest.approx(abs(angle - 1.1), rel=1e-13)
    assert found.at[2] == 0.0


def test_a_chain_of_rods_as_least_squares_in_angles() -> None:
    random = np.random.default_rng(3)
    given = np.array([[1.0, 0.2], [1.6, -0.4], [2.7, 0.1]]) + 0.2 * random.standard_normal((3, 2))
    names = ["a", "b", "c"]
    bodies = {
        name: {"mass": k + 1, "at": place.tolist()} for k, (name, place) in enumerate(zip(names, given, strict=True))
    }
    rods = [
        {"kind": "rod", "a": one, "b": other, "length": 1} for one, other in zip(names, [[0, 0], "a", "b"], strict=True)
    ]
    found = assembly_of(sketch(bodies, rods))

    def away(angles: np.ndarray) -> np.ndarray:
        steps = np.stack([np.cos(angles), np.sin(angles)], axis=1)
        return (np.cumsum(steps, axis=0) - given).ravel()

    best = least_squares(away, [0.0, 0.0, 0.0], xtol=1e-15, ftol=1e-15, gtol=1e-15)
    places = given + away(best.x).reshape(3, 2)
    assert np.array([found.bodies[name].at for name in names]) == pytest.approx(places, abs=1e-7)
    assert found.distance == pytest.approx(math.sqrt(2 * best.cost), rel=1e-12)


def test_velocities_go_to_the_nearest_that_the_connections_allow() -> None:
    """On a circle that is the tangential part; of a body about a pin (l v.t + k^2 w)/(l^2 + k^2)."""
    bob = {"mass": 2, "at": [0.6, -0.8], "velocity": [1, 0.5]}
    scene = sketch({"bob": bob}, [{"kind": "rod", "a": "bob", "b": [0, 0], "length": 1}])
    speed = 0.8 * 1 + 0.6 * 0.5
    answer = solve_scene(scene, [0.0])
    assert column(answer, "bob.velocity").values[0] == pytest.approx((0.8 * speed, 0.6 * speed), rel=1e-15)
    assert answer.assembly is not None
    assert answer.assembly.velocities_changed
    bar = {"mass": 2, "inertia": 0.5, "at": [0.6, 0], "places": {"end": [-0.6, 0]}, "velocity": [1, 0.5],
           "angular_velocity": 2}  # fmt: skip
    answer = solve_scene(sketch({"bar": bar}, [{"kind": "pin", "a": "bar.end", "b": [0, 0]}]), [0.0])
    rate = (0.6 * 0.5 + 0.25 * 2) / (0.6**2 + 0.25)
    assert column(answer, "bar.angular_velocity").values[0] == pytest.approx(rate, rel=1e-14)


def test_a_start_that_satisfies_its_connections_is_left_as_it_is() -> None:
    question = json.loads((EXAMPLES / "four-bar-linkage.json").read_text())
    del question["times"]
    found = assembled(read(question | {"assemble": "nearest"}))
    assert found.scene == read(question)
    assert found.assembly is not None
    assert found.assembly.distance == 0.0
    assert not found.assembly.velocities_changed


@pytest.mark.parametrize("degrees", [-170, -60, 35, 100])
def test_a_study_over_one_angle_moves_what_follows_it(degrees: int) -> None:
    """The second bar of a double pendulum follows the first: as described by formulas at the angle that is nearest."""
    question = json.loads((EXAMPLES / "double-pendulum.json").read_text())
    cosine, sine = f"cos({degrees}*pi/180)", f"sin({degrees}*pi/180)"
    question["bodies"]["one"] |= {"at": [f"{cosine}/2", f"{sine}/2"], "angle": {"degrees": degrees}}
    found = solve_scene(read(_without_times(question) | {"assemble": {"nearest": ["two"]}}), [0.0, 0.3])
    assert found.assembly is not None
    assert found.assembly.bodies["one"].moved == 0.0
    end = (math.cos(math.radians(degrees)), math.sin(math.radians(degrees)))
    k, x, y = 0.0833, 1 - end[0], 0.5 - end[1]
    angle = math.atan2(0.5 * y + k, 0.5 * x)
    assert found.assembly.bodies["two"].angle == pytest.approx(
        angle + (2 * math.pi if angle < -math.pi / 2 else 0.0), rel=1e-13
    )
    question["bodies"]["two"] |= {
        "at": [f"{cosine} + cos({angle!r})/2", f"{sine} + sin({angle!r})/2"],
        "angle": angle,
    }
    same = solve_scene(read(_without_times(question)), [0.0, 0.3])
    for name in ("one.position", "two.velocity"):
        assert column(found, name).values == pytest.approx(column(same, name).values, abs=1e-12)


def _without_times(question: dict[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in question.items() if key != "times"}


def test_what_overlaps_is_put_in_touch_and_long_strings_are_pulled_in() -> None:
    bodies = {"a": {"mass": 1, "at": [0, -0.3]}, "b": {"mass": 3, "at": [3, 0.4]}}
    floor = [{"kind": "contact", "place": name, "on": {"at": [0, 0]}} for name in bodies]
    found = assembly_of(sketch(bodies, floor))
    assert found.bodies["a"].at == (0.0, 0.0)
    assert found.bodies["b"].at == (3.0, 0.4)
    found = assembly_of(sketch(bodies, [{"kind": "string", "through": ["a", "b"], "length": 2}]))
    length = math.hypot(3, 0.7)
    share = (length - 2) / 2 / length
    assert found.bodies["a"].at == pytest.approx((3 * share, -0.3 + 0.7 * share), rel=1e-14)
    assert found.bodies["b"].at == pytest.approx((3 - 3 * share, 0.4 - 0.7 * share), rel=1e-14)


def test_connections_that_no_places_satisfy_say_by_how_much() -> None:
    question = json.loads((EXAMPLES / "four-bar-linkage.json").read_text())
    question["connections"][3]["b"] = [7, 0]
    with pytest.raises(InvalidParameter) as refused:
        assembled(read(_without_times(question) | {"assemble": "nearest"}))
    assert "by about 2.59 m" in refused.value.detail
    assert f"{7 - 3 - math.sqrt(2):.6g} m more than the other three links together" in refused.value.detail


def test_places_without_a_nearest_are_refused() -> None:
    with pytest.raises(NotApplicable, match="none is the nearest"):
        assembled(sketch({"bob": {"mass": 1, "at": [0, 0]}}, [ROD]))


def test_chains_are_not_assembled() -> None:
    ends = {"front": {"mass": 0, "at": [0, -0.5]}, "back": {"mass": 0, "at": [-1.5, 0]}}
    chain = {"kind": "chain", "through": ["front", [0, 0], "back"], "density": 1.2}
    with pytest.raises(NotApplicable) as refused:
        assembled(sketch(ends, [chain]))
    assert refused.value.path == ("assemble",)


def test_refused_places_name_the_nearest_that_fit() -> None:
    with pytest.raises(InvalidParameter) as refused:
        solve_scene(read({"gravity": [0, -9.81], "bodies": {"bob": BOB}, "connections": [ROD]}))
    size = math.hypot(0.9, 0.5)
    assert refused.value.remedy is not None
    assert f'"bob" at [{0.9 * 1.25 / size:.10g}, {-0.5 * 1.25 / size:.10g}]' in refused.value.remedy
    with pytest.raises(InvalidParameter) as refused:
        solve_scene(read({"gravity": [0, -9.81], "bodies": {"bob": BOB}, "connections": [ROD, ROD | {"b": [3, 0]}]}))
    assert refused.value.remedy is not None
    assert "no places satisfy them all" in refused.value.remedy


@pytest.mark.parametrize(("slope", "spot"), [(0.5, (-0.2, 0.1)), (0.0, (-0.2, 0.1)), (0.5, (0.0, 0.0))])
def test_bodies_on_one_slider_turn_alike(slope: float, spot: tuple[float, float]) -> None:
    body = {"mass": 1, "inertia": 0.3, "places": {"spot": spot}}
    bodies = {"a": {**body, "at": [0, 1]}, "b": {**body, "at": [1.2, 1]}}
    slider = {"kind": "slider", "a": "a.spot", "b": "b", "slope": slope}
    found = solve_scene(read({"bodies": bodies, "connections": [slider], "assemble": "nearest"}))

    def displacement(angle: float) -> float:
        # Both turn by the angle; what the place is beside the line then is taken half by either body.
        c, s = math.cos(angle), math.sin(angle)
        place = -1.2 + c * spot[0] - s * spot[1], s * spot[0] + c * spot[1]
        beside = math.cos(slope + angle) * place[1] - math.sin(slope + angle) * place[0]
        return beside**2 / 2 + 2 * 0.3 * 2 * (1 - c)

    angle = minimize_scalar(displacement, bounds=(-1.5, 1.5), options={"xatol": 1e-12}).x
    assert found.assembly is not None
    for name in ("a", "b"):
        assert found.assembly.bodies[name].angle == pytest.approx(angle, abs=1e-7)


def test_a_ball_that_nothing_sees_turn_keeps_its_angular_velocity() -> None:
    ball = {"mass": 2, "at": [0, 0.3, 0], "moments": [1, 1, 1], "angular_velocity": [1, 2, 3], "velocity": [1, 1, 1]}
    plane = {"kind": "track", "name": "plane", "place": "ball", "on": {"at": [0, 0, 0], "normal": [0, 1, 0]}}
    with pytest.raises(InvalidParameter) as refused:
        solve_scene(read({"bodies": {"ball": ball}, "connections": [plane]}))
    assert refused.value.remedy is not None
    assert '"ball" at [0, 0, 0]' in refused.value.remedy


@pytest.mark.parametrize("wrong", ["near", {"nearest": []}, {"nearest": ["bop"]}, {"closest": ["bob"]}])
def test_an_assembly_that_is_none_is_refused(wrong: Any) -> None:
    with pytest.raises(InvalidParameter) as refused:
        assembled(sketch({"bob": BOB}, [ROD], wrong))
    assert refused.value.path[0] == "assemble"


def test_a_range_of_rest_is_that_of_the_places_that_are_found() -> None:
    """A bar against a smooth wall at the angle a rests with friction mu >= 1/(2 tan a) on the floor."""
    bar = {"mass": 1, "inertia": 0.1, "at": [0.45, 0.8], "angle": 2.1, "places": {"foot": [-1, 0], "top": [1, 0]}}
    scene = sketch(
        {"bar": bar},
        [
            {"kind": "contact", "place": "bar.foot", "on": {"at": [0, 0]}, "friction": 0.9},
            {"kind": "contact", "place": "bar.top", "on": {"at": [0, 0], "slope": {"degrees": -90}}},
        ],
    )
    angle = assembly_of(scene).bodies["bar"].angle
    assert angle is not None
    found = solve_scene(scene, outputs=[RestOf("/connections/0/friction", [0, 2])]).thresholds
    assert found is not None
    assert found[0].lower is not None
    assert found[0].lower.value == pytest.approx(1 / (2 * math.tan(math.pi - angle)), rel=1e-12)


@pytest.mark.parametrize("size", ["0.001", "1", "10", "1000"])
def test_a_sketch_whose_size_is_a_power_of_ten_is_assembled(size: str) -> None:
    rod = {"kind": "rod", "a": "p", "b": [0, 0], "length": 1}
    bodies = {"p": {"mass": 1, "at": ["0.6*1.1", "-0.8*1.1"]}, "far": {"mass": 1, "at": [size, 0]}}
    place = assembly_of(sketch(bodies, [rod])).bodies["p"].at
    assert [float(x) for x in place] == pytest.approx([0.6, -0.8], abs=1e-15)


def test_places_that_disagree_are_refused_without_a_word_of_a_sketch_that_nobody_asked_for() -> None:
    """Of what is held at a transcendental function no nearest places are sought."""
    held = {"kind": "relation", "of": "bob.x - exp(bob.y)", "equals": 5}
    with pytest.raises(InvalidParameter) as refused:
        solve_scene(read({"gravity": [0, -9.81], "bodies": {"bob": BOB}, "connections": [held]}))
    assert "assemble" not in f"{refused.value.rule} {refused.value.remedy}"


@pytest.mark.parametrize("radius", [1e150, 1e155, 1e160, 1e299])
def test_a_shape_whose_squares_are_no_doubles_does_not_fit_and_that_is_said(radius: float) -> None:
    wheel = {"mass": 2, "radius": radius, "inertia": 0.01, "at": [0.03, 0.09]}
    rolling = {"kind": "rolling", "place": "wheel", "on": {"at": [0, 0], "slope": {"degrees": -20}}}
    with pytest.raises(InvalidParameter) as refused:
        solve_scene(sketch({"wheel": wheel}, [rolling], None))
    assert refused.value.remedy is not None
    assert not re.search(r"\b(nan|inf|0) m\b", refused.value.remedy)


@pytest.mark.parametrize("y", [0.5, 1.5])
@pytest.mark.parametrize(
    ("kind", "axes"),
    [
        ("cylindrical", {"axis": [0, 0, 1]}),
        ("screw", {"axis": [0, 0, 1], "pitch": 0.1}),
        ("universal", {"axes": [[0, 0, 1], [1, 0, 0]]}),
    ],
)
def test_a_plate_beside_its_joint_is_offered_the_place_on_it(kind: str, axes: dict[str, Any], y: float) -> None:
    # A plate has no extent along its third axis: turns of that axis alone would cost next to nothing.
    plate = {"mass": 1, "moments": [0.1, 0.1, 0.2], "at": [0, y, 0]}
    connections = [{"kind": kind, "a": "a", "b": [0, 0, 0], **axes}]
    with pytest.raises(InvalidParameter) as fault:
        solve_scene(read({"bodies": {"a": plate}, "gravity": [0, 0, -9.81], "connections": connections}), [0.0])
    assert '"a" at [0, 0, 0]' in (fault.value.remedy or "")


def test_springs_that_nowhere_balance_are_refused_with_what_stays_open() -> None:
    bodies = {"p": {"mass": 0, "at": [0, -1]}, "m": {"mass": 1, "at": [0, -2]}}
    connections = [
        {"kind": "spring", "a": [0, 0], "b": "p", "stiffness": 40, "rest_length": 0.9},
        {"kind": "spring", "a": "p", "b": "m", "stiffness": 40, "rest_length": 100},
    ]
    with pytest.raises(InvalidParameter, match="where its springs balance"):
        solve_scene(read({"bodies": bodies, "gravity": [0, -9.81], "connections": connections}), [0.0])
