#!/bin/bash
# Compiles every header alone, with nothing included before it: the C headers as C11 and C++20, all
# others as C++20. Public headers must be clean under strict warnings. A header that its own source
# includes first is left to the consumer in a subdirectory, which compiles each source by itself.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
strict=(-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror)
runtime=(-I"$root/runtime" -I"$root/shaders" -I"$root/plugin/include" -DVK_NO_PROTOTYPES -fno-rtti)

compile() {
    "$@" >/dev/null || { echo "does not compile alone: $*" && return 1; }
}

# check FILE: every language the header promises.
check() {
    local file=$1
    case $file in
        */plugin/include/*.hpp)
            compile c++ -x c++ -std=c++20 -fsyntax-only "${strict[@]}" -Wno-pragma-once-outside-header \
                -I"$root/plugin/include" "$file"
            ;;
        */plugin/include/*.h)
            compile cc -x c -std=c11 -fsyntax-only "${strict[@]}" -I"$root/plugin/include" "$file"
            compile c++ -x c++ -std=c++20 -fsyntax-only "${strict[@]}" \
                -I"$root/plugin/include" "$file"
            ;;
        *) compile c++ -x c++ -std=c++20 -fsyntax-only -w "${runtime[@]}" "$file" ;;
    esac
}

# in_its_source FILE: true if the source beside it includes this header first.
in_its_source() {
    local file=$1 source=${1%.h}.cpp
    [[ -f $source ]] && [[ $(grep -m 1 '^#include' "$source") == "#include \"${file#"$root"/runtime/}\"" ]]
}

if [[ $# -eq 1 ]]; then
    check "$1"
    exit
fi
find "$root"/plugin/include "$root"/runtime "$root"/shaders/shared -name '*.h' -o -name '*.hpp' | sort |
    while read -r file; do in_its_source "$file" || echo "$file"; done | xargs -P "$(nproc)" -n 1 bash "$0"
echo "every header compiles alone"
