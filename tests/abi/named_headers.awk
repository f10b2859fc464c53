# Which files use what of the standard library without naming its header, themselves or by what of ours
# they include: with headers that were compiled before they would compile all the same.
# Variables: list (a file of paths), roots (folders that includes start from, colons between).
function where(name, from,   k, folder, parts) {
    folder = from
    sub(/[^\/]*$/, "", folder)
    if ((folder name) in known) return folder name
    split(roots, parts, ":")
    for (k = 1; k in parts; ++k)
        if ((parts[k] "/" name) in known) return parts[k] "/" name
    return ""
}
function reaches(file, header, question,   i, next_) {
    if ((file, header) in named) return 1
    if (asked[file] == question) return 0
    asked[file] = question
    for (i = 1; i <= owns[file]; ++i) {
        next_ = where(own[file, i], file)
        if (next_ != "" && reaches(next_, header, question)) return 1
    }
    return 0
}
function read(file,   line, header) {
    while ((getline line < file) > 0) {
        sub(/\/\/.*/, "", line)
        if (match(line, /^#include [<"][^>"]+/)) {
            if (substr(line, 10, 1) == "<") named[file, substr(line, 11, RLENGTH - 10)] = 1
            else own[file, ++owns[file]] = substr(line, 11, RLENGTH - 10)
            continue
        }
        for (header in names)
            if (!((file, header) in uses) && line ~ "std::" names[header] "($|[^A-Za-z0-9_])") uses[file, header] = line
    }
    close(file)
}
BEGIN {
    names["algorithm"] = "(min|max|clamp|minmax|sort|stable_sort|find|find_if|any_of|all_of|none_of|copy|copy_n|copy_if|fill|fill_n|lower_bound|upper_bound|equal_range|unique|remove|remove_if|count|count_if|reverse|rotate|transform|nth_element|max_element|min_element|is_sorted|binary_search|partial_sort|mismatch|replace|equal)"
    names["array"] = "array"
    names["atomic"] = "(atomic|atomic_flag|atomic_thread_fence)"
    names["bit"] = "(popcount|countr_zero|countl_zero|countr_one|bit_cast|bit_ceil|bit_floor|bit_width|has_single_bit|rotl|rotr)"
    names["chrono"] = "chrono"
    names["cmath"] = "(sqrt|fabs|floor|ceil|round|lround|llround|pow|exp|exp2|log|log2|sin|cos|tan|atan2|acos|asin|hypot|fmod|isfinite|isnan|cbrt|trunc|lerp|copysign|ldexp|frexp)"
    names["cstring"] = "(memcpy|memset|memcmp|memmove|strcmp|strncmp|strlen|strstr|strchr)"
    names["functional"] = "(function|hash|greater|less)"
    names["limits"] = "numeric_limits"
    names["memory_resource"] = "pmr::(memory_resource|get_default_resource|polymorphic_allocator|monotonic_buffer_resource|null_memory_resource)"
    names["mutex"] = "(mutex|lock_guard|unique_lock|scoped_lock)"
    names["numeric"] = "(accumulate|iota|gcd|lcm|midpoint|inner_product|partial_sum)"
    names["optional"] = "(optional|nullopt)"
    names["span"] = "(span|as_bytes|as_writable_bytes)"
    names["string"] = "(pmr::)?(string|to_string)"
    names["tuple"] = "(tuple|tie|make_tuple)"
    names["utility"] = "(pair|exchange|make_pair|index_sequence|to_underlying)"
    names["vector"] = "(pmr::)?vector"
    while ((getline file < list) > 0) {
        files[++count] = file
        known[file] = 1
        read(file)
    }
    for (i = 1; i <= count; ++i)
        for (header in names)
            if ((files[i], header) in uses && !reaches(files[i], header, i header))
                print files[i] ": " uses[files[i], header] "   <- nothing it includes names <" header ">"
}
