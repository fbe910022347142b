"""Line lengths for a target shape."""
