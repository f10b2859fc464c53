#!/bin/bash
# An artist's long day, pressed together: the same round of work over and over in one window, with
# real keys and clicks, half of it under the validation layers. Memory stays flat, and when the program
# is killed in the middle of it, what was done until half a minute before is there again. All of it is
# checked, and what is wrong is told at the end.
# Usage: editor_session.sh [SECONDS], with the build folder in FW_BUILD_FOLDER; 40 unless given. 77:
# something it needs is not here.
set -euo pipefail
seconds=${1:-40}
binary="${FW_BUILD_FOLDER:?set FW_BUILD_FOLDER to a build folder}/editor/app/flamewright-editor"
[[ -x $binary ]] || { echo "flamewright-editor is not built" && exit 77; }
# shellcheck source=../support/window.sh
source "$(dirname "${BASH_SOURCE[0]}")/../support/window.sh"
need Xvfb xdotool
export HOME=$work XDG_STATE_HOME=$work/state XDG_CACHE_HOME=$work/cache
open_display

faults=()
fault() {
    echo "$1"
    faults+=("$1")
}
# The program is about to end or to be ended: what the validation layers said until here.
check_messages() {
    ! grep -E 'VUID-|UNASSIGNED-|SYNC-HAZARD|validation:' "$work/log" || fault "the validation layer complains"
}

# MiB that the program holds.
memory() { awk '/^VmRSS/ { print int($2 / 1024) }' "/proc/$program/status"; }

# One round: a source placed, moved and taken back, the burn played, scrubbed, asked and compared,
# a stroke painted, the flame page and the export page looked at.
round() {
    xdotool key 1 key shift+a mousemove 600 330 click 1
    await "did: Add heat source"
    xdotool key space
    sleep 1
    xdotool key space mousemove 130 598 mousedown 1 mousemove 100 598 mousemove 110 598 mouseup 1
    xdotool key y mousemove 560 330 click 1
    await "answered"
    xdotool key Escape key c
    await "did: Compared"
    sleep 1
    xdotool key c key 2
    await "ready to paint"
    xdotool mousemove 440 380 mousedown 1 mousemove 446 390 mousemove 460 420 mouseup 1
    await "did: Paint burn multiplier on"
    xdotool key 3
    sleep 0.3
    xdotool key 4
    sleep 0.3
    xdotool key 1 key ctrl+z
    await "did: Undone"
    xdotool key ctrl+z key ctrl+z
    xdotool key Home
}

# work_for SECONDS: rounds; `before`: memory after the first four.
work_for() {
    local end=$((SECONDS + $1)) rounds=0
    while ((rounds < 5 || SECONDS < end)); do
        round
        rounds=$((rounds + 1))
        echo "round $rounds: $(memory) MiB"
        ((rounds != 4)) || before=$(memory)
    done
}

# Without the layers, which keep a note of every buffer that there ever was. What is kept of a scene
# (moments to go back to, undo) is bounded; a leak of a picture a round is not.
layers=()
start "$binary" --scene "Burning crate"
await ready
work_for $((seconds / 2))
after=$(memory)
echo "$before MiB after the fourth, $after after the last"
((after <= before + before / 10 + 24)) || fault "memory grows"
kill -9 "$program"
wait "$program" 2>/dev/null || true
rm -f "$work"/state/flamewright/recovery-*

layers=(--validate)
start "$binary" --scene "Burning crate"
await ready
work_for $((seconds / 2))
check_messages

# Killed: the work until the last autosave is offered again.
xdotool key 1 mousemove 600 330 key shift+a click 1
await "did: Add heat source"
for _ in $(seq 300); do
    ! compgen -G "$work/state/flamewright/recovery-*.fwscene" >/dev/null || break
    sleep 0.1
done
sleep 0.5
check_messages
kill -9 "$program"
wait "$program" 2>/dev/null || true
start "$binary"
# The button to recover it, as soon as the page is there.
for _ in $(seq 60); do
    grep -q '^ready$' "$work/log" && break
    sleep 1
    xdotool mousemove 112 296 click 1
done
await ready
grep -q '"point"' "$work"/state/flamewright/recovery-*.fwscene || fault "the last heat source was lost"
check_messages
kill -9 "$program"
wait "$program" 2>/dev/null || true
program=
((${#faults[@]} == 0)) || { printf 'wrong: %s\n' "${faults[@]}" && exit 1; }
echo "no message, flat memory; killed, and its work is there again"
