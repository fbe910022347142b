"""The archive that a project is: its members, never more of them than is read of a file of its size."""

from __future__ import annotations

import io
import os
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from core.document.document_limits import too_large
from core.errors import ProjectError, reason_of
from core.files.regular_file import open_regular
from core.messages import Message

HEADROOM = 64_000_000
"""So many bytes more than ``_RATIO`` times what it takes in its file may a member hold."""

_RATIO = 10
"""No scan packs better; a file made to fill the memory packs a hundred times better."""

_AT_ONCE = 1 << 20
_BROKEN = (zipfile.BadZipFile, zlib.error, EOFError, RuntimeError, ValueError)
_HINT = Message("Open a backup or start from the scan.")


class _Sparing(io.BufferedReader):
    """A file of which nobody reads much at once: a table of contents that is larger fills the memory."""

    def read(self, size: int | None = -1, /) -> bytes:
        """Return ``size`` bytes, or all the rest. Raises BadZipFile if that is too much."""
        data = super().read(_AT_ONCE + 1 if size is None or size < 0 else min(size, _AT_ONCE + 1))
        if len(data) > _AT_ONCE:
            raise zipfile.BadZipFile("too much at once")
        return data


@contextmanager
def project_archive(path: Path) -> Iterator[zipfile.ZipFile]:
    """Open the archive of a project for reading. Raises ProjectError, also if reading fails meanwhile."""
    try:
        with _Sparing(io.FileIO(open_regular(path))) as file, zipfile.ZipFile(file) as archive:
            yield archive
    except FileNotFoundError:
        raise ProjectError(
            Message("Project {file} does not exist.", file=str(path)),
            Message("Check the name, or choose another one."),
        ) from None
    except OSError as problem:
        raise ProjectError(
            Message("{file} cannot be read: {problem}.", file=path.name, problem=reason_of(problem)),
            Message("Check the file, or open a backup."),
        ) from problem
    except _BROKEN as problem:
        raise ProjectError(
            Message("{file} is an incomplete Busk project.", file=path.name), _HINT
        ) from problem


def member_bytes(archive: zipfile.ZipFile, name: str, most: int) -> bytes:
    """Return what a member holds, ``most`` bytes at most.

    Its size is what is read, whatever the archive says. Raises ProjectError.
    """
    try:
        member = archive.getinfo(name)
    except KeyError:
        raise ProjectError(
            Message("This file is not a Busk project."), Message("Open a .busk file or a scan.")
        ) from None
    # Other ways of packing are not unpacked piece by piece.
    if member.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        raise ProjectError(
            Message("{name} of this project uses an unsupported compression method.", name=name), _HINT
        )
    packed = min(member.compress_size, os.fstat(archive.fp.fileno()).st_size)  # type: ignore[union-attr]
    within, out = min(most, HEADROOM + _RATIO * packed), io.BytesIO()
    with archive.open(member) as stream:
        while piece := stream.read(_AT_ONCE):
            if out.tell() + len(piece) > within:
                raise too_large(name, within, _HINT)
            out.write(piece)
    return out.getvalue()
