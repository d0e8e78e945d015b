"""Described scenes with contacts, friction, impacts and slack strings: laws of motion between events, by hand.

References
----------
D. Morin, Introduction to Classical Mechanics (2008), chapters 5 (impacts), 8 (rolling). G. Galperin, "Playing pool with
pi", Regular and Chaotic Dynamics 8 (2003). P. Painleve, Comptes rendus 121 (1895).
"""

from __future__ import annotations

import math

import numpy as np
import pytest

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


def test_the_chalk_of_painleve(answer_of):
    answer = answer_of("scenes/painleve-chalk")
    assert answer["ended"] == "no-motion"
    assert answer["problem"]["connections"] == ["board"]
    c, s, mu, inertia = 0.5, math.sqrt(3) / 2, 2, 0.3333
    assert 1 + c * (c - mu * s) / inertia < 0
    assert answer["trajectory"]["columns"] == {}
