"""Runs of one design on many bodies, on Dask: no Qt."""
