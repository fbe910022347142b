"""Target shape: positions that the line lengths are computed for."""
