"""Proves the Dockerfile without a Docker engine: its steps run in a clean Debian, and the result as it is meant to run.

Run as root, where debootstrap is installed: python -m tests.image.clean_root

The base image is stood in for by Debian's own Python 3.11. Everything else is read from the Dockerfile: variables,
steps, what is copied, the user, the command and the health check. The result runs as that user, without capabilities,
on a root that cannot be written.
"""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import urllib.request
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

from tests.image.dockerfile import Stage, assignments, stages

ROOT = Path(__file__).resolve().parents[2]
PORT = 8000
PATH = "/usr/local/bin:/usr/local/sbin:/usr/bin:/usr/sbin:/bin:/sbin"
CERTIFICATES = Path("/etc/ssl/certs/ca-certificates.crt")


def main() -> None:
    """Build, run, look, stop."""
    if "--apart" not in sys.argv:
        # In a namespace of its own, so that no mount outlives this process.
        apart = ["unshare", "--mount", "--", sys.executable, "-m", "tests.image.clean_root", "--apart"]
        sys.exit(subprocess.run(apart, check=False, cwd=ROOT).returncode)
    with tempfile.TemporaryDirectory(prefix="polhode-image-") as folder:
        base = _base(Path(folder))
        built: dict[str, Path] = {}
        final = None
        for final in stages((ROOT / "Dockerfile").read_text(encoding="utf-8")):
            assert final.image.startswith("python:3.11-slim-bookworm"), final.image
            root = Path(folder) / f"stage-{final.name}"
            subprocess.run(["cp", "-a", base, root], check=True)
            environment = _build(final, root, built)
            built[final.name] = root
        assert final is not None
        _tell(f"built: {_size(root) - _size(base)} MB above the base")
        _run(final, root, environment)


def _base(folder: Path) -> Path:
    """Return a root with Python 3.11 and nothing else."""
    base = folder / "base"
    subprocess.run(["debootstrap", "--variant=minbase", "bookworm", base], check=True, stdout=subprocess.DEVNULL)
    shutil.copy("/etc/resolv.conf", base / "etc/resolv.conf")
    packages = "apt-get -qq update && apt-get -qq install -y --no-install-recommends python3.11 python3.11-venv"
    with _mounted(base):
        _chroot(base, ["sh", "-c", packages], {"PATH": PATH, "DEBIAN_FRONTEND": "noninteractive"})
    (base / "usr/local/bin/python").symlink_to("/usr/bin/python3.11")
    _tell("base made")
    return base


def _build(stage: Stage, root: Path, built: Mapping[str, Path]) -> dict[str, str]:
    """Run the steps of a stage; return the variables that it leaves."""
    environment, directory = {"PATH": PATH}, "/"
    for instruction, argument in stage.steps:
        if instruction == "ENV":
            environment |= assignments(argument, environment)
        elif instruction == "WORKDIR":
            directory = argument
            (root / directory.lstrip("/")).mkdir(parents=True, exist_ok=True)
        elif instruction == "COPY":
            _copy(argument, root, directory, built)
        elif instruction == "RUN":
            since = time.monotonic()
            settings, mirrors = _pip()
            with _mounted(root, mirrors):
                _chroot(root, ["sh", "-c", f"cd {directory} && {argument}"], environment | settings)
            _tell(f"{stage.name}: RUN {argument[:60]}... {time.monotonic() - since:.0f} s")
        else:
            assert instruction in {"USER", "EXPOSE", "STOPSIGNAL", "HEALTHCHECK", "ENTRYPOINT"}, instruction
    return environment


def _copy(argument: str, root: Path, directory: str, built: Mapping[str, Path]) -> None:
    *sources, target = argument.split()
    origin = ROOT
    if sources[0].startswith("--from="):
        origin = built[sources.pop(0).removeprefix("--from=")]
    else:
        allowed = (ROOT / ".dockerignore").read_text(encoding="utf-8").split()
        assert all(f"!{source}" in allowed for source in sources), sources
    for source in sources:
        found = origin / source.lstrip("/")
        place = root / directory.lstrip("/") / target if not target.startswith("/") else root / target.lstrip("/")
        if found.is_dir():
            ignored = shutil.ignore_patterns("__pycache__") if origin == ROOT else None
            shutil.copytree(found, place, symlinks=True, ignore=ignored, dirs_exist_ok=True)
        else:
            shutil.copy(found, place / found.name if place.is_dir() else place)


def _run(stage: Stage, root: Path, environment: Mapping[str, str]) -> None:
    """Run the image as the Dockerfile's head says, look at it from outside and inside, and stop it."""
    user, directory = stage.last("USER"), stage.last("WORKDIR")
    subprocess.run(["mount", "--bind", root, root], check=True)
    for place in ("tmp", "dev/shm"):
        (root / place).mkdir(exist_ok=True)
        subprocess.run(["mount", "-t", "tmpfs", "-o", "mode=1777,size=512m", "none", root / place], check=True)
    for device in ("null", "urandom", "zero"):
        (root / "dev" / device).touch()
        subprocess.run(["mount", "--bind", f"/dev/{device}", root / "dev" / device], check=True)
    subprocess.run(["mount", "-o", "remount,ro,bind", root], check=True)
    bound = f"setpriv --reuid {user} --regid {user} --clear-groups --no-new-privs --bounding-set=-all --inh-caps=-all"

    def inside(command: Sequence[str]) -> list[str]:
        return ["chroot", str(root), *bound.split(), "sh", "-c", f'cd {directory} && exec "$@"', "-", *command]

    mounting = f'mount -t proc none {root}/proc && exec "$@"'
    started = time.monotonic()
    service = subprocess.Popen(
        ["unshare", "--pid", "--fork", "--kill-child", "sh", "-c", mounting, "-", *inside(stage.entrypoint())],
        env=dict(environment),
    )
    try:
        check = inside(stage.health_check())
        while subprocess.run(check, env=dict(environment), check=False, stderr=subprocess.DEVNULL).returncode:
            assert service.poll() is None, "the service stopped"
            assert time.monotonic() - started < 120, "the health check never passed"
            time.sleep(0.5)
        _tell(f"healthy {time.monotonic() - started:.1f} s after its start")
        first = _child(service.pid)
        status = Path(f"/proc/{first}/status").read_text(encoding="utf-8")
        assert f"Uid:\t{user}\t{user}\t{user}\t{user}" in status
        assert "CapEff:\t0000000000000000" in status
        for place in ("/polhode/x", "/x", "/polhode/compiled/x"):
            assert subprocess.run(inside(["touch", place]), check=False, stderr=subprocess.DEVNULL).returncode, place
        compiled = sorted((root / "tmp/compiled").rglob("*"))
        since = time.monotonic()
        answer = _ask()
        _tell(f"T-handle answered after {1e3 * (time.monotonic() - since):.0f} ms, error {answer['accuracy']['error']}")
        assert sorted((root / "tmp/compiled").rglob("*")) == compiled, "something was compiled after the start"
        os.kill(first, getattr(signal, stage.last("STOPSIGNAL")))
        since = time.monotonic()
        assert service.wait(timeout=30) == 0
        _tell(f"stopped after {time.monotonic() - since:.1f} s, exit code 0")
    finally:
        service.kill()
        service.wait()
        subprocess.run(["umount", "--recursive", "--lazy", root], check=True)


def _ask() -> dict[str, dict[str, float]]:
    url = f"http://127.0.0.1:{PORT}/v1/rotation/trajectory"
    question = (ROOT / "examples" / "t-handle.json").read_bytes()
    request = urllib.request.Request(url, question, {"Content-Type": "application/json"})
    with urllib.request.urlopen(request, timeout=30) as response:
        answer: dict[str, dict[str, float]] = json.load(response)
    return answer


def _child(parent: int) -> int:
    """Return the only child of a process."""
    return int(Path(f"/proc/{parent}/task/{parent}/children").read_text(encoding="utf-8").split()[0])


def _pip() -> tuple[dict[str, str], list[Path]]:
    """Return this machine's settings of pip as variables, and the folders that they name."""
    listed = subprocess.run([sys.executable, "-m", "pip", "config", "list"], check=True, capture_output=True, text=True)
    settings: dict[str, str] = {}
    for line in listed.stdout.splitlines():
        name, value = line.split("=", 1)
        settings[f"PIP_{name.split('.')[-1].upper().replace('-', '_')}"] = value.strip("'\"")
    words = [*" ".join(settings.values()).replace("file://", "").split(), str(CERTIFICATES)]
    # A folder that is an index by its last name names its files by their places beside it.
    folders = [Path(word).parent if word.endswith("/simple") else Path(word) for word in words if word.startswith("/")]
    return settings, [folder for folder in dict.fromkeys(folders) if folder.exists()]


@contextmanager
def _mounted(root: Path, also: Sequence[Path] = ()) -> Iterator[None]:
    """Show a root /proc, the null device, and files of this machine that its packages come from."""
    mounted = []
    for source in [Path("/dev/null"), Path("/dev/urandom"), *also]:
        place = root / str(source).lstrip("/")
        place.parent.mkdir(parents=True, exist_ok=True)
        if source.is_dir():
            place.mkdir(exist_ok=True)
        else:
            place.touch()
        subprocess.run(["mount", "--bind", source, place], check=True)
        mounted.append(place)
    subprocess.run(["mount", "-t", "proc", "none", root / "proc"], check=True)
    mounted.append(root / "proc")
    try:
        yield
    finally:
        for place in reversed(mounted):
            subprocess.run(["umount", "--lazy", place], check=True)


def _chroot(root: Path, command: Sequence[str], environment: Mapping[str, str]) -> None:
    quiet = subprocess.run(
        ["chroot", root, *command], env=dict(environment), check=False, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
    )
    if quiet.returncode:
        sys.stdout.buffer.write(quiet.stdout[-4000:])
        raise SystemExit(f"failed: {' '.join(command)}")


def _size(root: Path) -> int:
    """Return the size of a tree in megabytes."""
    counted = subprocess.run(["du", "-sxm", root], check=True, capture_output=True, text=True)
    return int(counted.stdout.split()[0])


def _tell(line: str) -> None:
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    main()
