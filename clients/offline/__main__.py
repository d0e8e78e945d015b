"""Write answer keys, and the code that grades with them, into a folder, or a zip archive of it, that needs no network.

python -m clients.offline examples/assessments/*.json --output bundle

Each file is a request to POST /v1/assessments. Its key has the figures of the answer and those that its submissions
claim, sampled ones at the times of its submissions. The folder runs with Python 3.11 or newer and numpy:

python -I bundle < request.json
"""

from __future__ import annotations

import argparse
import ast
import importlib.metadata
import json
import re
import shutil
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from core.errors import MechanicsError
from service.problems import Refusal
from service.routes import questions
from service.routes.assessments import answer_key
from service.routes.certified.answers import ROOT as CERTIFIED

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
FIRST = "core.assessment.answer_key"
UNITS = "pint"
"""The library of units, which is pure Python and goes with the folder."""
INSTALLED = ("numpy",)
"""What has to be there."""


def modules_from(module: str) -> Iterator[str]:
    """Yield the modules of core that a module imports when it is imported, itself first."""
    rest, seen = [module], {module}
    while rest:
        own = rest.pop()
        yield own
        for node in ast.parse(source_of(own).read_text(encoding="utf-8")).body:
            if isinstance(node, ast.ImportFrom) and node.module and node.module.startswith("core"):
                new = {node.module} - seen
                seen |= new
                rest.extend(new)


def source_of(module: str) -> Path:
    """Return the file of a module of core."""
    path = ROOT.joinpath(*module.split("."))
    return path / "__init__.py" if path.is_dir() else path.with_suffix(".py")


def packages_from(name: str) -> Iterator[str]:
    """Yield a package and those that it requires, numpy left out."""
    rest, seen = [name], {name, *INSTALLED}
    while rest:
        own = rest.pop()
        yield own
        for line in importlib.metadata.requires(own) or ():
            required = re.split(r"[^\w.-]", line)[0]
            if "extra ==" not in line and required not in seen:
                seen.add(required)
                rest.append(required)


def keys_of(files: list[Path]) -> dict[str, str]:
    """Return the key of each file, by its name, or end with the reason why there is none."""
    routes = questions()
    certified = [route for route in routes if route.path.startswith(CERTIFIED)]
    others = [route for route in routes if route not in certified]
    found = {}
    for file in files:
        try:
            found[file.name] = json.dumps(answer_key(others, certified, file.read_bytes()))
        except Refusal as refusal:
            sys.exit(f"{file}: {refusal.problem.detail}")
        except MechanicsError as error:
            sys.exit(f"{file}: {error.detail}")
    return found


def write(keys: dict[str, str], output: Path) -> None:
    """Write keys and code.

    Raises
    ------
    FileExistsError
        If the folder exists.
    """
    output.mkdir(parents=True)
    for module in modules_from(FIRST):
        source = source_of(module)
        folders = [folder for folder in source.parents if folder.is_relative_to(ROOT / "core")]
        for file in (source, *(folder / "__init__.py" for folder in folders)):
            copy(file, output / file.relative_to(ROOT))
    for package in packages_from(UNITS):
        for part in importlib.metadata.files(package) or ():
            if ".." not in part.parts and part.suffix != ".pyc":
                copy(Path(str(part.locate())), output / part)
    copy(HERE / "grade.py", output / "__main__.py")
    (output / "keys").mkdir()
    for name, key in keys.items():
        (output / "keys" / name).write_text(key, encoding="utf-8")


def copy(source: Path, target: Path) -> None:
    """Copy a file into folders that are made."""
    target.parent.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(source, target)


def main() -> None:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", type=Path, metavar="file.json")
    parser.add_argument("--output", type=Path, required=True, help="a folder that does not exist, or a file .zip")
    options = parser.parse_args()
    keys = keys_of(options.files)
    if options.output.suffix != ".zip":
        write(keys, options.output)
        return
    with tempfile.TemporaryDirectory() as folder:
        write(keys, Path(folder) / "bundle")
        shutil.make_archive(str(options.output.with_suffix("")), "zip", Path(folder) / "bundle")


if __name__ == "__main__":
    main()
