#include "bake/import/import_assembly.h"

#include <algorithm>
#include <cstdint>
#include <optional>

#include "bake/import/import_names.h"
#include "bake/import/import_parts.h"

namespace relief {
namespace {

class Flattener {
  public:
    Flattener(const Assembly& assembly, const glm::dmat3& linear, const ImportJob& job)
        : assembly_(assembly),
          root_{linear, glm::dvec3(0.0)},
          job_(job),
          marks_(job.options.names, job.file_name) {}

    Result<TriangleMesh> run(TriangleMesh mesh) {
        RELIEF_TRY(countTriangles());
        RELIEF_TRY(countParts(mesh));
        if (triangles_in_all_ > job_.triangle_max) {
            return tooManyTriangles(job_.shown, job_.triangle_max);
        }
        MeshInstances instances(job_.shown, job_.triangle_max, std::move(mesh));
        const bool counted =
            forEachUse([&](const AssemblyObject& object, const Transform& transform, std::uint8_t) {
                return std::all_of(object.parts.begin(), object.parts.end(), [&](const AssemblyPart& part) {
                    const std::size_t triangles = part.triangles.size();
                    return instances.count(std::min(object.positions.size(), 3 * triangles), triangles,
                                           transform);
                });
            });
        if (!counted) {
            return instances.tooMany();
        }
        instances.begin(marks_.any());
        const auto nameOf = [](const std::vector<std::string>& names) {
            // The first is the identifier of what has another name behind it.
            return names.empty()                           ? std::string()
                   : names.size() > 1 && !names[1].empty() ? names[1]
                                                           : names[0];
        };
        std::uint32_t use = 0;
        forEachUse([&](const AssemblyObject& object, const Transform& transform, std::uint8_t above) {
            ++use;
            for (const AssemblyPart& part : object.parts) {
                instances.surface({use, nameOf(object.names), nameOf(part.names)});
                compact(object.positions, part.triangles);
                instances.add(positions_, triangles_, transform, std::max(above, markOf(part.names)));
            }
            return true;
        });
        return instances.finish(marks_);
    }

  private:
    enum class State : std::uint8_t { kUnseen, kOpen, kDone };
    static constexpr std::uint64_t kCountMax = std::uint64_t{1} << 60;

    [[nodiscard]] tl::unexpected<Error> wrong(const std::string& what) const {
        return invalidInput("cannot read the mesh " + job_.shown + ": " + what);
    }

    /// Counts the triangles below each object, as often as they are placed: what has none is not looked at again.
    Result<void> countTriangles() {
        states_.assign(assembly_.objects.size(), State::kUnseen);
        triangles_below_.assign(assembly_.objects.size(), 0);
        for (const AssemblyUse& root : assembly_.roots) {
            RELIEF_TRY(countTriangles(root.object));
            triangles_in_all_ = std::min(triangles_in_all_ + triangles_below_[root.object], kCountMax);
        }
        for (const State state : states_) {
            shown_.push_back(state == State::kDone);
        }
        // Objects that place each other in a circle are no roots, and would be lost.
        for (std::size_t object = 0; object < assembly_.objects.size(); ++object) {
            RELIEF_TRY(countTriangles(object));
        }
        return {};
    }

    Result<void> countTriangles(std::size_t first) {
        struct Step {
            std::size_t object;
            std::size_t use = 0;
        };
        std::vector<Step> steps;
        if (states_[first] == State::kUnseen) {
            steps.push_back({first});
        }
        while (!steps.empty()) {
            Step& step = steps.back();
            const AssemblyObject& object = assembly_.objects[step.object];
            std::uint64_t& below = triangles_below_[step.object];
            states_[step.object] = State::kOpen;
            if (step.use == object.uses.size()) {
                for (const AssemblyPart& part : object.parts) {
                    below += part.triangles.size();
                }
                for (const AssemblyUse& use : object.uses) {
                    below = std::min(below + triangles_below_[use.object], kCountMax);
                }
                states_[step.object] = State::kDone;
                steps.pop_back();
                continue;
            }
            const std::size_t next = object.uses[step.use++].object;
            if (states_[next] == State::kOpen) {
                return wrong("an object is placed within itself; export it again");
            }
            if (states_[next] == State::kUnseen) {
                steps.push_back({next});
            }
        }
        return {};
    }

    /// Counts what the objects hold, with warnings, and checks the indices.
    Result<void> countParts(TriangleMesh& mesh) const {
        MeshParts parts;
        for (std::size_t i = 0; i < assembly_.objects.size(); ++i) {
            const AssemblyObject& object = assembly_.objects[i];
            std::vector<bool> used(object.positions.size(), false);
            std::size_t triangles = 0;
            for (const AssemblyPart& part : object.parts) {
                triangles += part.triangles.size();
                for (const glm::uvec3& triangle : part.triangles) {
                    for (int corner = 0; corner < 3; ++corner) {
                        if (triangle[corner] >= used.size()) {
                            return wrong("a triangle uses vertex " + std::to_string(triangle[corner]) +
                                         " of " + std::to_string(used.size()) +
                                         " from 0 on; export it again");
                        }
                        used[triangle[corner]] = true;
                    }
                }
            }
            const auto unused = static_cast<std::uint64_t>(std::count(used.begin(), used.end(), false));
            parts.polygons += triangles;
            parts.vertices += used.size();
            parts.unused += unused;
            parts.loose += unused;
            parts.meshes += triangles > 0 ? 1 : 0;
            parts.unplaced += triangles > 0 && !shown_[i] ? 1 : 0;
        }
        if (const std::optional<std::string> refusal = partsRefusal(parts)) {
            return wrong(*refusal);
        }
        mesh.unused_vertices = parts.unused;
        warnOfParts(parts, mesh.warnings);
        return {};
    }

    /// Sets positions_ and triangles_ to a part and to those positions that it uses.
    void compact(const std::vector<glm::vec3>& positions, const std::vector<glm::uvec3>& triangles) {
        constexpr std::uint32_t kNone = 0xFFFFFFFF;
        places_.resize(std::max(places_.size(), positions.size()), kNone);
        positions_.clear();
        triangles_ = triangles;
        for (glm::uvec3& triangle : triangles_) {
            for (int corner = 0; corner < 3; ++corner) {
                std::uint32_t& place = places_[triangle[corner]];
                if (place == kNone) {
                    place = static_cast<std::uint32_t>(positions_.size());
                    positions_.push_back(positions[triangle[corner]]);
                }
                triangle[corner] = place;
            }
        }
        // Only what was touched: an object may have many parts, or be placed often.
        for (const glm::uvec3& triangle : triangles) {
            places_[triangle.x] = places_[triangle.y] = places_[triangle.z] = kNone;
        }
    }

    std::uint8_t markOf(const std::vector<std::string>& names) {
        std::uint8_t mark = 0;
        for (const std::string& name : names) {
            mark = std::max(mark, marks_.meet(name));
        }
        return mark;
    }

    /// \param visit  (object, transform, mark) -> whether to go on. \return whether it got to the end.
    template <class Visit>
    bool forEachUse(const Visit& visit) {
        struct Pending {
            std::size_t object;
            Transform transform;
            std::uint8_t mark;
        };
        std::vector<Pending> pending;
        const auto push = [&](const std::vector<AssemblyUse>& uses, const Transform& transform,
                              std::uint8_t mark) {
            for (auto use = uses.rbegin(); use != uses.rend(); ++use) {
                if (triangles_below_[use->object] > 0) {
                    pending.push_back({use->object, transform * use->transform, mark});
                }
            }
        };
        push(assembly_.roots, root_, 0);
        while (!pending.empty()) {
            const Pending next = pending.back();
            pending.pop_back();
            const AssemblyObject& object = assembly_.objects[next.object];
            const std::uint8_t mark =
                marks_.any() ? std::max(next.mark, markOf(object.names)) : std::uint8_t{0};
            if (!object.parts.empty() && !visit(object, next.transform, mark)) {
                return false;
            }
            push(object.uses, next.transform, mark);
        }
        return true;
    }

    const Assembly& assembly_;
    Transform root_;
    const ImportJob& job_;
    NameMarks marks_;
    std::vector<State> states_;                   // of the objects, as are the next two
    std::vector<std::uint64_t> triangles_below_;  // with its own, at most kCountMax
    std::vector<bool> shown_;
    std::uint64_t triangles_in_all_ = 0;
    std::vector<std::uint32_t> places_;  // compact()'s, as are the next two
    std::vector<glm::vec3> positions_;
    std::vector<glm::uvec3> triangles_;
};

}  // namespace

Result<TriangleMesh> flatten(const Assembly& assembly, const glm::dmat3& linear, const ImportJob& job,
                             TriangleMesh mesh) {
    return Flattener(assembly, linear, job).run(std::move(mesh));
}

}  // namespace relief
