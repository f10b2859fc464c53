#!/bin/bash
# A stretch of a game, ten times over, with pictures and the validation layer: memory at the end is what
# it was after the first, each comes out alike, and the last takes about as long as the first.
# Usage: game_soak.sh [MINUTES [MOST]], of the ten rounds together (default 0.15), and what part of the
# first one's processor time the last may take (default 1.6, as others use the machine and rounds are
# short; by itself, over ten minutes: 1.1), with the build folder in FW_BUILD_FOLDER.
set -euo pipefail
binary="${FW_BUILD_FOLDER:?set FW_BUILD_FOLDER to a build folder}/samples/tower_defence/tower_defence"
[[ -x $binary ]] || { echo "tower_defence is not built" && exit 77; }
unset DISPLAY WAYLAND_DISPLAY
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
status=0
"$binary" --headless --validate --soak "${1:-0.15}" --size 192x108 --out "$out" >"$out/log" 2>&1 ||
    status=$?
cat "$out/log"
if grep -E -q 'VUID-|UNASSIGNED-|SYNC-HAZARD|validation:' "$out/log"; then
    echo "the validation layer complains" && exit 1
fi
[[ $status -eq 0 ]] || exit "$status"
slower=$(sed -n 's/^processor time: the last is \(.*\) of the first$/\1/p' "$out/log")
awk "BEGIN { exit !($slower > 0 && $slower <= ${2:-1.6}) }" || { echo "it became slower" && exit 1; }
