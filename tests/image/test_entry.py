"""The entry point of the image runs the service or a command; the commands of the compose file exist."""

from __future__ import annotations

import os
import subprocess
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest
import yaml

from tests.image.clean_root import ROOT
from tests.image.dockerfile import assignments, stages

COMPOSE: Any = yaml.safe_load((ROOT / "docker/compose.yaml").read_text())["services"]
SAYS = '#!/bin/sh\nfor word in "$(basename "$0")" "$@"; do echo "$word"; done\n'


def run(folder: Path, *words: str) -> list[str]:
    """Return what is run in the end, with programs in place of python and dask that say how they are called."""
    for name in ("python", "dask"):
        (folder / name).write_text(SAYS)
        (folder / name).chmod(0o755)
    (folder / "compiled").mkdir()
    (folder / "compiled" / "kernel").write_text("")
    variables = {"COMPILED": str(folder / "compiled"), "NUMBA_CACHE_DIR": str(folder / "cache")}
    variables["PATH"] = f"{folder}:{os.environ['PATH']}"
    command = ["sh", str(ROOT / "docker/entry.sh"), *words]
    done = subprocess.run(command, env=variables, capture_output=True, text=True, check=True)
    assert [file.name for file in (folder / "cache").iterdir()] == ["kernel"]
    return done.stdout.splitlines()


@pytest.mark.parametrize("options", [[], ["--port", "9000"], ["--workers", "2"]])
def test_options_are_those_of_the_service(tmp_path: Path, options: list[str]) -> None:
    assert run(tmp_path, *options) == ["python", "-m", "service", *options]


@pytest.mark.parametrize("name", COMPOSE)
def test_commands_of_the_compose_file_are_run_as_they_are(tmp_path: Path, name: str) -> None:
    command = COMPOSE[name].get("command", [])
    found = run(tmp_path, *command)
    assert found == (command or ["python", "-m", "service"])
    if command:
        program = import_module(f"distributed.cli.dask_{command[1]}").main
        known = {option for parameter in program.params for option in (*parameter.opts, *parameter.secondary_opts)}
        assert {word for word in command if word.startswith("--")} <= known


def test_every_command_of_the_image_imports_the_service() -> None:
    """The program dask has its own folder on its path, not the one that it is run in."""
    final = stages((ROOT / "Dockerfile").read_text())[-1]
    assert assignments(final.last("ENV"), {"PATH": ""})["PYTHONPATH"] == final.last("WORKDIR")


def test_volumes_are_mounted_where_the_user_of_the_image_may_write() -> None:
    final = stages((ROOT / "Dockerfile").read_text())[-1]
    made = next(argument for instruction, argument in final.steps if instruction == "RUN")
    for entry in COMPOSE.values():
        for volume in entry.get("volumes", ()):
            folder = volume.partition(":")[2]
            assert f"chown {final.last('USER')} {folder}" in made
            assert assignments(final.last("ENV"), {"PATH": ""})["POLHODE_DATA"] == folder
