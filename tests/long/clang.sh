#!/bin/bash
# The whole tree compiles with Clang without a warning, and the quick unit and ABI tests pass there
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
folder=${FW_LONG_FOLDER:?set FW_LONG_FOLDER to a folder for results}

# Skips device tests, which test the driver, and slow real meshes, which other suites run.
slow='Device|/device$|BothBackends|Backends(Agree|AndFrame)|^(DrawnMesh|HostFuzz|NetModelCorner)\.|^Seeds/HostFuzz'
slow+='|^Mesh(Bake|Front)\.(Bunny|BakesInstalled|TenRandom|SeamDelays|TenUnwraps)'

# An interrupted build resumes; a suite that passed is skipped.
export FW_WARNINGS_AS_ERRORS=ON
"$here/run" --clang --build
for suite in unit abi; do
    [[ ! -f $folder/$suite ]] || continue
    "$here/run" --clang --suite "$suite" --except "$slow"
    touch "$folder/$suite"
done
