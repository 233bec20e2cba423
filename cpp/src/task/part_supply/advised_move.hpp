#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "mmgrasp/task/base_region.hpp"
#include "mmgrasp/task/ids.hpp"

namespace mmgrasp::detail {

/// A translation on the floor and all that takes part in it.
struct TrayMove {
  Eigen::Vector2d by = Eigen::Vector2d::Zero();  // world x, y [m]
  std::vector<std::string> trays, objects;       // names; the tray to be moved is the first
};

/// The shortest move of a tray (with what carries it and what else stands on that) by whole cells after which a disc of
/// the positioning uncertainty and one cell more is free for the robot at home and serves the tray; checked in the
/// moved scene. Nothing when no move of up to a few metres was found, or when the move alone would not be enough.
std::optional<TrayMove> advise_move(const PartSupplyProblem& problem, const ReachDatabase& database,
                                    const BaseGrid& grid, TrayId tray);

}  // namespace mmgrasp::detail
