"""Write the table of case keys into the README: ``python -m tools.case_table README.md``."""

import re
import sys
from pathlib import Path

from crossview.cases.schema import table

path = Path(sys.argv[1])
text = path.read_text(encoding="utf-8")
found, count = re.subn(r"\| key \| value \|.*?(?=\n\n)", lambda _: table(), text, flags=re.DOTALL)
if count != 1:
    sys.exit(f"{path} has {count} tables of keys")
path.write_text(found, encoding="utf-8")
