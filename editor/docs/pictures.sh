#!/bin/bash
# Takes the guide's pictures anew, without a display: the target flamewright_guide runs it.
# Usage: pictures.sh, with the build folder in FW_BUILD_FOLDER.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
editor="${FW_BUILD_FOLDER:?set FW_BUILD_FOLDER to a build folder}/editor/app/flamewright-editor"
state=$(mktemp -d)
trap 'rm -rf "$state"' EXIT
export HOME=$state XDG_STATE_HOME=$state XDG_CACHE_HOME=${XDG_CACHE_HOME:-$state/cache}

cd "$state"

# page NAME PAGE SECONDS SCENE [LINES]: one picture of 1280 x 720, after those commands.
page() {
    "$editor" --headless --size 1280x720 --scale 1 --shot "$here/$1.png" --page "$2" --seconds "$3" \
        --scene "$4" --do "${5:-}"
}
page welcome welcome 0 ""
page scene scene 6 "Burning crate"
page paint paint 0 "Burning crate" 'add layer multiplier mesh Crate name=Belt;'\
'stroke Belt size 0.07 value 0 path -0.25:0.28:0.27 0.25:0.28:0.27 0.27:0.28:-0.25;'\
'stroke Belt size 0.09 value 1.85 path -0.25:0.1:0.27 0.25:0.1:0.27'
page flame flame+points 2 "Campfire"
page export export 0 "Burning crate"
