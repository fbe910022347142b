"""Facts about program and machine, for somebody who is to find out why something does not work."""

from __future__ import annotations

import platform
import sys
from importlib import metadata
from pathlib import Path

from PySide6.QtCore import QSysInfo, qVersion
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import QWidget

from app.gui.session.app_folders import folders, shown_folder
from app.gui.viewport.opengl import graphics_in_words, is_safe_mode
from app.i18n.catalog import tr
from core import __version__

LIBRARIES = ("PySide6-Essentials", "vtk", "pyvista", "pyvistaqt", "numpy", "scipy", "numba")

Group = tuple[str, list[tuple[str, str]]]


def system_info(window: QWidget) -> list[Group]:
    """Return what the program is made of, what draws for it, and where it writes."""
    screen = window.screen()
    size, scale = screen.geometry(), window.devicePixelRatioF()
    return [
        (
            tr("Program"),
            [
                ("Busk", __version__),
                ("Python", f"{platform.python_version()} ({shown_folder(Path(sys.executable))})"),
                ("Qt", f"{qVersion()}, {QGuiApplication.platformName()}"),
                *((name, _version_of(name)) for name in LIBRARIES),
                (tr("System"), f"{QSysInfo.prettyProductName()}, {QSysInfo.currentCpuArchitecture()}"),
            ],
        ),
        (
            tr("Graphics"),
            [
                *graphics_in_words(),
                (tr("Safe mode"), tr("on") if is_safe_mode() else tr("off")),
                (tr("Screen"), f"{size.width()} x {size.height()} ({scale:g}x)"),
            ],
        ),
        (tr("Folders"), [(title, shown_folder(folder)) for title, folder in folders()]),
    ]


def _version_of(name: str) -> str:
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return tr("not installed")
