// SPDX-License-Identifier: Apache-2.0
// Births where a surface touches another: exactly those of the unfiltered births that closed forms keep.
#include "runtime/scene/scene_touch.h"
#include "runtime/births/emitter_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>

#include "formats/container.h"
#include "formats/patch_tree.h"
#include "tests/formats/random_patches.h"
#include "tests/runtime/collider/analytic_collider.h"
#include "tests/runtime/scene/scene_text.h"
#include "tests/temporary_folder.h"

namespace relief {
namespace {

constexpr double kDt = 1.0 / 50;

/// A box of 2 x 0.5 x 2 whose top is at y = 0: oak where x < 0, earth elsewhere.
analytic::Shape slab() {
    return analytic::box({-1.0, -0.5, -1.0}, {1.0, 0.0, 1.0});
}

struct Born {
    Birth birth;
    double moment = 0.0;
};
struct Played {
    std::vector<Born> births;
    std::uint64_t rejected = 0;
};

/// Whether a birth is kept; nullopt if it is so near to the rule's edge that map errors may decide.
using Truth = std::function<std::optional<bool>(const glm::dvec3& p, double moment)>;

std::optional<bool> below(double value, double limit, double margin) {
    return std::abs(value - limit) < margin ? std::nullopt : std::optional(value < limit);
}

class SceneTouch : public testing::Test {
  protected:
    SceneTouch() {
        Collider box = analytic::frontBackCollider(slab(), 128);
        EXPECT_TRUE(saveCollider(folder_.path() / "bare.relief", box));
        box.materials.list = {{"oak"}, {"earth"}};
        box.materials.size = 2.0F;
        box.materials.origin = glm::vec3(-1.0F);
        box.materials.nodes.resize(1);
        box.materials.nodes[0].leaves = {0, 1, 0, 1, 0, 1, 0, 1};
        EXPECT_TRUE(saveCollider(folder_.path() / "box.relief", box));
        folder_.write("foot.obj", "v -0.5 0 -0.3\nv -0.5 0 0.3\nv 0.5 0 0.3\nv 0.5 0 -0.3\nf 1 2 3 4\n");
    }

    Result<LoadedScene> load(const std::string& text) {
        return loadAll(folder_.write("scene.toml", text), {});
    }
    /// \param room  capacity of each step.
    Played run(const std::string& text, double seconds, std::uint64_t room = 1U << 20) {
        Played made;
        LoadedScene loaded = required(load(text));
        const std::vector<EmitterMotion> motions = emitterMotions(loaded);
        for (int step = 0; step < std::lround(seconds / kDt); ++step) {
            std::vector<Birth> births;
            made.rejected += emitAll(loaded.emitters, kDt, room, births, motions, step * kDt);
            for (const Birth& birth : births) {
                made.births.push_back({birth, step * kDt - double{birth.age}});
            }
        }
        return made;
    }
    /// \param scene  ends with a surface emitter.
    /// \param keys  pose keys of that emitter.
    /// \return the number of births that touch something.
    std::size_t expectTruth(const std::string& scene, const std::string& touching, double seconds,
                            const Truth& truth, const std::string& keys = "") {
        const std::vector<Born> all = run(scene + keys, seconds).births;
        const std::vector<Born> kept =
            run(scene + "touching = { " + touching + " }\n" + keys, seconds).births;
        std::size_t next = 0;
        std::size_t unknown = 0;
        for (const Born& one : all) {
            const bool stays = next < kept.size() && kept[next].birth.position == one.birth.position &&
                               kept[next].birth.velocity == one.birth.velocity &&
                               kept[next].birth.age == one.birth.age && kept[next].moment == one.moment;
            next += stays ? 1 : 0;
            const glm::vec3& p = one.birth.position;
            const std::optional<bool> wanted = truth(p, one.moment);
            unknown += wanted ? 0 : 1;
            EXPECT_EQ(stays, wanted.value_or(stays))
                << p.x << " " << p.y << " " << p.z << " at " << one.moment;
        }
        EXPECT_EQ(next, kept.size()) << "births that the unfiltered run does not have";
        EXPECT_LT(unknown, all.size() / 10);
        return kept.size();
    }

    const test::TemporaryFolder folder_;
};

const std::string kNoGround = "ground = { enabled = false }\n";
const std::string kBoxCollider = "[[collider]]\nfile = \"box.relief\"\n";
const std::string kFoot = "[[emitter]]\nshape = \"surface\"\nmesh = \"foot.obj\"\nrate = 3000\nspeed = 0\n";

/// A footstep: the foot, otherwise at height 0.3, is down from 1 s to 2 s.
double footHeight(double time) {
    return 0.3 * std::clamp(std::max(1.0 - time, time - 2.0), 0.0, 1.0);
}
const std::string kStep =
    "[[emitter.key]]\ntime = 0\nposition = [0, 0.3, 0]\n[[emitter.key]]\ntime = 1\n"
    "[[emitter.key]]\ntime = 2\n[[emitter.key]]\ntime = 3\nposition = [0, 0.3, 0]\n";

TEST_F(SceneTouch, FeetRaiseDustOnlyWhileDown) {
    const auto dust = [&](const std::string& names, bool only_earth) {
        return expectTruth(
            kNoGround + kBoxCollider + kFoot, "within = 0.05" + names, 3.0,
            [&](const glm::dvec3& p, double time) -> std::optional<bool> {
                EXPECT_NEAR(footHeight(time), p.y, 1e-6);
                const auto down = below(footHeight(time), 0.05, 0.002);
                const auto earth = only_earth ? below(-p.x, 0.0, 0.002) : true;
                return down && earth ? std::optional(*down && *earth) : std::nullopt;
            },
            kStep);
    };
    // Half of the area or all of it, for 4/3 of 3 s; the bound is five standard deviations.
    EXPECT_NEAR(static_cast<double>(dust(", material = \"earth\"", true)), 2000.0, 200.0);
    EXPECT_NEAR(static_cast<double>(dust(", material = [\"earth\", \"oak\"]", false)), 4000.0, 240.0);
    EXPECT_NEAR(static_cast<double>(dust("", false)), 4000.0, 240.0);
}

/// Births far from patches are rejected by the box around them, without a search.
TEST_F(SceneTouch, FeetRaiseDustFromPatches) {
    Collider flat;
    flat.bounds = {{-1.0F, -1.5F, -1.0F}, {1.0F, 0.0F, 1.0F}};
    // One root, solid up to three quarters of its height: y = 0.
    const PatchHeights heights = PatchHeights::of(std::vector<double>(4, 0.75), 2);
    flat.maps = {test::patchesOf({{1, 1, 1}, 0}, {PatchRecord::patch({.first = 1}, false, heights, 2)})};
    flat.maps[0].object_to_map = {{{0.5F, 0, 0, 0.5F}, {0, 0.5F, 0, 0.75F}, {0, 0, 0.5F, 0.5F}}};
    flat.maps[0].object_per_map = glm::vec3(2.0F);
    ASSERT_TRUE(saveCollider(folder_.path() / "flat.relief", flat));
    const std::size_t dust = expectTruth(
        kNoGround + "[[collider]]\nfile = \"flat.relief\"\n" + kFoot, "within = 0.05", 3.0,
        [&](const glm::dvec3&, double time) { return below(footHeight(time), 0.05, 0.002); }, kStep);
    EXPECT_NEAR(static_cast<double>(dust), 4000.0, 240.0);
}

TEST_F(SceneTouch, MovingBodiesTouchTheSurface) {
    const std::string rises = kNoGround + kBoxCollider +
                              "[[collider.key]]\ntime = 0\nposition = [0.2, -1, 0]\n"
                              "[[collider.key]]\ntime = 1\nposition = [0.2, 0, 0]\n" +
                              kFoot;
    const std::size_t touched =
        expectTruth(rises, "within = 0.1, material = \"oak\"", 1.5, [](const glm::dvec3& p, double time) {
            const double top = std::min(time, 1.0) - 1.0;
            const auto near = below(-top, 0.1, 0.004);
            const auto oak = below(p.x, 0.2, 0.002);
            return near && oak ? std::optional(*near && *oak) : std::nullopt;
        });
    EXPECT_NEAR(static_cast<double>(touched), 3000 * 0.6 * 0.7, 150.0);
    // A foot inside the body does not touch its surface.
    const std::string deep =
        kNoGround + kBoxCollider + "position = [0, 0.25, 0]\n" + kFoot + "touching = { within = 0.2 }\n";
    EXPECT_TRUE(run(deep, 0.1).births.empty());
}

TEST_F(SceneTouch, SpeedIsRelativeToTheTouchedBody) {
    const auto keys = [](const std::string& of) {
        return "[[" + of + ".key]]\ntime = 0\nposition = [-0.2, 0, 0]\n[[" + of +
               ".key]]\ntime = 1\nposition = [0.2, 0, 0]\n";
    };
    const std::string slides = keys("collider");
    const std::string along = keys("emitter");
    const auto count = [&](const std::string& body_keys, const std::string& foot_keys, const char* speed) {
        return run(kNoGround + kBoxCollider + body_keys + kFoot +
                       "touching = { within = 0.05, min_speed = " + speed + " }\n" + foot_keys,
                   1.0)
            .births.size();
    };
    // The first births have times up to 0, when nothing moves.
    EXPECT_NEAR(static_cast<double>(count(slides, "", "0.39")), 2940.0, 1.0);
    EXPECT_EQ(count(slides, "", "0.41"), 0U);
    EXPECT_NEAR(static_cast<double>(count("", along, "0.39")), 2940.0, 1.0) << "the foot slides";
    EXPECT_EQ(count("", along, "0.41"), 0U);
    EXPECT_EQ(count(slides, along, "0.001"), 0U) << "both move together";
    EXPECT_EQ(count(slides, along, "0"), 3000U);
}

TEST_F(SceneTouch, RotatingBodiesAreFasterFartherOut) {
    const std::string turns = kNoGround + kBoxCollider +
                              "[[collider.key]]\ntime = 0\n[[collider.key]]\ntime = 1\nangle = 90\n" + kFoot;
    expectTruth(turns, "within = 0.05, min_speed = 0.5", 0.9, [](const glm::dvec3& p, double time) {
        const auto fast = below(-1.5707963 * std::hypot(p.x, p.z), -0.5, 1e-3);
        return time < 0.0 ? false : fast;
    });
}

TEST_F(SceneTouch, TheColliderOfTheSurfaceIsIgnored) {
    const std::string two = kNoGround + kBoxCollider +
                            "[[collider]]\nfile = \"bare.relief\"\nposition = [0.5, 0.55, 0]\n" +
                            "[[emitter]]\nshape = \"surface\"\nattach = 0\nrate = 4000\nspeed = 0\n";
    const std::size_t touching = expectTruth(two, "within = 0.1", 1.0, [](const glm::dvec3& p, double) {
        return below(std::abs(slab().distance(p - glm::dvec3(0.5, 0.55, 0.0))), 0.1, 0.03);
    });
    // 1.5 x 2 of the top, and strips beside it, of a surface of 12.
    EXPECT_GT(touching, 900U);
}

TEST_F(SceneTouch, NearestOfManyBodiesDecides) {
    std::string scene = kNoGround;
    std::vector<glm::dvec3> places;
    for (int i = 0; i < 500; ++i) {
        // A grid of slabs with side 0.16, some of them out of reach.
        const glm::dvec3 at(-0.6 + 0.05 * (i % 25), -0.01 * (i % 11), -0.5 + 0.05 * (i / 25));
        places.push_back(at);
        scene += std::string("[[collider]]\nfile = \"") + (i % 3 == 0 ? "bare" : "box") +
                 ".relief\"\nscale = 0.02\nposition = [" + std::to_string(at.x) + ", " +
                 std::to_string(at.y) + ", " + std::to_string(at.z) + "]\n";
    }
    scene += "[[collider]]\nfile = \"box.relief\"\nposition = [0, -0.03, 0]\n" + kFoot;
    const analytic::Shape shape = slab();
    const auto truth = [&](const glm::dvec3& p, double) -> std::optional<bool> {
        double nearest = std::abs(p.y + 0.03);
        double second = 0.04;
        double x = p.x;
        bool bare = false;
        for (std::size_t i = 0; i < places.size(); ++i) {
            const glm::dvec3 q = (p - places[i]) / 0.02;
            const double distance = 0.02 * std::abs(shape.distance(q));
            second = std::min(second, std::max(distance, nearest));
            if (distance < nearest) {
                nearest = distance;
                x = q.x * 0.02;
                bare = i % 3 == 0;
            }
        }
        const bool unknown = second - nearest < 5e-4 || std::abs(x) < 1e-3;
        return unknown ? std::nullopt : std::optional(!bare && x > 0.0);
    };
    EXPECT_GT(expectTruth(scene, "within = 0.04, material = \"earth\"", 0.5, truth), 300U);
}

TEST_F(SceneTouch, GroundHasNoMaterial) {
    const std::string scene =
        "ground = { height = -0.03 }\n[collider]\nfile = \"box.relief\"\n"
        "position = [0.8, -0.02, 0]\n" +
        kFoot;
    expectTruth(scene, "within = 0.05", 0.1, [](const glm::dvec3&, double) { return true; });
    // From x = -0.2 on, the box is 0.02 below, and around its edge.
    expectTruth(scene, "within = 0.025", 0.2,
                [](const glm::dvec3& p, double) { return below(-p.x, 0.2 + 0.015, 0.02); });
    // Beside the box the ground is nearer, except close to the box's edge.
    expectTruth(scene, "within = 0.05, material = [\"oak\", \"earth\"]", 0.2,
                [](const glm::dvec3& p, double) { return below(-p.x, 0.2 + std::sqrt(5e-4), 0.02); });
}

TEST_F(SceneTouch, DroppedBirthsUseNoCapacity) {
    const std::string scene = kNoGround + kBoxCollider + kFoot;
    const std::string earth = "touching = { within = 0.05, material = \"earth\" }\n";
    const Played whole = run(scene + earth, 0.2);
    const Played tight = run(scene + earth, 0.2, 20);
    EXPECT_EQ(whole.rejected, 0U);
    EXPECT_EQ(tight.births.size(), 200U);
    EXPECT_EQ(tight.births.size() + tight.rejected, whole.births.size());
    EXPECT_EQ(tight.births[19].birth.position, whole.births[19].birth.position);
}

TEST_F(SceneTouch, UnknownMaterialsAreErrors) {
    expectErrorOf(
        load(kBoxCollider + kFoot + "[emitter.touching]\nwithin = 1\nmaterial = [\"oak\",\n  \"erth\"]\n"),
        "scene.toml:11:3: emitter[0].touching.material = 'erth'");
}

}  // namespace
}  // namespace relief
