"""Writes a project of the sample body for an installed Busk to open: ``python sample_project.py FILE``."""

import sys
from pathlib import Path

from app.presenters.samples import sample_design, sample_path
from core.document.document import Document
from core.document.storage.project_file import ScanFile, save_project

scan = sample_path("mannequin")
save_project(
    Path(sys.argv[1]), Document.single(sample_design()), ScanFile(scan.name, scan.read_bytes()), None
)
