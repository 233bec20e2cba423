#pragma once

#include <Eigen/Core>
#include <array>
#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "mmgrasp/core/outcome.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/reach/reach_database.hpp"
#include "mmgrasp/robot/ik.hpp"
#include "mmgrasp/robot/ik_branches.hpp"
#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp::detail {

/// Arm configurations at the nodes of a grid of tool poses, found on first use: seeds for WarmStartedIk, which
/// needs a step or two from a node to any pose in the node's cell. What a node holds depends on the node alone, never
/// on the query that came first, so that answers made from it depend on the pose alone. Arms of six joints with a
/// closed form get all branches, others what the database leads to. Thread-safe.
class IkSeedGrid {
 public:
  static constexpr double kEdge = 0.05;  ///< Edge of a cell [m].

  class Node {
   public:
    /// Configuration `k`, or nullptr when there are fewer. They are searched one by one, as far as they are needed.
    const double* solution(int k, const IkSeedGrid& grid, const Pose& T_base_node);
    /// Why a node has no configurations.
    Rejection cause() const { return cause_; }
    std::atomic<int> last_good{0};  ///< The configuration that was of use last: saves time, decides nothing.

   private:
    void start(const IkSeedGrid& grid, const Pose& T_base_node);
    bool search(const IkSeedGrid& grid, const Pose& T_base_node);

    std::mutex mutex_;
    std::atomic<int> found_{0};
    std::atomic<bool> exhausted_{false};
    bool started_ = false;
    int next_ = 0, seeds_count_ = 0, fruitless_ = 0;
    Eigen::MatrixXd configurations_;  ///< Found ones first; seeds not yet used from `next_` on.
    Rejection cause_ = Rejection::unreachable;
  };

  /// The nodes of one orientation of the tool and one height above the root.
  class Slice {
   public:
    Slice(const IkSeedGrid& grid, const Eigen::Matrix3d& R, double z);
    ~Slice();
    Slice(const Slice&) = delete;
    Slice& operator=(const Slice&) = delete;
    /// The node of the cell that holds a position, nullptr where the tool never gets. `cell`: its column and row.
    Node* find(double x, double y, std::array<int, 2>& cell);
    Node* at(int ix, int iy);
    Pose pose(int ix, int iy) const;
    /// Squared distance from a position to a node [m^2].
    double squared_distance(int ix, int iy, double x, double y) const;

   private:
    Eigen::Matrix3d R_;
    double z_;
    int x0_ = 0, y0_ = 0, nx_ = 0, ny_ = 0;
    std::unique_ptr<std::atomic<Node*>[]> nodes_;
  };

  /// `arm` with its root in the origin; without a closed form up to `seeds` stored configurations are followed for each
  /// node. Keeps copies.
  IkSeedGrid(const JointGroup& arm, const ReachDatabase& database, int seeds);
  /// True when branches() gives every configuration of a pose.
  bool closed_form() const { return closed_form_; }
  /// All configurations of a pose itself, with closed_form() only.
  IkBranches branches(const Pose& T_base_hand) const;
  /// The slice for a tool orientation and height in the root frame. It lives as long as the grid.
  Slice& slice(const Eigen::Matrix3d& R, double z) const;

 private:
  friend class Node;
  using Key = std::array<int, 7>;

  JointGroup arm_;
  ReachDatabase database_;
  int seeds_;
  double far_;  ///< Distance beyond which no stored configuration counts [cells of the database].
  bool closed_form_;
  IkOptions ik_;
  mutable std::mutex mutex_;
  mutable std::map<Key, std::unique_ptr<Slice>> slices_;
};

}  // namespace mmgrasp::detail
