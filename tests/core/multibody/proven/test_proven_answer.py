"""Described scenes to many digits, against closed forms and Lagrange's equations in mpmath."""

from __future__ import annotations

import re
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from mpmath import mp, mpf

from core.errors import BudgetExceeded, InvalidParameter, NotApplicable
from core.multibody.proven.proven_answer import ProvenAnswer, proven_answer
from core.multibody.solve import solve_scene
from tests.core.multibody.proven.test_proven_series import SWING
from tests.core.multibody.worked_examples import read
from tests.oracles.free_rotation import reference_angular_velocity, reference_attitude

PULLEY: dict[str, Any] = {
    "gravity": [0, "-9.81"],
    "bodies": {
        "a": {"mass": 1, "at": ["-0.1", -1]},
        "b": {"mass": 2, "at": ["0.1", -1]},
        "wheel": {"mass": "0.5", "radius": "0.1", "inertia": "0.0025", "at": [0, 0]},
    },
    "connections": [
        {"kind": "pin", "a": "wheel", "b": [0, 0]},
        {"kind": "string", "name": "s", "through": ["a", "wheel", "b"], "sides": {"wheel": ["left", "right"]}},
    ],
}
SPRINGS: dict[str, Any] = {
    "bodies": {"one": {"mass": 1, "at": [1.5, 0]}, "two": {"mass": 1, "at": [2, 0]}},
    "connections": [
        {"kind": "slider", "a": "one", "b": [0, 0]},
        {"kind": "slider", "a": "two", "b": [0, 0]},
        {"kind": "spring", "a": [0, 0], "b": "one", "stiffness": 1, "rest_length": 1},
        {"kind": "spring", "a": "one", "b": "two", "stiffness": 1, "rest_length": 1},
    ],
}
POINTS: dict[str, Any] = {
    "gravity": [0, "-9.81"],
    "bodies": {
        "upper": {"mass": 1, "at": ["sin(1)", "-cos(1)"]},
        "lower": {"mass": 1, "at": ["sin(1) - sin(0.5)", "-cos(1) - cos(0.5)"]},
    },
    "connections": [{"kind": "rod", "a": "upper", "b": [0, 0]}, {"kind": "rod", "a": "lower", "b": "upper"}],
}
TOP: dict[str, Any] = {
    "bodies": {"body": {"mass": 1, "at": [0, 0, 0], "moments": [1, 2, 3], "angular_velocity": [0.25, 1, 0.5]}}
}


def asked(scene: dict[str, Any], digits: int, times: list[str] | None = None, **more: Any) -> ProvenAnswer:
    return proven_answer(read(scene), digits, [Fraction(time) for time in times or []], **more)


def near(numeral: Any, true: Any, digits: int, scale: Any = None) -> bool:
    size = abs(true) if scale is None else scale
    return bool(abs(mpf(numeral) - true) <= mpf("0.51") * mpf(10) ** (1 - digits) * size)


def test_a_pulley_with_mass_to_fifty_digits() -> None:
    found = asked(PULLEY, 50, ["0.5"])
    with mp.workdps(70):
        g = mpf("9.81")
        a = g / (3 + mpf("0.25"))
        assert found.accelerations is not None
        assert near(found.accelerations["b"].linear[1], -a, 50)
        assert found.accelerations["b"].linear[0] == "0"
        assert found.forces is not None
        assert near(found.forces["s.1.tension"].value, g + a, 50)
        assert near(found.forces["s.2.tension"].value, 2 * (g - a), 50)
        assert found.energy is not None
        assert near(found.energy.potential, -3 * g, 50)
        assert found.columns is not None
        assert near(found.columns["b.position"].values[0][1], -1 - a / 8, 50)
        assert near(found.columns["a.velocity"].values[0][1], a / 2, 50)
        assert near(found.columns["wheel.angle"].values[0], -a / 8 / mpf("0.1"), 50)
    assert found.model.name == "constant acceleration"
    assert [notice.code for notice in found.warnings] == ["end-not-proven"]


def test_modes_are_proven_at_any_time() -> None:
    found = asked(SPRINGS, 40, ["1e6", "0.3"])
    with mp.workdps(80):
        slow, fast = (mp.sqrt(5) - 1) / 2, (mp.sqrt(5) + 1) / 2
        (part,) = found.model.apart
        assert near(part.modes[0][0], slow, 40)
        assert near(part.modes[1][0], fast, 40)
        # The deviation (1/2, 0) in the modes (1, phi) and (phi, -1), phi the golden ratio.
        for k, t in enumerate((mpf(10) ** 6, mpf("0.3"))):
            norm = 1 + fast * fast
            x = 1 + (mp.cos(slow * t) + fast * fast * mp.cos(fast * t)) / norm / 2
            assert found.columns is not None
            assert near(found.columns["one.position"].values[k][0], x, 40, mpf(1))


def test_a_pendulum_is_proven_step_by_step() -> None:
    found = asked(SWING, 30, ["0.5", "-0.2", "0"])
    assert found.columns is not None
    with mp.workdps(50):
        k, rate = mp.sin(mpf("1.25")), mp.sqrt(mpf("9.81"))
        quarter = mp.ellipk(k * k)
        for row, t in zip(found.columns["bob.position"].values, ("0.5", "-0.2", "0"), strict=True):
            half = mp.asin(k * mp.ellipfun("sn", quarter + rate * mpf(t), k=k))
            assert near(row[0], mp.sin(2 * half), 30, 1)
            assert near(row[1], -mp.cos(2 * half), 30, 1)


def test_a_double_pendulum_by_lagrange() -> None:
    found = asked(POINTS, 20, ["0.08"])
    assert found.columns is not None
    with mp.workdps(30):

        def slope(t: Any, y: Any) -> list[Any]:
            a, b, u, w = y
            c, s, g = mp.cos(a - b), mp.sin(a - b), mpf("9.81")
            right = (-w * w * s - 2 * g * mp.sin(a), u * u * s - g * mp.sin(b))
            det = 2 - c * c
            return [u, w, (right[0] - c * right[1]) / det, (2 * right[1] - c * right[0]) / det]

        a, b, u, w = mp.odefun(slope, 0, [mpf(1), -mpf("0.5"), mpf(0), mpf(0)])(mpf("0.08"))
        x, y = found.columns["lower.position"].values[0]
        assert near(x, mp.sin(a) + mp.sin(b), 19)
        assert near(y, -mp.cos(a) - mp.cos(b), 19)
        assert near(found.columns["upper.velocity"].values[0][0], u * mp.cos(a), 19)
        assert abs(w) > 0


def test_the_attitude_of_an_asymmetric_top() -> None:
    found = asked(TOP, 25, ["0.25"])
    assert found.columns is not None
    with mp.workdps(50):
        (q,) = reference_attitude([1, 2, 3], [0.25, 1, 0.5], [0.25])
        (rates,) = reference_angular_velocity([1, 2, 3], [0.25, 1, 0.5], [0.25])
        for x, y in zip(found.columns["body.attitude"].values[0], q, strict=True):
            assert near(x, y, 25, 1)
        for x, y in zip(found.columns["body.angular_velocity"].values[0], rates, strict=True):
            assert near(x, y, 25, mp.sqrt(sum(z * z for z in rates)))


def test_angles_count_their_turns() -> None:
    bar = {"mass": 1, "inertia": "1/3", "at": [0, -1], "angle": 0, "angular_velocity": 20, "places": {"top": [0, 1]}}
    scene = {
        "gravity": [0, -9.81],
        "bodies": {"bar": bar},
        "connections": [{"kind": "pin", "a": "bar.top", "b": [0, 0]}],
    }
    found = asked(scene, 18, ["0.2", "0.1"])
    motion = solve_scene(read(scene), [0.2, 0.1]).trajectory
    assert motion is not None
    assert found.columns is not None
    assert float(found.columns["bar.angle"].values[0]) > np.pi
    proven = np.array(found.columns["bar.angle"].values, dtype=float)
    assert np.abs(proven - motion["bar.angle"]).max() <= motion.columns["bar.angle"].error + 1e-14


def test_what_cannot_be_proven_is_refused_with_a_remedy() -> None:
    rounded = {
        "gravity": [0, -9.81],
        "bodies": {"bob": {"mass": 1, "at": [0.6, -0.8000000001]}},
        "connections": [{"kind": "rod", "a": "bob", "b": [0, 0], "length": 1}],
    }
    block = {"mass": 1, "at": [0, 0], "velocity": [1, 0]}
    touching = {
        "gravity": [0, -9.81],
        "bodies": {"block": block},
        "connections": [{"kind": "contact", "place": "block", "on": {"at": [0, 0]}}],
    }
    for scene in (rounded, touching):
        with pytest.raises(NotApplicable) as refusal:
            asked(scene, 20)
        assert refusal.value.path[0] == "connections"
        assert refusal.value.remedy
    with pytest.raises(BudgetExceeded) as late:
        asked(SWING, 20, ["1e5"])
    assert late.value.path == ("times",)
    # It says how far the steps reach, and there they do.
    reach = re.search(r"up to about (\S+) s", str(late.value.remedy))
    assert reach is not None
    assert late.value.needed > late.value.limit
    assert asked(SWING, 20, [str(0.9 * float(reach[1]))]).rows == [0]
    for times, more in ((["1e400"], {}), (["0", "-1e301"], {}), ([], {"outputs": ("trajectory",)})):
        with pytest.raises(InvalidParameter) as fault:
            asked(SWING, 20, times, **more)
        assert fault.value.path == ("times",)
    with pytest.raises(InvalidParameter):
        asked(SWING, 15)


def test_only_what_is_requested_is_answered() -> None:
    found = asked(PULLEY, 20, ["0.5"], outputs=("energy",))
    assert found.columns is None
    assert found.accelerations is None
    assert found.energy is not None
    assert found.ended == "horizon"
    assert asked(PULLEY, 20).ended is None


def test_parts_that_share_no_connection_have_the_digits_that_they_have_alone() -> None:
    far = {"mass": 2, "at": [9, 1], "velocity": [1, 3]}
    fall = {"gravity": POINTS["gravity"], "bodies": {"far": far}}
    both = {**POINTS, "bodies": POINTS["bodies"] | fall["bodies"]}
    found, points, falling = (asked(scene, 22, ["0.25"]) for scene in (both, POINTS, fall))
    assert points.columns is not None
    assert falling.columns is not None
    assert found.columns == {**points.columns, **falling.columns}
    assert found.model.apart == (*points.model.apart, *falling.model.apart)
    assert found.accelerations == {**(points.accelerations or {}), **(falling.accelerations or {})}
    with mp.workdps(40):
        assert found.energy is not None
        heights = -mpf("9.81") * (2 * mp.cos(1) + mp.cos(mpf("0.5"))) + 2 * mpf("9.81")
        assert near(found.energy.total, heights + 10, 22)


def test_the_motion_of_parts_ends_with_the_first_of_them() -> None:
    """The weight of the pulley reaches it after 0.81 s."""
    far = {"mass": 2, "at": [9, 1], "velocity": [1, 3]}
    both = {**PULLEY, "bodies": PULLEY["bodies"] | {"far": far}}
    alone, found = asked(PULLEY, 18, ["0.5", "5"]), asked(both, 18, ["0.5", "5"])
    assert (found.rows, found.ended) == (alone.rows, alone.ended) == ([0], "singular")
