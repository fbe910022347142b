"""Opening, orienting and editing a scan."""
