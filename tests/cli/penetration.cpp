// relief-penetration MESH PARTICLES.ply: how deep particles lie inside a mesh, and how many rest on it.
//
// By CGAL's AABB tree: inside by the parity of exact-predicate ray intersections, majority of five directions
// (the mesh need not be closed), depth as the distance to the nearest triangle. Prints one JSON object.
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "bake/import/mesh_import.h"

namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Point = Kernel::Point_3;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

struct Particle {
    std::array<float, 3> position;
    std::array<float, 3> velocity;
};

/// The x y z vx vy vz of a binary little-endian PLY whose vertex properties are all four bytes wide.
std::vector<Particle> readParticles(const char* path) {
    std::ifstream file(path, std::ios::binary);
    std::vector<std::string> properties;
    std::size_t count = 0;
    for (std::string line; std::getline(file, line) && line != "end_header";) {
        std::istringstream words(line);
        std::string first, second, third;
        words >> first >> second >> third;
        if (first == "element") {
            count = std::stoul(third);
        } else if (first == "property") {
            properties.push_back(third);
        }
    }
    std::vector<Particle> particles(count);
    std::vector<float> record(properties.size());
    for (Particle& particle : particles) {
        file.read(reinterpret_cast<char*>(record.data()), static_cast<std::streamsize>(4 * record.size()));
        for (std::size_t i = 0; i < properties.size(); ++i) {
            static const std::string kNames[] = {"x", "y", "z", "vx", "vy", "vz"};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                if (properties[i] == kNames[axis]) {
                    particle.position[axis] = record[i];
                } else if (properties[i] == kNames[axis + 3]) {
                    particle.velocity[axis] = record[i];
                }
            }
        }
    }
    if (!file) {
        std::fprintf(stderr, "relief-penetration: %s is cut short\n", path);
        std::exit(2);
    }
    return particles;
}

bool isInside(const Tree& tree, const Point& p) {
    static const Kernel::Vector_3 kDirections[] = {
        {1, 0.013, 0.027}, {-0.031, 1, 0.017}, {0.019, -0.023, 1}, {-1, 0.37, 0.61}, {0.41, -1, -0.53}};
    int votes = 0;
    for (const Kernel::Vector_3& direction : kDirections) {
        votes += static_cast<int>(tree.number_of_intersected_primitives(Kernel::Ray_3(p, direction)) % 2);
    }
    return votes >= 3;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) {
        std::fprintf(stderr, "usage: relief-penetration MESH PARTICLES.ply\n");
        return 1;
    }
    const auto mesh = relief::importMeshInWorker(argv[1]);
    if (!mesh) {
        std::fprintf(stderr, "relief-penetration: %s\n", mesh.error().message.c_str());
        return 3;
    }
    Triangles triangles;
    CGAL::Bbox_3 box;
    for (const auto& t : mesh->triangles) {
        const auto corner = [&](unsigned i) {
            const auto& v = mesh->positions[i];
            return Point(v.x, v.y, v.z);
        };
        triangles.emplace_back(corner(t.x), corner(t.y), corner(t.z));
        box += triangles.back().bbox();
    }
    Tree tree(triangles.cbegin(), triangles.cend());
    tree.accelerate_distance_queries();
    const double side = std::max({box.x_span(), box.y_span(), box.z_span()});
    const double near = 3.0 * side / 510.0;

    std::size_t checked = 0;
    std::size_t inside = 0;
    std::size_t resting = 0;
    double deepest = 0.0;
    const std::vector<Particle> particles = readParticles(argv[2]);
    for (const Particle& particle : particles) {
        const Point p(particle.position[0], particle.position[1], particle.position[2]);
        if (p.x() < box.xmin() - near || p.x() > box.xmax() + near || p.y() < box.ymin() - near ||
            p.y() > box.ymax() + near || p.z() < box.zmin() - near || p.z() > box.zmax() + near) {
            continue;
        }
        ++checked;
        const double distance = std::sqrt(tree.squared_distance(p));
        const auto& v = particle.velocity;
        if (distance <= near && v[0] * v[0] + v[1] * v[1] + v[2] * v[2] == 0.0F) {
            ++resting;
        }
        if (distance > deepest && isInside(tree, p)) {
            ++inside;
            deepest = distance;
        }
    }
    std::printf(
        "{\"particles\": %zu, \"in_the_box\": %zu, \"ever_deeper\": %zu, \"deepest\": %.6g, "
        "\"deepest_share_of_longest_side\": %.6g, \"resting_on_mesh\": %zu}\n",
        particles.size(), checked, inside, deepest, deepest / side, resting);
    return 0;
}
