"""Uncertainty of results, propagated from landmarks, scan, tissue and lines."""
