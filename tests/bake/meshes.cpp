// SPDX-License-Identifier: Apache-2.0
#include "tests/bake/meshes.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <utility>

namespace relief::test {

double boxDistance(const glm::dvec3& p, const glm::dvec3& half) {
    const glm::dvec3 q = glm::abs(p) - half;
    return glm::length(glm::max(q, 0.0)) + std::min(std::max({q.x, q.y, q.z}), 0.0);
}

TriangleMesh finished(std::vector<glm::vec3> positions, std::vector<glm::uvec3> triangles) {
    TriangleMesh mesh;
    mesh.name = "test";
    mesh.content_hash = std::string(32, '0');
    mesh.positions = std::move(positions);
    mesh.triangles = std::move(triangles);
    return required(finishMesh(std::move(mesh)));
}

TriangleMesh makeBoxMesh(const glm::dvec3& center, const glm::dvec3& half, const glm::dmat3& axes) {
    std::vector<glm::vec3> positions;
    for (unsigned corner = 0; corner < 8; ++corner) {
        const glm::dvec3 sign((corner & 1U) != 0 ? 1 : -1, (corner & 2U) != 0 ? 1 : -1,
                              (corner & 4U) != 0 ? 1 : -1);
        positions.emplace_back(center + axes * (sign * half));
    }
    const std::vector<glm::uvec3> triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5},
                                               {0, 1, 5}, {0, 5, 4}, {2, 6, 7}, {2, 7, 3},
                                               {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
    return finished(positions, triangles);
}

TriangleMesh makeIcosphere(const glm::dvec3& center, double radius, int levels) {
    const double g = (1.0 + std::sqrt(5.0)) / 2.0;
    std::vector<glm::dvec3> unit = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                    {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                    {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
    for (glm::dvec3& p : unit) {
        p = glm::normalize(p);
    }
    std::vector<glm::uvec3> triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                         {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                         {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                         {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    for (int level = 0; level < levels; ++level) {
        std::map<std::pair<unsigned, unsigned>, unsigned> middles;
        const auto middle = [&](unsigned a, unsigned b) {
            const auto [at, added] =
                middles.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<unsigned>(unit.size()));
            if (added) {
                unit.push_back(glm::normalize(unit[a] + unit[b]));
            }
            return at->second;
        };
        std::vector<glm::uvec3> finer;
        for (const glm::uvec3& t : triangles) {
            const unsigned a = middle(t.x, t.y);
            const unsigned b = middle(t.y, t.z);
            const unsigned c = middle(t.z, t.x);
            finer.insert(finer.end(), {{t.x, a, c}, {t.y, b, a}, {t.z, c, b}, {a, b, c}});
        }
        triangles = std::move(finer);
    }
    std::vector<glm::vec3> positions;
    for (const glm::dvec3& p : unit) {
        positions.emplace_back(center + radius * p);
    }
    return finished(positions, triangles);
}

TriangleMesh makeTorusMesh(double ring_radius, double tube_radius, unsigned around, unsigned across) {
    constexpr double kTurn = 6.283185307179586;
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
    for (unsigned i = 0; i < around; ++i) {
        for (unsigned j = 0; j < across; ++j) {
            const double a = kTurn * i / around;
            const double b = kTurn * j / across;
            const double r = ring_radius + tube_radius * std::cos(b);
            positions.emplace_back(r * std::cos(a), r * std::sin(a), tube_radius * std::sin(b));
            const auto index = [&](unsigned u, unsigned v) { return (u % around) * across + v % across; };
            triangles.emplace_back(index(i, j), index(i + 1, j), index(i + 1, j + 1));
            triangles.emplace_back(index(i, j), index(i + 1, j + 1), index(i, j + 1));
        }
    }
    return finished(positions, triangles);
}

float hillsAt(float x, float z) {
    return 6.0F * std::sin(0.07F * x) * std::cos(0.05F * z) + 1.5F * std::sin(0.31F * x + 0.23F * z);
}

TriangleMesh makeHills(std::uint32_t n) {
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
    const std::uint32_t row = n + 1;
    for (const bool top : {true, false}) {
        for (std::uint32_t i = 0; i < row * row; ++i) {
            const auto along = [&](std::uint32_t at) {
                return kHillsHalf * (2.0F * static_cast<float>(at) / static_cast<float>(n) - 1.0F);
            };
            const float x = along(i % row);
            const float z = along(i / row);
            positions.emplace_back(x, top ? hillsAt(x, z) : -20.0F, z);
        }
    }
    const std::uint32_t below = row * row;
    const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        triangles.emplace_back(a, b, c);
        triangles.emplace_back(a, c, d);
    };
    for (std::uint32_t z = 0; z < n; ++z) {
        for (std::uint32_t x = 0; x < n; ++x) {
            const std::uint32_t at = z * row + x;
            quad(at, at + row, at + row + 1, at + 1);
            quad(below + at, below + at + 1, below + at + row + 1, below + at + row);
        }
    }
    for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t far = n * row;
        quad(i, i + 1, below + i + 1, below + i);
        quad(far + i + 1, far + i, below + far + i, below + far + i + 1);
        quad((i + 1) * row, i * row, below + i * row, below + (i + 1) * row);
        quad(i * row + n, (i + 1) * row + n, below + (i + 1) * row + n, below + i * row + n);
    }
    return finished(std::move(positions), std::move(triangles));
}

TriangleMesh makePanel(int axis, double at, double window) {
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
    const auto place = [&](double u, double v) {
        glm::dvec3 p(0.0);
        p[axis] = at;
        p[(axis + 1) % 3] = u;
        p[(axis + 2) % 3] = v;
        positions.emplace_back(p);
    };
    for (const double half : {1.5, 0.5 * window}) {
        for (int corner = 0; corner < 4; ++corner) {
            place(corner == 1 || corner == 2 ? half : -half, corner >= 2 ? half : -half);
        }
    }
    for (std::uint32_t i = 0; i < 4; ++i) {
        const std::uint32_t next = (i + 1) % 4;
        triangles.insert(triangles.end(), {{i, next, i + 4}, {next, next + 4, i + 4}});
    }
    if (window == 0.0) {
        positions.resize(4);
        triangles = {{0, 1, 2}, {0, 2, 3}};
    }
    return finished(positions, triangles);
}

TriangleMesh makeRooms(double window) {
    std::vector<TriangleMesh> panels;
    for (int axis = 0; axis < 3; ++axis) {
        panels.push_back(makePanel(axis, -0.5));
        panels.push_back(makePanel(axis, 0.5, axis == 0 ? window : 0.0));
    }
    return joined(panels);
}

TriangleMesh makePlane(float height, unsigned n) {
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
    for (unsigned i = 0; i <= n; ++i) {
        for (unsigned j = 0; j <= n; ++j) {
            const auto at = [&](unsigned k) {
                return -1.0F + 2.0F * static_cast<float>(k) / static_cast<float>(n);
            };
            positions.emplace_back(at(i), height, at(j));
            if (i < n && j < n) {
                const unsigned k = i * (n + 1) + j;
                triangles.emplace_back(k, k + 1, k + n + 2);
                triangles.emplace_back(k, k + n + 2, k + n + 1);
            }
        }
    }
    return finished(positions, triangles);
}

TriangleMesh joined(const std::vector<TriangleMesh>& meshes) {
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
    for (const TriangleMesh& mesh : meshes) {
        for (const glm::uvec3& t : mesh.triangles) {
            triangles.push_back(t + static_cast<std::uint32_t>(positions.size()));
        }
        positions.insert(positions.end(), mesh.positions.begin(), mesh.positions.end());
    }
    return finished(positions, triangles);
}

MeshQuery queryOf(PreparedMesh mesh) {
    return required(MeshQuery::build(std::move(mesh)));
}

TriangleMesh reversed(TriangleMesh mesh, std::size_t step) {
    for (std::size_t i = 0; i < mesh.triangles.size(); i += step) {
        std::swap(mesh.triangles[i].y, mesh.triangles[i].z);
    }
    return mesh;
}

Collider bakeMaps(const PreparedMesh& mesh, std::vector<MapSpec> maps, Quality quality, Prefer prefer) {
    BakeOptions options;
    options.maps = std::move(maps);
    options.quality = quality;
    options.prefer = prefer;
    return required(bake(mesh, options)).collider;
}

Collider bakeSpecs(const PreparedMesh& mesh, const std::vector<std::string>& specs, std::uint32_t resolution,
                   unsigned threads) {
    BakeOptions options;
    options.resolution = resolution;
    options.threads = threads;
    for (const std::string& text : specs) {
        options.maps.push_back(required(parseMapSpec(text, kPaperDefaults)));
    }
    return required(bake(mesh, options)).collider;
}

DepthMap bakeMap(const TriangleMesh& mesh, const std::string& spec, std::uint32_t resolution) {
    // Baking fails for a collider without any surface, but not for a single empty map. The other maps ensure a surface.
    return bakeSpecs(mesh, {spec, "float:size=16", "float:dir=-y,size=16"}, resolution).maps.front();
}

}  // namespace relief::test
