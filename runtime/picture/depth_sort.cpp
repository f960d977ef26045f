#include "runtime/picture/depth_sort.h"

#include <algorithm>
#include <array>
#include <bit>
#include <string>

#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"

namespace relief {
namespace {

constexpr int kOrderUnit = 0;
constexpr int kPositionUnit = 1;

std::uint32_t regionFor(std::uint32_t extent) {
    return extent == 0 ? 0 : std::bit_ceil(extent);
}

}  // namespace

Result<DepthSorter> DepthSorter::create(std::uint32_t capacity, StepPath path) {
    RELIEF_TRY(checkContext());
    if (capacity == 0 || capacity > kCapacityMax) {
        return fail(ErrorCode::kUsage, "a depth sorter for " + std::to_string(capacity) +
                                           " particles is not possible; choose 1 to " +
                                           std::to_string(kCapacityMax));
    }
    const std::uint32_t rows = std::max(regionFor(capacity) / kWidth, 1U);
    RELIEF_TRY(checkTextureSize(kWidth, rows, "the ranks of " + std::to_string(capacity) + " particles",
                                "choose a smaller capacity"));
    const PassState state;
    DepthSorter sorter(capacity);
    const StepPath chosen = RELIEF_TRY(chosenPath(path));
    if (chosen == StepPath::kCompute) {
        auto radix = RadixSort::create(capacity, kWidth);
        if (radix) {
            sorter.radix_ = std::move(*radix);
            return sorter;
        }
        if (path != StepPath::kAuto || radix.error().code != ErrorCode::kLimit) {
            return forward(radix);
        }
        // OpenGL ES 3.1 promises work groups of half the size that the radix sort takes, and storage blocks of 128 MiB.
    }
    RELIEF_TRY(sorter.createTextures());
    RELIEF_TRY(sorter.createPrograms());
    return sorter;
}

Result<void> DepthSorter::createTextures() {
    const std::uint32_t rows = std::max(regionFor(capacity_) / kWidth, 1U);
    forgetGlErrors();
    for (int i = 0; i < 2; ++i) {
        order_[i] = makeTexture2D(GL_RG32UI, static_cast<GLsizei>(kWidth), static_cast<GLsizei>(rows),
                                  GL_RG_INTEGER, GL_UNSIGNED_INT);
        RELIEF_TRY(checkAllocated("sorting " + std::to_string(capacity_) + " particles",
                                  "choose a smaller capacity"));
        const std::array<GLuint, 1> textures{order_[i].name()};
        target_[i] = RELIEF_TRY(makeFramebuffer(textures));
    }
    return {};
}

Result<void> DepthSorter::createPrograms() {
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

/// Draws the sorted region of the other buffer from this one.
void DepthSorter::drawNext(const GlProgram& program) {
    const int next = 1 - current_;
    useTexture(kOrderUnit, order_[current_]);
    // A power of two: part of the first row, or whole rows.
    program.drawScreen(target_[next].name(), static_cast<GLsizei>(std::min(count_, kWidth)),
                       static_cast<GLsizei>(std::max(count_ / kWidth, 1U)));
    current_ = next;
}

void DepthSorter::endSequence(std::uint32_t extent) {
    // Valid only at the end of a whole sequence: see the header.
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
