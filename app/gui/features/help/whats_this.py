"""Why the parts of the window are there: what a click says after Shift+F1."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtWidgets import QWidget

from app.i18n.catalog import tr


def explain(parts: Mapping[str, QWidget]) -> None:
    """Give each of the main parts, by its name, its What's this."""
    for name, text in (_work() | _panels()).items():
        parts[name].setWhatsThis(f"<p>{text}</p>")


def _work() -> dict[str, str]:
    return {
        "steps": tr(
            "The way from a scan to a result. No step is locked: go back and forth as you like. A green tick "
            "says that a step is done, an amber badge that something there wants a look."
        ),
        "view": tr(
            "The body as the model reshapes it. What you see moves at once while you drag a line, and is the "
            "model's answer when the verdict below says settled. How near a worn garment comes to it is not "
            "measured. The selected band can be pulled up or down to make its line shorter or longer."
        ),
        "section": tr(
            "The body cut by a plane, before and after. Move the plane by the handle on it "
            "in the view, by the slider here, or by typing where it is."
        ),
        "report": tr(
            "The sheet to work from, as it comes out of the printer: size, lengths to cut, measures, "
            "pressures and pictures. It follows the design; the customer's name is saved with the project."
        ),
        "convergence": tr(
            "The model comes to rest turn by turn. A garment whose model vibrates or folds tells nothing "
            "yet: look at the verdict before you trust a shape. The dashed line is the exact answer."
        ),
        "notifications": tr(
            "What needs your attention, one at a time, with what you can do. Close it with the cross."
        ),
    }


def _panels() -> dict[str, str]:
    return {
        "scan": tr(
            "What Busk understood of the scan: unit, up and front. All lengths follow from the unit, so that "
            "it is worth a look on a new scanner."
        ),
        "landmarks": tr(
            "Places on the body that the control mesh rests on. Where the skin did not show one clearly, its "
            "confidence is low: drag its pin to where you would put it."
        ),
        "lines": tr(
            "Each line stands for a band of the garment. Shorter than at rest it pulls; the skin gives way "
            "as far as the volume of the body allows. Set and reached differ by what the body does not give."
        ),
        "result": tr(
            "The scan, and what the model makes of it, measured alike in the same places, so that the change "
            "is the model's alone."
        ),
        "garment": tr(
            "How long to cut the elastic of each worn line, how far it is stretched on the body and what it "
            "pulls with. All newtons are estimates: they rest on the stiffness of tissue that stands below."
        ),
        "model": tr(
            "How lines, skin and volume act. The choices of the paper are marked; they change the result, "
            "and are saved with the design."
        ),
    }
