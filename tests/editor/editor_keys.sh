#!/bin/bash
# Each command of the key map has its keys on its pages, no two commands of one page share keys, and
# keys that a user changed survive a restart.
# Usage: editor_keys.sh, with the build folder in FW_BUILD_FOLDER. 77: a requirement is missing.
set -euo pipefail
binary="${FW_BUILD_FOLDER:?set FW_BUILD_FOLDER to a build folder}/editor/app/flamewright-editor"
[[ -x $binary ]] || { echo "flamewright-editor is not built" && exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export HOME=$work XDG_STATE_HOME=$work/state XDG_CACHE_HOME=$work/cache
unset DISPLAY WAYLAND_DISPLAY
"$binary" --headless --keys >"$work/keys"

faults=0
fault() {
    echo "$1"
    faults=$((faults + 1))
}
# Pages by number, -2: all, -3: all that have a scene. Then keys, then the command.
while IFS=$'\t' read -r page keys command; do
    grep -q -F -x -e "$page"$'\t'"$keys"$'\t'"$command" "$work/keys" ||
        fault "$command is not on $keys (page $page): $(grep -F -e $'\t'"$command" "$work/keys" || echo it is missing)"
done < <(tr '|' '\t' <<'TEXT'
-2|Ctrl+P|Find anything
-3|Ctrl+Z|Undo
-3|Ctrl+Shift+Z|Redo
-3|Ctrl+S|Save
-2|Ctrl+O|Open…
-2|Ctrl+N|New scene
0|Ctrl+C|Copy
0|Ctrl+V|Paste
0|Ctrl+D|Duplicate
0|Del|Delete
-3|1|Scene
-3|2|Paint on meshes
-3|3|Flame
-3|4|Export
-2|F1|Keys
-2|Shift+F1|What is this?
-3|Tab|Show panels
0|Q|Select
0|W|Move
0|E|Rotate
0|R|Scale
0|Shift+A|Add heat source
0|D|Drop to surface
0|F|Frame selection
0|A|Frame all
0|Num 1|Front
0|Num 3|Side
0|Num 7|Top
0|O|Show burn times
0|Shift+O|Show burn multipliers
0|H|Show marks and maps
0|Y|Why does it not burn?
0|Space|Play, pause
0|,|Back one frame
0|.|On one frame
0|Home|To start
0|End|To end
0|M|Add event
0|L|Loop
0|C|Compare
0|Ctrl+Space|Burn on from here
1|B|Paint on the mesh
1|X|Erase paint
1|S|Smooth paint
1|G|Fill with paint
1|I|Pick paint
1|]|Larger paint brush
1|[|Smaller paint brush
1|Shift+]|Stronger paint
1|Shift+[|Weaker paint
1|K|Mirror paint
2|B|Paint
2|X|Erase
2|S|Smooth
2|F|Smear
2|I|Pick a value
2|]|Larger brush
2|[|Smaller brush
2|Shift+]|Stronger brush
2|Shift+[|Weaker brush
TEXT
)
# Every pair of commands with equal keys on a common page.
awk -F'\t' '$2 != "" {
    for (i = 1; i <= count; ++i)
        if (keys[i] == $2 && (page[i] == $1 || page[i] < -1 || $1 < -1)) print $2 ": " name[i] " and " $3
    ++count; page[count] = $1; keys[count] = $2; name[count] = $3
}' "$work/keys" >"$work/shared"
[[ ! -s $work/shared ]] || fault "shared: $(cat "$work/shared")"

printf 'keys Frame all\tShift+F\n' >"$work/state/flamewright/editor"
"$binary" --headless --keys | grep -q -F -x $'0\tShift+F\tFrame all' || fault "changed keys are forgotten"
((faults == 0)) || exit 1
echo "$(wc -l <"$work/keys") commands, each of the key map with its keys, none shared"
