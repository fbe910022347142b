"""What window, command line and report show, one module a feature. Without Qt."""
