#!/bin/bash
# The README's lines of C, compiled as they stand there, as C11 and as C++20, inside a host that
# declares what they lean on. Before it trusts itself it breaks a line and must notice.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

sed -n '/^```c$/,/^```$/p' "$root/README.md" | sed '/^```/d' >"$work/lines"
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
void host(const FwVulkanHost lent, const FwWorldDef worldDef, const FwVulkanTargetDef targetDef,
          const FwMeshDef meshDef, const FwBurnableMeshDef burnableDef, const FwIgnitionDef match,
          const FwVulkanFrame frame, const FwView view, const VkViewport viewport);
void host(const FwVulkanHost lent, const FwWorldDef worldDef, const FwVulkanTargetDef targetDef,
          const FwMeshDef meshDef, const FwBurnableMeshDef burnableDef, const FwIgnitionDef match,
          const FwVulkanFrame frame, const FwView view, const VkViewport viewport) {
    FwContext* context;
    FwWorld* world;
    FwErrorInfo error;
    FwTargetId target;
    FwMeshId mesh;
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
echo "$calls calls of README.md compile"
