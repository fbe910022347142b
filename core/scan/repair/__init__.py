"""Repair of a scan's surface: holes, loose pieces, noise, hidden layers."""
