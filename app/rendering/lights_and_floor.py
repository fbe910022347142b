"""The stage round the body: background, lights and a soft floor."""

from __future__ import annotations

import numpy as np
import pyvista as pv
from vtkmodules.vtkRenderingCore import vtkViewport

from app.rendering.appearance import APPEARANCES, Appearance, rgb

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


class LightsAndFloor:
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
            texture=_shadow(APPEARANCES[False]),
            lighting=False,
            culling="back",
            name="floor",
            reset_camera=False,
            render=False,
        )
        self.floor.SetPickable(False)
        self.floor.SetVisibility(False)

    def set_appearance(self, look: Appearance) -> None:
        """Repaint background, lamps and floor for one theme."""
        for lamp, strength in zip(self._lamps, look.lights, strict=True):
            lamp.intensity = strength
        self._plotter.set_background(look.centre, top=look.edge)
        self._plotter.renderer.SetGradientMode(
            vtkViewport.GradientModes.VTK_GRADIENT_RADIAL_VIEWPORT_FARTHEST_CORNER
        )
        self.floor.SetTexture(_shadow(look))

    def place_floor(self, x: float, y: float, z: float) -> None:
        """Place the floor under a body whose lowest point is at height ``z``, centred at (x, y) [mm]."""
        self.floor.SetPosition(x, y, z - FLOOR_DROP)
        self.floor.SetVisibility(True)

    def show_floor(self, shown: bool) -> None:
        """Show or hide the shadow on the floor."""
        self.floor.SetVisibility(shown)


def _shadow(look: Appearance) -> pv.Texture:
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
