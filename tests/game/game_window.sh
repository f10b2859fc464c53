#!/bin/bash
# Plays the tower-defence game with real keys and clicks in a window: places a tower, upgrades it,
# calls the wave, pauses, fast-forwards, resizes, rewinds ten seconds, sells and quits. Runs under the
# validation layer with synchronization checks.
# Usage: game_window.sh, with the build folder in FW_BUILD_FOLDER. 77: a requirement is missing.
# FW_KEEP_PICTURES: a folder for screenshots (ImageMagick).
set -euo pipefail
binary="${FW_BUILD_FOLDER:?set FW_BUILD_FOLDER to a build folder}/samples/tower_defence/tower_defence"
[[ -x $binary ]] || { echo "tower_defence is not built" && exit 77; }
# shellcheck source=../support/window.sh
source "$(dirname "${BASH_SOURCE[0]}")/../support/window.sh"
need Xvfb xdotool
open_display

# The centre of a plot, as reported by the game.
plot_place() { sed -n "s/^did: plot $1 at //p" "$work/log" | tail -1; }

start "$binary" --size 720x405
await "did: size 720x405"

xdotool key space
await "did: pause$"
read -r x y < <(plot_place 0)
xdotool key 1 mousemove "$x" "$y"
sleep 1
xdotool click 1
await "did: place 0$"
xdotool key u
await "did: upgrade 0$"
xdotool key u # 110 coins are left of 320, and the next level costs 120
await "did: upgrade 0: not enough coins"
picture placed
xdotool key Return
await "did: call wave"
xdotool key space
await "did: go on"
xdotool key f
await "did: speed 2"
xdotool key f
await "did: speed 4"
await "did: second 6$"
xdotool windowsize "$window" 800 450
await "did: size 800x450"
await "did: second 13$"
picture fight
xdotool key r
await "did: rewind [0-9]+ ticks"
back=$(sed -n 's/^did: rewind \([0-9]*\) ticks.*/\1/p' "$work/log")
# Ten seconds, plus at most the two between keyframes and the delay of the key.
[[ $back -ge 320 && $back -le 420 ]] || { echo "rewind went back $back ticks" && exit 1; }
await "did: second [3-5]$"
picture again
xdotool key x
await "did: sell 0$"
xdotool key x
await "did: sell 0: there is no tower"
leave Escape
grep -q "did: quit" "$work/log" || { echo "the game did not report that it quits" && exit 1; }
echo "placed, upgraded, paused, fast-forwarded, resized, rewound, sold and left"
