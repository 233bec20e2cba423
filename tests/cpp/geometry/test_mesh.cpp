#include "mmgrasp/geometry/mesh.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/geometry/shape.hpp"
#include "support/robot_support.hpp"

using namespace mmgrasp;
namespace fs = std::filesystem;
using testing_support::shared;

namespace {

class TempFile {
 public:
  TempFile(const std::string& name, const std::string& content)
      : path_((fs::temp_directory_path() / (std::to_string(::getpid()) + "_" + name)).string()) {
    std::ofstream(path_, std::ios::binary) << content;
  }
  ~TempFile() { fs::remove(path_); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

std::string message_of(const std::string& path) {
  try {
    load_mesh(path);
  } catch (const IoError& error) {
    return error.what();
  }
  return "";
}

void expect_refused(const std::string& name, const std::string& content, const std::string& reason) {
  const TempFile file(name, content);
  const std::string message = message_of(file.path());
  EXPECT_NE(message.find(file.path()), std::string::npos) << name << ": " << message;
  EXPECT_NE(message.find(reason), std::string::npos) << name << ": " << message;
}

std::string binary_stl(const TriangleMesh& mesh) {
  std::string out(80, ' ');
  const auto put = [&](const auto& value) { out.append(reinterpret_cast<const char*>(&value), sizeof value); };
  put(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) put(0.0f);
    for (const int corner : t) {
      for (int k = 0; k < 3; ++k) put(static_cast<float>(mesh.vertices[corner][k]));
    }
    put(std::uint16_t{0});
  }
  return out;
}

std::string ascii_stl(const TriangleMesh& mesh) {
  std::ostringstream out;
  out << "solid part\n";
  for (const auto& t : mesh.triangles) {
    out << "facet normal 0 0 0\n outer loop\n";
    for (const int corner : t) out << "  vertex " << mesh.vertices[corner].transpose() << "\n";
    out << " endloop\nendfacet\n";
  }
  out << "endsolid part\n";
  return out.str();
}

std::string obj(const TriangleMesh& mesh) {
  std::ostringstream out;
  for (const auto& v : mesh.vertices) out << "v " << v.transpose() << "\n";
  for (const auto& t : mesh.triangles) out << "f " << t[0] + 1 << "/1/1 " << t[1] + 1 << " " << t[2] + 1 << "\n";
  return out.str();
}

std::string ply(const TriangleMesh& mesh, const std::string& format) {
  std::ostringstream out;
  out << "ply\nformat " << format << " 1.0\ncomment made here\nelement vertex " << mesh.vertices.size()
      << "\nproperty double x\nproperty double y\nproperty double z\nelement face " << mesh.triangles.size()
      << "\nproperty list uchar int vertex_indices\nend_header\n";
  const bool swap = format == "binary_big_endian";
  const auto put = [&](const auto& value) {
    std::string bytes(reinterpret_cast<const char*>(&value), sizeof value);
    if (swap) std::reverse(bytes.begin(), bytes.end());
    out << bytes;
  };
  for (const auto& v : mesh.vertices) {
    if (format == "ascii")
      out << v.transpose() << "\n";
    else
      for (int k = 0; k < 3; ++k) put(v[k]);
  }
  for (const auto& t : mesh.triangles) {
    if (format == "ascii") {
      out << "3 " << t[0] << " " << t[1] << " " << t[2] << "\n";
    } else {
      put(std::uint8_t{3});
      for (const int corner : t) put(static_cast<std::int32_t>(corner));
    }
  }
  return out.str();
}

std::string dae(const std::string& unit, const std::string& up_axis, const std::string& node_transform) {
  return "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
         "version=\"1.4.1\"><asset>" +
         unit + "<up_axis>" + up_axis +
         "</up_axis></asset><library_geometries><geometry id=\"g\"><mesh><source id=\"p\"><float_array id=\"a\" "
         "count=\"12\">"
         "0 0 0 1 0 0 0 2 0 0 0 3</float_array><technique_common><accessor source=\"#a\" count=\"4\" "
         "stride=\"3\"><param name=\"X\" "
         "type=\"float\"/><param name=\"Y\" type=\"float\"/><param name=\"Z\" "
         "type=\"float\"/></accessor></technique_common></source>"
         "<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices><triangles count=\"4\"><input "
         "semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>0 2 1 0 1 3 1 2 3 0 3 2</p></triangles></mesh></geometry>"
         "</library_geometries><library_visual_scenes><visual_scene id=\"s\"><node id=\"n\">" +
         node_transform +
         "<instance_geometry url=\"#g\"/></node></visual_scene></library_visual_scenes><scene><instance_visual_scene "
         "url=\"#s\"/></scene></COLLADA>";
}

Eigen::AlignedBox3d bounds(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const auto& v : mesh.vertices) box.extend(v);
  return box;
}

std::shared_ptr<const TriangleMesh> shells(const std::vector<std::pair<Box, bool>>& boxes) {
  std::vector<Eigen::Vector3d> v;
  std::vector<std::array<int, 3>> t;
  for (const auto& [box, inwards] : boxes) {
    const auto mesh = shape_mesh(box);
    const int first = static_cast<int>(v.size());
    v.insert(v.end(), mesh->vertices.begin(), mesh->vertices.end());
    for (auto triangle : mesh->triangles) {
      for (int& corner : triangle) corner += first;
      if (inwards) std::swap(triangle[0], triangle[1]);
      t.push_back(triangle);
    }
  }
  return make_mesh(v, t);
}

std::string with_returns(const std::string& text) {
  std::string lines;
  for (const char c : text) lines += c == '\n' ? "\r\n" : std::string(1, c);
  return lines;
}

}  // namespace

TEST(Mesh, EveryFormatGivesTheSameSolid) {
  const auto box = shape_mesh(Box{{0.5, 0.25, 1}});  // exact in single precision
  const std::pair<std::string, std::string> files[] = {{"a.stl", binary_stl(*box)},
                                                       {"b.stl", ascii_stl(*box)},
                                                       {"c.obj", obj(*box)},
                                                       {"d.ply", ply(*box, "ascii")},
                                                       {"e.ply", ply(*box, "binary_little_endian")},
                                                       {"f.ply", ply(*box, "binary_big_endian")},
                                                       {"g.ply", with_returns(ply(*box, "ascii"))}};
  for (const auto& [name, content] : files) {
    const TempFile file(name, content);
    MeshReport report;
    const auto mesh = load_mesh(file.path(), Eigen::Vector3d(2, 1, 1), &report);
    EXPECT_EQ(mesh->vertices.size(), 8u) << name;
    EXPECT_EQ(report.triangles, 12) << name;
    EXPECT_TRUE(mesh->closed && mesh->convex) << name;
    EXPECT_NEAR(mesh_volume(*mesh), 0.25, 1e-12) << name;
    EXPECT_TRUE(bounds(*mesh).sizes().isApprox(Eigen::Vector3d(1, 0.25, 1))) << name;
    EXPECT_EQ(mesh->source, file.path());
  }
}

TEST(Mesh, MirroringKeepsTheOutside) {
  const TempFile file("m.stl", binary_stl(*shape_mesh(Box{{0.5, 0.25, 1}})));
  EXPECT_NEAR(mesh_volume(*load_mesh(file.path(), Eigen::Vector3d(-1, 1, 1))), 0.125, 1e-12);
  EXPECT_THROW(load_mesh(file.path(), Eigen::Vector3d(0, 1, 1)), InvalidInput);
  EXPECT_THROW(load_mesh(file.path(), Eigen::Vector3d(1, std::nan(""), 1)), InvalidInput);
}

TEST(Mesh, DaeUnitAndNodesCountButNotTheUpAxis) {
  const auto size = [](const std::string& content) {
    const TempFile file("t.dae", content);
    return bounds(*load_mesh(file.path())).max().eval();
  };
  EXPECT_TRUE(size(dae("", "Z_UP", "")).isApprox(Eigen::Vector3d(1, 2, 3)));
  EXPECT_TRUE(size(dae("", "Y_UP", "")).isApprox(Eigen::Vector3d(1, 2, 3)));
  EXPECT_TRUE(size(dae("<unit name=\"centimeter\" meter=\"0.01\"/>", "Y_UP", ""))
                  .isApprox(Eigen::Vector3d(0.01, 0.02, 0.03), 1e-6));
  EXPECT_TRUE(size(dae("", "Z_UP", "<matrix>0 0 1 10 1 0 0 20 0 1 0 30 0 0 0 1</matrix>"))
                  .isApprox(Eigen::Vector3d(13, 21, 32)));
}

TEST(Mesh, TruncatedFilesAreRefusedAtEveryLength) {
  const auto box = shape_mesh(Box{{0.5, 0.25, 1}});
  const std::string binary = binary_stl(*box), ascii = ascii_stl(*box), big = ply(*box, "binary_big_endian");
  for (std::size_t length = 1; length < binary.size(); length += 13)
    expect_refused("t.stl", binary.substr(0, length), "truncated");
  for (std::size_t length = 20; length < ascii.size() - 15; length += 37) {
    const TempFile file("t.stl", ascii.substr(0, length));
    EXPECT_NE(message_of(file.path()).find(file.path()), std::string::npos) << length;
  }
  for (std::size_t length = 10; length < big.size(); length += 13) {
    const TempFile file("t.ply", big.substr(0, length));
    EXPECT_NE(message_of(file.path()).find(file.path()), std::string::npos) << length;
  }
  const std::string collada = dae("", "Z_UP", "");
  for (std::size_t length = 10; length < collada.size() - 1; length += 53) {
    const TempFile file("t.dae", collada.substr(0, length));
    EXPECT_NE(message_of(file.path()).find(file.path()), std::string::npos) << length;
  }
}

TEST(Mesh, GarbageIsRefusedWithAReason) {
  expect_refused("g.stl", std::string(200, '\xff'), "truncated, or no STL");
  expect_refused("empty.stl", "", "is empty");
  expect_refused("zero.stl", std::string(84, '\0'), "holds no triangle");
  expect_refused("g.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nhello\n", "line 4");
  expect_refused("i.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 7\n", "names vertex 7 of 3");
  expect_refused("n.obj", "v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n", "vertex 2 is not finite");
  expect_refused("w.obj", "v 0 0 x\n", "'x' is no number");
  expect_refused("d.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\nf 1 1 2\n", "no triangle with an area");
  expect_refused("h.ply", "ply\nformat ascii 1.0\nelement vertex x\n", "has no count");
  expect_refused("j.ply", "ply\nformat ascii 1.0\nelement face 12\nproperty list uchar int vertex_indices end_header\n",
                 "line 4: 'end_header' is more than the line may say");
  expect_refused("k.ply", "ply format ascii 1.0\n", "line 1: 'format' is more");
  expect_refused("l.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float\nx\n",
                 "line 4: a property has no name");
  expect_refused("m.ply", "ply\nformat ascii 1.0\ncomment a\felement vertex 1\n", "line 3: a control character");
  expect_refused("o.ply", "ply\nformat ascii 1.0\nelement 99999999face 12\n",
                 "line 3: element '99999999face' must begin");
  const std::string strips = ply(*shape_mesh(Box{{1, 1, 1}}), "ascii");
  expect_refused("p.ply", std::string(strips).replace(strips.find("element face"), 12, "element tristrips"),
                 "no triangle");
  expect_refused("g.dae", "<COLLADA>", "DAE");
  expect_refused("a.step", "ISO-10303-21;", "extension '.step'");
  std::string nan = binary_stl(*shape_mesh(Box{{1, 1, 1}}));
  const float bad = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(&nan[84 + 12], &bad, 4);
  expect_refused("n.stl", nan, "not finite");
  EXPECT_NE(message_of("/nowhere/part.stl").find("'/nowhere/part.stl': does not exist"), std::string::npos);
}

TEST(Mesh, CleaningMergesDropsAndOrients) {
  auto box = *shape_mesh(Box{{1, 2, 3}});
  std::vector<Eigen::Vector3d> v;
  std::vector<std::array<int, 3>> t;
  Rng rng(2);
  for (const auto& triangle : box.triangles) {  // every corner its own vertex, every second triangle turned over
    for (const int corner : triangle) v.push_back(box.vertices[corner]);
    const int n = static_cast<int>(v.size());
    t.push_back(rng.uniform() < 0.5 ? std::array<int, 3>{n - 3, n - 2, n - 1}
                                    : std::array<int, 3>{n - 2, n - 3, n - 1});
  }
  v.push_back({9, 9, 9});  // used by nobody
  t.push_back({0, 0, 1});  // two equal corners
  MeshReport report;
  const auto mesh = make_mesh(v, t, "", &report);
  EXPECT_EQ(mesh->vertices.size(), 8u);
  EXPECT_EQ(report.vertices_read, 37);
  EXPECT_EQ(report.vertices_merged, 28);
  EXPECT_EQ(report.degenerate_triangles, 1);
  EXPECT_TRUE(mesh->closed && mesh->convex);
  EXPECT_NEAR(mesh_volume(*mesh), 6, 1e-12);

  box.triangles.pop_back();
  EXPECT_FALSE(make_mesh(box.vertices, box.triangles)->closed);
  EXPECT_THROW(make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 3}}), InvalidInput);
  EXPECT_THROW(make_mesh({{0, 0, 0}, {1, 0, 0}, {0, std::nan(""), 0}}, {{0, 1, 2}}), InvalidInput);
}

TEST(Mesh, TrianglesStoredTwiceLeaveASolidSolid) {
  const std::shared_ptr<const TriangleMesh> solids[] = {shape_mesh(Box{{1, 2, 3}}), shape_mesh(Sphere{0.5}, 24)};
  Rng rng(3);
  for (const auto& solid : solids) {
    for (const double share : {0.01, 0.3, 1.0}) {
      for (const bool turned : {false, true}) {
        auto triangles = solid->triangles;
        for (const auto& t : solid->triangles) {
          if (rng.uniform() > share && triangles.size() > solid->triangles.size()) continue;  // one repeat at least
          triangles.push_back(turned ? std::array<int, 3>{t[1], t[0], t[2]} : std::array<int, 3>{t[1], t[2], t[0]});
        }
        const auto mesh = make_mesh(solid->vertices, triangles);
        EXPECT_TRUE(mesh->closed && mesh->convex) << share << turned;
        EXPECT_EQ(mesh->triangles.size(), solid->triangles.size());
        EXPECT_NEAR(mesh_volume(*mesh), mesh_volume(*solid), 1e-12);
        EXPECT_TRUE(mesh_contains(*mesh, {0.1, 0.05, 0.02}));

        triangles.erase(triangles.begin());  // its repeat stays
        const auto less = make_mesh(solid->vertices, triangles);
        EXPECT_TRUE(less->closed);
      }
    }
  }
}

TEST(Mesh, FacesThatSolidsShareAreNoRepeats) {
  // Two boxes side by side: the face between them is there twice, turned against itself.
  const auto box = shape_mesh(Box{{1, 2, 3}});
  auto vertices = box->vertices;
  auto triangles = box->triangles;
  for (const Eigen::Vector3d& v : box->vertices) vertices.push_back(Eigen::Vector3d(-v.x() + 1, v.y(), v.z()));
  for (const auto& t : box->triangles) triangles.push_back({t[1] + 8, t[0] + 8, t[2] + 8});
  const auto both = make_mesh(vertices, triangles);
  EXPECT_TRUE(both->closed);
  EXPECT_NEAR(mesh_volume(*both), 12, 1e-12);
  EXPECT_TRUE(mesh_contains(*both, {0.1, 0.05, 0.02}) && mesh_contains(*both, {0.9, 0.05, 0.02}));

  // A sheet that is stored from both sides stays one.
  const auto sheet =
      make_mesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}, {0, 2, 1}, {0, 3, 2}});
  EXPECT_FALSE(sheet->closed);
}

TEST(Mesh, CavitiesAndSeparateSolids) {
  const auto hollow = shells({{Box{{2, 2, 2}}, false}, {Box{{1, 1, 1}}, true}});
  EXPECT_TRUE(hollow->closed);
  EXPECT_FALSE(hollow->convex);
  EXPECT_NEAR(mesh_volume(*hollow), 7, 1e-12);
  EXPECT_FALSE(mesh_contains(*hollow, {0.1, 0.2, 0.3}));
  EXPECT_TRUE(mesh_contains(*hollow, {0.1, 0.2, 0.7}));
  // The same file written inside out.
  const auto reversed = shells({{Box{{2, 2, 2}}, true}, {Box{{1, 1, 1}}, false}});
  EXPECT_NEAR(mesh_volume(*reversed), 7, 1e-12);
  // A point in two overlapping solids is inside, not outside.
  const auto crossed = shells({{Box{{2, 1, 1}}, false}, {Box{{1, 2, 1}}, false}});
  EXPECT_TRUE(mesh_contains(*crossed, {0.1, 0.2, 0.3}));
  EXPECT_FALSE(mesh_contains(*crossed, {0.8, 0.8, 0.3}));
}

TEST(Mesh, ContainmentAgreesWithClosedForms) {
  Rng rng(4);
  const auto box = shape_mesh(Box{{1, 2, 3}});
  const auto ball = shape_mesh(Sphere{1}, 96);
  std::vector<Eigen::Vector3d> tetra_points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const auto tetra = convex_hull(tetra_points);
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector3d p(rng.uniform(-2, 2), rng.uniform(-2, 2), rng.uniform(-2, 2));
    EXPECT_EQ(mesh_contains(*box, p), std::abs(p.x()) < 0.5 && std::abs(p.y()) < 1 && std::abs(p.z()) < 1.5);
    EXPECT_EQ(mesh_contains(*tetra, p), p.minCoeff() > 0 && p.sum() < 1);
    if (p.norm() < 0.995 || p.norm() > 1) {
      EXPECT_EQ(mesh_contains(*ball, p), p.norm() < 1);
    }
  }
  // Rays through vertices and along edges: points right below a corner in the ray's direction.
  for (const Eigen::Vector3d& corner : box->vertices) {
    const Eigen::Vector3d d(0.21132486540518713, 0.35682208977308993, 1.0);
    const Eigen::Vector3d p = corner - 0.25 * d, q = corner - 9 * d;
    EXPECT_EQ(mesh_contains(*box, p), std::abs(p.x()) < 0.5 && std::abs(p.y()) < 1 && std::abs(p.z()) < 1.5);
    EXPECT_FALSE(mesh_contains(*box, q));
  }
}

TEST(ConvexHull, KnownVolumes) {
  EXPECT_NEAR(mesh_volume(*convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}})), 1.0 / 6, 1e-15);
  std::vector<Eigen::Vector3d> grid;  // a box full of points, most of them on faces, edges or inside
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      for (int k = 0; k < 6; ++k) grid.emplace_back(0.2 * i, 0.4 * j, 0.6 * k);
  const auto box = convex_hull(grid);
  EXPECT_NEAR(mesh_volume(*box), 6, 1e-9);
  EXPECT_TRUE(box->closed && box->convex);
  const int n = 64;
  const auto cylinder = convex_hull(shape_mesh(Cylinder{0.5, 2}, n)->vertices);
  EXPECT_NEAR(mesh_volume(*cylinder), 2 * 0.5 * n * 0.25 * std::sin(2 * M_PI / n), 1e-9);
}

TEST(ConvexHull, HoldsRandomPointsAndNothingMore) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Rng rng(seed);
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < 300; ++i) {
      Eigen::Vector3d p(rng.normal(), rng.normal(), 1e-3 * rng.normal());
      if (seed % 2 == 0) p.normalize();
      points.push_back(p);
    }
    const auto hull = convex_hull(points);
    ASSERT_TRUE(hull->closed);
    // Euler: a closed surface of genus 0 has F = 2 V - 4.
    EXPECT_EQ(hull->triangles.size(), 2 * hull->vertices.size() - 4);
    for (const auto& t : hull->triangles) {
      const Eigen::Vector3d a = hull->vertices[t[0]];
      const Eigen::Vector3d n = (hull->vertices[t[1]] - a).cross(hull->vertices[t[2]] - a).normalized();
      for (const auto& p : points) ASSERT_LT(n.dot(p - a), 1e-9);
    }
  }
}

TEST(ConvexHull, FlatInputIsRefused) {
  EXPECT_THROW(convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), InvalidInput);
  EXPECT_THROW(convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0.3, 0.2, 0}}), InvalidInput);
  EXPECT_THROW(convex_hull({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}), InvalidInput);
}

TEST(MeshData, EveryMeshLoadsOrIsRefusedByName) {
  MMGRASP_NEEDS_SHARED_DATA();
  int loaded = 0;
  for (const auto& entry : fs::recursive_directory_iterator(shared("meshes"))) {
    std::string extension = entry.path().extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(c));
    if (std::set<std::string>{".stl", ".obj", ".ply", ".dae", ".3mf", ".step"}.count(extension) == 0) continue;
    try {
      const auto mesh = load_mesh(entry.path().string());
      ++loaded;
      EXPECT_FALSE(mesh->triangles.empty());
      if (mesh->closed) {
        EXPECT_GT(mesh_volume(*mesh), 0) << entry.path();
      }
    } catch (const IoError& error) {
      EXPECT_NE(std::string(error.what()).find(entry.path().string()), std::string::npos) << error.what();
      EXPECT_TRUE(extension == ".3mf" || extension == ".step") << error.what();
    }
  }
  EXPECT_GT(loaded, 70);
}

TEST(MeshData, TheSameSolidInTwoFormats) {
  MMGRASP_NEEDS_SHARED_DATA();
  const double obj = mesh_volume(*load_mesh(shared("meshes/trimesh/fuze.obj")));
  EXPECT_NEAR(mesh_volume(*load_mesh(shared("meshes/trimesh/fuze.ply"))), obj, 1e-9);
  EXPECT_NEAR(mesh_volume(*load_mesh(shared("meshes/trimesh/fuze_ascii.ply"))), obj, 1e-9);
}

TEST(MeshData, TiagoCollisionMeshesMatchTheirVisualOnes) {
  MMGRASP_NEEDS_SHARED_DATA();
  const std::string folder = shared("robots/tiago/example-robot-data/robots/tiago_description/meshes/");
  // Collision DAE (Y_UP, no unit) and visual STL of the same part fill the same box within a few millimetres.
  const std::pair<const char*, const char*> pairs[] = {
      {"arm/arm_1_collision.dae", "arm/arm_1.stl"},     {"arm/arm_2_collision.dae", "arm/arm_2.stl"},
      {"arm/arm_3_collision.dae", "arm/arm_3.stl"},     {"arm/arm_4_collision.dae", "arm/arm_4.stl"},
      {"arm/arm_5_collision.dae", "arm/arm_5.stl"},     {"arm/arm_6_collision.dae", "arm/arm_6.stl"},
      {"head/head_1_collision.dae", "head/head_1.stl"}, {"head/head_2_collision.dae", "head/head_2.stl"}};
  for (const auto& [collision, visual] : pairs) {
    const Eigen::AlignedBox3d a = bounds(*load_mesh(folder + collision)), b = bounds(*load_mesh(folder + visual));
    EXPECT_LT((a.min() - b.min()).cwiseAbs().maxCoeff(), 0.006) << collision;
    EXPECT_LT((a.max() - b.max()).cwiseAbs().maxCoeff(), 0.006) << collision;
  }
}
