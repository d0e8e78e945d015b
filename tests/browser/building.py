"""A scene built in the page as a reader does it: tools, places of the picture, keys."""

from __future__ import annotations

import json
import re
from typing import Any

from tests.browser.waiting import settle

SEEN = (5.12, 3.62)
"""Metres that an empty picture shows at least, with its margins."""


class Builder:
    """The page of scenes with nothing in it."""

    def __init__(self, page: Any) -> None:
        self.page = page
        page.locator("#new").click()
        settle(page)

    def at(self, x: float, y: float) -> tuple[float, float]:
        """Pixels of a point of the picture, as long as nobody has moved what is seen."""
        box = self.page.locator("#plane-canvas").bounding_box()
        scale = min(box["width"] / SEEN[0], box["height"] / SEEN[1])
        return box["x"] + box["width"] / 2 + scale * x, box["y"] + box["height"] / 2 - scale * y

    def tool(self, name: str) -> Any:
        return self.page.locator(f"[data-tool={name}]")

    def drag(self, start: tuple[float, float], end: tuple[float, float]) -> None:
        """Drag from one point of the picture to another."""
        self.page.mouse.move(*self.at(*start))
        self.page.mouse.down()
        self.page.mouse.move(*self.at(*end), steps=6)
        self.page.mouse.up()
        settle(self.page)

    def place(self, name: str, x: float, y: float) -> None:
        """Drag a part out of the palette."""
        box = self.tool(name).bounding_box()
        self.page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
        self.page.mouse.down()
        self.page.mouse.move(*self.at(x, y), steps=6)
        self.page.mouse.up()
        settle(self.page)

    def press(self, name: str, *points: tuple[float, float]) -> None:
        """Press on places with a tool."""
        self.tool(name).click()
        for point in points:
            self.page.mouse.click(*self.at(*point))
        settle(self.page)

    def connect(self, name: str, start: tuple[float, float], end: tuple[float, float]) -> None:
        """Drag from place to place with a tool."""
        self.tool(name).click()
        self.drag(start, end)

    def keys(self, *keys: str) -> None:
        for key in keys:
            self.page.keyboard.press(key)
        settle(self.page)

    def by_name(self, name: str, *places: str) -> None:
        """Connect by keyboard: choose the tool, then its places by name."""
        self.tool(name).focus()
        self.page.keyboard.press("Enter")
        boxes = self.page.locator("#connect select")
        for box, place in zip(boxes.all(), places, strict=True):
            box.focus()
            # Letters go on from what is chosen to the next that begins with them.
            if box.input_value() != place:
                self.page.keyboard.type(place)
        self.page.keyboard.press("Enter")
        if self.page.locator("#connect").is_visible():
            self.page.locator("#connect button.play").press("Enter")
        settle(self.page)

    def set(self, label: str, value: str) -> None:
        """Write into a field of the inspector."""
        field = self.page.locator("#inspector").get_by_label(re.compile(f"^{label}( |$)"))
        field.fill(value)
        field.press("Tab")
        settle(self.page)

    @property
    def scene(self) -> Any:
        return json.loads(self.page.locator("#editor").input_value())

    @property
    def summary(self) -> str:
        return str(self.page.locator("#summary").inner_text())

    @property
    def said(self) -> str:
        return str(self.page.locator("#said").inner_text())
