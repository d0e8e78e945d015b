"""Twelve scenes of a course are built from nothing, by mouse and by keyboard, and move as their mechanics has it."""

import re

import pytest

from tests.browser.course_scenes import SCENES, run

REFUSED = ("422",)
"""A connection by name may ask for places that do not fit at first."""

SAID = {
    "pendulum": "Rod swings with a period of 1.93 s",
    "Atwood's machine": "stay at rest|are accelerated by 3.22",
    "body on a ramp": "is accelerated obliquely downward",
    "damped oscillator": "2 degrees of freedom|ever less",
    "double pendulum": "Rod and rod-2 move in 2 degrees of freedom",
    "crank and slider": "move as driven: no degree of freedom is left",
    "bouncing ball": r"Disc touches the floor after 0\.\d+ s",
    "throw": "Point is accelerated downward by 9.81",
    "block on a movable wedge": "Wedge is accelerated to the left by .* and point is accelerated obliquely downward",
    "ladder against a wall": "Rod touches the wall|Rod stays at rest",
    "pendulum on a cart": "Box and point repeat the motion",
    "two discs collide": r"Disc and disc-2 touch after 0\.\d+ s",
}
"""What the page says of each, in the way of either builder where they build it unlike."""


@pytest.mark.parametrize("way", ["mouse", "keyboard"])
@pytest.mark.parametrize("name", SCENES)
def test_a_scene_of_a_course_is_built_from_nothing(opened, name, way):
    page = opened("/scenes", expected=REFUSED)
    _, _, said = run(page, SCENES[name][("mouse", "keyboard").index(way)])
    assert page.locator("#misfits li").count() == 0
    assert re.search(SAID[name], said)
