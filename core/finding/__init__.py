"""The rules behind the landmarks, one a room."""
