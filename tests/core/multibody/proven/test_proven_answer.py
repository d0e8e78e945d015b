"""Described scenes to many digits, against closed forms and Lagrange's equations in mpmath."""

from __future__ import annotations

import re
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from mpmath import mp, mpf

from core.errors import BudgetExceeded, InvalidParameter, NotApplicable
from core.multibody.proven.part_proof import ProvenAnswer
from core.multibody.proven.proven_answer import proven_answer
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
HELD: dict[str, Any] = {
    "gravity": [0, "-9.81"],
    "bodies": {
        "bar": {
            "mass": 1,
            "inertia": "1/3",
            "at": [0, -1],
            "angle": 0,
            "angular_velocity": 1,
            "velocity": [1, 0],
            "places": {"top": [0, 1]},
        }
    },
    "connections": [
        {"kind": "pin", "a": "bar.top", "b": [0, 0]},
        {"kind": "torsion-spring", "a": "bar", "b": "ground", "stiffness": 2},
    ],
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


@pytest.mark.parametrize(("digits", "time"), [(30, "0.5"), (30, "-0.2"), (30, "0"), (40, "1e9"), (300, "-77.7")])
def test_a_pendulum_by_elliptic_functions(digits: int, time: str) -> None:
    """theta = 2 asin(k sn(K + sqrt(g) t, k)) from rest at the amplitude; Whittaker, Analytical Dynamics, section 44."""
    found = asked(SWING, digits, [time])
    assert found.columns is not None
    with mp.workdps(digits + 20):
        k, rate = mp.sin(mpf("1.25")), mp.sqrt(mpf("9.81"))
        phase = mp.ellipk(k * k) + rate * mpf(time)
        phase -= 4 * mp.ellipk(k * k) * mp.nint(phase / (4 * mp.ellipk(k * k)))
        half = mp.asin(k * mp.ellipfun("sn", phase, k=k))
        (row,) = found.columns["bob.position"].values
        assert near(row[0], mp.sin(2 * half), digits, 1)
        assert near(row[1], -mp.cos(2 * half), digits, 1)
        assert near(found.model.apart[0].period, 4 * mp.ellipk(k * k) / rate, digits)


@pytest.mark.parametrize("tilted", [False, True])
def test_what_turns_over_counts_its_turns_at_any_time(tilted: bool) -> None:
    """From the lowest place half the angle is am(r w0 t, 1/r), r = omega/(2 w0); also in a scene turned as a whole."""
    bar = {"mass": 1, "inertia": "1/3", "angular_velocity": -9, "places": {"top": [0, 1]}}
    gravity: list[str]
    if tilted:
        gravity = ["9.81*0.6", "-9.81*0.8"]
        bar |= {"at": ["0.6", "-0.8"], "angle": "asin(0.6)", "velocity": ["-9*0.8", "-9*0.6"]}
    else:
        gravity = ["0", "-9.81"]
        bar |= {"at": [0, -1], "angle": 0, "velocity": [-9, 0]}
    pin = {"kind": "pin", "a": "bar.top", "b": [0, 0]}
    scene = {"gravity": gravity, "bodies": {"bar": bar}, "connections": [pin]}
    found = asked(scene, 30, ["1000.25"])
    assert found.columns is not None
    with mp.workdps(60):
        slow = mp.sqrt(mpf("9.81") * 3 / 4)
        r = 9 / (2 * slow)
        quarter = mp.ellipk(1 / r**2)
        u = slow * r * mpf("1000.25")
        halves = mp.nint(u / (2 * quarter))
        sine = mp.ellipfun("sn", u - 2 * halves * quarter, m=1 / r**2)
        angle = -2 * (halves * mp.pi + mp.asin(sine)) + (mp.asin(mpf("0.6")) if tilted else 0)
        assert near(found.columns["bar.angle"].values[0], angle, 30)


@pytest.mark.parametrize("time", ["2", "-1e7"])
@pytest.mark.parametrize("speed", ["0.9", "1.5"], ids=["ellipse", "hyperbola"])
def test_an_orbit_by_keplers_equation(speed: str, time: str) -> None:
    """From the apse at distance one: M = E - e sin E or e sinh F - F, with e the excentricity from the near apse."""
    scene = {
        "bodies": {"point": {"mass": 2, "at": [1, 0], "velocity": [0, speed]}},
        "connections": [{"kind": "inverse-square", "a": "point", "b": [0, 0], "strength": 2}],
    }
    found = asked(scene, 30, [time])
    assert found.columns is not None
    with mp.workdps(70):
        t, square = mpf(time), mpf(speed) ** 2
        energy = square / 2 - 1
        a, e = -1 / (2 * energy), abs(square - 1)
        if energy < 0:
            # Below the circular speed it starts at the far apse, where E is pi.
            mean = mp.pi + t / a ** mpf("1.5")
            anomaly = mp.findroot(lambda E: E - e * mp.sin(E) - mean, mean)
            x, y = a * (mp.cos(anomaly) - e), a * mp.sqrt(1 - e * e) * mp.sin(anomaly)
            place = -x, -y
        else:
            mean = t / (-a) ** mpf("1.5")
            anomaly = mp.findroot(lambda F: e * mp.sinh(F) - F - mean, mp.asinh(mean / e))
            place = -a * (e - mp.cosh(anomaly)), -a * mp.sqrt(e * e - 1) * mp.sinh(anomaly)
        for one, true in zip(found.columns["point.position"].values[0], place, strict=True):
            assert near(one, true, 30, mp.hypot(*place))


@pytest.mark.parametrize("time", ["0.25", "1e6"])
@pytest.mark.parametrize("moments", [["1.1", "2.3", "3"], ["3", "1.1", "2.3"], ["2.3", "1.1", "3"]], ids=lambda x: x[0])
def test_a_free_body_of_decimal_moments(moments: list[str], time: str) -> None:
    """Moments and rates that are no doubles, in several orders: Jacobi's solution in mpmath."""
    rates = ["0.1", "1", "-0.7"]
    body = {"mass": 1, "at": [0, 0, 0], "moments": moments, "angular_velocity": rates}
    found = asked({"bodies": {"body": body}}, 25, [time])
    assert found.columns is not None
    exact = [Fraction(x) for x in moments], [Fraction(x) for x in rates], [Fraction(time)]
    with mp.workdps(50):
        (q,), (w,) = reference_attitude(*exact), reference_angular_velocity(*exact)
        for own, true, size in (("attitude", q, 1), ("angular_velocity", w, mp.norm(w))):
            (row,) = found.columns[f"body.{own}"].values
            sign = mp.sign(mpf(row[0]) * true[0]) if own == "attitude" else 1
            assert all(near(x, sign * y, 25, size) for x, y in zip(row, true, strict=True))


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
        asked(HELD, 20, ["1e5"])
    assert late.value.path == ("times",)
    # It says how far the steps reach, and there they do.
    reach = re.search(r"up to about (\S+) s", str(late.value.remedy))
    assert reach is not None
    assert late.value.needed > late.value.limit
    assert asked(HELD, 20, [str(0.9 * float(reach[1]))]).rows == [0]
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
