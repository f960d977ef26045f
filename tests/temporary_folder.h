// SPDX-License-Identifier: Apache-2.0
// A temporary folder for a test.
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

namespace relief::test {

/// A folder that is deleted after the test.
class TemporaryFolder {
  public:
    TemporaryFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "relief-test-XXXXXX").string();
        if (::mkdtemp(name.data()) == nullptr) {
            ADD_FAILURE() << "no temporary folder";
        }
        path_ = name;
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder() {
        std::error_code error;
        std::filesystem::remove_all(path_, error);
    }

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    /// Writes a file with this name and returns its path.
    std::filesystem::path write(const std::string& name, std::string_view contents) const {
        const std::filesystem::path path = path_ / name;
        std::ofstream(path, std::ios::binary) << contents;
        return path;
    }

  private:
    std::filesystem::path path_;
};

}  // namespace relief::test
