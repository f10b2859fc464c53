#!/bin/bash
# Runs 01_host_device with every combination of its switches under core and synchronization
# validation: primary and secondary command buffers, one and four samples, normal and reversed depth,
# both kinds of pacing, three encodings, one view and two. Each run must be silent and leave a picture.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
turn=1
for secondary in "" --secondary; do
    for msaa in "" --msaa; do
        for reversed in "" --reversed; do
            for target in linear srgb unorm; do
                # Pacing is independent of the others: every second run.
                turn=$((1 - turn))
                pacing=""
                [[ $turn -eq 0 ]] || pacing=--slot-pacing
                switches=()
                for switch in $secondary $msaa $reversed $pacing; do switches+=("$switch"); done
                [[ $target != srgb ]] || switches+=(--split)
                switches+=(--target "$target")
                echo "01_host_device ${switches[*]}"
                status=0
                "$here/sample.sh" 01_host_device headless "${switches[@]}" || status=$?
                [[ $status -eq 0 ]] || exit "$status"
            done
        done
    done
done
