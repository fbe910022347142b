"""Scenes that are drawn off-screen, and the sample bodies as they are in their files."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest
import pyvista as pv

from app.presenters.samples import sample_path
from app.rendering.scene import Scene
from core.geometry.mesh import Mesh

MakeScene = Callable[..., Scene]


@pytest.fixture
def make_scene() -> Iterator[MakeScene]:
    """Make scenes of a width and height [px], without antialiasing; they are closed after the test."""
    plotters: list[pv.Plotter] = []

    def make(width: int = 300, height: int = 300) -> Scene:
        plotters.append(pv.Plotter(off_screen=True, window_size=[width, height], lighting="none"))
        plotters[-1].ren_win.SetMultiSamples(0)
        return Scene(plotters[-1])

    yield make
    for plotter in plotters:
        plotter.close()


@pytest.fixture
def scene(make_scene: MakeScene) -> Scene:
    """An empty scene."""
    return make_scene()


@pytest.fixture(scope="session")
def mannequin_mesh() -> Mesh:
    """The sample body as it is in its file: a smooth, watertight scan."""
    return _read("mannequin")


@pytest.fixture(scope="session")
def person_mesh() -> Mesh:
    """The sample body with the shape of a person as it is in its file."""
    return _read("person")


def _read(name: str) -> Mesh:
    shape = pv.read(sample_path(name))
    return Mesh(shape.points, shape.regular_faces)
