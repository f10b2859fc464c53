#!/bin/bash
# Plays the tower-defence game as a hand does, with real keys and clicks in a window: places a
# tower, upgrades it, calls the wave, pauses, fast-forwards, resizes, goes ten seconds back, sells
# and leaves. Under the validation layer, synchronization checks included.
# Usage: window.sh, with the build folder in FW_BUILD_FOLDER. 77: something it needs is not here.
# With FW_KEEP_PICTURES a folder: screenshots are left there (ImageMagick).
set -euo pipefail
binary="${FW_BUILD_FOLDER:?set FW_BUILD_FOLDER to a build folder}/samples/tower_defence/tower_defence"
[[ -x $binary ]] || { echo "tower_defence is not built" && exit 77; }
for tool in Xvfb xdotool; do
    command -v $tool >/dev/null || { echo "$tool is not here" && exit 77; }
done

work=$(mktemp -d)
server= game=
cleanup() {
    [[ -z $game ]] || kill "$game" 2>/dev/null || true
    [[ -z $server ]] || kill "$server" 2>/dev/null || true
    rm -rf "$work"
}
trap cleanup EXIT

Xvfb -displayfd 3 -screen 0 1280x720x24 -nolisten tcp 3>"$work/display" 2>"$work/xvfb.log" &
server=$!
for _ in $(seq 100); do
    [[ -s $work/display ]] && break
    sleep 0.1
done
[[ -s $work/display ]] || { cat "$work/xvfb.log" && echo "Xvfb does not start" && exit 1; }
DISPLAY=:$(cat "$work/display")
export DISPLAY

# Until a line of the report matches; what came before is forgotten.
seen=0
await() {
    local text=$1
    for _ in $(seq 1800); do
        if tail -n +$((seen + 1)) "$work/log" | grep -q -E -- "$text"; then
            seen=$(wc -l <"$work/log")
            return
        fi
        kill -0 "$game" 2>/dev/null || break
        sleep 0.1
    done
    cat "$work/log"
    echo "the game never said: $text"
    exit 1
}
picture() {
    [[ -n ${FW_KEEP_PICTURES:-} ]] || return 0
    import -window root "$FW_KEEP_PICTURES/$1.png" || true
}
# The middle of a plot, as the game says where it is.
plot_place() { sed -n "s/^did: plot $1 at //p" "$work/log" | tail -1; }

: >"$work/log"
"$binary" --validate --report --size 720x405 >"$work/log" 2>&1 &
game=$!
await "did: size 720x405"
window=$(xdotool search --name Flamewright | head -1)
xdotool windowmove "$window" 0 0
xdotool windowfocus "$window"

xdotool key space
await "did: pause$"
read -r x y < <(plot_place 0)
xdotool key 1 mousemove "$x" "$y"
sleep 1
xdotool click 1
await "did: place 0$"
xdotool key u
await "did: upgrade 0$"
xdotool key u # 110 coins are left of 320, and the next level costs 120
await "did: upgrade 0: not enough coins"
picture placed
xdotool key Return
await "did: call wave"
xdotool key space
await "did: go on"
xdotool key f
await "did: speed 2"
xdotool key f
await "did: speed 4"
await "did: second 6$"
xdotool windowsize "$window" 800 450
await "did: size 800x450"
await "did: second 13$"
picture fight
xdotool key r
await "did: rewind [0-9]+ ticks"
back=$(sed -n 's/^did: rewind \([0-9]*\) ticks.*/\1/p' "$work/log")
# Ten seconds, and at most the two between moments and what passed until the key was heard.
[[ $back -ge 320 && $back -le 420 ]] || { echo "rewind went back $back ticks" && exit 1; }
await "did: second [3-5]$"
picture again
xdotool key x
await "did: sell 0$"
xdotool key x
await "did: sell 0: there is no tower"
xdotool key Escape
await "did: quit"
status=0
wait "$game" || status=$?
game=
cat "$work/log"
[[ $status -eq 0 ]] || { echo "the game left with status $status" && exit 1; }
if grep -E -q 'VUID-|UNASSIGNED-|SYNC-HAZARD|validation:' "$work/log"; then
    echo "the validation layer complains" && exit 1
fi
echo "placed, upgraded, paused, fast-forwarded, resized, rewound, sold and left"
