"""The scan: what was detected on it, its edits, and the question of its orientation."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal
from PySide6.QtGui import QColor, QImage

from app.gui.features.scan.panel import ScanPanel
from app.gui.session.jobs import Job
from app.gui.theme.stylesheet import tokens_of
from app.gui.viewport.orientation_card import PICTURE, OrientationChoice
from app.gui.widgets.notification_bar import REFUSED, SCAN
from app.i18n.catalog import tr
from app.presenters.scan import scan_view
from app.rendering.appearance import APPEARANCES
from app.rendering.thumbnail import OrientationOption, Picture, option_thumbnails
from core.document.design import Design, ScanSource
from core.pipeline.build import IncompleteBuildError, Stages
from core.pipeline.live_solver import Frame
from core.pipeline.warnings import warnings
from core.scan.body import Body
from core.scan.orientation.lean_angles import corrected_up
from core.scan.source import ScanEdits

if TYPE_CHECKING:
    from app.gui.context import AppContext

_QUESTION = "how the scan stands"
"""What a notice is about that asks for an answer, or says that there is none."""


class ScanController(QObject):
    """Show what was detected on a scan, and make corrections of it edits of the design.

    ``found`` carries the stages of a body whose landmarks are to be shown, ``checked`` those of one that has
    just been opened, ``incomplete_shown`` why the scan that is shown is no document.
    """

    found = Signal(object)
    checked = Signal(object)
    incomplete_shown = Signal(object)

    def __init__(self, context: AppContext, panel: ScanPanel, may_leave: Callable[[], bool]) -> None:
        super().__init__(context.session)
        self._context, self._panel, self._may_leave = context, panel, may_leave
        self._session = context.session
        self._asked_for: Design | None = None
        self._stages: Stages | None = None
        self._painting: Job | None = None
        self._connect()

    def _connect(self) -> None:
        session, panel, question = self._session, self._panel, self._context.view.question
        session.failed.connect(lambda _: self.show_refused())
        session.requested.connect(self.show_stuck)
        panel.value_set.connect(self.tell)
        panel.edits.edited.connect(self.edit)
        panel.lean.leaned.connect(self.lean)
        panel.lean.up_chosen.connect(self.stand_upright)
        panel.front_requested.connect(self.ask)
        question.answered.connect(self.answer)
        question.closed.connect(self.leave_question)

    @property
    def painting(self) -> bool:
        """Return whether the question's pictures are being painted."""
        return self._painting is not None

    # -- the session speaks

    def show_found(self, stages: Stages) -> None:
        """Show what was understood of the scan, and found on it."""
        context = self._context
        self._panel.set_scan(scan_view(stages.design.scan, stages.body, landmarks=stages.landmarks))
        sure = stages.body.pose.is_certain and not stages.landmarks.size_doubted
        context.navigation.mark_step("scan", "done" if sure else "look", 1)
        self.found.emit(stages)

    def show_opened(self, frame: Frame) -> None:
        """Show what is unclear on a scan that was opened, and ask for its orientation if need be."""
        self._check_pose(frame.stages)
        for sentence in warnings(frame.stages):
            self._context.notifications.warn(sentence, topic=SCAN)
        if (remark := self._session.remark) is not None:
            self._context.notifications.warn(remark.message, remark.hint, topic=SCAN)

    def show_frame(self, frame: Frame) -> None:
        """Show what was found on the scan of a frame, if it is another one; warnings that are over go."""
        former, self._stages = self._stages, frame.stages
        if former is None or frame.stages.landmarks is not former.landmarks:
            self.show_found(frame.stages)
        if former is not None and frame.stages.control is not former.control:
            remark = self._session.remark
            lasting = [remark.message] if remark is not None and frame.stages.tissue is None else []
            self._context.notifications.keep_only(SCAN, [*warnings(frame.stages), *lasting])

    def _check_pose(self, stages: Stages) -> None:
        self._forget_question()
        self._session.stuck = None
        self.checked.emit(stages)
        pose, source = stages.body.pose, stages.design.scan
        if pose.is_certain:
            return
        if source.up and source.front:
            unsure = tr("The unit, up or front axis of this scan is ambiguous.")
            self._context.notifications.warn(unsure, pose.reason, topic=_QUESTION)
        else:
            self._ask(stages.body, None)

    def show_stuck(self, stuck: IncompleteBuildError) -> None:
        """Show a scan that cannot go on if no document is open; ask how it stands if that is not sure."""
        self._forget_question()
        asked = self._session.stuck is not None and self._session.stuck.design.scan is stuck.design.scan
        if self._session.design is None:
            self._show_alone(stuck)
        if stuck.kind == "unsure" and not asked:
            self._ask(stuck.body, stuck.design)
        else:
            self._say_stuck(stuck)

    def _show_alone(self, stuck: IncompleteBuildError) -> None:
        """Show a scan that cannot go on in the place of a document."""
        context, self._session.stuck = self._context, stuck
        lacks = stuck.kind == "landmarks"
        self.incomplete_shown.emit(stuck)
        self._panel.set_scan(scan_view(stuck.design.scan, stuck.body, stuck.kind != "refused"))
        context.view.show_stuck(stuck.body, stuck.landmarks)
        context.navigation.show_step("landmarks" if lacks else "scan")
        context.navigation.mark_step("scan", "done" if lacks else "look")

    def _say_stuck(self, stuck: IncompleteBuildError) -> None:
        notifications = self._context.notifications
        notifications.withdraw(REFUSED)
        notifications.show("bad", stuck.message, stuck.hint, lasting=True, topic=REFUSED)

    # -- the user asks

    def tell(self, key: str, value: str) -> None:
        """Read the scan again with its unit, up or front as told; an empty key forgets what was told."""
        design = self._session.stuck.design if self._session.stuck else self._session.design
        if design is None:
            return
        scan = design.scan
        if not key:
            text, scan = (
                tr("Unit and directions reset"),
                scan.set_up(unit=None, up=None, front=None),
            )
        elif key == "unit":
            text, scan = tr("Scan in {unit}").format(unit=value), scan.set_up(unit=value)
        elif key == "up":
            # What was told to be front may lie along the new axis: then it is to be found.
            front = (
                scan.front if scan.front and scan.front[1:] != value[1:] and "," not in scan.front else None
            )
            text, scan = tr("{axis} is up").format(axis=value), scan.set_up(up=value, front=front)
        else:
            up = self._shown_up() if scan.up is None else scan.up
            text, scan = tr("{axis} is front").format(axis=value), scan.set_up(up=up, front=value)
        self._read_again(scan, text)

    def lean(self, forward: float, left: float) -> None:
        """Correct a lean of the body in its file, forward and to its left [degrees]."""
        body = self._shown_body()
        if body is not None:
            self._rotate(corrected_up(body.pose, forward, left), tr("Correct lean"))

    def stand_upright(self, up: str) -> None:
        """Set a leaning body upright, with the direction of the file that is up."""
        self._rotate(up, tr("Set upright"))

    def _rotate(self, up: str, text: str) -> None:
        design = self._session.stuck.design if self._session.stuck else self._session.design
        if design is not None:
            self._read_again(design.scan.set_up(up=up), text)

    def edit(self, edits: ScanEdits, text: str) -> None:
        """Edit the scan as one undo step named ``text``."""
        design = self._session.stuck.design if self._session.stuck else self._session.design
        if design is not None:
            self._read_again(replace(design.scan, edits=edits), text)

    def show_refused(self) -> None:
        """Show the scan as it is after an edit that was refused."""
        frame, design = self._session.frame, self._session.design
        if frame is not None and design is not None and not self._session.stuck:
            self.show_found(frame.stages)

    def _read_again(self, scan: ScanSource, text: str) -> None:
        if self._session.stuck:
            self._session.open_design(replace(self._session.stuck.design, scan=scan))
        else:
            self._session.change({"scan": scan}, text)

    def ask(self) -> None:
        """Show the pictures for the present scan."""
        frame = self._session.frame
        if self._session.stuck:
            self._ask(self._session.stuck.body, self._session.stuck.design)
        elif frame is not None:
            self._ask(frame.stages.body, None)

    def answer(self, up: str, front: str) -> None:
        """Take the answer: the open scan is read again as one undo step, one that waits is opened."""
        waiting, design = self._asked_for, self._session.design
        self._forget_question()
        self._context.notifications.withdraw(_QUESTION)
        if waiting is not None:
            # What is open may have been edited while the question waited.
            if self._may_leave():
                self._session.open_design(replace(waiting, scan=waiting.scan.set_up(up=up, front=front)))
        elif design is not None:
            self._session.change(
                {"scan": design.scan.set_up(up=up, front=front)}, tr("Front chosen from image")
            )

    def leave_question(self) -> None:
        """Leave a scan as it is understood; one that waited for the answer is let go, if it is not shown."""
        waiting, frame = self._asked_for, self._session.frame
        self._forget_question()
        self._context.notifications.withdraw(_QUESTION)
        if self._session.stuck:
            self._say_stuck(self._session.stuck)
        elif waiting is None and frame is not None and not frame.stages.body.pose.is_certain:
            self._say_unsure(tr("Check the orientation at the Scan step."))

    # -- inside

    def _shown_body(self) -> Body | None:
        frame = self._session.frame
        return (
            self._session.stuck.body
            if self._session.stuck
            else frame.stages.body
            if frame is not None
            else None
        )

    def _shown_up(self) -> str:
        body = self._shown_body()
        return body.pose.up if body is not None else "+z"

    def _forget_question(self) -> None:
        self._asked_for = None
        self._context.jobs.cancel(self._painting)
        self._painting = None
        self._context.view.question.hide()

    def _ask(self, body: Body, waiting: Design | None) -> None:
        """Have a picture painted for each way the body may stand."""
        self._asked_for = waiting
        if not body.pose.is_certain:
            self._say_unsure(tr("Choose an image below."))
        clay = QColor(APPEARANCES[tokens_of(self._context.window).dark].clay)
        colour, scale = (clay.red(), clay.green(), clay.blue()), self._context.view.devicePixelRatioF()
        size = round(PICTURE[0] * scale), round(PICTURE[1] * scale)
        self._context.jobs.cancel(self._painting)
        self._painting = self._context.jobs.run(
            tr("Rendering orientation options…"),
            lambda progress: option_thumbnails(body, size, colour, progress),
            self._show_question,
            self._show_no_question,
            left=self.leave_question,
        )

    def _show_question(self, painted: object) -> None:
        assert isinstance(painted, list)
        self._painting = None
        self._context.view.question.ask(
            [OrientationChoice(way.up, way.front, _image(picture), _words(way)) for way, picture in painted]
        )

    def _show_no_question(self, error: Exception) -> None:
        """Without pictures nothing can be chosen below: the Scan step asks the same."""
        logging.error("the pictures of the question failed", exc_info=error)
        self._painting = None
        self._say_unsure(tr("Check the orientation at the Scan step."))

    def _say_unsure(self, ask: str) -> None:
        self._context.notifications.withdraw(_QUESTION)
        unsure = tr("The scan orientation is ambiguous.")
        self._context.notifications.warn(unsure, ask, topic=_QUESTION)


def _words(way: OrientationOption) -> str:
    up, front = (axis.replace("-", "\N{MINUS SIGN}") for axis in way.axes)
    return tr("{up} up, {front} front").format(up=up, front=front)


def _image(picture: Picture) -> QImage:
    height, width, _ = picture.shape
    # The image only looks at the array: a copy of its own outlives it.
    return QImage(picture.tobytes(), width, height, 4 * width, QImage.Format.Format_RGBA8888).copy()
