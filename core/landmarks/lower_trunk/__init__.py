"""Landmarks of the lower trunk: crotch, hip, waist, belly, buttocks, gluteal folds."""
