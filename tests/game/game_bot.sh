#!/bin/bash
# A scripted player plays a game without a window. The result line, hash included, is the same on the
# cpu backend and the device, and differs for another seed. A game that rewinds ten seconds on its way
# ends with the same line.
# Usage: game_bot.sh, with the build folder in FW_BUILD_FOLDER.
set -euo pipefail
binary="${FW_BUILD_FOLDER:?set FW_BUILD_FOLDER to a build folder}/samples/tower_defence/tower_defence"
[[ -x $binary ]] || { echo "tower_defence is not built" && exit 77; }
unset DISPLAY WAYLAND_DISPLAY

play() { "$binary" --headless --bot --waves 1 --backend "$@"; }
cpu=$(play cpu --seed 1)
device=$(play vulkan --seed 1)
other=$(play cpu --seed 2)
back=$(play cpu --seed 1 --rewind 2>&1)
printf '%s\n' "cpu     $cpu" "vulkan  $device" "seed 2  $other" "rewound $back"
over='game: stopped,.*waves 1, felled [1-9].*hash [0-9a-f]{16}'
[[ $cpu =~ ^$over$ ]] || { echo "the result does not show a completed first wave" && exit 1; }
[[ $cpu == "$device" ]] || { echo "the backends differ" && exit 1; }
[[ $cpu != "$other" ]] || { echo "another seed makes the same game" && exit 1; }
# Ten seconds, plus at most the two between keyframes.
[[ $back =~ rewind:\ (3[2-9][0-9])\ ticks && $back =~ $over ]] ||
    { echo "the game did not rewind ten seconds and finish the wave" && exit 1; }
[[ $back == *"$cpu"* ]] || { echo "the game after the rewind differs" && exit 1; }
