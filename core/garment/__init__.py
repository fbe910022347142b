"""The garment's bands: elastics, tension, cut list, contact pressure."""
