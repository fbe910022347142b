"""Level curves of the trunk alone: over holes and gaps, without arms."""
