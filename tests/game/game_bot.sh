#!/bin/bash
# A game that a scripted player plays, with nobody watching: the result on the cpu backend and on
# the device is the same line, hash included, and another seed makes another game. One that goes ten
# seconds back on its way ends with the same line, too.
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
[[ $cpu =~ ^$over$ ]] || { echo "that is no result of a game with its first wave over" && exit 1; }
[[ $cpu == "$device" ]] || { echo "the backends do not agree" && exit 1; }
[[ $cpu != "$other" ]] || { echo "another seed makes the same game" && exit 1; }
# Ten seconds, and at most the two between moments.
[[ $back =~ rewind:\ (3[2-9][0-9])\ ticks && $back =~ $over ]] ||
    { echo "it did not go ten seconds back and play on to the end of the wave" && exit 1; }
[[ $back == *"$cpu"* ]] || { echo "what came after the ten seconds is another game" && exit 1; }
