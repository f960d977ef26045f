#include "formats/base/destination.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

constexpr int kLinksMax = 40;  // as Linux follows

/// weakly_canonical takes a dangling link for a file that does not exist yet, and leaves it as it is.
fs::path settled(const fs::path& path, std::error_code& error) {
    fs::path result = fs::weakly_canonical(fs::absolute(path, error), error);
    // A folder that does not exist keeps the slash at its end, which would count as a part.
    return result.has_filename() ? result : result.parent_path();
}

}  // namespace

fs::path destination(const fs::path& path, std::error_code& error) {
    fs::path result = settled(path, error);
    for (int i = 0; i < kLinksMax && !error; ++i) {
        fs::path walked;
        auto part = result.begin();
        for (; part != result.end(); ++part) {
            std::error_code none;
            if (fs::is_symlink(fs::symlink_status(walked / *part, none))) {
                break;
            }
            walked /= *part;
        }
        if (part == result.end()) {
            return result;
        }
        fs::path followed = walked / fs::read_symlink(walked / *part, error);
        for (++part; part != result.end(); ++part) {
            followed /= *part;
        }
        result = settled(followed, error);
    }
    if (!error) {
        error = std::make_error_code(std::errc::too_many_symbolic_link_levels);
    }
    return result;
}

}  // namespace relief
