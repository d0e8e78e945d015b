"""Described scenes with contacts, friction, impacts and slack strings: laws of motion between events, by hand.

References
----------
D. Morin, Introduction to Classical Mechanics (2008), chapters 5 (impacts), 8 (rolling). G. Galperin, "Playing pool with
pi", Regular and Chaotic Dynamics 8 (2003). P. Painleve, Comptes rendus 121 (1895). G. W. Housner, Bulletin of the
Seismological Society of America 53 (1963) 403.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from mpmath import acos, atan, cos, mp, mpf, quad, sin, sqrt

from tests.examples.scene_columns import agree, columns, times

G = 9.81


def events(answer):
    return [(event["kind"], event["name"]) for event in answer["events"]]


def at(answer, number):
    event = answer["events"][number]
    return event["time"], event["error"] + 4e-16


def total(answer):
    return sum(event["energy_loss"] for event in answer["events"])


def test_the_ladder_leaves_the_wall(answer_of):
    answer = answer_of("scenes/ladder-leaves-wall")
    assert events(answer) == [("lift-off", "wall")]
    time, error = at(answer, 0)
    assert abs(time - 0.58173830116164499) <= error
    found = columns(answer)
    # Energy holds on both sides of the event.
    v, w, y = found["ladder.velocity"], found["ladder.angular_velocity"], found["ladder.position"][:, 1]
    energy = 2 * (v**2).sum(axis=1) + 1.5 * w**2 + 4 * G * y
    assert energy == pytest.approx(energy[0], rel=1e-14)
    # Then nothing pushes along the floor.
    assert v[-1, 0] == pytest.approx(v[-2, 0], rel=1e-14)


def test_the_disc_slips_and_rolls(answer_of):
    for name, speed, spin in (("slip-to-roll", 3.0, 0.0), ("backspin-returns", 1.0, 50.0)):
        answer = answer_of(f"scenes/{name}")
        assert events(answer) == [("roll", "floor")]
        end, error = at(answer, 0)
        assert abs(end - (speed + 0.1 * spin) / (3 * 0.2 * G)) <= error
        t = np.array(times(answer))
        slipping = np.minimum(t, end)
        v = speed - 0.2 * G * slipping
        x = speed * slipping - 0.1 * G * slipping**2 + v * (t - slipping)
        omega = np.where(t < end, spin - 0.2 * G * 0.1 * slipping / 0.005, -v / 0.1)
        agree(answer, {"disc.position": np.stack([x, np.full_like(x, 0.1)], axis=1)}, own=4e-15)
        agree(answer, {"disc.angular_velocity": omega}, own=4e-14)


def test_the_ball_bounces_to_rest(answer_of):
    answer = answer_of("scenes/bounce-to-rest")
    assert events(answer)[-1] == ("settle", "floor")
    first = math.sqrt(2.5 / G)
    limit, error = at(answer, -1)
    assert abs(limit - 9 * first) <= error
    heights = []
    for t in times(answer):
        n = 0
        begin, speed = first, 0.8 * G * first
        while n < 400 and begin + 2 * speed / G < t:
            begin, speed, n = begin + 2 * speed / G, 0.8 * speed, n + 1
        late = t - begin
        heights.append(1.25 - G * t * t / 2 if t <= first else late * (speed - G * late / 2) if t < limit else 0.0)
    agree(answer, {"ball.position": np.stack([np.zeros(len(heights)), heights], axis=1)}, own=1e-14)


def test_the_stone_falls_out_of_its_loop(answer_of):
    answer = answer_of("scenes/loop-with-slack-string")
    assert events(answer) == [("slack", "s")]
    time, error = at(answer, 0)
    assert abs(time - 0.33986875327139788) <= error
    theta = 2.0049681313625003
    speed = math.sqrt(-G * 0.5 * math.cos(theta))
    free = np.array([t for t in times(answer) if t > time]) - time
    x = 0.5 * math.sin(theta) + speed * math.cos(theta) * free
    y = -0.5 * math.cos(theta) + speed * math.sin(theta) * free - G * free**2 / 2
    found = columns(answer)["stone.position"]
    assert found[-len(free) :] == pytest.approx(np.stack([x, y], axis=1), abs=1e-14)
    assert np.linalg.norm(found[: -len(free)], axis=1) == pytest.approx(0.5, rel=1e-15)


def test_the_block_slides_up_and_back(answer_of):
    answer = answer_of("scenes/block-up-rough-incline")
    alpha, mu = math.radians(30), 0.3
    up, down = (G * (math.sin(alpha) + s * mu * math.cos(alpha)) for s in (1, -1))
    assert events(answer) == [("slip", "incline")]
    turn, error = at(answer, 0)
    assert abs(turn - 4 / up) <= error
    t = np.array(times(answer))
    early, late = np.minimum(t, 4 / up), np.maximum(t - 4 / up, 0.0)
    way = 4 * early - up * early**2 / 2 - down * late**2 / 2
    agree(answer, {"block.position": np.outer(way, [math.cos(alpha), math.sin(alpha)])}, own=4e-15)


def test_the_block_takes_the_plank_along(answer_of):
    answer = answer_of("scenes/block-on-plank")
    together, error = at(answer, 0)
    assert abs(together - 2 / (0.3 * G * 1.25)) <= error
    t = np.minimum(np.array(times(answer)), together)
    agree(answer, {"block.velocity": np.outer(2 - 0.3 * G * t, [1, 0])}, own=4e-15)
    agree(answer, {"plank.velocity": np.outer(0.075 * G * t, [1, 0])}, own=4e-15)


def test_the_block_on_a_spring_sticks(answer_of):
    answer = answer_of("scenes/block-on-spring-with-friction")
    assert events(answer) == [("slip", "floor")] * 4 + [("stick", "floor")]
    shift = 0.25 * G / 25
    x = []
    for t in times(answer):
        n = min(int(t / (math.pi / 5)), 5)
        middle = (-1) ** n * shift
        start = (-1) ** n * (1 - 2 * n * shift)
        x.append(start if n == 5 else middle + (start - middle) * math.cos(5 * (t - n * math.pi / 5)))
    agree(answer, {"block.position": np.outer(x, [1, 0])}, own=1e-14)


def test_the_disc_leaves_the_cylinder(answer_of):
    answer = answer_of("scenes/disc-leaves-cylinder")
    assert events(answer) == [("lift-off", "top")]
    time, _ = at(answer, 0)
    found = columns(answer)
    cosine = 2 * math.cos(0.2) / 3
    speed = math.sqrt(G * 1.2 * cosine)
    assert found["disc.velocity"][-1, 0] == pytest.approx(speed * cosine, rel=1e-13)
    fall = speed * math.sqrt(1 - cosine**2) + G * (times(answer)[-1] - time)
    assert found["disc.velocity"][-1, 1] == pytest.approx(-fall, rel=1e-13)


def test_the_weight_lands(answer_of):
    answer = answer_of("scenes/weight-lands")
    pull, back = G / 3.25, G / 1.25
    landing = math.sqrt(1 / pull)
    assert events(answer)[:2] == [("touch", "floor"), ("slack", "s.2")]
    time, error = at(answer, 0)
    assert abs(time - landing) <= error
    assert answer["events"][0]["energy_loss"] == pytest.approx(pull**2 * landing**2, rel=1e-14)
    taut, error = at(answer, 2)
    assert abs(taut - landing - 2 * pull * landing / back) <= error
    # The jerk: wheel and a have the mass 1.25, b joins them.
    push = pull * landing / (1 / 1.25 + 1 / 2)
    assert answer["events"][2]["energy_loss"] == pytest.approx(push * pull * landing / 2, rel=1e-13)


def test_the_blocks_count(answer_of):
    answer = answer_of("scenes/blocks-count-pi")
    assert len(answer["events"]) == 31
    assert total(answer) == 0.0
    v = columns(answer)["light.velocity"][:, 0], columns(answer)["heavy.velocity"][:, 0]
    assert v[0] ** 2 + 100 * v[1] ** 2 == pytest.approx(np.full(21, 100.0), rel=1e-14)
    # By hand: every second impact turns the light one, every other exchanges momentum.
    light, heavy = 0.0, -1.0
    for n in range(31):
        if n % 2 == 0:
            light, heavy = (200 * heavy - 99 * light) / 101, (99 * heavy + 2 * light) / 101
        else:
            light = -light
    assert (v[0][-1], v[1][-1]) == (pytest.approx(light, rel=1e-13), pytest.approx(heavy, rel=1e-13))


def test_the_cradle_exchanges(answer_of):
    answer = answer_of("scenes/cradle-of-two")
    from mpmath import ellipk, mp, mpf, pi
    from mpmath import sin as mp_sin

    quarter = ellipk(mp_sin(mpf(1) / 4) ** 2) / (mpf("9.81") ** mpf("0.5"))
    assert mp.prec >= 53
    assert pi > 3
    assert events(answer) == [("touch", "pair")] * 2
    for number, event in enumerate(answer["events"]):
        assert abs(event["time"] - float((2 * number + 1) * quarter)) <= event["error"] + 4e-16
        assert event["energy_loss"] == pytest.approx(0.0, abs=1e-15)


def test_the_ball_hits_the_stick(answer_of):
    answer = answer_of("scenes/ball-and-stick")
    push = 3 / (1 + 1 / 3 + 0.81)
    time, error = at(answer, 0)
    assert abs(time - 0.45) <= error
    after = np.array(times(answer)) > time
    agree(answer, {"stick.angular_velocity": np.where(after, -push * 0.9, 0.0)}, own=1e-15)
    agree(answer, {"stick.velocity": np.outer(np.where(after, push / 3, 0.0), [1, 0])}, own=1e-15)


def test_the_dumbbell_lands_on_one_end(answer_of):
    """The lower end of two points of 1 kg: the impulse (1 + e) v/(1/m + (a cos)^2/I) of an end turns and lifts it."""
    answer = answer_of("scenes/dumbbell-dropped")
    assert events(answer)[0] == ("touch", "l")
    drop = 2 - math.sin(0.3)
    time, error = at(answer, 0)
    assert abs(time - math.sqrt(2 * drop / G)) <= error
    push = 1.5 * math.sqrt(2 * G * drop) / (1 / 2 + math.cos(0.3) ** 2 / 2)
    assert answer["events"][0]["impulses"]["normal"] == pytest.approx(push, rel=1e-14)


def test_the_spool_winds_up_or_rolls_away(answer_of):
    """m a = F cos - f and I a/R^2 = f - F r/R: a (m + I/R^2) = F (cos - r/R), with R = 2 r."""
    for name, angle in (("spool-winds-up", 0.0), ("spool-rolls-away", 5 * math.pi / 12)):
        answer = answer_of(f"scenes/{name}")
        assert answer["events"] == []
        assert answer["phases"][0]["states"] == {"floor": "stick"}
        a = 3 * (math.cos(angle) - 0.5) / (2 + 0.03 / 0.04)
        assert (a > 0) == (name == "spool-winds-up")
        t = np.array(times(answer))
        agree(answer, {"spool.velocity": np.outer(a * t, [1, 0])}, own=1e-15)
        agree(answer, {"spool.angular_velocity": -a * t / 0.2}, own=1e-14)
        assert answer["forces"]["floor.friction"]["value"] == pytest.approx(2 * a - 3 * math.cos(angle), rel=1e-14)


def test_the_disc_slips_down(answer_of):
    """It rolls where tan a <= 3 mu only; here a = g (sin - mu cos) down and I alpha = mu m g cos R."""
    answer = answer_of("scenes/disc-slips-down-incline")
    assert answer["events"] == []
    slope = 2 * math.pi / 9
    assert math.tan(slope) > 3 * 0.15
    t = np.array(times(answer))
    gain = G * (math.sin(slope) - 0.15 * math.cos(slope))
    agree(answer, {"disc.velocity": np.outer(gain * t, [math.cos(slope), -math.sin(slope)])}, own=4e-15)
    agree(answer, {"disc.angular_velocity": -0.15 * G * math.cos(slope) * 0.1 / 0.005 * t}, own=2e-14)


def test_the_lower_block_is_pulled_away(answer_of):
    answer = answer_of("scenes/blocks-pulled")
    assert answer["phases"][0]["states"] == {"floor": "slide", "between": "slide back"}
    t = np.array(times(answer))
    lower = (20 - 0.2 * G - 0.1 * 4 * G) / 3
    agree(answer, {"lower.velocity": np.outer(lower * t, [1, 0])}, own=4e-15)
    agree(answer, {"upper.velocity": np.outer(0.2 * G * t, [1, 0])}, own=1e-15)


def test_the_block_tips_over(answer_of):
    """With I' = I + m (h^2 + b^2) about the lower edge: I' w' = m g (h sin - b cos) at first, then energy."""
    answer = answer_of("scenes/block-tips-over")
    assert answer["phases"][0]["states"] == {"front": "stick", "back": "open"}
    h, b, slope, mass = 0.3, 0.1, 0.45, 6
    about = 0.2 + mass * (h * h + b * b)
    gain = mass * G * (h * math.sin(slope) - b * math.cos(slope)) / about
    assert answer["accelerations"]["block"]["angular"] == pytest.approx(-gain, rel=1e-14)
    found = columns(answer)
    x, y = found["block.position"].T
    assert np.hypot(x - 0.1, y) == pytest.approx(math.hypot(h, b), rel=1e-15)
    fallen = G * (math.sin(slope) * (x - x[0]) - math.cos(slope) * (y - y[0]))
    assert about * found["block.angular_velocity"] ** 2 / 2 == pytest.approx(mass * fallen, rel=1e-12, abs=1e-15)


def test_the_rod_slips_over_the_edge(answer_of):
    """With a from the edge to the centre: tan(theta) = mu I/(I + 3 m a^2) by the forces along and across the rod."""
    from mpmath import atan, mp, mpf, quad, sqrt
    from mpmath import sin as sine

    answer = answer_of("scenes/rod-on-edge")
    assert events(answer) == [("slip", "edge")]
    with mp.workdps(30):
        a, inertia = mpf("0.1"), mpf(1) / 12
        end = atan(inertia / (inertia + 3 * a * a) / 2)
        square = 2 * mpf("9.81") * a / (inertia + a * a)
        # theta = u^2 takes the root away at the start.
        when = quad(lambda u: 2 * u / sqrt(square * sine(u * u)) if u else 2 / sqrt(square), [0, sqrt(end)])
        time, error = at(answer, 0)
        assert abs(time - when) <= error
    force = answer["forces"]["edge.normal"]["value"]
    assert force == pytest.approx(G * (1 / 12) / (1 / 12 + 0.01), rel=1e-14)


def test_the_rod_falls_against_its_stop(answer_of):
    from mpmath import mp, mpf, quad, sqrt
    from mpmath import sin as sine

    answer = answer_of("scenes/rod-against-stop")
    assert events(answer) == [("stop", "stop")]
    with mp.workdps(30):
        square = 2 * 2 * mpf("9.81") / 2 / (mpf(1) / 2 + mpf(1) / 2)
        when = quad(lambda u: 2 * u / sqrt(square * sine(u * u)) if u else 2 / sqrt(square), [0, 1])
        time, error = at(answer, 0)
        assert abs(time - when) <= error
    fall = 2 * G * 0.5 * math.sin(1)
    assert answer["events"][0]["energy_loss"] == pytest.approx(0.75 * fall, rel=1e-13)
    assert answer["events"][0]["impulses"]["normal"] == pytest.approx(1.5 * math.sqrt(2 * fall), rel=1e-13)


def test_the_spinning_disc_bounces_away(answer_of):
    """Friction stops the slip of 4 m/s by the impulse 4/(1 + m R^2/I) = 4/3 N s, below 0.3 times 1.8 v."""
    answer = answer_of("scenes/spinning-disc-bounces")
    down = math.sqrt(2 * G)
    assert answer["events"][0]["impulses"]["normal"] == pytest.approx(1.8 * down, rel=1e-14)
    assert answer["events"][0]["impulses"]["friction"] == pytest.approx(-4 / 3, rel=1e-14)
    after = np.array(times(answer)) > answer["events"][0]["time"]
    agree(answer, {"disc.angular_velocity": np.where(after, 40 - 0.1 * 4 / 3 / 0.005, 40.0)}, own=1e-14)
    assert columns(answer)["disc.velocity"][-1, 0] == pytest.approx(-4 / 3, rel=1e-15)


def test_the_upper_ball_leaves_at_twice_the_speed(answer_of):
    """Both arrive at v; the lower one turns, and its three times larger mass gives all of its momentum away."""
    answer = answer_of("scenes/ball-on-ball-dropped")
    assert events(answer) == [("touch", "floor"), ("touch", "pair"), ("lift-off", "pair")]
    assert [event["energy_loss"] for event in answer["events"]] == [0.0, 0.0, 0.0]
    assert answer["energy"]["conserved"]
    down = math.sqrt(2 * G)
    late = times(answer)[-1] - down / G
    found = columns(answer)
    assert found["upper.velocity"][-1, 1] == pytest.approx(2 * down - G * late, rel=1e-14)
    assert found["lower.velocity"][-1, 1] == pytest.approx(0.0, abs=4e-15)


def test_the_billiard_ball_slips_along_a_parabola(answer_of):
    """The slip v - R w x n at the cloth is (2.9, 1.2): its direction stays, and 7/2 mu g takes it away."""
    answer = answer_of("scenes/billiard-ball")
    slip = np.array([2 + 0.03 * 30, 0.03 * 40])
    size = math.hypot(*slip)
    end = 2 * size / (7 * 0.2 * G)
    assert events(answer) == [("roll", "cloth")]
    time, error = at(answer, 0)
    assert abs(time - end) <= error
    t = np.array(times(answer))
    early = np.minimum(t, end)
    u = np.array([*slip / size, 0.0])
    velocity = np.array([2.0, 0, 0]) - 0.2 * G * np.outer(early, u)
    agree(answer, {"ball.velocity": velocity}, own=2e-15)
    turned = 0.2 * G * 0.17 * 0.03 / 6.12e-5 * early
    spin = np.array([40.0, -30, 25]) + np.outer(turned, [-u[1], u[0], 0])
    agree(answer, {"ball.angular_velocity_in_space": spin}, own=4e-14)


def test_the_spinning_ball_bounces_and_rolls(answer_of):
    answer = answer_of("scenes/ball-bounces-with-spin")
    down, pushed = math.sqrt(2 * G), -2 / 7 * np.array([1.0, 0.8])
    first = answer["events"][0]["impulses"]
    assert first["normal"] == pytest.approx(1.6 * down, rel=1e-14)
    assert [first["friction.x"], first["friction.y"]] == pytest.approx(pushed, rel=1e-14)
    assert events(answer)[-1] == ("settle", "floor")
    limit, error = at(answer, -1)
    assert abs(limit - down / G * 4) <= error
    v = columns(answer)["ball.velocity"][-1]
    assert v == pytest.approx([1 + pushed[0], 0.5 + pushed[1], 0], abs=1e-15)
    assert answer["phases"][-1]["states"] == {"floor": "stick"}


def test_the_dumbbell_lands_in_space(answer_of):
    """One end, 0.8 of its half length to the side: p = (1 + e) v/(1/m + (0.4)^2/I)."""
    answer = answer_of("scenes/dumbbell-dropped-in-space")
    assert events(answer) == [("touch", "a")]
    time, error = at(answer, 0)
    assert abs(time - math.sqrt(2 * 0.7 / G)) <= error
    push = 1.5 * math.sqrt(2 * G * 0.7) / (1 / 2 + 0.16 / 0.5)
    assert answer["events"][0]["impulses"]["normal"] == pytest.approx(push, rel=1e-14)
    assert answer["events"][0]["energy_loss"] == pytest.approx(0.75 * 2 * G * 0.7 / 2 / (1 / 2 + 0.16 / 0.5), rel=1e-13)


def test_the_block_takes_the_plank_along_in_space(answer_of):
    answer = answer_of("scenes/block-on-plank-in-space")
    together, error = at(answer, 0)
    assert abs(together - 2 / (0.3 * G * 1.25)) <= error
    t = np.minimum(np.array(times(answer)), together)
    agree(answer, {"block.velocity": np.outer(2 - 0.3 * G * t, [0.6, 0.8, 0])}, own=4e-15)
    agree(answer, {"plank.velocity": np.outer(0.075 * G * t, [0.6, 0.8, 0])}, own=4e-15)


def test_the_table_shares_its_load(answer_of):
    """No leg's load is determined, as each adds to a cross of loads that balance."""
    answer = answer_of("scenes/four-legged-table")
    assert answer["model"]["name"] == "rest"
    for leg in "abcd":
        told = answer["forces"][f"{leg}.normal"]
        assert told["determined"] is False
        assert told["shared_with"] == [f"{leg}" for leg in "abcd"]


def test_the_stone_turns_downhill_and_stops(answer_of):
    """With f = mu g cos(a) and s = g sin(a): f v + s v cos(psi) falls at f^2 - s^2; v is a power of tan(psi/2).

    dv/dpsi = v (f - s cos psi)/(s sin psi): v = v0 tan(psi/2)^(f/s)/sin(psi), from psi = 90 degrees down to zero.
    """
    answer = answer_of("scenes/stone-across-slope")
    pull, rub = G * math.sin(0.3), G * math.cos(0.3) / 2
    assert events(answer) == [("stick", "slope")]
    stop, error = at(answer, 0)
    assert abs(stop - 2 * rub / (rub**2 - pull**2)) <= error + 2e-16
    v = columns(answer)["stone.velocity"]
    moving = np.array(times(answer)) < stop
    speed, angle = np.hypot(v[moving, 0], v[moving, 1]), np.arctan2(v[moving, 1], v[moving, 0])
    assert speed == pytest.approx(2 * np.tan(angle / 2) ** (rub / pull) / np.sin(angle), rel=1e-13)
    assert rub * speed + pull * v[moving, 0] == pytest.approx(
        2 * rub - (rub**2 - pull**2) * np.array(times(answer))[moving], rel=1e-14
    )
    assert not v[~moving].any()


def test_the_stone_leaves_the_hollow_sphere(answer_of):
    answer = answer_of("scenes/stone-leaves-hollow-sphere")
    assert events(answer)[0] == ("lift-off", "sphere")
    time, error = at(answer, 0)
    assert abs(time - 0.33986875327139788) <= error
    found = columns(answer)["stone.position"]
    free = np.array([t for t in times(answer) if t > time]) - time
    theta = 2.0049681313625003
    speed = math.sqrt(-G * 0.5 * math.cos(theta))
    along = 0.5 * math.sin(theta) + speed * math.cos(theta) * free
    z = -0.5 * math.cos(theta) + speed * math.sin(theta) * free - G * free**2 / 2
    assert found[-len(free) :] == pytest.approx(np.stack([0.6 * along, 0.8 * along, z], axis=1), abs=1e-14)


def test_the_chalk_of_painleve(answer_of):
    answer = answer_of("scenes/painleve-chalk")
    assert answer["ended"] == "no-motion"
    assert answer["problem"]["connections"] == ["board"]
    c, s, mu, inertia = 0.5, math.sqrt(3) / 2, 2, 0.3333
    assert 1 + c * (c - mu * s) / inertia < 0
    assert answer["trajectory"]["columns"] == {}


def test_a_block_rocks_until_it_stands(answer_of):
    """About a corner phi'' = -K sin(alpha - phi), K = 3 g/(4 R); an impact leaves 1 - 3/2 sin^2(alpha) of the rate."""
    answer = answer_of("scenes/rocking-block")
    with mp.workdps(40):
        b, h, tilt = mpf("0.3"), mpf("0.36"), mpf("0.1")
        alpha, k = atan(b / h), 3 * mpf("9.81") / (4 * sqrt(b * b + h * h))
        left = 1 - 3 * sin(alpha) ** 2 / 2

        def falls(most):
            """Return the time from the largest tilt to the level; the integral is smooth in u, phi = most (1 - u^2)."""

            def part(u):
                square = 4 * k * sin(alpha - most * (2 - u * u) / 2) * sin(most * u * u / 2)
                return 2 * u * most / sqrt(square) if u else sqrt(2 * most / (k * sin(alpha - most)))

            return quad(part, [0, 1])

        expected, rate = [falls(tilt)], sqrt(2 * k * (cos(alpha - tilt) - cos(alpha)))
        for _ in range(8):
            rate *= left
            expected.append(expected[-1] + 2 * falls(alpha - acos(cos(alpha) + rate * rate / (2 * k))))
    touches = [event for event in answer["events"] if event["kind"] == "touch"]
    for event, time in zip(touches, expected, strict=False):
        assert abs(event["time"] - time) <= event["error"] + 4e-16
    # It stands from the limit of these times on: what is left is a geometric series.
    assert [event["name"] for event in touches[:4]] == ["left", "right", "left", "right"]
    assert touches[-1]["time"] == pytest.approx(
        float(expected[-1] + (expected[-1] - expected[-2]) * left / (1 - left)), abs=1e-9
    )
    assert columns(answer)["block.angle"][-1] == pytest.approx(0, abs=1e-12)
