// What surrounds the search: options, counts, summary, rating by drawn surfaces.
#include <algorithm>
#include <cmath>
#include <utility>

#include "grasp/synthesis/evaluate_grasp.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/core/parallel.hpp"
#include "mmgrasp/grasp/synthesize_grasps.hpp"

namespace mmgrasp {

void detail::add_verdict(Verdict verdict, SynthesisCounts& counts) {
  switch (verdict) {
    case Verdict::good:
      return;
    case Verdict::missed:
      ++counts.missed;
      return;
    case Verdict::uneven:
      ++counts.uneven;
      return;
    case Verdict::slipping:
      ++counts.slipping;
      return;
    case Verdict::uncertain:
      ++counts.uncertain;
      return;
    case Verdict::collision:
      ++counts.collision;
      return;
    case Verdict::table:
      ++counts.table;
      return;
    case Verdict::arm:
      ++counts.arm;
      return;
  }
}

void SynthesisOptions::check() const {
  const auto not_negative = [](double value, const char* field) { require_not_negative(value, field); };
  require(samples > 0 && samples <= 1000000, "samples", samples, "must be from 1 to 1000000");
  require_count(refined, "refined", 1, 1'000'000);
  not_negative(shift, "shift");
  require(max_tilt >= 0 && max_tilt <= 3.2, "max_tilt", max_tilt, "must be in [0, 3.2] [rad]");
  if (table) require_number(*table, "table", "m");
  not_negative(table_tolerance, "table_tolerance");
  if (object) {
    const bool sound = !object->isEmpty() && object->min().allFinite() && object->max().allFinite();
    require(sound, "object", "box", "its lower corner must be below its upper one, both finite [m]");
  }
  not_negative(sigmas, "sigmas");
  not_negative(margin, "margin");
  require(approach_distance >= 0 && approach_distance <= 10, "approach_distance", approach_distance,
          "must be in [0, 10] [m]");
  not_negative(min_distance, "min_distance");
  require_count(max_grasps, "max_grasps", 1, 1'000'000);
  resolve_threads(threads);  // says what is wrong
  success.check();
  patch.check();
}

std::string GraspSynthesis::summary() const {
  const auto number = [](std::size_t n) { return std::to_string(n); };
  if (!grasps.empty())
    return number(grasps.size()) + " grasps, the best with probability " + std::to_string(grasps[0].quality);
  if (outcome == Outcome::stopped) return "stopped before any grasp was confirmed";
  const std::pair<std::size_t, const char*> causes[] = {
      {counts.no_opposite, "the map has no surface opposite"},
      {counts.too_wide, "the object is wider there than the hand opens"},
      {counts.too_thin, "the object is thinner there than the hand closes"},
      {counts.tilted, "the hand would come in tilted by more than max_tilt"},
      {counts.missed, "a pad meets too little of the surface"},
      {counts.uneven, "a pad meets no plane"},
      {counts.slipping, "no force closure"},
      {counts.uncertain, "the surface is less certain than max_sigma"},
      {counts.collision, "the hand touches the map"},
      {counts.table, "the hand touches the table"},
      {counts.arm, "the arm does not get there"}};
  const auto* most = std::max_element(std::begin(causes), std::end(causes),
                                      [](const auto& a, const auto& b) { return a.first < b.first; });
  std::string wide;
  if (counts.too_wide > counts.evaluated) {
    const auto millimetres = [](double x) { return std::to_string(static_cast<int>(std::round(1e3 * x))) + " mm"; };
    wide = "; half of the opposite walls are " + millimetres(median_too_wide) + " or more apart, and the hand opens " +
           millimetres(opens);
  }
  // Another place of the base changes this cause alone.
  const std::string beyond =
      counts.arm > 0 ? "; the arm does not get to the " + number(counts.arm) + " that hold: " + arm.summary() : "";
  return "no grasp of " + number(counts.drawn) + " surface points drawn and " + number(counts.evaluated) +
         " grasps evaluated; most often (" + number(most->first) + "): " + most->second + wide + beyond;
}

void draw_success(const ProbabilisticSdf& map, const HandModel& hand, const SurfaceDrawOptions& draws,
                  const SynthesisOptions& options, GraspSynthesis& found) {
  parallel_for(found.ratings.size(), options.threads, [&](std::size_t i, int) {
    GraspRating& rating = found.ratings[i];
    const auto pads = hand.pads(hand.shares_of(rating.pretouch_opening, rating.pretouch_posture));
    rating.drawn = draw_success(map, pads, found.grasps[i].T_object_hand, found.object, hand.hand().clearance, draws,
                                options.success, options.patch);
  });
}

}  // namespace mmgrasp
