#pragma once

// What the traversal of a triangle tree by a ray exchanges with its callers: plain arrays only, because the functions
// are compiled once for each instruction set.

#include <cstddef>

namespace mmgrasp::detail {

constexpr int kTreeWidth = 8;                                 // children of a node
constexpr int kPacketWidth = 4;                               // triangles of a leaf
constexpr int kMaxDepth = 72;                                 // levels of the deepest tree that the builder makes
constexpr int kStackSize = kMaxDepth * (kTreeWidth - 1) + 1;  // for those who push all children of a node

/// Eight children with their boxes, in the tree's own coordinates: the mesh fills [-1, 1] along its longest side, and
/// every box is larger than what it holds by more than the rounding of single precision.
struct alignas(64) TreeNode {
  float bounds[6][kTreeWidth];  // lower x, y, z, upper x, y, z; lower > upper where there is no child
  int child[kTreeWidth];        // a node, or ~packet
};

/// Up to four triangles in the mesh's coordinates. Places left over hold triangles without an area.
struct alignas(64) TrianglePacket {
  double corner[3][3][kPacketWidth];  // [corner][axis][triangle]
  int triangle[kPacketWidth];         // index in the mesh, -1 where there is none
};

struct TreeView {
  const TreeNode* nodes;
  const TrianglePacket* packets;
};

/// Where the tree lies in the mesh's coordinates.
struct TreePlace {
  double lower[3], upper[3];  // box around the mesh, a little larger
  double centre[3], scale;    // the tree's coordinates: (p - centre) * scale
};

/// A ray cut to the tree's box, ready for the traversal.
/// Arrays of four hold numbers along x, y, z; the fourth only fills the lane.
struct alignas(32) PreparedRay {
  double origin[4];
  long long near[4], far[4];    // places in TreeNode::bounds of the faces through which the ray enters and leaves
  float inverse[4], offset[4];  // for boxes: 1 / direction, -start / direction
  double nearest, farthest;
  double shear[3];  // direction[axis[0 or 1]] / direction[axis[2]], 1 / direction[axis[2]]
  int axis[3];      // the last is the one along which the ray is longest; the others so that front faces stay front
  // Lengths for boxes are in the tree's coordinates, from where the ray enters the tree's box.
  float start, length;      // how far boxes are worth a visit
  double begin, to_length;  // length = (t - begin) * to_length
};

struct RayRecord {
  double t = 0;  // in: the farthest allowed
  int triangle = -1, packet = -1, lane = -1;
};

struct RayKernels {
  const char* name;
  /// False: the ray, as far as it is to be followed, misses the tree's box.
  bool (*prepare)(const TreePlace& place, const double* origin, const double* direction, double nearest,
                  double farthest, PreparedRay& ray);
  void (*closest)(const TreeView& tree, const PreparedRay& ray, RayRecord& best);
  bool (*any)(const TreeView& tree, const PreparedRay& ray);
  /// Calls visit(data, packet) for each leaf whose box the ray meets.
  void (*leaves)(const TreeView& tree, const PreparedRay& ray, void (*visit)(void* data, int packet), void* data);
  /// The nearest triangle of each ray; packet -1: it meets none. Quicker than one by one, with the same answers.
  void (*closest_many)(const TreeView& tree, const PreparedRay* rays, int count, RayRecord* records);
  /// Some packet with a triangle that the ray meets, or -1.
  void (*any_many)(const TreeView& tree, const PreparedRay* rays, int count, RayRecord* records);
};

/// Those of instruction_set(). Every set gives the same answers.
const RayKernels& ray_kernels();

}  // namespace mmgrasp::detail
