#pragma once

#include "mmgrasp/core/detail/instruction_set.hpp"
#include "mmgrasp/core/export.hpp"

/// The arithmetic of kinematics on plain arrays, compiled once for every instruction set. No Eigen type passes through
/// here: wider registers would change the alignment that Eigen's types were given elsewhere.
namespace mmgrasp::detail {

constexpr int kMaxColumns = 64;    ///< Most columns of a group: Jacobians live on the stack.
constexpr int kMaxSegments = 128;  ///< Moving joints on the way from the root to a tip; lets scratch live on the stack.
constexpr int kMaxRevolute = 1024;  ///< Revolute joints a group moves anywhere in the robot.
constexpr int kMaxSpherical = 16;   ///< Floating joints on the way to a tip.
constexpr int kAngleBlock = 8;      ///< Tables of angles are padded to a multiple of this.

/// Angles that depend on the configuration: multiplier * q[column] + offset.
struct AngleTable {
  int count = 0;  ///< Entries that mean something; the rest of the last block is harmless.
  const int* column = nullptr;
  const double* multiplier = nullptr;
  const double* offset = nullptr;
};

enum class Motion { revolute, prismatic, spherical };

/// One elementary motion on the way to the tip. Any rotation is Rz(a) Rx(b) Rz(c): the rotations about z on either
/// side are folded into the angles of the motions before and after, so that only the one about x is left between two of
/// them.
/// A fixed transform, then a motion about or along the z of the frame it leads to.
struct Segment {
  double p[3] = {0, 0, 0};            ///< From the frame before, in that frame, before the rotation about x.
  double tilt_cos = 1, tilt_sin = 0;  ///< Cosine and sine of the rotation about x.
  double multiplier = 1, offset = 0;  ///< Prismatic: value = multiplier * q[column] + offset. Revolute: see AngleTable.
  int column = 0;
  int spherical = 0;  ///< Which of the motions that the caller worked out.
  Motion motion = Motion::revolute;
  bool adds = false;  ///< An earlier segment has written this column of the Jacobian.
};

/// Rotation that the caller works out from a rotation vector. Columns of three.
struct SphericalMotion {
  double R[9];     ///< Rotation, seen from the frame before it.
  double axes[9];  ///< Its left Jacobian: angular velocity per rate of each value.
};

struct Chain {
  int segments = 0;
  const Segment* segment = nullptr;
  AngleTable angles;  ///< One entry for each segment (a constant one for prismatic and spherical ones), then the base's
                      ///< heading.
  bool base = false;  ///< Columns 0 to 2 are x, y, theta of the root.
  int columns = 0;
  int still_columns = 0;  ///< Columns that do not move the tip.
  const int* still_column = nullptr;
  double R_tip[9], p_tip[3];  ///< Behind the last motion; columns of three.
};

/// Where the root stands: rotation (columns of three) and position. Ignored by chains with a base.
struct RootPose {
  double R[9], p[3];
};

/// How a frame stands in its parent: R = A + sin B + cos C for a revolute motion, A times the rotation by a rotation
/// vector for a spherical one, A for the others.
struct FrameStep {
  enum class Kind { fixed, revolute, prismatic, spherical };
  Kind kind = Kind::fixed;
  int frame = 0, parent = 0;
  int angle = 0;                      ///< Revolute: entry of the table of angles.
  int column = 0;                     ///< Prismatic, and the first of three columns of a spherical motion.
  double multiplier = 1, offset = 0;  ///< Prismatic.
  double A[12], B[12], C[12];         ///< Columns of four, the last entry 0.
  double p[4], d[4];                  ///< Position and what a prismatic motion adds per metre.
};

struct KinematicsKernels {
  int lanes;  ///< Configurations that `batch` takes at a time.
  /// `T` receives a 4 x 4 pose, `J` (may be null) 6 x columns with `stride` between columns.
  void (*single)(const Chain&, const RootPose&, const double* q, const SphericalMotion*, double* T, double* J,
                 long stride);
  /// `blocks` times `lanes` configurations; chains without spherical motions. J (may be null): 6 x columns each, next
  /// to each other.
  void (*batch)(const Chain&, const RootPose&, const double* q, long stride, long blocks, double* T, double* J);
  /// Places frames in this order; parents stand already. `T` holds 4 x 4 poses by frame number.
  void (*frames)(const FrameStep* steps, int count, const AngleTable&, const double* q, double* T);
};

/// The fastest that this machine can run, unless use_instruction_set() chose another.
MMGRASP_EXPORT const KinematicsKernels& kinematics_kernels();

extern const KinematicsKernels kPortableKinematics;
#ifdef MMGRASP_X86_KERNELS
extern const KinematicsKernels kAvx2Kinematics;
extern const KinematicsKernels kAvx512Kinematics;
#endif

/// For tables with angles beyond what the vector polynomials reduce exactly, or infinite ones.
void any_sines(const AngleTable&, const double* q, double* sines, double* cosines);
/// The rotation by a rotation vector, columns of four.
void rotation_columns(const double* rotation_vector, double* R);

}  // namespace mmgrasp::detail
