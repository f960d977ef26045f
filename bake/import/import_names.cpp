#include "bake/import/import_names.h"

#include <algorithm>
#include <utility>

#include "bake/mesh/mesh.h"
#include "formats/base/text.h"

namespace relief {
namespace {

/// Names that are remembered, to find the nearest to a wrong one, and those that a message lists.
constexpr std::size_t kNamesMax = 1000;
constexpr std::size_t kListedMax = 20;
constexpr std::size_t kListedBytesMax = 80;

}  // namespace

NameMarks::NameMarks(const std::vector<std::string>& asked, std::string file_name)
    : asked_(asked), file_name_(std::move(file_name)) {
    for (std::size_t i = 0; i < std::min(asked.size(), kAskedNamesMax); ++i) {
        marks_[asked[i]] = static_cast<std::uint8_t>(i + 1);
    }
}

std::uint8_t NameMarks::meet(std::string_view raw, bool listed) {
    std::string name = cleanUtf8(raw, kAskedNameBytesMax);
    if (name.empty()) {
        return 0;
    }
    if (listed && name != file_name_ && names_.size() < kNamesMax && listed_.insert(name).second) {
        names_.push_back(name);
    }
    const auto found = marks_.find(name);
    if (found == marks_.end()) {
        return 0;
    }
    met_.insert(found->second);
    return found->second;
}

Result<void> NameMarks::allMet(const std::string& shown) const {
    const auto unmet = std::find_if(asked_.begin(), asked_.end(), [&](const std::string& name) {
        const auto found = marks_.find(name);
        return found == marks_.end() || !met_.contains(found->second);
    });
    if (unmet == asked_.end()) {
        return {};
    }
    std::string text = shown + " names no triangles '" + cleanUtf8(*unmet, kAskedNameBytesMax) + "'";
    const std::vector<std::string_view> known(names_.begin(), names_.end());
    text += didYouMean(*unmet, known);
    if (known.empty()) {
        return fail(ErrorCode::kUsage, text + ", nor anything else; leave the name out");
    }
    text += text.ends_with("?") ? " It has " : "; it has ";
    for (std::size_t i = 0; i < std::min(known.size(), kListedMax); ++i) {
        text += (i == 0 ? "'" : ", '") + cleanUtf8(known[i], kListedBytesMax) + "'";
    }
    return fail(ErrorCode::kUsage, text + (known.size() > kListedMax ? " and more" : ""));
}

}  // namespace relief
