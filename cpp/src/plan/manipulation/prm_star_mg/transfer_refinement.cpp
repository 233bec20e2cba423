#include "plan/manipulation/prm_star_mg/transfer_refinement.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "plan/manipulation/common/informed_union.hpp"
#include "plan/manipulation/common/transfer_shortening.hpp"
#include "plan/manipulation/prm_star_mg/roadmap_search.hpp"
#include "plan/roadmap/roadmap_data.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kFirstVertexCount = 100;      // Vertices of the first roadmap.
constexpr int kRoundsPerVertex = 4;         // Rounds after which a roadmap has one vertex more.
constexpr int kNeighbours = 16;             // Neighbours of each vertex.
constexpr double kDetourFactor = 1.3;       // Every other round takes paths up to this many times as long as the best.
constexpr double kLeastImprovement = 1e-6;  // Paths shorter by less than this share do not count as better.

/// Rounds of small roadmaps drawn where a cheaper path can pass, each searched and its path shortened.
class Refinement {
 public:
  Refinement(const ManipulationInput& input, ManipulationResult& result)
      : input_(input),
        result_(result),
        ends_(input.candidates.found()),
        informed_(ends_, input.problem.group.sample_lower(), input.problem.group.sample_upper()) {}

  void run() {
    for (int round = 0; round < input_.options.prm.refinements && !input_.out_of_time(); ++round) {
      informed_.set_cost(result_.cost * (1 - kLeastImprovement));
      const std::optional<Roadmap> roadmap = draw(round);
      if (!roadmap) return;
      // Paths may be longer before they are shortened.
      const double slack = round % 2 == 0 ? kDetourFactor : 1;
      TransferPath best{result_.grasp_index, slack * result_.cost, *result_.path, PlanStage::shortening};
      // Straight lines were checked before; a small roadmap is not worth a second thread.
      RoadmapSearch(input_, *roadmap, false, 1, best, result_, PlanStage::refinement).run();
      shorten_transfer(input_, best, result_, static_cast<unsigned>(round) + 1);
    }
  }

 private:
  /// Nothing when no grasp can win.
  std::optional<Roadmap> draw(int round) {
    if (informed_.grasps() == 0) return std::nullopt;
    Rng rng(input_.options.seed, 0x72660000u + static_cast<std::uint64_t>(round));
    Eigen::MatrixXd vertices(input_.problem.group.size(), kFirstVertexCount + round / kRoundsPerVertex);
    for (Eigen::Index v = 0; v < vertices.cols(); ++v)
      if (informed_.draw(rng, vertices.col(v).data()) < 0) return std::nullopt;
    return roadmap_over(input_.problem.group, kNeighbours, std::move(vertices), input_.options.joint_weights);
  }

  const ManipulationInput& input_;
  ManipulationResult& result_;
  GraspEnds ends_;
  InformedUnion informed_;
};

}  // namespace

void refine_transfer(const ManipulationInput& input, ManipulationResult& result) {
  // The bound holds for the roadmaps before; these paths leave them.
  const double bound = result.stats.roadmap_bound;
  Refinement(input, result).run();
  result.stats.roadmap_bound = std::min(bound, result.cost);
}

}  // namespace mmgrasp::detail
