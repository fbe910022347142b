"""The stage round the body: background, lights and a soft floor."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pyvista as pv
from vtkmodules.vtkRenderingCore import vtkViewport


@dataclass(frozen=True)
class Look:
    """Colours and strengths of the 3D view in one theme; they belong to no widget."""

    centre: str
    edge: str
    clay: str
    deep: str
    plaster: str
    ambient: float
    lights: tuple[float, ...]
    shadow: str
    shadow_alpha: float
    ghost: str
    wire: str


LOOKS: dict[bool, Look] = {
    False: Look(
        centre="#FBFAF9",
        edge="#E3E0DC",
        clay="#EDD8C9",
        deep="#B57E66",
        plaster="#D6D2CC",
        ambient=0.25,
        lights=(0.74, 0.32, 0.13, 0.34, 0.26),
        shadow="#3A302A",
        shadow_alpha=95.0,
        ghost="#AEBBD0",
        wire="#3F4650",
    ),
    True: Look(
        centre="#2E3036",
        edge="#16171A",
        clay="#E2CBBC",
        deep="#7A5244",
        plaster="#BDBAB5",
        ambient=0.16,
        lights=(0.83, 0.22, 0.14, 0.57, 0.46),
        shadow="#000000",
        shadow_alpha=190.0,
        ghost="#56657F",
        wire="#10141A",
    ),
}
"""The look by theme: ``LOOKS[dark]``."""

_LAMPS = (
    ((-0.55, 0.75, 1.0), "#FFF6EC"),  # key
    ((0.9, 0.15, 0.7), "#FFF4EC"),  # fill; a cool one makes skin grey
    ((0.0, -0.8, 0.6), "#FFE9DC"),  # light that the floor throws back
    ((0.9, 0.5, -0.9), "#FFFFFF"),  # two rims from behind, which draw the outline
    ((-0.9, 0.4, -0.9), "#FFFFFF"),
)

FLOOR_SIZE = (1050.0, 780.0)
"""Width and depth of the floor shadow [mm]."""

FLOOR_DROP = 6.0
"""How far the floor lies under the body [mm]."""


def rgb(colour: str) -> np.ndarray:
    """Return ``"#rrggbb"`` as three numbers 0..255, shape (3,)."""
    return np.array(list(bytes.fromhex(colour.lstrip("#"))), dtype=np.float64)


class Stage:
    """Background, five lamps that travel with the camera, and the floor, on one plotter."""

    def __init__(self, plotter: pv.BasePlotter) -> None:
        self._plotter = plotter
        self._lamps = [
            pv.Light(position=at, color=colour, light_type="camera light") for at, colour in _LAMPS
        ]
        # Nothing seen through lies behind something else seen through; to mix that in any order is dear.
        plotter.renderer.SetUseOIT(False)
        plotter.remove_all_lights()
        for lamp in self._lamps:
            plotter.add_light(lamp)
        self._quad = pv.Plane(i_size=FLOOR_SIZE[0], j_size=FLOOR_SIZE[1], i_resolution=1, j_resolution=1)
        self.floor = plotter.add_mesh(
            self._quad,
            texture=_shadow(LOOKS[False]),
            lighting=False,
            culling="back",
            name="floor",
            reset_camera=False,
            render=False,
        )
        self.floor.SetPickable(False)
        self.floor.SetVisibility(False)

    def set_look(self, look: Look) -> None:
        """Repaint background, lamps and floor for one theme."""
        for lamp, strength in zip(self._lamps, look.lights, strict=True):
            lamp.intensity = strength
        self._plotter.set_background(look.centre, top=look.edge)
        self._plotter.renderer.SetGradientMode(
            vtkViewport.GradientModes.VTK_GRADIENT_RADIAL_VIEWPORT_FARTHEST_CORNER
        )
        self.floor.SetTexture(_shadow(look))

    def stand(self, x: float, y: float, z: float) -> None:
        """Lay the floor under a body whose lowest point is at height ``z``, centred at (x, y) [mm]."""
        self.floor.SetPosition(x, y, z - FLOOR_DROP)
        self.floor.SetVisibility(True)

    def show_floor(self, shown: bool) -> None:
        """Show or hide the shadow on the floor."""
        self.floor.SetVisibility(shown)


def _shadow(look: Look) -> pv.Texture:
    """Return a soft round shadow that has faded out before the rim of the quad."""
    axis = np.linspace(-1.0, 1.0, 128)
    radius = np.hypot(*np.meshgrid(axis, axis))
    fade = np.exp(-((radius / 0.46) ** 2)) * np.clip((1.0 - radius) / 0.3, 0.0, 1.0)
    pixels = np.empty((128, 128, 4), dtype=np.uint8)
    pixels[..., :3] = rgb(look.shadow)
    pixels[..., 3] = look.shadow_alpha * fade
    texture = pv.Texture(pixels)
    texture.interpolate = True
    return texture
