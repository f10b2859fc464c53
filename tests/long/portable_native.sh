#!/bin/bash
# The same burn from other compilers and flags, and on a device
# build: flamewright_portable
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
folder=${FW_LONG_FOLDER:?set FW_LONG_FOLDER to a folder for results}
status=0
for row in gcc_O2 gcc_v3 gcc_v4 clang old_processor vulkan; do
    [[ ! -f $folder/$row ]] || continue  # passed in an interrupted run
    if bash "$here/portable/portable.sh" "$row"; then touch "$folder/$row"; else status=1; fi
done
exit "$status"
