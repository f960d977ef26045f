// SPDX-License-Identifier: Apache-2.0
// Browser implementations of functions that other files define on desktops: capabilities of a WebGL2 context, state
// around a pass, read-back, zstd with the page's decoder, and loading files of a world without a thread. The
// functions of OpenGL ES 3.1 are stubs that are never called, because hasCompute() returns false.
#include <deque>
#include <optional>
#include <string>
#include <utility>

#include "formats/compression.h"
#include "formats/container_reader.h"
#include "runtime/gl/buffer_read.h"
#include "runtime/gl/gl_capabilities.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"
#include "runtime/player/watchdog.h"
#include "runtime/stream/collider_source.h"

extern "C" {
int relief_js_has_extension(const char* name);
int relief_js_is_lost();
int relief_js_is_software();
void relief_js_save_state(int units);
void relief_js_restore_state();
void relief_js_read_buffer(unsigned buffer, unsigned offset, void* out, unsigned bytes);
int relief_js_decompress(const void* stored, int stored_size, void* raw, int raw_size);
}

namespace relief {

bool isGles() {
    return true;
}

bool isSoftwareRenderer() {
    return relief_js_is_software() != 0;
}

bool hasCompute() {
    return false;
}

bool hasGlExtension(const char* name) {
    return relief_js_has_extension(name) != 0;
}

bool gpuWasReset() {
    return relief_js_is_lost() != 0;
}

// The page's textures and buffers have no GL names in this module, so pass_state.js saves the state. Steps already run
// in a pass (api.cpp), so a sequence does nothing.
struct PassState::Saved {};

PassState::PassState(Scope scope) : scope_(scope) {
    if (scope_ == Scope::kPass) {
        relief_js_save_state(kUnits);
    }
}

PassState::~PassState() {
    if (scope_ == Scope::kPass) {
        relief_js_restore_state();
    }
}

// WebGL2 cannot map buffers or wait for fences; getBufferSubData() replaces both.
bool waitToRead(const GlFence&, GLuint64) {
    return true;
}

bool readBuffer(const GlBuffer& buffer, std::size_t offset, std::span<std::byte> out) {
    relief_js_read_buffer(buffer.name(), static_cast<unsigned>(offset), out.data(),
                          static_cast<unsigned>(out.size()));
    return true;
}

Result<std::vector<std::byte>> compress(std::span<const std::byte>, int) {
    return fail(ErrorCode::kUnsupported, "browsers cannot compress; write the collider without zstd");
}

Result<std::vector<std::byte>> decompress(std::span<const std::byte> stored, std::uint64_t raw_size) {
    std::vector<std::byte> raw(static_cast<std::size_t>(raw_size));
    const int size = relief_js_decompress(stored.data(), static_cast<int>(stored.size()), raw.data(),
                                          static_cast<int>(raw.size()));
    if (size < 0) {
        return invalidInput("its payload is not a zstd frame, or does not decompress");
    }
    if (static_cast<std::size_t>(size) != raw.size()) {
        return invalidInput("its payload decompresses to " + std::to_string(size) + " bytes, not " +
                            std::to_string(raw_size));
    }
    return raw;
}

namespace {

/// Reads containers from the in-memory file system when take() is called.
class MemorySource : public ColliderSource {
  public:
    MemorySource(World world, std::filesystem::path folder, const ContainerLimits& limits)
        : world_(std::move(world)), folder_(std::move(folder)), limits_(limits) {}

    void request(std::size_t collider) override { requests_.push_back(collider); }

    std::optional<Arrival> take() override {
        if (requests_.empty()) {
            return std::nullopt;
        }
        const std::size_t first = requests_.front();
        requests_.pop_front();
        return Arrival{first, withinMemory([&]() -> Result<Collider> {
                           return loadWorldCollider(world_, first, WorldDetail::kFine, folder_, limits_);
                       })};
    }

  private:
    const World world_;
    const std::filesystem::path folder_;
    const ContainerLimits limits_;
    std::deque<std::size_t> requests_;
};

}  // namespace

Result<std::unique_ptr<ColliderSource>> makeFileSource(World world, std::filesystem::path folder,
                                                       const ContainerLimits& limits) {
    return std::make_unique<MemorySource>(std::move(world), std::move(folder), limits);
}

// Browsers have their own GPU watchdog, so Watchdog does nothing.
void Watchdog::feed(const std::string&) {}
void Watchdog::rest() {}

}  // namespace relief

extern "C" {
void glDispatchCompute(GLuint, GLuint, GLuint) {}
void glMemoryBarrier(GLbitfield) {}
void glDrawArraysIndirect(GLenum, const void*) {}
void glBindImageTexture(GLuint, GLuint, GLint, GLboolean, GLint, GLenum, GLenum) {}
}
