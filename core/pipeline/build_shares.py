"""Shares of the time of a build that its stages take, for its progress."""

from __future__ import annotations

SHARES = {
    "read scan": 0.46,
    "edit scan": 0.04,
    "find landmarks": 0.1,
    "fit control mesh": 0.1,
    "bind body": 0.1,
}
"""What part of the time of a build the slow stages take, roughly."""

PARTS = {
    "reading": (0.0, 0.15),
    "rebuilding the surface": (0.15, 0.3),
    "repairing": (0.3, 0.4),
    "finding up and front": (0.4, 0.45),
    "closing holes": (0.45, 0.46),
    "calming the skin": (0.46, 0.5),
    "find landmarks": (0.5, 0.6),
}
"""Where each part of the first stages begins and ends, as shares of the time of a build, roughly."""

UNKNOWN = (0.0, 0.5)
"""The same for any other part of reading and editing a scan."""
