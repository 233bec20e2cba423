#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <nanoflann.hpp>
#include <utility>
#include <vector>

#include "mmgrasp/plan/roadmap.hpp"

namespace mmgrasp {

namespace detail {

/// A monitor that is stopped as soon as `over` says so, which is asked now and then.
class Until {
 public:
  Until() : over_(kNever) {}  ///< Never stopped.
  Until(const Monitor& monitor, const std::function<bool()>& over) : over_(over) { own_.progress = monitor.progress; }
  const Monitor& monitor() const { return own_; }
  /// To be called with every step, by any thread. Whether it is stopped.
  bool breathe() {
    if (steps_++ % kSteps == 0 && over_()) own_.stop.stop();
    return own_.stopped();
  }

 private:
  static constexpr std::size_t kSteps = 64;
  inline static const std::function<bool()> kNever = [] { return false; };
  const std::function<bool()>& over_;
  Monitor own_;
  std::atomic<std::size_t> steps_{0};
};

/// Columns of a matrix as nanoflann wants them. Coordinates are read one by one only while the search tree is made,
/// which has no other place where it could be stopped.
struct ColumnCloud {
  struct Stopped {};
  const Eigen::MatrixXd& columns;
  Until* until = nullptr;  ///< While the tree is made: throws Stopped.
  mutable std::size_t reads = 0;

  std::size_t kdtree_get_point_count() const { return static_cast<std::size_t>(columns.cols()); }
  double kdtree_get_pt(std::size_t i, std::size_t k) const {
    if (until && ++reads % 1024 == 0 && until->breathe()) throw Stopped{};
    return columns(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i));
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

/// Squared distances straight from the columns.
struct ColumnMetric : nanoflann::L2_Simple_Adaptor<double, ColumnCloud> {
  using L2_Simple_Adaptor::L2_Simple_Adaptor;
  double evalMetric(const double* a, std::size_t i, std::size_t size) const {
    const double* b = data_source.columns.data() + i * size;
    double sum = 0;
    for (std::size_t k = 0; k < size; ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
    return sum;
  }
};

using ColumnTree = nanoflann::KDTreeSingleIndexAdaptor<ColumnMetric, ColumnCloud, -1, int>;

/// Roadmap::build that is empty when `over` ended it. `over` is asked by several threads.
MMGRASP_EXPORT Roadmap build_roadmap(const JointGroup& group, const RoadmapOptions& options, const Monitor& monitor,
                                     const std::function<bool()>& over);

/// A small roadmap over given configurations, one column each, made by the calling thread.
MMGRASP_EXPORT Roadmap roadmap_over(const JointGroup& group, int neighbours, Eigen::MatrixXd vertices);

/// What a group must agree on to use a roadmap: the robot's joints, and which of them it moves where. Shapes, disabled
/// pairs and where the root stands do not matter.
std::uint64_t kinematics_key(const JointGroup& group);

}  // namespace detail

struct Roadmap::Data {
  Data(const JointGroup& group_in, const RoadmapOptions& options_in) : group(group_in), options(options_in) {}

  /// Draws the vertices; false when stopped.
  bool draw(detail::Until& until);
  /// Makes the search tree over the vertices; false when stopped.
  bool index(detail::Until& until);
  double radius() const;
  /// The nearest so many vertices, or with 0 those nearer than radius(); ascending.
  void near(const double* q, int neighbours, std::vector<int>& out) const;
  /// Joins near vertices; false when stopped.
  bool join(detail::Until& until, int threads);
  /// Makes the arcs of `ends`; false when stopped.
  bool make_arcs(detail::Until& until);

  JointGroup group;
  RoadmapOptions options;
  Eigen::MatrixXd vertices;
  std::vector<std::pair<int, int>> ends;  ///< Of each edge, ascending.
  std::vector<int> first;                 ///< Arcs of vertex v: first[v] .. first[v + 1].
  std::vector<Arc> arcs;
  std::unique_ptr<detail::ColumnCloud> cloud;
  std::unique_ptr<detail::ColumnTree> tree;
};

}  // namespace mmgrasp
