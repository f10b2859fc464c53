# Scans C and C++ for what tests/structure.sh counts. Prints, separated by tabs:
#   function LINES FILE:LINE NAME
#   type FIELDS METHODS LINES FILE:LINE NAME
# Reads braces and semicolons outside comments and strings; it knows no template or macro.
function begin_file() {
    depth = 0; text = ""; in_comment = 0; in_raw = 0; kind[0] = "namespace"; braces = 0
}
# The kind of the block that `text` opens inside a block of the kind `outer`.
function kind_of(text, outer,   bare) {
    if (outer == "function" || outer == "other") return "other"
    if (text ~ /(^| )namespace( |$)/ || text ~ /extern ("")?$/) return "namespace"
    bare = text
    while (sub(/<[^<>]*>/, "", bare)) continue
    if (bare ~ /(^| )(class|struct|union) [A-Za-z_]/ && bare !~ /[()]/) return "type"
    if (bare ~ /(^| )enum( |$)/) return "other"
    if (bare ~ /\(/ && bare !~ /=[^=]*$/) return "function"
    if (bare ~ /operator[=<>!]/) return "function"
    return "other"
}
function name_of(text, what,   bare) {
    bare = text
    while (sub(/<[^<>]*>/, "", bare)) continue
    if (what == "type") {
        sub(/ : .*$/, "", bare)
        sub(/ final$/, "", bare)
        sub(/^.*(class|struct|union) /, "", bare)
        return bare
    }
    sub(/\(.*$/, "", bare)
    sub(/^.* [*&]*/, "", bare)
    return bare
}
# One declaration in the body of a type: a field or a method.
function declare(text,   bare) {
    bare = text
    sub(/^ */, "", bare)
    while (sub(/^(public|private|protected) *: */, "", bare)) continue
    if (bare == "" || bare ~ /^(using|typedef|friend|template|static_assert|static constexpr|enum|class|struct|union)( |$|\()/) {
        if (bare !~ /\(/ || bare ~ /^(using|typedef|friend|static_assert)/) return
    }
    while (sub(/<[^<>]*>/, "", bare)) continue
    if (bare ~ /\(/) ++methods[depth]
    else if (bare != "") { n = gsub(/,/, ",", bare); fields[depth] += 1 + n }
}
FNR == 1 { begin_file() }
{
    line = $0
    if (line ~ /^ *#/ || continued) { continued = line ~ /\\$/; next }
    if (in_raw) { if (line ~ /\)[A-Za-z]*"/) { in_raw = 0; sub(/^.*\)[A-Za-z]*"/, "", line) } else next }
    gsub(/\\\\/, "", line)
    gsub(/\\["']/, "", line)
    if (!in_comment && line ~ /R"[A-Za-z]*\(/ && line !~ /R"[A-Za-z]*\(.*\)[A-Za-z]*"/) { in_raw = 1; sub(/R"[A-Za-z]*\(.*$/, "", line) }
    gsub(/"[^"]*"/, "\"\"", line)
    gsub(/'[{}();\/"]'/, "0", line)
    if (in_comment) { if (match(line, /\*\//)) { line = substr(line, RSTART + 2); in_comment = 0 } else next }
    while (match(line, /\/\*/)) {
        rest = substr(line, RSTART)
        if (match(rest, /\*\//)) sub(/\/\*([^*]|\*+[^*\/])*\*+\//, " ", line)
        else { sub(/\/\*.*$/, "", line); in_comment = 1 }
        if (in_comment) break
    }
    sub(/\/\/.*$/, "", line)
    count = split(line, parts, /[{};]/)
    at = 0
    for (i = 1; i <= count; ++i) {
        at += length(parts[i]) + 1
        if (text == "") { sub(/^ +/, "", parts[i]); if (parts[i] != "") started = FNR }
        text = text parts[i]
        if (i == count) break
        sign = substr(line, at, 1)
        inside = kind[depth]
        if (sign == "{") {
            gsub(/ +/, " ", text)
            sub(/^ /, "", text); sub(/ $/, "", text)
            while (sub(/^(public|private|protected) *: */, "", text)) continue
            what = kind_of(text, inside)
            if (inside == "type" && what == "function") ++methods[depth]
            ++depth
            kind[depth] = what
            begun[depth] = started
            named[depth] = (what == "type" || what == "function") ? name_of(text, what) : ""
            fields[depth] = 0
            methods[depth] = 0
            kept[depth] = (what == "other" && (inside == "type")) ? text : ""
            text = ""
        } else if (sign == "}") {
            if (kind[depth] == "function")
                printf "function\t%d\t%s:%d\t%s\n", FNR - begun[depth] + 1, FILENAME, begun[depth], named[depth]
            else if (kind[depth] == "type")
                printf "type\t%d\t%d\t%d\t%s:%d\t%s\n", fields[depth], methods[depth], FNR - begun[depth] + 1, FILENAME, begun[depth], named[depth]
            # An initialiser in braces belongs to a field, whose declaration ends at the semicolon.
            text = kept[depth]
            if (depth > 0) --depth
        } else {
            if (inside == "type") declare(text)
            text = ""
        }
    }
    if (text != "") text = text " "
}
