"""A ruler and a protractor laid over a picture, by mouse and by keyboard, against the numbers of the trajectory."""

import json
import math
import re

import pytest

from tests.browser.building import Builder
from tests.browser.waiting import settle


def field(page, name):
    return page.get_by_label(re.compile(f"^{name}"))


def read(page, tool):
    """Numbers that a tool shows."""
    words = page.locator("#measures > span", has_text=tool).locator("output").inner_text()
    return [float(number) for number in re.findall(r"-?\d+(?:\.\d+)?", words)]


def test_a_ruler_is_dragged_from_place_to_place(opened):
    build = Builder(opened("/scenes"))
    build.place("point", -1, 0)
    build.place("point", 0.5, 0.8)
    build.page.get_by_label("Ruler", exact=True).check()
    settle(build.page)
    ends = [
        tuple(float(x) for x in field(build.page, f"Ruler, {end}").input_value().split(",")) for end in ("from", "to")
    ]
    scene = build.scene
    build.drag(ends[0], (-1, 0))
    build.drag(ends[1], (0.5, 0.8))
    assert build.scene == scene, "what lies beneath a ruler stays where it is"
    assert field(build.page, "Ruler, from").input_value() == "point"
    assert field(build.page, "Ruler, to").input_value() == "point-2"
    assert read(build.page, "Ruler") == [1.7, 1.5, 0.8]
    assert build.said == "Ruler: 1.7 m (1.5, 0.8)."


def test_a_protractor_by_keyboard_follows_the_motion(opened, ask):
    page = opened("/scenes#scene=simple-pendulum")
    scene = json.loads(page.locator("#editor").input_value())
    (hold,) = [end for one in scene["connections"] for end in (one.get("a"), one.get("b")) if isinstance(end, list)]
    page.get_by_label("Protractor", exact=True).focus()
    page.keyboard.press("Space")
    down = [hold[0], hold[1] - 1]
    for name, place in (("corner", hold), ("one arm", down), ("other arm", "bob")):
        field(page, f"Protractor, {name}").focus()
        page.keyboard.press("Control+a")
        page.keyboard.type(place if isinstance(place, str) else ", ".join(map(str, place)))
        page.keyboard.press("Enter")
    first, _, body = page.locator("#request pre").inner_text().partition("\n")
    trajectory = ask(first.removeprefix("POST "), json.loads(body))["trajectory"]
    places = trajectory["columns"]["bob.position"]["values"]
    for sample in (0, 200, 400):
        page.locator("#player input").fill(str(1000 * sample / (len(places) - 1)))
        settle(page)
        x, y = places[sample]
        angle = abs(math.degrees(math.atan2(x - hold[0], hold[1] - y)))
        assert read(page, "Protractor")[0] == pytest.approx(angle, rel=1e-3, abs=1e-2)
    field(page, "Protractor, corner").fill("no such place")
    page.keyboard.press("Enter")
    assert field(page, "Protractor, corner").get_attribute("aria-invalid") == "true"
