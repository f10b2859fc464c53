# Sourced by tests that run a program in a window on its own display and drive it with real keys and
# clicks.
# shellcheck shell=bash

work=$(mktemp -d)
server= program=
layers=(--validate)  # what programs are started with
cleanup() {
    [[ -z $program ]] || kill "$program" 2>/dev/null || true
    [[ -z $server ]] || kill "$server" 2>/dev/null || true
    rm -rf "$work"
}
trap cleanup EXIT

# need TOOL...: exits with 77 if one is not installed.
need() {
    local tool
    for tool in "$@"; do
        command -v "$tool" >/dev/null || { echo "$tool is not installed" && exit 77; }
    done
}

# Opens an invisible screen of 1280 x 720 and sets DISPLAY. -noreset keeps it when the last window
# closes, so that the next program finds a display.
open_display() {
    need Xvfb
    Xvfb -displayfd 3 -screen 0 1280x720x24 -nolisten tcp -noreset 3>"$work/display" 2>"$work/xvfb.log" &
    server=$!
    for _ in $(seq 100); do
        [[ -s $work/display ]] && break
        sleep 0.1
    done
    [[ -s $work/display ]] || { cat "$work/xvfb.log" && echo "Xvfb does not start" && exit 1; }
    DISPLAY=:$(cat "$work/display")
    export DISPLAY
}

# start PROGRAM ARGUMENT...: waits until its window is in the corner and accepts keys. The program and
# the validation layers write to $work/log.
start() {
    : >"$work/log"
    seen=0
    "$1" "${layers[@]}" --report "${@:2}" >"$work/log" 2>&1 &
    program=$!
    # The found window may belong to a program that was just killed, or may not be mapped yet.
    for _ in $(seq 600); do
        xdotool search --name Flamewright >"$work/window" 2>/dev/null || true
        window=$(head -1 "$work/window")
        if [[ -n $window ]] && xdotool windowmove "$window" 0 0 windowfocus "$window" 2>/dev/null; then return; fi
        sleep 0.1
    done
    cat "$work/log"
    echo "the program shows no window"
    exit 1
}

# await EXPRESSION: waits for a matching line of the log and discards earlier lines.
await() {
    for _ in $(seq 1800); do
        if tail -n +$((seen + 1)) "$work/log" | grep -q -E -- "$1"; then
            seen=$(wc -l <"$work/log")
            return
        fi
        kill -0 "$program" 2>/dev/null || break
        sleep 0.1
    done
    cat "$work/log"
    echo "the log never showed: $1"
    exit 1
}

# leave KEY: the program must quit on this key without validation messages.
leave() {
    xdotool key "$1"
    local status=0
    wait "$program" || status=$?
    program=
    cat "$work/log"
    [[ $status -eq 0 ]] || { echo "the program exited with status $status" && exit 1; }
    if grep -E -q 'VUID-|UNASSIGNED-|SYNC-HAZARD|validation:' "$work/log"; then
        echo "the validation layer complains" && exit 1
    fi
}

# picture NAME: saves a screenshot in the folder FW_KEEP_PICTURES, if set (ImageMagick).
picture() {
    [[ -n ${FW_KEEP_PICTURES:-} ]] || return 0
    import -window root "$FW_KEEP_PICTURES/$1.png" || true
}
