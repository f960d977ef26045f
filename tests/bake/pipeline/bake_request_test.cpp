// SPDX-License-Identifier: Apache-2.0
// Bake requests: parsed from the command line, written as one, and read from containers.
#include "bake/pipeline/bake_request.h"

#include <algorithm>
#include <cstring>
#include <glm/geometric.hpp>

#include "bake/pipeline/bake.h"
#include "bake/pipeline/mesh_check.h"
#include "bake/report/bake_report.h"
#include "formats/animation/mesh_pose.h"
#include "formats/base/text.h"
#include "formats/container.h"
#include "tests/bake/meshes.h"

namespace relief::test {
namespace {

/// \param text  a command line without quotes; %XX is an escaped byte
RecordedBake recorded(std::string_view text) {
    std::vector<RecordedOption> options;
    for (std::string_view word = popWord(text); !word.empty(); word = popWord(text)) {
        std::string name(word.starts_with("--") ? word.substr(2) : word);
        std::ranges::replace(name, '-', '_');
        std::string value(popWord(text));
        for (std::size_t at = value.find('%'); at != std::string::npos; at = value.find('%', at + 1)) {
            value.replace(at, 3, 1, static_cast<char>(std::stoi(value.substr(at + 1, 2), nullptr, 16)));
        }
        options.push_back({name, value});
    }
    return recordedBake(options);
}

/// The recorded options as a command line, without mesh and output.
std::string wordsOf(const std::string& options) {
    BakeRequest request = recorded(options).request;
    request.mesh = "m";
    const std::string line = commandLine(request, "o");
    EXPECT_TRUE(line.starts_with("relief bake m -o o")) << line;
    return line.substr(std::string("relief bake m -o o").size());
}

TEST(BakeRequest, EveryFieldRoundTrips) {
    BakeRequest request;
    for (const std::string field :
         {"map=cube:size=16,compare=less", "decode=projected", "depth=half", "paper=true", "budget=1.5MB",
          "max_error=2.5%", "thickness=auto=0.25", "up=-z"}) {
        const std::size_t equals = field.find('=');
        ASSERT_TRUE(setField(request, field.substr(0, equals), field.substr(equals + 1))) << field;
    }
    EXPECT_EQ(request.budget, 1'500'000U);
    EXPECT_EQ(request.max_error, 2.5F);
    EXPECT_TRUE(request.thickness && request.thickness->by_part);
    const std::vector<FieldWords> changed = changedFields(request);
    EXPECT_EQ(changed.size(), 8U);
    BakeRequest again;
    for (const FieldWords& field : changed) {
        for (const std::string& word : field.words) {
            EXPECT_TRUE(setField(again, field.name, word)) << field.name;
        }
    }
    const std::vector<FieldWords> read = changedFields(again);
    ASSERT_EQ(read.size(), changed.size());
    for (std::size_t i = 0; i < read.size(); ++i) {
        EXPECT_EQ(read[i].words, changed[i].words) << read[i].name;
    }
}

TEST(BakeRequest, ErrorsNameTheOptionAndTheFix) {
    for (const auto& [name, word, begin] :
         {std::tuple{"budget", "much", "--budget is 'much' but must be a number of bytes"},
          std::tuple{"budget", "4095", "--budget is '4095' but must be a number of bytes, at least 4096"},
          std::tuple{"max_error", "-1", "--max-error is '-1' but must be a percentage, such as 1.5"},
          std::tuple{"quality", "bset", "--quality is 'bset' but must be one of fast, normal, best"},
          std::tuple{"depth", "x", "--depth is 'x' but must be unorm16 or half"},
          std::tuple{"thickness", "0", "--thickness is '0' but must be a length above 0"},
          std::tuple{"unit", "mile", "--unit is 'mile' but must be one of m, cm, mm, um, km, in, ft, yd"},
          std::tuple{"up", "z", "--up is 'z' but must be one of +x, -x, +y, -y, +z, -z"},
          std::tuple{"repair", "", "--repair is empty"},
          std::tuple{"threads", "1.5", "--threads is '1.5' but must be"},
          std::tuple{"no_such", "1", "unknown option --no-such"}}) {
        BakeRequest request;
        expectError(setField(request, name, word), ErrorCode::kUsage, begin);
    }
}

TEST(BakeRequest, LengthsAcceptUnits) {
    for (const auto& [word, metres] :
         {std::pair("1cm", 0.01F), {"0.01", 0.01F}, {"2.5 mm", 0.0025F}, {"3m", 3.0F}, {"0.5km", 500.0F}}) {
        BakeRequest request;
        EXPECT_TRUE(setField(request, "texel", word)) << word;
        EXPECT_EQ(request.texel, metres) << word;
    }
    for (const char* word : {"1inch", "cm", "0mm", "-1cm", "1cmm", "1e30km"}) {
        BakeRequest request;
        expectError(setField(request, "texel", word), ErrorCode::kUsage,
                    "--texel is '" + std::string(word) + "' but must be a length above 0");
    }
}

TEST(BakeRequest, CheckRejectsConflictingFields) {
    const auto fault = [](const std::vector<std::pair<std::string, std::string>>& words) {
        BakeRequest request;
        for (const auto& [name, word] : words) {
            EXPECT_TRUE(setField(request, name, word)) << name;
        }
        const Result<BakeSettings> settings = settingsOf(request);
        return settings ? std::string() : settings.error().message;
    };
    EXPECT_EQ(fault({{"budget", "1MB"}, {"max_error", "1"}}), "");
    EXPECT_TRUE(fault({{"map", "cube"}, {"paper", "true"}}).starts_with("--map and --paper both choose"));
    EXPECT_TRUE(fault({{"paper", "true"}, {"max_error", "1"}}).starts_with("--paper and --max-error both"));
    EXPECT_TRUE(fault({{"decode", "plane"}}).starts_with("--decode has no effect without --map"));
    EXPECT_TRUE(fault({{"resolution", "64"}}).ends_with("or add --map, --paper or --holes keep"));
    EXPECT_EQ(fault({{"holes", "keep"}, {"resolution", "64"}}), "");
    EXPECT_TRUE(
        fault({{"holes", "keep"}, {"budget", "1MB"}}).starts_with("--budget has no effect with --holes"));
    EXPECT_TRUE(fault({{"as", "a=shell"}, {"holes", "keep"}}).starts_with("--as NAME=KIND has no effect"));
    EXPECT_TRUE(fault({{"repair", "magic"}}).starts_with("--repair is 'magic'"));
    EXPECT_EQ(fault({{"animated", "true"}, {"clips", "walk.glb"}, {"resolution", "64"}, {"up", "+z"}}), "");
    EXPECT_TRUE(fault({{"animated", "true"}, {"holes", "keep"}}).starts_with("--holes has no effect with"));
    EXPECT_TRUE(fault({{"animated", "true"}, {"map", "cube"}}).starts_with("--map has no effect with"));
    EXPECT_TRUE(fault({{"clips", "walk.glb"}}).starts_with("--clips has no effect without --animated"));
}

TEST(RecordedBake, ReadsRecordsOfBake) {
    const RecordedBake bake = recorded(
        "--map front-back:dir=+z,size=95x90,depth=unorm16,decode=plane,box=tight "
        "--map cube:size=6,compare=less,decode=plane,box=0/0/0/1/1/1 --quality best --prefer inside "
        "--budget 60000 --holes keep --unit mm --up +z --repair wrap=0.02 --as shell --thickness 0.25");
    EXPECT_TRUE(bake.understood);
    const BakeRequest& request = bake.request;
    EXPECT_EQ(request.map.size(), 2U);
    EXPECT_EQ(request.quality, Quality::kBest);
    EXPECT_EQ(request.prefer, Prefer::kInside);
    EXPECT_EQ(request.budget, 60'000U);
    EXPECT_EQ(request.holes, Holes::kKeep);
    EXPECT_EQ(request.import.unit, "mm");
    EXPECT_EQ(request.repair.method, "wrap=0.02");
    EXPECT_EQ(request.as, std::vector<std::string>{"shell"});
    EXPECT_TRUE(request.thickness && request.thickness->length == 0.25 && !request.thickness->by_part);
    EXPECT_EQ(wordsOf("--quality best --prefer inside --budget 60000 --holes keep --unit mm --up +z "
                      "--repair wrap=0.02 --as shell --thickness 0.25"),
              " --budget 60kB --quality best --prefer inside --holes keep --unit mm --up +z "
              "--repair wrap=0.02 --as shell --thickness 0.25");
    EXPECT_EQ(wordsOf("--quality normal"), "");
}

TEST(RecordedBake, IsOneShellCommand) {
    for (const char* options :
         {"--unit $(reboot)", "--prefer ;reboot", "`reboot` x", "--unit mm;reboot", "--up '+z",
          "--map cube:size=6|reboot", "--unit \"mm\"", "x > file", "--unit a\tb\\", "--unit ~/x",
          "--unit \xff", "--timeout 5", "--threads 7", "--from the=future", "--map cube:size=many",
          "--repair magic", "--as wall", "--thickness -1", "--quality"}) {
        EXPECT_EQ(wordsOf(options), "") << options;
        EXPECT_FALSE(recorded(options).understood) << options;
    }
    EXPECT_TRUE(recorded("").understood);
    const char* const named = "--as solid --as glass%20%27top%27%3B=shell --as wheel=auto --as -x=shell";
    EXPECT_TRUE(recorded(named).understood);
    EXPECT_EQ(wordsOf(named), " --as solid --as 'glass '\\''top'\\'';=shell' --as wheel=auto --as -x=shell");
    std::string many;
    for (std::size_t i = 0; i < 2 * kSelectedNamesMax; ++i) {
        many += " --as n" + std::to_string(i) + "=solid";
    }
    EXPECT_EQ(recorded(many).request.as.size(), kSelectedNamesMax);
}

// In a container and as text.
TEST(RecordedBake, NamesRoundTrip) {
    std::string all;
    for (char c = ' '; c < '\x7f'; ++c) {
        all += c;
    }
    const ShapeOptions options{
        ShapeAs::kSolid,
        0.0,
        {{all, ShapeAs::kShell}, {"caf\xc3\xa9 \xe7\xaa\x93", ShapeAs::kAuto}, {"%41", ShapeAs::kTerrain}}};
    ShapeReport report;
    report.as = options.as;
    for (const NamedShape& named : options.named) {
        report.named.push_back({named, 1});
    }
    BakeRequest request;
    request.map = {"cube:size=8"};
    BakeResult baked = required(bake(request, {}, makeBoxMesh({0, 0, 0}, {1, 1, 1})));
    Collider& collider = baked.baked.collider;
    for (const std::string& word : asOptionWords(report)) {
        collider.provenance.options.push_back({"as", word});
    }
    const Collider back = required(readContainer(required(writeContainer(collider))));
    const RecordedBake read = recordedBake(back.provenance.options);
    EXPECT_TRUE(read.understood);
    const ShapeOptions shape = required(parseShapeOptions(read.request.as));
    EXPECT_EQ(shape.as, options.as);
    EXPECT_EQ(shape.named, options.named);
    EXPECT_TRUE(back.provenance.optionsText().ends_with(" --as %41=terrain"));
}

TEST(RecordedBake, RecordsWhetherVoidsAreFilled) {
    const auto checkedVoids = [](std::optional<VoidMode> voids, bool forget) {
        BakeRequest request;
        request.budget = 20'000;
        request.thickness = Thickness{0.06, false};
        request.voids = voids;
        BakeResult baked = required(bake(request, {}, makeRooms()));
        Collider& collider = baked.baked.collider;
        if (forget) {
            std::erase_if(collider.provenance.options,
                          [](const RecordedOption& o) { return o.name == "voids"; });
        }
        CheckRequest check_request;
        check_request.samples = 1'000;
        return required(check(check_request, std::move(collider), makeRooms())).shape.voids;
    };
    EXPECT_EQ(checkedVoids({}, false), 1U);
    EXPECT_EQ(checkedVoids(VoidMode::kKeep, false), 0U);
    EXPECT_EQ(checkedVoids({}, true), 0U);  // baked by an older version
}

TEST(RecordedBake, ReproducesTheBakedSolid) {
    TriangleMesh box = makeBoxMesh({0, 0, 0}, {1, 1, 1});
    box.triangles.pop_back();
    const auto solid = [&](const char* options) { return makeSolid(recorded(options).request, box); };
    const ShapedMesh closed = required(solid(""));
    EXPECT_TRUE(closed.mesh.closed());
    EXPECT_EQ(required(solid("--holes keep")).mesh->triangles.size(), 11U);
    EXPECT_NEAR(required(solid("--as shell --thickness 0.1")).report.thickness, 0.1, 1e-6);
    const ShapedMesh wrapped =
        required(repairedSolid(recorded("--holes keep --repair wrap=0.1").request, box));
    EXPECT_TRUE(wrapped.mesh.closed());
    // A record must not make a check run for hours.
    EXPECT_FALSE(repairedSolid(recorded("--repair wrap=0.001").request, box));
}

TEST(Director, BakesTheRestPoseOfAnAnimatedMesh) {
    // A cube on an animated node. Its left half is wound inward.
    const std::string document = R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],)"
                                 R"("nodes":[{"name":"box","mesh":0,"translation":[0,0,5]}],)"
                                 R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)"
                                 R"("animations":[{"name":"go","samplers":[{"input":2,"output":3}],)"
                                 R"("channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}]}],)"
                                 R"("accessors":[)"
                                 R"({"bufferView":0,"componentType":5126,"count":8,"type":"VEC3"},)"
                                 R"({"bufferView":1,"componentType":5121,"count":39,"type":"SCALAR"},)"
                                 R"({"bufferView":2,"componentType":5126,"count":2,"type":"SCALAR"},)"
                                 R"({"bufferView":3,"componentType":5126,"count":2,"type":"VEC3"}],)"
                                 R"("bufferViews":[{"buffer":0,"byteLength":96},)"
                                 R"({"buffer":0,"byteOffset":96,"byteLength":39},)"
                                 R"({"buffer":0,"byteOffset":136,"byteLength":8},)"
                                 R"({"buffer":0,"byteOffset":144,"byteLength":24}],)"
                                 R"("buffers":[{"byteLength":168,"uri":"b.bin"}]})";
    std::string bytes(168, '\0');
    const auto put = [&bytes](std::size_t at, float value) { std::memcpy(&bytes[at], &value, 4); };
    for (std::size_t i = 0; i < 8; ++i) {
        put(12 * i, i % 2 == 0 ? 0.0F : 1.0F);
        put(12 * i + 4, i / 2 % 2 == 0 ? 0.0F : 1.0F);
        put(12 * i + 8, i < 4 ? 0.0F : 1.0F);
    }
    // The first triangle has no area. Half of the others are reversed.
    const std::vector<int> corners = {0, 0, 1, 0, 1, 2, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5,
                                      4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    std::copy(corners.begin(), corners.end(), bytes.begin() + 96);
    put(140, 2.0F);
    put(156, 10.0F);
    const TemporaryFolder folder;
    folder.write("b.bin", bytes);
    BakeRequest request;
    request.mesh = folder.write("box.gltf", document).string();
    request.animated = true;
    request.resolution = 32;
    const BakeResult baked = required(bake(request));
    const Collider& collider = baked.baked.collider;
    EXPECT_EQ(collider.bounds.min, glm::vec3(0, 0, 5)) << "the bounds of the rest pose";
    EXPECT_EQ(collider.maps.size(), 3U);
    EXPECT_EQ(collider.provenance.optionsText(), "--quality normal --resolution 32 --animated");
    const RecordedBake again = recordedBake(collider.provenance.options);
    EXPECT_TRUE(again.understood && again.request.animated && settingsOf(again.request));
    const AnimatedMesh mesh = required(readAnimatedMesh(collider.animation));
    ASSERT_EQ(mesh.triangles.size(), 13U);
    // The drawn mesh must have the same orientation as the maps.
    double volume = 0.0;
    for (const glm::uvec3& t : mesh.triangles) {
        volume += glm::dot(mesh.positions[t.x], glm::cross(mesh.positions[t.y], mesh.positions[t.z]));
    }
    EXPECT_NEAR(volume, 6.0, 1e-5);
    EXPECT_EQ(findClip(mesh, "go"), 0U);
}

MeshCheck checkOf(const BakeResult& baked, const TriangleMesh& mesh) {
    CheckRequest request;
    request.samples = 2000;
    return required(check(request, baked.baked.collider, mesh));
}

TEST(Director, BakesAMeshInMemory) {
    BakeRequest request;
    request.budget = 60'000;
    const BakeResult made = required(bake(request, {}, makeBoxMesh({0, 0, 0}, {1, 1, 1})));
    EXPECT_LE(made.baked.collider.texelBytes(), 60'000U);
    EXPECT_TRUE(made.patches && made.wrong && made.wrong->total() < 5.0);
    EXPECT_LT(checkOf(made, makeBoxMesh({0, 0, 0}, {1, 1, 1})).wrongPercent(), 5.0);
    // bakeSolid() makes the same maps from a mesh that needs no preparation.
    EXPECT_EQ(required(bakeSolid(request, made.mesh.mesh)).collider.maps, made.baked.collider.maps);
    request.import.unit = "mm";
    EXPECT_FALSE(bake(request, {}, makeBoxMesh({0, 0, 0}, {1, 1, 1})));
}

TEST(Director, WarnsIfTheGradeIsNotGood) {
    // A lattice of four by four rods.
    std::vector<TriangleMesh> rods;
    for (int i = 0; i < 4; ++i) {
        rods.push_back(makeBoxMesh({0.0, i - 1.5, 0.0}, {2.0, 0.05, 0.05}));
        rods.push_back(makeBoxMesh({i - 1.5, 0.0, 0.0}, {0.05, 2.0, 0.05}));
    }
    BakeRequest request;
    for (const auto& [budget, grade] : {std::pair{32'000U, "fair"}, {64'000U, "good"}}) {
        request.budget = budget;
        const BakeResult baked = required(bake(request, {}, joined(rods)));
        EXPECT_EQ(gradeOf(baked.wrong->total()), grade) << baked.wrong->total();
        const std::string warned = "% wrong near the surface; try --budget";
        EXPECT_EQ(std::ranges::any_of(
                      baked.baked.report.warnings,
                      [&](const std::string& warning) { return warning.find(warned) != std::string::npos; }),
                  budget == 32'000U);
        EXPECT_NE(bakeText(baked, "x.relief", 1, false).find("% wrong near the surface"), std::string::npos);
    }
    // With --max-error, and with --texel if the budget suffices for it, a larger budget does not help.
    const auto adviceOf = [&] {
        const BakeResult coarse = required(bake(request, {}, joined(rods)));
        EXPECT_GT(coarse.wrong->total(), 1.0);
        std::string all;
        for (const std::string& warning : coarse.baked.report.warnings) {
            all += warning + "\n";
        }
        return all;
    };
    request.budget = 1'000'000;
    request.texel = 0.25F;
    EXPECT_NE(adviceOf().find("try --texel 0.125\n"), std::string::npos) << adviceOf();
    request.budget = 32'000;
    request.texel = 0.01F;
    EXPECT_NE(adviceOf().find("try --budget 128kB\n"), std::string::npos) << adviceOf();
    request.budget.reset();
    request.texel.reset();
    request.max_error = 6.0F;
    EXPECT_EQ(adviceOf().find("--budget"), std::string::npos);
}

TEST(Director, AdvisesOnlyMovingTheOriginIfFloatsAreTooCoarse) {
    const TriangleMesh mesh = moved(makeIcosphere({0, 0, 0}, 1.0, 3),
                                    [](const glm::dvec3& p) { return p + glm::dvec3(4e5, 0.0, 8e5); });
    BakeRequest request;
    request.budget = 20'000;
    const BakeResult baked = required(bake(request, {}, mesh));
    ASSERT_GT(baked.wrong->total(), 5.0);
    const std::string warning = coarseFloatsWarning(mesh).value();
    EXPECT_NE(warning.find("move it to the origin"), std::string::npos);
    // The wrong percentage is still reported, without advice on the budget.
    ASSERT_EQ(baked.baked.report.warnings.size(), 2U);
    EXPECT_EQ(baked.baked.report.warnings[0], warning);
    EXPECT_NE(baked.baked.report.warnings[1].find("% wrong near the surface; move it to the origin"),
              std::string::npos);
    const MeshCheck checked = checkOf(baked, mesh);
    EXPECT_EQ(checked.warnings, std::vector{warning});
    EXPECT_TRUE(adviceFor(checked, "mesh.obj", "out.relief").empty());
    EXPECT_FALSE(coarseFloatsWarning(makeIcosphere({0, 0, 0}, 1.0, 1)));
    // A bake by --max-error reports it, too.
    request.budget.reset();
    request.max_error = 50.0F;
    const BakeResult limited = required(bake(request, {}, mesh));
    ASSERT_GT(limited.wrong->total(), 5.0);
    EXPECT_TRUE(std::ranges::any_of(limited.baked.report.warnings, [](const std::string& text) {
        return text.find("% wrong near the surface; move it to the origin") != std::string::npos;
    }));
}

TEST(ShellWord, IsOneShellWord) {
    EXPECT_EQ(shellWord("a/b-1.obj"), "a/b-1.obj");
    EXPECT_EQ(shellWord("my mesh.obj"), "'my mesh.obj'");
    EXPECT_EQ(shellWord("it's.obj"), "'it'\\''s.obj'");
    EXPECT_EQ(shellWord("$(reboot)"), "'$(reboot)'");
    EXPECT_EQ(shellWord("-o"), "./-o");
    EXPECT_EQ(shellWord(""), "''");
}

}  // namespace
}  // namespace relief::test
