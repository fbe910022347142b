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

READING = {
    "reading": (0.0, 0.3),
    "rebuilding the surface": (0.3, 0.6),
    "repairing": (0.6, 0.8),
    "finding up and front": (0.8, 0.9),
    "closing holes": (0.9, 0.92),
    "calming the skin": (0.92, 1.0),
}
"""Where each part of reading and editing a scan begins and ends, as shares of the time of both, roughly."""
