#include "formats/base/numbered_files.h"

#include <algorithm>
#include <string_view>

#include "formats/base/text.h"

namespace relief {

std::filesystem::path NumberedFiles::path(std::uint32_t number) const {
    const std::string digits = std::to_string(number);
    return folder / (head + std::string(4 - std::min<std::size_t>(digits.size(), 4), '0') + digits + ending);
}

bool NumberedFiles::hold(const std::string& name) const {
    if (name.size() <= head.size() + ending.size() || !std::string_view(name).starts_with(head) ||
        !std::string_view(name).ends_with(ending)) {
        return false;
    }
    const auto number =
        parseUnsigned(std::string_view(name).substr(head.size(), name.size() - head.size() - ending.size()));
    return number && *number < count && path(static_cast<std::uint32_t>(*number)).filename() == name;
}

}  // namespace relief
