"""``python -m app`` is ``busk``."""

import sys

from app.cli import main

sys.exit(main())
