"""Memory of this process that it does not need now: what its allocator keeps, and machine code that has been run."""

from __future__ import annotations

import ctypes
import re
from contextlib import suppress
from pathlib import Path

CODE = re.compile(r"^([0-9a-f]+)-([0-9a-f]+) r-xp \S+ \S+ \S+ +/\S*\.so(?:\.[0-9.]+)?$", re.MULTILINE)
"""The code of a shared library in the list of what a process has mapped (proc_pid_maps(5))."""

MADV_DONTNEED = 4
"""Of madvise(2)."""


def give_back() -> None:
    """Give the system what the allocator keeps for later, and the pages of code, as far as it can be told to.

    What loading kernels and answering every example leaves behind with the allocator (malloc_trim(3) of glibc) is 10 MB
    in each process. The compiler's code, of which loading kernels runs the half, is 50 MB. Code is never written to:
    what is run again is mapped again, from the file that the system has in memory.
    """
    system = ctypes.CDLL(None)
    trim = getattr(system, "malloc_trim", None)
    if trim is not None:
        trim(0)
    with suppress(OSError):
        for first, end in CODE.findall(Path("/proc/self/maps").read_text()):
            start = int(first, 16)
            system.madvise(ctypes.c_void_p(start), ctypes.c_size_t(int(end, 16) - start), MADV_DONTNEED)
