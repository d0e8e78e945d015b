"""Log lines: one JSON object each, whatever is logged."""

from __future__ import annotations

import json
import logging
import re
import subprocess
import sys
import time
from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from service.observability.logs import LOG, JsonLines, configure
from tests.drawn import draws
from tests.service.conftest import PATIENCE

ROOT = Path(__file__).parents[3]
LINES = JsonLines()


def record(message: str = "told", *args: Any, exc_info: Any = None, **extra: Any) -> logging.LogRecord:
    return LOG.makeRecord("polhode", logging.WARNING, __file__, 1, message, args, exc_info, extra=extra)


def read(line: str) -> dict[str, Any]:
    assert "\n" not in line

    def refused(constant: str) -> None:
        raise AssertionError(f"{constant} is no JSON")

    found: dict[str, Any] = json.loads(line, parse_constant=refused)
    return found


@pytest.fixture
def elsewhere(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Where clocks show another time than that of Greenwich."""
    monkeypatch.setenv("TZ", "UTC-5:30")
    time.tzset()
    yield
    monkeypatch.undo()
    time.tzset()


@pytest.mark.usefixtures("elsewhere")
def test_a_line_has_time_level_logger_and_message() -> None:
    made = record("%s of %d", "one", 2)
    made.created, made.msecs = 1_700_000_000.0625, 62.5
    found = read(LINES.format(made))
    assert found == {
        "time": "2023-11-14T22:13:20.062Z",
        "level": "warning",
        "logger": "polhode",
        "message": "one of 2",
    }
    assert next(iter(found)) == "time"


@given(st.datetimes(datetime(1970, 1, 2), datetime(2200, 1, 1)))
@settings(derandomize=True)
def test_times_are_universal_and_to_the_millisecond(moment: datetime) -> None:
    moment = moment.replace(tzinfo=UTC)
    made = record()
    made.created = moment.timestamp()
    made.msecs = (made.created % 1.0) * 1000.0
    told = datetime.fromisoformat(read(LINES.format(made))["time"])
    assert told.tzinfo is not None
    assert -1e-5 <= (moment - told).total_seconds() < 1.0011e-3


def test_extras_are_members() -> None:
    extra = {"request_id": "a-1", "status": 200, "milliseconds": 0.5, "nothing": None, "listed": [1, {"a": 2}]}
    found = read(LINES.format(record(**extra)))
    assert {name: found[name] for name in extra} == extra
    # Of what Python knows about a record beside it nothing is told: places of files are the house's own.
    assert not {"pathname", "lineno", "args", "msg", "thread", "process", "exc_info"} & set(found)


def test_what_was_raised_is_reported_in_one_line() -> None:
    try:
        raise ValueError("first\nsecond")
    except ValueError:
        found = read(LINES.format(record(exc_info=sys.exc_info())))
    assert found["traceback"].startswith("Traceback")
    assert found["traceback"].endswith("ValueError: first\nsecond")
    assert "traceback" not in read(LINES.format(record()))


ANYTHING = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats()
    | st.text(st.characters())
    | st.binary()
    | st.complex_numbers(),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=3) | st.integers(), inner, max_size=3),
    max_leaves=6,
)


@given(st.text(st.characters()), ANYTHING)
@settings(deadline=None, derandomize=True, max_examples=draws(200))
def test_whatever_is_logged_there_is_a_line(message: str, extra: Any) -> None:
    """Texts that are no Unicode, numbers of any size, things of any kind: a line that is lost tells nothing."""
    found = read(LINES.format(record(message.replace("%", "%%"), thing=extra)))
    assert found["level"] == "warning"
    if all(not "\ud800" <= character <= "\udfff" for character in message):
        assert found["message"] == message.replace("%", "%%")
    assert "thing" in found


@pytest.mark.parametrize(
    ("extra", "told"),
    [
        (2**64, str(2**64)),
        (Path("/a"), "/a"),
        ({(1, 2): 3}, "{(1, 2): 3}"),
        ("a\ud800b", "a\\ud800b"),
    ],
    ids=["a large number", "a path", "keys that are no texts", "no Unicode"],
)
def test_what_json_has_no_form_for_is_reported_as_text(extra: Any, told: str) -> None:
    found = read(LINES.format(record("a\nb", status=200, thing=extra)))
    assert (found["message"], found["status"], found["thing"]) == ("a\nb", 200, told)


def test_a_process_is_configured_to_log_lines_on_standard_error() -> None:
    script = f"""
import logging, sys, warnings
sys.path.insert(0, {str(ROOT)!r})
from service.observability.logs import LOG, configure
logging.basicConfig(stream=sys.stdout)
configure("info")
LOG.debug("not told")
LOG.info("told", extra={{"a": 1}})
logging.getLogger("uvicorn.error").warning("told too")
try:
    1 / 0
except ZeroDivisionError:
    LOG.exception("failed")
warnings.warn("of a package")
"""
    run = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True, timeout=PATIENCE)
    assert run.stdout == ""
    found = [read(line) for line in run.stderr.splitlines()]
    assert [(entry["level"], entry["logger"], entry["message"]) for entry in found] == [
        ("info", "polhode", "told"),
        ("warning", "uvicorn.error", "told too"),
        ("error", "polhode", "failed"),
        ("warning", "py.warnings", found[3]["message"]),
    ]
    assert "UserWarning: of a package" in found[3]["message"]
    assert found[0]["a"] == 1
    assert re.search("ZeroDivisionError", found[2]["traceback"])


def test_an_unknown_level_is_refused() -> None:
    with pytest.raises(ValueError, match="LOUD"):
        configure("loud")
