"""From a scan's file to a clean, upright body in millimetres."""
