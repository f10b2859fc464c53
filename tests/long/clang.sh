#!/bin/bash
# The whole tree compiles with Clang without a warning, and the quick unit and ABI tests pass there
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
folder=${FW_LONG_FOLDER:?set FW_LONG_FOLDER to a folder for results}

# Devices are the driver's work, and real meshes many seconds of our own code that others run, too.
slow='Device|/device$|BothBackends|Backends(Agree|AndFrame)|^(AbiDrawn|AbiFuzz|NetModelCorner)\.|^Seeds/AbiFuzz'
slow+='|^Mesh(Bake|Front)\.(Bunny|Models|TenRandom|P3_Seam|TenUnwraps)'

# A build that was stopped goes on with the files that are left; a suite that passed is not run again.
export FW_WARNINGS_AS_ERRORS=ON
"$here/run" --clang --build
for suite in unit abi; do
    [[ ! -f $folder/$suite ]] || continue
    "$here/run" --clang --suite "$suite" --except "$slow"
    touch "$folder/$suite"
done
