"""The body deformed with the control mesh (t-FFD)."""
