"""Where the frozen program starts."""

import os
import sys
from multiprocessing import freeze_support

from platformdirs import user_cache_path

# An installed program cannot write where it lies: what numba compiles is kept among the user's caches.
os.environ.setdefault("NUMBA_CACHE_DIR", str(user_cache_path("Busk", appauthor=False) / "numba"))

if __name__ == "__main__":
    freeze_support()
    from app.cli import main

    sys.exit(main())
