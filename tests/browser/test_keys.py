"""A service that requires keys: each page asks for one, says when it is wrong, and has it until the tab is closed."""

import hashlib

import pytest

from tests.browser.serving import serving

KEY, STANDING = "a-key-of-a-student", "body[data-ready]"


@pytest.fixture(scope="module")
def guarded(tmp_path_factory):
    file = tmp_path_factory.mktemp("keys") / "keys"
    file.write_text(f"student {hashlib.sha256(KEY.encode()).hexdigest()} 1000 600\n")
    with serving(POLHODE_KEYS_FILE=str(file)) as url:
        yield url


@pytest.mark.parametrize("path", ["/", "/scenes", "/studies"])
def test_a_page_asks_for_the_key(opened, guarded, path):
    page = opened(guarded + path, expected=("401",), wait=False)
    form = page.locator("form.credentials")
    form.wait_for()
    assert form.inner_text().startswith("This service requires a key:")
    form.locator("input").fill("another")
    form.locator("button").click()
    form.get_by_text("does not accept this key").wait_for()
    form.locator("input").fill(KEY)
    page.keyboard.press("Enter")
    page.wait_for_selector(STANDING)
    assert form.count() == 0
    page.reload()
    page.wait_for_selector(STANDING)
    assert form.count() == 0
    assert KEY not in page.url
