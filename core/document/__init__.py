"""The design and its document: lines, elastics, presets, text notation."""
