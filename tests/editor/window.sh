#!/bin/bash
# Drives the editor as a hand does, with real keys and clicks in a window: imports a glTF, places a
# heat source on it, plays, scrubs back, undoes and does again, paints on the mesh, paints a flame,
# saves, and opens what was saved; the scene is the same to the byte.
# Under the validation layer, synchronization checks included.
# Usage: window.sh, with the build folder in FW_BUILD_FOLDER. 77: something it needs is not here.
set -euo pipefail
binary="${FW_BUILD_FOLDER:?set FW_BUILD_FOLDER to a build folder}/editor/app/flamewright-editor"
[[ -x $binary ]] || { echo "flamewright-editor is not built" && exit 77; }
for tool in Xvfb xdotool; do
    command -v $tool >/dev/null || { echo "$tool is not here" && exit 77; }
done
model=/usr/share/assimp/models/glTF2/BoxTextured-glTF-Binary/BoxTextured.glb
[[ -f $model ]] || { echo "$model is not here (package assimp-testmodels)" && exit 77; }

work=$(mktemp -d)
server= editor=
cleanup() {
    [[ -z $editor ]] || kill "$editor" 2>/dev/null || true
    [[ -z $server ]] || kill "$server" 2>/dev/null || true
    rm -rf "$work"
}
trap cleanup EXIT
export HOME=$work XDG_STATE_HOME=$work/state XDG_CACHE_HOME=$work/cache
cp "$model" "$work/box.glb"

Xvfb -displayfd 3 -screen 0 1280x720x24 -nolisten tcp 3>"$work/display" 2>"$work/xvfb.log" &
server=$!
for _ in $(seq 100); do
    [[ -s $work/display ]] && break
    sleep 0.1
done
[[ -s $work/display ]] || { cat "$work/xvfb.log" && echo "Xvfb does not start" && exit 1; }
DISPLAY=:$(cat "$work/display")
export DISPLAY

start() {
    : >"$work/log"
    "$binary" --validate --report "$@" >"$work/log" 2>&1 &
    editor=$!
    for _ in $(seq 600); do
        xdotool search --name Flamewright >"$work/window" 2>/dev/null && break
        sleep 0.1
    done
    xdotool windowmove "$(head -1 "$work/window")" 0 0
    xdotool windowfocus "$(head -1 "$work/window")"
}
# Until a line of the report matches; what came before is forgotten.
seen=0
await() {
    local text=$1
    for _ in $(seq 1200); do
        if tail -n +$((seen + 1)) "$work/log" | grep -q -- "$text"; then
            seen=$(wc -l <"$work/log")
            return
        fi
        kill -0 "$editor" 2>/dev/null || break
        sleep 0.1
    done
    cat "$work/log"
    echo "the editor never said: $text"
    exit 1
}
leave() {
    xdotool key ctrl+q
    local status=0
    wait "$editor" || status=$?
    editor=
    cat "$work/log"
    [[ $status -eq 0 ]] || { echo "the editor left with status $status" && exit 1; }
    if grep -E -q 'VUID-|UNASSIGNED-|SYNC-HAZARD|validation:' "$work/log"; then
        echo "the validation layer complains" && exit 1
    fi
}

start
xdotool key ctrl+i key ctrl+a type "$work/box.glb"
xdotool key Return
await "did: Import"
await ready
xdotool mousemove 600 330 key shift+a
xdotool click 1
await "did: Add heat source"
xdotool key space
await "burn at 1 s"
xdotool key space
# Back by hand: the preview follows while the button is down, and time goes on from there.
xdotool mousemove 100 598 mousedown 1
await "preview of"
xdotool mousemove 96 598 mouseup 1
xdotool key ctrl+z
await "did: Undone"
xdotool key ctrl+shift+z
await "did: Done again"
# A stroke over the mesh is one step, and undone as one.
xdotool key 2
await "ready to paint"
xdotool key f mousemove 440 380 mousedown 1
xdotool mousemove 446 390 mousemove 452 400 mousemove 460 420 mouseup 1
await "did: Paint burn multiplier on"
xdotool key ctrl+z
await "did: Undone"
xdotool key ctrl+shift+z
await "did: Done again"
xdotool key 3 mousemove 540 300 mousedown 1
xdotool mousemove 560 340 mousemove 560 400 mouseup 1
await "did: Paint the flame"
xdotool key 1 key ctrl+s key ctrl+a type "$work/first.fwscene"
xdotool key Return
await "did: Saved first.fwscene"
leave
seen=0
grep -q '"shape": "point"' "$work/first.fwscene" || grep -q '"point"' "$work/first.fwscene" ||
    { cat "$work/first.fwscene" && echo "the heat source is not in the file" && exit 1; }

start "$work/first.fwscene"
await "did: Opened first.fwscene"
await ready
xdotool key ctrl+shift+s key ctrl+a type "$work/second.fwscene"
xdotool key Return
await "did: Saved second.fwscene"
leave
cmp "$work/first.fwscene" "$work/second.fwscene" || { echo "saving changed the scene" && exit 1; }
echo "imported, placed, played, undone, painted, saved and opened again: the same scene"
