"""Showing: the 3D view and the strip; plain values in, signals out."""
