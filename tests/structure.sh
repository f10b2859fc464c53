#!/bin/bash
# Measures the structure of the code: prints "name value limit" a line, the limits being those of
# structure_limits.txt, and fails where a value is beyond its limit.
# Usage: tests/structure.sh [NAME]   with a name: lists the places that this figure counts
set -euo pipefail
export LC_ALL=C
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
cd "$here/.."
wanted=${1:-}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# code FOLDER...: their files of code, without the reference implementations and the adapters.
code() {
    find "$@" -type f \( -name '*.cpp' -o -name '*.h' -o -name '*.hpp' -o -name '*.c' -o -name '*.glsl' \
        -o -name '*.inl' \) -not -path 'runtime/reference/*' -not -path 'plugin/adapters/*' | sort
}

# retired FILE...: "file:line:text" of each line that holds a retired word, alone or as a part of an
# identifier: kFlameTint is read as k, Flame, Tint; FLAME_TINT as two parts; flamelet as one.
retired() {
    awk '
        FILENAME == ARGV[1] {
            if (!/^#/) for (i = 1; i <= NF; ++i) { words[$i]; any = any (any ? "|" : "") $i }
            next
        }
        tolower($0) !~ any { next }
        {
            rest = $0
            while (match(rest, /[A-Z]+[a-z]*|[a-z]+/)) {
                word = substr(rest, RSTART, RLENGTH)
                rest = substr(rest, RSTART + RLENGTH)
                # In CPUFlame the last capital begins the next word.
                if (match(word, /^[A-Z]+[a-z]/) && RLENGTH > 2) {
                    head = tolower(substr(word, 1, RLENGTH - 2))
                    tail = tolower(substr(word, RLENGTH - 1))
                } else {
                    head = tolower(word)
                    tail = ""
                }
                if (head in words || (tail != "" && tail in words)) {
                    print FILENAME ":" FNR ":" $0
                    break
                }
            }
        }' "$here/retired_words.txt" "$@"
}

# Before it trusts itself: words, parts of identifiers, and words that only contain a retired one.
printf '%s\n' 'a de''ed' 'kDe''edSize' 'FW_TO''LD_HOLES' 'to''ld_holes' 'le''ntFor(x)' 'xA''RPStep' 'He''roes.' \
    'tells an''ew' 'silent, blend, sharp, cylinder, newspaper, newsprint, history, plenty, spheroid, arpeggio' \
    'sto''ry2' >"$work/words"
[[ $(retired "$work/words" | wc -l) -eq 9 ]] || {
    retired "$work/words"
    echo "structure: of 10 lines the search for retired words should find 9"
    exit 1
}
cat >"$work/a.cpp" <<'CODE'
namespace fw {
struct Outer : Base {  // two fields, three methods
    struct Inner { int a, b; };
    using Map = std::map<int, int>;
    static constexpr int kMost = 3;
    void one();
    int two() const noexcept { return {}; }
    [[nodiscard]] bool three(int (*call)(int)) = delete;
    int x_ = 0;
    std::function<void(int, int)> y_{};
};
const int kTable[] = {1, 2};  /* { */
const char* text = "{";
void Outer::one() {
    if (x_) { y_(1, 2); }
}
}
CODE
seen=$(awk -f "$here/structure.awk" "$work/a.cpp" | sed "s|$work/||" | sort | tr '\t\n' ' ;')
expected='function 1 a.cpp:7 two;function 3 a.cpp:14 Outer::one;type 2 0 1 a.cpp:3 Inner;type 2 3 10 a.cpp:2 Outer;'
[[ $seen == "$expected" ]] || {
    echo "structure: the scan of two types and two functions says $seen"
    exit 1
}

code runtime plugin shaders >"$work/library"
tr '\n' '\0' <"$work/library" | xargs -0 awk -f "$here/structure.awk" >"$work/scan"
find runtime plugin shaders editor samples tests -type f -not -name '*.png' -not -name '*.fwbook' \
    -not -name '*.log' -not -path tests/retired_words.txt -not -name MIGRATION.md \
    -not -path plugin/docs/glossary.md | sort >"$work/texts"

# places NAME: the places that a figure counts, a line each.
places() {
    case $1 in
        # The class that owns the world, by whichever name: World, WorldState, World::State.
        world_class)
            awk -F '\t' '$1 == "type" && $5 ~ /^runtime\// && $5 !~ /^runtime\/gpu\// && $6 ~ /^World($|State|Impl|::)/' \
                "$work/scan" | sort -t $'\t' -k 2,2nr | head -n 1
            ;;
        vk_class)
            awk -F '\t' '$1 == "type" && $5 ~ /^runtime\/gpu\/vk\//' "$work/scan" | sort -t $'\t' -k 2,2nr | head -n 1
            ;;
        long_functions) awk -F '\t' '$1 == "function" && $2 > 100 { print $2, $3, $4 }' "$work/scan" | sort -nr ;;
        pass_files)
            find runtime/gpu -name '*.cpp' -exec grep -l -E '^(inline )?const(expr)? [A-Za-z:]*Pass k[A-Z]' {} + | sort
            ;;
        retired_words)
            {
                tr '\n' '\0' <"$work/texts" | xargs -0 bash -c 'retired "$@"' retired
                retired "$work/texts" | sed 's/^.*:/name of a file: /'
            } | cut -c 1-200
            ;;
        assertions)
            grep -r -n -E '\bFW_ASSERT\(' runtime | grep -v '^runtime/core/assert\.' || true
            ;;
        *)
            echo "structure: no figure \"$1\" has a list; long_functions, pass_files, retired_words and" \
                "assertions have" >&2
            exit 2
            ;;
    esac
}
export -f retired
export here
if [[ $# -gt 0 ]]; then
    places "$1"
    exit 0
fi

failed=0
# row NAME VALUE: prints it with its limit, "-" where it has none.
row() {
    local bound limit
    read -r bound limit < <(awk -v name="$1" '$1 == name { print $2, $3 }' "$here/structure_limits.txt") || true
    printf '%-34s %6d %6s\n' "$1" "$2" "${limit:--}"
    case ${bound:-} in
        "") ;;
        most) [[ $2 -le $limit ]] || failed=1 ;;
        least) [[ $2 -ge $limit ]] || failed=1 ;;
        *)
            echo "structure: the limit of $1 is neither \"most\" nor \"least\""
            failed=1
            ;;
    esac
}
lines() { tr '\n' '\0' | xargs -0 cat /dev/null | wc -l; }
count() { places "$1" | wc -l; }

# A room is a folder below runtime, plugin or shaders; folders in runtime/gpu are rooms too.
in_room='s|^\(runtime/gpu/[^/]*\)/.*|\1|; t; s|^\([^/]*/[^/]*\)/.*|\1|; t; s|/[^/]*$||'
sed "$in_room" "$work/library" | sed '/\.[a-z]*$/s|/[^/]*$||' | paste - "$work/library" >"$work/rooms"
while read -r room; do
    row "lines:$room" "$(awk -F '\t' -v room="$room" '$1 == room { print $2 }' "$work/rooms" | lines)"
done < <(cut -f 1 "$work/rooms" | sort -u)
row library_lines "$(lines <"$work/library")"
IFS=$'\t' read -r _ fields methods _ place _ < <(places world_class)
row world_fields "$fields"
row world_methods "$methods"
row world_header_lines "$(wc -l <"${place%:*}")"
IFS=$'\t' read -r _ fields _ < <(places vk_class)
row vk_largest_fields "$fields"
for name in long_functions pass_files retired_words assertions; do row "$name" "$(count "$name")"; done
row readme_lines "$(wc -l <README.md)"
if [[ $failed -ne 0 ]]; then
    echo "a figure is beyond its limit; tests/structure.sh NAME lists the places it counts"
fi
exit "$failed"
