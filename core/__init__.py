"""The method of Busk, without a window: one way only, from a scan to a reshaped body.

    scan -> Body -> Landmarks -> ControlMesh -> TensegrityModel + Lines + Volume -> iterations -> t-FFD

All lengths are millimetres. In the canonical frame z is up, the body faces -y, and +x is the subject's left.
``core`` never imports Qt; a test holds it to that.
"""

__version__ = "0.1.0"
