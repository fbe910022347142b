"""Tries the installer for Windows without Windows, on Debian: ``make check-windows``.

Needs nsis and p7zip-full. A small payload stands in for the frozen program. The script is compiled, warnings
are errors, and the result is listed; where there is a wine64 it is installed, upgraded, refused and removed
too, in a folder that is gone afterwards.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

from installer import HERE, compile_installer, makensis

from core import __version__

TARGET = "amd64-unicode"
"""Debian's makensis has it; a wine of 64 bits alone runs no other."""

INSIDE = (
    "busk.exe",
    "buskw.exe",
    "busk-project.ico",
    "_internal/resources/deep/names.txt",
    "_internal/日本語.txt",
)
REFUSED = 2
LISTED = r"HKCU\Software\Microsoft\Windows\CurrentVersion\Uninstall\Busk"
KIND = r"[Software\\Classes\\Busk.Project\\shell\\open\\command]"
IN_THE_REGISTRY = (
    f'"DisplayVersion"="{__version__}"',
    r'"QuietUninstallString"="\"C:\\users\\',
    '"EstimatedSize"=dword:',
    '"FileType"=dword:00000001',
    KIND,
    r"[Software\\Classes\\.busk\\OpenWithProgids]",
    '@="Busk.Project"',
    r"[Software\\Microsoft\\Windows\\CurrentVersion\\App Paths\\busk.exe]",
    r"[Software\\Classes\\Applications\\buskw.exe\\SupportedTypes]",
)

failures = 0


def check(told: str, held: bool) -> None:
    """Print a line, and count what does not hold."""
    global failures  # noqa: PLW0603 - the one figure of this script
    failures += not held
    print(f"{'ok' if held else 'FAILED':6s} {told}", flush=True)


def stand_in(folder: Path, version: str) -> Path:
    """Return a payload: two programs that wait, and a few files, one that this version alone has."""
    inside = folder / "_internal"
    (inside / "resources" / "deep").mkdir(parents=True)
    for name in ("busk", "buskw"):
        command = [str(makensis()), "-V1", f"-DOUT={folder / name}.exe", str(HERE / "stand_in.nsi")]
        subprocess.run(command, check=True)
    for name in ("resources/deep/names.txt", "日本語.txt", f"only in {version}.txt"):
        (inside / name).write_text(version, encoding="utf-8")
    return folder


class Wine:
    """A Windows of our own: folders, registry and programs under ``home``."""

    def __init__(self, home: Path) -> None:
        self.prefix = home / "prefix"
        quiet = {"WINEPREFIX": str(self.prefix), "WINEARCH": "win64", "WINEDEBUG": "-all", "HOME": str(home)}
        # Its menus shall not become those of this machine.
        self.environment = os.environ | quiet | {"WINEDLLOVERRIDES": "winemenubuilder.exe=d"}
        self.environment.pop("DISPLAY", None)
        self.run("wineboot", "-i", seconds=300)
        self.settled()
        user = next(path for path in (self.prefix / "drive_c" / "users").iterdir() if path.name != "Public")
        self.local = user / "AppData" / "Local"
        self.programs = user / "AppData" / "Roaming" / "Microsoft" / "Windows" / "Start Menu" / "Programs"
        self.installed = self.local / "Programs" / "Busk"

    def run(self, *words: str, seconds: float = 120) -> int:
        """Return the exit code of a program."""
        return subprocess.run(
            ["wine", *words], env=self.environment, timeout=seconds, check=False, capture_output=True
        ).returncode

    def settled(self) -> None:
        """Wait until every program has ended, and the registry is written."""
        subprocess.run(["wineserver", "-w"], env=self.environment, timeout=120, check=False)

    def registry(self) -> str:
        """Return the user's part of the registry."""
        self.settled()
        return (self.prefix / "user.reg").read_text("utf-8", errors="replace")

    def gone(self, path: Path) -> bool:
        """Tell whether a file goes within twenty seconds: an uninstaller works on after its first process."""
        for _ in range(100):
            if not path.exists():
                return True
            time.sleep(0.2)
        return False


def try_with_wine(wine: Wine, older: Path, newer: Path) -> None:
    """Install, upgrade, refuse, remove."""
    check("Windows 7 is refused", wine.run(str(older), "/S") == REFUSED and not wine.installed.exists())
    wine.run("reg", "add", r"HKCU\Software\Wine", "/v", "Version", "/d", "win10", "/f")
    wine.run("reg", "add", r"HKCU\Software\Busk\Busk", "/v", "language", "/d", "ja")
    _try_to_install(wine, older)
    _try_to_upgrade(wine, newer)
    _try_what_is_refused(wine, older, newer)
    _try_to_remove(wine)


def _try_to_install(wine: Wine, older: Path) -> None:
    check("the older version installs in silence", wine.run(str(older), "/S") == 0)
    check("its files are there", all((wine.installed / name).exists() for name in INSIDE))
    check("it has a place in the start menu", (wine.programs / "Busk.lnk").exists())
    check("projects are opened with it", KIND in wine.registry())


def _try_to_upgrade(wine: Wine, newer: Path) -> None:
    there = wine.installed
    (there / "of the user.txt").write_text("hers")
    check("the newer version installs over it", wine.run(str(newer), "/S") == 0)
    check("the older one's own files are gone", not (there / "_internal" / "only in 0.0.1.txt").exists())
    check("the newer one's are there", (there / "_internal" / f"only in {__version__}.txt").exists())
    registry = wine.registry()
    for told in IN_THE_REGISTRY:
        check(f"the registry holds {told}", told in registry)
    for key in (r"HKCU\Software\Classes\Busk.Project", r"HKCU\Software\Classes\.busk"):
        wine.run("reg", "delete", key, "/f")
    wine.run("reg", "add", LISTED, "/v", "FileType", "/t", "REG_DWORD", "/d", "0", "/f")
    check("an upgrade without the file type installs", wine.run(str(newer), "/S") == 0)
    check("and leaves projects to others", KIND not in wine.registry())
    wine.run("reg", "delete", LISTED, "/v", "FileType", "/f")
    check("one of before it was asked installs", wine.run(str(newer), "/S") == 0)
    check("and opens projects", KIND in wine.registry())


def _try_what_is_refused(wine: Wine, older: Path, newer: Path) -> None:
    there = wine.installed
    running = subprocess.Popen(
        ["wine", str(there / "buskw.exe")], env=wine.environment, stderr=subprocess.DEVNULL
    )
    time.sleep(2.0)
    check("while Busk runs, installing is refused", wine.run(str(older), "/S") == REFUSED)
    check("and nothing was changed", (there / "_internal" / f"only in {__version__}.txt").exists())
    running.wait(60)

    foreign = wine.prefix / "drive_c" / "foreign"
    (foreign / "_internal").mkdir(parents=True)
    (foreign / "_internal" / "theirs.txt").write_text("theirs")
    check("a folder of others is refused", wine.run(str(newer), "/S", r"/D=C:\foreign") == REFUSED)
    check("and left as it was", [path.name for path in foreign.iterdir()] == ["_internal"])


def _try_to_remove(wine: Wine) -> None:
    there = wine.installed
    wine.run(str(there / "uninstall.exe"), "/S")
    check("the program is removed", wine.gone(there / "uninstall.exe"))
    check("a file of the user's stays", [path.name for path in there.iterdir()] == ["of the user.txt"])
    check("its entry in the start menu is gone", not (wine.programs / "Busk.lnk").exists())
    left = [line for line in wine.registry().splitlines() if "busk" in line.lower()]
    check(
        f"the registry holds the user's choices alone: {left}",
        all(r"Software\\Busk\\Busk" in line for line in left),
    )
    check("and these are there", bool(left))


def main() -> int:
    """Try all that can be tried here, and return 1 if something failed."""
    with tempfile.TemporaryDirectory(prefix="busk-") as name:
        home = Path(name)
        made = []
        for version in ("0.0.1", __version__):
            payload = stand_in(home / f"payload-{version}", version)
            made.append(compile_installer(payload, home / f"setup-{version}.exe", version, TARGET))
            check(f"the installer of {version} compiles without a warning", made[-1].stat().st_size > 10_000)
        listed = subprocess.run(
            ["7z", "l", "-ba", str(made[-1])], capture_output=True, text=True, check=False
        ).stdout
        for inside in INSIDE:
            check(f"it holds {inside}", inside in listed.replace("\\", "/"))
        if shutil.which("wine"):
            # Such a wine believes itself to be Windows 7 until it is told otherwise.
            try_with_wine(Wine(home), *made)
        else:
            print("       there is no wine here: it was not installed, nor removed")
    return int(failures > 0)


if __name__ == "__main__":
    sys.exit(main())
