// SPDX-License-Identifier: Apache-2.0
// relief._relief: the compiled module of the Python package. relief/__init__.py documents it for users.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "bake/ground/ground_bake.h"
#include "bake/measure/worst_places.h"
#include "bake/pipeline/bake.h"
#include "bake/pipeline/mesh_check.h"
#include "bake/python/convert.h"
#include "bake/python/interruptible.h"
#include "bake/verdict/parts_report.h"
#include "formats/base/text.h"
#include "formats/container.h"
#include "formats/fields/field.h"
#include "formats/nearest_surface.h"
#include "formats/validate.h"
#include "formats/world/world_field.h"

namespace relief {
namespace {

/// \param points  shape (n, 3); validated by the package.
std::span<const glm::vec3> pointsOf(const Floats& points) {
    static_assert(sizeof(glm::vec3) == 3 * sizeof(float));
    return {reinterpret_cast<const glm::vec3*>(points.data()), static_cast<std::size_t>(points.shape(0))};
}

struct Samples {
    Floats distance;
    Floats normal;
    py::array_t<std::int32_t> map;
};

/// Points between two signal checks: a tenth of a second on a few cores.
constexpr std::size_t kChunk = std::size_t{1} << 16;

/// Calls evaluate_at(p) for all points, on all cores. A point that is not finite gets NaN as distance and normal.
template <class Evaluate>
Samples sampleAll(const Floats& points, const Evaluate& evaluate_at) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    const auto at = pointsOf(points);
    const auto count = static_cast<py::ssize_t>(at.size());
    Samples out{Floats(count), Floats({count, py::ssize_t{3}}), py::array_t<std::int32_t>(count)};
    float* const distance = out.distance.mutable_data();
    float* const normal = out.normal.mutable_data();
    std::int32_t* const map = out.map.mutable_data();
    const auto sampleOne = [&](std::size_t i) {
        const glm::vec3& p = at[i];
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
            distance[i] = kNan;
            std::fill_n(normal + 3 * i, 3, kNan);
            map[i] = -1;
            return;
        }
        const auto sample = evaluate_at(p);
        distance[i] = sample.distance;
        std::copy_n(&sample.normal.x, 3, normal + 3 * i);
        map[i] = sample.map;
    };
    for (std::size_t begin = 0; begin < at.size(); begin += kChunk) {
        const std::size_t end = std::min(begin + kChunk, at.size());
        released([&] {
            tbb::parallel_for(tbb::blocked_range<std::size_t>(begin, end, 4096), [&](const auto& range) {
                for (std::size_t i = range.begin(); i != range.end(); ++i) {
                    sampleOne(i);
                }
            });
        });
        raiseSignals();
    }
    return out;
}

py::tuple query(const Collider& collider, const Floats& points, const std::string& distance) {
    Samples s = distance == "plane"
                    ? sampleAll(points, [&](const glm::vec3& p) { return evaluate(collider, p); })
                    : sampleAll(points, [&](const glm::vec3& p) { return nearestSurface(collider, p); });
    return py::make_tuple(s.distance, s.normal, s.map);
}

/// Returns the distance, normal and body at each point.
py::tuple queryWorld(const WorldField& field, const Floats& points) {
    const Samples s = sampleAll(points, [&](const glm::vec3& p) {
        const WorldSample sample = field.evaluate(p);
        return FieldSample{sample.distance, sample.normal, sample.body};
    });
    return py::make_tuple(s.distance, s.normal, s.map);
}

Floats cornersOf(const Bounds& bounds) {
    const auto& [low, high] = bounds;
    return Floats({2, 3}, std::array{low.x, low.y, low.z, high.x, high.y, high.z}.data());
}

/// Returns the stored texels of a map without a copy; they keep the collider alive.
py::array texelsOf(const py::object& self, std::size_t index) {
    const auto& collider = self.cast<const Collider&>();
    const DepthMap& map = collider.maps.at(index);
    const auto faces = static_cast<py::ssize_t>(map.faceCount());
    const auto height = static_cast<py::ssize_t>(map.height);
    const auto width = static_cast<py::ssize_t>(map.width);
    const bool floats = map.format == MapFormat::kFloat32;
    const bool words = texelSize(map.format) == 4 * sizeof(std::uint16_t);
    const py::dtype type = floats  ? py::dtype::of<float>()
                           : words ? py::dtype::of<std::uint16_t>()
                                   : py::dtype::of<std::uint8_t>();
    py::array array(type, {faces, height, width, py::ssize_t{4}}, map.texels.data(), self);
    array.attr("setflags")(py::arg("write") = false);
    return array;
}

/// Returns the depth of the front or back surface of every texel; NaN without one.
Floats depthOf(const Collider& collider, std::size_t index, bool back) {
    const DepthMap& map = collider.maps.at(index);
    Floats out({static_cast<py::ssize_t>(map.faceCount()), static_cast<py::ssize_t>(map.height),
                static_cast<py::ssize_t>(map.width)});
    float* depth = out.mutable_data();
    for (std::uint32_t face = 0; face < map.faceCount(); ++face) {
        for (std::uint32_t y = 0; y < map.height; ++y) {
            for (std::uint32_t x = 0; x < map.width; ++x) {
                const Texel texel = decodeTexel(map.format, map.texelAt(face, x, y));
                const auto& surface = back ? texel.back : texel.front;
                *depth++ = surface ? surface->depth : std::numeric_limits<float>::quiet_NaN();
            }
        }
    }
    return out;
}

py::dict describe(const Collider& collider, std::size_t index) {
    const DepthMap& map = collider.maps.at(index);
    py::list rows;
    for (const glm::vec4& row : map.object_to_map.row) {
        rows.append(py::make_tuple(row.x, row.y, row.z, row.w));
    }
    return py::dict(py::arg("format") = mapFormatName(map.format),
                    py::arg("encoding") = depthEncodingName(map.format),
                    py::arg("compare") = compareName(map.compare), py::arg("decode") = decodeName(map.decode),
                    py::arg("width") = map.width, py::arg("height") = map.height,
                    py::arg("faces") = map.faceCount(), py::arg("object_to_map") = rows,
                    py::arg("encloses") = map.encloses, py::arg("empty_is_outside") = map.empty_is_outside);
}

// --- Bake

/// Returns the mesh given by arrays; nullopt for a file, which is read later.
std::optional<TriangleMesh> meshOf(const std::optional<std::filesystem::path>& file, const Floats& vertices,
                                   const Indices& triangles, const std::string& name) {
    if (file) {
        return std::nullopt;
    }
    const auto positions = pointsOf(vertices);
    TriangleMesh mesh;
    mesh.name = cleanUtf8(name);
    if (mesh.name.size() > kMeshNameMax) {
        raise({ErrorCode::kUsage, "name has " + std::to_string(mesh.name.size()) + " bytes; at most " +
                                      std::to_string(kMeshNameMax) + " are allowed"});
    }
    mesh.positions.assign(positions.begin(), positions.end());
    const auto* corners = reinterpret_cast<const glm::uvec3*>(triangles.data());
    mesh.triangles.assign(corners, corners + triangles.shape(0));
    return need(finishMesh(std::move(mesh)));
}

/// Pairs of field names and their values as words.
using Words = std::vector<std::pair<std::string, std::string>>;
using SharedCollider = std::shared_ptr<Collider>;

template <class Request>
Request requestOf(const Words& words) {
    Request request;
    for (const auto& [name, word] : words) {
        need(setField(request, name, word));
    }
    return request;
}

/// Returns the name, kind ("flag", "value" or "list") and help text with the default for each field.
template <class Request>
py::list describeFields() {
    constexpr std::array<const char*, 3> kKinds = {"flag", "value", "list"};
    py::list described;
    for (const FieldWords& field : fieldsOf(Request())) {
        const std::string fallback = defaultText(field);
        described.append(py::make_tuple(
            field.name, kKinds.at(static_cast<std::size_t>(field.kind)),
            std::string(field.info.help) + (fallback.empty() ? "" : " (default: " + fallback + ")")));
    }
    return described;
}

/// Returns the collider of a height map, and the warnings of its bake.
py::tuple bakeGround(const BakeRequest& request) {
    FileGuard files;
    need(files.reads(request.mesh));
    const GroundResult baked = need(interruptible<GroundResult>(
        [request](const auto& checkpoint) -> Result<GroundResult> {
            return bakeHeightMap(request, {{}, {}, 0, [&](double) { checkpoint(); }});
        },
        request.timeout));
    return py::make_tuple(std::make_shared<Collider>(need(readContainer(baked.container))),
                          textsOf(baked.warnings));
}

/// Bakes the mesh or height map of a request. \param mesh  used instead of the request's file.
py::tuple bake(BakeRequest request, std::optional<TriangleMesh> mesh) {
    if (!request.heights.empty() && !mesh) {
        return bakeGround(request);
    }
    FileGuard files;
    need(files.reads(request.mesh));
    for (const std::string& clips : request.clips) {
        need(files.reads(clips));
    }
    request.repair.examine = false;
    const std::optional<float> seconds = request.timeout;
    const BakeResult baked = need(interruptible<BakeResult>(
        [request = std::move(request), files = std::move(files),
         mesh = std::move(mesh)](const auto& checkpoint) mutable -> Result<BakeResult> {
            BakeWatcher watcher;
            watcher.begin = [&](const char*) { checkpoint(); };
            watcher.progress = [&](double) { checkpoint(); };
            watcher.checkpoint = checkpoint;
            watcher.files = &files;
            BakeResult result = RELIEF_TRY(relief::bake(request, watcher, std::move(mesh)));
            checkpoint();
            return result;
        },
        seconds));
    return py::make_tuple(std::make_shared<Collider>(baked.baked.collider),
                          textsOf(baked.baked.report.warnings));
}

py::list placesOf(const std::vector<WorstPlace>& found) {
    py::list places;
    for (const WorstPlace& place : found) {
        places.append(py::dict(
            py::arg("position") = py::make_tuple(place.position.x, place.position.y, place.position.z),
            py::arg("size") = place.size(), py::arg("contribution_percent") = place.contribution_percent,
            py::arg("false_inside_percent") = place.false_inside_percent, py::arg("map") = place.map,
            py::arg("cause") = std::string(wordOf(place.cause))));
    }
    return places;
}

/// Returns the fields of relief.Accuracy, and the warnings of the check. \param mesh  used instead of the request's
/// file.
py::tuple check(const SharedCollider& collider, const CheckRequest& request,
                std::optional<TriangleMesh> mesh) {
    const MeshCheck run = need(
        interruptible<MeshCheck>([collider, request, mesh = std::move(mesh)](const auto& checkpoint) mutable {
            return relief::check(request, *collider, std::move(mesh), checkpoint);
        }));
    const FieldAccuracy& accuracy = run.judged().accuracy.field;
    const py::dict measured(
        py::arg("false_inside_percent") = accuracy.near.false_inside,
        py::arg("false_outside_percent") = accuracy.near.false_outside,
        py::arg("distance_error_mean") = accuracy.distance_mean,
        py::arg("distance_error_p99") = accuracy.distance_p99,
        py::arg("normal_error_mean") = accuracy.normal_mean,
        py::arg("unknown_percent") = accuracy.unknown_percent,
        py::arg("lost_parts") = run.part_accuracy.countOf(PartVerdict::kLost),
        py::arg("ignored_parts") = run.part_accuracy.countOf(PartVerdict::kMinor),
        py::arg("grade") = verdictOf(run.wrongPercent(), run.part_accuracy, run.collider.unit).grade,
        py::arg("proven_depth") = onlyIf(run.proof.unproven.empty(), run.proof.depth),
        py::arg("worst_places") = placesOf(run.places));
    return py::make_tuple(measured, textsOf(run.warnings));
}

}  // namespace
}  // namespace relief

PYBIND11_MODULE(_relief, m) {
    using namespace relief;  // NOLINT: a module is one scope
    m.attr("version") = RELIEF_VERSION;

    auto* const errors = new std::map<ErrorCode, py::object>;  // lives as long as the process
    const auto derive = [&](ErrorCode code, const char* name, const py::object& base) {
        const std::string full = std::string("relief.") + name;
        (*errors)[code] =
            py::reinterpret_steal<py::object>(PyErr_NewException(full.c_str(), base.ptr(), nullptr));
        m.attr(name) = (*errors)[code];
    };
    derive(ErrorCode::kFailure, "Error", py::reinterpret_borrow<py::object>(PyExc_RuntimeError));
    const py::object base = (*errors)[ErrorCode::kFailure];
    // relief/__init__.py also raises it, for invalid arguments.
    derive(ErrorCode::kUsage, "UsageError", py::make_tuple(base, py::handle(PyExc_ValueError)));
    derive(ErrorCode::kInvalidInput, "InputError", base);
    derive(ErrorCode::kIo, "FileError", base);
    derive(ErrorCode::kLimit, "LimitError", base);
    derive(ErrorCode::kUnsupported, "UnsupportedError", base);
    g_errors = errors;

    py::class_<Collider, SharedCollider>(m, "Collider")
        .def_property_readonly("bounds", [](const Collider& c) { return cornersOf(c.bounds); })
        .def_property_readonly("unit", [](const Collider& c) { return c.unit; })
        .def_property_readonly("mesh_name", [](const Collider& c) { return c.provenance.mesh_name; })
        .def_property_readonly("options", [](const Collider& c) { return c.provenance.optionsText(); })
        .def_property_readonly("gpu_bytes", &Collider::texelBytes)
        .def_property_readonly("map_count", [](const Collider& c) { return c.maps.size(); })
        .def("describe_map", &describe)
        .def("map_texels", [](const py::object& self, std::size_t i) { return texelsOf(self, i); })
        .def("map_depth", &depthOf)
        .def("query", &query);
    py::class_<WorldField, std::shared_ptr<WorldField>>(m, "World")
        .def_property_readonly("bounds",
                               [](const WorldField& f) { return cornersOf(worldBounds(f.world())); })
        .def_property_readonly("unit", [](const WorldField& f) { return f.world().unit; })
        .def_property_readonly("nodes",
                               [](const WorldField& f) {
                                   py::list nodes;
                                   for (const WorldBody& body : f.world().bodies) {
                                       nodes.append(textOf(body.node));
                                   }
                                   return nodes;
                               })
        .def_property_readonly(
            "positions", [](const WorldField& f) { return column(f.world().bodies, &WorldBody::position); })
        .def_property_readonly(
            "rotations", [](const WorldField& f) { return column(f.world().bodies, &WorldBody::rotation); })
        .def_property_readonly(
            "scales", [](const WorldField& f) { return column(f.world().bodies, &WorldBody::scale); })
        .def_property_readonly(
            "collider_of", [](const WorldField& f) { return column(f.world().bodies, &WorldBody::collider); })
        .def("collider",
             [](const std::shared_ptr<WorldField>& f, std::size_t i) {
                 const auto& colliders = f->colliders();
                 return SharedCollider(
                     f, const_cast<Collider*>(&colliders.at(i)));  // NOLINT: Python never modifies it
             })
        .def_property_readonly("collider_count", [](const WorldField& f) { return f.colliders().size(); })
        .def("query", &queryWorld);
    m.def("load_world", [](const std::filesystem::path& path) {
        return std::make_shared<WorldField>(
            need(released([&]() -> Result<WorldField> { return WorldField(RELIEF_TRY(loadWorld(path))); })));
    });
    m.def("load", [](const std::filesystem::path& path) {
        return std::make_shared<Collider>(need(released([&] { return loadCollider(path); })));
    });
    m.def("read", [](const py::bytes& bytes) {
        const std::string_view view = bytes;
        return std::make_shared<Collider>(need(readContainer(std::as_bytes(std::span(view)))));
    });
    m.def("save", [](const Collider& collider, const std::filesystem::path& path, int compression) {
        need(released([&] { return saveCollider(path, collider, {compression}); }));
    });
    m.def("to_bytes", [](const Collider& collider, int compression) {
        const auto bytes = need(released([&] { return writeContainer(collider, {compression}); }));
        return py::bytes(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    });
    m.def("bake_fields", &describeFields<BakeRequest>);
    m.def("check_fields", &describeFields<CheckRequest>);
    m.def("bake", [](const Words& words, const std::optional<std::filesystem::path>& file,
                     const Floats& vertices, const Indices& triangles, const std::string& name) {
        auto request = requestOf<BakeRequest>(words);
        request.mesh = file.value_or("");
        return bake(std::move(request), meshOf(file, vertices, triangles, name));
    });
    m.def("check", [](const SharedCollider& collider, const Words& words,
                      const std::optional<std::filesystem::path>& file, const Floats& vertices,
                      const Indices& triangles, const std::string& name) {
        auto request = requestOf<CheckRequest>(words);
        request.mesh = file.value_or("");
        return check(collider, request, meshOf(file, vertices, triangles, name));
    });
    addSimulation(m);
}
