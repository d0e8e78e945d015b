"""Memory that a process has freed and its allocator keeps."""

from __future__ import annotations

import ctypes


def give_back() -> None:
    """Give the system what the allocator keeps for later, where it can be told to (malloc_trim(3) of glibc).

    What loading kernels and answering every example leaves behind is 10 MB in each process.
    """
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
    if trim is not None:
        trim(0)
