"""What the window does about the scan: how it was understood, and the question how it stands."""

from __future__ import annotations

import logging
from dataclasses import replace
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject
from PySide6.QtGui import QColor, QImage

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
from core.scan.edits import ScanEdits
from core.scan.orientation.lean_angles import corrected_up

if TYPE_CHECKING:
    from app.gui.main_window import MainWindow

_QUESTION = "how the scan stands"
"""What a notice is about that asks for an answer, or says that there is none."""


class ScanDesk(QObject):
    """Brings what was understood of a scan to the window, and what the user knows better to the session.

    ``stuck`` is what keeps the scan that is shown from being a document, until the user knows better; never
    while a document is open, for that is what is shown then.
    """

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._session = window.session
        self._asked_for: Design | None = None
        self.stuck: IncompleteBuildError | None = None
        self._stages: Stages | None = None
        self._painting: Job | None = None

    @property
    def painting(self) -> bool:
        """Whether the question's pictures are being painted."""
        return self._painting is not None

    # -- the session speaks

    def show_found(self, stages: Stages) -> None:
        """Show what was understood of the scan, and found on it."""
        window = self._window
        window.scan.set_scan(scan_view(stages.design.scan, stages.body, landmarks=stages.landmarks))
        sure = stages.body.pose.is_certain and not stages.landmarks.size_doubted
        window.navigation.mark_step("scan", "done" if sure else "look", 1)
        window.landmark_desk.show_found(stages)

    def show_opened(self, frame: Frame) -> None:
        """Show what is unclear on a scan that was opened, and ask for its orientation if need be."""
        self._check_pose(frame.stages)
        for sentence in warnings(frame.stages):
            self._window.notifications.warn(sentence, topic=SCAN)

    def show_frame(self, frame: Frame) -> None:
        """Show what was found on the scan of a frame, if it is another one; warnings that are over go."""
        former, self._stages = self._stages, frame.stages
        if former is None or frame.stages.landmarks is not former.landmarks:
            self.show_found(frame.stages)
        if former is not None and frame.stages.control is not former.control:
            self._window.notifications.keep_only(SCAN, warnings(frame.stages))

    def _check_pose(self, stages: Stages) -> None:
        self._forget_question()
        self.stuck = None
        self._window.landmark_desk.show_unclear(stages)
        pose, source = stages.body.pose, stages.design.scan
        if pose.is_certain:
            return
        if source.up and source.front:
            unsure = tr("Busk is not sure of the unit, up or front of this scan.")
            self._window.notifications.warn(unsure, pose.reason, topic=_QUESTION)
        else:
            self._ask(stages.body, None)

    def show_stuck(self, stuck: IncompleteBuildError) -> None:
        """Show a scan that cannot go on if no document is open; ask how it stands if that is not sure."""
        self._forget_question()
        asked = self.stuck is not None and self.stuck.design.scan is stuck.design.scan
        if self._session.design is None:
            self._show_alone(stuck)
        if stuck.kind == "unsure" and not asked:
            self._ask(stuck.body, stuck.design)
        else:
            self._say_stuck(stuck)

    def _show_alone(self, stuck: IncompleteBuildError) -> None:
        """Show a scan that cannot go on in the place of a document."""
        window, self.stuck = self._window, stuck
        lacks = stuck.kind == "landmarks"
        window.landmark_desk.show_stuck(stuck)
        window.scan.set_scan(scan_view(stuck.design.scan, stuck.body, stuck.kind != "refused"))
        window.view.show_stuck(stuck.body, stuck.landmarks)
        window.navigation.show_step("landmarks" if lacks else "scan")
        window.navigation.mark_step("scan", "done" if lacks else "look")

    def _say_stuck(self, stuck: IncompleteBuildError) -> None:
        notifications = self._window.notifications
        notifications.withdraw(REFUSED)
        notifications.show("bad", stuck.message, stuck.hint, lasting=True, topic=REFUSED)

    # -- the user asks

    def tell(self, key: str, value: str) -> None:
        """Read the scan again with its unit, up or front as told; an empty key forgets what was told."""
        design = self.stuck.design if self.stuck else self._session.design
        if design is None:
            return
        scan = design.scan
        if not key:
            text, scan = tr("Unit, up and front as found"), scan.set_up(unit=None, up=None, front=None)
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
        self._rotate(up, tr("Stand upright"))

    def _rotate(self, up: str, text: str) -> None:
        design = self.stuck.design if self.stuck else self._session.design
        if design is not None:
            self._read_again(design.scan.set_up(up=up), text)

    def edit(self, edits: ScanEdits, text: str) -> None:
        """Edit the scan as one undo step named ``text``."""
        design = self.stuck.design if self.stuck else self._session.design
        if design is not None:
            self._read_again(replace(design.scan, edits=edits), text)

    def show_refused(self) -> None:
        """Show the scan as it is after an edit that was refused."""
        frame, design = self._session.frame, self._session.design
        if frame is not None and design is not None and not self.stuck:
            self.show_found(frame.stages)

    def _read_again(self, scan: ScanSource, text: str) -> None:
        if self.stuck:
            self._session.open_design(replace(self.stuck.design, scan=scan))
        else:
            self._session.change({"scan": scan}, text)

    def ask(self) -> None:
        """Show the pictures for the present scan."""
        frame = self._session.frame
        if self.stuck:
            self._ask(self.stuck.body, self.stuck.design)
        elif frame is not None:
            self._ask(frame.stages.body, None)

    def answer(self, up: str, front: str) -> None:
        """Take the answer: the open scan is read again as one undo step, one that waits is opened."""
        waiting, design = self._asked_for, self._session.design
        self._forget_question()
        self._window.notifications.withdraw(_QUESTION)
        if waiting is not None:
            # What is open may have been edited while the question waited.
            if self._window.project_controller.may_leave():
                self._session.open_design(replace(waiting, scan=waiting.scan.set_up(up=up, front=front)))
        elif design is not None:
            self._session.change(
                {"scan": design.scan.set_up(up=up, front=front)}, tr("Front chosen by its picture")
            )

    def leave_question(self) -> None:
        """Leave a scan as it is understood; one that waited for the answer is let go, if it is not shown."""
        waiting, frame = self._asked_for, self._session.frame
        self._forget_question()
        self._window.notifications.withdraw(_QUESTION)
        if self.stuck:
            self._say_stuck(self.stuck)
        elif waiting is None and frame is not None and not frame.stages.body.pose.is_certain:
            self._say_unsure(tr("Please check it at the Scan step."))

    # -- inside

    def _shown_body(self) -> Body | None:
        frame = self._session.frame
        return self.stuck.body if self.stuck else frame.stages.body if frame is not None else None

    def _shown_up(self) -> str:
        body = self._shown_body()
        return body.pose.up if body is not None else "+z"

    def _forget_question(self) -> None:
        self._asked_for = None
        self._window.jobs.cancel(self._painting)
        self._painting = None
        self._window.view.question.hide()

    def _ask(self, body: Body, waiting: Design | None) -> None:
        """Have a picture painted for each way the body may stand."""
        self._asked_for = waiting
        if not body.pose.is_certain:
            self._say_unsure(tr("Please choose a picture below."))
        clay = QColor(APPEARANCES[tokens_of(self._window).dark].clay)
        colour, scale = (clay.red(), clay.green(), clay.blue()), self._window.devicePixelRatioF()
        size = round(PICTURE[0] * scale), round(PICTURE[1] * scale)
        self._window.jobs.cancel(self._painting)
        self._painting = self._window.jobs.run(
            tr("Painting how the scan may stand"),
            lambda progress: option_thumbnails(body, size, colour, progress),
            self._show_question,
            self._show_no_question,
            left=self.leave_question,
        )

    def _show_question(self, painted: object) -> None:
        assert isinstance(painted, list)
        self._painting = None
        self._window.view.question.ask(
            [OrientationChoice(way.up, way.front, _image(picture), _words(way)) for way, picture in painted]
        )

    def _show_no_question(self, error: Exception) -> None:
        """Without pictures nothing can be chosen below: the Scan step asks the same."""
        logging.error("the pictures of the question failed", exc_info=error)
        self._painting = None
        self._say_unsure(tr("Please check it at the Scan step."))

    def _say_unsure(self, ask: str) -> None:
        self._window.notifications.withdraw(_QUESTION)
        unsure = tr("Busk is not sure how this scan stands.")
        self._window.notifications.warn(unsure, ask, topic=_QUESTION)


def _words(way: OrientationOption) -> str:
    up, front = (axis.replace("-", "\N{MINUS SIGN}") for axis in way.axes)
    return tr("{up} up, {front} front").format(up=up, front=front)


def _image(picture: Picture) -> QImage:
    height, width, _ = picture.shape
    # The image only looks at the array: a copy of its own outlives it.
    return QImage(picture.tobytes(), width, height, 4 * width, QImage.Format.Format_RGBA8888).copy()
