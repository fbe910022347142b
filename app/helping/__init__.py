"""Helping: help, preferences, the tour, safe mode, facts about the machine."""
