// SPDX-License-Identifier: Apache-2.0
#include "runtime/picture/depth_sort.h"

#include <algorithm>
#include <bit>
#include <string>

#include "runtime/gl/compute_units.h"
#include "runtime/gl/gl_capabilities.h"
#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"
#include "shaders/picture/constants.h"

namespace relief {
namespace {

constexpr int kOrderUnit = 0;
constexpr int kPositionUnit = 1;

// Storage units, as in the shaders.
constexpr GLuint kFromUnit = 0;
constexpr GLuint kToUnit = 1;
constexpr GLuint kCountsUnit = 2;
constexpr GLuint kTotalsUnit = 3;

constexpr std::uint32_t kDigits = kRadixDigits;
constexpr std::uint32_t kDigitBits = 8;
constexpr std::uint32_t kKeyDigits = 32 / kDigitBits;
static_assert(kDigits == 1U << kDigitBits && kKeyDigits % 2 == 0);
// With more rows, first the number of blocks grows up to kBlocksFirst, then their length up to kTurnsFirst rows, then
// their number up to kBlocksMax. These values were the fastest on an H100 for 2^16 to 2^24 particles.
constexpr std::uint32_t kBlocksFirst = 512;
constexpr std::uint32_t kTurnsFirst = 8;
constexpr std::uint32_t kBlocksMax = 2048;

constexpr GLsizeiptr kElementBytes = 2 * sizeof(std::uint32_t);

std::uint32_t ceilDiv(std::uint32_t a, std::uint32_t b) {
    return (a + b - 1) / b;
}

GLenum orderFormat() {
    return isGles() ? GL_RGBA32UI : GL_RG32UI;
}

Result<void> checkStorage(std::uint32_t capacity) {
    GLint64 block_max = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &block_max);
    GLint group_max = 0;
    glGetIntegerv(GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS, &group_max);
    if (block_max < GLint64{capacity} * kElementBytes || group_max < GLint{kRadixDigits}) {
        return fail(ErrorCode::kLimit,
                    "sorting " + std::to_string(capacity) + " particles needs storage blocks of " +
                        std::to_string(GLint64{capacity} * kElementBytes) + " bytes and work groups of " +
                        std::to_string(kRadixDigits) + "; this GL context has " + std::to_string(block_max) +
                        " and " + std::to_string(group_max) +
                        "; choose a smaller capacity or the fragment path");
    }
    return {};
}

std::uint32_t regionFor(std::uint32_t extent) {
    return extent == 0 ? 0 : std::bit_ceil(extent);
}

}  // namespace

/// Exact drawing order by a radix sort in compute shaders, complete in each call (shaders/picture/radix.glsl).
///
///     bytes on the GPU = 24 · capacity and up to 2 MB:
///         elements  2 × 8 bytes (double-buffered)      index of a particle, key
///         counts    of 256 digits in up to 2048 blocks
///         order     RG32UI (RGBA32UI of 16 bytes on OpenGL ES, whose shaders cannot write RG32UI)
class RadixSort {
  public:
    /// Needs hasCompute(), and the state of a pass (PassState).
    /// \param capacity  1…2^24. \param width  texels in a row of order().
    /// Errors: kLimit (GL limits), kFailure.
    [[nodiscard]] static Result<RadixSort> create(std::uint32_t capacity, std::uint32_t width);

    /// Sorts particles with indices below `extent`, 1…capacity; otherwise like DepthSorter::update(). Changes the
    /// program and textures; restores image and storage units.
    void sort(const GlTexture& positions, std::uint32_t width, std::uint32_t extent, const glm::vec3& eye);

    /// One texel per rank: index (x) and key (y). The number of ranks is the `extent` of the last sort().
    [[nodiscard]] const GlTexture& order() const { return order_; }

  private:
    /// Division of the elements into blocks.
    struct Partition {
        std::uint32_t count, turns, blocks;
    };

    RadixSort() = default;
    static void dispatch(const GlProgram& program, const Partition& partition, std::uint32_t digit,
                         std::uint32_t groups);

    GlBuffer elements_[2];
    GlBuffer counts_;
    GlBuffer totals_;
    GlTexture order_;
    GlProgram keys_;   // counts the first digit
    GlProgram count_;  // counts the other digits
    GlProgram scan_;
    GlProgram move_;
    GlProgram place_;  // moves the last digit
};

Result<RadixSort> RadixSort::create(std::uint32_t capacity, std::uint32_t width) {
    RELIEF_TRY(checkStorage(capacity));
    const StorageUnits storage;
    RadixSort sort;
    clearGlErrors();
    const auto allocated = [&] {
        return checkAllocated("sorting " + std::to_string(capacity) + " particles",
                              "choose a smaller capacity");
    };
    sort.order_ = makeImageTexture2D(orderFormat(), static_cast<GLsizei>(width),
                                     static_cast<GLsizei>(ceilDiv(capacity, width)));
    RELIEF_TRY(allocated());
    for (GlBuffer& elements : sort.elements_) {
        elements = StorageUnits::make(capacity * kElementBytes);
        RELIEF_TRY(allocated());
    }
    const std::uint32_t blocks = std::min(ceilDiv(capacity, kDigits), kBlocksMax);
    sort.counts_ = StorageUnits::make(GLsizeiptr{kDigits} * blocks * GLsizeiptr{sizeof(std::uint32_t)});
    sort.totals_ = StorageUnits::make(GLsizeiptr{kDigits} * GLsizeiptr{sizeof(std::uint32_t)});
    RELIEF_TRY(allocated());
    const std::string last = "#define RELIEF_RADIX_LAST\n#define RELIEF_ORDER_WIDTH " +
                             std::to_string(width) + "\n#define RELIEF_RADIX_FORMAT " +
                             (isGles() ? "rgba32ui" : "rg32ui") + "\n";
    sort.keys_ = RELIEF_TRY(makeComputeProgram("picture/radix_count.comp", "#define RELIEF_RADIX_FIRST\n"));
    sort.count_ = RELIEF_TRY(makeComputeProgram("picture/radix_count.comp"));
    sort.scan_ = RELIEF_TRY(makeComputeProgram("picture/radix_scan.comp"));
    sort.move_ = RELIEF_TRY(makeComputeProgram("picture/radix_move.comp"));
    sort.place_ = RELIEF_TRY(makeComputeProgram("picture/radix_move.comp", last));
    sort.keys_.use();
    sort.keys_.set("u_position", kPositionUnit);
    return sort;
}

void RadixSort::dispatch(const GlProgram& program, const Partition& partition, std::uint32_t digit,
                         std::uint32_t groups) {
    program.use();
    program.set("u_count", partition.count);
    program.set("u_turns", partition.turns);
    program.set("u_blocks", partition.blocks);
    program.set("u_shift", digit * kDigitBits);
    glDispatchCompute(groups, 1, 1);
    StorageUnits::order();
}

void RadixSort::sort(const GlTexture& positions, std::uint32_t width, std::uint32_t extent,
                     const glm::vec3& eye) {
    const std::uint32_t rows = ceilDiv(extent, kDigits);
    const std::uint32_t turns =
        std::max(std::min(ceilDiv(rows, kBlocksFirst), kTurnsFirst), ceilDiv(rows, kBlocksMax));
    const Partition partition{extent, turns, ceilDiv(rows, turns)};

    const StorageUnits storage;
    const ImageUnits images;
    StorageUnits::order();  // the previous order may still be in use
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
        dispatch(digit == 0 ? keys_ : count_, partition, digit, partition.blocks);
        dispatch(scan_, partition, digit, kDigits);
        dispatch(digit + 1 == kKeyDigits ? place_ : move_, partition, digit, partition.blocks);
    }
    ImageUnits::finish();
}

DepthSorter::DepthSorter(std::uint32_t capacity) : capacity_(capacity) {}
DepthSorter::~DepthSorter() = default;
DepthSorter::DepthSorter(DepthSorter&&) noexcept = default;
DepthSorter& DepthSorter::operator=(DepthSorter&&) noexcept = default;

const GlTexture& DepthSorter::order() const {
    return radix_ ? radix_->order() : order_[current_];
}

Result<DepthSorter> DepthSorter::create(std::uint32_t capacity, StepPath path) {
    RELIEF_TRY(checkContext());
    if (capacity == 0 || capacity > kCapacityMax) {
        return fail(ErrorCode::kUsage, "a depth sorter cannot sort " + std::to_string(capacity) +
                                           " particles; choose 1 to " + std::to_string(kCapacityMax));
    }
    const std::uint32_t rows = std::max(regionFor(capacity) / kWidth, 1U);
    RELIEF_TRY(checkTextureSize(kWidth, rows, "the ranks of " + std::to_string(capacity) + " particles",
                                "choose a smaller capacity"));
    const PassState state;
    DepthSorter sorter(capacity);
    const StepPath chosen = RELIEF_TRY(resolvePath(path));
    if (chosen == StepPath::kCompute) {
        auto radix = RadixSort::create(capacity, kWidth);
        if (radix) {
            sorter.radix_ = std::make_unique<RadixSort>(std::move(*radix));
            return sorter;
        }
        if (path != StepPath::kAuto || radix.error().code != ErrorCode::kLimit) {
            return forward(radix);
        }
        // OpenGL ES 3.1 guarantees only half the work group size that the radix sort needs, and storage blocks of 128
        // MiB.
    }
    RELIEF_TRY(sorter.createFragmentPath());
    return sorter;
}

Result<void> DepthSorter::createFragmentPath() {
    const std::uint32_t rows = std::max(regionFor(capacity_) / kWidth, 1U);
    clearGlErrors();
    for (int i = 0; i < 2; ++i) {
        order_[i] = makeTexture2D(GL_RG32UI, static_cast<GLsizei>(kWidth), static_cast<GLsizei>(rows),
                                  GL_RG_INTEGER, GL_UNSIGNED_INT);
        RELIEF_TRY(checkAllocated("sorting " + std::to_string(capacity_) + " particles",
                                  "choose a smaller capacity"));
        target_[i] = RELIEF_TRY(makeFramebuffer({order_[i].name()}));
    }
    const std::string defines = "#define RELIEF_ORDER_WIDTH " + std::to_string(kWidth) + "\n";
    keys_ = RELIEF_TRY(makeScreenProgram("picture/sort_keys.frag", defines));
    pass_ = RELIEF_TRY(makeScreenProgram("picture/sort_pass.frag", defines));
    keys_.use();
    keys_.set("u_order", kOrderUnit);
    keys_.set("u_position", kPositionUnit);
    pass_.use();
    pass_.set("u_order", kOrderUnit);
    return {};
}

void DepthSorter::update(const GlTexture& positions, std::uint32_t width, std::uint32_t extent,
                         const glm::vec3& eye, std::uint32_t passes) {
    extent = std::min(extent, capacity_);
    if (radix_) {
        count_ = extent;
        if (extent > 0) {
            const PassState state;
            radix_->sort(positions, width, extent, eye);
        }
        return;
    }
    merge(positions, width, extent, eye, passes);
}

void DepthSorter::merge(const GlTexture& positions, std::uint32_t width, std::uint32_t extent,
                        const glm::vec3& eye, std::uint32_t passes) {
    const std::uint32_t kept = count_;
    if (extent > count_) {
        count_ = regionFor(extent);
        restart();
    }
    peak_ = std::max(peak_, extent);
    if (count_ == 0) {
        return;
    }
    const PassState state;
    keys_.use();
    useTexture(kPositionUnit, positions);
    keys_.set("u_kept", static_cast<GLint>(kept));
    keys_.set("u_width", static_cast<GLint>(width));
    keys_.set("u_extent", static_cast<GLint>(extent));
    keys_.set("u_eye", eye);
    drawNext(keys_);

    pass_.use();
    for (std::uint32_t i = 0; i < passes && count_ > 1; ++i) {
        drawPass();
        if (block_ > count_) {
            endSequence(extent);
        }
    }
    if (count_ == 1) {  // sorted without a pass
        endSequence(extent);
    }
}

void DepthSorter::drawPass() {
    pass_.set("u_block", block_);
    pass_.set("u_stride", stride_);
    drawNext(pass_);
    ++passes_done_;
    stride_ /= 2;
    if (stride_ == 0) {
        stride_ = block_;
        block_ *= 2;
    }
}

/// Draws the sorted region of the other buffer from the current one.
void DepthSorter::drawNext(const GlProgram& program) {
    const int next = 1 - current_;
    useTexture(kOrderUnit, order_[current_]);
    // A power of two: part of the first row, or whole rows.
    program.drawScreen(target_[next].name(), static_cast<GLsizei>(std::min(count_, kWidth)),
                       static_cast<GLsizei>(std::max(count_ / kWidth, 1U)));
    current_ = next;
}

void DepthSorter::endSequence(std::uint32_t extent) {
    // Valid only at the end of a complete sequence; see the header.
    count_ = regionFor(peak_);
    restart();
    peak_ = extent;
}

void DepthSorter::restart() {
    block_ = 2;
    stride_ = 1;
    passes_done_ = 0;
    peak_ = 0;
}

std::uint32_t DepthSorter::sequencePasses(std::uint32_t extent) {
    const auto k = extent == 0 ? 0U : static_cast<std::uint32_t>(std::bit_width(extent - 1));
    return k * (k + 1) / 2;
}

std::uint32_t DepthSorter::passesPerFrame(std::uint32_t extent, std::uint32_t frames) {
    return (sequencePasses(extent) + frames - 1) / frames;
}

}  // namespace relief
