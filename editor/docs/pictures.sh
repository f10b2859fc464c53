#!/bin/bash
# Renders the guide's pictures and those of the welcome page, headless: the target flamewright_guide runs it.
# Usage: pictures.sh [cards | pages], with the build folder in FW_BUILD_FOLDER.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
editor="${FW_BUILD_FOLDER:?set FW_BUILD_FOLDER to a build folder}/editor/app/flamewright-editor"
state=$(mktemp -d)
trap 'rm -rf "$state"' EXIT
export HOME=$state XDG_STATE_HOME=$state XDG_CACHE_HOME=${XDG_CACHE_HOME:-$state/cache}

cd "$state"

# page NAME PAGE SECONDS SCENE [LINES]: one picture of 1280 x 720, after the commands LINES.
page() {
    "$editor" --headless --size 1280x720 --scale 1 --shot "$here/$1.png" --page "$2" --seconds "$3" \
        --scene "$4" --do "${5:-}"
}
# card NAME SECONDS SCENE: the scene alone, in the size of the welcome page. The build embeds it, so
# rebuild afterwards.
card() {
    "$editor" --headless --size 360x223 --scale 1 --shot "$here/../app/cards/$1.png" --page scene+bare \
        --seconds "$2" --scene "$3"
}
mkdir -p "$here/../app/cards"
if [[ ${1:-} != pages ]]; then
    card burning_crate 9 "Burning crate"
    card campfire 3 "Campfire"
    card hand_torch 3 "Hand torch"
    card bonfire 4 "Bonfire"
    card candle 3 "Candle"
    card rune_fire 3 "Rune fire"
fi
[[ ${1:-} != cards ]] || exit 0

page welcome welcome 0 ""
page scene scene 9 "Burning crate"
page paint paint 0 "Burning crate" 'add layer multiplier mesh Crate name=Belt;'\
'stroke Belt size 0.07 value 0 path -0.25:0.28:0.27 0.25:0.28:0.27 0.27:0.28:-0.25;'\
'stroke Belt size 0.09 value 1.85 path -0.25:0.1:0.27 0.25:0.1:0.27'
page flame flame+points 2 "Campfire"
page export export 0 "Burning crate"
