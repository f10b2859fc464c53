#!/bin/bash
# Each fuzzer for two minutes, from the corpus of earlier runs: no crash, leak, hang or undefined behaviour
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
"$here/run" --fuzz 120
