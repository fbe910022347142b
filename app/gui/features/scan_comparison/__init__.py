"""Comparison with a scan of the worn garment."""
