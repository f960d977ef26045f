// std::bit_cast, which LLVM's standard library lacks up to version 13 (Debian's emscripten has that).
#pragma once

#include <type_traits>

namespace relief {

template <class To, class From>
[[nodiscard]] constexpr To bitCast(const From& from) {
    static_assert(sizeof(To) == sizeof(From) && std::is_trivially_copyable_v<To>);
    return __builtin_bit_cast(To, from);
}

}  // namespace relief
