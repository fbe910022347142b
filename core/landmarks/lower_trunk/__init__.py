"""Landmarks of the lower trunk: waist, belly, hips, seat and the tops of the legs."""
