"""What's This texts of the parts of the window (Shift+F1)."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtWidgets import QWidget

from app.i18n.catalog import tr


def explain(parts: Mapping[str, QWidget]) -> None:
    """Set the What's This texts of the main parts, by name."""
    for name, text in (_work() | _panels()).items():
        parts[name].setWhatsThis(f"<p>{text}</p>")


def _work() -> dict[str, str]:
    return {
        "steps": tr(
            "Steps from scan to result. All steps can be opened at any time. A green tick marks a finished "
            "step; an amber badge marks items to review."
        ),
        "view": tr(
            "Reshaped body as computed by the model, updated while you drag a line. The result is final "
            "when the status below is Converged. The agreement with a real garment has not been measured. "
            "Drag the selected band up to shorten its line, down to lengthen it."
        ),
        "section": tr(
            "Section of the body before and after. Move the plane with its handle in the 3D "
            "view, with the slider, or by entering a position."
        ),
        "report": tr(
            "Report as printed: size, cut lengths, measurements, contact pressures and images. The report "
            "is updated when the design changes. The customer's name is saved with the project."
        ),
        "convergence": tr(
            "Convergence of the solver over the iterations. Do not use the shape while the "
            "status is Oscillating or Folded. The dashed line is the exact solution."
        ),
        "notifications": tr("Notices with possible actions, one at a time. Close a notice with the cross."),
    }


def _panels() -> dict[str, str]:
    return {
        "scan": tr(
            "Detected unit, up and front of the scan. All lengths depend on the unit: check it when using "
            "a new scanner."
        ),
        "landmarks": tr(
            "Landmarks are the basis of the control mesh. Where a landmark is unclear on the "
            "scan, its confidence is low: drag its pin to the correct position."
        ),
        "lines": tr(
            "Each line represents a band of the garment. A shorter line compresses the body. Set "
            "is the requested length, Reached the actual length, Gap the difference."
        ),
        "result": tr(
            "Measurements of the scan and of the model result at the same places: all "
            "differences come from the model."
        ),
        "garment": tr(
            "Cut length, elongation on the body and tension of all active lines. All forces in N "
            "are estimates that depend on the tissue stiffness below."
        ),
        "model": tr(
            "Line, skin and volume behaviour. The choices of the paper are marked. They affect "
            "the result and are saved with the design."
        ),
        "pattern": tr(
            "Pieces of a garment block, laid flat so that their seams agree. Strain is what the cloth has to "
            "take up beyond its ease; a piece that is over the limit of its cloth is marked."
        ),
    }
