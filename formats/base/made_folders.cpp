// SPDX-License-Identifier: Apache-2.0
#include "formats/base/made_folders.h"

#include <unistd.h>

#include <system_error>

#include "formats/base/file_io.h"

namespace relief {

namespace fs = std::filesystem;

MadeFolders::~MadeFolders() {
    for (; !made_.empty(); made_.pop_back()) {
        ::rmdir(made_.back().c_str());  // fails if not empty
    }
}

Result<void> MadeFolders::make(const fs::path& path, std::string_view option) {
    std::error_code error;
    fs::path folder;
    for (const fs::path& part : path) {
        folder /= part;
        if (!fs::exists(folder, error)) {
            made_.push_back(folder);
        }
    }
    return preflightFolder(path, option);
}

}  // namespace relief
