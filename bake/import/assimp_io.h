// What assimp is given to read from and to log to.
#pragma once

#include <algorithm>
#include <assimp/IOSystem.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "bake/import/import_files.h"

namespace relief {

/// Files for assimp: the mesh from memory, and whatever it refers to (material libraries) as ImportFiles
/// allows. Nothing can be written.
class ReadOnlyFiles final : public Assimp::IOSystem {
  public:
    explicit ReadOnlyFiles(ImportFiles& files) : files_(files) {}

    bool Exists(const char* path) const override { return path != nullptr && files_.exists(path); }
    [[nodiscard]] char getOsSeparator() const override { return '/'; }
    Assimp::IOStream* Open(const char* path, const char* mode) override;
    void Close(Assimp::IOStream* stream) override;
    // assimp's own would touch the disk.
    bool CreateDirectory(const std::string& /*path*/) override { return false; }
    bool ChangeDirectory(const std::string& /*path*/) override { return false; }
    bool DeleteFile(const std::string& /*file*/) override { return false; }

  private:
    ImportFiles& files_;
};

/// The errors that assimp logs on this thread while this lives, and the warnings that say that it leaves a part of the
/// surface out. Where one of its readers mends a file, such as an index out of range, that is all it says. Use one at a
/// time on a thread.
class LoggedErrors {
  public:
    LoggedErrors();
    LoggedErrors(const LoggedErrors&) = delete;
    LoggedErrors& operator=(const LoggedErrors&) = delete;
    ~LoggedErrors();

    /// The first few, each once.
    [[nodiscard]] const std::vector<std::string>& errors() const { return errors_; }
    [[nodiscard]] bool say(std::string_view words) const {
        return std::any_of(errors_.begin(), errors_.end(),
                           [&](const std::string& error) { return error.find(words) != std::string::npos; });
    }

  private:
    std::vector<std::string> errors_;
};

}  // namespace relief
