"""`fakesss tune`: a local page on which a scene is changed while it is looked at.

The browser keeps the *settings* (`wishes.Settings`): what differs from the scene that the tuner was started with. It
sends *wishes*, and gets each answered by one frame at most; the newest wish is drawn, those between are forgotten.
All pictures are drawn by one `studio.Studio` on one thread; each viewer has a loop of its own (`viewer`), so that
several look at the same time, each with their own camera.

A frame is a binary WebSocket message: four bytes, little-endian, with the length of a JSON header, the header
(`frames.Header`), and the bytes of a JPEG (while something moves) or of the very PNG that `fakesss render` writes.
"""
