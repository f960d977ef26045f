// SPDX-License-Identifier: Apache-2.0
#include "bake/patches/frame_choice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "formats/patch_tree.h"

namespace relief {
namespace {

/// Minimum fraction of the surface in a cell that faces the other way for a pair to be tried.
constexpr double kOtherSide = 0.03;

/// The unit gradients of w of all frames.
const std::array<glm::dvec3, 13>& frameAxes() {
    static const auto kAxes = [] {
        std::array<glm::dvec3, 13> ways;
        std::ranges::transform(patchFrames(), ways.begin(), [](const PatchFrame& frame) {
            return unit(glm::dvec3(frame.gradient(0.0F, 0.0F)));
        });
        return ways;
    }();
    return kAxes;
}

/// A weight by the cosine to the frame's axis: steep pieces count little, pieces that face away count negatively.
double worthSeen(double cosine) {
    return cosine > 0.2 ? cosine : 5.0 * cosine - 0.8;
}

}  // namespace

FrameChoice chooseFrame(std::span<const ClippedTriangle> pieces) {
    FrameChoice single;
    FrameChoice both{.two_sides = true};
    double best_single = -std::numeric_limits<double>::infinity();
    double best_both = best_single;
    for (std::uint8_t frame = 0; frame < frameAxes().size(); ++frame) {
        double above = 0.0;
        double below = 0.0;
        double either = 0.0;
        for (const ClippedTriangle& piece : pieces) {
            const double cosine = dot(piece.normal, frameAxes()[frame]);
            above += piece.area * worthSeen(cosine);
            below += piece.area * worthSeen(-cosine);
            either += piece.area * worthSeen(std::abs(cosine));
        }
        if (std::max(above, below) > best_single + 1e-9) {
            best_single = std::max(above, below);
            single.index = frame;
        }
        if (either > best_both + 1e-9) {
            best_both = either;
            both.index = frame;
        }
    }
    double area[2] = {};
    for (const ClippedTriangle& piece : pieces) {
        area[dot(piece.normal, frameAxes()[both.index]) < 0.0 ? 0 : 1] += piece.area;
    }
    return std::min(area[0], area[1]) > kOtherSide * (area[0] + area[1]) ? both : single;
}

}  // namespace relief
