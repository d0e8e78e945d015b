"""Compilation with numba, and three machine instructions that numba does not provide.

Compiled code is cached on disk, so only the first process after an installation compiles. Numba's cache depends only on
the file of a function, and would return outdated code if an inlined function of another file changed. The cache
directory is therefore named by a digest of all files that contain compiled functions or constants used in them.
Floating-point semantics are strict (no reassociation, no contraction), because the error bounds rely on them.
"""

from __future__ import annotations

import hashlib
import os
import pickle
import re
import warnings
from collections.abc import Callable
from contextlib import suppress
from functools import cache, wraps
from pathlib import Path
from typing import Any, TypeVar, cast

import numba
from llvmlite import ir
from numba import types
from numba.core import caching, serialize
from numba.extending import intrinsic

from core.lanes import LANES, fused

F = TypeVar("F", bound=Callable[..., Any])


_IMPORTED = re.compile(rb"^from core\.([\w.]+) import", re.MULTILINE)


def _digest() -> str:
    """Return a digest of every source file with compiled functions, and of those that provide constants to them."""
    found, core = hashlib.sha256(numba.__version__.encode()), Path(__file__).parent
    texts = {path: path.read_bytes() for path in core.rglob("*.py")}
    compiling = {path for path, text in texts.items() if b"core.compiled" in text or path.name == "compiled.py"}
    imported = {name.decode().replace(".", "/") for path in compiling for name in _IMPORTED.findall(texts[path])}
    taken_from = {core / f"{name}.py" for name in imported} & set(texts)
    for path in sorted(compiling | taken_from):
        found.update(texts[path])
    return found.hexdigest()[:16]


def _keep_by_content() -> None:
    """Set the cache directory: named by the digest, in NUMBA_CACHE_DIR or beside this file.

    If that is not writable, numba's own choice, a directory of the user, remains.
    """
    config: Any = numba.config
    base = Path(config.CACHE_DIR or Path(__file__).parent / "__pycache__")
    if os.access(base if base.exists() else base.parent, os.W_OK):
        config.CACHE_DIR = str(base / f"compiled-{_digest()}")


_keep_by_content()


def has_compiled_code() -> bool:
    """Return whether an earlier process has kept compiled code, so that this one need not compile."""
    config: Any = numba.config
    directory = str(config.CACHE_DIR)
    return bool(directory) and any(Path(directory).rglob("*.nbc"))


class CacheUnusable(RuntimeWarning):
    """Compiled code could not be cached, or the cache is damaged; the code is compiled again."""


# Numba's packages have no type annotations.
_CodeCache: Any = caching.CompileResultCacheImpl
_FunctionCache: Any = caching.FunctionCache
_dumps: Any = serialize.dumps


class _CheckedCode(_CodeCache):  # type: ignore[misc]
    """Compiled code with a digest of its bytes, because damaged machine code might run and give wrong results."""

    def reduce(self, cres: Any) -> tuple[bytes, bytes]:
        code: bytes = _dumps(super().reduce(cres))
        return hashlib.sha256(code).digest(), code

    def rebuild(self, target_context: Any, payload: tuple[bytes, bytes]) -> Any:
        digest, code = payload
        if hashlib.sha256(code).digest() != digest:
            raise ValueError("does not have the bytes that were written")
        return super().rebuild(target_context, pickle.loads(code))


class _CheckedCache(_FunctionCache):  # type: ignore[misc]
    """Numba's cache of one function; an error in it only causes a new compilation."""

    _impl_class = _CheckedCode

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        try:
            return super().load_overload(sig, target_context)
        # Reading a damaged file may raise anything.
        except Exception as fault:
            self._unusable(fault)
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        try:
            super().save_overload(sig, data)
        except Exception as fault:
            self._unusable(fault)

    def _unusable(self, fault: Exception) -> None:
        # One place in the code, so that many errors give one warning.
        warnings.warn(f"compiled code in {self.cache_path} is not used: {fault!r}", CacheUnusable, stacklevel=1)
        with suppress(Exception):
            self.flush()


def kernel(*signatures: object, **options: object) -> Callable[[F], F]:
    """Compile a function to machine code, on import if signatures are given, otherwise at the first call.

    Inside of it arrays are copied entry by entry. For an assignment to a slice, numba compiles the text of its error
    message, in every process anew: two seconds.
    """

    def compile_it(function: F) -> F:
        compiler: Any = numba.njit
        dispatcher: Any = compiler(**{"error_model": "numpy", **options})(function)
        try:
            dispatcher._cache = _CheckedCache(function)
        except RuntimeError as fault:
            # No directory is writable: neither this one nor one of the user.
            warnings.warn(f"compiled code cannot be kept: {fault}", CacheUnusable, stacklevel=1)
        if signatures:
            for signature in signatures:
                dispatcher.compile(signature)
            dispatcher.disable_compile()
        return cast(F, dispatcher)

    return compile_it


def entry(*signatures: object) -> Callable[[F], F]:
    """Compile a function, which only Python code calls, for arguments of given types, at its first call.

    Without signatures it would be compiled for each function or layout of an array that it is given.
    """

    def compile_it(function: F) -> F:
        @cache
        def compiled() -> F:
            return kernel(*signatures)(function)

        @wraps(function)
        def call(*arguments: Any) -> Any:
            return compiled()(*arguments)

        return cast(F, call)

    return compile_it


@intrinsic
def _fma(typing_context: Any, a: Any, b: Any, c: Any) -> Any:
    kind = LANES if a == LANES else types.float64

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return fused(builder, arguments) if kind is LANES else builder.fma(*arguments)

    return kind(kind, kind, kind), generate


@intrinsic
def _double_from_bits(typing_context: Any, pattern: Any) -> Any:
    signature = types.float64(types.int64)

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.bitcast(arguments[0], ir.DoubleType())

    return signature, generate


@intrinsic
def _bits_of(typing_context: Any, number: Any) -> Any:
    signature = types.int64(types.float64)

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.bitcast(arguments[0], ir.IntType(64))

    return signature, generate


fma = cast(Callable[[float, float, float], float], _fma)
"""a*b + c rounded once, in compiled code; of doubles or of `core.lanes`."""

bits_of = cast(Callable[[float], int], _bits_of)
"""The 64-bit integer that has the bit pattern of a double, in compiled code."""

double_from_bits = cast(Callable[[int], float], _double_from_bits)
"""The double whose bit pattern is the given 64-bit integer, in compiled code."""
