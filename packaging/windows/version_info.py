"""What Windows shows of an executable file - name, description, version - as text that PyInstaller reads."""

from __future__ import annotations

from pathlib import Path

EXECUTABLES = {"busk": "Busk (command line)", "buskw": "Busk"}
"""The two programs of one folder, as Python has python.exe and pythonw.exe.

``busk`` prints; ``buskw``, which menu and double click start, opens no black console. "Busk.exe" would be the
same name as "busk.exe" on a disk of Windows.
"""

_TEXT = """\
VSVersionInfo(
  ffi=FixedFileInfo(filevers={numbers}, prodvers={numbers}, mask=0x3f, flags=0x0, OS=0x40004, fileType=0x1,
    subtype=0x0, date=(0, 0)),
  kids=[
    StringFileInfo([StringTable('040904B0', [
      StringStruct('CompanyName', 'Busk'),
      StringStruct('FileDescription', {description!r}),
      StringStruct('FileVersion', {version!r}),
      StringStruct('InternalName', {name!r}),
      StringStruct('LegalCopyright', 'Apache License 2.0'),
      StringStruct('OriginalFilename', {file!r}),
      StringStruct('ProductName', 'Busk'),
      StringStruct('ProductVersion', {version!r})])]),
    VarFileInfo([VarStruct('Translation', [0x409, 1200])])
  ])
"""


def numbers_of(version: str) -> tuple[int, int, int, int]:
    """Return a version 1.2.3 as the four numbers that Windows compares. Raises ValueError."""
    major, minor, patch = (int(number) for number in version.split("."))
    return major, minor, patch, 0


def version_text(name: str, version: str) -> str:
    """Return the version resource of one of ``EXECUTABLES``."""
    return _TEXT.format(
        numbers=numbers_of(version),
        description=EXECUTABLES[name],
        version=version,
        name=name,
        file=f"{name}.exe",
    )


def write_version(name: str, version: str, folder: Path) -> Path:
    """Write the version resource of one of ``EXECUTABLES`` into a folder, for ``EXE(version=...)``."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{name}-version.txt"
    path.write_text(version_text(name, version), encoding="utf-8")
    return path
