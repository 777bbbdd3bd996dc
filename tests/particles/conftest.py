"""Makes the helpers of this folder importable: `discs` and `dense_reference`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
