// SPDX-License-Identifier: Apache-2.0
// Executes the texts of shaders/engines as C++ with stand-in types, and compares them with the CPU's field. This tests
// each text's arithmetic, also that of MSL and of Godot's language, for which no compiler is available here. WGSL is
// executed in a browser (tests/web).

#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "tests/engines/engine_agreement.h"
#include "tests/engines/stand_in/shader_types.h"

namespace relief::stand_in {
namespace Glsl {
#include "tests/engines/stand_in/shader_words_begin.h"
//
#include "shaders/engines/relief.glsl"
#include "tests/engines/stand_in/shader_words_end.h"
}  // namespace Glsl
namespace Hlsl {
#include "tests/engines/stand_in/shader_words_begin.h"
//
#include "shaders/engines/relief.hlsl"
#include "tests/engines/stand_in/shader_words_end.h"
}  // namespace Hlsl
namespace Msl {
#include "tests/engines/stand_in/shader_words_begin.h"
//
#include "shaders/engines/relief.metal"
#include "tests/engines/stand_in/shader_words_end.h"
}  // namespace Msl
namespace Godot {
#include "tests/engines/stand_in/shader_words_begin.h"
//
#include "shaders/engines/relief.gdshaderinc"
#include "tests/engines/stand_in/shader_words_end.h"
}  // namespace Godot
}  // namespace relief::stand_in

namespace relief::engines {
namespace {

using stand_in::Real3;
using stand_in::Real4;

Real3 real3(const glm::vec4& a) {
    return {a.x, a.y, a.z};
}
Real4 real4(const glm::vec4& a) {
    return {real3(a), a.w};
}
glm::vec4 vec4(const Real3& a, stand_in::Real w) {
    return {a.x.value, a.y.value, a.z.value, w.value};
}

/// The cases of all texts.
const std::vector<Case>& casesOf(std::size_t points) {
    static std::map<std::size_t, std::vector<Case>> all;
    std::vector<Case>& cases = all[points];
    if (cases.empty()) {
        cases = makeCases(points);
    }
    return cases;
}

/// \param distance, collide  reliefDistance() and reliefCollide() of a text.
template <class Collider, class Texture>
void expectTheCpuField(std::size_t points, auto distance, auto collide) {
    for (const Case& one : casesOf(points)) {
        SCOPED_TRACE(one.name);
        const PatchConstants& own = one.constants;
        const Collider collider{real4(own.row[0]),
                                real4(own.row[1]),
                                real4(own.row[2]),
                                real4(own.size),
                                {own.place[0], own.place[1], own.place[2], own.place[3]}};
        const Texture texels{&one.texels};
        std::vector<Answer> answers;
        answers.reserve(one.queries.size());
        for (const Query& query : one.queries) {
            const Real3 p = real3(query.point);
            const glm::vec4& by = query.reaction;
            const auto surface = distance(texels, collider, p);
            const auto motion = collide(texels, collider, p, real3(query.velocity), by.x, by.y, by.z);
            answers.push_back({vec4(surface.normal, surface.distance), vec4(motion.position, motion.distance),
                               vec4(motion.velocity, 0), vec4(motion.normal, 0)});
        }
        expectEqualFields(one, answers, Match::kBits);
    }
}

#define RELIEF_TEXT_TEST(language, points, Texture)                                       \
    TEST(EngineText, language##EqualsTheCpuAt##points##Points) {                          \
        expectTheCpuField<stand_in::language::ReliefCollider, Texture>(                   \
            points, [](auto... in) { return stand_in::language::reliefDistance(in...); }, \
            [](auto... in) { return stand_in::language::reliefCollide(in...); });         \
    }
RELIEF_TEXT_TEST(Glsl, 4000, stand_in::Texels)
RELIEF_TEXT_TEST(Glsl, 100000, stand_in::Texels)
RELIEF_TEXT_TEST(Hlsl, 4000, stand_in::Texture2D<stand_in::uint4>)
RELIEF_TEXT_TEST(Hlsl, 100000, stand_in::Texture2D<stand_in::uint4>)
RELIEF_TEXT_TEST(Msl, 4000, stand_in::texture2d<stand_in::uint>)
RELIEF_TEXT_TEST(Msl, 100000, stand_in::texture2d<stand_in::uint>)
RELIEF_TEXT_TEST(Godot, 4000, stand_in::Texels)
RELIEF_TEXT_TEST(Godot, 100000, stand_in::Texels)

}  // namespace
}  // namespace relief::engines
