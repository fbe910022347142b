"""The fitting report: layout and painting."""
