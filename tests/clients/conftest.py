"""A running service, and answer keys that need none."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.examples.conftest import service

__all__ = ["bundle", "service"]

ROOT = Path(__file__).parents[2]
QUESTIONS = ("1f", "1g", "problem-1")


@pytest.fixture(scope="session")
def bundle(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Answer keys of some questions and the code that grades, as a folder; beside it the same as bundle.zip."""
    folder: Path = tmp_path_factory.mktemp("platforms")
    files = [str(ROOT / "examples" / "assessments" / f"{name}.json") for name in QUESTIONS]
    command = [sys.executable, "-m", "clients.offline", *files, "--output", str(folder / "bundle.zip")]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False, timeout=250)
    assert done.returncode == 0, done.stderr
    shutil.unpack_archive(folder / "bundle.zip", folder / "bundle")
    return folder / "bundle"
