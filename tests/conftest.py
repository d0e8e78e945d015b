"""What holds for every test: property tests draw the same examples in every run, and nothing works on studies.

What is imported and collected stays until the end: the collector of garbage need not walk through it again and again,
which would take a tenth of the time.

Data go to a temporary folder. The lock on its studies is held here, so that services in tests start no process
for them.
"""

import contextlib
import fcntl
import gc
import os
import tempfile
from collections.abc import Generator
from pathlib import Path

import generate
import pytest
from hypothesis import settings

from tests.drawn import draws

settings.register_profile("fixed", derandomize=True, deadline=None, max_examples=draws(100))
settings.load_profile("fixed")

# The client's modules that are made when it is built.
generate.write()

# Before any settings of the service are read.
FOLDER = Path(os.environ.setdefault("POLHODE_DATA", tempfile.mkdtemp(prefix="polhode-tests-")))
LOCK = os.open(FOLDER / "studies.lock", os.O_RDWR | os.O_CREAT)
with contextlib.suppress(BlockingIOError):
    # Unless another process of these tests has it.
    fcntl.flock(LOCK, fcntl.LOCK_EX | fcntl.LOCK_NB)


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.enable()
