"""Seeing: everything that is drawn in 3D, on any pyvista plotter, without Qt."""
