"""A second scan of the same person with the garment on: aligned, compared, and the model fitted to it."""
