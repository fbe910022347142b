"""The bill of materials of the frozen program: what is in it, under which licence, with the texts beside it.

    python packaging/bill.py [--program DIR] [--origins FILE] [--out DIR]

It starts from the files that are shipped and asks of each where it came from: a Python package, a package of
the system, Python itself, this repository. It fails if something has no owner, no licence or no text of one.
"""

from __future__ import annotations

import argparse
import fnmatch
import json
import re
import shutil
import subprocess
import sys
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from importlib import metadata
from pathlib import Path

ROOT = Path(__file__).parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "packaging")]

from bill_part import Part, faults, wanted_whole  # noqa: E402

from core import __version__  # noqa: E402

HERE = ROOT / "packaging" / "licences"
KNOWN = json.loads((HERE / "known.json").read_text("utf-8"))
PYTHON = Path(sys.base_prefix)
CLOSED = re.compile(r"\.(so|pyd|dylib|dll|ttf|otf|woff2?|afm|csv|js)\b[.\d]*$", re.IGNORECASE)
LICENCE_FILE = re.compile(r"(licen[cs]e|copying|copyright|notice|authors)[^/]*$", re.IGNORECASE)


@cache
def packages() -> dict[str, metadata.Distribution]:
    """Return which Python package each installed file belongs to, by its path."""
    return {
        str(Path(str(found.locate_file(file))).resolve()): found
        for found in metadata.distributions()
        for file in found.files or ()
    }


def named(found: metadata.Distribution) -> str:
    """Return the name of a Python package as registries spell it."""
    return re.sub(r"[-_.]+", "-", found.metadata["Name"]).lower()


def python_part(found: metadata.Distribution) -> Part:
    """Return a Python package with all texts about its licence that it brings."""
    name = named(found)
    files = [
        file for file in found.files or () if ".dist-info" in file.parts[0] and LICENCE_FILE.search(str(file))
    ]
    texts = {
        "-".join(file.parts[1:]): Path(str(found.locate_file(file))).read_text("utf-8") for file in files
    }
    if name in ("pyside6-essentials", "shiboken6"):  # their wheels hold none
        texts = our_texts(["LGPL-3.0", "GPL-3.0"])
    licence = KNOWN["python"].get(name) or found.metadata["License-Expression"] or ""
    return Part(name, found.version, licence, "python", texts)


def our_texts(names: Iterable[str], copyright_: str = "") -> dict[str, str]:
    """Return texts that lie in this folder, below the line that names who holds the rights."""
    head = f"{copyright_}\n\n" if copyright_ else ""
    return {f"{name}.txt": head + (HERE / "texts" / f"{name}.txt").read_text("utf-8") for name in names}


@cache
def system_package(path: str) -> str:
    """Return the name of Debian's package that a file belongs to, or nothing."""
    places = [path, path.removeprefix("/usr"), str(Path(path).resolve())]
    for place in dict.fromkeys(places):
        told = subprocess.run(["dpkg", "-S", place], capture_output=True, text=True, check=False)
        if told.returncode == 0:
            return told.stdout.split(":")[0]
    return ""


def system_part(name: str) -> Part:
    """Return a package of Debian, with its file of rights."""
    shown = subprocess.run(
        ["dpkg-query", "-W", "-f=${Version}\n", name], capture_output=True, text=True, check=True
    )
    text = (Path("/usr/share/doc") / name / "copyright").read_text("utf-8")
    version, licence = shown.stdout.split("\n")[0], KNOWN["system"].get(name, "")
    # Debian keeps these texts in one place of the system; other systems have no such place.
    whole = our_texts(wanted_whole(licence))
    return Part(name, version, licence, "system", {"copyright.txt": text, **whole})


def owner(place: str, source: str) -> Part:
    """Return the part that a shipped file belongs to, by where it lies and where it came from."""
    path = Path(source)
    if found := packages().get(str(path.resolve())):
        return busk() if named(found) == "busk" else _python_part(named(found))
    if path.is_relative_to(PYTHON) or place == "base_library.zip":
        return python_itself()
    if path.is_relative_to(ROOT):
        return _own(place)
    if name := system_package(source):
        return _system_part(name)
    return Part(place, "", "", "unknown")


@cache
def _python_part(name: str) -> Part:
    return python_part(metadata.distribution(name))


_system_part = cache(system_part)


@cache
def python_itself() -> Part:
    """Return the interpreter with its standard library."""
    texts = [PYTHON / "lib" / f"python3.{sys.version_info.minor}" / "LICENSE.txt", PYTHON / "LICENSE.txt"]
    texts.append(Path(f"/usr/share/doc/python3.{sys.version_info.minor}/copyright"))
    found = {path.name: path.read_text("utf-8") for path in texts if path.is_file()}
    return Part("CPython", sys.version.split()[0], "Python-2.0.1", "python itself", found)


def _own(place: str) -> Part:
    for row in KNOWN["ours"]:
        if any(fnmatch.fnmatchcase(place, pattern) for pattern in row["places"]):
            text = (ROOT / row["text"]).read_text("utf-8")
            return Part(row["name"], row["version"], row["licence"], "ours", {Path(row["text"]).name: text})
    return busk()


@cache
def busk() -> Part:
    """Return Busk itself."""
    return Part("Busk", __version__, "Apache-2.0", "ours", {"LICENSE": (ROOT / "LICENSE").read_text("utf-8")})


def within(places: list[str], parts: Mapping[str, Part]) -> Iterator[Part]:
    """Yield what others bring along inside them, as far as a shipped file shows that it is there."""
    for row in KNOWN["within"]:
        there = any(fnmatch.fnmatchcase(place, pattern) for place in places for pattern in row["places"])
        if there and (bringer := parts.get(row["of"])):
            texts = our_texts(row["texts"], row.get("copyright", "")) if "texts" in row else bringer.texts
            version = row.get("version", "").replace("as PySide6", bringer.version)
            yield Part(row["name"], version, row["licence"], "within", texts, row["of"])


def unasked(origins: Mapping[str, str]) -> list[str]:
    """Return a sentence on each Python package that ships what may hold others' work, and has no row of it.

    That are fonts, tables of colours and what was compiled: a library inside shows in no list of packages.
    """
    answered = {row["of"] for row in KNOWN["within"]} | set(KNOWN["nothing within"])
    found = {
        packages().get(str(Path(source).resolve())) for source in origins.values() if CLOSED.search(source)
    }
    names = sorted({named(each) for each in found if each} - answered)
    return [
        f"{name} may bring other work along: say what in packaging/licences/known.json." for name in names
    ]


def collected(program: Path, origins: Mapping[str, str]) -> tuple[list[Part], list[str]]:
    """Return all parts of the program in order, and the shipped files that nobody knows.

    ``origins`` tells the source of each place in ``_internal``, and of each module inside the executable.
    """
    inside = program / "_internal"
    shipped = [
        path.relative_to(inside).as_posix()
        for path in sorted(inside.rglob("*"))
        if path.is_file() and not path.is_symlink() and path.relative_to(inside).parts[0] != "licences"
    ]
    strays = [place for place in shipped if place not in origins and place != "base_library.zip"]
    stub = {each.name: each for each in (_python_part("pyinstaller"), busk(), python_itself())}
    for place, source in origins.items():
        if source == "-":  # a folder of packages that has no file itself
            continue
        part = owner(place, source)
        stub.setdefault(part.name, part)
    parts = [*stub.values(), *within(shipped, stub)]
    return sorted(parts, key=lambda part: (part.key, part.version)), strays


def cyclone(parts: Iterable[Part]) -> dict[str, object]:
    """Return the bill as CycloneDX 1.6, without a time: equal programs have equal bills."""
    rows = [
        {
            "type": "library",
            "bom-ref": part.key,
            "name": part.name,
            **({"version": part.version} if part.version else {}),
            "licenses": [{"expression": part.licence}],
            "purl": part.purl,
            "properties": [
                {"name": "busk:licence-texts", "value": f"licences/{part.key}"},
                *([{"name": "busk:within", "value": part.within}] if part.within else []),
            ],
        }
        for part in parts
        if part.name != "Busk"
    ]
    program = {"type": "application", "bom-ref": "busk", "name": "Busk", "version": __version__}
    program["licenses"] = [{"expression": "Apache-2.0"}]
    tree = [{"ref": "busk", "dependsOn": [row["bom-ref"] for row in rows]}]
    return {
        "$schema": "http://cyclonedx.org/schema/bom-1.6.schema.json",
        "bomFormat": "CycloneDX",
        "specVersion": "1.6",
        "version": 1,
        "metadata": {"component": program},
        "components": rows,
        "dependencies": tree,
    }


def table(parts: Iterable[Part]) -> str:
    """Return the bill as plain text, a line a part."""
    rows = [("name", "version", "licence", "brought by")]
    rows += [(part.name, part.version or "-", part.licence, part.within or "-") for part in parts]
    widths = [max(len(row[i]) for row in rows) for i in range(4)]
    return "".join(
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() + "\n"
        for row in rows
    )


def write(parts: list[Part], program: Path, out: Path) -> None:
    """Write texts and bill into the program, and the bill once more beside the packages."""
    folder = program / "_internal" / "licences"
    shutil.rmtree(folder, ignore_errors=True)
    for part in parts:
        place = folder / part.key
        place.mkdir(parents=True, exist_ok=True)
        for name, text in part.texts.items():
            (place / name).write_text(text, "utf-8")
    shutil.copyfile(HERE / "README.txt", folder / "README.txt")
    machine, people = json.dumps(cyclone(parts), indent=2, ensure_ascii=False) + "\n", table(parts)
    for place, stem in ((folder, "bill"), (out, f"busk-{__version__}-bill")):
        (place / f"{stem}.json").write_text(machine, "utf-8")
        (place / f"{stem}.txt").write_text(people, "utf-8")


def main() -> int:
    """Write the bill, or say what is missing in it."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--program", type=Path, default=ROOT / "dist" / "busk")
    parser.add_argument("--origins", type=Path, default=ROOT / "build" / "work" / "busk" / "origins.json")
    parser.add_argument("--out", type=Path, default=ROOT / "dist")
    chosen = parser.parse_args()
    origins = dict(json.loads(chosen.origins.read_text("utf-8")))
    parts, strays = collected(chosen.program, origins)
    wrong = [f"Nobody knows where {place} came from." for place in strays]
    wrong += faults(parts) + unasked(origins)
    if wrong:
        print("\n".join(("The bill is not complete:", *wrong)), file=sys.stderr)
        return 1
    write(parts, chosen.program, chosen.out)
    print(f"bill: {len(parts)} parts, each with a licence and its text")
    return 0


if __name__ == "__main__":
    sys.exit(main())
