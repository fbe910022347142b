"""Translated texts, number and length formats, search terms. Without Qt."""
