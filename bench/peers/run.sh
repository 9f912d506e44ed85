#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The bench against MuJoCo and SOFA: bench/peers/run.sh [--json] [--help]. Everything runs on one thread.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
python=$here/../../build/python-env/bin/python
if ! "$python" -c 'import insula' 2>/dev/null; then
  echo "error: the Python package is not built: run ./insula build first" >&2
  exit 2
fi
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
exec "$python" -B "$here/peers.py" "$@"
