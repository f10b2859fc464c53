#!/bin/bash
# The game looks the same in a window and without one: a windowed game with real input is recorded, and
# screenshots of its pauses are compared with pictures of the same game without a window.
# Usage: game_pictures.sh, with the build folder in FW_BUILD_FOLDER. 77: a requirement is missing.
set -euo pipefail
binary="${FW_BUILD_FOLDER:?set FW_BUILD_FOLDER to a build folder}/samples/tower_defence/tower_defence"
[[ -x $binary ]] || { echo "tower_defence is not built" && exit 77; }
# shellcheck source=../support/window.sh
source "$(dirname "${BASH_SOURCE[0]}")/../support/window.sh"
need Xvfb xdotool import compare
most_away=0.1 # percent of pixels that may be away by more than a twentieth

# shoot NAME: pauses, waits for a still picture, saves it, continues.
shoot() {
    xdotool key space
    await "did: stands still$"
    import -window "$window" "$work/window_$1.png"
    xdotool key space
    await "did: go on"
}

open_display
start "$binary" --size 480x270 --fps 10 --record "$work/inputs"
await "did: size 480x270"
read -r x y < <(sed -n "s/^did: plot 0 at //p" "$work/log" | tail -1)
xdotool key 2 mousemove "$x" "$y" # a mortar, which reaches far
sleep 0.5
xdotool click 1
await "did: place 0$"
xdotool key u
await "did: upgrade 0$"
shoot placed
xdotool key Return
await "did: call wave"
xdotool key f
await "did: speed 2"
xdotool key f
await "did: second 16$"
shoot fight
xdotool key n
await "did: second 18$"
shoot light
leave Escape

mkdir "$work/played"
"$binary" --headless --play "$work/inputs" --size 480x270 --out "$work/played" >"$work/play.log" 2>&1 ||
    { cat "$work/play.log" && exit 1; }
mapfile -t pictures < <(find "$work/played" -name '[0-9]*.png' | sort -V)
[[ ${#pictures[@]} -eq 3 ]] || { echo "${#pictures[@]} pictures of three pauses" && exit 1; }
status=0
i=0
for name in placed fight light; do
    away=$(compare -metric AE -fuzz 5% "$work/window_$name.png" "${pictures[i]}" "$work/away_$name.png" 2>&1) ||
        [[ $? -eq 1 ]]
    share=$(awk "BEGIN { print 100 * $away / (480 * 270) }")
    echo "$name: $share % of the pixels differ"
    awk "BEGIN { exit !($share <= $most_away) }" || status=1
    if [[ -n ${FW_KEEP_PICTURES:-} ]]; then
        cp "$work/window_$name.png" "$work/away_$name.png" "$FW_KEEP_PICTURES/"
        cp "${pictures[i]}" "$FW_KEEP_PICTURES/headless_$name.png"
    fi
    i=$((i + 1))
done
# The three pictures must differ, otherwise the comparison shows nothing.
for other in fight light; do
    away=$(compare -metric AE -fuzz 5% "$work/window_placed.png" "$work/window_$other.png" null: 2>&1) || [[ $? -eq 1 ]]
    awk "BEGIN { exit !($away > 0.01 * 480 * 270) }" || { echo "$other looks like placed" && status=1; }
done
exit $status
