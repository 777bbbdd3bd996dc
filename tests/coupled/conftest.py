"""Makes the helpers of this folder importable: `independent_beam` and `small_models`."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
