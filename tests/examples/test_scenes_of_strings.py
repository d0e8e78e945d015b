"""Described scenes of strings, pulleys and inclines: uniform accelerations by hand.

References
----------
D. Morin, Introduction to Classical Mechanics (2008), section 3.1 (Atwood's machines), problems 3.8 (a plane that moves)
and 6.1; L. D. Landau, E. M. Lifshitz, Mechanics, section 5 (Lagrange's equations).
"""

from __future__ import annotations

import numpy as np
import pytest
from mpmath import exp, mp, mpf, pi

from tests.examples.scene_columns import agree, columns, in_time, times
from tests.oracles.minimal_coordinates import cos, exact, sin, sqrt

G = 9.81
EXACT = 4 * 2.0**-52


def force(answer, name):
    assert answer["forces"][name]["determined"]
    return answer["forces"][name]["value"]


def test_atwood_s_machine(answer_of):
    """(m1 + m2) a = (m2 - m1) g, T = 2 m1 m2 g/(m1 + m2)."""
    answer = answer_of("scenes/atwood-machine")
    assert answer["accelerations"]["light"]["linear"] == [0.0, pytest.approx(G / 2, rel=EXACT)]
    assert force(answer, "string-1.tension") == pytest.approx(1.5 * G, rel=EXACT)

    def places(t):
        fallen = exact(G) / 4 * t * t
        return {"light.position": (exact(-0.1), fallen - 0.5), "heavy.position": (exact(0.1), -fallen - 0.5)}

    agree(answer, in_time(answer, places))


def test_the_double_atwood_machine(answer_of):
    """Lagrange: x the fall of the wheel, s that of the heavier mass beside it.

    2 L = (M + w + a + b) x'^2 + 2 (b - a) x' s' + (a + b + I/R^2) s'^2 + 2 g (w + a + b - M) x + 2 g (b - a) s.
    """
    answer = answer_of("scenes/double-atwood-machine")
    x, s = np.linalg.solve([[7.5, 1], [1, 3.25]], [-0.5 * G, G])
    assert answer["accelerations"]["wheel"]["linear"] == [0.0, pytest.approx(-x, rel=EXACT)]
    assert answer["accelerations"]["wheel"]["angular"] == pytest.approx(-s / 0.1, rel=EXACT)
    tensions = [force(answer, name + ".tension") for name in ("upper", "lower.1", "lower.2")]
    assert tensions == pytest.approx([4 * (G + x), G + s - x, 2 * (G - x - s)], rel=EXACT)

    def places(t):
        # Cramer's rule for the equations above.
        half, pull = t * t / 2, exact(G) / (7.5 * 3.25 - 1)
        x, s = half * pull * (-0.5 * 3.25 - 1), half * pull * (7.5 + 0.5)
        return {
            "heavy.position": (exact(-0.3), x - 1),
            "wheel.position": (exact(0.2), -x - 0.5),
            "wheel.angle": -10 * s,
            "a.position": (exact(0.1), s - x - 1),
            "b.position": (exact(0.3), -s - x - 1),
        }

    agree(answer, in_time(answer, places))


def test_atwood_s_machine_with_a_spring(answer_of):
    """e'' = 4 g/3 - 140 e for the elongation e, 3 u'' = 60 e - g for the fall u of the mass above the spring."""
    answer = answer_of("scenes/atwood-machine-with-spring")
    (part,) = answer["model"]["apart"]
    assert max(mode["frequency"] for mode in part["modes"]) == pytest.approx(140**0.5, rel=EXACT)

    def elongation(t):
        mean, rate = exact(G) / 105, sqrt(exact(140))
        return mean, exact(0.1) - mean, cos(rate * t)

    def places(t):
        mean, swing, c = elongation(t)
        u = (60 * mean - exact(G)) / 6 * t * t + swing * (1 - c) / 7
        return {
            "left.position": (exact(-0.1), u - 0.5),
            "right.position": (exact(0.1), -u - 0.5),
            "bob.position": (exact(0.1), -u - exact(0.9) - mean - swing * c),
        }

    agree(answer, in_time(answer, places))
    pull = [sum(a * b for a, b in zip((1, c), (mean, s), strict=True)) for mean, s, c in map(elongation, times(answer))]
    agree(
        answer,
        {
            "spring-2.force": [float(60 * e) for e in pull],
            "string-1.tension": [float(2 * (exact(G) + (60 * e - exact(G)) / 3)) for e in pull],
        },
    )


def test_the_block_and_tackle(answer_of):
    """The weight moves twice as far: 3 a = 3 g - 2 T, 4 a = T - 2 g, and the load goes up by g/11."""
    answer = answer_of("scenes/block-and-tackle")
    assert force(answer, "string-1.tension") == pytest.approx(18 * G / 11, rel=EXACT)

    def places(t):
        up = exact(G) / 22 * t * t
        return {"load.position": (exact(0), up - 2), "weight.position": (exact(1), -2 * up - 1)}

    agree(answer, in_time(answer, places))


def test_blocks_on_an_incline(answer_of):
    """(m1 + m2) a = m2 g - m1 g sin 30."""
    answer = answer_of("scenes/blocks-on-incline")
    assert force(answer, "string-2.tension") == pytest.approx(1.5 * 6 / 7 * G, rel=EXACT)
    assert force(answer, "incline.normal") == pytest.approx(2 * G * 0.75**0.5, rel=EXACT)

    def places(t):
        s = exact(G) / 14 * t * t
        return {
            "block.position": ((s - 1) * sqrt(exact(3)) / 2, (s - 1) / 2),
            "weight.position": (exact(0), -s - 1),
        }

    agree(answer, in_time(answer, places))


def test_the_movable_wedge(answer_of):
    """A = m g sin cos/(M + m sin^2), and (M + m) g sin/(M + m sin^2) down the face."""
    answer = answer_of("scenes/movable-wedge")
    assert force(answer, "face.normal") == pytest.approx(3 * G * 0.75**0.5 / 3.25, rel=EXACT)
    assert force(answer, "floor.normal") == pytest.approx(3 * G + 3 * G * 0.75 / 3.25, rel=EXACT)

    def places(t):
        half, c = exact(G) / exact(3.25) * t * t / 2, sqrt(exact(3)) / 2
        x, s = half * c / 2, 2 * half
        return {
            "wedge.position": (x, exact(0)),
            "block.position": (c + x - s * c, exact(0.5) - s / 2),
        }

    agree(answer, in_time(answer, places))


def test_a_cylinder_rolls_down_an_incline(answer_of):
    """a = g sin/(1 + I/(m R^2)); two thirds of the weight's part hold it, one third turns it."""
    answer = answer_of("scenes/cylinder-on-incline")
    slope = np.deg2rad(20)
    assert force(answer, "rolling-1.normal") == pytest.approx(2 * G * np.cos(slope), rel=EXACT)
    assert abs(force(answer, "rolling-1.friction")) == pytest.approx(2 * G * np.sin(slope) / 3, rel=EXACT)

    def places(t):
        angle = _degrees(20)
        s = exact(G) * sin(angle) / 3 * t * t
        return {
            "cylinder.position": (s * cos(angle) + sin(angle) / 10, cos(angle) / 10 - s * sin(angle)),
            "cylinder.angle": -10 * s,
        }

    agree(answer, in_time(answer, places))


def _degrees(value):
    return type(exact(1)).pi() * value / 180


def test_a_cylinder_rolls_down_a_movable_wedge(answer_of):
    """2 L = (M + m) x'^2 - 2 m cos(30) x' s' + 3/2 m s'^2 + 2 m g s sin(30), s down the face."""
    answer = answer_of("scenes/cylinder-on-movable-wedge")

    def places(t):
        c = sqrt(exact(3)) / 2
        s = exact(G) / 2 / (exact(1.5) - c * c / 4) * t * t / 2
        x = s * c / 4
        return {
            "wedge.position": (x, exact(0)),
            "cylinder.position": (c - exact(0.05) + x - s * c, exact(0.5) + c / 10 - s / 2),
            "cylinder.angle": 10 * s,
        }

    agree(answer, in_time(answer, places))


def test_the_spool_rolls_towards_the_pull(answer_of):
    """The weight falls at (1 - r/R) = 1/2 of the speed: (M + I/R^2 + m/4) a = m g/2, the fall is uniform."""
    answer = answer_of("scenes/spool")
    assert answer["accelerations"]["flange"]["linear"] == pytest.approx([G / 6, 0.0], rel=EXACT)
    assert force(answer, "string-3.tension") == pytest.approx(11 * G / 12, rel=EXACT)

    def places(t):
        x = exact(G) / 12 * t * t
        return {
            "flange.position": (x, exact(0.2)),
            "flange.angle": -5 * x,
            "axle.angle": -5 * x,
            "weight.position": (exact(1), -x / 2 - 0.5),
        }

    agree(answer, in_time(answer, places))


def test_the_shafts_on_a_wedge_agree_with_the_named_scene(answer_of):
    answer, named = answer_of("scenes/shafts-on-wedge"), answer_of("scenes/unwinding-shafts/solid-shafts")
    assert force(answer, "string-3.tension") == pytest.approx(named["tension"], rel=EXACT)
    found, time = columns(answer), np.array(times(answer))
    for i, (name, turn, slope) in enumerate((("one", 1, 0.5), ("two", -1, 0.9))):
        gain, spin = named["accelerations"][i], named["angular_accelerations"][i]
        assert np.hypot(*answer["accelerations"][name]["linear"]) == pytest.approx(gain, rel=EXACT)
        down = np.array([-turn * np.cos(slope), -np.sin(slope)])
        path = found[f"{name}.position"][0] + 0.5 * gain * time[:, None] ** 2 * down
        agree(answer, {f"{name}.position": path, f"{name}.angle": turn * spin * time**2 / 2}, own=4e-16)


def hyperbola(t, x, v, a, k):
    """Return x and x' of x'' = a + k^2 (x - x(0)) at a time, of 40 digits."""
    with mp.workdps(40):
        z = k * t
        return x + v * mp.sinh(z) / k + a * (mp.cosh(z) - 1) / k**2, v * mp.cosh(z) + a * mp.sinh(z) / k


def test_a_chain_slides_off_a_table_and_leaves_its_edge(answer_of):
    """Only what hangs pulls: L x'' = g x.

    The edge takes T - rho v^2 on either side, T = (L - x) x'' rho the pull on what is left. By energy L v^2 = g (x^2 -
    x0^2), so that it vanishes where 2 x^2 - L x - x0^2 = 0.
    """
    answer = answer_of("scenes/chain-off-table")
    with mp.workdps(40):
        start, length = mpf(1) / 2, mpf(2)
        rate = mp.sqrt(mpf("9.81") / length)
        leaves = mp.acosh((length + mp.sqrt(length**2 + 8 * start**2)) / 4 / start) / rate
        hung = [hyperbola(mpf(t), start, 0, rate**2 * start, rate) for t in times(answer)]
    (event,) = answer["events"]
    assert answer["ended"] == event["kind"] == "lift-off"
    assert event["name"] == "chain"
    assert abs(mpf(event["time"]) - leaves) <= event["error"] < 4e-15
    assert len(hung) == 13
    agree(
        answer,
        {
            "front.position": [(0, -x) for x, _ in hung],
            "front.velocity": [(0, -v) for _, v in hung],
            "back.position": [(x - 2, 0) for x, _ in hung],
            "chain.tension": [mpf("1.2") * (2 - x) * rate**2 * x for x, _ in hung],
            "chain.normal": [mpf("1.2") * mp.sqrt(2) * ((2 - x) * rate**2 * x - v * v) for x, v in hung],
            "chain.1.tension": [0 for _ in hung],
        },
    )


def test_a_chain_over_a_peg_carries_its_own_weight(answer_of):
    """Newton's law for the whole: what supports it, the peg, is its weight and what its momentum gains.

    The momentum upwards is (m2 - m1) v + rho (L - 2 x) v with v the rate of the light side's length x, downwards.
    """
    answer = answer_of("scenes/chain-over-peg")
    with mp.workdps(40):
        g, light, heavy, rho, length = (mpf(x) for x in ("9.81", "1", "1.5", "0.8", "3"))
        mass = light + heavy + rho * length
        pull = (light + rho * 1 - heavy - rho * 2) * g / mass
        rate = mp.sqrt(2 * rho * g / mass)
        slides = [hyperbola(mpf(t), mpf(1), mpf("1.2"), pull, rate) for t in times(answer)]
        expected: dict[str, list] = {"chain.normal": [], "chain.1.tension": [], "chain.2.tension": []}
        for x, v in slides:
            gain = ((light + rho * x) - (heavy + rho * (length - x))) * g / mass
            upward = (heavy - light + rho * (length - 2 * x)) * gain - 2 * rho * v * v
            expected["chain.normal"].append(mass * g + upward)
            expected["chain.1.tension"].append(light * (g - gain))
            expected["chain.2.tension"].append(heavy * (g + gain))
    assert answer["ended"] == "horizon"
    expected["light.position"] = [(0, -x) for x, _ in slides]
    expected["heavy.velocity"] = [(0, v) for _, v in slides]
    agree(answer, expected)
    (part,) = answer["model"]["apart"]
    rates = [(mode["frequency"], mode["growth_rate"]) for mode in part["modes"]]
    assert rates == [(0, pytest.approx(sign * float(rate), rel=EXACT)) for sign in (-1, 1)]


def test_a_band_brake_stops_its_drum(answer_of):
    """The fixed end is drawn by W exp(mu pi), W the weight: I alpha = W (exp(mu pi) - 1) R."""
    answer = answer_of("scenes/band-brake")
    weight = 2 * mpf("9.81")
    gain = weight * (exp(mpf("0.3") * pi) - 1) * mpf("0.2") / mpf("0.1")
    stop = 30 / gain
    angles = [-30 * min(mpf(t), stop) + gain * min(mpf(t), stop) ** 2 / 2 for t in times(answer)]
    agree(answer, {"drum.angle": angles})
    (stopped,) = answer["events"]
    assert (stopped["kind"], stopped["name"]) == ("stick", "band")
    assert abs(stopped["time"] - stop) <= stopped["error"] + 2.0**-53
