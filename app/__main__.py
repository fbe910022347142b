"""``python -m app`` is ``busk``."""

import sys

from app.cli.main import main

sys.exit(main())
