#!/bin/bash
# Repeats one round of work in one window with real keys and clicks, half of the time under the
# validation layers. Memory must stay flat. After a kill, all work up to half a minute before must be
# restored. The script checks everything and prints all faults at the end.
# Usage: editor_session.sh [SECONDS], with the build folder in FW_BUILD_FOLDER; 40 unless given. 77:
# a requirement is missing.
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
# The messages of the validation layers up to now, before the program ends.
check_messages() {
    ! grep -E 'VUID-|UNASSIGNED-|SYNC-HAZARD|validation:' "$work/log" || fault "the validation layer complains"
}

# Resident memory of the program in MiB.
memory() { awk '/^VmRSS/ { print int($2 / 1024) }' "/proc/$program/status"; }

# One round: places, moves and undoes a source; plays, scrubs, queries and compares the burn; paints a
# stroke; visits the flame page and the export page.
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

# Without the layers, which remember every buffer. The memory of a scene (keyframes, undo) is bounded;
# a leak of one image per round is not.
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

# After a kill the editor offers the work up to the last autosave.
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
