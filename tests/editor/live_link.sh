#!/bin/bash
# An editor script pushes a scene to a sample change by change. Most changes apply in place within a
# frame, others start a new burn. The igniting flame is attached to a node of the file, which moves.
# In the end both burns are equal bit for bit, and the sample's picture equals the editor's viewport.
# Usage: live_link.sh, with the build folder in FW_BUILD_FOLDER. 77: a requirement is missing.
set -euo pipefail
build="${FW_BUILD_FOLDER:?set FW_BUILD_FOLDER to a build folder}"
editor=$build/editor/app/flamewright-editor sample=$build/samples/14_scene/14_scene
for program in "$editor" "$sample"; do
    [[ -x $program ]] || { echo "$program is not built" && exit 77; }
done
model=/usr/share/assimp/models/glTF2/BoxTextured-glTF-Binary/BoxTextured.glb
[[ -f $model ]] || { echo "$model is missing (package assimp-testmodels)" && exit 77; }
work=$(mktemp -d)
program=
trap '[[ -z $program ]] || kill "$program" 2>/dev/null || true; rm -rf "$work"' EXIT
export HOME=$work XDG_STATE_HOME=$work/state XDG_CACHE_HOME=$work/cache
unset DISPLAY WAYLAND_DISPLAY
cp "$model" "$work/box.glb"
fail() {
    cat "$work/log" "$work/script.log" 2>/dev/null || true
    echo "$1"
    exit 1
}

"$sample" --headless --validate --link 0 --seconds 2 --size 320x180 --out "$work/out" >"$work/log" 2>&1 &
program=$!
port=
for _ in $(seq 600); do
    port=$(sed -n 's/.*on local port \([0-9]*\).*/\1/p' "$work/log")
    [[ -z $port ]] || break
    sleep 0.1
done
[[ -n $port ]] || fail "the sample does not listen"

cat >"$work/edit.fws" <<TEXT
import box.glb name=Box materials pine map_size 256 texels_per_metre 128
set settings pace 30 duration 4
set camera target 0 0.1 0 distance 3 yaw 25 pitch 12
add source match name=Match position 0.3 -0.5 0 radius 0.15 sticks_to Box sticks_to_node "#1"
link $port
link wait
play 2
hash
set settings wind 2 0 0 daylight day
link wait
add layer multiplier name=Belt mesh Box
fill Belt value 0.4
link wait
hash
save "pushed.fwscene"
link off
TEXT
"$editor" --script "$work/edit.fws" --headless >"$work/script.log" 2>&1 || fail "the script does not run"
status=0
wait "$program" || status=$?
program=
[[ $status -eq 0 ]] || fail "the sample left with status $status"
if grep -E -q 'VUID-|UNASSIGNED-|SYNC-HAZARD|validation:' "$work/log"; then
    fail "the validation layer complains"
fi
mapfile -t hashes < <(grep '^Box: ' "$work/script.log")
[[ ${#hashes[@]} -eq 2 && ${hashes[0]} != "${hashes[1]}" ]] || fail "the changes do not change the fire"
grep -q -F -x "${hashes[1]}" "$work/log" || fail "the sample's fire is not the editor's"
grep -q -E '^scene 2 is shown after [12] frames?$' "$work/log" || fail "wind and light come late"

# The same scene in the editor's viewport, equal to the pixel except for flicker.
"$editor" --headless --page scene+bare --size 320x180 --scale 1 --seconds 2 --shot "$work/viewport.png" \
    "$work/pushed.fwscene" >>"$work/log" 2>&1 || fail "the editor takes no picture"
# The comparison works: equal while nothing changes, different in other light.
for shot in same other; do
    lines=
    [[ $shot == same ]] || lines='set settings daylight dusk light 0.2'
    "$editor" --headless --page scene+bare+beside --size 320x180 --scale 1 --seconds 1 \
        --shot "$work/$shot.png" --do "$lines" "$work/pushed.fwscene" >>"$work/log" 2>&1 ||
        fail "the editor takes no picture of a comparison"
done
cat >"$work/compare.fws" <<TEXT
expect alike "viewport.png" "out/scene.png" 0.01
expect halves "same.png" below 0.015
expect halves "other.png" above 0.02
TEXT
"$editor" --script "$work/compare.fws" --headless >>"$work/script.log" 2>&1 || fail "the pictures differ"
if [[ -n ${FW_KEEP_PICTURES:-} ]]; then cp "$work/viewport.png" "$work/out/scene.png" "$FW_KEEP_PICTURES/"; fi
grep -E 'is shown after' "$work/log"
echo "pushed and shown; equal burns: ${hashes[1]}"
