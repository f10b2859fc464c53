#!/bin/bash
# The tools for job runners: fw-info, fw-cook, fw-bake, fw-shot. Checks help, exit codes and the JSON
# line per written file, and that split work gives the same files as work in one run.
# Usage: scene_tools.sh, with the build folder in FW_BUILD_FOLDER. 77: a requirement is missing.
set -euo pipefail
build="${FW_BUILD_FOLDER:?set FW_BUILD_FOLDER to a build folder}"
tools=$build/editor/tools script=$build/editor/script/fw-script
for program in "$script" "$tools"/fw-{info,cook,bake,shot}; do
    [[ -x $program ]] || { echo "$program is not built" && exit 77; }
done
model=/usr/share/assimp/models/glTF2/BoxTextured-glTF-Binary/BoxTextured.glb
[[ -f $model ]] || { echo "$model is missing (package assimp-testmodels)" && exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export HOME=$work XDG_STATE_HOME=$work/state XDG_CACHE_HOME=$work/cache
cd "$work"
cp "$model" box.glb
fail() {
    cat out.txt err.txt 2>/dev/null || true
    echo "$1"
    exit 1
}
# exits CODE COMMAND...: expects the exit code; output goes to out.txt and err.txt.
exits() {
    local status=0
    "${@:2}" >out.txt 2>err.txt || status=$?
    [[ $status -eq $1 ]] || fail "$(basename "$2") ${*:3} left with $status, not $1"
}
json() {
    [[ -s out.txt ]] || fail "$1 wrote no JSON"
    ! grep -v -q -E \
        '^\{("[a-z_]+": ("[^"]*"|-?[0-9][0-9.e+-]*|\[("[^"]*"(, )?)*\])(, )?)+\}$' out.txt ||
        fail "$1 wrote a line that is no JSON"
}

cat >scene.fws <<'TEXT'
import box.glb name=Near materials pine map_size 64 texels_per_metre 16
import box.glb name=Far materials pine map_size 64 texels_per_metre 16 position 0 0 3
set settings pace 30 duration 2 frames_per_second 8
add source match name=Match position 0 0 0.5 radius 0.2
set camera target 0 0 1 distance 6 yaw 40 pitch 15
save two.fwscene
TEXT
exits 0 "$script" --script scene.fws --headless

for tool in info cook bake shot; do
    exits 0 "$tools/fw-$tool" --help
    grep -q 'Exit code: 0' out.txt || fail "fw-$tool --help says nothing of its exit codes"
    exits 2 "$tools/fw-$tool" two.fwscene --sideways
    grep -q -e '--sideways' err.txt || fail "fw-$tool does not name the option it does not know"
    exits 1 "$tools/fw-$tool" none.fwscene --quiet
    grep -q 'none.fwscene' err.txt || fail "fw-$tool does not name the file that is not there"
done
exits 2 "$tools/fw-cook" two.fwscene --part 3/2

exits 0 "$tools/fw-info" two.fwscene --json
json fw-info
# For a glTF file: its size, its parts, and the omitted parts.
cat >board.gltf <<'TEXT'
{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "animations": [{}],
 "extensionsRequired": ["KHR_lights_punctual"],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
 "bufferViews": [{"buffer": 0, "byteLength": 36}],
 "buffers": [{"byteLength": 36, "uri":
  "data:;base64,AAAAAAAAAAAAAAAAAAAAQAAAAAAAAAAAAAAAAAAAAEAAAAAA"}]}
TEXT
exits 0 "$tools/fw-info" board.gltf
for line in 'size                 2 x 2 x 0 m' 'parts                1' 'triangles            1' \
    'note: animations (1) are left out: the rest pose is shown' \
    'note: KHR_lights_punctual is left out (extensionsRequired)'; do
    grep -q -x -F "$line" out.txt || fail "fw-info does not say: $line"
done
exits 0 "$tools/fw-info" board.gltf --json
json fw-info
grep -q -F '"size_x": 2, "size_y": 2, "size_z": 0' out.txt || fail "fw-info has no size in JSON"
sed 's/{"mesh": 0}/{"mesh": 0, "scale": [1e-9, 1e-9, 1e-9]}/' board.gltf >tiny.gltf
exits 1 "$tools/fw-cook" tiny.gltf --quiet
grep -q "tiny.gltf: The mesh's longest side is" err.txt || fail "fw-cook does not name the mesh's file"
# shares TOOL OPTION...: runs all at once, then in two shares as on two machines.
shares() {
    exits 0 "$tools/fw-$1" two.fwscene --json --out "$1_all" "${@:2}"
    json "fw-$1"
    for part in 1 2; do
        exits 0 "$tools/fw-$1" two.fwscene --quiet --out "$1_parts" --part "$part/2" "${@:2}"
        [[ ! -s err.txt ]] || fail "fw-$1 --quiet is not quiet"
    done
    [[ $(find "$1_all" -type f | wc -l) -ge 2 ]] || fail "fw-$1 wrote too little"
    diff -r "$1_all" "$1_parts" >out.txt || fail "fw-$1 writes other files in shares"
}
shares cook
# A progress bar shows on terminals only, not in a job's log.
[[ ! -s err.txt ]] || fail "fw-cook writes a bar into a file"
script -qec "$tools/fw-cook two.fwscene --out bar" /dev/null </dev/null >out.txt
grep -q -E '\[#+ *\] +100 %' out.txt || fail "fw-cook shows no bar in a terminal"
shares shot --at 0,1.5 --size 96x64
# Not compared byte by byte: an EXR header holds a date.
exits 0 "$tools/fw-bake" two.fwscene --json --out bake_all
json fw-bake
for part in 1 2; do
    exits 0 "$tools/fw-bake" two.fwscene --quiet --out bake_parts --part "$part/2"
done
[[ $(ls bake_all) == "$(ls bake_parts)" ]] || fail "fw-bake writes other files in shares"
exits 0 "$tools/fw-info" "$(find cook_all -name '*.fwburn' | head -1)" --json
json fw-info
echo "fw-info, fw-cook, fw-bake and fw-shot: help, exit codes, JSON and shares"
