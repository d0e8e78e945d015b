"""Panels over linear axes."""

from __future__ import annotations

import json
import re
from itertools import pairwise
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest

from service.responses.linear_svg import LEFT, MOST_POINTS, WIDTH, Line, Panel, panels
from service.responses.svg import COLOURS, DASHES

PAGES = Path(__file__).parent.parent.parent.parent / "service" / "page"


def drawn(*shown: Panel) -> Any:
    return ElementTree.fromstring(panels("a < b", shown))


def points_of(figure: Any) -> list[Any]:
    return [
        np.array([[float(x) for x in p.split(",")] for p in e.attrib["points"].split()])
        for e in figure.iter()
        if e.tag.endswith("polyline")
    ]


@pytest.mark.parametrize("size", [1e-300, 1e-7, 1.0, 3e5, 1e300])
def test_curves_fill_their_panel_whatever_their_size(size: float) -> None:
    t = np.linspace(-1, 1, 21)
    (points,) = points_of(drawn(Panel("x", "y", [Line("s", size * t, size * t**2)])))
    assert points[:, 0].min() == LEFT
    assert points[:, 0].max() == LEFT + WIDTH
    assert points[:, 0] == pytest.approx(LEFT + WIDTH * (t + 1) / 2, abs=0.06)


def test_round_values_are_marked() -> None:
    texts = [e.text for e in drawn(Panel("x", "y", [Line("s", np.array([0.0, 1.0]), np.array([0.0, 50.0]))])).iter()]
    assert {"0", "0.2", "1", "10", "50"} <= set(texts)


def test_one_scale_makes_a_circle_round() -> None:
    t = np.linspace(0, 2 * np.pi, 100)
    (points,) = points_of(drawn(Panel("x", "y", [Line("c", 3 + np.cos(t), 1e3 + np.sin(t))], one_scale=True)))
    distance = np.hypot(*(points - (points.max(0) + points.min(0)) / 2).T)
    assert np.ptp(distance) < 0.5


def test_a_single_time_is_a_point_and_many_are_thinned() -> None:
    figure = drawn(Panel("x", "y", [Line("s", np.array([2.0]), np.array([2.0]))]))
    assert any(e.tag.endswith("circle") for e in figure.iter())
    many = np.linspace(0, 1, 10 * MOST_POINTS)
    (points,) = points_of(drawn(Panel("x", "y", [Line("s", many, many)])))
    assert len(points) == MOST_POINTS


def test_no_lines_at_all() -> None:
    assert points_of(drawn(Panel("x", "y", []))) == []


def test_components_have_the_colours_of_the_pages() -> None:
    # Graphs of scenes have the longest list; that of rotations has its first three, for the three components.
    lists = [("curve_choice.js", r"COLORS = (\[[^]]+\])"), ("rotation.js", r"colors = (\[[^]]+\])")]
    scenes, rotation = (json.loads(re.findall(pattern, (PAGES / name).read_text())[0]) for name, pattern in lists)
    light = dict(re.findall(r"--(\w+): (#[0-9a-f]{6});", (PAGES / "theme.css").read_text().partition("@media")[0]))
    assert tuple(light[name] for name in scenes) == COLOURS[: len(scenes)]
    assert rotation == scenes[:3]
    t = np.linspace(0, 1, 5)
    figure = drawn(Panel("time (s)", "rad/s", [Line(f"angular_velocity.{x}", t, t**k) for k, x in enumerate("xyz")]))
    drawn_in = [e.attrib["stroke"] for e in figure.iter() if e.tag.endswith("polyline")]
    assert drawn_in == [light[name] for name in rotation]


def test_forty_curves_can_be_told_apart_and_neighbours_in_print() -> None:
    t = np.linspace(0, 1, 3)
    figure = drawn(Panel("x", "y", [Line(str(k), t, k * t) for k in range(len(COLOURS) * len(DASHES))]))
    curves = [e.attrib for e in figure.iter() if e.tag.endswith("polyline")]
    looks = [(one["stroke"], one.get("stroke-dasharray", "")) for one in curves]
    assert len(set(looks)) == 40
    assert all(one[1] != other[1] for one, other in pairwise(looks))
