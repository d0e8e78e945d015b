"""The page of the source's questions: it says what the service answers, and that is what other calculations find."""

from __future__ import annotations

import json
import math
import re
import sys
from functools import cache
from pathlib import Path

import mpmath
import numpy as np
import pytest

from examples import source_questions
from examples.ask import names, path_of, request_of
from examples.source_questions import QUESTIONS, TEMPLATE, figures, page
from service.routes.scene_catalogue import scene_catalogue

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "source-questions.md"
G = 9.81


@pytest.fixture(scope="module")
def found(answer_of):
    return figures(answer_of)


def test_the_page_says_what_the_service_answers(found):
    assert PAGE.read_text(encoding="utf-8") == page(found)


def test_the_command_prints_the_page(service, monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["source_questions", "--service", service])
    source_questions.main()
    assert capsys.readouterr().out == PAGE.read_text(encoding="utf-8")


# Independent calculations: formulas of the source's mechanics evaluated here, each integration by a loop of this file.


def gyration(moments, w):
    a, b, c = moments
    x, y, z = w
    return np.array([(b - c) / a * y * z, (c - a) / b * z * x, (a - b) / c * x * y])


def forward_euler(moments, start, step, steps):
    """Return the states, shape (steps + 1, 3, ...)."""
    states = [np.array(start, dtype=float)]
    with np.errstate(all="ignore"):
        for _ in range(steps):
            states.append(states[-1] + step * gyration(moments, states[-1]))
    return np.array(states)


def energies(moments, states):
    return 0.5 * np.einsum("i,...i,...i->...", np.array(moments), states, states)


def flip_interval(moments, start):
    """Return 2K(m)/p at 40 digits, in the order A < B < C with the differences of L^2 and 2EI as sums."""
    with mpmath.workdps(40):
        pairs = sorted((mpmath.mpf(i), mpmath.mpf(w)) for i, w in zip(moments, start, strict=True))
        i, w = [p[0] for p in pairs], [p[1] for p in pairs]
        excess = [sum(i[k] * (i[k] - i[j]) * w[k] ** 2 for k in range(3)) for j in range(3)]
        d, c = (2, 0) if excess[1] > 0 else (0, 2)
        x, y = abs(excess[d]), abs(excess[c])
        p = mpmath.sqrt(abs(i[d] - i[1]) * y / (i[0] * i[1] * i[2]))
        m = abs(i[1] - i[c]) * x / (abs(i[d] - i[1]) * y)
        return float(2 * mpmath.ellipk(m) / p)


def shafts():
    m1, m2, a, b = 2.0, 1.0, G * math.sin(0.5), G * math.sin(0.9)
    tension = (a + b) * m1 * m2 / (3 * (m1 + m2))
    half = [m1 / 3, m2 / 3]
    times = [math.sqrt(2 * wound * 0.5 * m / tension) for wound, m in ((0.5, m1), (0.8, m2))]
    return {
        "tension": tension,
        "a1": ((3 * m1 + 2 * m2) * a - m2 * b) / (3 * (m1 + m2)),
        "a2": ((3 * m2 + 2 * m1) * b - m1 * a) / (3 * (m1 + m2)),
        "string": (half[0] * a - half[1] * b) / sum(half),
        "vertical_tension": 3 * G / 3,
        "vertical_acceleration": 2 * G / 3,
        "unwound": min(times),
    }


def rod():
    k = math.sqrt(0.75)
    length = (1 - 1 / 6) / k
    # 3.1060366 and 2.8003916 are the source's formula and that with only its moment of inertia, worked out by hand.
    return {
        "rate": math.sqrt(2 * G * k * 0.5 / (1 - 1 / 6)),
        "period": float(4 * mpmath.ellipk(0.25)) / math.sqrt(G / length),
        "source": pytest.approx(3.1060366, abs=5e-8),
        "source_inertia": pytest.approx(2.8003916, abs=5e-8),
    }


def chain():
    a, b, rho, length, m1, m2, x = math.sin(0.6), math.sin(0.8), 0.5, 2.0, 1.0, 1.2, 1.0
    whole = m1 + m2 + rho * length
    return {
        "acceleration": G * ((m1 + rho * x) * a - (m2 + rho * (length - x)) * b) / whole,
        "apex_tension": G * (a + b) * (m1 + rho * x) * (m2 + rho * (length - x)) / whole,
        "growth_rate": math.sqrt(rho * G * (a + b) / whole),
        "equilibrium": ((m2 + rho * length) * b - m1 * a) / (rho * (a + b)),
    }


def coin_measured():
    states = forward_euler((1, 1, 2), (1, 1, 1), 15 / 1999, 1999)
    distance = np.linalg.norm(states - 1.0, axis=1)
    point = next(k for k in range(20, 2000) if distance[k] < 0.035)
    # The exact motion is 2 sqrt(2) sin(t/2) away from the start.
    early = 2 * math.asin(0.035 / (2 * math.sqrt(2)))
    times = np.linspace(0, 15, 2000)
    seen = times[times > 2 * math.pi - early][0]
    assert times[point] == 6.28064032016008
    return {
        "point": 837,
        "time": times[point],
        "percent": 100 * (times[point] / (2 * math.pi) - 1),
        "theory": 2 * math.pi,
        "early": pytest.approx(early, rel=1e-9),
        "grid": pytest.approx(seen - 2 * math.pi + early, rel=1e-9),
        "method": pytest.approx(times[point] - seen, rel=1e-9),
    }


def symmetric(w1, i1, i, seconds):
    rate = (i1 - i) / i * w1
    return math.cos(rate * seconds), math.sin(rate * seconds)


def closed_form():
    c, s = symmetric(3.1, 1, 2, 10)
    return {"x": 3.1, "y": 2 * c, "z": 2 * s, "source_y": 2 * math.cos(31), "source_z": -2 * math.sin(31)}


def error_of_euler(rate, across, whole):
    """Return the largest error, over |w|, of a step that multiplies w2 + i w3 by 1 + i rate h."""
    n, h = np.arange(10_000), 20 / 9999
    with_steps = (1 + 1j * rate * h) ** n
    return float(np.abs(with_steps - np.exp(1j * rate * h * n)).max()) * across / whole


def compared():
    oblate = error_of_euler(0.8, math.hypot(0.6, 0.6), math.sqrt(0.64 + 0.72))
    prolate = error_of_euler(-0.4, math.hypot(0.8, 0.2), math.sqrt(0.64 + 0.68))
    return {
        "oblate": 2 * math.pi / 0.8,
        "prolate": 2 * math.pi / 0.4,
        "oblate_error": pytest.approx(100 * oblate, rel=1e-8),
        "prolate_error": pytest.approx(100 * prolate, rel=1e-8),
        "source_oblate": 2 * math.pi / 0.4,
        "source_prolate": 2 * math.pi / 0.8,
    }


def wobble():
    e, solar = 1 / 430, 1 / (430 * 1.00273790935)
    return {
        "asymmetry": e,
        "ellipticity": math.sqrt((1 + e) / (1 - e)),
        "solar_asymmetry": solar,
        "solar_ellipticity": math.sqrt((1 + solar) / (1 - solar)),
        "source": pytest.approx(1.00116, abs=5e-6),
    }


def jacobian(moments, w, h=1e-6):
    columns = [(gyration(moments, w + h * unit) - gyration(moments, w - h * unit)) / (2 * h) for unit in np.eye(3)]
    return np.array(columns).T


def growth(moments, axis, rate=1.0):
    """Return the largest eigenvalue by size of the linearised equations, by differences and numpy."""
    values = np.linalg.eigvals(jacobian(moments, rate * np.eye(3)[axis]))
    return values[np.argmax(np.abs(values))]


def eigenvalues():
    moments = (2, 1, 0.5)
    return {
        "low": pytest.approx(abs(growth(moments, 2).imag), rel=1e-9),
        "middle": pytest.approx(abs(growth(moments, 1).real), rel=1e-9),
        "high": pytest.approx(abs(growth(moments, 0).imag), rel=1e-9),
    }


def thrown():
    a, b, c = 0.088, 0.063, 0.016
    deck = [0.094 / 12 * x for x in (b * b + c * c, a * a + c * c, a * a + b * b)]
    r, h, m = 0.011625, 0.00233, 0.0075
    return {
        "low": 1e5 * deck[0],
        "middle": 1e5 * deck[1],
        "high": 1e5 * deck[2],
        "growth": pytest.approx(abs(growth(deck, 1, 10.0).real), rel=1e-8),
        "flip": flip_interval(deck, (0.1, 10.0, 0.1)),
        "across": 1e7 * m * (3 * r * r + h * h) / 12,
        "along": 1e7 * m * r * r / 2,
    }


@cache
def t_handle_tensors():
    """Return the source's tensors about the origin and about the centre of mass, summed in rational-like precision."""
    angle, along = np.meshgrid(np.linspace(0, 2 * np.pi, 20), np.linspace(0, 1, 10))
    tube = np.array([np.cos(angle), np.sin(angle), 5 * along])
    one = tube - np.array([0, 0, 2.5]).reshape((3, 1, 1))
    points = np.concatenate((one, np.array([tube[0, :5], tube[2, :5], tube[1, :5]])), 1).reshape(3, -1)

    def tensor(r):
        products = np.array([[math.fsum(r[i] * r[j]) for j in range(3)] for i in range(3)])
        return np.trace(products) * np.eye(3) - products

    center = np.array([math.fsum(row) / 300 for row in points])
    return tensor(points), tensor(points - center[:, None]), center


def t_handle():
    origin, own, center = t_handle_tensors()
    # The published figures of the lesson and their counterparts, beside this file's own sums.
    assert np.linalg.eigvalsh(origin) == pytest.approx([437.68518519, 714.00820069, 837.19550301], abs=5e-9)
    assert np.linalg.eigvalsh(own) == pytest.approx([395.782921811, 713.509259259, 795.792181070], abs=5e-10)
    keys = ("low", "middle", "high")
    return {
        "mass": 300,
        "x": pytest.approx(1 / 20, rel=1e-12),
        "y": pytest.approx(10 / 27, rel=1e-12),
        **{k: pytest.approx(x, rel=1e-12) for k, x in zip(keys, np.linalg.eigvalsh(own), strict=True)},
        **{f"source_{k}": pytest.approx(x, rel=1e-12) for k, x in zip(keys, np.linalg.eigvalsh(origin), strict=True)},
        "center": center,
    }


def energy_gained(moments):
    states = forward_euler(moments, (1, 10, 1), 20 / 9999, 9999)
    found = energies(moments, states)
    assert (np.diff(found) > 0).all()
    return 100 * (found[-1] / found[0] - 1)


def tumbling():
    origin, own, _ = t_handle_tensors()
    free, pinned = np.linalg.eigvalsh(own)[::-1], np.linalg.eigvalsh(origin)[::-1]
    return {
        "flip": pytest.approx(flip_interval(free, (1, 10, 1)), rel=1e-12),
        "growth": pytest.approx(energy_gained(free), rel=1e-9),
        "tilt": math.degrees(math.atan(math.sqrt(2) / 10)),
        "near": pytest.approx(flip_interval(free, (0.01, 10, 0)), rel=1e-12),
        "source": pytest.approx(flip_interval(pinned, (1, 10, 1)), rel=1e-12),
        "source_growth": pytest.approx(energy_gained(pinned), rel=1e-9),
    }


ORACLES = {
    "shafts": shafts,
    "chain": chain,
    "rod": rod,
    "1a": lambda: {"x": 1 + 0.5 / 2, "y": 1 - 1.5, "z": 1 + 1 / 0.5, "source_y": 1 + 1.5},
    "1b": lambda: {"x": 1.25, "y": -0.5, "z": 3.0, "source_x": 0.5 / 2, "source_y": -1.5, "source_z": 1 / 0.5},
    "1c": lambda: {"x": 0.0, "y": 0.0, "z": 1.0},
    "1d": lambda: {"x": 3.0, "y": 2.0, "z": 1.0},
    "1e": lambda: {"coin_body": 1.0, "coin_space": math.sqrt(6), "football_body": -0.5, "football_space": 1.5},
    "1f": coin_measured,
    "1g": closed_form,
    "1h": lambda: {"energy": (2 + 1 + 0.5) / 2},
    "1i": lambda: {"x": 1.0, "y": math.sqrt(2), "z": 2.0},
    "1k": compared,
    "1l": wobble,
    # 1/((A/C ratio of WGS 84 and IAU 2006) - 1) rotations, and S. C. Chandler's period as it is given today.
    "1m": lambda: {"rigid": pytest.approx(1 / (0.0032737949 / (1 - 0.0032737949)) / 1.00273790935, abs=5e-3),
                   "observed": 433.0},
    "1n": eigenvalues,
    "1o": thrown,
    "1p": t_handle,
    "1q": tumbling,
    "1r": lambda: {"warned": 1},
}  # fmt: skip


@pytest.mark.parametrize("question", ORACLES)
def test_the_numbers_are_right(found, question):
    expected = ORACLES[question]()
    expected.pop("center", None)
    assert found[question].keys() == expected.keys()
    for key, value in expected.items():
        right = value if not isinstance(value, float) else pytest.approx(value, rel=1e-13, abs=1e-300)
        assert found[question][key] == right, key


def test_explicit_euler_grows_as_a_loop_of_our_own_says(found, answer_of):
    starts = np.array(answer_of("rotation/initial-states/thirty-starts")["angular_velocities"])
    moments = (2, 1, 0.5)
    ends = {}
    for step in (0.002, 0.1, 0.2):
        ends[step] = energies(moments, forward_euler(moments, starts.T, step, round(20 / step))[-1].T)
    assert energies(moments, starts) == pytest.approx(np.ones(30), rel=1e-14)
    assert found["1j"] == {
        "least": pytest.approx(100 * (ends[0.002].min() - 1), rel=1e-8),
        "most": pytest.approx(100 * (ends[0.002].max() - 1), rel=1e-8),
        "least_large": pytest.approx(ends[0.1].min(), rel=1e-8),
        "most_large": pytest.approx(ends[0.1].max(), rel=1e-8),
        "refused": 422,
    }
    assert 0.4 < found["1j"]["least"] < found["1j"]["most"] < 3.5
    assert not np.isfinite(ends[0.2]).all()


def test_every_question_has_an_oracle():
    assert {*ORACLES, "1j"} == set(QUESTIONS)


# The text between the numbers.


def rows():
    return [line for line in TEMPLATE.read_text(encoding="utf-8").splitlines() if line.startswith("| ")][1:]


def linked(text):
    return re.findall(r"\]\(\.\./examples/([\w/-]+)\.json\)", text)


def test_every_question_of_the_source_is_listed():
    numbers = [row.split(" | ")[0].removeprefix("| ") for row in rows()]
    assert numbers == [
        "Problem 1",
        "(its predecessor)",
        "Problem 2",
        *(f"1{letter}" for letter in "abcdefghijklmnopqr"),
    ]


@pytest.mark.parametrize(("row", "key"), list(zip(rows(), QUESTIONS, strict=True)), ids=list(QUESTIONS))
def test_a_row_names_its_own_numbers_examples_and_endpoints(row, key):
    _, examples = QUESTIONS[key]
    assert set(re.findall(r"\{(\w+)\[", row)) == {key}
    assert set(examples) <= set(linked(row))
    assert set(re.findall(r"`(/v1/[\w/-]+)`", row)) == {path_of(name) for name in linked(row)}
    assert row.count(" | ") == 4


def numbers_in(value):
    if isinstance(value, dict):
        return {x for entry in value.values() for x in numbers_in(entry)}
    if isinstance(value, list):
        return {x for entry in value for x in numbers_in(entry)}
    return {float(value)} if isinstance(value, (int, float)) else set()


@pytest.mark.parametrize("row", rows(), ids=list(QUESTIONS))
def test_decimals_in_the_text_are_those_of_the_requests(row):
    asked = {x for name in linked(row) for x in numbers_in(json.loads(request_of(name)))}
    written = re.findall(r"\d+\.\d+", re.sub(r"\{[^}]*\}|\]\([^)]*\)", "", row))
    assert {float(x) for x in written} <= asked


def test_every_number_that_is_found_is_shown(found):
    text = TEMPLATE.read_text(encoding="utf-8")
    assert set(re.findall(r"\{(\w+)\[(\w+)\]", text)) == {(key, name) for key in found for name in found[key]}


def test_every_example_is_linked_and_every_link_leads_somewhere():
    text = PAGE.read_text(encoding="utf-8")
    # The catalogue of described scenes, grading and studies have pages of their own; the box is the README's.
    own = {f"scenes/{name}" for name in scene_catalogue()} | {"rotation/precession/box"}
    assert (
        set(linked(text))
        == {name for name in names() if not name.startswith(("assessments/", "variants/", "studies/"))} - own
    )
    for target in re.findall(r"\]\(([^)#]+)\)", text):
        assert (PAGE.parent / target).exists(), target
