"""The 3D view: what is framed, its material, pictures of it."""
