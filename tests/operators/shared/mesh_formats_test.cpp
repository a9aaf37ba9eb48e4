// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes and surfaces through files and back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <regex>

#include "tests/operators/shared/files.hpp"
#include "tests/operators/shared/shapes.hpp"

namespace msml {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

/// One cell of every kind in an order that no grouping keeps, with regions and fields.
Mesh every_kind() {
  Mesh m;
  m.points.resize(10, 3);
  m.points << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, .5, 0, 0, .5, .5, 0, 0, .5, 0, 0, 0, .5, .5, 0, .5, 0, .5, .5;
  m.points *= 0.1;  // not representable in single precision
  const int ids[10] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  const int edge[3] = {0, 1, 4}, face[6] = {0, 1, 2, 4, 5, 6};
  m.add_cell(CellKind::tet10, ids, 7);
  m.add_cell(CellKind::tri3, ids, -2);
  m.add_cell(CellKind::vertex, ids, 1);
  m.add_cell(CellKind::tet4, ids, 3);
  m.add_cell(CellKind::line3, edge, 4);
  m.add_cell(CellKind::tri6, face, 5);
  m.add_cell(CellKind::line2, ids, 6);
  Field f{.name = "displacement", .components = 3};
  for (int i = 0; i < 30; ++i) f.values.push_back(i / 3.0);
  m.point_fields = {f};
  m.cell_fields = {{.name = "quality", .values = {1, 2, 3, 4, 5, 6, 1e-300}}};
  return m;
}

void expect_equal(const Mesh& a, const Mesh& b) {
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.kinds, b.kinds);
  EXPECT_EQ(a.nodes, b.nodes);
  EXPECT_EQ(a.regions, b.regions);
}

MeshPtr through(const Mesh& mesh, const std::filesystem::path& path) {
  const Registry registry = test::all();
  registry.write(std::make_shared<const Mesh>(mesh), path);
  return std::get<MeshPtr>(registry.read(path, Type::mesh));
}

class MeshFile : public testing::TestWithParam<std::string> {};

TEST_P(MeshFile, KeepsPointsCellsTheirOrderAndRegions) {
  const test::Folder folder("msml_mesh");
  const Mesh mesh = every_kind();
  expect_equal(*through(mesh, folder / ("m" + GetParam())), mesh);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);  // no temporary is left
}
INSTANTIATE_TEST_SUITE_P(All, MeshFile, testing::Values(".vtk", ".vtu", ".msh"));

class FieldFile : public testing::TestWithParam<std::string> {};

TEST_P(FieldFile, KeepsFieldsToTheLastBit) {
  const test::Folder folder("msml_field");
  const Mesh mesh = every_kind();
  const MeshPtr back = through(mesh, folder / ("m" + GetParam()));
  ASSERT_EQ(back->point_fields.size(), 1U);
  EXPECT_EQ(back->point_fields[0].name, "displacement");
  EXPECT_EQ(back->point_fields[0].components, 3);
  EXPECT_EQ(back->point_fields[0].values, mesh.point_fields[0].values);
  ASSERT_EQ(back->cell_fields.size(), 1U);
  EXPECT_EQ(back->cell_fields[0].values, mesh.cell_fields[0].values);
}
INSTANTIATE_TEST_SUITE_P(All, FieldFile, testing::Values(".vtk", ".vtu"));

TEST_P(FieldFile, KeepsNamesThatXmlWouldRead) {
  const test::Folder folder("msml_names");
  Mesh mesh = every_kind();
  mesh.point_fields[0].name = GetParam() == ".vtu" ? "a<b & \"c\">d" : "a b";  // legacy files have words of their own
  EXPECT_EQ(through(mesh, folder / ("m" + GetParam()))->point_fields[0].name, mesh.point_fields[0].name);
}

TEST(VtuFile, OfTwoFieldsWithOneNameTheLaterIsWrittenAndRegionsComeLast) {
  const test::Folder folder("msml_twins");
  Mesh mesh = every_kind();
  const std::size_t cells = mesh.kinds.size();
  const auto field = [&](const std::string& name, double value) {
    return Field{.name = name, .values = std::vector<double>(cells, value)};
  };
  mesh.cell_fields = {field("x", 1), field("region", 7), field("x", 2)};
  const MeshPtr back = through(mesh, folder / "m.vtu");
  EXPECT_EQ(back->regions, mesh.regions);
  ASSERT_EQ(back->cell_fields.size(), 1U);
  EXPECT_EQ(back->cell_fields[0].values, std::vector<double>(cells, 2));
}

TEST(VtuFile, WithTwoArraysOfOneNameIsRefused) {
  const test::Folder folder("msml_two");
  const auto file = [](const std::string& second) {
    return "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\"><UnstructuredGrid>"
           "<Piece NumberOfPoints=\"1\" NumberOfCells=\"1\"><PointData><DataArray type=\"Float64\" Name=\"a\" "
           "format=\"ascii\">3</DataArray></PointData><CellData><DataArray type=\"Float64\" Name=\"a\" "
           "format=\"ascii\">1</DataArray><DataArray type=\"Int32\" Name=\"" +
           second +
           "\" format=\"ascii\">2</DataArray></CellData><Points><DataArray type=\"Float64\" Name=\"Points\" "
           "NumberOfComponents=\"3\" format=\"ascii\">0 0 0</DataArray></Points><Cells><DataArray type=\"Int32\" "
           "Name=\"connectivity\" format=\"ascii\">0</DataArray><DataArray type=\"Int32\" Name=\"offsets\" "
           "format=\"ascii\">1</DataArray><DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">1</DataArray>"
           "</Cells></Piece></UnstructuredGrid></VTKFile>";
  };
  test::put_bytes(folder / "m.vtu", file("a"));
  EXPECT_THAT(test::read_error(folder / "m.vtu", Type::mesh), HasSubstr("m.vtu: holds two arrays named 'a', of which"));
  test::put_bytes(folder / "m.vtu", file("b"));
  EXPECT_EQ(std::get<MeshPtr>(test::all().read(folder / "m.vtu", Type::mesh))->cell_fields.size(), 2U);
}

TEST(VtuFile, MayHoldPointsAlone) {
  const test::Folder folder("msml_points");
  Mesh mesh;
  mesh.points = every_kind().points;
  const MeshPtr back = through(mesh, folder / "m.vtu");
  EXPECT_EQ(back->points, mesh.points);
  EXPECT_EQ(back->cell_count(), 0);
}

TEST(MeditFile, KeepsRegionsAndGroupsCellsByKind) {
  const test::Folder folder("msml_medit");
  Mesh mesh;
  mesh.points = every_kind().points;
  const int ids[4] = {0, 1, 2, 3};
  mesh.add_cell(CellKind::tet4, ids, 3);
  mesh.add_cell(CellKind::tri3, ids, 9);
  const MeshPtr back = through(mesh, folder / "m.mesh");
  EXPECT_EQ(back->points, mesh.points);
  EXPECT_THAT(back->kinds, ElementsAre(CellKind::tet4, CellKind::tri3));
  EXPECT_THAT(back->regions, ElementsAre(3, 9));
}

TEST(MeditFile, RefusesQuadraticCellsAndNamesFormatsThatHoldThem) {
  const test::Folder folder("msml_medit2");
  EXPECT_THROW(through(every_kind(), folder / "m.mesh"), Error);
  EXPECT_FALSE(std::filesystem::exists(folder / "m.mesh"));
}

TEST(GmshFile, TakesMidNodesInGmshsOrder) {
  // A tet10 as Gmsh numbers it: mid nodes on 01 12 20 03 23 13; x of each mid node tells its edge.
  const test::Folder folder("msml_gmsh");
  test::put_bytes(
      folder / "t.msh",
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 5 \"liver\"\n$EndPhysicalNames\n$Nodes\n10\n"
      "11 0 0 0\n12 1 0 0\n13 0 1 0\n14 0 0 1\n15 .5 0 0\n16 .5 .5 0\n17 0 .5 0\n18 0 0 .5\n19 0 .5 .5\n"
      "20 .5 0 .5\n$EndNodes\n$Elements\n1\n1 11 2 5 1 11 12 13 14 15 16 17 18 19 20\n$EndElements\n");
  const MeshPtr mesh = std::get<MeshPtr>(test::all().read(folder / "t.msh", Type::mesh));
  EXPECT_THAT(mesh->regions, ElementsAre(5));
  const auto middle = [&](int node) { return Vec3(mesh->points.row(mesh->cell(0)[node])); };
  EXPECT_EQ(middle(8), Vec3(.5, 0, .5));  // VTK's node 8 is on edge 13
  EXPECT_EQ(middle(9), Vec3(0, .5, .5));  // VTK's node 9 is on edge 23
}

class SurfaceFile : public testing::TestWithParam<std::string> {};

TEST_P(SurfaceFile, KeepsTheShape) {
  const test::Folder folder("msml_surface");
  const Registry registry = test::all();
  const Surface box = test::box(Vec3(0.1, 0.2, 0.3), Vec3(1, 2, 3));
  const auto path = folder / ("s" + GetParam());
  registry.write(std::make_shared<const Surface>(box), path);
  const SurfacePtr back = std::get<SurfacePtr>(registry.read(path, Type::surface));
  EXPECT_EQ(back->point_count(), 8);
  EXPECT_EQ(back->triangle_count(), 12);
  EXPECT_NEAR(test::volume(*back), 0.9 * 1.8 * 2.7, GetParam() == ".stl" ? 1e-6 : 1e-13);  // STL is single precision
  EXPECT_EQ(std::get<MeshPtr>(registry.read(path, Type::mesh))->count(CellKind::tri3), 12);
}
INSTANTIATE_TEST_SUITE_P(All, SurfaceFile,
                         testing::Values(".stl", ".off", ".obj", ".ply", ".vtp", ".vtk", ".vtu", ".mesh", ".msh"));

TEST(SurfaceFile, OfATetMeshIsRefusedAndNamesTheOperatorThatHelps) {
  const test::Folder folder("msml_tets");
  test::all().write(std::make_shared<const Mesh>(test::five_tets()), folder / "m.vtu");
  EXPECT_EQ(
      test::read_error(folder / "m.vtu", Type::surface),
      "m.vtu: holds 8 points, 5 tet4, not triangles alone, so it is no Surface; ExtractSurfaceMesh makes one of it");
}

TEST(SurfaceFile, QuadsBecomeTriangles) {
  const test::Folder folder("msml_quads");
  test::put_bytes(folder / "q.off", "OFF\n4 1 0\n0 0 0\n2 0 0\n2 3 0\n0 3 0\n4 0 1 2 3\n");
  const SurfacePtr s = std::get<SurfacePtr>(test::all().read(folder / "q.off", Type::surface));
  EXPECT_EQ(s->triangle_count(), 2);
  double area = 0;
  for (const auto& t : s->triangles) {
    const Vec3 a = s->points.row(t[0]), b = s->points.row(t[1]), c = s->points.row(t[2]);
    area += (b - a).cross(c - a).norm() / 2;
  }
  EXPECT_NEAR(area, 6, 1e-14);
}

TEST(MeshFiles, CellsOfOtherKindsAreCountedAndNamed) {
  const test::Folder folder("msml_hexa");
  test::put_bytes(
      folder / "h.vtk",
      "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 float\n0 0 0 1 0 0 1 1 0 0 1 0 "
      "0 0 1 1 0 1 1 1 1 0 1 1\nCELLS 2 14\n8 0 1 2 3 4 5 6 7\n4 0 1 2 3\nCELL_TYPES 2\n12\n9\n");
  EXPECT_EQ(test::read_error(folder / "h.vtk", Type::mesh),
            "h.vtk: holds 1 Quad (VTK cell type 9), 1 Hexahedron (VTK cell type 12); cells can be Vertex, Line, "
            "QuadraticEdge, Triangle, QuadraticTriangle, Tetra and QuadraticTetra");
}

TEST(MeshFiles, RegionsAreReadFromMsmlsMaterials) {
  const test::Folder folder("msml_materials");
  test::put_bytes(
      folder / "m.vtk",
      "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 float\n0 0 0 1 0 0 0 1 0 0 0 1 "
      "0 0 -1\nCELLS 2 10\n4 0 1 2 3\n4 0 2 1 4\nCELL_TYPES 2\n10\n10\nCELL_DATA 2\nSCALARS Materials int 1\n"
      "LOOKUP_TABLE default\n4\n9\n");
  EXPECT_THAT(std::get<MeshPtr>(test::all().read(folder / "m.vtk", Type::mesh))->regions, ElementsAre(4, 9));
}

TEST(MeshFiles, ANaNIsNeverWritten) {
  const test::Folder folder("msml_nan");
  Mesh mesh = every_kind();
  mesh.point_fields[0].values[7] = std::nan("");
  for (const char* const name : {"m.vtu", "m.vtk"}) {
    try {
      test::all().write(std::make_shared<const Mesh>(mesh), folder / name);
      ADD_FAILURE() << name << " was written";
    } catch (const Error& e) {
      EXPECT_THAT(e.what(), HasSubstr("point field 'displacement' is nan at point 2; only finite numbers are allowed"));
    }
    EXPECT_FALSE(std::filesystem::exists(folder / name));
  }
}

TEST(MeshFiles, ANaNIsNotRead) {
  const test::Folder folder("msml_nan_in");
  test::put_bytes(folder / "n.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 nan 0\n3 0 1 2\n");
  EXPECT_NE(test::read_error(folder / "n.off", Type::surface), "no error");
}

/// Every format, cut at many places, and with bytes overturned: a value or an Error, nothing else, and no text.
class DamagedMeshFile : public testing::TestWithParam<std::string> {};

TEST_P(DamagedMeshFile, IsAnErrorOrAValidMeshAndPrintsNothing) {
  const test::Folder folder("msml_damaged");
  const Registry registry = test::all();
  const auto good = folder / ("g" + GetParam()), bad = folder / ("b" + GetParam());
  const std::vector<std::string> meshes = registry.extensions_for(Type::mesh, true);
  if (std::find(meshes.begin(), meshes.end(), GetParam()) != meshes.end())
    registry.write(std::make_shared<const Mesh>(test::five_tets()), good);
  else
    registry.write(std::make_shared<const Surface>(test::box(Vec3::Zero(), Vec3::Ones())), good);
  const std::string bytes = test::bytes_of(good);
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  int errors = 0, cut = 0;
  for (std::size_t n = 0; n < bytes.size(); n += 1 + bytes.size() / 60, ++cut) {
    test::put_bytes(bad, bytes.substr(0, n));
    errors += test::read_error(bad, Type::mesh) != "no error";
  }
  for (std::size_t n = 0; n < bytes.size(); n += 1 + bytes.size() / 150) {
    std::string damaged = bytes;
    damaged[n] = static_cast<char>(damaged[n] ^ 0x15);
    test::put_bytes(bad, damaged);
    test::read_error(bad, Type::mesh);
  }
  // A sanitizer says when it refuses an absurd allocation; that is its own line, not ours.
  static const std::regex refused("==[0-9]+==WARNING: AddressSanitizer failed to allocate [^\n]*\n");
  const std::string printed = std::regex_replace(testing::internal::GetCapturedStderr(), refused, "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(printed, "");
  // A cut in trailing blanks goes unnoticed, and an OBJ file, which says no counts, may end behind any face.
  EXPECT_GE(errors, GetParam() == ".obj" ? cut / 3 : cut * 9 / 10);
}
INSTANTIATE_TEST_SUITE_P(All, DamagedMeshFile,
                         testing::Values(".vtk", ".vtu", ".vtp", ".stl", ".off", ".obj", ".ply", ".mesh", ".msh"));

TEST(MeshFiles, TheLiverOfMsmlHas297Tets) {
  const std::filesystem::path scenes = MSML_SOURCE_DIR "/../shared/scenes";
  if (!std::filesystem::exists(scenes)) GTEST_SKIP() << "the scenes of MSML are not there: " << scenes;
  EXPECT_EQ(std::get<MeshPtr>(test::all().read(scenes / "liver/LiverXSTet4.vtk", Type::mesh))->count(CellKind::tet4),
            297);
  EXPECT_EQ(std::get<MeshPtr>(test::all().read(scenes / "liver/LiverXSTet10.vtk", Type::mesh))->count(CellKind::tet10),
            297);
}

TEST(MeshFiles, TheBeamOfMsmlMixesTrianglesAndTets) {
  const std::filesystem::path scenes = MSML_SOURCE_DIR "/../shared/scenes";
  if (!std::filesystem::exists(scenes)) GTEST_SKIP() << "the scenes of MSML are not there: " << scenes;
  const auto path = scenes / "beam/Beam_Tet4WithSurface_NElement=1810.vtk";
  const MeshPtr mesh = std::get<MeshPtr>(test::all().read(path, Type::mesh));
  EXPECT_EQ(mesh->count(CellKind::tet4), 1810);
  EXPECT_EQ(mesh->count(CellKind::tri3) + 1810, mesh->cell_count());
}

}  // namespace
}  // namespace msml
