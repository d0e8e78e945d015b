"""Every code block of README and documentation runs: a service answers what they send, and the answers are those shown.

`sh` and `python` run as they stand, in a folder of their own; what a block prints is the `text` or
`json` that follows. `json` behind the name of an endpoint is a request to it, and the `json` after that its answer. A
block that cannot run says so in its first line: `# not tested: needs Docker`.
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import re
import subprocess
import sys
import urllib.request
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from docs.site.blocks import Block, blocks
from docs.site.navigation import pages

ROOT = Path(__file__).parents[2]
RUN = ("sh", "python", "json")
SHOWN = ("text", "html", "math", "ts", "yaml")
"""Languages of blocks that are only read."""

UNTESTED = re.compile(r"^# not tested: (.+)$", re.MULTILINE)
REASONS = ("installs packages", "needs Docker", "needs a cluster", "runs for minutes")
PAGES = [page for page in pages().values() if any(blocks(page.read_text()))]
LINKED = ("clients", "core", "docs", "examples", "service")
"""Folders that somebody who has cloned the repository finds where commands run."""

ACTIVATED = "source .venv/bin/activate"
"""What pages say before commands that need the environment: its programs come first, and nothing else is set."""


def contains(answer: Any, shown: Any) -> bool:
    """Return whether every field that is shown is in the answer, with the same value."""
    if isinstance(shown, dict):
        return isinstance(answer, dict) and all(
            name in answer and contains(answer[name], value) for name, value in shown.items()
        )
    if isinstance(shown, list):
        return (
            isinstance(answer, list)
            and len(answer) == len(shown)
            and all(contains(a, s) for a, s in zip(answer, shown, strict=True))
        )
    return bool(answer == shown)


def untested(block: Block) -> str | None:
    """Return why no test runs a block, if its first line says so."""
    reason = UNTESTED.match(block.code)
    return reason[1] if reason else None


class Page:
    """Runs the blocks of one page in their order; those in Python share their names."""

    def __init__(self, service: str, folder: Path) -> None:
        self.service, self.folder = service, folder
        self.names: dict[str, Any] = {"__name__": "page"}
        self.printed = ""

    def at(self, text: str) -> str:
        for address in ("http://127.0.0.1:8000", "http://localhost:8000", "localhost:8000"):
            text = text.replace(address, self.service)
        return text

    def run(self, block: Block) -> None:
        if block.language == "python":
            printed = io.StringIO()
            with contextlib.redirect_stdout(printed):
                exec(compile(self.at(block.code), "block", "exec"), self.names)
            self.printed = printed.getvalue()
        elif block.language == "sh":
            self.printed = self.shell(self.at(block.code))
        elif block.language == "json" and block.endpoint:
            self.printed = self.send(block.endpoint, block.code)
        elif block.language == "json":
            assert contains(json.loads(self.printed), json.loads(block.code)), self.printed
        elif block.language == "text":
            assert self.printed == block.code

    def shell(self, code: str) -> str:
        environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"} | {
            "POLHODE_PORT": self.service.rpartition(":")[2],
            "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}",
        }
        command = ["bash", "-eo", "pipefail", "-c", code]
        done = subprocess.run(command, cwd=self.folder, env=environment, capture_output=True, text=True, timeout=200)
        assert done.returncode == 0, done.stderr
        return done.stdout

    def send(self, path: str, body: str) -> str:
        json.loads(body)
        request = urllib.request.Request(self.service + path, body.encode(), {"Content-Type": "application/json"})
        answer: str = urllib.request.urlopen(request).read().decode()
        return answer


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a folder in which blocks may write."""
    for name in LINKED:
        (tmp_path / name).symlink_to(ROOT / name)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_blocks_run_and_print_what_is_shown(page: Path, service: str, folder: Path) -> None:
    runner = Page(service, folder)
    for block in blocks(page.read_text()):
        if untested(block) is None:
            runner.run(block)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_every_block_is_run_or_says_why_not(page: Path) -> None:
    for block in blocks(page.read_text()):
        assert block.language in RUN + SHOWN, block.code
        assert untested(block) is None or untested(block) in REASONS
        assert "not tested" not in block.code or untested(block)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_a_page_says_where_its_commands_run(page: Path) -> None:
    text = page.read_text()
    commands = [block.code for block in blocks(text) if block.language == "sh" and untested(block) is None]
    assert ACTIVATED in text or not any(re.search(r"(?m)^python ", code) for code in commands)


def test_the_request_of_the_readme_is_that_of_the_example() -> None:
    request = next(block for block in blocks((ROOT / "README.md").read_text()) if block.language == "json")
    assert json.loads(request.code) == json.loads((ROOT / "examples/rotation/precession/box.json").read_text())


WRONG: list[Callable[[Page], None]] = [
    lambda page: page.run(Block("python", "print(1)\n", "")) or page.run(Block("text", "2\n", "")),
    lambda page: page.run(Block("sh", "false | true\n", "")),
    lambda page: page.run(Block("sh", "echo '{\"a\": 1}'\n", "")) or page.run(Block("json", '{"a": 2}', "")),
]


@pytest.mark.parametrize("wrong", WRONG)
def test_a_block_that_shows_something_else_is_found(wrong: Callable[[Page], None], tmp_path: Path) -> None:
    with pytest.raises(AssertionError):
        wrong(Page("http://127.0.0.1:1", tmp_path))
