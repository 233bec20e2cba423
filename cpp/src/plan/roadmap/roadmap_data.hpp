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
#include "mmgrasp/robot/detail/joint_metric.hpp"

namespace mmgrasp {

namespace detail {

/// Makes a long call end when `over` is true, which is checked now and then. The caller's progress is passed on.
class CancelCheck {
 public:
  CancelCheck() : over_(kNever) {}  ///< Never stopped.
  CancelCheck(const Monitor& monitor, const std::function<bool()>& over) : over_(over) {
    own_.progress = monitor.progress;
  }
  const Monitor& monitor() const { return own_; }
  /// Must be called with every step, from any thread. True once the call shall end.
  bool stopped() {
    if (steps_++ % kCheckInterval == 0 && over_()) own_.stop.stop();
    return own_.stopped();
  }

 private:
  static constexpr std::size_t kCheckInterval = 64;
  inline static const std::function<bool()> kNever = [] { return false; };
  const std::function<bool()>& over_;
  Monitor own_;
  std::atomic<std::size_t> steps_{0};
};

/// Columns of a matrix as nanoflann wants them. Coordinates are read one by one only while the search tree is
/// built, which can be stopped nowhere else.
struct ColumnCloud {
  struct Stopped {};
  const Eigen::MatrixXd& columns;
  CancelCheck* cancel = nullptr;  ///< While the tree is built: reading throws Stopped when it is stopped.
  mutable std::size_t reads = 0;

  std::size_t kdtree_get_point_count() const { return columns.cols(); }
  double kdtree_get_pt(std::size_t i, std::size_t k) const {
    if (cancel && ++reads % 1024 == 0 && cancel->stopped()) throw Stopped{};
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

/// Roadmap::build that gives an empty roadmap when `over` ended it. `over` is called from several threads.
MMGRASP_EXPORT Roadmap build_roadmap(const JointGroup& group, const RoadmapOptions& options, const Monitor& monitor,
                                     const std::function<bool()>& over);

/// A small roadmap over given configurations, one column each, built in the calling thread.
MMGRASP_EXPORT Roadmap roadmap_over(const JointGroup& group, int neighbours, Eigen::MatrixXd vertices,
                                    const JointWeights& weights = {});

/// Hash of what must be the same for a roadmap to fit a group: the robot's joints, and which of them the group moves
/// within which bounds. Shapes, disabled pairs and the pose of the root do not matter.
std::uint64_t kinematics_key(const JointGroup& group);

}  // namespace detail

struct Roadmap::Data {
  Data(const JointGroup& group_in, const RoadmapOptions& options_in)
      : group(group_in), metric(group_in.wraps(), options_in.joint_weights.of(group_in)), options(options_in) {}

  /// Draws the vertices; false when stopped.
  bool draw(detail::CancelCheck& cancel);
  /// Builds the search tree over the vertices; false when stopped.
  bool index(detail::CancelCheck& cancel);
  double radius() const;
  /// Nearest vertices that each is joined with; 0: all within radius().
  int neighbours() const;
  /// The `neighbours` nearest vertices, or with 0 those nearer than radius(); ascending.
  void near(const double* q, int neighbours, std::vector<int>& out) const;
  /// The same where angles wrap or joints have weights. The search tree holds coordinates of the metric and knows no
  /// angles, so it is asked for each image of q by whole turns that can be nearer to a vertex than q in [-pi, pi] is:
  /// every such angle has one.
  void near_around(const double* q, int neighbours, std::vector<int>& out) const;
  /// Joins near vertices; false when stopped.
  bool join(detail::CancelCheck& cancel, int threads);
  /// Makes the arcs of `ends` and counts the components; false when stopped.
  bool make_arcs(detail::CancelCheck& cancel);
  void count_components();

  JointGroup group;
  detail::JointMetric metric;
  RoadmapOptions options;
  Eigen::MatrixXd vertices;
  std::vector<std::pair<int, int>> ends;  ///< The two vertices of each edge, the smaller number first.
  std::vector<int> first;                 ///< Arcs of vertex v: first[v] .. first[v + 1].
  std::vector<Arc> arcs;
  int components = 0, largest_component = 0;  ///< Their number, and the vertices of the largest one.
  Eigen::MatrixXd coordinates;                ///< The vertices in the metric, unless it is plain.
  std::unique_ptr<detail::ColumnCloud> cloud;
  std::unique_ptr<detail::ColumnTree> tree;
};

}  // namespace mmgrasp
