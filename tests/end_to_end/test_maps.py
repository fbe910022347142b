"""Maps and the section plane in the real window."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from window_tools import Script, drag, run_main, settled

import app.gui.features.sections.controller as section_module
from app.gui.main_window import MainWindow
from app.rendering.appearance import appearance_of
from core.geometry.planar_curves import Curve, nearest

pytestmark = pytest.mark.usefixtures("empty_house")


def colours(window: MainWindow) -> np.ndarray:
    return window.view.viewport.scene.body.colours.astype(int)


def click_on(window: MainWindow, place: np.ndarray) -> None:
    view = window.view.viewport
    x, y, *_ = view.scene.view.to_picture(place[None], view.width(), view.height())[0]
    QTest.mouseClick(view.overlay.parentWidget(), Qt.MouseButton.LeftButton, pos=QPoint(round(x), round(y)))


def test_maps_show_the_right_values_with_a_range_by_hand_and_values_pinned() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        yield lambda: window.view.is_shaded
        clay, maps, legend = colours(window), window.maps_controller, window.maps_controller.legend
        window.view.set_layer("bands", False)
        yield from the_key_goes_through_all_maps_and_back(window, clay)
        maps.choose("displacement")
        frame, body = window.session.frame, window.view.viewport.scene.body
        assert frame is not None
        assert body is not None
        moving = frame.stages.moving
        normals = frame.stages.body.mesh.vertex_normals[moving.vertices]
        moved = ((frame.points - moving.rest) * normals).sum(axis=1)
        low, high = legend.bar.range_
        assert low == -high
        assert np.abs(moved).max() <= high <= 2.0 * np.abs(moved).max()
        most = int(moving.vertices[np.argmax(moved)])
        red, _, blue = colours(window)[most]
        assert red - blue > clay[most][0] - clay[most][2] + 20  # orange: outward

        legend.high.setText("50")
        legend.high.setModified(True)
        QTest.keyClick(legend.high, Qt.Key.Key_Return)
        assert legend.bar.range_ == (-50.0, 50.0)
        assert colours(window)[most][0] - colours(window)[most][2] < red - blue - 20  # far less of it
        legend.range_freed.emit()
        assert legend.bar.range_ == (low, high)

        window.view.viewport.set_view("front")
        click_on(window, body.shown_points[most])
        (flag,) = maps.flags.flags
        at = int(np.linalg.norm(body.shown_points - flag.place, axis=1).argmin())
        assert np.linalg.norm(flag.place - body.shown_points[most]) < 6.0
        value = moved[np.flatnonzero(moving.vertices == at)[0]]
        assert flag.text == f"{value:+.1f} mm"
        what_is_pinned_stays_when_the_map_changes(window)
        yield from a_dragged_slider_carries_map_and_flag(window, at)
        click_on(window, maps.flags.flags[0].place)
        assert maps.flags.flags == ()  # a click on a flag takes it away
        window.view.set_after(False)
        assert np.array_equal(colours(window), clay)  # at rest nothing has moved
        window.view.set_after(True)
        assert not np.array_equal(colours(window), clay)
        the_zero_of_a_map_is_the_material(window)
        the_sides_at_rest_are_worked_out_once(window)
        maps.choose("")
        assert np.array_equal(colours(window), clay)

    run_main([], script)


def what_is_pinned_stays_when_the_map_changes(window: MainWindow) -> None:
    maps = window.maps_controller
    (flag,) = maps.flags.flags
    maps.choose("strain")
    (other,) = maps.flags.flags
    assert np.array_equal(other.place, flag.place), "it tells the new map's value on the same spot"
    assert other.text.endswith("%")
    maps.choose("pull")
    assert maps.flags.flags == (), "the skin has no pull"
    maps.choose("displacement")
    assert [each.text for each in maps.flags.flags] == [flag.text]


def the_zero_of_a_map_is_the_material(window: MainWindow) -> None:
    window.view_controller.choose_material("graphite")
    stops = window.maps_controller.legend.bar._stops
    assert stops[len(stops) // 2] == appearance_of(window.view.viewport.scene.dark, "graphite").clay
    window.view_controller.choose_material("clay")


def the_sides_at_rest_are_worked_out_once(window: MainWindow) -> None:
    maps = window.maps_controller
    maps.choose("sides")
    now, asked = maps.now, []
    assert now is not None
    differ = now.sides.protrusion_difference
    now.sides.protrusion_difference = lambda *told: asked.append(len(told)) or differ(*told)  # type: ignore[method-assign]
    maps.pin(window.view.viewport.scene.body.shown_points[0], "")
    maps.set_range(-7.0, 7.0)
    maps.refresh()
    assert set(asked) == {3}, "only what moves is laid over the other side again"
    maps.free_range()


def the_key_goes_through_all_maps_and_back(window: MainWindow, clay: np.ndarray) -> Script:
    window.activateWindow()
    yield window.isActiveWindow
    seen = []
    shift, none = Qt.KeyboardModifier.ShiftModifier, Qt.KeyboardModifier.NoModifier
    for held in (none, shift, shift, none, none, shift, shift, shift, none):
        QTest.keyClick(window, Qt.Key.Key_C, held)
        seen.append(window.maps_controller.name)
        assert window.maps_controller.legend.isVisible() == bool(seen[-1])
        assert window.view.tools.actions_by_name["map"].isChecked() == bool(seen[-1])
        assert np.array_equal(colours(window), clay) == (seen[-1] in ("", "pull", "pressure"))
    assert seen[:5] == ["displacement", "strain", "sides", "", "sides"], "off in one, and back to the same"
    assert seen[5:] == ["pull", "pressure", "displacement", ""]
    assert window.view.viewport.scene.is_visible("bands")  # the map of the pull needs them
    window.view.set_layer("bands", False)


def a_dragged_slider_carries_map_and_flag(window: MainWindow, at: int) -> Script:
    flag = window.maps_controller.flags.flags[0]
    drag(window, "mid-bust", -30)
    yield settled(window)
    frame = window.session.frame
    assert frame is not None
    (now,) = window.maps_controller.flags.flags
    row = np.flatnonzero(frame.stages.moving.vertices == at)[0]
    assert now.place == pytest.approx(frame.points[row])
    normal = frame.stages.body.mesh.vertex_normals[at]
    assert now.text == f"{(frame.points[row] - frame.stages.moving.rest[row]) @ normal:+.1f} mm"
    assert now.text != flag.text


@pytest.fixture
def answered(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    path = tmp_path / "section.csv"
    monkeypatch.setattr(section_module, "ask_save", lambda *_: str(path))
    return path


def away_from(curves: tuple[Curve, ...], place: np.ndarray) -> float:
    foot = nearest(curves, place)
    assert foot is not None
    return float(np.linalg.norm(foot.place - place))


@pytest.mark.usefixtures("fine_samples")
def test_the_section_plane_cuts_before_and_after(answered: Path) -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        section, panel, scene = (
            window.sections_controller,
            window.sections_controller.panel,
            window.view.viewport.scene,
        )
        window.activateWindow()
        yield window.isActiveWindow
        QTest.keyClick(window, Qt.Key.Key_P)
        assert panel.isVisible()
        assert window.view.tools.actions_by_name["section"].isChecked()
        frame = window.session.frame
        assert frame is not None
        bust = frame.stages.landmarks.position("bust_point_left")
        assert scene.section.curve[:, 0] == pytest.approx(bust[0], abs=1e-3)
        before, after = (
            np.concatenate([c.places for c in section.curves[role]]) for role in ("before", "after")
        )
        lift = frame.marks.bust_point_left_z - frame.stages.rest_marks.bust_point_left_z
        assert panel.readout.text().startswith(f"Bust point left: {lift:.1f} mm up, ")
        ((at_rest, lifted),) = panel.plot._drawn.marks
        assert lifted[1] - at_rest[1] == pytest.approx(lift)
        assert away_from(section.curves["before"], at_rest) < 0.05
        assert away_from(section.curves["after"], lifted) < 1.0, "but that it left the plane by 1.2 mm"
        at = int(np.abs(after[:, 1] - bust[2] + 25.0).argmin())
        panel.plot.pointed.emit(after[at])
        gap = float(panel.plot.gap.split()[0].replace("−", "-"))
        assert abs(gap) == pytest.approx(np.linalg.norm(before - after[at], axis=1).min(), abs=0.3)

        drag(window, "mid-bust", -30)
        yield settled(window)
        moved = np.concatenate([c.places for c in section.curves["after"]])
        assert np.abs(moved[:, 0].max() - after[:, 0].max()) > 0.05  # live
        assert scene.section.curve[:, 0] == pytest.approx(bust[0], abs=1e-3)

        panel.through_requested.emit("right")
        right = frame.stages.landmarks.position("bust_point_right")
        assert panel.place.text() == f"{right[0]:.1f}".replace("-", "−")
        panel.axis_chosen.emit("z")
        panel.slider.setValue(round(2 * (right[2] - 30.0)))
        assert scene.section.curve[:, 2] == pytest.approx(right[2] - 30.0, abs=0.3)
        window.maps_controller.choose("sides")
        assert set(section.curves) == {"before", "after", "other"}
        panel.export.trigger()
        with open(answered, newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        assert {row["body"] for row in rows} == {"before", "after", "other"}
        written = [float(row["x_mm"]) for row in rows if row["body"] == "after"]
        assert written == pytest.approx(section.curves["after"][0].places[:, 0].tolist(), abs=1e-3)
        window.view.compare_by("wipe")
        beside = window.view.beside.bodies[1].viewport.scene
        assert np.abs(beside.section.curve[:, 2] - right[2] + 30.0).max() < 0.3  # cut at rest there
        window.view.set_after(True)
        QTest.keyClick(window, Qt.Key.Key_P)
        assert not panel.isVisible()
        assert not scene.plotter.actors["section curve"].GetVisibility()

    run_main([], script)
