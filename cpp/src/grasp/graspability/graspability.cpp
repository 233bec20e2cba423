#include "mmgrasp/grasp/graspability.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "grasp/graspability/graspability_layers.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/parallel.hpp"

namespace mmgrasp {
namespace {

/// One closing direction, opening and fingertip height.
struct Item {
  int orientation = 0, opening = 0, layer = 0;
};

struct ItemResult {
  std::vector<ScoredGrasp> grasps;
  GraspabilityCounts counts;
};

int in_cells(double length, double resolution) {
  return static_cast<int>(std::lround(length / resolution));
}

/// The tcp's rotation when the hand moves along -z and closes along an angle.
Eigen::Matrix3d hand_rotation(const Gripper& gripper, double angle) {
  const Eigen::Vector3d approach = -Eigen::Vector3d::UnitZ(), closing(std::cos(angle), std::sin(angle), 0);
  Eigen::Matrix3d from, to;
  from << gripper.approach, gripper.closing, gripper.approach.cross(gripper.closing);
  to << approach, closing, approach.cross(closing);
  return to * from.transpose();
}

/// Closing directions differ by the smaller angle between undirected lines.
double line_angle(double a, double b) {
  const double d = std::abs(std::remainder(a - b, detail::kPi));
  return d;
}

class Evaluation {
 public:
  Evaluation(const HeightMap& map, const Gripper& gripper, const GraspabilityOptions& options)
      : map_(map), gripper_(gripper), options_(options), refiner_(map, gripper, options) {
    int border = 0;
    for (int k = 0; k < options.openings; ++k)
      openings_.push_back(gripper.max_opening * (options.openings - k) / options.openings);
    for (int i = 0; i < options.orientations; ++i) {
      for (const double opening : openings_) {
        hands_.emplace_back(make_hand_masks(gripper, options.hand, opening, angle(i), map.resolution));
        border = std::max(border, hands_.back().radius());
      }
    }
    for (const double tip : detail::tip_heights(map, options)) layers_.emplace_back(map, tip, options, border);
    for (int l = 0; l < static_cast<int>(layers_.size()); ++l) {
      for (int i = 0; i < options.orientations; ++i) {
        for (int k = 0; k < options.openings; ++k) items_.push_back({i, k, l});
      }
    }
  }

  std::size_t items() const { return items_.size(); }

  ItemResult evaluate(std::size_t index) const {
    const Item& item = items_[index];
    const auto& hand = hands_[static_cast<std::size_t>(item.orientation) * openings_.size() + item.opening];
    const detail::TipLayer& layer = layers_[item.layer];
    const detail::LayerMap map = detail::layer_map(layer, hand, in_cells(options_.smoothing, map_.resolution) / 2);
    ItemResult result;
    for (const int cell : detail::local_maxima(map, map_.nx, map_.ny, options_.min_distance / map_.resolution)) {
      ScoredGrasp grasp;
      grasp.orientation = item.orientation;
      ++result.counts.tried;
      switch (refiner_.refine(cell % map_.nx, cell / map_.nx, angle(item.orientation), openings_[item.opening], layer,
                              grasp)) {
        case detail::Refined::too_wide:
          ++result.counts.too_wide;
          continue;
        case detail::Refined::poor:
          ++result.counts.poor;
          continue;
        case detail::Refined::collision:
          ++result.counts.collision;
          continue;
        case detail::Refined::good:
          break;
      }
      // Near the edge of what is graspable the mean falls below the value itself.
      grasp.score *= 0.5 + 0.5 * std::min(1.0f, map.smooth[cell] / map.raw[cell]);
      grasp.T_world_tcp.linear() = hand_rotation(gripper_, grasp.angle);
      result.grasps.push_back(grasp);
    }
    return result;
  }

  /// Best first, those beside better ones left out.
  Graspability gather(std::vector<ItemResult>& results) const {
    Graspability out;
    std::vector<ScoredGrasp> all;
    for (const ItemResult& result : results) {
      out.counts.tried += result.counts.tried;
      out.counts.too_wide += result.counts.too_wide;
      out.counts.poor += result.counts.poor;
      out.counts.collision += result.counts.collision;
      all.insert(all.end(), result.grasps.begin(), result.grasps.end());
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const ScoredGrasp& a, const ScoredGrasp& b) { return a.score > b.score; });
    for (ScoredGrasp& grasp : all) {
      const bool keep = static_cast<int>(out.grasps.size()) < options_.max_grasps && !near_better(grasp, out.grasps);
      keep ? out.grasps.push_back(grasp) : void(++out.counts.near_better);
    }
    for (ScoredGrasp& grasp : out.grasps) grasp.T_world_tcp = map_.T_world_map * grasp.T_world_tcp;
    return out;
  }

 private:
  double angle(int orientation) const { return detail::kPi * orientation / options_.orientations; }

  bool near_better(const ScoredGrasp& grasp, const std::vector<ScoredGrasp>& better) const {
    constexpr double kAlike = 0.55;  // [rad]: half the way to a direction that is another grasp of the same part
    return std::any_of(better.begin(), better.end(), [&](const ScoredGrasp& b) {
      const Eigen::Vector2d gap = (b.T_world_tcp.translation() - grasp.T_world_tcp.translation()).head<2>();
      return gap.norm() < options_.min_distance && line_angle(b.angle, grasp.angle) < kAlike;
    });
  }

  const HeightMap& map_;
  const Gripper& gripper_;
  const GraspabilityOptions& options_;
  detail::Refiner refiner_;
  std::vector<double> openings_;
  std::vector<detail::HandRuns> hands_;  // by orientation, then opening
  std::vector<detail::TipLayer> layers_;
  std::vector<Item> items_;
};

}  // namespace

void GraspabilityOptions::check() const {
  hand.check();
  const auto not_negative = [](double value, const char* field) {
    require(std::isfinite(value) && value >= 0, field, value, "must be zero or positive and finite [m]");
  };
  require(orientations > 0 && orientations <= 360, "orientations", orientations, "must be from 1 to 360");
  require(openings > 0 && openings <= 20, "openings", openings, "must be from 1 to 20");
  require(std::isfinite(layer_step) && layer_step > 0, "layer_step", layer_step, "must be positive and finite [m]");
  require(std::isfinite(lowest), "lowest", lowest, "must be finite [m]");
  require(std::isfinite(insertion) && insertion > 0, "insertion", insertion, "must be positive and finite [m]");
  not_negative(smoothing, "smoothing");
  require(min_contact > 0 && min_contact <= 1, "min_contact", min_contact, "must be above 0 and at most 1");
  not_negative(min_distance, "min_distance");
  require(max_grasps > 0, "max_grasps", max_grasps, "must be positive");
  require(threads >= 0, "threads", threads, "must be zero or positive");
}

Graspability evaluate_graspability(const HeightMap& map, const Gripper& gripper, const GraspabilityOptions& options,
                                   const Monitor& monitor) {
  options.check();
  map.check();
  gripper.check();
  const Evaluation evaluation(map, gripper, options);
  std::vector<ItemResult> results(evaluation.items());
  parallel_for(
      evaluation.items(), options.threads, [&](std::size_t i, int) { results[i] = evaluation.evaluate(i); }, monitor,
      "graspability");
  return evaluation.gather(results);
}

std::vector<float> graspability_map(const HeightMap& map, const Gripper& gripper, double angle, double opening,
                                    double tip_height, const GraspabilityOptions& options) {
  options.check();
  map.check();
  require(std::isfinite(tip_height), "tip_height", tip_height, "must be finite [m]");
  const detail::HandRuns hand(make_hand_masks(gripper, options.hand, opening, angle, map.resolution));
  const detail::TipLayer layer(map, tip_height, options, hand.radius());
  detail::LayerMap result = detail::layer_map(layer, hand, in_cells(options.smoothing, map.resolution) / 2);
  if (result.empty) result.smooth.assign(map.height.size(), 0.0f);
  return std::move(result.smooth);
}

void find_pixels(const DepthImage& image, std::vector<ScoredGrasp>& grasps) {
  image.check();
  const Pose T_camera_world = image.T_world_camera.inverse(Eigen::Isometry);
  for (ScoredGrasp& grasp : grasps) {
    const auto pixel = image.camera.project(T_camera_world * grasp.T_world_tcp.translation());
    if (pixel) grasp.pixel = *pixel;
  }
}

}  // namespace mmgrasp
