"""One effect per module: a function from a scene to its declared node. GLSL files have the same stem."""
