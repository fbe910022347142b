"""Where the frozen program starts."""

import sys
from multiprocessing import freeze_support

if __name__ == "__main__":
    freeze_support()
    from app.cli.main import main

    sys.exit(main())
