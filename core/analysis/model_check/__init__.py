"""Comparison of the model with stored displacements of an independent finite-element model."""
