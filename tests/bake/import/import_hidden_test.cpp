// SPDX-License-Identifier: Apache-2.0
// Hidden geometry, and instances of missing geometry.

#include <cstring>
#include <ctime>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "bake/import/animated_import.h"
#include "bake/import/level.h"
#include "bake/import/mesh_import.h"
#include "bake/import/source_properties.h"
#include "tests/bake/import/import_meshes.h"
#include "tests/temporary_folder.h"

namespace relief::test {
namespace {

/// The tetrahedron at node `t`, and at node `other` with these properties, translated by 10 along x.
std::string twoFbx(const std::string& properties, const std::string& other_class = "Mesh") {
    std::string text = tetrahedronFbx(1, 1, "100");
    const std::string model = "Model: 2000, \"Model::t\", \"Mesh\" {\nVersion: 232\nProperties70:  {\n}\n}\n";
    text = replaced(text, model,
                    model + "Model: 3000, \"Model::other\", \"" + other_class +
                        "\" {\nVersion: 232\nProperties70:  {\n"
                        "P: \"Lcl Translation\", \"Lcl Translation\", \"\", \"A\",10,0,0\n" +
                        properties + "}\n}\n");
    const std::string placed = "C: \"OO\",1000,2000\n";
    return replaced(text, placed, placed + "C: \"OO\",3000,0\nC: \"OO\",1000,3000\n");
}

/// Node `parent` has the child `inner`, a tetrahedron at x = 10, beside node `t`.
std::string nestedFbx(const std::string& parent, const std::string& inner) {
    std::string text = twoFbx(inner);
    text = replaced(text, "Model: 3000",
                    "Model: 4000, \"Model::parent\", \"Null\" {\nVersion: 232\n"
                    "Properties70:  {\n" +
                        parent + "}\n}\nModel: 3000");
    return replaced(text, "C: \"OO\",3000,0\n", "C: \"OO\",4000,0\nC: \"OO\",3000,4000\n");
}

/// A LodGroup `Tree` with the levels `near` at x = 0 and `far` at x = 10, beside node `t`.
std::string levelsFbx() {
    std::string text = twoFbx("");
    text = replaced(text, "Model: 3000",
                    "Model: 4000, \"Model::Tree\", \"LodGroup\" {\nVersion: 232\nProperties70:  {\n}\n}\n"
                    "Model: 5000, \"Model::near\", \"Mesh\" {\nVersion: 232\nProperties70:  {\n}\n}\n"
                    "Model: 3000");
    return replaced(text, "C: \"OO\",3000,0\n",
                    "C: \"OO\",4000,0\nC: \"OO\",5000,4000\nC: \"OO\",1000,5000\nC: \"OO\",3000,4000\n");
}

/// Converts the text FBX documents above to binary.
class BinaryFbx {
  public:
    explicit BinaryFbx(const std::string& text) : lines_(text) {
        out_ = std::string("Kaydara FBX Binary  \0\x1a\0", 23);
        number(std::uint32_t{7300});
        std::string line;
        std::getline(lines_, line);  // the comment
        readBlock();
        out_ += std::string(13, '\0');
    }
    [[nodiscard]] const std::string& bytes() const { return out_; }

  private:
    template <class T>
    void number(T value) {
        const std::size_t at = out_.size();
        out_.resize(at + sizeof(value));
        std::memcpy(&out_[at], &value, sizeof(value));
    }
    void write(std::size_t at, std::size_t value) {
        const auto number = static_cast<std::uint32_t>(value);
        std::memcpy(&out_[at], &number, sizeof(number));
    }

    /// Reads until '}'. \return whether the block has lines
    bool readBlock() {
        bool any = false;
        for (std::string line; std::getline(lines_, line) && line != "}"; any = true) {
            readNode(line);
        }
        return any;
    }

    void readNode(const std::string& line) {
        const std::size_t at = out_.size();
        const std::size_t colon = line.find(':');
        const std::string name = line.substr(0, colon);
        const bool opens = line.ends_with('{');
        out_ += std::string(12, '\0') + static_cast<char>(name.size()) + name;
        const std::size_t begin = out_.size();
        std::size_t count = 1;
        if (line[colon + 2] == '*') {
            readArray(name == "Vertices");
        } else {
            count = writeProperties(line.substr(colon + 1, line.size() - colon - (opens ? 2 : 1)), name);
        }
        write(at + 4, count);
        write(at + 8, out_.size() - begin);
        if (opens && line[colon + 2] != '*' && readBlock()) {
            out_ += std::string(13, '\0');
        }
        write(at, out_.size());
    }

    void readArray(bool doubles) {
        std::string line;
        std::getline(lines_, line);
        std::istringstream words(line.substr(2));
        std::vector<double> values;
        for (std::string word; std::getline(words, word, ',');) {
            values.push_back(std::stod(word));
        }
        out_ += doubles ? 'd' : 'i';
        number(static_cast<std::uint32_t>(values.size()));
        number(std::uint32_t{0});  // not compressed
        number(static_cast<std::uint32_t>(values.size() * (doubles ? 8 : 4)));
        for (const double value : values) {
            doubles ? number(value) : number(static_cast<std::int32_t>(value));
        }
        std::getline(lines_, line);  // its '}'
    }

    std::size_t writeProperties(const std::string& text, const std::string& node) {
        std::istringstream words(text);
        std::size_t count = 0;
        bool whole = node != "P";
        for (std::string word; std::getline(words, word, ',');) {
            word.erase(0, word.find_first_not_of(' '));
            word.erase(word.find_last_not_of(' ') + 1);
            if (word.empty()) {
                continue;
            }
            ++count;
            if (word[0] == '"') {
                word = word.substr(1, word.size() - 2);
                whole = whole || word == "int" || word == "bool" || word == "Visibility Inheritance";
                const std::size_t split = word.find("::");
                word = split == std::string::npos
                           ? word
                           : word.substr(split + 2) + std::string("\0\1", 2) + word.substr(0, split);
                out_ += 'S';
                number(static_cast<std::uint32_t>(word.size()));
                out_ += word;
            } else if (node.ends_with("Version")) {
                out_ += 'I';
                number(static_cast<std::int32_t>(std::stoi(word)));
            } else if (node == "P" && whole) {
                out_ += 'I';
                number(static_cast<std::int32_t>(std::stoi(word)));
            } else if (node == "P") {
                out_ += 'D';
                number(std::stod(word));
            } else {
                out_ += 'L';
                number(static_cast<std::int64_t>(std::stoll(word)));
            }
        }
        return count;
    }

    std::istringstream lines_;
    std::string out_;
};

std::string binary(const std::string& fbx) {
    return BinaryFbx(fbx).bytes();
}

std::string visibility(const char* value) {
    return std::string(R"(P: "Visibility", "Visibility", "", "A",)") + value + "\n";
}

std::string propertyShow(int value) {
    return R"(P: "Show", "bool", "", "",)" + std::to_string(value) + "\n";
}

/// A document with this node library and this visual scene.
std::string dae(const std::string& scene, const std::string& library = "") {
    return replaced(
        replaced(tetrahedronDae(""), R"(<node id="n"><instance_geometry url="#g"/></node>)", scene),
        "<library_visual_scenes>", "<library_nodes>" + library + "</library_nodes><library_visual_scenes>");
}

constexpr const char* kShownNode = R"(<node id="n"><instance_geometry url="#g"/></node>)";
constexpr const char* kMoved = "<translate>10 0 0</translate>";
constexpr const char* kUnseen =
    R"(<extra><technique profile="FCOLLADA"><visibility>0.000000</visibility></technique></extra>)";

/// A node with the tetrahedron at x = 10.
std::string hiddenNode(const std::string& attributes, const std::string& extra = kUnseen) {
    return "<node " + attributes + ">" + kMoved + R"(<instance_geometry url="#g"/>)" + extra + "</node>";
}
std::string hiddenDae(const std::string& attributes, const std::string& extra = kUnseen) {
    return dae(kShownNode + hiddenNode(attributes, extra));
}

/// The tetrahedron at x = 0, and hidden at x = 10.
std::vector<std::pair<std::string, std::string>> hiddenFiles() {
    const std::string hidden = R"({"mesh":0,"name":"other","translation":[10,0,0],"extensions":)"
                               R"({"KHR_node_visibility":{"visible":false}}})";
    const GltfParts gltf{.nodes = R"({"mesh":0},)" + hidden, .roots = "0,1"};
    const GltfParts below{.nodes = R"({"mesh":0},{"children":[2],"extensions":)"
                                   R"({"KHR_node_visibility":{"visible":false}}},)"
                                   R"({"mesh":0,"name":"other","translation":[10,0,0]})",
                          .roots = "0,1",
                          .more = R"("extensionsRequired":["KHR_node_visibility"],)"};
    const std::string shape =
        "numvert 4\n0 0 0\n1 0 0\n0 2 0\n0 0 3\nnumsurf 4\n"
        "SURF 0x0\nrefs 3\n0 0 0\n2 0 0\n1 0 0\nSURF 0x0\nrefs 3\n0 0 0\n1 0 0\n3 0 0\n"
        "SURF 0x0\nrefs 3\n1 0 0\n2 0 0\n3 0 0\nSURF 0x0\nrefs 3\n0 0 0\n3 0 0\n2 0 0\nkids 0\n";
    return {
        {"visibility.fbx", twoFbx(visibility("0"))},
        {"show.fbx", twoFbx(propertyShow(0))},
        {"binary.fbx", binary(twoFbx(visibility("0")))},
        {"binary_show.fbx", binary(twoFbx(propertyShow(0)))},
        {"binary_parent.fbx", binary(nestedFbx(visibility("0"), ""))},
        {"parent.fbx", nestedFbx(visibility("0"), "")},
        {"visible.gltf", tetrahedronGltf(gltf)},
        {"below.gltf", tetrahedronGltf(below)},
        {"visibility.dae", hiddenDae(R"(id="other" name="other")")},
        {"sid.dae", hiddenDae(R"(sid="other")")},
        {"name.dae", hiddenDae(R"(name="other")")},
        {"technique.dae",
         hiddenDae(R"(id="other")",
                   R"(<extra><technique profile="MAX3D"><frozen>0</frozen></technique><technique profile=)"
                   R"("FCOLLADA"><visibility>0</visibility></technique></extra>)")},
        {"extra.dae",
         hiddenDae(R"(id="other")", "<extra><technique profile=\"x\"/></extra>" + std::string(kUnseen))},
        {"false.dae",
         hiddenDae(
             R"(id="other")",
             "<extra><technique profile=\"FCOLLADA\"><visibility> false </visibility></technique></extra>")},
        {"library.dae", dae(std::string(kShownNode) + R"(<node><instance_node url="#other"/></node>)",
                            hiddenNode(R"(id="other")"))},
        {"hidden.ac",
         "AC3Db\nMATERIAL \"\" rgb 1 1 1 amb 0 0 0 emis 0 0 0 spec 0 0 0 shi 0 trans 0\n"
         "OBJECT world\nkids 2\nOBJECT poly\nname \"t\"\n" +
             shape + "OBJECT poly\nname \"other\"\nhidden\nloc 10 0 0\n" + shape},
    };
}

TEST(ImportHidden, HiddenGeometryIsSkippedAndCounted) {
    for (const auto& [name, text] : hiddenFiles()) {
        SCOPED_TRACE(name);
        const TriangleMesh mesh = imported(name, text);
        EXPECT_EQ(mesh.triangles.size(), 4U);
        EXPECT_LT(mesh.bounds.max.x, 5.0F);
        EXPECT_TRUE(warns(mesh, "left out 1 hidden object ('other'"))
            << ::testing::PrintToString(mesh.warnings);
        EXPECT_EQ(mesh.warnings.size(), 1U);
    }
}

// FBX: Visibility applies to all descendants, Show only to its node.
TEST(ImportHidden, FbxShowAffectsOnlyItsNode) {
    const TriangleMesh mesh = imported("show.fbx", nestedFbx(propertyShow(0), ""));
    EXPECT_EQ(mesh.triangles.size(), 8U);
    EXPECT_TRUE(mesh.warnings.empty()) << ::testing::PrintToString(mesh.warnings);
    EXPECT_EQ(imported("show.fbx", binary(nestedFbx(propertyShow(0), ""))).triangles.size(), 8U);
}

TEST(ImportHidden, LevelsSkipHiddenGeometry) {
    const TemporaryFolder folder;
    for (const auto& [name, text] : hiddenFiles()) {
        SCOPED_TRACE(name);
        EXPECT_EQ(required(importLevelInWorker(folder.write(name, text))).bodies.size(), 1U);
    }
}

TEST(ImportHidden, VisibleGeometryIsKept) {
    for (const std::string& properties :
         {visibility("1"), visibility("0.5"), propertyShow(1), std::string()}) {
        const TriangleMesh mesh = imported("shown.fbx", twoFbx(properties));
        EXPECT_EQ(mesh.triangles.size(), 8U);
        EXPECT_TRUE(mesh.warnings.empty());
    }
    // A node that does not inherit visibility.
    const std::string apart = R"(P: "Visibility Inheritance", "Visibility Inheritance", "", "",0)"
                              "\n";
    EXPECT_EQ(imported("apart.fbx", nestedFbx(visibility("0"), apart)).triangles.size(), 8U);
    EXPECT_EQ(imported("apart.fbx", binary(nestedFbx(visibility("0"), apart))).triangles.size(), 8U);
}

TEST(ImportHidden, KeepReadsHiddenGeometry) {
    ImportOptions keep;
    keep.hidden = HiddenMode::kKeep;
    std::vector<std::pair<std::string, std::string>> files = hiddenFiles();
    files.emplace_back("levels.fbx", levelsFbx());
    for (const auto& [name, text] : files) {
        SCOPED_TRACE(name);
        const TriangleMesh mesh = imported(name, text, keep);
        EXPECT_GT(mesh.bounds.max.x, 10.0F);
        EXPECT_TRUE(mesh.warnings.empty());
    }
}

/// COLLADA nodes may have no name or equal names. An id is optional, and a sid is not unique.
TEST(ImportHidden, ColladaNodesWithEqualNamesAreHiddenSeparately) {
    const std::string other = R"(<technique profile="OTHER"><kind>1</kind></technique>)";
    for (const std::string& extra : {std::string(kUnseen), replaced(kUnseen, "<extra>", "<extra>" + other),
                                     "<extra>" + other + "</extra>" + kUnseen}) {
        for (const char* attributes : {R"(sid="k")", R"(name="k")", R"(id="" sid="k")", ""}) {
            SCOPED_TRACE(attributes + extra);
            const std::string shown =
                "<node " + std::string(attributes) + R"(><instance_geometry url="#g"/></node>)";
            const std::string hidden = hiddenNode(attributes, extra);
            const TriangleMesh mesh = imported("two.dae", dae(shown + hidden + shown + hidden));
            EXPECT_EQ(mesh.triangles.size(), 8U);
            EXPECT_LT(mesh.bounds.max.x, 5.0F);
            EXPECT_TRUE(warns(mesh, "left out 2 hidden objects"));
            EXPECT_EQ(mesh.warnings.size(), 1U);
        }
    }
    // assimp drops an instance of a node inside a library node.
    const TriangleMesh mesh = imported(
        "dropped.dae", dae(R"(<node><instance_node url="#inner"/><instance_node url="#l"/></node>)" +
                               std::string(kShownNode),
                           R"(<node id="l"><node id="inner"/>)" + hiddenNode(R"(sid="k")") + "</node>"));
    EXPECT_EQ(mesh.triangles.size(), 4U);
    EXPECT_TRUE(warns(mesh, "left out 1 hidden object ('k'")) << ::testing::PrintToString(mesh.warnings);
}

TEST(ImportHidden, FullyHiddenFilesAreRejectedWithTheOption) {
    const std::string all = R"({"mesh":0,"extensions":{"KHR_node_visibility":{"visible":false}}})";
    expectWrong("none.gltf", {{tetrahedronGltf({.nodes = all}), "all of its objects are hidden"}});
    // The object gets the chunk 0x4010; later, a keyframer contains a node for it.
    std::string file = tetrahedron3ds();
    file += std::string("\x10\x40\6\0\0\0", 6);
    for (const std::size_t size_at : {2U, 8U, 14U}) {
        file[size_at] = static_cast<char>(file[size_at] + 6);
    }
    EXPECT_TRUE(warns(imported("some.3ds", file),
                      "could not leave out 1 hidden object ('t'), because no node represents it; remove it"));
    const std::string keyframer(
        "\x00\xB0\x22\0\0\0\x02\xB0\x1C\0\0\0\x30\xB0\x08\0\0\0\0\0"
        "\x10\xB0\x0E\0\0\0t\0\0\0\0\0\xFF\xFF",
        34);
    file += keyframer;
    file[2] = static_cast<char>(file[2] + static_cast<char>(keyframer.size()));
    expectWrong("none.3ds", {{file, "--hidden keep"}});
}

TEST(ImportHidden, HiddenNamesSelectNothing) {
    ImportOptions options;
    options.names = {"other"};
    expectRejected(importText("names.fbx", twoFbx(visibility("0")), options),
                   "no triangle has the name 'other'", ErrorCode::kUsage);
}

TEST(ImportHidden, OnlyTheFirstLevelOfDetailIsBaked) {
    for (const std::string& text : {levelsFbx(), binary(levelsFbx())}) {
        const TriangleMesh mesh = imported("levels.fbx", text);
        EXPECT_EQ(mesh.triangles.size(), 8U);
        EXPECT_LT(mesh.bounds.max.x, 5.0F);
        EXPECT_TRUE(warns(mesh, "left out 1 lower level of detail ('other'"));
    }
    ImportOptions named;  // the group keeps its name
    named.names = {"Tree"};
    EXPECT_TRUE(importText("levels.fbx", levelsFbx(), named));
    const GltfParts gltf{.nodes = R"({"mesh":0,"extensions":{"MSFT_lod":{"ids":[1]}}},)"
                                  R"({"mesh":0,"name":"far","translation":[10,0,0]})",
                         .roots = "0,1"};
    EXPECT_TRUE(
        warns(imported("levels.gltf", tetrahedronGltf(gltf)), "left out 1 lower level of detail ('far'"));
    expectWrong("levels.gltf",
                {{tetrahedronGltf({.nodes = R"({"mesh":0,"extensions":{"MSFT_lod":{"ids":[7]}}})"}),
                  "nodes[0].extensions.MSFT_lod references nodes[7], which does not exist"}});
    // The first level is hidden, directly or by an unnamed parent.
    const std::string near = R"({"mesh":0,"extensions":{"MSFT_lod":{"ids":[1,2]})";
    const std::string hidden = R"("KHR_node_visibility":{"visible":false})";
    const std::string lower = R"({"mesh":0,"translation":[10,0,0]},{"mesh":0,"translation":[20,0,0]})";
    for (const auto& [nodes, roots] :
         {std::pair(near + "," + hidden + "}}," + lower, "0,1,2"),
          std::pair(near + "}}," + lower + R"(,{"children":[0],"extensions":{)" + hidden + "}}", "3,1,2")}) {
        const TriangleMesh mesh = imported("hidden.gltf", tetrahedronGltf({.nodes = nodes, .roots = roots}));
        EXPECT_EQ(mesh.bounds.min.x, 10.0F);
        EXPECT_EQ(mesh.bounds.max.x, 11.0F);
        EXPECT_TRUE(warns(mesh, "left out 1 hidden object; ")) << ::testing::PrintToString(mesh.warnings);
        EXPECT_TRUE(warns(mesh, "left out 1 lower level of detail; "));
    }
}

TEST(ImportHidden, CyclicLevelsOfDetailAreRejected) {
    const auto node = [](const std::string& levels, const std::string& more = "") {
        return R"({"mesh":0,"extensions":{"MSFT_lod":{"ids":[)" + levels + "]}}" + more + "}";
    };
    const std::string words = "nodes[0] is a lower level of detail of itself (MSFT_lod)";
    ImportOptions keep;
    keep.hidden = HiddenMode::kKeep;
    const auto kept = importText(
        "kept.gltf", tetrahedronGltf({.nodes = node("1") + "," + node("0"), .roots = "0,1"}), keep);
    ASSERT_TRUE(kept) << kept.error().message;
    EXPECT_EQ(kept->triangles.size(), 8U);
    expectWrong(
        "ring.gltf",
        {{tetrahedronGltf({.nodes = node("1") + "," + node("0"), .roots = "0,1"}), words},
         {tetrahedronGltf({.nodes = node("1") + "," + node("2") + "," + node("0"), .roots = "0,1,2"}), words},
         {tetrahedronGltf({.nodes = R"({"children":[1]},)" + node("0")}), words}});
    // Its own index, a level with a level, a shared level, and a level that is also a child.
    const GltfParts chain{.nodes = node("0,1,2") + "," + node("2") + R"(,{"mesh":0},)" +
                                   node("4,2", R"(,"children":[4])") + R"(,{"mesh":0})",
                          .roots = "0,1,2,3"};
    const TriangleMesh mesh = imported("chain.gltf", tetrahedronGltf(chain));
    EXPECT_EQ(mesh.triangles.size(), 8U);
    EXPECT_TRUE(warns(mesh, "left out 3 lower levels of detail"));
}

/// Every string contains all following ones, so copies would take quadratic time.
TEST(ImportHidden, LongFbxStringsAreNotCopied) {
    constexpr std::uint32_t kSize = 1U << 20;
    const auto string = [](std::uint32_t size, const char* text) {
        std::string all = "S0000" + std::string(text);
        std::memcpy(&all[1], &size, sizeof(size));
        return all;
    };
    std::string file("Kaydara FBX Binary  \0\x1a\0", 23);
    while (file.size() + 100 < kSize) {
        file += string(10, "Visibility");
        file += string(static_cast<std::uint32_t>(kSize - file.size() - 5), "");
    }
    file.resize(kSize);
    file += string(0, "") + string(0, "");
    const std::clock_t start = std::clock();
    EXPECT_FALSE(patchedFbx(std::as_bytes(std::span(file))));
    EXPECT_LT(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, 1.0);
}

TEST(ImportHidden, AnimatedVisibilityIsNoted) {
    const std::string curve = "AnimationCurveNode: 9000, \"AnimCurveNode::Visibility\", \"\" {\n}\n";
    const std::string fbx = replaced(twoFbx(""), "Model: 3000", curve + "Model: 3000");
    EXPECT_TRUE(warns(imported("moves.fbx", fbx), "animations show and hide"));
    EXPECT_TRUE(warns(imported("moves.fbx", binary(fbx)), "animations show and hide"));
    const GltfParts gltf{
        .more = R"("animations":[{"channels":[{"sampler":0,"target":{"path":"pointer","extensions":)"
                R"({"KHR_animation_pointer":{"pointer":)"
                R"("/nodes/0/extensions/KHR_node_visibility/visible"}}}}]}],)"};
    EXPECT_TRUE(warns(imported("moves.gltf", tetrahedronGltf(gltf)), "animations show and hide"));
}

TEST(ImportHidden, MissingColladaInstancesAreNamed) {
    const std::string lost = R"(<node name="lost"><instance_geometry url="#missing"/></node>)";
    const TriangleMesh mesh = imported("missing.dae", dae(kShownNode + lost));
    EXPECT_EQ(mesh.triangles.size(), 4U);
    EXPECT_TRUE(warns(mesh, "line 1: the node 'lost' instantiates '#missing', which does not exist"))
        << ::testing::PrintToString(mesh.warnings);
    for (const char* element : {"instance_controller", "instance_node"}) {
        const std::string node = std::string("<node id=\"lost\"><") + element + R"( url="#missing"/></node>)";
        EXPECT_TRUE(warns(imported("missing.dae", dae(kShownNode + node)), "the node 'lost'")) << element;
        EXPECT_TRUE(warns(
            imported("missing.dae", dae(std::string(kShownNode) + R"(<node><instance_node url="#l"/></node>)",
                                        R"(<node id="l" name="deep">)" + node + "</node>")),
            "the node 'lost'"))
            << element;
    }
    const TriangleMesh two = imported("missing.dae", dae(kShownNode + lost + lost));
    EXPECT_TRUE(warns(two, "and 1 more like it"));
    EXPECT_EQ(two.warnings.size(), 1U);
    expectWrong(
        "missing.dae",
        {{dae(std::string(kShownNode) + R"(<node name="x"><instance_geometry url="b.dae#g"/></node>)"),
          "line 1: the node 'x' instantiates 'b.dae#g', which is in another file", ErrorCode::kUnsupported}});
}

}  // namespace
}  // namespace relief::test
