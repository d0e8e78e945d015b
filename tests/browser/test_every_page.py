"""What holds for all pages: no violation of axe-core, no sideways scrolling, weight, time to load."""

import gzip
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from axe_playwright_python.sync_playwright import Axe

from tests.browser.conftest import FIGURES
from tests.browser.serving import ROOT

PAGES = (
    "/",
    "/#body=points&method=explicit-euler",
    "/#body=moments&moments=1,2,3&spin=0,2,0",
    "/scenes",
    "/scenes#scene=lagrange-top",
    "/scenes#scene=own",
    "/scenes?embed=1#scene=spool",
    "/studies",
    "/docs",
    "/docs#/rotation/rotation_trajectory",
)
DEPRECATED = ("Deprecated: escaping deep link whitespace",)


@pytest.mark.parametrize("path", PAGES)
def test_axe_finds_no_violation(opened, path):
    page = opened(path, expected=DEPRECATED)
    for width, scheme in ((1280, "light"), (1280, "dark"), (390, "dark"), (390, "light")):
        page.set_viewport_size({"width": width, "height": 844})
        page.emulate_media(color_scheme=scheme, reduced_motion="reduce")
        # The viewer of the reference follows by a class.
        theme = "html.dark-mode" if scheme == "dark" else "html:not(.dark-mode)"
        page.wait_for_selector(f"{theme} body.docs, body:not(.docs)")
        page.wait_for_timeout(700)
        results = Axe().run(page)
        assert results.violations_count == 0, results.generate_report()
        assert page.evaluate("document.documentElement.scrollWidth - innerWidth") <= 0
        passed = len(results.response["passes"])
        FIGURES.append(f"axe-core: {path} at {width} px, {scheme}: 0 violations, {passed} rules passed")


@pytest.mark.parametrize("path", ["/", "/scenes"])
def test_touch_scrolls_over_the_pictures(opened, path):
    page = opened(path, has_touch=True, is_mobile=True, viewport={"width": 390, "height": 844})
    for canvas in page.locator(".view canvas").all():
        assert canvas.evaluate("e => getComputedStyle(e).touchAction") in ("pan-y", "auto")
    page.wait_for_timeout(500)
    box = page.locator(".view:visible canvas").first.bounding_box()
    x, y = box["x"] + 40, min(800, box["y"] + box["height"] - 60)
    touch = page.context.new_cdp_session(page)
    touch.send("Input.dispatchTouchEvent", {"type": "touchStart", "touchPoints": [{"x": x, "y": y}]})
    for k in range(1, 11):
        touch.send("Input.dispatchTouchEvent", {"type": "touchMove", "touchPoints": [{"x": x, "y": y - 15 * k}]})
        page.wait_for_timeout(30)
    touch.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    page.wait_for_timeout(500)
    assert page.evaluate("scrollY") > 80


def counting(page):
    """Return a session with the browser that counts the processor time of the page's main thread."""
    session = page.context.new_cdp_session(page)
    session.send("Performance.enable", {"timeDomain": "threadTicks"})
    return session


SHOWN = "new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(performance.now()))))"
"""Milliseconds from the start of the navigation to the second frame after this was asked."""


@pytest.mark.parametrize("path", ["/", "/scenes", "/studies", "/docs"])
def test_weight_and_time(opened, base, path):
    sizes: dict[str, int] = {}

    def weigh(response):
        sizes[response.url] = len(gzip.compress(response.body(), 9))

    opened(path, watch=weigh).wait_for_load_state("networkidle")
    # Each time in a new context, whose cache is empty; the least time is the one that others disturbed least. Weighing
    # takes the processor and is done before.
    seconds, busy = [], []
    for _ in range(3):
        sessions = []
        page = opened(path, before=lambda page, found=sessions: found.append(counting(page)))
        seconds.append(page.evaluate(SHOWN) / 1e3)
        metrics = sessions[0].send("Performance.getMetrics")["metrics"]
        busy += [metric["value"] for metric in metrics if metric["name"] == "TaskDuration"]
    files = {url: size for url, size in sizes.items() if "/v1/" not in url}
    assert all(urlsplit(url).netloc == urlsplit(base).netloc for url in sizes)
    assert 0 < sum(files.values()) <= 900_000
    FIGURES.append(
        f"{path}: {len(files)} files, {sum(files.values()) / 1e3:.0f} kB gzipped, shown after {min(seconds):.2f} s, "
        f"of which {min(busy):.2f} s of processor time in the page"
    )


def test_the_reference_asks_and_shows_the_answer(opened):
    page = opened("/docs#/bodies/mass_properties", expected=DEPRECATED)
    page.locator("#operations-bodies-mass_properties .btn.execute").click()
    live = page.locator("#operations-bodies-mass_properties .live-responses-table")
    live.wait_for()
    assert "200" in live.inner_text()
    assert '"center_of_mass"' in live.inner_text()
    assert len(live.locator("pre").first.inner_text().splitlines()) > 10


def test_every_own_script_is_loaded_by_a_page(opened):
    loaded = set()
    for path in ("/", "/scenes#scene=lagrange-top", "/studies", "/docs"):
        page = opened(path)
        urls = page.evaluate("performance.getEntriesByType('resource').map(e => e.name)")
        loaded |= {Path(urlsplit(url).path).name for url in urls}
    own = {file.name for file in (ROOT / "service/page").glob("*.js")}
    assert own - loaded == set()
