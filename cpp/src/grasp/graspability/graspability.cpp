#include "mmgrasp/grasp/graspability.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "grasp/graspability/graspability_layers.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/core/parallel.hpp"

namespace mmgrasp {
namespace {

/// One closing direction, opening and fingertip height.
struct Item {
  int orientation = 0, opening = 0, layer = 0;
};

struct ItemResult {
  std::vector<Grasp> grasps;
  GraspabilityCounts counts;
};

constexpr double kMostCells = 1e6;  // Wider than any map: 20,000 cells.

int in_cells(double length, double resolution) {
  return static_cast<int>(std::lround(std::min(length / resolution, kMostCells)));
}

/// The tool frame's rotation when the hand moves along -z and closes along an angle.
Eigen::Matrix3d hand_rotation(const Hand& hand, double angle) {
  const Eigen::Vector3d approach = -Eigen::Vector3d::UnitZ(), closing(std::cos(angle), std::sin(angle), 0);
  Eigen::Matrix3d from, to;
  from << hand.approach, hand.closing, hand.approach.cross(hand.closing);
  to << approach, closing, approach.cross(closing);
  return to * from.transpose();
}

double closing_angle(const Grasp& grasp) {
  return std::get<HeightMapProvenance>(grasp.provenance).angle;
}

/// Closing directions differ by the smaller angle between undirected lines.
double line_angle(double a, double b) {
  const double d = std::abs(std::remainder(a - b, detail::kPi));
  return d;
}

/// Every closing direction, opening and fingertip height as one item of work; the best places of all are kept apart.
class Evaluation {
 public:
  Evaluation(const HeightMap& map, const Hand& hand, const GraspabilityOptions& options)
      : map_(map), hand_(hand), options_(options), refiner_(map, hand, options) {
    int border = 0;
    for (int k = 0; k < options.openings; ++k)
      openings_.push_back(hand.max_opening * (options.openings - k) / options.openings);
    for (int i = 0; i < options.orientations; ++i) {
      for (const double opening : openings_) {
        masks_.emplace_back(make_hand_masks(hand, opening, angle(i), map.resolution, options.margin));
        border = std::max(border, masks_.back().radius());
      }
    }
    for (const double tip : detail::tip_heights(map, options)) layers_.emplace_back(map, tip, hand, options, border);
    for (int l = 0; l < static_cast<int>(layers_.size()); ++l) {
      for (int i = 0; i < options.orientations; ++i) {
        for (int k = 0; k < options.openings; ++k) items_.push_back({i, k, l});
      }
    }
  }

  std::size_t items() const { return items_.size(); }

  ItemResult evaluate(std::size_t index) const {
    const Item& item = items_[index];
    const auto& masks = masks_[item.orientation * openings_.size() + item.opening];
    const detail::TipLayer& layer = layers_[item.layer];
    const detail::LayerMap map = detail::layer_map(layer, masks, in_cells(options_.smoothing, map_.resolution) / 2);
    ItemResult result;
    for (const int cell : detail::local_maxima(map, map_.nx, map_.ny, options_.min_distance / map_.resolution)) {
      Grasp grasp;
      HeightMapProvenance place;
      std::vector<QualityFactor> parts;
      ++result.counts.tried;
      switch (refiner_.refine(cell % map_.nx, cell / map_.nx, angle(item.orientation), openings_[item.opening], layer,
                              grasp, place, parts)) {
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
      parts.push_back({"room", std::min(1.0f, map.smooth[cell] / map.raw[cell]), 0.5});
      grasp.set_quality(std::move(parts));
      grasp.T_object_hand.linear() = hand_rotation(hand_, place.angle);
      grasp.provenance = place;
      result.grasps.push_back(std::move(grasp));
    }
    return result;
  }

  /// Best first, those beside better ones left out.
  Graspability gather(std::vector<ItemResult>& results) const {
    Graspability out;
    std::vector<Grasp> all;
    for (const ItemResult& result : results) {
      out.counts.tried += result.counts.tried;
      out.counts.too_wide += result.counts.too_wide;
      out.counts.poor += result.counts.poor;
      out.counts.collision += result.counts.collision;
      all.insert(all.end(), result.grasps.begin(), result.grasps.end());
    }
    std::stable_sort(all.begin(), all.end(), [](const Grasp& a, const Grasp& b) { return a.quality > b.quality; });
    for (Grasp& grasp : all) {
      const bool keep = static_cast<int>(out.grasps.size()) < options_.max_grasps && !near_better(grasp, out.grasps);
      keep ? out.grasps.push_back(grasp) : void(++out.counts.near_better);
    }
    for (Grasp& grasp : out.grasps) grasp.T_object_hand = map_.T_world_map * grasp.T_object_hand;
    return out;
  }

 private:
  double angle(int orientation) const { return detail::kPi * orientation / options_.orientations; }

  bool near_better(const Grasp& grasp, const std::vector<Grasp>& better) const {
    constexpr double kSameDirection =
        0.55;  // [rad]: half the way to a direction that is another grasp of the same part
    return std::any_of(better.begin(), better.end(), [&](const Grasp& b) {
      const Eigen::Vector2d apart = (b.T_object_hand.translation() - grasp.T_object_hand.translation()).head<2>();
      return apart.norm() < options_.min_distance &&
             line_angle(closing_angle(b), closing_angle(grasp)) < kSameDirection;
    });
  }

  const HeightMap& map_;
  const Hand& hand_;
  const GraspabilityOptions& options_;
  detail::Refiner refiner_;
  std::vector<double> openings_;
  std::vector<detail::HandRuns> masks_;  // by orientation, then opening
  std::vector<detail::TipLayer> layers_;
  std::vector<Item> items_;
};

}  // namespace

void GraspabilityOptions::check() const {
  const auto not_negative = [](double value, const char* field) { require_not_negative(value, field, "m"); };
  require(orientations > 0 && orientations <= 360, "orientations", orientations, "must be from 1 to 360");
  require(openings > 0 && openings <= 20, "openings", openings, "must be from 1 to 20");
  require_length(layer_step, "layer_step");
  require_number(lowest, "lowest", "m");
  require_positive(insertion, "insertion", "m");
  not_negative(margin, "margin");
  not_negative(smoothing, "smoothing");
  require(min_contact > 0 && min_contact <= 1, "min_contact", min_contact, "must be above 0 and at most 1");
  not_negative(min_distance, "min_distance");
  require_count(max_grasps, "max_grasps", 1, 1'000'000);
  resolve_threads(threads);  // says what is wrong
}

Graspability evaluate_graspability(const HeightMap& map, const Hand& hand, const GraspabilityOptions& options,
                                   const Monitor& monitor) {
  options.check();
  map.check();
  hand.check_fingers();
  const Evaluation evaluation(map, hand, options);
  std::vector<ItemResult> results(evaluation.items());
  parallel_for(
      evaluation.items(), options.threads, [&](std::size_t i, int) { results[i] = evaluation.evaluate(i); }, monitor,
      "graspability");
  return evaluation.gather(results);
}

std::vector<float> graspability_map(const HeightMap& map, const Hand& hand, double angle, double opening,
                                    double tip_height, const GraspabilityOptions& options) {
  options.check();
  map.check();
  require_number(tip_height, "tip_height", "m");
  const detail::HandRuns masks(make_hand_masks(hand, opening, angle, map.resolution, options.margin));
  const detail::TipLayer layer(map, tip_height, hand, options, masks.radius());
  detail::LayerMap result = detail::layer_map(layer, masks, in_cells(options.smoothing, map.resolution) / 2);
  if (result.empty) result.smooth.assign(map.height.size(), 0.0f);
  return std::move(result.smooth);
}

void find_pixels(const DepthImage& image, std::vector<Grasp>& grasps) {
  image.check();
  const Pose T_camera_world = image.T_world_camera.inverse(Eigen::Isometry);
  for (Grasp& grasp : grasps) {
    const auto pixel = image.camera.project(T_camera_world * grasp.T_object_hand.translation());
    auto* place = std::get_if<HeightMapProvenance>(&grasp.provenance);
    if (pixel && place != nullptr) place->pixel = *pixel;
  }
}

}  // namespace mmgrasp
