"""The table of attacks in docs/deployment.md and the command that repeats them name the same tests."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]


def test_the_table_is_what_the_command_runs() -> None:
    makefile = (ROOT / "Makefile").read_text()
    section = makefile.split("ATTACKS :=")[1].split("\n\n")[0]
    run = re.findall(r"tests/\S+\.py", section)
    table = (ROOT / "docs" / "deployment.md").read_text().split("## What was attacked")[1]
    named = re.findall(r"`(tests/[^`]+)`", table)
    assert named
    assert sorted(run) == sorted(named)
    assert all((ROOT / file).is_file() for file in named)
