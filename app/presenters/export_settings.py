"""How the user has chosen to export, remembered as text: each thing, and each format of it, for itself."""

from __future__ import annotations

import json
from dataclasses import replace

from app.presenters.export_formats import Export, exports, settings_of, usual
from app.presenters.export_request import Manner
from app.presenters.model_options import Choice
from app.rendering.camera import View

_OF_FORMAT = ("unit", "axes")  # each program that opens a format asks for its own


class Choices:
    """What was chosen, from the ``text`` of a former session; what in it is no choice is forgotten."""

    def __init__(self, text: str) -> None:
        self._exports = {export.what: export for export in exports()}
        try:
            kept = json.loads(text)
        except ValueError:
            kept = {}
        self._kept: dict[str, object] = kept if isinstance(kept, dict) else {}

    @property
    def text(self) -> str:
        """All choices, to be remembered."""
        return json.dumps(self._kept)

    @property
    def export(self) -> Export:
        """What was exported last, at first the body."""
        return self.find(str(self._kept.get("what")))

    def find(self, what: str) -> Export:
        """Return what can be exported by its word, else the first."""
        return self._exports.get(what, next(iter(self._exports.values())))

    def choose_export(self, what: str) -> None:
        """Export something else."""
        self._kept["what"] = what

    def kind(self, what: str) -> str:
        """Return the format that was chosen for something."""
        formats, kept = self.find(what).formats, self._kept.get(f"{what}/format")
        return kept if isinstance(kept, str) and kept in formats else next(iter(formats))

    def settings(self, what: str) -> tuple[Choice, ...]:
        """Return what can be chosen for something in its format."""
        return settings_of(self.find(what), self.kind(what))

    def values(self, what: str, kind: str = "") -> dict[str, str]:
        """Return what is chosen for something, in its format or another ``kind``, by the keys of settings."""
        kind = kind or self.kind(what)
        chosen = {}
        for setting in settings_of(self.find(what), kind):
            kept = self._kept.get(_key(what, kind, setting.key))
            known = any(kept == value for value, _ in setting.options)
            chosen[setting.key] = str(kept) if known else usual(what, setting.key)
        return chosen | {"format": kind}

    def choose(self, what: str, key: str, value: str) -> None:
        """Remember one choice for something."""
        self._kept[_key(what, self.kind(what), key)] = value

    def manner(self, what: str, kind: str = "", view: View | None = None) -> Manner:
        """Return how to write something in its format or another ``kind``; ``view`` is the view now."""
        chosen = self.values(what, kind)
        manner = Manner(
            unit=chosen.get("unit"),
            axes=chosen.get("axes"),
            before=chosen.get("shape") == "before",
            dark=chosen.get("ground") == "dark",
            beside=chosen.get("shows") == "beside",
            clear=chosen.get("ground") == "clear",
            bands=chosen.get("bands") != "none",
        )
        if "size" in chosen:
            wide, high = chosen["size"].split("x")
            manner = replace(manner, size=(int(wide), int(high)))
        if "frames" in chosen:
            manner = replace(manner, frames=int(chosen["frames"]), seconds=float(chosen["seconds"]))
        if chosen.get("view", "now") != "now":
            return replace(manner, view=chosen["view"])
        return manner if view is None else replace(manner, view=view)


def _key(what: str, kind: str, key: str) -> str:
    return f"{what}.{kind}/{key}" if key in _OF_FORMAT else f"{what}/{key}"
