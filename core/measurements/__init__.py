"""Body measurements, breast volume and sizes."""
