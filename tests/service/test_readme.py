"""The README's requests, run as printed, with curl and in Python, against a server that the test starts."""

import contextlib
import io
import json
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")


def block(language: str) -> str:
    found = re.search(rf"```{language}\n(.*?)```", README, re.DOTALL)
    assert found is not None
    return found[1]


def at(text: str, url: str) -> str:
    assert "http://127.0.0.1:8000" in text
    return text.replace("http://127.0.0.1:8000", url)


def test_python_prints_what_is_shown(server, monkeypatch):
    monkeypatch.chdir(ROOT)
    printed = io.StringIO()
    code = at(block("python"), server.url)
    assert len(code.strip().splitlines()) == 6
    with contextlib.redirect_stdout(printed):
        exec(compile(code, "README.md", "exec"), {})
    assert printed.getvalue() == block("text")


def contains(answer: Any, shown: Any) -> bool:
    """Return whether every field that is shown is in the answer, with the same value."""
    if isinstance(shown, dict):
        return all(name in answer and contains(answer[name], value) for name, value in shown.items())
    return bool(answer == shown)


@pytest.mark.skipif(shutil.which("curl") is None, reason="curl is not installed")
def test_the_curl_line_prints_the_answer_that_is_shown(server):
    line = at(block("sh"), server.url)
    answer = json.loads(subprocess.run(line, shell=True, cwd=ROOT, check=True, capture_output=True).stdout)
    assert contains(answer, json.loads(block("json")))


def test_the_table_lists_every_endpoint():
    table = "".join(re.findall(r"^\| `.*?\|", README, re.MULTILINE))
    paths = json.loads((ROOT / "docs" / "openapi.json").read_text())["paths"]
    listed = set(re.findall(r"(/[a-z0-9/.{}-]*)`", table))
    documented = {path for path in paths if not path.startswith("/v1/certified/")}
    assert listed == documented | {"/v1/certified/..."}


def test_every_linked_file_exists():
    for target in re.findall(r"\]\(([^)#]+)\)", README):
        assert (ROOT / target).exists(), target
