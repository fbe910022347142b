"""What lies in the repository: light files, pinned downloads, one version, named licences, no traces."""

from __future__ import annotations

import ast
import re
import shutil
import subprocess
import tomllib
from fnmatch import fnmatch
from pathlib import Path

from core import __version__

ROOT = Path(__file__).parents[2]
LOCK = (ROOT / "requirements.lock").read_text("utf-8")
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
DIRECT = [*PROJECT["dependencies"], *PROJECT["optional-dependencies"]["dev"]]


def tracked_files() -> list[Path]:
    """What a clone holds: asked of git, or where there is no git, all that .gitignore does not name."""
    if shutil.which("git"):
        command = ["git", "ls-files", "-z"]
        names = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False).stdout.split(
            "\0"
        )
        if any(names):
            return [ROOT / name for name in names if name and (ROOT / name).is_file()]
    ignored = [line.strip("/") for line in (ROOT / ".gitignore").read_text("utf-8").split()] + [".git"]
    return [
        path
        for path in ROOT.rglob("*")
        if path.is_file()
        and not any(fnmatch(part, name) for part in path.relative_to(ROOT).parts for name in ignored)
    ]


FILES = tracked_files()
TEXTS = {path: path.read_text("utf-8") for path in FILES if b"\0" not in path.read_bytes()[:8192]}
PYTHON = [path for path in FILES if path.suffix == ".py"]


def package_names(requirements: list[str]) -> set[str]:
    """The names of requirements as registries spell them: lower case, dashes."""
    return {re.split(r"[^\w.-]", line)[0].lower().replace("_", "-") for line in requirements}


def locked() -> list[str]:
    return re.findall(r"^[a-z].*==.*$", LOCK, re.MULTILINE)


def test_no_file_is_heavy() -> None:
    heavy = {path.name: path.stat().st_size for path in FILES if path.stat().st_size > 3_000_000}
    assert not heavy


def test_a_module_can_be_read_in_one_sitting() -> None:
    lines = {path.relative_to(ROOT).as_posix(): TEXTS[path].count("\n") for path in PYTHON}
    assert {name: count for name, count in lines.items() if count > 600} == {}


def test_a_function_has_at_most_40_lines() -> None:
    long = {
        f"{path.relative_to(ROOT).as_posix()}: {node.name}": node.end_lineno - node.lineno + 1
        for path in PYTHON
        if path.relative_to(ROOT).parts[0] in ("core", "app")
        for node in ast.walk(ast.parse(TEXTS[path]))
        if isinstance(node, ast.FunctionDef) and node.end_lineno
    }
    assert {name: count for name, count in long.items() if count > 40} == {}


def test_every_download_is_pinned_by_hash() -> None:
    blocks = re.split(r"^(?=[a-z])", LOCK, flags=re.MULTILINE)[1:]
    assert len(blocks) > 30
    assert [
        block.splitlines()[0] for block in blocks if not re.search(r"--hash=sha256:[0-9a-f]{64}", block)
    ] == []


def test_the_lock_names_no_registry() -> None:
    assert "://" not in LOCK
    assert not re.search(r"^\s*-(i|f|-index-url|-extra-index-url|-find-links)\b", LOCK, re.MULTILINE)


def test_the_lock_holds_every_dependency() -> None:
    assert package_names(DIRECT) <= package_names(locked())


def test_the_lock_avoids_the_qt_that_dies_on_python_3_11() -> None:
    pins = [line for line in locked() if line.startswith("pyside6-essentials==6.12")]
    assert all("python_full_version >= '3.12'" in pin for pin in pins)


def test_third_party_names_every_package_and_font() -> None:
    notices = (ROOT / "THIRD_PARTY.md").read_text("utf-8").lower()
    unnamed = sorted(name for name in package_names(locked()) if f"| {name} |" not in notices)
    assert not unnamed
    families = {path.name.split("-")[0] for path in FILES if path.suffix in {".ttf", ".otf"}}
    assert families
    for family in families:
        assert (ROOT / "resources" / "fonts" / f"{family}-LICENSE.txt").is_file()
        assert f"`{family}-*".lower() in notices


def test_the_version_stands_in_one_place() -> None:
    assert "version" not in PROJECT
    assert [path.name for path in PYTHON if f'"{__version__}"' in TEXTS[path]] == ["__init__.py"]
    changes = (ROOT / "CHANGELOG.md").read_text("utf-8")
    assert re.findall(r"^## (\d\S*)", changes, re.MULTILINE)[0] == __version__


def test_the_readme_begins_with_the_two_commands() -> None:
    readme = (ROOT / "README.md").read_text("utf-8")
    assert "make run" in readme
    assert "make test" in readme


def personal_paths(*folders: Path) -> re.Pattern[str]:
    """What names a file in one of ``folders``, or in anybody's home; a folder that all share names nobody."""
    shared = {
        Path(folder.anchor) / name for folder in folders for name in ("", "home", "Users", "root", "tmp")
    }
    own = [re.escape(f"{folder}/") for folder in folders if folder not in shared]
    return re.compile("|".join([*own, r"/home/\w", r"/Users/\w", r"[A-Z]:\\Users"]))


def test_no_file_knows_the_machine_it_was_written_on() -> None:
    personal = personal_paths(ROOT, Path.home())
    assert [
        path.name for path, text in TEXTS.items() if personal.search(text) and path != Path(__file__)
    ] == []


def test_a_home_that_is_a_folder_of_homes_makes_no_file_personal() -> None:
    script = "home=/home/$user; find / -path /home -o -path /tmp/x"
    for home in ("/home", "/", "/tmp"):
        assert not personal_paths(Path(home)).search(script)
    assert personal_paths(Path("/srv/anna")).search("see /srv/anna/notes")
    assert personal_paths(Path("/home")).search("see /home/anna/notes")
