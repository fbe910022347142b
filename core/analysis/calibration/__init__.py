"""Tissue and line stiffness fitted to a scan of the worn garment."""
