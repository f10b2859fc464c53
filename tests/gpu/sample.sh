#!/bin/bash
# Runs one sample for a few small frames under the validation layer with synchronization checks.
# Usage: sample.sh NAME headless|window [SWITCH...], with the build folder in FW_BUILD_FOLDER. Fails on
# any validation message, and headless on a run that leaves no picture. The switches are the sample's.
set -euo pipefail
name=$1
mode=$2
shift 2
binary="${FW_BUILD_FOLDER:?set FW_BUILD_FOLDER to a build folder}/samples/$name/$name"
if [[ ! -x $binary ]]; then
    echo "$name is not built"
    exit 77
fi

# shellcheck source=../support/window.sh
source "$(dirname "${BASH_SOURCE[0]}")/../support/window.sh"

export VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation
export VK_LAYER_ENABLES=VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT
arguments=(--frames 6 --size 320x180 --seed 7 --out "$work/out" "$@")
case $name in
    02_burning_mesh)
        model=/usr/share/assimp/models/glTF2/BoxTextured-glTF-Binary/BoxTextured.glb
        [[ -f $model ]] || { echo "$model is missing (package assimp-testmodels)" && exit 77; }
        arguments+=("$model")
        ;;
esac
if [[ $mode == headless ]]; then
    unset DISPLAY WAYLAND_DISPLAY
    arguments+=(--headless)
else
    open_display
fi

status=0
timeout 300 "$binary" "${arguments[@]}" >"$work/log" 2>&1 || status=$?
cat "$work/log"
[[ $status -eq 0 ]] || { echo "$name left with status $status" && exit 1; }
if grep -E -q 'VUID-|UNASSIGNED-|SYNC-HAZARD|SPIR-V WARNING|Validation (Error|Warning)' "$work/log"; then
    echo "$name: the validation layer complains"
    exit 1
fi
# A server draws nothing: it leaves a save.
[[ $name != 13_server || -s $work/out/server.fwsave ]] || { echo "$name left no save" && exit 1; }
# Two processes with one fire leave their hashes instead of pictures.
if [[ $name == 12_multiplayer ]]; then
    cmp "$work/out/server.txt" "$work/out/client.txt" || { echo "$name left different hashes" && exit 1; }
fi
if [[ $mode == headless && $name != 12_multiplayer && $name != 13_server && -z $(find "$work/out" -name '*.png' -size +0 2>/dev/null) ]]; then
    echo "$name left no picture in --out"
    exit 1
fi
