"""The worn scan: read, registered to the first, compared with the prediction, calibrated on."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from PySide6.QtCore import QObject, Signal

from app.gui.features.scan_comparison.page import ScanComparisonPage, ScanComparisonView
from app.gui.session.jobs import Job
from app.gui.widgets.file_dialogs import ask_scan
from app.gui.widgets.navigation_row import NavigationRow
from app.i18n.catalog import tr
from app.presenters import scan_comparison as words
from core.analysis.calibration.api import (
    CalibrationResult,
    FittingScan,
    Residuals,
    calibrate,
    compare,
    read_fitting_scan,
)
from core.document.design import Design, ScanSource
from core.geometry.mesh import Floats
from core.pipeline.live_solver import Frame
from core.scan.body import Body

if TYPE_CHECKING:
    from app.gui.context import AppContext

MAP = "worn"
"""The map Predicted less real."""

PANEL = "worn"
"""The name of the page in the inspector."""

_REFUSED = "the worn scan"  # what a refusal is about, which the next scan takes away


class ScanComparisonController(QObject):
    """Keep one worn scan of the body shown, and compare and calibrate with it.

    ``compared`` is emitted when there is another comparison, or none, ``map_requested`` with the name of a
    map or none. A calibration belongs to one design, and goes with it; the scan goes with its body.
    """

    compared = Signal()
    map_requested = Signal(str)

    def __init__(self, context: AppContext) -> None:
        super().__init__(context.session)
        self._context, self._mapped = context, False
        self.page = ScanComparisonPage()
        self.door = NavigationRow(tr("Compare with fitting scan"))
        self.worn: FittingScan | None = None
        self._of: Body | None = None  # the body that a scan was chosen for
        self._path, self._unit, self._thickness = "", "", 0.0
        self._difference: tuple[Frame, Residuals] | None = None
        self._found: tuple[Design, CalibrationResult] | None = None
        self._reading: Job | None = None
        self._comparing: tuple[Job, Frame] | None = None
        self._fitting: tuple[Job, Design] | None = None
        self._connect()

    def _connect(self) -> None:
        text = tr("Compare the prediction with a scan of the worn garment")
        begin = tr("Compare with fitting scan…")
        self._context.actions.add("file", begin, tip=text, do=self.begin, of_document=True)
        self._context.session.design_changed.connect(lambda _: self.follow())
        self._context.session.opened.connect(lambda _: self.close())
        page = self.page
        self.door.clicked.connect(lambda _: self.show_page())
        page.asked.connect(self.choose)
        page.closed.connect(self.close)
        page.told.connect(self._tell_unit)
        page.thickened.connect(self._thicken)
        page.mapped.connect(lambda on: self.map_requested.emit(MAP if on else ""))
        page.calibrated.connect(self.calibrate)
        page.applied.connect(self.apply)

    # -- what is asked

    def begin(self) -> None:
        """Open the page, and ask for a scan if there is none yet."""
        self.show_page()
        if self.worn is None:
            self.choose()

    def show_page(self) -> None:
        """Show the page in the place of the measures."""
        self._context.navigation.show_step("result")
        self._context.navigation.show_panel(PANEL)
        self._context.navigation.focus_panel()
        self.follow()

    def close(self) -> None:
        """Show the measures again, if the page is shown."""
        if self._context.navigation.panel == PANEL:
            self._context.navigation.show_panel("result")

    def choose(self) -> None:
        """Prompt for the fitting scan and read it."""
        if path := ask_scan(self._context.window, tr("Open fitting scan")):
            self.read(path)

    def read(self, path: str) -> None:
        """Read a worn scan and lay it on the body shown; what was compared before stays until then."""
        frame = self._context.session.frame
        if frame is None:
            return
        self._context.jobs.cancel(self._reading)
        self._path, self._of = path, frame.stages.body
        self._context.notifications.withdraw(_REFUSED)
        source = ScanSource(path, unit=self._unit or None)
        self._reading = self._context.jobs.run(
            tr("Reading fitting scan…"),
            lambda progress: read_fitting_scan(frame.stages, source, progress),
            lambda worn: self._take(cast(FittingScan, worn)),
            lambda error: self._context.notifications.error(error, _REFUSED),
            waited=True,
        )

    def calibrate(self) -> None:
        """Find the numbers at which the prediction comes nearest, beside."""
        frame, worn, thickness = self._context.session.frame, self.worn, self._thickness
        if frame is None or worn is None or not self._context.session.is_converged:
            return
        design = frame.stages.design
        job = self._context.jobs.run(
            tr("Calibrating…"),
            lambda progress: calibrate(frame.stages, worn, thickness=thickness, progress=progress),
            lambda found: self._take_found(design, cast(CalibrationResult, found)),
            self._fail_to_fit,
            waited=True,
            left=self.follow,
        )
        self._fitting = job, design
        self.follow()

    def _fail_to_fit(self, error: Exception) -> None:
        self._fitting = None
        self._context.notifications.error(error)
        self.follow()

    def apply(self) -> None:
        """Apply the calibrated parameters to the design, as one undo step."""
        if self._found is None or self._found[0] is not self._context.session.design:
            return
        found, self._found = self._found[1], None
        text = tr("Calibration with {file}").format(file=found.calibration.worn)
        self._context.session.edit(lambda _: found.design, text)

    def _tell_unit(self, unit: str) -> None:
        self._unit = unit
        if self._path:
            self.read(self._path)

    def _thicken(self, mm: float) -> None:
        self._thickness = mm
        self._begin_anew()
        self.page.thickness.show_value(mm)
        self.follow()

    # -- what is known

    def values(self, frame: Frame) -> Floats:
        """Return predicted less real at ``skin.vertices`` of a frame, (r,) [mm]; no numbers if unknown."""
        return words.map_values(self._known(frame), len(frame.stages.skin.vertices))

    def note(self, frame: Frame) -> str:
        """Return what the legend of the map says first, or nothing."""
        return next(words.notes_of(self.worn, self._known(frame) is None), "")

    def _known(self, frame: Frame) -> Residuals | None:
        """Return the comparison of a frame; if it is not known yet it is worked out beside."""
        if self._difference is not None and _is_as(frame, self._difference[0]):
            return self._difference[1]
        asked = self._comparing is not None and _is_as(frame, self._comparing[1])
        if self.worn is not None and self._of is frame.stages.body and self._rests(frame) and not asked:
            self._compare(frame, self.worn)
        return None

    def _rests(self, frame: Frame) -> bool:
        """Return whether the shape shown has settled, though turns beside it may go on for seconds."""
        session = self._context.session
        of_now = frame is session.frame and frame.stages.design is session.design and session.is_answered
        return of_now and (frame.verdict.motion == "settled" or not frame.is_running)

    def _compare(self, frame: Frame, worn: FittingScan) -> None:
        if self._comparing is not None:
            self._context.jobs.cancel(self._comparing[0])
        thickness = self._thickness
        job = self._context.jobs.run(
            tr("Comparing with fitting scan…"),
            lambda progress: compare(frame.stages, frame.all_points, worn, thickness),
            lambda found: self._take_difference(frame, cast(Residuals, found)),
            self._context.notifications.error,
        )
        self._comparing = job, frame

    def _take(self, worn: FittingScan) -> None:
        self._reading, self.worn = None, worn
        self._begin_anew()
        self.follow()

    def _begin_anew(self) -> None:
        """Release all that was found, or is being looked for, with another scan or thickness."""
        for begun in (self._comparing, self._fitting):
            if begun is not None:
                self._context.jobs.cancel(begun[0])
        self._comparing = self._fitting = self._difference = self._found = None
        self.compared.emit()

    def _take_difference(self, frame: Frame, found: Residuals) -> None:
        self._comparing = None
        self._difference = frame, found
        self.follow()
        self.compared.emit()

    def _take_found(self, design: Design, found: CalibrationResult) -> None:
        self._fitting = None
        if design is self._context.session.design:
            self._found = design, found
        self.follow()

    def show_map(self, name: str) -> None:
        """Show by the page whether its map lies on the body."""
        self._mapped = name == MAP
        self.follow()

    def follow(self) -> None:
        """Update page and navigation row, and drop results of other designs."""
        frame, design = self._context.session.frame, self._context.session.design
        if frame is None or design is None:
            return
        self._let_go(frame, design)
        self.door.show_words(words.navigation_text(design.calibration, self.worn))
        if not self.page.isVisible():
            return
        known = self._known(frame)
        shown = known or (self._difference[1] if self._difference else None)
        self.page.show_view(self._view(frame, design, shown, faint=known is None))
        self.page.show_map(self._mapped)

    def _let_go(self, frame: Frame, design: Design) -> None:
        if self._of is not None and frame.stages.body is not self._of:
            self._context.jobs.cancel(self._reading)
            self._reading = self.worn = self._of = None
            self._path = ""
            if self._mapped:
                self.map_requested.emit("")  # of a body that is gone
            self._begin_anew()
        if self._found is not None and self._found[0] is not design:
            self._found = None
        if self._fitting is not None and self._fitting[1] is not design:
            self._context.jobs.cancel(self._fitting[0])
            self._fitting = None

    def _view(
        self, frame: Frame, design: Design, shown: Residuals | None, *, faint: bool
    ) -> ScanComparisonView:
        worn, found = self.worn, self._found[1] if self._found else None
        at_work = self._fitting is not None and self._fitting[0].wanted
        return ScanComparisonView(
            file=worn.name if worn else "",
            lies=words.aligned_text(worn) if worn else "",
            rows=words.residual_rows(shown) if shown else (),
            bust=words.summary_text(shown) if shown else "",
            numbers=words.parameter_rows(found, design) if found else (),
            surely=words.determination_text(found, design) if found else "",
            kept=words.fixed_parameters_text(found, design) if found else "",
            better=words.improvement_text(found, design) if found else "",
            record=words.record_text(design.calibration),
            faint=faint,
            ready=bool(worn) and self._context.session.is_converged and not at_work and not faint,
            helped=found is not None and found.is_improved,
            doubtful=found is not None and found.is_poorly_determined,
        )


def _is_as(frame: Frame, other: Frame) -> bool:
    """Return whether two frames show the same shape: another may have come of turns beside it alone."""
    same = frame.stages is other.stages
    return same and bool((frame.all_points == other.all_points).all())
