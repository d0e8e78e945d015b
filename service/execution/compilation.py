"""Compiles every kernel in processes that end: python -m service.execution.compilation.

The compiler takes more than a gigabyte, which the system gets back only from a process that ends. The processes of the
service then load the compiled code. A file beside it records that the code of these sources is complete.
"""

from __future__ import annotations

import hashlib
import subprocess
import sys
from collections.abc import Iterable
from contextlib import ExitStack
from importlib import import_module
from pathlib import Path

from core.compiled import code_directory, compiler
from service.observability.logs import LOG, configure
from service.settings import Settings

PACKAGES = ("core", "examples", "service")
"""Packages whose sources define the kernels and the questions that reach them."""

FIRST = {
    "rotation": ("core.elliptic.functions", "core.rotation.torque_free"),
    "scenes": ("core.multibody.motion.generic_equation",),
}
"""By the name of a process, the modules with which it begins. Both compile about half and load the other half."""


def ensure_compiled() -> None:
    """Compile what is not yet compiled; where that is impossible, the processes of the service compile for themselves.

    Notes
    -----
    The record of an earlier compilation is named by a digest of the sources, of the versions of the compiler and of the
    processor, so that a copy of the directory is complete as well.
    """
    root = Path(__file__).parents[2]
    record = code_directory() / f"complete-{sources_digest(root / package for package in PACKAGES)}"
    if record.exists():
        LOG.info("loading kernels")
        return
    LOG.info("compiling kernels: two to four minutes, once")
    if not run_together([sys.executable, "-m", __spec__.name, name] for name in FIRST):
        LOG.warning("a process that compiles kernels has failed")
        return
    try:
        record.parent.mkdir(parents=True, exist_ok=True)
        record.touch()
    except OSError as fault:
        LOG.warning("that kernels are compiled cannot be recorded: %s", fault)


def sources_digest(folders: Iterable[Path]) -> str:
    """Return a digest of the Python sources below some folders, of the compiler and of the processor."""
    digest = hashlib.sha256(compiler().encode())
    for folder in folders:
        for file in sorted(folder.rglob("*.py")):
            digest.update(f"\n{file.relative_to(folder.parent)}\n".encode())
            digest.update(file.read_bytes())
    return digest.hexdigest()[:20]


def run_together(commands: Iterable[list[str]]) -> bool:
    """Run commands at the same time; return whether all succeeded. None outlives this call, however it ends."""
    with ExitStack() as stack:
        processes = []
        for command in commands:
            process = stack.enter_context(subprocess.Popen(command, stdin=subprocess.DEVNULL))
            stack.callback(process.kill)
            processes.append(process)
        return all([process.wait() == 0 for process in processes])


def compile_kernels(name: str) -> None:
    """Import everything and answer every example in this process, beginning as `FIRST` says.

    What answers members of studies together is two large kernels, which the process that begins with the rotation
    compiles while the other compiles those of scenes.
    """
    for module in FIRST[name]:
        import_module(module)
    from service.execution.worker import new_handler, terms_of
    from service.routing import TABLE

    handler = new_handler(terms_of(Settings(), TABLE))
    if name == "rotation":
        handler.warm_many()
    handler.warm(scenes_first=name == "scenes")
    handler.warm_many()


if __name__ == "__main__":
    if len(sys.argv) > 1:
        compile_kernels(sys.argv[1])
    else:
        configure(Settings().log_level)
        ensure_compiled()
