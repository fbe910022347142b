"""Bands, elastics, tension and contact pressure."""
