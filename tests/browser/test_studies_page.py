"""The page of studies: what is started runs to its end, is drawn with the numbers of the API, and goes away."""

import json
import re
from urllib.request import urlopen

from axe_playwright_python.sync_playwright import Axe

REFUSED = ("422",)


def test_a_map_has_the_numbers_of_the_api(opened, base):
    page = opened("/studies")
    page.locator("#price").click()
    page.locator("#told", has_text="members").wait_for()
    page.locator("#start").click()
    row = page.locator("#list li")
    row.get_by_text("successful").wait_for(timeout=120_000)
    row.get_by_role("button", name="Show").click()
    page.locator("#map").wait_for()
    (study,) = json.load(urlopen(f"{base}/v1/studies"))["studies"]
    answer = json.load(urlopen(f"{base}/v1/studies/{study['jobID']}/results?count=1"))
    figures = answer["statistics"]["figures"]
    assert page.locator("#figure option").all_inner_texts() == list(figures)
    for pointer, found in figures.items():
        page.locator("#figure").select_option(pointer)
        said = page.locator("#numbers").inner_text()
        assert said.startswith(f"{found['present']} members have this figure; mean {found['mean']:.6g}")
        said = page.locator("#map .map").get_attribute("aria-label")
        assert said.startswith(f"Map of {pointer} over /body/moments/0 and /body/moments/1, from ")
        assert page.locator("#histogram").get_attribute("aria-label").startswith("Histogram from ")
    with page.expect_download() as download:
        page.locator("#links button", has_text="npz").click()
    assert download.value.suggested_filename.endswith(".npz")
    page.reload()
    page.wait_for_selector("body[data-ready]")
    assert "successful, 6400 of 6400 members" in page.locator("#list li").inner_text()
    page.locator("#list li button", has_text="Remove").click()
    page.locator("#none").wait_for()
    assert json.load(urlopen(f"{base}/v1/studies"))["studies"] == []


def started(page, study):
    """Start a study and show it."""
    page.locator("#editor").fill(json.dumps(study))
    page.locator("#start").click()
    row = page.locator("#list li")
    row.get_by_text("successful").wait_for(timeout=120_000)
    row.get_by_role("button", name="Show").click()
    page.locator("#map canvas").first.wait_for()


def removed(page):
    page.locator("#list li button", has_text="Remove").click()
    page.locator("#none").wait_for()


def test_a_cell_says_its_values_and_opens_its_member(opened, base, ask):
    page = opened("/studies")
    study = json.loads(page.locator("#editor").input_value())
    for axis, count in zip(study["vary"], (4, 3), strict=True):
        axis["count"] = count
    started(page, study)
    (state,) = json.load(urlopen(f"{base}/v1/studies"))["studies"]
    columns = json.load(urlopen(f"{base}/v1/studies/{state['jobID']}/results?count=12"))
    # The second cell of the first axis, the last of the second one: member 1*3 + 2.
    over = page.locator("#map .map .u-over")
    over.scroll_into_view_if_needed()
    box = over.bounding_box()
    place = (box["x"] + box["width"] * 1.5 / 4, box["y"] + box["height"] * 0.5 / 3)
    page.mouse.move(*place)
    values = [columns["inputs"][axis["pointer"]][5] for axis in study["vary"]]
    figure = columns["figures"]["/flip_interval"][5]
    said = f"/body/moments/0 {values[0]:.5g}, /body/moments/1 {values[1]:.5g}: {figure:.6g} s"
    assert page.locator("#hovered").inner_text() == said
    page.mouse.click(*place)
    member = page.locator("#member")
    member.get_by_role("heading", name="Member 5").wait_for()
    member.locator("summary").click()
    first, _, body = member.locator("pre").inner_text().partition("\n")
    answer = ask(first.removeprefix("POST "), json.loads(body))
    assert answer["flip_interval"] == figure
    # By keys: one cell to the right of it.
    page.locator("#map .map").focus()
    page.keyboard.press("ArrowRight")
    page.keyboard.press("Enter")
    member.get_by_role("heading", name="Member 8").wait_for()
    for width in (1280, 390):
        page.set_viewport_size({"width": width, "height": 844})
        page.wait_for_timeout(500)
        results = Axe().run(page)
        assert results.violations_count == 0, results.generate_report()
        assert page.evaluate("document.documentElement.scrollWidth - innerWidth") <= 0
    removed(page)


def test_refused_members_are_told_by_reason_with_an_example(opened):
    page = opened("/studies", expected=REFUSED)
    study = json.loads(page.locator("#editor").input_value())
    # No moment of inertia is negative.
    study["vary"] = [study["vary"][0] | {"min": -0.05, "count": 4}, study["vary"][1] | {"count": 3}]
    started(page, study)
    # The members of the study are looked through for an example of each reason first.
    page.locator("#refusals li").first.locator("button").click()
    page.locator("#member [role=status]", has_text=re.compile(r"^Refused \(.*\): /body")).wait_for()
    removed(page)


def test_a_fault_is_shown_with_its_place(opened):
    page = opened("/studies", expected=REFUSED)
    study = json.loads(page.locator("#editor").input_value())
    study["quantities"] = ["/no_such_figure"]
    page.locator("#editor").fill(json.dumps(study))
    for button in ("#price", "#start"):
        page.locator(button).click()
        page.locator("#problem", has_text=re.compile("^/quantities/0 ")).wait_for()
    assert page.locator("#list li").count() == 0


def test_no_time_is_foreseen_until_a_member_is_done(opened):
    state = {"jobID": "one", "path": "/v1/scenes", "inputs": [{"pointer": "/gravity/1"}]}
    state |= {
        "created": "2030-01-01T00:00:00Z",
        "status": "running",
        "message": "",
        "count": 3000,
        "done": 0,
        "failed": 0,
    }
    state |= {"predicted_end": "2030-01-01T00:00:00Z"}
    later = []

    def answered(route):
        alone = route.request.url.endswith("/one")
        route.fulfill(json=state | {"done": len(later)} if alone else {"studies": [state]})

    page = opened("/studies")
    page.route("**/v1/studies**", answered)
    page.reload()
    row = page.locator("#list li")
    row.get_by_text("running, 0 of 3000 members, starting").wait_for()
    assert row.get_by_role("button", name="Show").is_disabled()
    later.append(1)
    row.get_by_text("running, 1 of 3000 members, about").wait_for()


def test_a_running_study_shows_progress_and_can_be_stopped(opened, base):
    page = opened("/studies")
    study = json.loads(page.locator("#editor").input_value())
    study["question"]["path"] = "/v1/rotation/trajectory"
    study["question"]["request"]["times"] = {"start": 0, "stop": 1000, "count": 1000}
    study["quantities"] = ["/angular_velocity/999/1"]
    for axis in study["vary"]:
        axis["count"] = 300
    page.locator("#editor").fill(json.dumps(study))
    page.locator("#start").click()
    row = page.locator("#list li")
    row.get_by_text("s left").wait_for(timeout=60_000)
    row.locator("button", has_text="Stop").click()
    row.get_by_text("dismissed").wait_for(timeout=10_000)
    (state,) = json.load(urlopen(f"{base}/v1/studies"))["studies"]
    assert state["status"] == "dismissed"
    assert state["done"] < state["count"] == 90_000
    row.locator("button", has_text="Remove").click()
    page.locator("#none").wait_for()
