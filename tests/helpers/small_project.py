"""A small project file, whole and known to the last byte, for the tests of files."""

from core.document.design import Design, ScanSource
from core.document.document import Document
from core.document.storage.project_file import ScanFile, save_project

SCAN = ScanFile("body.ply", b"ply\nformat ascii 1.0\nend_header\n" + bytes(range(256)))
DESIGN = Design(ScanSource("/scans/body.ply", unit="cm")).with_line("mid-bust", 0.97)
PICTURE = b"\x89PNG not really"


def write_project(folder):
    path = folder / "anna.busk"
    save_project(path, Document.single(DESIGN), SCAN, PICTURE)
    return path
