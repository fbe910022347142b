"""Diagnosis of a design and the steps' badges."""
