#include "shaders/shader_constants.h"

#include <array>
#include <cmath>
#include <limits>

#include "formats/base/float_chars.h"
#include "formats/depth_map.h"
#include "formats/nearest_surface.h"
#include "formats/normal_index.h"

namespace relief {
namespace {

/// As short as reads back as the same float.
std::string literal(float value) {
    if (std::abs(value) == std::numeric_limits<float>::max()) {
        // ANGLE, which browsers compile with, takes its shortest digits for infinite. This is exact: (2^24 - 1) 2^104.
        return std::string(value < 0.0F ? "-" : "") + "16777215.0 * 2.028240960365167e31";
    }
    std::array<char, 32> digits{};
    const auto end = toChars(digits.data(), digits.data() + digits.size(), value).ptr;
    std::string text(digits.data(), end);
    return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}
std::string literal(int value) {
    return std::to_string(value);
}

/// A code that shaders keep in a float texture or uniform.
template <class Code>
float asFloat(Code code) {
    return static_cast<float>(code);
}

std::string makeConstants() {
    std::string lines;
    const auto define = [&](const char* name, auto value) {
        // One word is left as it is: GLSL ES has no expressions in layout(…).
        const std::string text = literal(value);
        const bool word = text.front() != '-' && text.find(' ') == std::string::npos;
        lines += std::string("#define RELIEF_") + name + " " + (word ? text : "(" + text + ")") + "\n";
    };
    define("FLOAT32", static_cast<int>(MapFormat::kFloat32));
    define("FRONT_BACK_HALF", static_cast<int>(MapFormat::kFrontBackHalf));
    define("CUBE8", static_cast<int>(MapFormat::kCube8));
    define("FRONT_BACK_FIXED", static_cast<int>(MapFormat::kFrontBackFixed));
    define("KEEPS_FARTHEST", static_cast<int>(kKeepsFarthest));
    define("ENCLOSES", static_cast<int>(kEncloses));
    define("EMPTY_IS_OUTSIDE", static_cast<int>(kEmptyIsOutside));
    define("DECODES_PLANE", static_cast<int>(kDecodesPlane));
    define("IS_GAP", static_cast<int>(kIsGap));
    define("HAS_ROWS", static_cast<int>(kHasRows));
    define("FAR_INSIDE", Vote{}.distance);
    define("FAR_OUTSIDE", kFarOutside);
    define("CUBE_DEPTH_MAX", kCubeDepthMax);
    define("DEPTH_STEPS", static_cast<float>(kDepthSteps));
    define("DEPTH_SLACK", static_cast<float>(kDepthSlack));
    define("GRAZING", static_cast<float>(kGrazingCosine));
    define("STANDING_COSINE", kStandingCosine);
    define("NORMAL_HALF_RANGE", kNormalHalfRange);
    define("NEAREST_EVALUATIONS_MAX", NearestSearch::kEvaluationsMax);
    define("NEAREST_STEPS", NearestSearch::kSteps);
    define("NEAREST_STEPS_FROM_PROBE", NearestSearch::kStepsFromProbe);
    define("NEAREST_BEYOND", NearestSearch::kBeyond);
    define("NEAREST_BEYOND_MIN", NearestSearch::kBeyondMin);
    define("NEAREST_BEYOND_MAX", NearestSearch::kBeyondMax);
    define("NEAREST_NEARER", NearestSearch::kNearer);
    define("NEAREST_FINEST_RING", NearestSearch::kFinestRing);
    define("NEAREST_FINEST_WHOLE_RING", NearestSearch::kFinestWholeRing);
    define("NEAREST_HALVINGS", NearestSearch::kHalvings);
    define("NEAREST_ROUNDS", NearestSearch::kRounds);
    define("NEAREST_SHARE_NEAR", NearestSearch::kShareNear);
    define("NEAREST_SHARE_FAR", NearestSearch::kShareFar);
    define("NEAREST_TURNS", NearestSearch::kTurns);
    define("NEAREST_TILT", NearestSearch::kTilt);
    define("NEAREST_TILT_MIN", NearestSearch::kTiltMin);
    define("NEAREST_REACH_MAX", NearestSearch::kReachMax);
    define("NEAREST_REACH_MIN", NearestSearch::kReachMin);
    define("NEAREST_DISTANCE_MIN", NearestSearch::kDistanceMin);

    define("BOUNCE", asFloat(OnCollision::kBounce));
    define("STOP", asFloat(OnCollision::kStop));
    define("SLIDE", asFloat(OnCollision::kSlide));
    define("DIE", asFloat(OnCollision::kDie));
    define("GROUND", kGroundBit);
    define("FREE", asFloat(Contact::kNone));
    define("COLLIDED", asFloat(Contact::kCollided));
    define("CAUGHT", asFloat(Contact::kCaught));
    define("STOPPED", asFloat(Contact::kStopped));
    define("EVENT_COLLISION", static_cast<int>(kEventCollision));
    define("EVENT_LASTS", static_cast<int>(kEventLasts));
    define("EVENT_DEATH", static_cast<int>(kEventDeath));
    define("EVENT_FLAGS", kEventFlags);
    define("EVENT_DIRECTIONS", kEventDirections);
    define("EVENTS_COUNTED", kEventsCounted);
    define("EVENTS_WIDTH", kEventsWidth);
    define("CONTACT_PARTS", kContactParts);
    define("VERLET_COLLISIONS_MAX", kVerletCollisionsMax);
    define("DEAD_HEIGHT", kDeadHeight);
    define("DEAD_COLLISIONS", kDeadCollisions);
    define("STEP_GROUP_WIDTH", kStepGroupWidth);
    define("STEP_GROUP_HEIGHT", kStepGroupHeight);
    define("TOUR_STORAGE", kTourStorage);
    define("RADIX_DIGITS", kRadixDigits);
    define("TILE_SIDE", kTileSide);
    define("TILE_WORDS", kTileWords);
    define("TILE_ENTRIES_MAX", kTileEntriesMax);
    define("BIRTH_GROUP", kBirthGroup);
    define("REDUCED_SIDE", kReducedSide);
    define("REDUCED_GROUP", kReducedGroup);
    define("COLLISIONS_HIGH", static_cast<float>(kCollisionsHigh));
    define("TYPE_CODES", kTypeCodes);
    define("SPEED_MAX", kSpeedMaxOfState);

    define("AIR_FIELDS_MAX", kAirFieldsMax);
    define("SIX_PI", kSixPi);
    define("CURL_CELL_MAX", kCurlCellMax);
    define("CURL_PATTERNS", kCurlPatterns);
    define("BEND", static_cast<int>(DeformKind::kBend));
    define("TWIST", static_cast<int>(DeformKind::kTwist));
    define("LOOK_HEAD_TEXELS", kLookHeadTexels);
    define("LOOK_KEY_TEXELS", kLookKeyTexels);
    define("SUN_WIDTH", kSunWidth);
    define("SKY_REACH", kSkyReach);
    define("SUN_SAMPLES", kSunSamples);
    define("NO_SHADE", kNoShade);
    define("QUAD_VERTICES", kQuadVertices);
    return lines;
}

}  // namespace

const std::string& shaderConstants() {
    static const std::string lines = makeConstants();
    return lines;
}

}  // namespace relief
