"""Take the pictures of the pages for the documentation: ``make pictures``."""

from __future__ import annotations

from pathlib import Path

from playwright.sync_api import sync_playwright

from tests.browser.serving import ARGUMENTS, CHROMIUM, ROOT, serving

FOLDER = ROOT / "docs/pictures"
PICTURES = {
    "page-desktop": ("/#body=t-handle&spin=1,10,1", 1280, 860, "light", 70),
    "page-dark": (
        "/#body=moments&moments=1,2,3&spin=0.1,2,0.1&method=explicit-euler&setting=0.04",
        1280,
        860,
        "dark",
        300,
    ),
    "page-phone": ("/#body=racket", 390, 844, "light", 300),
    "builder-desktop": ("/scenes#scene=crank-slider", 1280, 900, "light", None),
    "gallery-desktop": ("/scenes", 1280, 900, "light", None),
    "scenes-desktop": ("/scenes#scene=spool", 1280, 860, "light", 330),
    "scenes-phone": ("/scenes#scene=lagrange-top", 390, 844, "dark", 330),
    "studies-desktop": ("/studies", 1280, 860, "light", None),
    "docs-desktop": ("/docs#/rotation/rotation_trajectory", 1280, 860, "light", None),
}
"""By name: path, width, height, colours, thousandths of the time shown."""


def take(base: str, folder: Path) -> None:
    """Write every picture into a folder."""
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        for name, (path, width, height, scheme, time) in PICTURES.items():
            size = {"width": width, "height": height}
            page = browser.new_context(viewport=size, color_scheme=scheme, reduced_motion="reduce").new_page()
            page.goto(base + path)
            page.wait_for_selector("body[data-ready]", timeout=60_000)
            page.wait_for_timeout(1_000)
            if path == "/studies":
                page.locator("#start").click()
                page.get_by_text("successful").wait_for()
                page.locator("#list button").first.click()
                page.locator("#map").wait_for()
            if name == "builder-desktop":
                page.locator("#parts button").first.click()
            if name == "gallery-desktop":
                page.locator("#browse").click()
            if time is not None:
                page.locator("#player input").fill(str(time))
                page.locator("#player input").blur()
            if "phone" in name:
                page.locator(".stage").evaluate("e => e.scrollIntoView()")
            page.wait_for_timeout(700)
            page.screenshot(path=folder / f"{name}.png")
        browser.close()


if __name__ == "__main__":
    with serving() as url:
        take(url, FOLDER)
