"""Routes: where lines run on the skin at rest, and on from there round the back or over the shoulder."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from core.control_mesh.back_length import Back
from core.control_mesh.fit import LOWER, ControlMesh
from core.control_mesh.skin_projection import points_on_skin
from core.control_mesh.straps import BAND, NO_TAIL, Tail, strap_tail
from core.document.lines import CustomLine
from core.geometry.mesh import Mesh, Points, frozen
from core.messages import Message

NO_BACK = NO_TAIL


@dataclass(frozen=True, eq=False)
class LineRoute:
    """The course of a line on the body at rest.

    ``path`` (k, 3) [mm] has a place for each vertex of the line. ``back`` (b, 3) [mm] goes on from its end:
    round the back to its beginning, or over the shoulder; it may be empty. A path that was ``drawn`` is kept
    as it is; one through control points is only where a band lies about. Open ends of a ``sewn`` one stay:
    those of slings meet at the back centre, in the air over the cleft, whose walls are no place for them.
    """

    path: Points
    back: Points = field(default_factory=lambda: NO_BACK)
    drawn: bool = False
    sewn: bool = False


def strap_tails(
    skin: Mesh, control: ControlMesh, own: tuple[CustomLine, ...], backs: Mapping[str, Back]
) -> dict[str, Tail]:
    """Return the tails of those ``own`` lines that go over the shoulder, by line; see ``straps``."""
    tails = {}
    for line in own:
        if line.over_shoulder:
            end = control.upper_end(line.name)
            if end @ control.held < 1.0 - 1e-9:
                problem = Message(
                    "The upper end is not fixed: extend the line to the edge of the control mesh."
                )
                tails[line.name] = Tail(0.0, NO_TAIL, problem=problem)
            else:
                tails[line.name] = strap_tail(skin, end @ control.mesh.vertices, backs[BAND].path)
    return tails


def line_routes(
    skin: Mesh, control: ControlMesh, backs: Mapping[str, Back], tails: Mapping[str, Tail]
) -> dict[str, LineRoute]:
    """Return the routes of all lines on a ``skin`` at rest, by line."""
    beyond = {name: back.path for name, back in backs.items()} | {name: t.path for name, t in tails.items()}
    routes = {}
    for name, path in control.paths.items():
        places = frozen(control.mesh.vertices[list(path)])
        routes[name] = LineRoute(places, beyond.get(name, NO_BACK), sewn=control.region == LOWER)
    for name, embedded in control.embedded.items():
        places = points_on_skin(skin, control.mesh, embedded.weights)
        routes[name] = LineRoute(frozen(places), beyond.get(name, NO_BACK), drawn=True)
    return routes
