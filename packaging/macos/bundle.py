"""What Busk.app tells macOS: its name, version, what it opens, and how it is signed."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent

IDENTIFIER = "org.busk.Busk"
PROJECT = "org.busk.project"

OLDEST = "13.0"
"""The oldest macOS that the pinned Qt is made for."""

KNOWN = (
    "public.polygon-file-format",
    "public.geometry-definition-format",
    "public.standard-tesselated-geometry-format",
)
"""PLY, OBJ and STL: macOS has names for them."""

OTHERS = {
    "org.khronos.glb": ("glb",),
    "org.khronos.gltf": ("gltf",),
    "org.busk.imported.off": ("off",),
    "org.busk.imported.vtp": ("vtp",),
}
"""Scans that macOS may not know: we say what they are, without a claim to them."""


def info_plist(version: str) -> dict[str, Any]:
    """Return what stands in Info.plist beside what PyInstaller writes."""
    return {
        "CFBundleDisplayName": "Busk",
        "CFBundleName": "Busk",
        "CFBundleShortVersionString": version,
        "CFBundleVersion": version,
        "CFBundleDevelopmentRegion": "en",
        "CFBundleLocalizations": ["en", "ja"],
        "CFBundleDocumentTypes": [
            _opens("Busk project", "Editor", "Owner", (PROJECT,))
            | {"CFBundleTypeIconFile": "busk-project.icns"},
            _opens("3D scan", "Viewer", "Alternate", (*KNOWN, *OTHERS)),
        ],
        # No zip to the system, though it is one: where Busk is gone, no double click unpacks a project.
        "UTExportedTypeDeclarations": [
            _type(PROJECT, "Busk project", ("public.data", "public.content"), ("busk",))
            | {"UTTypeIconFile": "busk-project.icns"}
        ],
        "UTImportedTypeDeclarations": [
            _type(name, "3D scan", ("public.data", "public.3d-content"), endings)
            for name, endings in OTHERS.items()
        ],
        "LSApplicationCategoryType": "public.app-category.graphics-design",
        "LSMinimumSystemVersion": OLDEST,
        "NSHighResolutionCapable": True,
        "NSHumanReadableCopyright": "Apache License 2.0",
        "NSPrincipalClass": "NSApplication",
        "NSRequiresAquaSystemAppearance": False,  # dark where the system is
    }


def signing() -> dict[str, str]:
    """Return how executables are signed: by the identity in BUSK_SIGN_AS, or if there is none ad hoc."""
    identity = os.environ.get("BUSK_SIGN_AS", "")
    entitlements = str(HERE / "entitlements.plist")
    return {"codesign_identity": identity, "entitlements_file": entitlements} if identity else {}


def _opens(name: str, role: str, rank: str, types: tuple[str, ...]) -> dict[str, Any]:
    told = {"CFBundleTypeName": name, "CFBundleTypeRole": role, "LSHandlerRank": rank}
    return told | {"LSItemContentTypes": list(types)}


def _type(name: str, words: str, kinds: tuple[str, ...], endings: tuple[str, ...]) -> dict[str, Any]:
    tags = {"public.filename-extension": list(endings)}
    return {
        "UTTypeIdentifier": name,
        "UTTypeDescription": words,
        "UTTypeConformsTo": list(kinds),
        "UTTypeTagSpecification": tags,
    }
