"""Results of stretches of members as files: numpy archives, written whole or not at all, in a folder or elsewhere."""

from __future__ import annotations

import io
import json
import os
import zipfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any, NamedTuple

import numpy as np

from service.responses import npz as archive

ARRAYS = ("inputs", "figures", "failures", "warnings")


class CorruptedChunk(Exception):
    """A file of results is missing or damaged."""


class Chunk(NamedTuple):
    """The results of a stretch of members; see `service.routes.studies.members.Block`."""

    start: int
    inputs: np.ndarray[Any, Any]
    figures: np.ndarray[Any, Any]
    failures: np.ndarray[Any, Any]
    warnings: np.ndarray[Any, Any]
    failure_names: tuple[str, ...]
    warning_names: tuple[str, ...]
    answer: bytes = b""

    @property
    def stop(self) -> int:
        """Number of the member behind the last."""
        return self.start + len(self.figures)


def packed(document: Mapping[str, Any]) -> bytes:
    """Return a block's document as the bytes of its file; equal blocks give equal bytes."""
    return b"".join(archive.archive(dict(document)))


def unpacked(data: bytes) -> Chunk:
    """Return the results in the bytes of a file.

    Raises
    ------
    CorruptedChunk
        If they are not those of a file as it was written; every member of the archive has a check sum.
    """
    try:
        with np.load(io.BytesIO(data), allow_pickle=False) as file:
            rest: dict[str, Any] = json.loads(file[archive.METADATA] if archive.METADATA in file.files else b"")
            inputs, figures, failures, warnings = (file[name] for name in ARRAYS)
            names = tuple(rest["failure_names"]), tuple(rest["warning_names"])
            answer = file["answer"].tobytes() if "answer" in file.files else b""
            return Chunk(rest["start"], inputs, figures, failures, warnings, *names, answer)
    except (OSError, ValueError, KeyError, TypeError, EOFError, zipfile.BadZipFile) as fault:
        raise CorruptedChunk(str(fault)) from None


class ChunkFiles:
    """The files below a URL of fsspec, or a path.

    Raises
    ------
    OSError
        By every method, where the storage cannot be used; its libraries have errors of their own.
    """

    def __init__(self, url: str) -> None:
        from fsspec.core import url_to_fs
        from fsspec.implementations.local import LocalFileSystem

        with _storage_errors():
            self._files, self._root = url_to_fs(url)
        # Object stores write whole objects and know no folders.
        self._in_folder = isinstance(self._files, LocalFileSystem)

    def write(self, study: str, start: int, stop: int, data: bytes) -> None:
        """Write a file; it is there as a whole or not at all."""
        path = self._path(study, start, stop)
        if not self._in_folder:
            with _storage_errors():
                self._files.pipe_file(path, data)
            return
        folder = self._folder(study)
        if not self._files.exists(folder):
            self._files.makedirs(folder, exist_ok=True)
            for made in (self._root, folder):
                # Results are for who runs the service alone, whatever the file mode creation mask.
                os.chmod(made, 0o700)
        part = path + ".part"
        try:
            self._files.pipe_file(part, data)
            self._files.mv(part, path)
        except OSError:
            if self._files.exists(part):
                self._files.rm_file(part)
            raise

    def read(self, study: str, start: int, stop: int) -> Chunk:
        """Return the results of a stretch.

        Raises
        ------
        CorruptedChunk
            If the file is missing or damaged.
        """
        try:
            with _storage_errors():
                data = self._files.cat_file(self._path(study, start, stop))
        except FileNotFoundError:
            raise CorruptedChunk("the file is missing") from None
        found = unpacked(data)
        if (found.start, found.stop) != (start, stop):
            raise CorruptedChunk("the file holds other members")
        return found

    def remove(self, study: str) -> None:
        """Remove every file of a study."""
        folder = self._folder(study)
        with _storage_errors():
            if self._files.exists(folder):
                self._files.rm(folder, recursive=True)

    def _folder(self, study: str) -> str:
        return f"{self._root}/{study}"

    def _path(self, study: str, start: int, stop: int) -> str:
        return f"{self._folder(study)}/{start}-{stop}.npz"


@contextmanager
def _storage_errors() -> Iterator[None]:
    """Raise the errors of whatever library the storage has as `OSError`."""
    try:
        yield
    except OSError:
        raise
    except Exception as fault:
        raise OSError(str(fault)) from fault
