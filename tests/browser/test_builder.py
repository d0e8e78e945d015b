"""Scenes built by hand: by mouse, by finger and by keyboard, each to the motion that its mechanics has."""

import json
import math
import re
import statistics

import pytest

from tests.browser.building import Builder
from tests.browser.conftest import FIGURES
from tests.browser.waiting import settle

REFUSED = ("422",)
"""Places that do not fit are first refused, then the nearest that do are asked for."""


def test_a_crank_slider_by_mouse(opened):
    build = Builder(opened("/scenes"))
    build.place("wheel", 0, 0)
    build.place("rod", 0.7, 0)
    build.place("box", 1.2, 0)
    build.press("motor", (0, 0))
    build.press("pin", (0.2, 0))
    build.press("pin", (1.2, 0))
    build.press("slider", (1.2, 0.1))
    kinds = [connection["kind"] for connection in build.scene["connections"]]
    assert kinds == ["pin", "motor", "pin", "pin", "slider"]
    assert build.scene["connections"][2] == {"kind": "pin", "name": "pin-2", "a": "rod.left", "b": "wheel.a"}
    assert "0 degrees of freedom" in build.page.locator("#answer").inner_text()
    assert build.page.locator("#misfits li").count() == 0


def test_atwoods_machine_by_mouse(opened):
    build = Builder(opened("/scenes"))
    build.place("pulley", 0, 0.8)
    build.place("point", -0.1, -0.4)
    build.place("point", 0.2, -0.4)
    build.press("string", (-0.1, -0.4), (0, 0.93), (0.2, -0.4))
    build.keys("Enter")
    _, string = build.scene["connections"]
    assert string["through"] == ["point", "pulley", "point-2"]
    assert string["sides"] == {"pulley": ["left", "right"]}
    build.set("Length", "")
    build.page.locator("#parts button", has_text=re.compile("^point-2$")).click()
    build.set("Mass", "3")
    assert build.scene["bodies"]["point-2"]["mass"] == 3


def test_a_pendulum_by_keyboard_alone(opened):
    build = Builder(opened("/scenes", expected=REFUSED))
    build.tool("rod").focus()
    build.keys("Enter")
    assert build.said == "rod placed at 0, 0."
    build.by_name("pin", "rod.left", "the ground")
    assert build.scene["connections"][0]["a"] == "rod.left"
    # The point of the ground was typed as 0, 0: the rod was put there.
    (x, y) = build.scene["bodies"]["rod"]["at"]
    assert math.hypot(x, y) == pytest.approx(0.5)
    build.page.locator("#plane-canvas").focus()
    build.keys("]", ",", ",")
    assert build.scene["bodies"]["rod"]["angle"] == {"degrees": 30}
    # It has turned about its pin.
    (x, y) = build.scene["bodies"]["rod"]["at"]
    assert (x, y) == pytest.approx((0.5 * math.cos(math.radians(30)), 0.25))
    # Keys that follow one another are one change.
    build.keys("Control+z")
    assert "angle" not in build.scene["bodies"]["rod"]
    build.page.keyboard.press("Control+y")
    settle(build.page)
    assert "angle" in build.scene["bodies"]["rod"]
    build.keys("Delete")
    assert build.scene["bodies"] == {}
    assert "with what was connected" in build.said


def test_bodies_stand_on_what_is_below(opened):
    build = Builder(opened("/scenes"))
    build.place("floor", 0, -1)
    build.place("box", -1, -0.8)
    build.place("disc", 0.6, 0.5)
    scene = build.scene
    assert scene["bodies"]["box"]["at"] == [-1, -0.85]
    assert {c["place"].split(".")[0] for c in scene["connections"]} == {"box", "disc"}
    # The face is one part: its handle turns it for everything that touches it.
    build.page.locator("#parts button", has_text="floor").click()
    build.set("Friction coefficient", "0.9")
    assert {c["friction"] for c in build.scene["connections"]} == {0.9}


def test_a_ramp_takes_a_box_turned_onto_it(opened):
    build = Builder(opened("/scenes"))
    build.place("ramp", -0.5, -0.5)
    build.place("box", 0.6, 0.3)
    box = build.scene["bodies"]["box"]
    assert box["angle"] == {"degrees": 30}
    x, y = box["at"][0] + 0.5, box["at"][1] + 0.5
    assert -x * 0.5 + y * math.sqrt(0.75) == pytest.approx(0.15, abs=1e-12)


def test_what_is_dragged_takes_its_joints_along(opened):
    page = opened("/scenes#scene=double-pendulum", expected=REFUSED)
    canvas = page.locator("#plane-canvas")
    page.locator("#parts button").first.click()
    canvas.focus()
    for _ in range(2):
        page.keyboard.press("Shift+ArrowDown")
    settle(page)
    bodies = json.loads(page.locator("#editor").input_value())["bodies"]
    angle = {name: body["angle"] for name, body in bodies.items()}
    end = [bodies["one"]["at"][k] + 0.5 * (math.cos, math.sin)[k](angle["one"]) for k in range(2)]
    top = [bodies["two"]["at"][k] - 0.5 * (math.cos, math.sin)[k](angle["two"]) for k in range(2)]
    assert end == pytest.approx(top, abs=1e-12)
    assert angle["one"] < -0.3
    assert page.locator("#misfits li").count() == 0


def test_what_cannot_be_is_said_in_words_of_the_picture(opened):
    build = Builder(opened("/scenes", expected=REFUSED))
    build.place("rod", 0, 0)
    build.connect("pin", (-0.5, 0), (-1.5, 0))
    build.connect("pin", (-0.5, 0), (1.5, 0.8))
    words = build.page.locator("#misfits").inner_text()
    assert "cannot" in words
    assert "/" not in words
    assert "does not fit" in build.page.locator("#parts").inner_text()
    build.keys("Control+z")
    assert build.page.locator("#misfits li").count() == 0


def test_names_are_edited_in_place_and_followed(opened):
    build = Builder(opened("/scenes"))
    build.place("point", 0, 0)
    build.connect("spring", (0, 0), (0, 1))
    build.page.mouse.dblclick(*build.at(0, 0))
    build.page.keyboard.type("bob")
    build.keys("Enter")
    assert list(build.scene["bodies"]) == ["bob"]
    assert build.scene["connections"][0]["a"] == "bob"


def test_a_group_moves_and_is_copied_with_what_holds_it(opened):
    build = Builder(opened("/scenes"))
    build.place("point", -1, 0)
    build.place("point", 0, 0)
    build.connect("spring", (-1, 0), (0, 0))
    build.page.keyboard.down("Shift")
    build.page.mouse.click(*build.at(-1, 0))
    build.page.mouse.click(*build.at(0, 0))
    build.page.keyboard.up("Shift")
    build.page.locator("#parts button", has_text="spring").click(modifiers=["Shift"])
    build.drag((0, 0), (0, 0.5))
    assert [body["at"] for body in build.scene["bodies"].values()] == [[-1, 0.5], [0, 0.5]]
    build.page.locator("#duplicate").click()
    settle(build.page)
    assert len(build.scene["bodies"]) == 4
    assert build.scene["connections"][1]["a"] in ("point-3", "point-4")


def test_an_arrow_gives_a_velocity_and_a_force(opened):
    build = Builder(opened("/scenes"))
    build.place("point", 0, 0)
    scale = build.at(1, 0)[0] - build.at(0, 0)[0]
    build.drag((0, 46 / scale), (120 / scale, 0))
    assert build.scene["bodies"]["point"]["velocity"] == [2, 0]
    build.connect("force", (0, 0), (0, 60 / scale))
    assert build.scene["connections"][0]["force"] == [0, 5]


def test_a_file_and_a_link_open_the_scene_that_was_built(opened, tmp_path):
    build = Builder(opened("/scenes"))
    build.place("floor", 0, -1)
    build.page.locator("#parts button", has_text="floor").wait_for()
    build.place("disc", 0, 0)
    again = opened(build.page.url[build.page.url.index("/scenes") :])
    assert json.loads(again.locator("#editor").input_value()) == build.scene
    file = tmp_path / "own.json"
    file.write_text(json.dumps(build.scene | {"gravity": [0, -1.62]}))
    again.locator("#file").set_input_files(file)
    settle(again)
    assert '"gravity": [0, -1.62]' in again.locator("#editor").input_value()


def test_a_finger_places_and_drags(opened):
    page = opened("/scenes", has_touch=True, is_mobile=True, viewport={"width": 390, "height": 844})
    build = Builder(page)
    build.tool("disc").tap()
    canvas = page.locator("#plane-canvas")
    canvas.scroll_into_view_if_needed()
    page.touchscreen.tap(*build.at(0, 0))
    settle(page)
    (name,) = build.scene["bodies"]
    before = build.scene["bodies"][name]["at"]
    touch = page.context.new_cdp_session(page)
    (x, y), (to, _) = build.at(*before), build.at(1, 0)
    for kind, points in (
        ("touchStart", [(x, y)]),
        *(("touchMove", [(x + (to - x) * k / 5, y)]) for k in range(1, 6)),
        ("touchEnd", []),
    ):
        touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": [{"x": a, "y": b} for a, b in points]})
        page.wait_for_timeout(30)
    settle(page)
    assert build.scene["bodies"][name]["at"][0] == pytest.approx(1, abs=0.1)


def test_the_motion_follows_while_one_drags(opened):
    page = opened("/scenes#scene=double-pendulum-of-points", expected=REFUSED)
    page.evaluate(
        """() => {
      window.asked = [];
      const own = (entry) => entry.name.endsWith("/v1/scenes");
      const durations = (list) => list.getEntries().filter(own).map((entry) => entry.duration);
      const observer = new PerformanceObserver((list) => asked.push(...durations(list)));
      observer.observe({ type: "resource" });
    }"""
    )
    page.locator("#parts button").first.click()
    page.locator("#plane-canvas").focus()
    for _ in range(6):
        page.keyboard.press("ArrowRight")
        page.wait_for_timeout(150)
    settle(page)
    asked = page.evaluate("window.asked")
    assert len(asked) >= 3
    FIGURES.append(
        f"a change of a double pendulum: {statistics.median(asked):.0f} ms to its answer, in the median of {len(asked)}"
    )
