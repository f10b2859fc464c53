#!/bin/bash
# The README's code, as it stands there. Whole programs are compiled, linked with the library and run:
# they light something and succeed only if it burns. Lines of C are compiled as C11 and as C++20 inside
# a host that declares what they lean on. Before it trusts itself it breaks a line and must notice.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Each fenced block of C or C++ becomes a file: one with a main() is a program, the others are lines.
awk -v work="$work" '
    /^```(c|cpp)$/ { language = substr($0, 4); text = ""; next }
    /^```$/ && language {
        if (text ~ /int main\(/) printf "%s", text >(work "/program" ++programs "." language)
        else printf "%s", text >(work "/lines")
        language = ""
    }
    language { text = text $0 "\n" }' "$root/README.md"
calls=$(grep -c 'fw[A-Z]' "$work/lines" || true)
if [[ $calls -lt 8 ]]; then
    echo "README.md has $calls lines of C that call the library; the example is gone"
    exit 1
fi

# host FILE: the lines of FILE inside a host.
host() {
    cat <<'CODE'
#include <flamewright/flamewright.h>
#include <flamewright/flamewright_vulkan.h>
void hear(const FwEvent* event);
void host(const FwVulkanHost hostDevice, const FwWorldDef worldDef, const FwVulkanTargetDef targetDef,
          const FwMeshDef meshDef, FwBurnableMeshDef burnableDef, const FwIgnitionDef match,
          const FwVulkanFrame frame, const FwView view, const VkViewport viewport);
void host(const FwVulkanHost hostDevice, const FwWorldDef worldDef, const FwVulkanTargetDef targetDef,
          const FwMeshDef meshDef, FwBurnableMeshDef burnableDef, const FwIgnitionDef match,
          const FwVulkanFrame frame, const FwView view, const VkViewport viewport) {
    FwContext* context;
    FwWorld* world;
    FwErrorInfo error;
    FwTargetId target;
    FwBurnableMeshId crate;
    FwEvent event;
    static unsigned char buffer[65536];
CODE
    cat "$1"
    echo '}'
}

# compiles FILE: as both languages, every warning an error.
compiles() {
    host "$1" >"$work/host.c"
    host "$1" >"$work/host.cpp"
    local flags=(-Wall -Wextra -Wpedantic -Werror -fsyntax-only "-I$root/plugin/include")
    cc -std=c11 "${flags[@]}" "$work/host.c" && c++ -std=c++20 "${flags[@]}" "$work/host.cpp"
}

sed '0,/fwWorld_Ignite/s//fwWorld_IgniteNot/' "$work/lines" >"$work/broken"
if compiles "$work/broken" >/dev/null 2>&1; then
    echo "a call that does not exist goes unnoticed"
    exit 1
fi
compiles "$work/lines"

library=${FW_BUILD_FOLDER:?set FW_BUILD_FOLDER to a build folder of the library}/plugin
ran=0
for program in "$work"/program*; do
    [[ $(wc -l <"$program") -le 20 ]] || { echo "${program##*/} of README.md has more than 20 lines"; exit 1; }
    case $program in
        *.c) compiler=(cc -std=c11) ;;
        *) compiler=(c++ -std=c++20) ;;
    esac
    "${compiler[@]}" -Wall -Wextra -Wpedantic -Werror "-I$root/plugin/include" "$program" \
        "-L$library" -lflamewright "-Wl,-rpath,$library" -o "$program.run"
    "$program.run"
    ran=$((ran + 1))
done
[[ $ran -eq 2 ]] || { echo "README.md has $ran whole programs; it should have one in C and one in C++"; exit 1; }
echo "$calls calls of README.md compile"
