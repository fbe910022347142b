"""A cloud of points gets the skin it was taken from: in place, closed where it was, open where it was."""

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

from core.errors import ScanError
from core.geometry.mesh import Mesh
from core.progress import Cancelled
from core.scan.body import body_of
from core.scan.readers.raw_scan import RawScan
from core.scan.readers.registry import read_triangles
from core.scan.reconstruction.point_cloud import is_cloud, reconstruct_surface

SAMPLES = Path(__file__).parents[3] / "resources" / "samples"


def ball(count, noise=0.0, seed=1):
    """Points on a ball of radius 100."""
    chance = np.random.default_rng(seed)
    points = chance.normal(size=(count, 3))
    points *= 100.0 / np.linalg.norm(points, axis=1, keepdims=True)
    return points + noise * chance.normal(size=points.shape)


def cloud_file(points, normals=None):
    """A binary PLY file of points."""
    values = points if normals is None else np.concatenate([points, normals], axis=1)
    names = ("x", "y", "z", "nx", "ny", "nz")[: values.shape[1]]
    head = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(values)}\n"
    head += "".join(f"property float {name}\n" for name in names) + "end_header\n"
    return head.encode() + values.astype("<f4").tobytes()


@pytest.mark.parametrize(("count", "noise"), [(5000, 0.0), (20_000, 0.5)])
def test_points_of_a_ball_give_the_ball(count, noise):
    skin = Mesh(*reconstruct_surface(ball(count, noise)))
    radius = np.linalg.norm(skin.vertices, axis=1)
    assert np.abs(radius - 100.0).mean() < max(0.3 * noise, 0.1)
    assert skin.boundary_loops == ()
    assert len(skin.vertices) - len(skin.edges) + len(skin.faces) == 2  # Euler: nothing but one closed skin
    assert skin.enclosed_volume() == pytest.approx(4.0 / 3.0 * np.pi * 100.0**3, rel=0.004)


def test_an_open_skin_stays_open():
    points = ball(12_000, 0.3)
    skin = Mesh(*reconstruct_surface(points[points[:, 2] < 40.0]))
    assert len(skin.boundary_loops) == 1
    border = skin.vertices[skin.boundary_loops[0]]
    assert border[:, 2].min() > 36.0
    assert border[:, 2].max() < 50.0


def test_the_unit_of_the_points_does_not_matter():
    points = ball(6000, 0.5)
    vertices, faces = reconstruct_surface(points)
    small, same = reconstruct_surface(points / 1024.0)  # a power of two: not a digit changes
    assert np.array_equal(faces, same)
    assert np.allclose(vertices, 1024.0 * small, rtol=0.0, atol=1e-9)


def test_what_lies_alone_or_nowhere_is_left_out():
    chance = np.random.default_rng(2)
    dirt = [chance.uniform(-300.0, 300.0, (60, 3)), np.full((50, 3), np.nan), np.full((50, 3), 1e30)]
    skin = Mesh(*reconstruct_surface(np.concatenate([ball(10_000), *dirt])))
    assert np.abs(np.linalg.norm(skin.vertices, axis=1) - 100.0).max() < 25.0
    assert skin.enclosed_volume() == pytest.approx(4.0 / 3.0 * np.pi * 100.0**3, rel=0.01)


def test_two_skins_close_to_each_other_stay_two():
    points = np.concatenate([ball(8000), ball(8000, seed=3) + np.array([212.0, 0.0, 0.0])])
    skin = Mesh(*reconstruct_surface(points))
    assert len(skin.vertices) - len(skin.edges) + len(skin.faces) == 4
    assert skin.enclosed_volume() == pytest.approx(8.0 / 3.0 * np.pi * 100.0**3, rel=0.004)


def test_the_normals_of_a_file_tell_the_outside_if_they_are_true():
    points = ball(6000)
    volume = Mesh(*reconstruct_surface(points)).enclosed_volume()
    assert volume > 0.0
    assert Mesh(*reconstruct_surface(points, -points)).enclosed_volume() == pytest.approx(-volume)
    junk = np.random.default_rng(4).normal(size=points.shape)
    assert Mesh(*reconstruct_surface(points, junk)).enclosed_volume() == pytest.approx(volume)


@pytest.mark.parametrize(
    "points",
    [
        np.ones((3000, 3)),
        np.repeat([[0.0, 0.0, 0.0], [1.0, 1.0, 1.0]], 1500, axis=0),
        np.full((3000, 3), np.nan),
        np.outer(np.arange(3000.0), [1.0, 2.0, 3.0]),
        np.random.default_rng(0).normal(size=(3000, 3)),
        10.0 ** np.random.default_rng(0).uniform(-30, 8, (3000, 3)),
    ],
    ids=["one place", "two places", "nowhere", "line", "fog", "all sizes"],
)
def test_a_cloud_of_anything_else_is_refused(points):
    with pytest.raises(ScanError):
        body_of("fog.ply", cloud_file(points))


def test_a_noisy_cloud_of_a_body_gives_that_body(tmp_path):
    name = "person.ply"
    vertices, faces = read_triangles(name, (SAMPLES / name).read_bytes())
    true = Mesh(vertices, faces)
    noisy = vertices + np.random.default_rng(5).normal(size=vertices.shape)
    body = body_of("cloud.ply.gz", cloud_file(0.1 * noisy, true.vertex_normals))
    assert body.rebuilt
    assert body.name == "cloud"
    assert str(body.repairs[0]) == f"Reconstructed a surface from {len(vertices):,} points."
    assert (body.pose.unit, body.pose.up, body.pose.front) == ("cm", "+z", "-y")
    _, near = cKDTree(true.vertices).query(body.mesh.vertices)
    gap = np.einsum("ij,ij->i", body.mesh.vertices - true.vertices[near], true.vertex_normals[near])
    assert np.abs(gap).mean() < 0.6
    assert abs(gap.mean()) < 0.1


def test_a_mesh_of_a_small_part_of_its_points_is_a_cloud_and_stray_points_are_not():
    vertices, faces = read_triangles("person.ply", (SAMPLES / "person.ply").read_bytes())
    some = faces[(vertices[faces][:, :, 2] < vertices[:, 2].min() + 30.0).all(axis=1)]
    assert is_cloud(RawScan(vertices, some))
    assert not is_cloud(RawScan(vertices, faces[::4]))
    half = faces[(vertices[faces][:, :, 0] > 0.2 * np.ptp(vertices[:, 0])).all(axis=1)]
    assert not is_cloud(RawScan(vertices, half))  # cut away, but its points were left
    strays = np.random.default_rng(6).normal(size=(5000, 3))
    assert not is_cloud(RawScan(np.concatenate([vertices, strays]), faces))


@pytest.mark.parametrize(
    "stop_at", ["reading", "rebuilding the surface", "repairing", "finding up and front"]
)
def test_work_on_a_cloud_can_be_stopped_anywhere(stop_at):
    heard = []

    def hear(what: str, share: float) -> None:
        heard.append((what, share))
        if what == stop_at:
            raise Cancelled

    with pytest.raises(Cancelled):
        body_of("ball.ply", cloud_file(ball(3000)), progress=hear)
    assert heard[-1][0] == stop_at
    assert all(0.0 <= share <= 1.0 for _, share in heard)
