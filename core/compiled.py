"""Compilation with numba, and three machine instructions that numba does not provide.

Compiled code is cached on disk, so only the first process after an installation compiles. Numba's cache depends on the
path and the content of the file of a function: it would compile again in a copy of the directory, and return outdated
code if an inlined function of another file changed. Here every function is cached under a digest of what it is compiled
from: its own byte code, the constants that it uses, and the functions that it calls. Floating-point semantics are
strict (no reassociation, no contraction), because the error bounds rely on them.
"""

from __future__ import annotations

import hashlib
import os
import pickle
import sys
import warnings
from collections.abc import Callable
from contextlib import suppress
from functools import cache, partial, wraps
from pathlib import Path
from types import CodeType, ModuleType
from typing import Any, TypeVar, cast

import llvmlite.binding
import numba
import numpy as np
from llvmlite import ir
from numba import types
from numba.core import caching, serialize
from numba.core.registry import cpu_target
from numba.extending import intrinsic

from core.lanes import LANES, fused

F = TypeVar("F", bound=Callable[..., Any])


def _choose_directory() -> None:
    """Set the cache directory: in NUMBA_CACHE_DIR or beside this file.

    If that is not writable, numba's own choice, a directory of the user, remains.
    """
    config: Any = numba.config
    base = Path(config.CACHE_DIR or Path(__file__).parent / "__pycache__")
    if os.access(base if base.exists() else base.parent, os.W_OK):
        config.CACHE_DIR = str(base / "compiled")


_choose_directory()


def code_directory() -> Path:
    """Return the directory of compiled code; where it is not writable, numba keeps code in one of the user."""
    config: Any = numba.config
    return Path(config.CACHE_DIR or Path(__file__).parent / "__pycache__" / "compiled")


def compiler() -> str:
    """Return the versions of the compiler and the processor for which it compiles."""
    target: Any = cpu_target
    versions = [f"{module.__name__} {module.__version__}" for module in (numba, llvmlite, np)]
    return f"{sys.version} {versions} {target.target_context.codegen().magic_tuple()}"


@cache
def _extensions() -> bytes:
    """Return the source of what extends numba, which every function may use."""
    return b"".join(Path(__file__).with_name(name).read_bytes() for name in ("compiled.py", "lanes.py"))


class _Sources:
    """What a compiled function consists of, as text that is the same wherever and whenever it is read."""

    def __init__(self) -> None:
        self.parts: list[str] = []
        self.known: list[Any] = []

    def add(self, name: str, value: Any) -> None:
        """Add what a name stands for in compiled code."""
        self.parts.append(name)
        if hasattr(value, "py_func"):
            self.add_function(value.py_func)
        elif isinstance(value, type):
            # Of the classes, compiled code knows named tuples.
            self.parts.append(f"{value.__qualname__} {getattr(value, '_fields', '')} {value.__annotations__}")
        elif isinstance(value, np.ndarray):
            self.parts.append(f"{value.dtype} {value.shape} {value.tobytes().hex()}")
        elif type(value) in (ModuleType, type(_fma)):
            # Of this version of their package, or of the extensions.
            self.parts.append(value.__name__)
        elif isinstance(value, (bool, int, float, str, tuple, type(None))):
            self.parts.append(repr(value))
        else:
            raise TypeError(f"compiled code may not depend on {name}, a {type(value).__name__}")

    def add_function(self, function: Any) -> None:
        """Add a function, and what it refers to."""
        if function in self.known:
            self.parts.append(f"function {self.known.index(function)}")
            return
        self.known.append(function)
        self._add_code(function.__code__, function.__globals__)
        for name, cell in zip(function.__code__.co_freevars, function.__closure__ or (), strict=True):
            self.add(name, cell.cell_contents)

    def _add_code(self, code: CodeType, names: dict[str, Any]) -> None:
        self.parts.append(f"{code.co_code.hex()} {code.co_names} {code.co_varnames}")
        for constant in code.co_consts:
            if isinstance(constant, CodeType):
                self._add_code(constant, names)
            else:
                self.parts.append(repr(constant))
        for name in code.co_names:
            if name in names:
                self.add(name, names[name])

    def digest(self) -> str:
        """Return a digest of all of it, and of the extensions."""
        return hashlib.sha256("\n".join(self.parts).encode() + _extensions()).hexdigest()[:20]


def _digest(function: Any, signature: Any) -> str:
    """Return a digest of what a function is compiled from, for arguments that may be compiled functions themselves."""
    sources = _Sources()
    sources.add_function(function)
    # The types of a call come as a tuple. A declared signature, of another type, has no functions among its arguments.
    for kind in signature if isinstance(signature, tuple) else ():
        if isinstance(kind, types.Dispatcher):
            sources.add("argument", kind.dispatcher)
    return sources.digest()


class CacheUnusable(RuntimeWarning):
    """Compiled code could not be cached, or the cache is damaged; the code is compiled again."""


# Numba's packages have no type annotations.
_CodeCache: Any = caching.CompileResultCacheImpl
_FunctionCache: Any = caching.FunctionCache
_IndexFile: Any = caching.IndexDataCacheFile
_Locator: Any = caching.UserProvidedCacheLocator
_dumps: Any = serialize.dumps


class _OneDirectory(_Locator):  # type: ignore[misc]
    """All functions are cached in one directory, as their digests tell them apart."""

    @classmethod
    def get_suitable_cache_subpath(cls, py_file: str) -> str:
        return ""


class _CheckedCode(_CodeCache):  # type: ignore[misc]
    """Compiled code with a digest of its bytes, because damaged machine code might run and give wrong results."""

    _locator_classes = (_OneDirectory, caching.InTreeCacheLocator, caching.UserWideCacheLocator)

    def reduce(self, cres: Any) -> tuple[bytes, bytes]:
        code: bytes = _dumps(super().reduce(cres))
        return hashlib.sha256(code).digest(), code

    def rebuild(self, target_context: Any, payload: tuple[bytes, bytes]) -> Any:
        digest, code = payload
        if hashlib.sha256(code).digest() != digest:
            raise ValueError("does not have the bytes that were written")
        loaded = super().rebuild(target_context, pickle.loads(code))
        _release_module(loaded.library)
        return loaded


def _release_module(library: Any) -> None:
    """Keep as bytes what other functions may inline of a loaded one.

    Numba keeps it as LLVM's objects, which take ten times as much, for every loaded function: 60 MB that next to no
    process needs, as what is loaded calls machine code.
    """
    bitcode = library._get_module_for_linking().as_bitcode()
    library._shared_module.close()
    library._shared_module = None
    library._get_module_for_linking = partial(llvmlite.binding.parse_bitcode, bitcode)


class _CheckedCache(_FunctionCache):  # type: ignore[misc]
    """Numba's cache of one function, by content; an error in it only causes a new compilation."""

    _impl_class = _CheckedCode

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        name = f"{self._py_func.__module__}.{self._py_func.__name__}-{_digest(self._py_func, sig)}"
        # The name says what the file contains: it needs no date of a source.
        self._cache_file = _IndexFile(self.cache_path, name, None)
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

    def _index_key(self, sig: Any, codegen: Any) -> tuple[Any, ...]:
        return sig, codegen.magic_tuple()

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
