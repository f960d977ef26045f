// SPDX-License-Identifier: Apache-2.0
// Levels written as OBJ into a temporary folder and baked into worlds there.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "bake/recipe/recipe_jobs.h"
#include "bake/world/world_bake.h"
#include "bake/world/world_check.h"
#include "formats/base/file_io.h"
#include "tests/bake/meshes.h"
#include "tests/temporary_folder.h"

namespace relief::test {

class LevelBakes : public testing::Test {
  protected:
    using Files = std::map<std::string, std::vector<std::byte>>;

    struct Object {
        std::string name;
        TriangleMesh mesh;
        glm::vec3 at{0.0F};
    };

    /// \param material_of  the material of a triangle of an object; default: none
    void write(
        const std::vector<Object>& objects,
        const std::function<std::string(const Object&, std::size_t triangle)>& material_of = {}) const {
        std::ostringstream text;
        std::size_t before = 1;
        for (const Object& object : objects) {
            text << "o " << object.name << "\n";
            for (const glm::vec3& position : object.mesh.positions) {
                const glm::vec3 p = position + object.at;
                text << "v " << p.x << " " << p.y << " " << p.z << "\n";
            }
            for (std::size_t i = 0; i < object.mesh.triangles.size(); ++i) {
                const glm::uvec3& t = object.mesh.triangles[i];
                if (material_of) {
                    text << "usemtl " << material_of(object, i) << "\n";
                }
                text << "f " << before + t.x << " " << before + t.y << " " << before + t.z << "\n";
            }
            before += object.mesh.positions.size();
        }
        folder_.write("level.obj", text.str());
    }

    /// Bakes with the fixture's request.
    WorldBakeResult bake(const char* into) {
        request_.bake.mesh = (folder_.path() / "level.obj").string();
        request_.folder = folder_.path() / into;
        std::filesystem::create_directories(request_.folder);
        return required(bakeWorld(request_));
    }

    [[nodiscard]] WorldField load(const char* from, WorldDetail detail = WorldDetail::kFine) const {
        return WorldField(required(loadWorld(folder_.path() / from / kWorldFileName, {}, detail)));
    }

    /// Compares the world with its level.
    [[nodiscard]] WorldAccuracy check(const WorldField& field, std::uint64_t samples) const {
        WorldCheckRequest request;
        request.check.mesh = (folder_.path() / "level.obj").string();
        request.check.samples = samples;
        return required(checkWorld(request, field));
    }

    [[nodiscard]] Files filesOf(const char* folder) const {
        Files files;
        for (const auto& entry : std::filesystem::directory_iterator(folder_.path() / folder)) {
            files[entry.path().filename().string()] = *readFile(entry.path());
        }
        return files;
    }

    TemporaryFolder folder_;
    WorldRequest request_;
};

}  // namespace relief::test
