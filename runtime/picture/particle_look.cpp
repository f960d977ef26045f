#include "runtime/picture/particle_look.h"

#include <algorithm>
#include <string>

#include "runtime/picture/collider_view.h"

namespace relief {
namespace {

// Counted in floats on the GPU: far above what any atlas holds.
constexpr std::uint32_t kCellMax = 1U << 20;

template <class T>
std::string trackProblem(const AgeTrack<T>& track, const char* name) {
    if (track.size() > kLookKeysMax) {
        return std::string(name) + " has " + std::to_string(track.size()) + " keys; give " +
               std::to_string(kLookKeysMax) + " at most";
    }
    float before = -1.0F;
    for (const AgeKey<T>& key : track) {
        if (!(key.age >= 0.0F && key.age <= 1.0F && key.age > before)) {
            return std::string("the ages of ") + name + " do not rise within 0 to 1";
        }
        before = key.age;
    }
    return {};
}

bool within(float value, float low, float high) {
    return value >= low && value <= high;  // false for NaN
}

std::string lookProblem(const ParticleLook& look) {
    for (const std::string& problem :
         {trackProblem(look.size, "size"), trackProblem(look.color, "color"),
          trackProblem(look.opacity, "opacity"), trackProblem(look.rotation, "rotation")}) {
        if (!problem.empty()) {
            return problem;
        }
    }
    constexpr float kHuge = 1e30F;
    bool good = within(look.turn, 0.0F, kHuge) && within(look.spin, 0.0F, kHuge) &&
                within(look.stretch, 0.0F, kHuge) && within(look.fade_in.value_or(0.0F), 0.0F, kHuge) &&
                within(look.fade_out.value_or(0.0F), 0.0F, kHuge);
    for (const auto& key : look.size) {
        good = good && within(key.value, 0.0F, kHuge);
    }
    for (const auto& key : look.opacity) {
        good = good && within(key.value, 0.0F, 1.0F);
    }
    for (const auto& key : look.rotation) {
        good = good && within(key.value, -kHuge, kHuge);
    }
    for (const auto& key : look.color) {
        for (int i = 0; i < 3; ++i) {
            good = good && within(key.value[i], 0.0F, 1.0F);
        }
    }
    if (!good) {
        return "a value is out of its range or not finite";
    }
    if (look.cell_first && (*look.cell_first > look.cell_last || look.cell_last > kCellMax)) {
        return "the cells do not go from a first to a last";
    }
    return {};
}

template <class T>
void addAges(const AgeTrack<T>& track, std::vector<float>& ages) {
    for (const AgeKey<T>& key : track) {
        ages.push_back(key.age);
    }
}

/// The ages that any track has a key at, rising; at least one.
std::vector<float> agesOf(const ParticleLook& look) {
    std::vector<float> ages;
    addAges(look.size, ages);
    addAges(look.color, ages);
    addAges(look.opacity, ages);
    addAges(look.rotation, ages);
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
    row[0] = {look.turn, look.spin, -1.0F, 0.0F};
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
        return fail(ErrorCode::kUsage, std::to_string(looks.size()) +
                                           " looks of particles are more than the " +
                                           std::to_string(kLooksMax) + " that Relief takes");
    }
    for (std::size_t i = 0; i < looks.size(); ++i) {
        if (const std::string problem = lookProblem(looks[i]); !problem.empty()) {
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
