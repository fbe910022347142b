"""Light worked out at the vertices in place of each pixel: nearly the same, half as dear."""

from __future__ import annotations

from weakref import WeakSet

import pyvista as pv
from vtkmodules.vtkRenderingCore import VTK_FLAT

_LAMPS = 5

_HEARD = "".join(f"uniform vec3 lightColor{n}; uniform vec3 lightDirectionVC{n};\n" for n in range(_LAMPS))

_AT_VERTEX = (
    f"{_HEARD}uniform float specularPowerUniform; out vec3 litVS; out vec3 shineVS;\n",
    "  vec3 outward = normalize(normalVCVSOutput), eye = normalize(-vertexVCVSOutput.xyz);\n"
    "  litVS = vec3(0.0); shineVS = vec3(0.0);\n  float lit;\n"
    + "".join(
        f"""  lit = max(0.0, dot(outward, -lightDirectionVC{n}));
  litVS += lit * lightColor{n};
  shineVS += sign(lit) * lightColor{n}
    * pow(max(1e-5, dot(reflect(lightDirectionVC{n}, outward), eye)), specularPowerUniform);
"""
        for n in range(_LAMPS)
    ),
)
_AT_PIXEL = (
    "in vec3 litVS; in vec3 shineVS;\n",
    "  fragOutput0 = vec4(ambientColor + litVS * diffuseColor + shineVS * specularColor, opacity);\n",
)
"""VTK's own sum over the lamps (its //VTK::Light::Impl for directional light), at another place."""


class VertexLighting:
    """Switches the light of all that is smooth on one plotter; the stage's lamps must be on.

    What has no normals at its vertices stays as it is.
    """

    def __init__(self, plotter: pv.BasePlotter) -> None:
        self._plotter = plotter
        self._quick: WeakSet[pv.Actor] = WeakSet()
        self._used: tuple[bool, int] | None = None

    def use(self, quickly: bool) -> None:
        """Light at the vertices, or again at each pixel, as VTK does by default."""
        using = quickly, self._plotter.renderer.GetViewProps().GetMTime()
        if using == self._used:
            return
        self._used = using
        for actor in self._plotter.renderer.actors.values():
            if (actor in self._quick) != quickly and _is_smooth(actor):
                _switch(actor, quickly)
                (self._quick.add if quickly else self._quick.discard)(actor)


def _is_smooth(actor: object) -> bool:
    if (
        not isinstance(actor, pv.Actor)
        or not actor.prop.lighting
        or actor.prop.GetInterpolation() == VTK_FLAT
    ):
        return False
    data = actor.mapper.dataset
    return data is not None and data.GetPointData().GetNormals() is not None


def _switch(actor: pv.Actor, quickly: bool) -> None:
    shader = actor.GetShaderProperty()
    for place, at_vertex, at_pixel in zip(("Dec", "Impl"), _AT_VERTEX, _AT_PIXEL, strict=True):
        word = f"//VTK::Light::{place}"
        if quickly:
            shader.AddVertexShaderReplacement(word, True, at_vertex, False)
            shader.AddFragmentShaderReplacement(word, True, at_pixel, False)
        else:
            shader.ClearVertexShaderReplacement(word, True)
            shader.ClearFragmentShaderReplacement(word, True)
