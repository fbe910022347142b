"""Meshes, plane sections, nearest points, mirroring, geodesics and the compiled kernels."""
