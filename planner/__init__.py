"""One thread for linear algebra, set before numpy is loaded.

Sums over a belief's cells are too short to share out: on a busy machine OpenBLAS' threads wait for each other many
times as long, and how a sum is rounded must not depend on the number of cores.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
