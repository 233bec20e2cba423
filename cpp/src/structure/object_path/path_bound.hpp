#pragma once

#include <optional>
#include <vector>

#include "mmgrasp/structure/object_path.hpp"
#include "mmgrasp/structure/pipe.hpp"
#include "mmgrasp/structure/pipe_grasps.hpp"
#include "structure/bound/ik_enclosure.hpp"
#include "structure/bound/sag_bound.hpp"

namespace mmgrasp::detail {

/// Grasps of one section and flip: middle +- half in distance along it [m] and in angle [rad].
struct GraspBox {
  int section = 0;
  bool flipped = false;
  double length = 0, half_length = 0, angle = 0, half_angle = 0;
};

/// All arm configurations along the path over a box of grasps, enclosed, with linear bounds from below on what it costs
/// to go from one to the next.
class MMGRASP_EXPORT BoxGraph {
 public:
  struct Bound {
    double cost = kInfinity;      ///< No grasp of the box costs less; infinite: none can follow the path.
    double estimate = kInfinity;  ///< About the cost of the grasp in the middle.
    std::vector<int> branches;    ///< Per pose: the configurations that the bound stems from.
  };
  Bound bound() const;
  const FormConfiguration& configuration(std::size_t pose, int branch) const { return layers_[pose].q[branch]; }
  bool alive(std::size_t pose, int branch) const { return layers_[pose].alive[branch] != 0; }
  /// Leaves out a configuration that no grasp of the box can have.
  void exclude(std::size_t pose, int branch) { layers_[pose].alive[branch] = 0; }

 private:
  friend class PathBound;
  /// Into this layer from the one before. The motion is at least direction . (to - from), or `least` where there is no
  /// direction.
  struct Edge {
    int from = 0, to = 0;
    Eigen::Matrix<double, 7, 1> direction = Eigen::Matrix<double, 7, 1>::Zero();
    double centre = 0;  ///< What the bound is in the middle, force included, errors left out.
    std::array<double, 2> slope{};
    double estimate = 0;
  };
  struct Layer {
    std::vector<FormConfiguration> q;
    std::vector<char> alive;
    std::vector<Edge> edges;
  };
  std::vector<Layer> layers_;
  LinearForm sag_;  ///< Weighted.
  double motion_ = 0;
};

/// Bounds Cost(O) of all grasps in a box from below: arm, limits and jumps count, its collisions do not.
class MMGRASP_EXPORT PathBound {
 public:
  /// Throws InvalidInput for arms that IkEnclosure does not take.
  PathBound(const ObjectPathProblem& problem, const Pipe& pipe, const ObjectPathOptions& options,
            const PipeGraspOptions& grasp);

  BoxGraph graph(const GraspBox& box) const;

 private:
  FormPose hand(const GraspBox& box, std::size_t pose) const;
  bool join(const FormConfiguration& from, const FormConfiguration& to, BoxGraph::Edge& edge) const;
  LinearForm force(const FormConfiguration& q, const FormPose& before, const FormPose& at, std::size_t pose) const;

  Poses T_world_object_;
  std::vector<Eigen::Vector3d> turns_;  ///< Rotation vector from the pose before [rad].
  Pipe pipe_;
  ObjectPathOptions options_;
  PipeGraspOptions grasp_;
  std::vector<bool> wraps_;
  IkEnclosure arm_;
  std::optional<SagBound> sag_;
};

}  // namespace mmgrasp::detail
