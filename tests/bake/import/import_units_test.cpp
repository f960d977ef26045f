// One tetrahedron in every format, with units and axes: it must lie at the same coordinates.
#include "bake/import/import_units.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <limits>
#include <span>

#include "bake/import/mesh_import.h"
#include "bake/mesh/triangle_plane.h"
#include "tests/bake/import/import_meshes.h"
#include "tests/bake/meshes.h"

namespace relief::test {
namespace {

double signedVolume(const TriangleMesh& mesh) {
    double volume = 0.0;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const TrianglePlane plane = planeOf(mesh, i);
        volume += dot(plane.point, plane.normal) / 6.0;
    }
    return volume;
}

void expectLiesAt(const Result<TriangleMesh>& mesh, const glm::vec3& low, const glm::vec3& high,
                  const std::string& unit) {
    ASSERT_TRUE(mesh) << mesh.error().message;
    const float tolerance = 1e-5F * glm::distance(low, high);
    EXPECT_LT(glm::distance(mesh->bounds.min, low), tolerance)
        << mesh->bounds.min.x << " " << mesh->bounds.min.y;
    EXPECT_LT(glm::distance(mesh->bounds.max, high), tolerance)
        << mesh->bounds.max.x << " " << mesh->bounds.max.y;
    EXPECT_EQ(mesh->unit, unit);
    const glm::vec3 size = high - low;
    EXPECT_NEAR(signedVolume(*mesh) / double{size.x * size.y * size.z / 6.0F}, 1.0, 1e-4)
        << "turned inside out";
}

ImportOptions options(const std::string& unit, std::optional<UpAxis> up = std::nullopt) {
    return {unit, up};
}

TEST(ImportUnits, EveryTurnIsARotationThatLiftsItsAxis) {
    for (const char* name : {"+x", "-x", "+y", "-y", "+z", "-z"}) {
        SCOPED_TRACE(name);
        const std::optional<UpAxis> up = fromWord<UpAxis>(name);
        ASSERT_TRUE(up);
        const glm::dmat3 turn = turnUpwards(*up);
        const int axis = (name[1] | 0x20) - 'x';
        EXPECT_EQ(turn[axis], glm::dvec3(0, name[0] == '-' ? -1 : 1, 0));
        EXPECT_EQ(glm::transpose(turn) * turn, glm::dmat3(1.0));
        EXPECT_EQ(glm::dot(glm::cross(turn[0], turn[1]), turn[2]), 1.0);
    }
    for (const char* wrong : {"", "z", "up", "+w", "+zz"}) {
        EXPECT_FALSE(fromWord<UpAxis>(wrong)) << wrong;
    }
}

TEST(ImportUnits, WordsAreMetres) {
    EXPECT_EQ(metresPer("in"), 0.0254);
    EXPECT_DOUBLE_EQ(metresPer("ft").value_or(0), 12 * 0.0254);
    EXPECT_DOUBLE_EQ(metresPer("yd").value_or(0), 36 * 0.0254);
    EXPECT_EQ(metresPer("cm"), 0.01);
    EXPECT_FALSE(metresPer(""));
    EXPECT_FALSE(metresPer("inch"));
    for (const std::string_view unit : kLengthUnits) {
        EXPECT_TRUE(metresPer(unit)) << unit;
    }
}

TEST(ImportUnits, FormatsWithoutUnitStayAsTheyAreUntilToldOtherwise) {
    const TemporaryFolder folder;
    for (const auto& [name, text] :
         {std::pair{"t.obj", tetrahedronObj()}, std::pair{"t.ply", tetrahedronPly()},
          std::pair{"t.off", tetrahedronOff()}, std::pair{"t.stl", tetrahedronStl()}}) {
        SCOPED_TRACE(name);
        const std::filesystem::path path = folder.write(name, text);
        expectLiesAt(importMesh(path), {0, 0, 0}, {1, 2, 3}, "");
        expectLiesAt(importMesh(path, options("m")), {0, 0, 0}, {1, 2, 3}, "m");
        expectLiesAt(importMesh(path, options("in")), {0, 0, 0}, {0.0254F, 0.0508F, 0.0762F}, "m");
        expectLiesAt(importMesh(path, options("", UpAxis::kPlusZ)), {0, 0, -2}, {1, 3, 0}, "");
        expectLiesAt(importMesh(path, options("mm", UpAxis::kMinusX)), {0, -0.001F, 0}, {0.002F, 0, 0.003F},
                     "m");
        const Result<TriangleMesh> told = importMesh(path, options("mm", UpAxis::kPlusZ));
        ASSERT_TRUE(told);
        EXPECT_TRUE(told->warnings.empty()) << told->warnings.front();
    }
}

TEST(ImportUnits, FormatsThatSayItLandAtTheSamePlace) {
    const TemporaryFolder folder;
    const glm::vec3 low(0, 0, -2);  // 1, 2, 3 m with z upwards
    const glm::vec3 high(1, 3, 0);
    expectLiesAt(importMesh(folder.write("z.fbx", tetrahedronFbx(2, 1, "100"))), low, high, "m");
    expectLiesAt(
        importMesh(folder.write("z.dae", tetrahedronDae("<unit meter=\"1\"/><up_axis>Z_UP</up_axis>"))), low,
        high, "m");
    expectLiesAt(importMesh(folder.write("z.gltf", tetrahedronGltf()), options("", UpAxis::kPlusZ)), low,
                 high, "m");
    expectLiesAt(importMesh(folder.write("z.stl", tetrahedronStl()), options("m", UpAxis::kPlusZ)), low, high,
                 "m");
}

TEST(ImportUnits, FbxIsInCentimetresTimesItsFactor) {
    const TemporaryFolder folder;
    expectLiesAt(importMesh(folder.write("y.fbx", tetrahedronFbx(1, 1, "1"))), {0, 0, 0},
                 {0.01F, 0.02F, 0.03F}, "m");
    expectLiesAt(importMesh(folder.write("in.fbx", tetrahedronFbx(1, 1, "2.54"))), {0, 0, 0},
                 {0.0254F, 0.0508F, 0.0762F}, "m");
    expectLiesAt(importMesh(folder.write("x.fbx", tetrahedronFbx(0, 1, "100"))), {-2, 0, 0}, {0, 1, 3}, "m");
    expectLiesAt(importMesh(folder.write("ny.fbx", tetrahedronFbx(1, -1, "100"))), {0, -2, -3}, {1, 0, 0},
                 "m");
}

TEST(ImportUnits, ColladaSaysMetresAndAxis) {
    const TemporaryFolder folder;
    expectLiesAt(importMesh(folder.write("no.dae", tetrahedronDae(""))), {0, 0, 0}, {1, 2, 3}, "m");
    expectLiesAt(importMesh(folder.write("in.dae", tetrahedronDae("<unit name=\"inch\" meter=\"0.0254\"/>"))),
                 {0, 0, 0}, {0.0254F, 0.0508F, 0.0762F}, "m");
    expectLiesAt(importMesh(folder.write("x.dae", tetrahedronDae("<up_axis>X_UP</up_axis>"))), {-2, 0, 0},
                 {0, 1, 3}, "m");
}

TEST(ImportUnits, ThreeDsHasZUpwardsAndNoUnit) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.write("t.3ds", tetrahedron3ds());
    expectLiesAt(importMesh(path), {0, 0, -2}, {1, 3, 0}, "");
    expectLiesAt(importMesh(path, options("mm", UpAxis::kPlusY)), {0, 0, 0}, {0.001F, 0.002F, 0.003F}, "m");
}

TEST(ImportUnits, AnOptionWinsOverTheFileAndSaysSo) {
    const TemporaryFolder folder;
    const std::filesystem::path dae =
        folder.write("in.dae", tetrahedronDae("<unit meter=\"0.0254\"/><up_axis>Z_UP</up_axis>"));
    const Result<TriangleMesh> mesh = importMesh(dae, options("cm", UpAxis::kPlusX));
    expectLiesAt(mesh, {-0.02F, 0, 0}, {0, 0.01F, 0.03F}, "m");
    ASSERT_EQ(mesh->warnings.size(), 2U);
    EXPECT_EQ(mesh->warnings[0], "in.dae: --unit cm is taken, but the file says that its unit is 0.0254 m");
    EXPECT_EQ(mesh->warnings[1], "in.dae: --up +x is taken, but the file says that +z points upwards");
    // Said again, it is no contradiction.
    const Result<TriangleMesh> same = importMesh(dae, options("in", UpAxis::kPlusZ));
    ASSERT_TRUE(same);
    EXPECT_TRUE(same->warnings.empty());

    const Result<TriangleMesh> gltf = importMesh(folder.write("t.gltf", tetrahedronGltf()), options("mm"));
    expectLiesAt(gltf, {0, 0, 0}, {0.001F, 0.002F, 0.003F}, "m");
    EXPECT_EQ(gltf->warnings.size(), 1U);
    const Result<TriangleMesh> fbx =
        importMesh(folder.write("t.fbx", tetrahedronFbx(2, 1, "1")), options("m", UpAxis::kPlusY));
    expectLiesAt(fbx, {0, 0, 0}, {1, 2, 3}, "m");
    EXPECT_EQ(fbx->warnings.size(), 2U);
}

TEST(ImportUnits, ColladaHeadersAreReadAsWritten) {
    const auto frame = [](const std::string& asset, const char* begin = "<asset>") {
        const std::string text = "<COLLADA>" + (begin + asset) + "</asset></COLLADA>";
        return colladaFrame(std::as_bytes(std::span(text)));
    };
    EXPECT_EQ(frame("<up_axis> Z_UP\n</up_axis>").up, UpAxis::kPlusZ);
    EXPECT_EQ(frame("<up_axis>X_UP</up_axis>").up, UpAxis::kPlusX);
    EXPECT_EQ(frame("<up_axis>Z_UP</up_axis>", "<asset xmlns='x'><!-- <up_axis>Y_UP</up_axis> -->").up,
              UpAxis::kPlusZ);
    EXPECT_EQ(frame("<x><up_axis>Z_UP</up_axis></x>").up, UpAxis::kPlusY) << "not of the document";
    EXPECT_EQ(frame("").up, UpAxis::kPlusY);
    EXPECT_EQ(frame("").metres, 1.0);
    EXPECT_EQ(frame("<unit name='a>b' meter=' 1e-2 '/>").metres, 0.01);
    EXPECT_EQ(frame("<up_axis>W_UP</up_axis>").up_fault, "its up_axis 'W_UP' is none of COLLADA");
    EXPECT_EQ(frame("<unit meter='0,010000'/>").metres, 0.01);
    for (const char* meter : {"-1", "0", "0,0,1", "1,000.5", "nan", "inf", "", "1e-400", "1 m"}) {
        const SourceFrame faulty = frame("<unit meter='" + std::string(meter) + "'/>");
        EXPECT_FALSE(faulty.metres) << meter;
        EXPECT_EQ(faulty.unit_fault, "its unit is '" + std::string(meter) + "' metres, which is no length");
    }
    // As XML allows it.
    const TemporaryFolder folder;
    const std::string asset = "<unit name=\"meter\"\n meter = '0.5'/><up_axis>\nZ_UP </up_axis>";
    const std::filesystem::path path = folder.write("t.dae", tetrahedronDae(asset));
    expectLiesAt(importMesh(path), {0, 0, -1}, {0.5F, 1.5F, 0}, "m");
    expectLiesAt(importMesh(path, options("m")), {0, 0, -2}, {1, 3, 0}, "m");
}

/// A file whose unit cannot be meant is refused, and read where the caller names one.
void expectCured(const std::filesystem::path& path, const std::string& what, const std::string& cure,
                 const ImportOptions& cured, const glm::vec3& low, const glm::vec3& high) {
    SCOPED_TRACE(path.filename());
    const Result<TriangleMesh> refused = importMesh(path);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::kInvalidInput);
    EXPECT_NE(refused.error().message.find(path.filename().string()), std::string::npos);
    EXPECT_NE(refused.error().message.find(what), std::string::npos) << refused.error().message;
    EXPECT_NE(refused.error().message.find(cure), std::string::npos) << refused.error().message;
    expectLiesAt(importMesh(path, cured), low, high, "m");
}

TEST(ImportUnits, UnitsThatCannotBeMeantAreRefusedUntilToldOtherwise) {
    const TemporaryFolder folder;
    const glm::vec3 low(0.0F);
    const glm::vec3 high(0.01F, 0.02F, 0.03F);
    for (const std::string meter : {"-1", "0,0,1", "inf", "none"}) {
        expectCured(folder.write("t" + meter + ".dae", tetrahedronDae("<unit meter=\"" + meter + "\"/>")),
                    "'" + meter + "' metres", "--unit", options("cm"), low, high);
    }
    for (const std::string factor : {"-100", "nan", "10,5"}) {
        expectCured(folder.write("t" + factor + ".fbx", tetrahedronFbx(1, 1, factor)), factor, "--unit",
                    options("cm"), low, high);
    }
    expectCured(folder.write("up.fbx", tetrahedronFbx(5, 1, "1")), "UpAxis is 5", "--up",
                options("", UpAxis::kPlusY), low, high);
    expectCured(folder.write("up.dae", tetrahedronDae("<unit meter='0.01'/><up_axis>W_UP</up_axis>")),
                "'W_UP'", "--up", options("", UpAxis::kPlusY), low, high);
    for (const float scale :
         {-1.0F, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        expectCured(folder.write("t.3ds", tetrahedron3ds(scale)), "master scale", "--unit",
                    options("cm", UpAxis::kPlusY), low, high);
    }
    // The importer of FBX does not go on there.
    const Result<TriangleMesh> zero =
        importMesh(folder.write("zero.fbx", tetrahedronFbx(1, 1, "0")), options("cm"));
    ASSERT_FALSE(zero);
    EXPECT_NE(zero.error().message.find("UnitScaleFactor is 0"), std::string::npos) << zero.error().message;
    EXPECT_NE(zero.error().message.find("export it again"), std::string::npos) << zero.error().message;
}

TEST(ImportUnits, MasterScalesOf3dsDivide) {
    const TemporaryFolder folder;
    expectLiesAt(importMesh(folder.write("t.3ds", tetrahedron3ds(0.5F))), {0, 0, -4}, {2, 6, 0}, "");
    expectLiesAt(importMesh(folder.write("t.3ds", tetrahedron3ds(0.0F))), {0, 0, -2}, {1, 3, 0}, "");
}

TEST(ImportUnits, ANumberOfFbxMayBeWhole) {
    const TemporaryFolder folder;
    std::string text = tetrahedronFbx(1, 1, "100");
    const std::string type = R"("double", "Number")";
    text.replace(text.find(type), type.size(), R"("int", "Integer")");
    expectLiesAt(importMesh(folder.write("whole.fbx", text)), {0, 0, 0}, {1, 2, 3}, "m");
}

TEST(ImportUnits, FbxSaysItInTextAndInBytes) {
    const auto unit = [](const std::string& document) { return fbxUnit(std::as_bytes(std::span(document))); };
    EXPECT_EQ(
        unit("; FBX\n P: \"UnitScaleFactor\", \"double\", \"Number\", \"\", 2.54\r\n P: 1").value().value,
        2.54);
    EXPECT_EQ(unit("; FBX\nProperty: \"UnitScaleFactor\", \"double\", \"\",100\n").value().value, 100.0);
    EXPECT_EQ(unit("; FBX\n P: \"UnitScaleFactor\", \"double\", \"Number\", \"\",10,5").value().text, "10,5");
    EXPECT_FALSE(unit("; FBX\n P: \"UnitScaleFactor\", \"double\", \"Number\", \"\",10,5").value().value);
    EXPECT_FALSE(unit("; FBX\n P: \"UnitScaleFactor\"").value().value);
    EXPECT_FALSE(unit("; FBX\n P: \"OriginalUnitScaleFactor\", \"double\", \"Number\", \"\",7"));
    using namespace std::string_literals;
    const std::string head =
        "Kaydara FBX Binary  S\x0f\0\0\0UnitScaleFactorS\x06\0\0\0doubleS\x06\0\0\0NumberS\0\0\0\0"s;
    EXPECT_EQ(unit(head + "D\0\0\0\0\0\0\x59\x40"s).value().value, 100.0);
    EXPECT_EQ(unit(head + "I\x64\0\0\0"s).value().value, 100.0);
    EXPECT_EQ(unit(head + "F\0\0\xc8\xc2"s).value().value, -100.0);
    EXPECT_FALSE(unit(head + "D\0\0\0\0\0\0\xf8\x7f"s).value().value);
    EXPECT_FALSE(unit(head + "X").value().value);
    EXPECT_FALSE(unit(head).value().value);
    EXPECT_FALSE(unit("Kaydara FBX Binary  "));
}

// What a left-handed file calls z is turned round when it is asked for.
TEST(ImportUnits, UpOfALeftHandedFileIsItsOwn) {
    SourceFrame left;
    left.mirrored = true;
    EXPECT_EQ(changeOf(left, "", UpAxis::kPlusZ).turn, turnUpwards(UpAxis::kMinusZ));
    EXPECT_EQ(changeOf(left, "", UpAxis::kMinusZ).turn, turnUpwards(UpAxis::kPlusZ));
    EXPECT_EQ(changeOf(left, "", UpAxis::kPlusX).turn, turnUpwards(UpAxis::kPlusX));
    EXPECT_EQ(changeOf(left, "", std::nullopt).turn, glm::dmat3(1.0));
}

}  // namespace
}  // namespace relief::test
