#!/bin/bash
# Repeats a part of a game ten times with pictures and the validation layer. Memory must not grow after
# the first round, all rounds must end alike, and the last takes about as long as the first.
# Usage: game_soak.sh [MINUTES [MOST]]: minutes of all rounds (default 0.15), and the greatest ratio of
# processor time of the last to the first (default 1.6 for short rounds on a shared machine; 1.1 for
# ten minutes on an idle one), with the build folder in FW_BUILD_FOLDER.
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
awk "BEGIN { exit !($slower > 0 && $slower <= ${2:-1.6}) }" || { echo "the last round is too slow" && exit 1; }
