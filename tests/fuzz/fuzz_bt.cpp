// OctoMap files, .bt and .ot: what is accepted holds finite voxels on the grid of its resolution.
#include "expect.hpp"
#include "geometry/readers/octree_reader.hpp"
#include "mmgrasp/core/error.hpp"

using namespace mmgrasp;
using fuzzing::expect;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view content(reinterpret_cast<const char*>(data), size);
  std::vector<Voxels> sizes;
  try {
    sizes = detail::parse_octree("fuzz.bt", content);
  } catch (const IoError& refusal) {
    fuzzing::expect_names(refusal, "fuzz.bt");
    return 0;
  }
  expect(!sizes.empty(), "something is occupied");
  std::size_t cells = 0;
  for (const Voxels& voxels : sizes) {
    check_shape(voxels, "voxels");
    cells += voxels.centres->size();
    for (const Eigen::Vector3d& centre : *voxels.centres)
      expect(centre.cwiseAbs().maxCoeff() <= sizes.front().resolution * 32768, "voxels lie inside the tree");
  }
  expect(cells <= 4 * size, "at most eight voxels for two bytes");
  return 0;
}
