#!/bin/bash
# Kills the editor (kill -9) at random times while an artist works and saves. The scene's file always
# opens and holds every reported save. The recovery copy always opens too and lacks at most the time
# between two copies, which is 1 s here instead of 20 s, so that kills also hit the writing of copies.
# Usage: editor_killed.sh [TIMES], with the build folder in FW_BUILD_FOLDER; 5 unless given. 77:
# a requirement is missing.
set -euo pipefail
times=${1:-5}
build="${FW_BUILD_FOLDER:?set FW_BUILD_FOLDER to a build folder}"
binary=$build/editor/app/flamewright-editor
[[ -x $binary ]] || { echo "flamewright-editor is not built" && exit 77; }
# shellcheck source=../support/window.sh
source "$(dirname "${BASH_SOURCE[0]}")/../support/window.sh"
need Xvfb xdotool
export HOME=$work XDG_STATE_HOME=$work/state XDG_CACHE_HOME=$work/cache
open_display
every=1 allowed=30 usual=20 # s: between copies here; allowed loss; default between copies
copies=$work/state/flamewright
cd "$work"

# opens FILE: in the editor, which reads its images too.
opens() {
    echo "open \"$1\"" >open.fws
    "$binary" --script open.fws --headless >open.log 2>&1 && ! grep -q -i 'repair\|cannot be read' open.log ||
        { cat open.log && echo "$1 does not open" && exit 1; }
}
events() { grep -c '"name": "Event' "$1" || true; }
milliseconds() { echo $((${EPOCHREALTIME/[.,]/} / 1000)); }

cp /usr/share/assimp/models/glTF2/BoxTextured-glTF-Binary/BoxTextured.glb box.glb 2>/dev/null ||
    { echo "box.glb is not here (package assimp-testmodels)" && exit 77; }
cat >begin.fws <<'TEXT'
import box.glb name=Box map_size 128 texels_per_metre 32
add layer multiplier name=Belt mesh Box size 256
fill Belt value 0.4
save "begin.fwscene"
TEXT
"$binary" --script begin.fws --headless >begin.log 2>&1 || { cat begin.log && exit 1; }

worst=0 found=0
for ((time = 1; time <= times; ++time)); do
    rm -rf scene copies_before && mkdir -p scene && rm -f "$copies"/recovery-*
    cp begin*.png box.glb scene/
    cp begin.fwscene scene/scene.fwscene
    start "$binary" --autosave "$every" scene/scene.fwscene
    await "did: Opened scene.fwscene"
    # Steps and saves as fast as the editor takes them, for 0.3 to 3.3 s.
    pressed=()
    stop=$(($(milliseconds) + 300 + RANDOM % 3000))
    while (($(milliseconds) < stop)); do
        pressed+=("$(milliseconds)")
        xdotool key m
        ((RANDOM % 12)) || xdotool key ctrl+s
        sleep 0.0$((RANDOM % 9))
    done
    killed=$(milliseconds)
    kill -9 "$program"
    wait "$program" 2>/dev/null || true
    program=
    opens scene/scene.fwscene
    kept=$(events scene/scene.fwscene)
    reported=$(awk '/did: Add event/ { ++steps } /did: Saved/ { saved = steps } END { print saved + 0 }' log)
    ((kept >= reported)) || { echo "$reported events were reported as saved, $kept are in the file" && exit 1; }
    for copy in "$copies"/recovery-*.fwscene; do
        [[ -s $copy ]] || continue
        opens "$copy"
        found=$((found + 1))
        [[ $(events "$copy") -le $kept ]] || kept=$(events "$copy")
    done
    lost=0
    ((kept >= ${#pressed[@]})) || lost=$((killed - pressed[kept]))
    ((lost <= worst)) || worst=$lost
    echo "$time: ${#pressed[@]} steps, $kept kept, $lost ms lost"
done
((found > 0 || times < 5)) || { echo "no copy was ever kept" && exit 1; }
echo "killed $times times: nothing is corrupt, at most $worst ms lost with a copy every $every s ($found copies)"
((worst + 1000 * (usual - every) <= 1000 * allowed)) || { echo "more than $allowed s may be lost" && exit 1; }
