"""The 3D view and its tools."""
