#pragma once

#include <limits>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/core/outcome.hpp"
#include "mmgrasp/gripper_design/gripper.hpp"
#include "mmgrasp/gripper_design/segment_requirement.hpp"

namespace mmgrasp {

/// A drive that fingers can be mounted on, e.g. an air chuck. Where the fingers sit on it is free, so that its opening
/// may begin anywhere; the stroke is fixed (P1 5.3.4: W- = W+ - d).
struct MMGRASP_EXPORT GripperActuator {
  std::string name;
  int fingers = 2;                                               ///< 2 or 3.
  double stroke = 0;                                             ///< Largest less smallest opening [m], > 0.
  double max_opening = std::numeric_limits<double>::infinity();  ///< As wide as fingers can be mounted [m], >= stroke.
  double cost = 1;  ///< Cost of a gripper with this drive, > 0; at most 1e6 times the least one.
};

/// Which fingers can be made, what a change of grippers costs, and how long minimal_grippers() searches.
struct MMGRASP_EXPORT MinimalGrippersOptions {
  double shortest_finger = 0.01;  ///< No finger is shorter [m], > 0.
  double longest_finger = 0.5;    ///< No finger is longer [m], >= shortest_finger.
  double opening_margin = 0;      ///< Stroke kept free beyond the part at either end [m], >= 0; less than half of it.
  double length_margin = 0;       ///< Kept from either limit of the finger length [m], >= 0.
  double finger_width = 0.015, finger_thickness = 0.008;  ///< Fingers of the grippers returned [m], > 0.
  /// Cost of changing the gripper between two operations, >= 0. At 0 changes cost nothing, but of all cheapest sets one
  /// with the fewest changes is taken.
  double change_cost = 0;
  /// Values of the largest opening and of the finger length on P1's grid (n and m of 5.3.4); 0 and 0: every gripper
  /// that matters, exactly.
  int grid_openings = 0, grid_lengths = 0;
  /// Most nodes of the search for fewest changes, and of that for better segments, > 0. Steps by which bounds are
  /// raised count as nodes, too: 20000 are about a second of processor time.
  int max_nodes = 20000;
  double time_limit = 60;  ///< Wall-clock cap [s], > 0.
  void check() const;
};

/// The grippers chosen for an assembly, which part each of them takes, and what is proven about the choice.
struct MMGRASP_EXPORT MinimalGrippersResult {
  /// `solved`: proven, in cost and changes (on a grid: of the grid's grippers); `approximate`: a set that takes every
  /// part, `lower_bound` and `changes_bound` say what is proven; `infeasible`: see `explanations`; `stopped`.
  Outcome outcome = Outcome::timeout;
  std::vector<Gripper> grippers;         ///< The grippers chosen, in the order of first use.
  std::vector<std::string> parts;        ///< Names of the parts, in the order of assembly.
  std::vector<int> gripper_of_part;      ///< Which of `grippers` takes it; one per part.
  std::vector<int> requirement_of_part;  ///< Which of the requirements given it takes the part by; one per part.
  double cost = 0;                       ///< Cost of the grippers and of the changes.
  double lower_bound = 0;                ///< Proven: no set of grippers costs less.
  int changes = 0;                       ///< How often the gripper changes from part to part.
  int changes_bound = 0;                 ///< Proven: no set of the same cost needs fewer.
  /// preferred_grippers() decided for every better segment of a part whether the set stays as good with it.
  /// False: `max_nodes` or the time limit ended first, and some part may be taken by a worse one.
  bool preference_finished = true;
  int candidates = 0;                     ///< Grippers that were chosen among, none doing only what another does.
  std::vector<std::string> uncovered;     ///< Parts that no gripper takes, in order.
  std::vector<std::string> explanations;  ///< One per uncovered part: what each segment asks that nothing offers.
};

/// The least set of grippers that takes every part of an assembly (P1 5.3.4, (5.1) and (5.2) with <=), and which
/// gripper takes which part by which segment. Parts are assembled in the order in which the requirements first name
/// them.
///
/// Proven least over all grippers, not over samples: a gripper can be moved up in opening until its smallest part is as
/// narrow as it goes, and its fingers shortened to what its parts ask, without losing a part; so grippers at these ends
/// suffice (docs/methods/gripper_design.md). Among the cheapest sets one with fewest changes along the order is sought
/// by branch and bound. The answer is checked part by part. Throws InvalidInput for wrong requirements, actuators or
/// options; IoError never.
MMGRASP_EXPORT MinimalGrippersResult minimal_grippers(const std::vector<SegmentRequirement>& requirements,
                                                      const std::vector<GripperActuator>& actuators,
                                                      const MinimalGrippersOptions& options = {},
                                                      const Monitor& monitor = {});

/// A set of no higher cost and no more changes that takes each part by its best segment, as far as one does: parts are
/// gone through in the order of assembly, and of each the requirements in the order of their values, highest first;
/// the first with which the set stays as good is kept. `values`: one per requirement, not NaN; equal ones stay as
/// minimal_grippers() chose. Asked are the set at hand, then each exchange of one gripper, then a branch and bound of
/// at most half of `max_nodes`, all of which together get five times `max_nodes`; of more than 4,000 requirements
/// the set at hand alone. Its `requirement_of_part` counts in the requirements given. Throws as minimal_grippers()
/// does, and for another number of values.
MMGRASP_EXPORT MinimalGrippersResult preferred_grippers(const std::vector<SegmentRequirement>& requirements,
                                                        const std::vector<double>& values,
                                                        const std::vector<GripperActuator>& actuators,
                                                        const MinimalGrippersOptions& options = {},
                                                        const Monitor& monitor = {});

}  // namespace mmgrasp
