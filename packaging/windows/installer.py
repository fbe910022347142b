"""Compiles the installer for Windows out of a frozen program: packaging/windows/installer.py [PAYLOAD [OUT]].

Needs makensis: on Windows the NSIS program, on Debian the package nsis. Any warning of it is an error.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from icon_files import write_ico

from core import __version__

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent


def makensis() -> str | None:
    """Return where makensis is, or None."""
    usual = Path(os.environ.get("PROGRAMFILES(X86)", "")) / "NSIS" / "makensis.exe"
    return shutil.which("makensis") or (str(usual) if usual.is_file() else None)


def compile_installer(payload: Path, out: Path, version: str = __version__, target: str = "") -> Path:
    """Return the installer of what lies in ``payload``, written to ``out``; ``target`` is that of NSIS."""
    program = makensis()
    if program is None:
        raise SystemExit(
            "There is no makensis. Debian: apt-get install nsis; Windows: install NSIS 3.08 or later."
        )
    missing = [name for name in ("busk.exe", "buskw.exe", "_internal") if not (payload / name).exists()]
    if missing:
        raise SystemExit(f"{payload} lacks {', '.join(missing)}.")
    out.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        told = {
            "VERSION": version,
            "PAYLOAD": payload.resolve(),
            "OUT": out.resolve(),
            "ICON": write_ico("busk", Path(folder) / "busk.ico"),
            "PROJECT_ICON": write_ico("busk-project", Path(folder) / "busk-project.ico"),
            "LICENCE": ROOT / "LICENSE",
            **({"TARGET": target} if target else {}),
        }
        told_words = [f"-D{key}={value}" for key, value in told.items()]
        command = [program, "-V2", "-WX", "-INPUTCHARSET", "UTF8", *told_words, str(HERE / "busk.nsi")]
        subprocess.run(command, check=True, cwd=HERE)
    return out


if __name__ == "__main__":
    given = [Path(word) for word in sys.argv[1:]]
    folder = given[0] if given else ROOT / "dist" / "busk"
    print(
        compile_installer(
            folder, given[1] if len(given) > 1 else ROOT / "dist" / f"busk-{__version__}-setup.exe"
        )
    )
