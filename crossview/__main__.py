"""``python -m crossview`` does what the command ``crossview`` does."""

import sys

from crossview_program import main

if __name__ == "__main__":
    sys.exit(main())
