"""Pictures drawn off-screen piece by piece: they are one picture, on the ground of the views or on none."""

import numpy as np
import pytest
import pyvista as pv
from PIL import Image

import app.rendering.offscreen as room
from app.presenters.lines import bands
from app.rendering.display import off_screen
from app.rendering.offscreen import OffscreenRenderer, with_background, with_transparency, write_picture
from app.rendering.scene import Scene
from core.errors import UserError
from core.pipeline.solve import solve
from core.progress import Cancelled, in_one_go

SIZE = (150, 180)


@pytest.fixture(scope="module")
def reshaped(built):
    stages = built("mannequin")
    return stages, solve(stages).region_points, bands(stages, ()), np.ones(len(stages.body.mesh.vertices))


@pytest.fixture
def studio(reshaped):
    with OffscreenRenderer(*reshaped) as studio:
        assert len(list(studio.set_up())) > 4, "a window answers between the parts"
        studio.frame_worn(SIZE, "three-quarter")
        yield studio


@pytest.mark.parametrize("parallel", [False, True])
def test_pieces_are_one_picture(monkeypatch, studio, parallel):
    studio.scene.set_parallel(parallel)
    whole = in_one_go(studio.render(SIZE)).astype(float)
    heard = []
    monkeypatch.setattr(room, "LONGEST", 100)
    pieces = in_one_go(studio.render(SIZE), lambda _, share: heard.append(share)).astype(float)
    assert len(heard) == 12
    assert heard == pytest.approx(np.arange(1, 13) / 12)
    assert pieces.shape == (180, 150, 4)
    assert np.abs(pieces - whole).mean() < 0.05
    assert (np.abs(pieces - whole).max(axis=2) > 12).mean() < 0.002  # some pixels of outlines


def test_it_is_what_the_views_draw(reshaped, studio):
    drawn = with_background(in_one_go(studio.render(SIZE)), dark=False).astype(float)
    stages, (points,), worn, occlusion = reshaped
    off_screen()
    plotter = pv.Plotter(off_screen=True, window_size=[2 * side for side in SIZE], lighting="none")
    try:
        plotter.ren_win.SetMultiSamples(0)
        scene = Scene(plotter)
        scene.show_body(stages.body.mesh)
        scene.set_occlusion(occlusion)
        scene.show_control_mesh(stages.control.mesh, stages.control.fixed)
        scene.show_bands(worn)
        scene.move_body(stages.moving.vertices, *stages.shape(points))
        scene.set_camera(studio.scene.view)
        seen = plotter.screenshot(return_img=True).astype(float)
    finally:
        plotter.close()
    seen = seen.reshape(180, 2, 150, 2, 3).mean(axis=(1, 3))
    assert np.abs(seen - drawn).max() < 3.0


def test_without_ground_only_the_body_is_solid_and_keeps_its_colours(tmp_path, studio):
    studio.scene.set_visible("floor", False)
    shot = in_one_go(studio.render(SIZE))
    write_picture(tmp_path / "p.png", shot, False, clear=True)
    with Image.open(tmp_path / "p.png") as picture:
        pixels = np.asarray(picture)
    assert picture.mode == "RGBA"
    solid = pixels[..., 3] == 255
    assert 0.3 < solid.mean() < 0.7
    assert (pixels[..., 3] == 0).mean() > 0.25
    assert not pixels[:4, :4, 3].any()
    np.testing.assert_array_equal(pixels[solid][:, :3], shot[solid][:, :3])
    # At its outline a body is of the colours of the body beside it: no rim of the ground is left.
    rim = (pixels[..., 3] > 60) & ~solid
    assert pixels[rim][:, 2].mean() < 225 < shot[~solid][:, 2].mean()


def test_a_picture_lies_whole_on_light_or_dark_ground(tmp_path, studio):
    shot = in_one_go(studio.render(SIZE))
    write_picture(tmp_path / "p.png", shot, False, clear=False)
    with Image.open(tmp_path / "p.png") as picture:
        assert (picture.mode, picture.size) == ("RGB", SIZE)
        pixels = np.asarray(picture).astype(float)
    assert pixels[0, 0] == pytest.approx([227, 224, 220], abs=3)  # LOOKS: the edge
    assert np.abs(pixels[..., :3] - with_background(shot, False)).max() == 0.0


def test_what_is_stopped_or_misnamed_leaves_no_file(tmp_path, studio):
    shot = with_transparency(in_one_go(studio.render((64, 64))), False)

    def stop(what, share):
        if share > 0.2:
            raise Cancelled

    with pytest.raises(Cancelled):
        write_picture(tmp_path / "p.png", shot, False, False, stop)
    with pytest.raises(UserError, match=r"ending in \.png"):
        write_picture(tmp_path / "p.jpg", shot, False, False)
    with pytest.raises(UserError, match="cannot be written"):
        write_picture(tmp_path / "missing" / "p.png", shot, False, False)
    assert list(tmp_path.iterdir()) == []
