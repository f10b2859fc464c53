#!/bin/bash
# How the library's own flipbooks were baked: bake.sh path/to/flamewright_flipbook
set -euo pipefail
tool=$(realpath "$1")
cd "$(dirname "${BASH_SOURCE[0]}")"
"$tool" campfire campfire.fwbook --frames 32 --seconds 1.6 --size 64 --quiet
for scene in roll puff smoke haze; do
    "$tool" "$scene" "$scene.fwbook" --frames 16 --size 64 --quiet
done
"$tool" spark spark.fwbook --frames 8 --size 32 --quiet
