"""Files for other programs: meshes, drawings, measurements, report data."""
