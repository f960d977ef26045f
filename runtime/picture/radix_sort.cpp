#include "runtime/picture/radix_sort.h"

#include <algorithm>
#include <string>

#include "runtime/gl/compute_units.h"
#include "runtime/gl/gl_capabilities.h"
#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "shaders/picture/constants.h"

namespace relief {
namespace {

constexpr int kPositionUnit = 0;

// Storage units, as the shaders have them.
constexpr GLuint kFromUnit = 0;
constexpr GLuint kToUnit = 1;
constexpr GLuint kCountsUnit = 2;
constexpr GLuint kTotalsUnit = 3;

constexpr std::uint32_t kDigits = kRadixDigits;
constexpr std::uint32_t kDigitBits = 8;
constexpr std::uint32_t kKeyDigits = 32 / kDigitBits;
static_assert(kDigits == 1U << kDigitBits && kKeyDigits % 2 == 0);
// More rows make blocks more numerous, then longer, then more numerous again: an H100's best for 2^16 to 2^24 particles.
constexpr std::uint32_t kBlocksFew = 512;
constexpr std::uint32_t kTurns = 8;
constexpr std::uint32_t kBlocksMax = 2048;

constexpr GLsizeiptr kElementBytes = 2 * sizeof(std::uint32_t);

std::uint32_t dividedUp(std::uint32_t a, std::uint32_t b) {
    return (a + b - 1) / b;
}

GLenum orderFormat() {
    return isGles() ? GL_RGBA32UI : GL_RG32UI;
}

Result<void> checkStorage(std::uint32_t capacity) {
    GLint64 most = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &most);
    GLint together = 0;
    glGetIntegerv(GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS, &together);
    if (most < GLint64{capacity} * kElementBytes || together < GLint{kRadixDigits}) {
        return fail(ErrorCode::kLimit,
                    "sorting " + std::to_string(capacity) + " particles needs storage blocks of " +
                        std::to_string(GLint64{capacity} * kElementBytes) + " bytes and work groups of " +
                        std::to_string(kRadixDigits) + ", and this GL has " + std::to_string(most) + " and " +
                        std::to_string(together) + "; choose a smaller capacity or the fragment path");
    }
    return {};
}

}  // namespace

Result<RadixSort> RadixSort::create(std::uint32_t capacity, std::uint32_t width) {
    RELIEF_TRY(checkStorage(capacity));
    const StorageUnits storage;
    RadixSort sort;
    forgetGlErrors();
    const auto allocated = [&] {
        return checkAllocated("sorting " + std::to_string(capacity) + " particles",
                              "choose a smaller capacity");
    };
    sort.order_ = makeImageTexture2D(orderFormat(), static_cast<GLsizei>(width),
                                     static_cast<GLsizei>(dividedUp(capacity, width)));
    RELIEF_TRY(allocated());
    for (GlBuffer& elements : sort.elements_) {
        elements = StorageUnits::make(capacity * kElementBytes);
        RELIEF_TRY(allocated());
    }
    const std::uint32_t blocks = std::min(dividedUp(capacity, kDigits), kBlocksMax);
    sort.counts_ = StorageUnits::make(GLsizeiptr{kDigits} * blocks * GLsizeiptr{sizeof(std::uint32_t)});
    sort.totals_ = StorageUnits::make(GLsizeiptr{kDigits} * GLsizeiptr{sizeof(std::uint32_t)});
    RELIEF_TRY(allocated());
    RELIEF_TRY(sort.createPrograms(width));
    return sort;
}

Result<void> RadixSort::createPrograms(std::uint32_t width) {
    const std::string last = "#define RELIEF_RADIX_LAST\n#define RELIEF_ORDER_WIDTH " +
                             std::to_string(width) + "\n#define RELIEF_RADIX_FORMAT " +
                             (isGles() ? "rgba32ui" : "rg32ui") + "\n";
    keys_ = RELIEF_TRY(makeComputeProgram("picture/radix_count.comp", "#define RELIEF_RADIX_FIRST\n"));
    count_ = RELIEF_TRY(makeComputeProgram("picture/radix_count.comp"));
    scan_ = RELIEF_TRY(makeComputeProgram("picture/radix_scan.comp"));
    move_ = RELIEF_TRY(makeComputeProgram("picture/radix_move.comp"));
    place_ = RELIEF_TRY(makeComputeProgram("picture/radix_move.comp", last));
    keys_.use();
    keys_.set("u_position", kPositionUnit);
    return {};
}

void RadixSort::dispatch(const GlProgram& program, const Cut& cut, std::uint32_t digit,
                         std::uint32_t groups) {
    program.use();
    program.set("u_count", cut.count);
    program.set("u_turns", cut.turns);
    program.set("u_blocks", cut.blocks);
    program.set("u_shift", digit * kDigitBits);
    glDispatchCompute(groups, 1, 1);
    StorageUnits::order();
}

void RadixSort::sort(const GlTexture& positions, std::uint32_t width, std::uint32_t extent,
                     const glm::vec3& eye) {
    const std::uint32_t rows = dividedUp(extent, kDigits);
    const std::uint32_t turns =
        std::max(std::min(dividedUp(rows, kBlocksFew), kTurns), dividedUp(rows, kBlocksMax));
    const Cut cut{extent, turns, dividedUp(rows, turns)};

    const StorageUnits storage;
    const ImageUnits images;
    StorageUnits::order();  // the last order may still be read
    StorageUnits::bind(kCountsUnit, counts_);
    StorageUnits::bind(kTotalsUnit, totals_);
    ImageUnits::write(0, order_, orderFormat());
    useTexture(kPositionUnit, positions);
    keys_.use();
    keys_.set("u_width", static_cast<GLint>(width));
    keys_.set("u_eye", eye);
    for (std::uint32_t digit = 0; digit < kKeyDigits; ++digit) {
        StorageUnits::bind(kFromUnit, elements_[digit % 2]);
        StorageUnits::bind(kToUnit, elements_[1 - digit % 2]);
        dispatch(digit == 0 ? keys_ : count_, cut, digit, cut.blocks);
        dispatch(scan_, cut, digit, kDigits);
        dispatch(digit + 1 == kKeyDigits ? place_ : move_, cut, digit, cut.blocks);
    }
    ImageUnits::finish();
}

}  // namespace relief
