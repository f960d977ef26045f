// The names of files that are written one after the other: frames/frame_0000.png and so on.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace relief {

struct NumberedFiles {
    std::filesystem::path folder;
    std::string head;         ///< "frame_"
    std::string ending;       ///< ".png"
    std::uint32_t count = 0;  ///< they are numbered from 0

    /// The folder's file of this number, which has four digits or more.
    [[nodiscard]] std::filesystem::path path(std::uint32_t number) const;
    /// Whether a file of the folder is one of them.
    [[nodiscard]] bool hold(const std::string& name) const;
};

}  // namespace relief
