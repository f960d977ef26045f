// SPDX-License-Identifier: Apache-2.0
#include "runtime/picture/particle_look.h"

#include <algorithm>
#include <string>

#include "runtime/picture/collider_view.h"

namespace relief {
namespace {

// Cell numbers are floats on the GPU; this is far above any atlas.
constexpr std::uint32_t kCellMax = 1U << 20;

bool within(float value, float low, float high) {
    return value >= low && value <= high;  // false for NaN
}

bool within(const glm::vec3& value, float low, float high) {
    return within(value.x, low, high) && within(value.y, low, high) && within(value.z, low, high);
}

constexpr float kHuge = 1e30F;
constexpr const char* kOutOfRange = "a value is out of range or not finite";

template <class T>
std::string trackFault(const AgeTrack<T>& track, const char* name, float low, float high) {
    if (track.size() > kLookKeysMax) {
        return std::string(name) + " has " + std::to_string(track.size()) + " keys; the maximum is " +
               std::to_string(kLookKeysMax);
    }
    float before = -1.0F;
    for (const AgeKey<T>& key : track) {
        if (!(within(key.age, 0.0F, 1.0F) && key.age > before)) {
            return std::string("the ages of ") + name + " are not ascending within 0 to 1";
        }
        if (!within(key.value, low, high)) {
            return kOutOfRange;
        }
        before = key.age;
    }
    return {};
}

std::string lookFault(const ParticleLook& look) {
    for (const std::string& problem :
         {trackFault(look.size, "size", 0.0F, kHuge), trackFault(look.color, "color", 0.0F, 1.0F),
          trackFault(look.opacity, "opacity", 0.0F, 1.0F),
          trackFault(look.rotation, "rotation", -kHuge, kHuge)}) {
        if (!problem.empty()) {
            return problem;
        }
    }
    for (const float value : {look.rotation_spread, look.spin_spread, look.stretch,
                              look.fade_in.value_or(0.0F), look.fade_out.value_or(0.0F)}) {
        if (!within(value, 0.0F, kHuge)) {
            return kOutOfRange;
        }
    }
    if (look.cell_first && (*look.cell_first > look.cell_last || look.cell_last > kCellMax)) {
        return "the last cell is before the first, or above " + std::to_string(kCellMax);
    }
    return {};
}

/// Returns the ages of all keys of all tracks in ascending order; at least one.
std::vector<float> agesOf(const ParticleLook& look) {
    std::vector<float> ages;
    const auto add = [&](const auto& track) {
        for (const auto& key : track) {
            ages.push_back(key.age);
        }
    };
    add(look.size);
    add(look.color);
    add(look.opacity);
    add(look.rotation);
    std::sort(ages.begin(), ages.end());
    ages.erase(std::unique(ages.begin(), ages.end()), ages.end());
    if (ages.empty()) {
        ages.push_back(0.0F);
    }
    return ages;
}

void packRow(const ParticleLook& look, const LookDefaults& defaults, std::span<const float> ages,
             glm::vec4* row) {
    AgeTrack<glm::vec3> color = look.color;
    for (AgeKey<glm::vec3>& key : color) {
        key.value = linearColor(key.value);
    }
    const glm::vec3 plain = linearColor(defaults.color);
    row[0] = {look.rotation_spread, look.spin_spread, -1.0F, 0.0F};
    if (look.cell_first) {
        row[0].z = static_cast<float>(*look.cell_first);
        row[0].w = static_cast<float>(look.cell_last - *look.cell_first + 1);
    }
    row[1] = {look.lit ? 1.0F : 0.0F, look.fade_in.value_or(defaults.fade_in),
              look.fade_out.value_or(defaults.fade_out), static_cast<float>(ages.size())};
    row[2] = {look.stretch, 0.0F, 0.0F, 0.0F};
    for (std::size_t k = 0; k < ages.size(); ++k) {
        glm::vec4* const key = row + kLookHeadTexels + kLookKeyTexels * k;
        key[0] = {ages[k], valueAt(look.size, ages[k], defaults.size),
                  valueAt(look.opacity, ages[k], defaults.opacity), valueAt(look.rotation, ages[k], 0.0F)};
        key[1] = glm::vec4(valueAt(color, ages[k], plain), 0.0F);
    }
}

}  // namespace

Result<PackedLooks> packLooks(std::span<const ParticleLook> looks, const LookDefaults& defaults) {
    if (looks.size() > kLooksMax) {
        return fail(ErrorCode::kUsage, std::to_string(looks.size()) + " particle looks; the maximum is " +
                                           std::to_string(kLooksMax));
    }
    for (std::size_t i = 0; i < looks.size(); ++i) {
        if (const std::string problem = lookFault(looks[i]); !problem.empty()) {
            return fail(ErrorCode::kUsage, "the look of particle type " + std::to_string(i) + ": " + problem);
        }
    }
    const std::vector<ParticleLook> plain(looks.empty() ? 1 : 0);
    const std::span<const ParticleLook> rows = looks.empty() ? std::span<const ParticleLook>(plain) : looks;
    std::vector<std::vector<float>> ages;
    PackedLooks packed;
    for (const ParticleLook& look : rows) {
        ages.push_back(agesOf(look));
        packed.width = std::max(packed.width, kLookHeadTexels + kLookKeyTexels * ages.back().size());
    }
    packed.texels.resize(rows.size() * packed.width, glm::vec4(0.0F));
    for (std::size_t i = 0; i < rows.size(); ++i) {
        packRow(rows[i], defaults, ages[i], &packed.texels[i * packed.width]);
    }
    return packed;
}

}  // namespace relief
