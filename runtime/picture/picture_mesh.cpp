// SPDX-License-Identifier: Apache-2.0
#include "runtime/picture/picture_mesh.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <string>
#include <utility>

#include "formats/base/finite.h"

namespace relief {
namespace {

// Maximum corners around a vertex that are compared pairwise, which takes quadratic time.
constexpr std::size_t kFanMax = 64;

glm::vec3 unitOrZero(const glm::vec3& v) {
    // Scale first, because squares of small numbers underflow.
    const float largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    return largest > 0.0F && std::isfinite(largest) ? glm::normalize(v / largest) : glm::vec3(0.0F);
}

struct Corner {
    glm::vec3 face;  // normal of its triangle
    float angle;
};

std::vector<Corner> cornersOf(const PictureMesh& mesh) {
    std::vector<Corner> corners(mesh.triangles.size());
    for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
        glm::vec3 p[3];
        for (std::size_t i = 0; i < 3; ++i) {
            p[i] = mesh.positions[mesh.triangles[t + i]];
        }
        const glm::vec3 normal = unitOrZero(glm::cross(unitOrZero(p[1] - p[0]), unitOrZero(p[2] - p[0])));
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::vec3 a = unitOrZero(p[(i + 1) % 3] - p[i]);
            const glm::vec3 b = unitOrZero(p[(i + 2) % 3] - p[i]);
            corners[t + i] = {normal, std::acos(std::clamp(glm::dot(a, b), -1.0F, 1.0F))};
        }
    }
    return corners;
}

/// Corners by vertex: list[begin[v]] … list[begin[v + 1] - 1] are the corners of vertex v, in ascending order.
struct Fans {
    std::vector<std::size_t> begin;
    std::vector<std::uint32_t> list;
};

Fans fansOf(const PictureMesh& mesh) {
    Fans fans;
    fans.begin.assign(mesh.positions.size() + 1, 0);
    for (const std::uint32_t v : mesh.triangles) {
        ++fans.begin[v + 1];
    }
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        fans.begin[v + 1] += fans.begin[v];
    }
    fans.list.resize(mesh.triangles.size());
    std::vector<std::size_t> next(fans.begin.begin(), fans.begin.end() - 1);
    for (std::size_t c = 0; c < mesh.triangles.size(); ++c) {
        fans.list[next[mesh.triangles[c]]++] = static_cast<std::uint32_t>(c);
    }
    return fans;
}

/// Per vertex of a mesh with creases: the corners whose triangles contribute to its normal.
struct Sums {
    std::vector<std::uint32_t> begin{0};
    std::vector<std::uint32_t> corners;
};

PictureMesh creased(const PictureMesh& mesh, float crease, Sums* sums) {
    const float cosine = std::cos(crease);
    const std::vector<Corner> corners = cornersOf(mesh);
    const Fans fans = fansOf(mesh);
    PictureMesh out;
    out.triangles.resize(mesh.triangles.size());
    std::vector<std::uint32_t> smooth;  // corners that contribute to the normal
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const std::span<const std::uint32_t> fan(&fans.list[0] + fans.begin[v],
                                                 fans.begin[v + 1] - fans.begin[v]);
        const std::size_t first = out.positions.size();  // first duplicate of this vertex
        for (const std::uint32_t c : fan) {
            glm::vec3 sum(0.0F);
            smooth.clear();
            for (const std::uint32_t other : fan) {
                if (fan.size() > kFanMax || other == c ||
                    glm::dot(corners[c].face, corners[other].face) >= cosine) {
                    sum += corners[other].angle * corners[other].face;
                    smooth.push_back(other);
                }
            }
            const glm::vec3 normal = unitOrZero(sum);
            std::size_t at = first;
            while (at < out.positions.size() && out.normals[at] != normal) {
                ++at;
            }
            if (at == out.positions.size()) {
                out.positions.push_back(mesh.positions[v]);
                out.normals.push_back(normal);
                if (!mesh.colors.empty()) {
                    out.colors.push_back(mesh.colors[v]);
                }
                if (sums != nullptr) {
                    sums->corners.insert(sums->corners.end(), smooth.begin(), smooth.end());
                    sums->begin.push_back(static_cast<std::uint32_t>(sums->corners.size()));
                }
            }
            out.triangles[c] = static_cast<std::uint32_t>(at);
            if (fan.size() > kFanMax) {
                for (const std::uint32_t other : fan) {
                    out.triangles[other] = static_cast<std::uint32_t>(at);
                }
                break;
            }
        }
    }
    return out;
}

}  // namespace

std::vector<glm::uvec3> trianglesOf(const PictureMesh& mesh) {
    std::vector<glm::uvec3> triangles;
    triangles.reserve(mesh.triangles.size() / 3);
    for (std::size_t i = 0; i + 2 < mesh.triangles.size(); i += 3) {
        triangles.emplace_back(mesh.triangles[i], mesh.triangles[i + 1], mesh.triangles[i + 2]);
    }
    return triangles;
}

Result<void> checkMesh(const PictureMesh& mesh) {
    if (mesh.triangles.empty() || mesh.triangles.size() % 3 != 0) {
        return invalidInput("the number of a mesh's indices must be a positive multiple of 3");
    }
    if (!mesh.normals.empty() && mesh.normals.size() != mesh.positions.size()) {
        return invalidInput("a mesh has " + std::to_string(mesh.positions.size()) + " vertices but " +
                            std::to_string(mesh.normals.size()) + " normals");
    }
    if (!mesh.colors.empty() && mesh.colors.size() != mesh.positions.size()) {
        return invalidInput("a mesh has " + std::to_string(mesh.positions.size()) + " vertices but " +
                            std::to_string(mesh.colors.size()) + " colours");
    }
    for (const std::uint32_t v : mesh.triangles) {
        if (v >= mesh.positions.size()) {
            return invalidInput("a triangle has vertex index " + std::to_string(v) + ", but there are " +
                                std::to_string(mesh.positions.size()) + " vertices");
        }
    }
    for (const glm::vec3& p : mesh.positions) {
        if (!isFinite(p)) {
            return invalidInput("a vertex of the mesh is not finite");
        }
    }
    return {};
}

PictureMesh withNormals(const PictureMesh& mesh, float crease) {
    return creased(mesh, crease, nullptr);
}

MovingMesh::MovingMesh(const PictureMesh& mesh) : triangles_(mesh.triangles) {
    Sums sums;
    mesh_ = creased(mesh, kCrease, &sums);
    sources_.resize(mesh_.positions.size());
    for (std::size_t corner = 0; corner < mesh_.triangles.size(); ++corner) {
        sources_[mesh_.triangles[corner]] = mesh.triangles[corner];
    }
    begin_ = std::move(sums.begin);
    corners_ = std::move(sums.corners);
}

void MovingMesh::setPositions(std::span<const glm::vec3> positions) {
    std::vector<glm::vec3> areas(triangles_.size() / 3);
    for (std::size_t t = 0; t < areas.size(); ++t) {
        const glm::vec3& corner = positions[triangles_[3 * t]];
        areas[t] =
            glm::cross(positions[triangles_[3 * t + 1]] - corner, positions[triangles_[3 * t + 2]] - corner);
    }
    for (std::size_t i = 0; i < mesh_.positions.size(); ++i) {
        mesh_.positions[i] = positions[sources_[i]];
        glm::vec3 sum(0.0F);
        for (std::uint32_t k = begin_[i]; k < begin_[i + 1]; ++k) {
            sum += areas[corners_[k] / 3];
        }
        mesh_.normals[i] = unitOrZero(sum);
    }
}

}  // namespace relief
