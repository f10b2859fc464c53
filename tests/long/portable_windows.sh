#!/bin/bash
# The same burn on Windows
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
bash "$here/portable/portable.sh" windows
