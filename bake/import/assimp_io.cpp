#include "bake/import/assimp_io.h"

#include <array>
#include <assimp/DefaultLogger.hpp>
#include <assimp/IOStream.hpp>
#include <cstring>
#include <optional>
#include <span>

#include "formats/base/text.h"

namespace relief {
namespace {

/// A file in memory.
class MemoryStream final : public Assimp::IOStream {
  public:
    explicit MemoryStream(std::span<const std::byte> bytes) : bytes_(bytes) {}
    explicit MemoryStream(std::vector<std::byte> owned) : owned_(std::move(owned)), bytes_(owned_) {}

    std::size_t Read(void* buffer, std::size_t size, std::size_t count) override {
        if (size == 0) {
            return 0;
        }
        const std::size_t whole = std::min(count, (bytes_.size() - at_) / size);
        if (whole > 0) {
            std::memcpy(buffer, bytes_.data() + at_, whole * size);
        }
        at_ += whole * size;
        return whole;
    }
    std::size_t Write(const void* /*buffer*/, std::size_t /*size*/, std::size_t /*count*/) override {
        return 0;
    }
    aiReturn Seek(std::size_t offset, aiOrigin origin) override {
        const std::size_t base = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? at_ : bytes_.size();
        // Negative offsets arrive as huge ones; the sum wraps round as it should.
        const std::size_t target = base + offset;
        if (target > bytes_.size()) {
            return aiReturn_FAILURE;
        }
        at_ = target;
        return aiReturn_SUCCESS;
    }
    [[nodiscard]] std::size_t Tell() const override { return at_; }
    [[nodiscard]] std::size_t FileSize() const override { return bytes_.size(); }
    void Flush() override {}

  private:
    std::vector<std::byte> owned_;
    std::span<const std::byte> bytes_;
    std::size_t at_ = 0;
};

thread_local std::vector<std::string>* errors_of_thread = nullptr;

/// Words of the warnings of its readers (BLEND, LWO, NFF, FBX, DXF, ASE) that a part of the surface is left out.
constexpr std::array<std::string_view, 9> kLeftOut = {
    "type is unsupported", "unsupported primitive chunk", "unknown polygon type",
    "unsupported ID",      "unrecognized geometry",       "INSERT within a BLOCK",
    "more than 4 indices", "not enough vertices",         "unexpected vertex setup"};

class Listener final : public Assimp::Logger {
  public:
    bool attachStream(Assimp::LogStream* /*stream*/, unsigned /*severity*/) override { return false; }
    bool detachStream(Assimp::LogStream* /*stream*/, unsigned /*severity*/) override { return false; }

  protected:
    void OnVerboseDebug(const char* /*message*/) override {}
    void OnDebug(const char* /*message*/) override {}
    void OnInfo(const char* /*message*/) override {}
    void OnWarn(const char* message) override {
        const std::string_view words(message);
        if (std::any_of(kLeftOut.begin(), kLeftOut.end(), [words](std::string_view part) {
                return words.find(part) != std::string_view::npos;
            })) {
            keep(message);
        }
    }
    void OnError(const char* message) override { keep(message); }

  private:
    static void keep(const char* message) {
        constexpr std::size_t kErrorsMax = 4;
        std::vector<std::string>* const errors = errors_of_thread;
        if (errors == nullptr || errors->size() >= kErrorsMax) {
            return;
        }
        const std::string line = oneCleanLine(message);
        // About what an import leaves out anyway.
        for (const char* other : {"aterial", "exture", "nimation", "angent", "inormal"}) {
            if (line.find(other) != std::string::npos) {
                return;
            }
        }
        if (std::find(errors->begin(), errors->end(), line) == errors->end()) {
            errors->push_back(line);
        }
    }
};

}  // namespace

Assimp::IOStream* ReadOnlyFiles::Open(const char* path, const char* mode) {
    if (path == nullptr || (mode != nullptr && std::strpbrk(mode, "wa+") != nullptr)) {
        return nullptr;
    }
    if (files_.isMesh(path)) {
        return new MemoryStream(files_.meshBytes());
    }
    std::optional<std::vector<std::byte>> bytes = files_.open(path);
    return bytes ? new MemoryStream(std::move(*bytes)) : nullptr;
}

void ReadOnlyFiles::Close(Assimp::IOStream* stream) {
    delete stream;
}

LoggedErrors::LoggedErrors() {
    static const bool kInstalled = [] {
        Assimp::DefaultLogger::set(new Listener);  // kept by assimp for the life of the process
        return true;
    }();
    static_cast<void>(kInstalled);
    errors_of_thread = &errors_;
}

LoggedErrors::~LoggedErrors() {
    errors_of_thread = nullptr;
}

}  // namespace relief
