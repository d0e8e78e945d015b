"""Twelve scenes of a course built from nothing, by mouse and keyboard: ``python -m tests.browser.course_scenes``.

Writes a table of actions and seconds. A focus stands for the tabs that lead to it; seconds are those of a script that
waits for every answer, and no measure of how long a person takes.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from time import perf_counter
from typing import Any

from playwright.sync_api import sync_playwright

from tests.browser.building import Builder
from tests.browser.serving import ARGUMENTS, CHROMIUM, serving


class Counted(Builder):
    """A builder that counts what it does: drags, presses, keys and fields."""

    actions = 0

    def drag(self, start: tuple[float, float], end: tuple[float, float]) -> None:
        self.actions += 1
        super().drag(start, end)

    def place(self, name: str, x: float, y: float) -> None:
        self.actions += 1
        super().place(name, x, y)

    def press(self, name: str, *points: tuple[float, float]) -> None:
        self.actions += 1 + len(points)
        super().press(name, *points)

    def keys(self, *keys: str) -> None:
        self.actions += len(keys)
        super().keys(*keys)

    def by_name(self, name: str, *places: str) -> None:
        self.actions += 2 + len(places)
        super().by_name(name, *places)

    def set(self, label: str, value: str) -> None:
        self.actions += 1
        super().set(label, value)

    def put(self, name: str, x: float, y: float, *more: tuple[str, str]) -> None:
        """Place a part by keyboard alone, and write where it is."""
        self.tool(name).focus()
        self.keys("Enter")
        for label, value in (("Place x", f"{x}"), ("Place y", f"{y}"), *more):
            self.set(label, value)

    def down(self) -> None:
        """Set what is selected down on the nearest face, by key."""
        self.page.locator("#plane-canvas").focus()
        self.keys("v")


def pendulum_mouse(build: Counted) -> None:
    build.place("rod", 0.5, 0.5)
    build.press("pin", (0, 0.5))


def pendulum_keys(build: Counted) -> None:
    build.put("rod", 0.5, 0)
    build.by_name("pin", "rod.left", "the ground")


def atwood_mouse(build: Counted) -> None:
    build.place("pulley", 0, 0.8)
    build.place("point", -0.2, -0.4)
    build.place("point", 0.2, -0.4)
    build.press("string", (-0.2, -0.4), (0, 0.93), (0.2, -0.4))
    build.keys("Enter")


def atwood_keys(build: Counted) -> None:
    build.put("pulley", 0, 0.8)
    build.put("point", -0.15, -0.4)
    build.put("point", 0.15, -0.4, ("Mass", "2"))
    build.by_name("string", "point", "pulley", "point-2")


def ramp_mouse(build: Counted) -> None:
    build.place("ramp", -0.5, -0.5)
    build.place("box", 0.6, 0.3)


def ramp_keys(build: Counted) -> None:
    build.tool("ramp").focus()
    build.keys("Enter")
    build.tool("disc").focus()
    build.keys("Enter")
    build.down()


def spring_mouse(build: Counted) -> None:
    build.place("point", 0, -0.2)
    build.connect("spring", (0, -0.2), (0, 1))
    build.connect("damper", (0, -0.2), (0.5, 1))


def spring_keys(build: Counted) -> None:
    build.put("point", 0, -1)
    build.by_name("spring", "point", "the ground")
    build.by_name("damper", "point", "the ground")


def double_mouse(build: Counted) -> None:
    build.place("rod", 0.5, 0.5)
    build.place("rod", 1.5, 0.5)
    build.press("pin", (0, 0.5))
    build.press("pin", (1, 0.5))


def double_keys(build: Counted) -> None:
    build.put("rod", 0.5, 0)
    build.put("rod", 1.5, 0)
    build.by_name("pin", "rod.left", "the ground")
    build.by_name("pin", "rod-2.left", "rod.right")


def crank_mouse(build: Counted) -> None:
    build.place("wheel", 0, 0)
    build.place("rod", 0.7, 0)
    build.place("box", 1.2, 0)
    build.press("motor", (0, 0))
    build.press("pin", (0.2, 0))
    build.press("pin", (1.2, 0))
    build.press("slider", (1.2, 0.1))


def crank_keys(build: Counted) -> None:
    build.put("rod", 0.5, 0)
    build.put("rod", 1.5, 0)
    build.put("box", 2, 0)
    build.by_name("pin", "rod.left", "the ground")
    build.by_name("pin", "rod-2.left", "rod.right")
    build.by_name("pin", "rod-2.right", "box")
    build.by_name("slider", "box", "the ground")
    build.by_name("motor", "rod")


def ball_mouse(build: Counted) -> None:
    build.place("floor", 0, -1)
    build.place("disc", 0, 0.5)
    build.page.locator("#parts button", has_text="floor").click()
    build.set("Restitution", "0.8")


def ball_keys(build: Counted) -> None:
    build.tool("floor").focus()
    build.keys("Enter")
    build.tool("disc").focus()
    build.keys("Enter")
    build.page.locator("#parts button", has_text="floor").focus()
    build.keys("Enter")
    build.set("Restitution", "0.8")


def throw_mouse(build: Counted) -> None:
    build.place("point", -1, -0.5)
    scale = build.at(1, 0)[0] - build.at(0, 0)[0]
    build.drag((-1, -0.5 + 46 / scale), (-1 + 90 / scale, -0.5 + 150 / scale))


def throw_keys(build: Counted) -> None:
    build.put("point", -1, -0.5, ("Velocity x", "2"), ("Velocity y", "3"))


def wedge_mouse(build: Counted) -> None:
    build.place("wedge", 0, -0.5)
    build.place("point", -0.2, -0.2)


def wedge_keys(build: Counted) -> None:
    build.put("wedge", 0, -0.5)
    build.put("point", -0.2, 0.2)
    build.down()


def ladder_mouse(build: Counted) -> None:
    build.place("floor", 0, -1)
    build.place("wall", 0.6, 0)
    build.place("rod", 0.2, -0.6)
    scale = build.at(1, 0)[0] - build.at(0, 0)[0]
    build.drag((0.2 + 0.5 + 34 / scale, -0.6), (0.6, 0.1))


def ladder_keys(build: Counted) -> None:
    for face in ("floor", "wall"):
        build.tool(face).focus()
        build.keys("Enter")
    build.put("rod", -1, -0.3, ("Angle", "60°"))
    build.down()
    build.down()


def cart_mouse(build: Counted) -> None:
    build.place("box", 0, 0.5)
    build.press("slider", (0, 0.5))
    build.place("point", 0.5, -0.4)
    build.connect("link", (0.5, -0.4), (0, 0.5))


def cart_keys(build: Counted) -> None:
    build.put("box", 0, 0.5)
    build.by_name("slider", "box", "the ground")
    build.put("point", 0.5, -0.4)
    build.by_name("link", "point", "box")


def balls_mouse(build: Counted) -> None:
    build.place("disc", -1, 0)
    build.place("disc", 0.6, 0.1)
    build.connect("contact", (-1, 0), (0.6, 0.1))
    build.page.locator("#parts button", has_text="disc").first.click()
    build.set("Velocity x", "2")


def balls_keys(build: Counted) -> None:
    build.put("disc", -1, 0, ("Velocity x", "2"))
    build.put("disc", 0.6, 0.1)
    build.by_name("contact", "disc", "disc-2")


SCENES: dict[str, tuple[Callable[[Counted], None], Callable[[Counted], None]]] = {
    "pendulum": (pendulum_mouse, pendulum_keys),
    "Atwood's machine": (atwood_mouse, atwood_keys),
    "body on a ramp": (ramp_mouse, ramp_keys),
    "damped oscillator": (spring_mouse, spring_keys),
    "double pendulum": (double_mouse, double_keys),
    "crank and slider": (crank_mouse, crank_keys),
    "bouncing ball": (ball_mouse, ball_keys),
    "throw": (throw_mouse, throw_keys),
    "block on a movable wedge": (wedge_mouse, wedge_keys),
    "ladder against a wall": (ladder_mouse, ladder_keys),
    "pendulum on a cart": (cart_mouse, cart_keys),
    "two discs collide": (balls_mouse, balls_keys),
}


def run(page: Any, build: Callable[[Counted], None]) -> tuple[int, float, str]:
    """Build a scene; return the actions, the seconds, and what the page says of it."""
    builder = Counted(page)
    start = perf_counter()
    build(builder)
    wrong = page.locator("#misfits").inner_text()
    return builder.actions, perf_counter() - start, wrong or builder.summary


def main() -> None:
    """Write the table."""
    with serving() as url, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        page = browser.new_context(viewport={"width": 1280, "height": 900}, reduced_motion="reduce").new_page()
        page.goto(f"{url}/scenes")
        page.wait_for_selector("body[data-ready]", timeout=60_000)
        for name, ways in SCENES.items():
            for way, build in zip(("mouse", "keyboard"), ways, strict=True):
                actions, seconds, said = run(page, build)
                sys.stdout.write(f"| {name} | {way} | {actions} | {seconds:.1f} | {said} |\n")
        browser.close()


if __name__ == "__main__":
    main()
