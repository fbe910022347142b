"""The 3D scene on any plotter, off-screen images, turntable, palette. Without Qt."""
