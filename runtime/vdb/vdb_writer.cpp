// SPDX-License-Identifier: Apache-2.0
#include "runtime/vdb/vdb_writer.h"

#include <dlfcn.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

namespace relief {
namespace {

namespace fs = std::filesystem;

constexpr const char* kModule = "relief-vdb.so";

Result<VdbWriter*> load() {
    std::error_code error;
    const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
    std::string why = std::string(kModule) + " is missing";
    for (const fs::path& module : {folder / kModule, folder / "../lib/relief" / kModule}) {
        if (!fs::is_regular_file(module, error)) {
            continue;
        }
        // Never unload it: OpenVDB keeps threads and registries.
        void* const handle = ::dlopen(module.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
        void* const make = handle != nullptr ? ::dlsym(handle, "reliefVdbWriter") : nullptr;
        if (make != nullptr) {
            return reinterpret_cast<VdbWriter* (*)()>(make)();
        }
        why = ::dlerror();
    }
    return fail(ErrorCode::kUnsupported, "this build has no OpenVDB (" + why +
                                             "); install libopenvdb-dev and build Relief with "
                                             "-DRELIEF_BUILD_OPENVDB=ON");
}

}  // namespace

Result<VdbWriter*> vdbWriter() {
    static const Result<VdbWriter*> kLoaded = load();
    return kLoaded;
}

Result<void> checkVdb() {
    const auto writer = vdbWriter();
    return writer ? Result<void>() : forward(writer);
}

Result<std::vector<std::byte>> encodeVdbPoints(std::span<const VdbPoint> particles) {
    VdbWriter* const writer = RELIEF_TRY(vdbWriter());
    for (const VdbPoint& p : particles) {
        if (!std::isfinite(p.position.x) || !std::isfinite(p.position.y) || !std::isfinite(p.position.z)) {
            return fail(ErrorCode::kFailure,
                        "particle " + std::to_string(p.id) +
                            " has a position that is not finite; OpenVDB cannot store it");
        }
    }
    std::vector<VdbPoint> ordered(particles.begin(), particles.end());
    std::sort(ordered.begin(), ordered.end(),
              [](const VdbPoint& a, const VdbPoint& b) { return a.id < b.id; });
    return writer->points(ordered);
}

}  // namespace relief
