#!/bin/bash
# Drives the editor with real keys and clicks in a window: imports a glTF, places a heat source, plays,
# scrubs, undoes, redoes, paints the mesh, paints a flame and edits its points, queries a point, saves,
# writes the game's files and opens the saved scene. The scene must be equal byte for byte, and the
# window's picture must equal one drawn without a window.
# Runs under the validation layer with synchronization checks.
# Usage: editor_window.sh, with the build folder in FW_BUILD_FOLDER. 77: a requirement is missing.
set -euo pipefail
binary="${FW_BUILD_FOLDER:?set FW_BUILD_FOLDER to a build folder}/editor/app/flamewright-editor"
[[ -x $binary ]] || { echo "flamewright-editor is not built" && exit 77; }
# shellcheck source=../support/window.sh
source "$(dirname "${BASH_SOURCE[0]}")/../support/window.sh"
need Xvfb xdotool
model=/usr/share/assimp/models/glTF2/BoxTextured-glTF-Binary/BoxTextured.glb
[[ -f $model ]] || { echo "$model is missing (package assimp-testmodels)" && exit 77; }

export HOME=$work XDG_STATE_HOME=$work/state XDG_CACHE_HOME=$work/cache
cp "$model" "$work/box.glb"
open_display

start "$binary"
xdotool key ctrl+i key ctrl+a type "$work/box.glb"
xdotool key Return
await "did: Import"
await ready
xdotool mousemove 600 330 key shift+a
xdotool click 1
await "did: Add heat source"
# Copies and pastes, and undoes it.
xdotool key ctrl+c
await "did: Copied"
xdotool key ctrl+v
await "did: Paste Heat source"
xdotool key ctrl+z
await "did: Undone"
xdotool key space
await "burn at 1 s"
xdotool key space
# Scrubs back: the preview follows while the button is down, and time continues from there.
xdotool mousemove 100 598 mousedown 1
await "preview of"
xdotool mousemove 96 598 mouseup 1
xdotool key ctrl+z
await "did: Undone"
xdotool key ctrl+shift+z
await "did: Done again"
# A stroke over the mesh is one undo step.
xdotool key 2
await "ready to paint"
xdotool key f mousemove 440 380 mousedown 1
xdotool mousemove 446 390 mousemove 452 400 mousemove 460 420 mouseup 1
await "did: Paint burn multiplier on"
xdotool key ctrl+z
await "did: Undone"
xdotool key ctrl+shift+z
await "did: Done again"
# A straight line from the end of the stroke.
xdotool mousemove 500 400 keydown shift click 1
await "did: Paint burn multiplier on"
xdotool keyup shift
xdotool key 3 mousemove 540 300 mousedown 1
xdotool mousemove 560 340 mousemove 560 400 mouseup 1
await "did: Paint the flame"
# A straight line from that end.
xdotool mousemove 590 460 keydown shift click 1
await "did: Paint the flame"
xdotool keyup shift
xdotool key f mousemove 540 300 mousedown 1
xdotool mousemove 560 290 mousemove 580 280 mouseup 1
await "did: Smear the flame"
xdotool key g mousemove 540 420 mousedown 1
xdotool mousemove 540 380 mousemove 540 240 mouseup 1
await "did: Gradient in the flame"
# Dragging an outline point is a step.
xdotool key p mousemove 645 443 mousedown 1
xdotool mousemove 630 440 mousemove 612 432 mouseup 1
await "did: Outline point of the flame"
# Queries an unburnt point. Everything but the forecast is answered at once.
xdotool key 1
await ready
xdotool key y mousemove 540 300 click 1
await "answered [0-2] frames later"
xdotool key Escape
# Time continues from the scrubbed time; a click queries a point; a command gets other keys.
xdotool key ctrl+space
await "did: Burns on from"
xdotool key space key shift+F1
await "did: Point at"
xdotool key Escape key F1 mousemove 100 120 click 1 key ctrl+p key ctrl+shift+n
await "did: Ctrl.Shift.N is New scene now"
xdotool key Escape
xdotool key ctrl+s key ctrl+a type "$work/first.fwscene"
xdotool key Return
await "did: Saved first.fwscene"
xdotool key 4 key ctrl+e
await "did: Wrote [0-9]+ files"
for file in first.c first.cpp; do
    [[ -s $work/first_game/$file ]] || { ls -R "$work" && echo "the code is missing" && exit 1; }
done
cc -std=c11 -Wall -Wextra -Werror -fsyntax-only -I"$(dirname "${BASH_SOURCE[0]}")/../../plugin/include" \
    "$work/first_game/first.c"
leave ctrl+q
grep -q '"shape": "point"' "$work/first.fwscene" || grep -q '"point"' "$work/first.fwscene" ||
    { cat "$work/first.fwscene" && echo "the heat source is not in the file" && exit 1; }

start "$binary" "$work/first.fwscene"
await "did: Opened first.fwscene"
await ready
# ImageMagick takes the window's picture.
if command -v import >/dev/null; then
    xdotool mousemove 1100 480
    sleep 2
    import -window root "$work/window.png"
    "$binary" --headless --page scene --size 1280x720 --scale 1 --shot "$work/headless.png" "$work/first.fwscene"
    echo 'expect alike "window.png" "headless.png" 0.002' >"$work/alike.fws"
    "$binary" --script "$work/alike.fws" --headless || { echo "the window shows another picture" && exit 1; }
fi
xdotool key ctrl+shift+s key ctrl+a type "$work/second.fwscene"
xdotool key Return
await "did: Saved second.fwscene"
leave ctrl+q
# Its images are named after the scene and their content.
sed 's/"second\.paint_/"first.paint_/' "$work/second.fwscene" | cmp - "$work/first.fwscene" ||
    { echo "saving changed the scene" && exit 1; }
cmp "$work"/first.paint_*.png "$work"/second.paint_*.png || { echo "saving changed the paint" && exit 1; }
echo "imported, placed, played, undone, painted, saved and opened again: the same scene"
